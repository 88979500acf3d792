/* Anderson mixing: a fixed-point iteration x <- G(x) that makes use of its last results. The vectors are spread over
 * ranks; entries have weights. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_Mixing *Anderson;

PetscErrorCode AndersonCreate(MPI_Comm, PetscInt n, const PetscReal *weight, Anderson *); /* weight[n] is borrowed */
PetscErrorCode AndersonDestroy(Anderson *);
void           AndersonStart(Anderson); /* of another iteration. Not collective */
/* x[n]: what was put in; g[n]: G(x), replaced by what is to be put in next. Collective. */
PetscErrorCode AndersonNext(Anderson, const PetscReal *x, PetscReal *g);
