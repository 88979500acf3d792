#include "matrix/sumoperator.h"

/* What the terms are called among the objects composed with the operator, which holds them so */
#define SUM_K "K"
#define SUM_C "C"

static PetscErrorCode SumOperatorGetTerms(Mat A, Mat *K, Mat *C)
{
  PetscFunctionBeginUser;
  PetscCall(PetscObjectQuery((PetscObject)A, SUM_K, (PetscObject *)K));
  PetscCall(PetscObjectQuery((PetscObject)A, SUM_C, (PetscObject *)C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SumOperatorMultiply(Mat A, Vec x, Vec y)
{
  Mat K, C;

  PetscFunctionBeginUser;
  PetscCall(SumOperatorGetTerms(A, &K, &C));
  PetscCall(MatMult(K, x, y));
  if (C) PetscCall(MatMultAdd(C, x, y, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SumOperatorCreate - Collective. Destroy it with MatDestroy(). */
PetscErrorCode SumOperatorCreate(Mat K, Mat *A)
{
  PetscInt rows, columns;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(K, &rows, &columns));
  PetscCall(MatCreateShell(PetscObjectComm((PetscObject)K), rows, columns, PETSC_DETERMINE, PETSC_DETERMINE, NULL, A));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))SumOperatorMultiply));
  PetscCall(PetscObjectCompose((PetscObject)*A, SUM_K, (PetscObject)K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SumOperatorSet - Logically collective. */
PetscErrorCode SumOperatorSet(Mat A, Mat C)
{
  PetscFunctionBeginUser;
  PetscCall(PetscObjectCompose((PetscObject)A, SUM_C, (PetscObject)C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SumOperatorMerge - Collective. */
PetscErrorCode SumOperatorMerge(Mat A, Mat *whole)
{
  PetscBool shell;
  Mat       K = NULL, C = NULL;

  PetscFunctionBeginUser;
  *whole = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSHELL, &shell));
  if (shell) PetscCall(SumOperatorGetTerms(A, &K, &C));
  if (K) PetscCall(MatDuplicate(K, MAT_COPY_VALUES, whole));
  if (K && C) PetscCall(MatAXPY(*whole, 1, C, DIFFERENT_NONZERO_PATTERN));
  PetscFunctionReturn(PETSC_SUCCESS);
}
