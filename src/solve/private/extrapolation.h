/* Where a run has come along, from which the next step is foretold: bodies that turn go on turning, which a tangent
 * takes for a straight line. */
#pragma once
#include "files/archive.h"
#include "mesh/mesh.h"

typedef struct _n_Path *Extrapolation;

/* No state is known at first. The mesh is borrowed. Not collective. */
PetscErrorCode ExtrapolationCreate(Mesh, Extrapolation *);
PetscErrorCode ExtrapolationDestroy(Extrapolation *);
/* The state (u, t) has been accepted; t grows. Not collective. */
PetscErrorCode ExtrapolationAdd(Extrapolation, const PetscReal *u, PetscReal t);
/* Of what was, only the last state counts: things go another way now. Not collective. */
PetscErrorCode ExtrapolationForget(Extrapolation);
/* Displacements to be expected at t, and whether the last state was where this would have expected it. Collective. */
PetscErrorCode ExtrapolationEvaluate(Extrapolation, PetscReal t, PetscReal *u, PetscBool *smooth);
/* Saves or restores what is known beside the last state u. nodes: the rows of the local nodes. Collective. */
PetscErrorCode ExtrapolationArchive(Extrapolation, Archive, const Hdf5Table *nodes, const PetscReal *u);
