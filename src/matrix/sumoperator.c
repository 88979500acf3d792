/* Sum of two matrices as a shell matrix, which holds both as composed objects. */
#include "matrix/sumoperator.h"
#include "matrix/blockfactors.h"

/* Names of the terms among the objects that are composed with the operator. The operator keeps references to them in
   this way. */
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

/*@
  SumOperatorCreate - creates the operator A = K + C, at first without C.

  Collective

  Input Parameter:
. K - AIJ matrix; its values may change later

  Output Parameter:
. A - shell matrix, destroyed with MatDestroy()
@*/
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

/*@
  SumOperatorSet - sets the other term of the operator.

  Logically collective

  Input Parameters:
+ A - the operator, from SumOperatorCreate()
- C - matrix of the layout of K, which may be one of BlockFactorsGet(), used with the values that it has when the
operator is applied; NULL: no other term
@*/
PetscErrorCode SumOperatorSet(Mat A, Mat C)
{
  PetscFunctionBeginUser;
  PetscCall(PetscObjectCompose((PetscObject)A, SUM_C, (PetscObject)C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SumOperatorMerge - computes K + C as one AIJ matrix.

  Collective

  Input Parameter:
. A - the operator, or any other matrix

  Output Parameter:
. whole - destroyed by the caller; NULL if A is not such an operator
@*/
PetscErrorCode SumOperatorMerge(Mat A, Mat *whole)
{
  PetscBool shell;
  Mat       K = NULL, C = NULL, formed = NULL;

  PetscFunctionBeginUser;
  *whole = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSHELL, &shell));
  if (shell) PetscCall(SumOperatorGetTerms(A, &K, &C));
  if (K) PetscCall(MatDuplicate(K, MAT_COPY_VALUES, whole));
  if (K && C) PetscCall(BlockFactorsForm(C, &formed));
  if (K && C) PetscCall(MatAXPY(*whole, 1, formed ? formed : C, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&formed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
