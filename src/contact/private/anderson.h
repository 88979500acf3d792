/* Anderson mixing: a fixed-point iteration x <- G(x) that makes use of its last results. The vectors are spread over ranks; entries have weights. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_Mixing *Mixing;

PetscErrorCode MixingCreate(MPI_Comm, PetscInt n, const PetscReal *weight, Mixing *); /* weight[n] is borrowed */
PetscErrorCode MixingDestroy(Mixing *);
void           MixingStart(Mixing); /* of another iteration. Not collective */
/* x[n]: what was put in; g[n]: G(x), replaced by what is to be put in next. Collective. */
PetscErrorCode MixingNext(Mixing, const PetscReal *x, PetscReal *g);
