/* How the bodies have turned, node by node, since an earlier state. A body's tangent turns with it, and a slender one turns by far more than it strains: what a
   factor of an older tangent makes of forces turned back, turned on again, is a better solution than what it makes of the forces as they are. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_NodeTurn *NodeTurn;

/* Borrows the mesh, whose constraints need not be set yet. Collective. */
PetscErrorCode NodeTurnCreate(Mesh, NodeTurn *);
PetscErrorCode NodeTurnDestroy(NodeTurn *);
/* The present state: local displacements u. Not collective. */
PetscErrorCode NodeTurnMove(NodeTurn, const PetscReal *u);
/* Turns count from the present state on. Not collective. */
PetscErrorCode NodeTurnBegin(NodeTurn);
/* Finds the turns from there to the present state. Collective. */
PetscErrorCode NodeTurnFind(NodeTurn);
/* Turns a vector over the free dofs along, or back. Not collective. */
PetscErrorCode NodeTurnApply(NodeTurn, PetscBool back, Vec x);
