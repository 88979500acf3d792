/* The rotations of the bodies, node by node, since an earlier state.

   The tangent of a body rotates with the body, and a slender body rotates by far more than it strains. An older
   tangent's factor therefore finds a better solution if forces are rotated back before it is applied and displacements
   are rotated forward after it (reusedfactor.h).

   Call CorotationMove() with each new state, CorotationBegin() where rotations shall begin, CorotationFind() to compute
   them, and CorotationApply() to rotate vectors. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_Corotation *Corotation;

PetscErrorCode CorotationCreate(Mesh, Corotation *);
PetscErrorCode CorotationDestroy(Corotation *);
PetscErrorCode CorotationMove(Corotation, const PetscReal *u);
PetscErrorCode CorotationBegin(Corotation);
PetscErrorCode CorotationFind(Corotation);
PetscErrorCode CorotationApply(Corotation, PetscBool back, Vec x);
