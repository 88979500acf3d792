/* Loads, supports and their springs, imposed displacements and rigid motions at any load parameter t. Knows no
   stepping.

   LoadsCreate() marks the prescribed dofs in the mesh and must come before any matrix or vector is made.
   LoadsPrescribe() writes the prescribed displacements; LoadsResidual() and LoadsTangent() add what forces and springs
   contribute. LoadsPrescribed() asks for imposed dofs alone, LoadsHeld() for springs too. LoadsRigidMotion() moves the
   points of rigid tools. LoadsSetShares() lets a pressure act on a part of its surface, LoadsPressure() tells how large
   it is.

   Supports may hold in some steps with names only. Such a step is a phase, and the loads are those of one phase. At its
   end LoadsChangePhase() notes what the next phase needs, and LoadsArchive() takes it to the loads of that phase. */
#pragma once
#include "bodies/elasticity.h"

typedef struct _n_Loads *Loads;

PetscErrorCode   LoadsCreate(Mesh, Scene, PetscInt phase, Loads *);
PetscErrorCode   LoadsDestroy(Loads *);
PetscErrorCode   LoadsPrescribe(Loads, PetscReal t, PetscReal *u);
PetscErrorCode   LoadsResidual(Loads, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                               PetscReal *force2);
PetscErrorCode   LoadsTangent(Loads, PetscReal t, const PetscReal *u, Elasticity);
PetscErrorCode   LoadsSetShares(Loads, int load, const PetscReal *nodes, const PetscReal *points);
PetscErrorCode   LoadsPressure(Loads, int load, PetscReal t, PetscReal *pressure);
PetscBool        LoadsConservative(Loads);
const PetscBool *LoadsConstrained(Loads);
PetscBool        LoadsPrescribed(Loads, PetscInt local_dof);
PetscBool        LoadsHeld(Loads, PetscInt local_dof);
const PetscReal *LoadsSpringForce(Loads);
void             LoadsAddSpringForces(Loads, PetscReal t, const PetscReal *u, PetscReal *forces);
PetscReal        LoadsFadingForce(Loads, PetscInt local_dof);
PetscInt         LoadsPhase(Loads);
PetscErrorCode   LoadsShowPhase(Loads, PetscInt phase);
PetscErrorCode   LoadsChangePhase(Loads, PetscInt phase, const PetscReal *u, const PetscReal *force);
PetscErrorCode   LoadsArchive(Loads, Archive);
void             LoadsRigidMotion(Loads, int body, PetscReal t, const PetscReal X[3], PetscReal x[3]);
void             LoadsRigidTurn(Loads, int body, PetscReal t, const PetscReal V[3], PetscReal v[3]);
PetscReal        LoadsRigidTravel(Loads, int body, PetscReal t0, PetscReal t1);
