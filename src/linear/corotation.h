/* How the bodies have turned, node by node, since an earlier state. A body's tangent turns with it, and a slender one
   turns by far more than it strains: what a factor of an older tangent makes of forces turned back, turned on again, is
   a better solution than what it makes of the forces as they are. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_NodeTurn *Corotation;

/* Borrows the mesh, whose constraints need not be set yet. Collective. */
PetscErrorCode CorotationCreate(Mesh, Corotation *);
PetscErrorCode CorotationDestroy(Corotation *);
/* The present state: local displacements u. Not collective. */
PetscErrorCode CorotationMove(Corotation, const PetscReal *u);
/* Turns count from the present state on. Not collective. */
PetscErrorCode CorotationBegin(Corotation);
/* Finds the turns from there to the present state. Collective. */
PetscErrorCode CorotationFind(Corotation);
/* Turns a vector over the free dofs along, or back. Not collective. */
PetscErrorCode CorotationApply(Corotation, PetscBool back, Vec x);
