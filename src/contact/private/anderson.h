/* Anderson mixing: a fixed-point iteration x <- G(x) that makes use of its last results. The vectors are spread over
   ranks, and their entries have weights. AndersonStart() begins an iteration, AndersonNext() is called after each
   evaluation of G. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_Mixing *Anderson;

PetscErrorCode AndersonCreate(MPI_Comm, PetscInt n, const PetscReal *weight, Anderson *);
PetscErrorCode AndersonDestroy(Anderson *);
void           AndersonStart(Anderson);
PetscErrorCode AndersonNext(Anderson, const PetscReal *x, PetscReal *g);
