/* The inverse of A + N diag(s) N^T, computed with a factor of A. A matrix that changes by few vectors needs no new
   factor. Columns are added with RankUpdateAdd(), which solves for them; RankUpdateApply() corrects a solution with A.
 */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_RankUpdate *RankUpdate;

PetscErrorCode RankUpdateAdd(RankUpdate *, PC factored, Mat N, const PetscReal *s);
PetscErrorCode RankUpdateDestroy(RankUpdate *);
PetscErrorCode RankUpdateApply(RankUpdate, Vec x);
