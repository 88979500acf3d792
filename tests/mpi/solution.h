/* What tests of factors share. */
#pragma once
#include "linear/factor.h"

/* Relative residual of a solution. transposed: that with the transposed matrix */
static PetscErrorCode SolutionMiss(Factor factor, Mat A, PetscBool transposed, PetscReal *miss)
{
  PetscReal right;
  Vec       b, x, r;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(VecSet(b, 1));
  PetscCall((transposed ? FactorSolveTransposed : FactorSolve)(factor, b, x));
  PetscCall((transposed ? MatMultTranspose : MatMult)(A, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, miss));
  PetscCall(VecNorm(b, NORM_2, &right));
  *miss /= right;
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
