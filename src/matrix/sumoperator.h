/* An operator A = K + C whose terms stay two matrices: what is coupled in C alone needs no place in K. Where somebody
 * wants its entries they are merged. */
#pragma once
#include "base/petsccompat.h"

/* A shell over an AIJ matrix K, whose values may change. Collective. */
PetscErrorCode SumOperatorCreate(Mat K, Mat *A);
/* The other term from now on, of the same layout, as it is when the operator is used; NULL: none. Logically collective.
 */
PetscErrorCode SumOperatorSet(Mat A, Mat C);
/* K + C in one AIJ matrix, which the caller destroys; NULL: A is no such operator. Collective. */
PetscErrorCode SumOperatorMerge(Mat A, Mat *whole);
