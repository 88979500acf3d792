/* Rows of an assembled AIJ matrix, read in place. */
#include "matrix/matrixrows.h"

/*@
  MatrixRowsGet - returns the rows of one block of an assembled AIJ matrix.

  Not collective

  Input Parameters:
+ mat   - sequential or parallel AIJ matrix
- block - MATRIX_OWN or MATRIX_OTHERS

  Output Parameter:
. rows - the rows, to be returned with MatrixRowsRestore(); rows->mat is NULL where there is no such block
@*/
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
  PetscCall(MatSeqAIJGetArrayRead(rows->mat, &rows->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MatrixRowsRestore - returns the rows to the matrix.

  Not collective

  Input Parameter:
. rows - from MatrixRowsGet()
@*/
PetscErrorCode MatrixRowsRestore(MatrixRows *rows)
{
  PetscBool done;

  PetscFunctionBeginUser;
  if (rows->mat) PetscCall(MatSeqAIJRestoreArrayRead(rows->mat, &rows->value));
  if (rows->mat)
    PetscCall(MatRestoreRowIJ(rows->mat, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->ptr, &rows->column, &done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether two rows have the same columns. */
static PetscBool AreAlike(const MatrixRows rows[MATRIX_BLOCKS], PetscInt r, PetscInt s)
{
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    const PetscInt n = rows[b].mat ? rows[b].ptr[r + 1] - rows[b].ptr[r] : 0;

    if (!rows[b].mat) continue;
    if (rows[b].ptr[s + 1] - rows[b].ptr[s] != n ||
        memcmp(&rows[b].column[rows[b].ptr[r]], &rows[b].column[rows[b].ptr[s]], n * sizeof(PetscInt)))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/*@
  MatrixRowsAlike - counts how many rows, from one row on, have the same columns in all blocks: the rows of one node.

  Not collective

  Input Parameters:
+ rows - both blocks
- row  - first row

  Note:
  Returns at least 1 and at most MATRIX_NODE_ROWS.
@*/
PetscInt MatrixRowsAlike(const MatrixRows rows[MATRIX_BLOCKS], PetscInt row)
{
  PetscInt n = 1;

  while (n < MATRIX_NODE_ROWS && row + n < rows[MATRIX_OWN].n && AreAlike(rows, row, row + n)) n++;
  return n;
}
