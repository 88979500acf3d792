/* The inverse of A + N diag(s) N^T by a factor of A: what changes by few vectors needs no new factor. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_RankUpdate *RankUpdate;

/* More columns; the first ones make the update, until then NULL. factored: with the factor of A
 * (DirectSolverColumns()); N: dense; s[columns of N]: the same on all ranks. Collective. */
PetscErrorCode RankUpdateAdd(RankUpdate *, PC factored, Mat N, const PetscReal *s);
PetscErrorCode RankUpdateDestroy(RankUpdate *);
/* x = A^-1 b becomes (A + N diag(s) N^T)^-1 b; it stays where that sum is singular. Collective. */
PetscErrorCode RankUpdateApply(RankUpdate, Vec x);
