#include "matrixrows.h"

/* MatrixRowsGet - the rows of block MATRIX_OWN or MATRIX_OTHERS of an assembled AIJ matrix, to be given back with MatrixRowsRestore(). Not collective. */
PetscErrorCode MatrixRowsGet(Mat mat, int block, MatrixRows *rows)
{
  PetscBool parallel, done;
  Mat       own = mat, others = NULL;

  PetscFunctionBeginUser;
  *rows = (MatrixRows){.mat = NULL};
  PetscCall(PetscObjectTypeCompare((PetscObject)mat, MATMPIAIJ, &parallel));
  if (parallel) PetscCall(MatMPIAIJGetSeqAIJ(mat, &own, &others, &rows->global));
  rows->mat = block == MATRIX_OWN ? own : others;
  if (block == MATRIX_OWN) rows->global = NULL;
  if (!rows->mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetRowIJ(rows->mat, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->ptr, &rows->column, &done));
  PetscCheck(done, PetscObjectComm((PetscObject)mat), PETSC_ERR_SUP, "the matrix shows no rows");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MatrixRowsRestore - Not collective. */
PetscErrorCode MatrixRowsRestore(MatrixRows *rows)
{
  PetscBool done;

  PetscFunctionBeginUser;
  if (rows->mat) PetscCall(MatRestoreRowIJ(rows->mat, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->ptr, &rows->column, &done));
  PetscFunctionReturn(PETSC_SUCCESS);
}
