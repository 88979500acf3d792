/* Node matrix: the matrix equals the sum of the ranks' blocks of nodes, on any number of ranks, also where another
   matrix has joined its pattern. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "matrix/matrixrows.h"
#include "matrix/nodematrix.h"
#include "matrix/widematrix.h"

/* ROWS: rows of each rank, whose first node lacks one dof */
enum { SIZE = 2, NODES = 4, ROWS = SIZE * NODES - 1 };

/* Nodes of a rank: its own nodes, in reverse order, and the first two of the next rank. A node is coupled to itself and
   to its neighbours in the list. */
typedef struct {
  PetscInt  dof[(NODES + 2) * SIZE], ptr[NODES + 3], column[3 * (NODES + 2)];
  PetscReal value[3 * (NODES + 2) * SIZE * SIZE];
  NodePairs pairs;
} List;

static PetscInt Dof(PetscMPIInt rank, PetscInt node, PetscInt d)
{
  return node || d ? rank * ROWS + node * SIZE + d - 1 : -1;
}

static void MakeList(List *list)
{
  PetscMPIInt rank, size;
  PetscInt    n = 0;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  list->pairs = (NodePairs){SIZE, size > 1 ? NODES + 2 : NODES, list->dof, list->ptr, list->column};
  for (PetscInt i = 0; i < list->pairs.n; i++)
    for (PetscInt d = 0; d < SIZE; d++)
      list->dof[i * SIZE + d] = i < NODES ? Dof(rank, NODES - 1 - i, d) : Dof((rank + 1) % size, i - NODES, d);
  for (PetscInt i = 0; i < list->pairs.n; i++) {
    list->ptr[i] = n;
    for (PetscInt j = PetscMax(0, i - 1); j <= PetscMin(list->pairs.n - 1, i + 1); j++) list->column[n++] = j;
  }
  list->ptr[list->pairs.n] = n;
  for (PetscInt k = 0; k < n * SIZE * SIZE; k++) list->value[k] = 1 + k + 100 * rank;
}

/* Computes the same sum with MatSetValues(). */
static Mat Expected(const List *list)
{
  Mat mat;

  assert_int_equal(MatCreate(PETSC_COMM_WORLD, &mat), 0);
  assert_int_equal(MatSetSizes(mat, ROWS, ROWS, PETSC_DETERMINE, PETSC_DETERMINE), 0);
  assert_int_equal(MatSetType(mat, MATAIJ), 0);
  assert_int_equal(MatSetUp(mat), 0);
  assert_int_equal(MatSetOption(mat, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE), 0);
  for (PetscInt i = 0; i < list->pairs.n; i++)
    for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++)
      assert_int_equal(MatSetValues(mat, SIZE, &list->dof[i * SIZE], SIZE, &list->dof[list->column[k] * SIZE],
                                    &list->value[k * SIZE * SIZE], ADD_VALUES),
                       0);
  assert_int_equal(MatAssemblyBegin(mat, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(MatAssemblyEnd(mat, MAT_FINAL_ASSEMBLY), 0);
  return mat;
}

/* Asserts that mat is a + b; with b NULL, that it is a. */
static void AssertSum(Mat mat, Mat a, Mat b)
{
  Mat       rest;
  PetscReal norm;

  assert_int_equal(MatDuplicate(mat, MAT_COPY_VALUES, &rest), 0);
  assert_int_equal(MatAXPY(rest, -1, a, DIFFERENT_NONZERO_PATTERN), 0);
  if (b) assert_int_equal(MatAXPY(rest, -1, b, DIFFERENT_NONZERO_PATTERN), 0);
  assert_int_equal(MatNorm(rest, NORM_FROBENIUS, &norm), 0);
  assert_true(norm == 0);
  assert_int_equal(MatDestroy(&rest), 0);
}

static void AssertDiagonal(Vec diagonal, Mat a)
{
  Vec       expected;
  PetscBool same;

  assert_int_equal(VecDuplicate(diagonal, &expected), 0);
  assert_int_equal(MatGetDiagonal(a, expected), 0);
  assert_int_equal(VecEqual(diagonal, expected, &same), 0);
  assert_true(same);
  assert_int_equal(VecDestroy(&expected), 0);
}

static void test_sum(void **state)
{
  List       narrow, wide;
  NodeMatrix matrix, other;
  Mat        a, b, mat;
  Vec        diagonal;

  (void)state;
  MakeList(&narrow);
  MakeList(&wide);
  wide.column[0] = 3; /* one pair that `narrow` does not have, out of order */
  a              = Expected(&narrow);
  b              = Expected(&wide);
  assert_int_equal(NodeMatrixCreate(PETSC_COMM_WORLD, ROWS, &narrow.pairs, &matrix), 0);
  assert_int_equal(NodeMatrixCreate(PETSC_COMM_WORLD, ROWS, &wide.pairs, &other), 0);
  assert_int_equal(NodeMatrixJoin(matrix, NULL), 0);
  assert_int_equal(NodeMatrixJoin(other, NULL), 0);
  assert_int_equal(NodeMatrixSet(matrix, narrow.value, NULL, NULL), 0);
  assert_int_equal(NodeMatrixSet(other, wide.value, NULL, NULL), 0);
  mat = NodeMatrixGet(matrix);
  assert_int_equal(MatCreateVecs(mat, &diagonal, NULL), 0);
  AssertSum(mat, a, NULL);
  AssertSum(NodeMatrixGet(other), b, NULL);
  for (int pass = 0; pass < 2; pass++) {
    assert_int_equal(NodeMatrixJoin(matrix, NodeMatrixGet(other)), 0);
    for (int again = 0; again < 2; again++) {
      assert_int_equal(NodeMatrixSet(matrix, narrow.value, NULL, NULL), 0);
      AssertSum(mat, a, NULL);
      assert_int_equal(NodeMatrixSet(matrix, narrow.value, NodeMatrixGet(other), diagonal), 0);
      AssertSum(mat, a, b);
      AssertDiagonal(diagonal, a);
    }
  }
  assert_true(NodeMatrixGet(matrix) == mat);
  assert_int_equal(NodeMatrixJoin(matrix, NULL), 0);
  assert_int_equal(NodeMatrixSet(matrix, narrow.value, NULL, NULL), 0);
  AssertSum(mat, a, NULL);
  assert_int_equal(NodeMatrixDestroy(&matrix), 0);
  assert_int_equal(NodeMatrixDestroy(&other), 0);
  assert_int_equal(MatDestroy(&a), 0);
  assert_int_equal(MatDestroy(&b), 0);
  assert_int_equal(VecDestroy(&diagonal), 0);
}

/* The symbolic part of a factorisation is kept as long as the pattern is the same. */
static void test_pattern_stays(void **state)
{
  List             list;
  NodeMatrix       matrix;
  PetscObjectState before, after;

  (void)state;
  MakeList(&list);
  assert_int_equal(NodeMatrixCreate(PETSC_COMM_WORLD, ROWS, &list.pairs, &matrix), 0);
  assert_int_equal(NodeMatrixJoin(matrix, NULL), 0);
  assert_int_equal(NodeMatrixSet(matrix, list.value, NULL, NULL), 0);
  assert_int_equal(MatGetNonzeroState(NodeMatrixGet(matrix), &before), 0);
  assert_int_equal(NodeMatrixSet(matrix, list.value, NULL, NULL), 0);
  assert_int_equal(MatGetNonzeroState(NodeMatrixGet(matrix), &after), 0);
  assert_true(before == after);
  assert_int_equal(NodeMatrixDestroy(&matrix), 0);
}

/* The matrix over all dofs of the nodes, with the diagonal of the one that each rank leaves out, plus a multiple of a
   matrix. */
static Mat Widened(Mat a, PetscReal diagonal, PetscReal factor, Mat b)
{
  const Mat from[2] = {a, b};
  Mat       wide;
  PetscInt  begin, end, row;

  assert_int_equal(MatCreateAIJ(PETSC_COMM_WORLD, ROWS + 1, ROWS + 1, PETSC_DETERMINE, PETSC_DETERMINE, 4 * NODES, NULL,
                                4 * NODES, NULL, &wide),
                   0);
  assert_int_equal(MatGetOwnershipRange(a, &begin, &end), 0);
  for (int m = 0; m < 2; m++) {
    for (PetscInt r = begin; r < end; r++) {
      const PetscInt    *column, to = r + r / ROWS + 1;
      const PetscScalar *value;
      PetscInt           n;

      assert_int_equal(MatGetRow(from[m], r, &n, &column, &value), 0);
      for (PetscInt k = 0; k < n; k++)
        assert_int_equal(
          MatSetValue(wide, to, column[k] + column[k] / ROWS + 1, m ? factor * value[k] : value[k], ADD_VALUES), 0);
      assert_int_equal(MatRestoreRow(from[m], r, &n, &column, &value), 0);
    }
  }
  row = begin + begin / ROWS;
  assert_int_equal(MatSetValue(wide, row, row, diagonal, ADD_VALUES), 0);
  assert_int_equal(MatAssemblyBegin(wide, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(MatAssemblyEnd(wide, MAT_FINAL_ASSEMBLY), 0);
  return wide;
}

/* Numbers of a matrix's columns of other ranks among all dofs; each rank leaves out its first dof. */
static PetscInt *Ghosts(Mat mat)
{
  MatrixRows others;
  PetscInt   n, *ghost;

  assert_int_equal(MatrixRowsGet(mat, MATRIX_OTHERS, &others), 0);
  if (!others.mat) return NULL;
  assert_int_equal(MatGetSize(others.mat, NULL, &n), 0);
  assert_int_equal(PetscMalloc1(n, &ghost), 0);
  for (PetscInt k = 0; k < n; k++) ghost[k] = others.global[k] + others.global[k] / ROWS + 1;
  assert_int_equal(MatrixRowsRestore(&others), 0);
  return ghost;
}

/* Sets the values between different nodes to 0. */
static void Uncouple(List *list)
{
  for (PetscInt i = 0; i < list->pairs.n; i++)
    for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++)
      for (int c = 0; c < SIZE * SIZE && list->column[k] != i; c++) list->value[k * SIZE * SIZE + c] = 0;
}

/* Makes the wide matrix, asserts that it is the expected one, and returns the number of its entries. */
static PetscInt WideEntries(WideMatrix loan, PetscBool full, Mat expected)
{
  Mat     wide;
  MatInfo info;

  assert_int_equal(WideMatrixCreate(loan, full, &wide), 0);
  AssertSum(wide, expected, NULL);
  assert_int_equal(MatGetInfo(wide, MAT_LOCAL, &info), 0);
  assert_int_equal(MatDestroy(&wide), 0);
  return (PetscInt)info.nz_used;
}

/* A wide matrix has the lender's entries, with or without those that another matrix alone has; afterwards the lender is
   what it was, to the last bit. */
static void test_wide(void **state)
{
  const PetscReal diagonal = 7, factor = -0.25; /* without rounding */
  PetscInt        row[ROWS], entries;
  List            list, bodies;
  NodeMatrix      matrix, other;
  WideMatrix      loan;
  Mat             a, mat, expected, alone;

  (void)state;
  MakeList(&list);
  MakeList(&bodies);
  Uncouple(&bodies);
  for (PetscInt r = 0; r < ROWS; r++) row[r] = r + 1;
  assert_int_equal(NodeMatrixCreate(PETSC_COMM_WORLD, ROWS, &list.pairs, &matrix), 0);
  assert_int_equal(NodeMatrixCreate(PETSC_COMM_WORLD, ROWS, &list.pairs, &other), 0);
  assert_int_equal(NodeMatrixJoin(other, NULL), 0);
  assert_int_equal(NodeMatrixSet(other, list.value, NULL, NULL), 0);
  assert_int_equal(NodeMatrixJoin(matrix, NodeMatrixGet(other)), 0);
  assert_int_equal(NodeMatrixSet(matrix, bodies.value, NodeMatrixGet(other), NULL), 0);
  mat      = NodeMatrixGet(matrix);
  expected = Widened(mat, diagonal, factor, NodeMatrixGet(other));
  alone    = Widened(mat, diagonal, -1, NodeMatrixGet(other));
  assert_int_equal(MatDuplicate(mat, MAT_COPY_VALUES, &a), 0);
  for (int again = 0; again < 2; again++) {
    assert_int_equal(WideMatrixBorrow(mat, &(WideRows){ROWS + 1, row, Ghosts(mat), diagonal}, SIZE, &loan), 0);
    assert_int_equal(WideMatrixAdd(loan, -1, NodeMatrixGet(other)), 0);
    entries = WideEntries(loan, PETSC_FALSE, alone);
    assert_int_equal(WideEntries(loan, PETSC_FALSE, alone), entries);
    assert_int_equal(WideMatrixAdd(loan, factor, NodeMatrixGet(other)), 0);
    assert_true(WideEntries(loan, PETSC_TRUE, expected) > entries);
    if (again) (void)WideEntries(loan, PETSC_FALSE, expected);
    assert_int_equal(WideMatrixReturn(&loan), 0);
    AssertSum(mat, a, NULL);
  }
  assert_int_equal(MatDestroy(&a), 0);
  assert_int_equal(MatDestroy(&expected), 0);
  assert_int_equal(MatDestroy(&alone), 0);
  assert_int_equal(NodeMatrixDestroy(&matrix), 0);
  assert_int_equal(NodeMatrixDestroy(&other), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sum), cmocka_unit_test(test_pattern_stays),
                                     cmocka_unit_test(test_wide)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
