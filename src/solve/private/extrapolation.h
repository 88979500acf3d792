/* Where a run has come along, from which the next step is foretold: bodies that turn go on turning, which a tangent takes for a straight line. */
#pragma once
#include "files/archive.h"
#include "mesh/mesh.h"

typedef struct _n_Path *Path;

/* No state is known at first. The mesh is borrowed. Not collective. */
PetscErrorCode PathCreate(Mesh, Path *);
PetscErrorCode PathDestroy(Path *);
/* The state (u, t) has been accepted; t grows. Not collective. */
PetscErrorCode PathAdd(Path, const PetscReal *u, PetscReal t);
/* Of what was, only the last state counts: things go another way now. Not collective. */
PetscErrorCode PathForget(Path);
/* Displacements to be expected at t, and whether the last state was where this would have expected it. Collective. */
PetscErrorCode PathForesee(Path, PetscReal t, PetscReal *u, PetscBool *smooth);
/* Saves or restores what is known beside the last state u. nodes: the rows of the local nodes. Collective. */
PetscErrorCode PathArchive(Path, Archive, const Rows *nodes, const PetscReal *u);
