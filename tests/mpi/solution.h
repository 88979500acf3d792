/* What tests of factors share. */
#pragma once
#include "linear/factor.h"

/* Relative residual of a solution */
static PetscErrorCode SolutionMiss(Factor factor, Mat A, PetscReal *miss)
{
  PetscReal right;
  Vec       b, x, r;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(VecSet(b, 1));
  PetscCall(FactorSolve(factor, b, x));
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, miss));
  PetscCall(VecNorm(b, NORM_2, &right));
  *miss /= right;
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
