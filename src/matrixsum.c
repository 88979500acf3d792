#include "matrixsum.h"
#include "matrixrows.h"

static inline PetscInt Column(const MatrixRows *rows, PetscInt k)
{
  return rows->global ? rows->global[rows->column[k]] : rows->column[k];
}

/* Merges one row of a block of K and of C, both ascending: columns, counted on from `first`, and values of the sum (NULL: not wanted); returns how many.
   Most rows of C are empty: contact is on surfaces. */
static PetscInt MergeRow(PetscInt row, const MatrixRows *K, const PetscScalar *a, const MatrixRows *C, const PetscScalar *b, PetscInt first, PetscInt *column,
                         PetscScalar *value)
{
  const PetscInt k_end = K->ptr[row + 1], l_end = C->ptr[row + 1];
  PetscInt       count = 0, k = K->ptr[row], l = C->ptr[row];

  while (l < l_end) {
    const PetscInt  of_K = k < k_end ? Column(K, k) : PETSC_MAX_INT, of_C = Column(C, l);
    const PetscBool left = (PetscBool)(of_K <= of_C), right = (PetscBool)(of_C <= of_K);

    if (column) {
      column[count] = first + (left ? of_K : of_C);
      value[count]  = (left ? a[k] : 0) + (right ? b[l] : 0);
    }
    count++;
    k += left;
    l += right;
  }
  for (PetscInt i = 0; column && i < k_end - k; i++) {
    column[count + i] = first + Column(K, k + i);
    value[count + i]  = a[k + i];
  }
  return count + k_end - k;
}

/* Goes through one block's rows of K + C: fills in how many entries each has, or sets them in the sum. */
static PetscErrorCode SumBlock(Mat K, Mat C, int block, PetscInt *count, Mat sum)
{
  MatrixRows         x, y;
  PetscInt           row_first, first = 0, room = 0, *column = NULL;
  PetscScalar       *value = NULL;
  const PetscScalar *a, *b;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(K, block, &x));
  if (!x.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatrixRowsGet(C, block, &y));
  PetscCall(MatGetOwnershipRange(K, &row_first, NULL));
  if (block == MATRIX_OWN) PetscCall(MatGetOwnershipRangeColumn(K, &first, NULL));
  PetscCall(MatSeqAIJGetArrayRead(x.mat, &a));
  PetscCall(MatSeqAIJGetArrayRead(y.mat, &b));
  for (PetscInt row = 0; row < x.n; row++) room = PetscMax(room, x.ptr[row + 1] - x.ptr[row] + y.ptr[row + 1] - y.ptr[row]);
  if (sum) PetscCall(PetscMalloc2(room, &column, room, &value));
  for (PetscInt row = 0; row < x.n; row++) {
    const PetscInt n = MergeRow(row, &x, a, &y, b, first, column, value), global = row_first + row;

    if (sum)
      PetscCall(MatSetValues(sum, 1, &global, n, column, value, INSERT_VALUES));
    else
      count[row] = n;
  }
  PetscCall(PetscFree2(column, value));
  PetscCall(MatSeqAIJRestoreArrayRead(y.mat, &b));
  PetscCall(MatSeqAIJRestoreArrayRead(x.mat, &a));
  PetscCall(MatrixRowsRestore(&y));
  PetscCall(MatrixRowsRestore(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MatrixSumCreate - K + C in a new matrix, with the pattern of both. The caller destroys it.

   Collective. K, C: assembled AIJ matrices of the same rows on every rank. */
PetscErrorCode MatrixSumCreate(Mat K, Mat C, Mat *sum)
{
  PetscInt m, n, *count[MATRIX_BLOCKS];

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(K, &m, &n));
  PetscCall(PetscCalloc2(m, &count[MATRIX_OWN], m, &count[MATRIX_OTHERS]));
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(SumBlock(K, C, block, count[block], NULL));
  PetscCall(MatCreate(PetscObjectComm((PetscObject)K), sum));
  PetscCall(MatSetSizes(*sum, m, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*sum, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(*sum, 1, count[MATRIX_OWN], count[MATRIX_OTHERS], NULL, NULL));
  PetscCall(MatSetOption(*sum, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(MatSetOption(*sum, MAT_SORTED_FULL, PETSC_TRUE));
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(SumBlock(K, C, block, NULL, *sum));
  PetscCall(MatAssemblyBegin(*sum, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*sum, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(count[MATRIX_OWN], count[MATRIX_OTHERS]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += x in one row, both ascending; every entry of x is in y. */
static PetscErrorCode RowAdd(PetscInt row, const MatrixRows *x, const PetscScalar *from, const MatrixRows *y, PetscScalar *to)
{
  PetscInt at = y->ptr[row];

  PetscFunctionBeginUser;
  for (PetscInt k = x->ptr[row]; k < x->ptr[row + 1]; k++, at++) {
    while (at < y->ptr[row + 1] && Column(y, at) < Column(x, k)) at++;
    PetscCheck(at < y->ptr[row + 1] && Column(y, at) == Column(x, k), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "row %" PetscInt_FMT " of the sum lacks an entry", row);
    to[at] += from[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block of sum := K + C. A row of the sum that is as long as K's is K's: most rows, as contact is on surfaces. */
static PetscErrorCode BlockUpdate(Mat K, Mat C, Mat sum, int block)
{
  MatrixRows         y, x, z;
  PetscScalar       *to;
  const PetscScalar *a, *b;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(sum, block, &y));
  if (!y.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatrixRowsGet(K, block, &x));
  PetscCall(MatrixRowsGet(C, block, &z));
  PetscCall(MatSeqAIJGetArray(y.mat, &to));
  PetscCall(MatSeqAIJGetArrayRead(x.mat, &a));
  PetscCall(MatSeqAIJGetArrayRead(z.mat, &b));
  for (PetscInt row = 0; row < y.n; row++) {
    const PetscInt n = y.ptr[row + 1] - y.ptr[row];

    if (n == x.ptr[row + 1] - x.ptr[row])
      PetscCall(PetscArraycpy(&to[y.ptr[row]], &a[x.ptr[row]], n));
    else {
      PetscCall(PetscArrayzero(&to[y.ptr[row]], n));
      PetscCall(RowAdd(row, &x, a, &y, to));
    }
    PetscCall(RowAdd(row, &z, b, &y, to));
  }
  PetscCall(MatSeqAIJRestoreArrayRead(z.mat, &b));
  PetscCall(MatSeqAIJRestoreArrayRead(x.mat, &a));
  PetscCall(MatSeqAIJRestoreArray(y.mat, &to));
  PetscCall(MatrixRowsRestore(&z));
  PetscCall(MatrixRowsRestore(&x));
  PetscCall(MatrixRowsRestore(&y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MatrixSumUpdate - values of the sum from those of its terms.

   Collective. K, C, sum: AIJ matrices of the same rows on every rank; the pattern of sum holds those of both, other entries become 0. */
PetscErrorCode MatrixSumUpdate(Mat K, Mat C, Mat sum)
{
  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(BlockUpdate(K, C, sum, block));
  PetscCall(MatAssemblyBegin(sum, MAT_FINAL_ASSEMBLY)); /* nothing moves: it tells the solver that values are new */
  PetscCall(MatAssemblyEnd(sum, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
