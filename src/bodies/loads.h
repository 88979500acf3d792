/* Loads, supports, imposed displacements and rigid motions at any load parameter t. Knows no stepping. */
#pragma once
#include "bodies/elasticity.h"

typedef struct _n_Loads *Loads;

/* Marks supported and imposed dofs as constrained in the mesh's local section; must come before any matrix or vector is
 * made. Collective. */
PetscErrorCode LoadsCreate(Mesh, Scene, Loads *);
PetscErrorCode LoadsDestroy(Loads *);
/* Writes the prescribed displacements at t into u (n_nodes*dim local). Not collective. */
PetscErrorCode LoadsPrescribe(Loads, PetscReal t, PetscReal *u);
/* Subtracts external forces at (t, u) from f; adds their potential to energy; force2: sum of squares of the unassembled
 * forces. Any may be NULL. Not collective. */
PetscErrorCode LoadsResidual(Loads, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                             PetscReal *force2);
/* Adds the loads' part of the tangent (follower loads) into the elasticity's local CSR. Not collective. */
PetscErrorCode LoadsTangent(Loads, PetscReal t, const PetscReal *u, Elasticity);
PetscBool      LoadsConservative(Loads);                   /* an energy exists: no follower load */
PetscBool      LoadsPrescribed(Loads, PetscInt local_dof); /* supported or imposed */
/* Position of a point of rigid body b (index into scene->bodies) at t; X relative to the mesh's centre. Not collective.
 */
void LoadsRigidMotion(Loads, int body, PetscReal t, const PetscReal X[3], PetscReal x[3]);
/* Largest displacement of any rigid point of the body between two load parameters: for the search distance. */
PetscReal LoadsRigidTravel(Loads, int body, PetscReal t0, PetscReal t1);
