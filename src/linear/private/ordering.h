/* The order in which a sparse matrix is eliminated: nested dissection by METIS, of the graph of its nodes. */
#pragma once
#include "base/petsccompat.h"

/* position[global rows of A] on the first rank, from 0; NULL on the others. A: AIJ, of symmetric pattern. The caller
 * frees it. Collective. */
PetscErrorCode OrderingFind(Mat A, PetscInt **position);
