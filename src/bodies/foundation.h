/* Springs on surfaces: an elastic foundation that ties a body to the ground. A reference area dA whose displacement is
   u feels the force -k_i u_i dA along each axis i, in every kinematics; in an axisymmetric scene x is the radius. A
   history may change k_i over the load parameter.

   FoundationResidual() adds force and energy, FoundationTangent() the tangent. FoundationHolds() tells which
   dofs have a spring. FoundationForce() gives the forces of the last residual, FoundationAddForces() those of any
   displacements. */
#pragma once
#include "bodies/elasticity.h"

typedef struct _n_Foundation *Foundation;

PetscErrorCode   FoundationCreate(Mesh, Scene, Foundation *);
PetscErrorCode   FoundationDestroy(Foundation *);
PetscErrorCode   FoundationResidual(Foundation, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                                    PetscReal *force2);
void             FoundationAddForces(Foundation, PetscReal t, const PetscReal *u, PetscReal *forces, PetscReal *energy,
                                     PetscReal *force2);
PetscErrorCode   FoundationTangent(Foundation, PetscReal t, Elasticity);
PetscBool        FoundationHolds(Foundation, PetscInt local_dof);
const PetscReal *FoundationForce(Foundation);
