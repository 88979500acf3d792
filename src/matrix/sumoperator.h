/* An operator A = K + C whose terms remain two matrices, so that K needs no entries for dofs that only C couples.
   Create it with SumOperatorCreate(), and set C with SumOperatorSet(). Where a solver needs the entries,
   SumOperatorMerge() adds the two matrices. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode SumOperatorCreate(Mat K, Mat *A);
PetscErrorCode SumOperatorSet(Mat A, Mat C);
PetscErrorCode SumOperatorMerge(Mat A, Mat *whole);
