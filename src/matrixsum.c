#include "matrixsum.h"
#include "matrixrows.h"

/* Merges a row of K and one of C, both ascending: columns and values of the sum; returns how many. */
static PetscInt MergeRow(PetscInt m, const PetscInt *i, const PetscScalar *a, PetscInt n, const PetscInt *j, const PetscScalar *b, PetscInt *column,
                         PetscScalar *value)
{
  PetscInt count = 0, k = 0, l = 0;

  while (k < m || l < n) {
    const PetscBool left = (PetscBool)(l == n || (k < m && i[k] <= j[l])), right = (PetscBool)(k == m || (l < n && j[l] <= i[k]));

    column[count]  = left ? i[k] : j[l];
    value[count++] = (left ? a[k] : 0) + (right ? b[l] : 0);
    k += left;
    l += right;
  }
  return count;
}

/* Calls for every row of this rank the merged row of K and C: fills in how many entries it has on this rank and on others, or sets them in the sum. */
static PetscErrorCode SumRows(Mat K, Mat C, PetscInt *own, PetscInt *others, Mat sum)
{
  PetscInt     first, end, left, right, room = 0, *column = NULL;
  PetscScalar *value = NULL;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(K, &first, &end));
  PetscCall(MatGetOwnershipRangeColumn(K, &left, &right));
  for (PetscInt row = first; row < end; row++) {
    PetscInt           m, n, count;
    const PetscInt    *i, *j;
    const PetscScalar *a, *b;

    PetscCall(MatGetRow(K, row, &m, &i, &a));
    PetscCall(MatGetRow(C, row, &n, &j, &b));
    if (m + n > room) {
      room = 2 * (m + n);
      PetscCall(PetscFree2(column, value));
      PetscCall(PetscMalloc2(room, &column, room, &value));
    }
    count = MergeRow(m, i, a, n, j, b, column, value);
    PetscCall(MatRestoreRow(C, row, &n, &j, &b));
    PetscCall(MatRestoreRow(K, row, &m, &i, &a));
    if (sum) {
      PetscCall(MatSetValues(sum, 1, &row, count, column, value, INSERT_VALUES));
      continue;
    }
    own[row - first] = 0;
    for (PetscInt k = 0; k < count; k++) own[row - first] += column[k] >= left && column[k] < right;
    others[row - first] = count - own[row - first];
  }
  PetscCall(PetscFree2(column, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MatrixSumCreate - K + C in a new matrix, with the pattern of both. The caller destroys it.

   Collective. K, C: assembled AIJ matrices of the same rows on every rank. */
PetscErrorCode MatrixSumCreate(Mat K, Mat C, Mat *sum)
{
  PetscInt m, n, *own, *others;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(K, &m, &n));
  PetscCall(PetscMalloc2(m, &own, m, &others));
  PetscCall(SumRows(K, C, own, others, NULL));
  PetscCall(MatCreate(PetscObjectComm((PetscObject)K), sum));
  PetscCall(MatSetSizes(*sum, m, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*sum, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(*sum, 1, own, others, NULL, NULL));
  PetscCall(MatSetOption(*sum, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(MatSetOption(*sum, MAT_SORTED_FULL, PETSC_TRUE));
  PetscCall(SumRows(K, C, NULL, NULL, *sum));
  PetscCall(MatAssemblyBegin(*sum, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*sum, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(own, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscInt Column(const MatrixRows *rows, PetscInt k)
{
  return rows->global ? rows->global[rows->column[k]] : rows->column[k];
}

/* y += x row by row, both ascending; every entry of x is in y. */
static PetscErrorCode RowsAdd(const MatrixRows *x, const PetscScalar *from, const MatrixRows *y, PetscScalar *to)
{
  PetscFunctionBeginUser;
  for (PetscInt row = 0; row < x->n; row++) {
    PetscInt at = y->ptr[row];

    for (PetscInt k = x->ptr[row]; k < x->ptr[row + 1]; k++, at++) {
      while (at < y->ptr[row + 1] && Column(y, at) < Column(x, k)) at++;
      PetscCheck(at < y->ptr[row + 1] && Column(y, at) == Column(x, k), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "row %" PetscInt_FMT " of the sum lacks an entry", row);
      to[at] += from[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block of sum := K + C. */
static PetscErrorCode BlockUpdate(Mat K, Mat C, Mat sum, int block)
{
  const Mat    terms[2] = {K, C};
  MatrixRows   y, x;
  PetscScalar *to;

  PetscFunctionBeginUser;
  PetscCall(MatrixRowsGet(sum, block, &y));
  if (!y.mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatSeqAIJGetArray(y.mat, &to));
  PetscCall(PetscArrayzero(to, y.ptr[y.n]));
  for (int i = 0; i < 2; i++) {
    const PetscScalar *from;

    PetscCall(MatrixRowsGet(terms[i], block, &x));
    PetscCall(MatSeqAIJGetArrayRead(x.mat, &from));
    PetscCall(RowsAdd(&x, from, &y, to));
    PetscCall(MatSeqAIJRestoreArrayRead(x.mat, &from));
    PetscCall(MatrixRowsRestore(&x));
  }
  PetscCall(MatSeqAIJRestoreArray(y.mat, &to));
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
