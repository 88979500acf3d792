/* Block matrix: blocks that are assembled on any number of ranks give the same product as the blocks themselves, also
   with rows that are not symmetric. The
   pattern is kept while it contains the blocks, and can be restored to a marked one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "base/lanes.h"
#include "matrix/blockfactors.h"
#include "matrix/blockmatrix.h"

enum { ROWS = 6 }; /* rows of each rank */

/* Each rank adds two blocks, the second of them v v^T, over two of its own dofs, one dof of the next rank, and one
   entry without a dof, in the order of the blocks. */
static void AddBlocks(BlockMatrix blocks, int node, const PetscInt *dof, PetscReal scale, const PetscReal *in,
                      PetscReal *out, Mat *matrix, PetscBool *changed)
{
  const PetscInt        n = 4 / node, *nodes;
  PetscInt              count;
  const PetscInt *const lists[] = {dof};
  PetscReal             value[16 + BLOCK_PADDING], vector[4 + BLOCK_PADDING];

  for (int i = 0; i < BLOCK_PADDING; i++) value[16 + i] = vector[4 + i] = NAN;
  assert_int_equal(BlockMatrixBegin(blocks, 1, &n, lists), 0);
  assert_int_equal(BlockMatrixName(blocks, 0, n, node == 1 ? (PetscInt[]){3, 1, 2, 0} : (PetscInt[]){1, 0}, PETSC_TRUE),
                   0);
  assert_int_equal(BlockMatrixPlace(blocks, ROWS, changed), 0);
  BlockMatrixGetNodes(blocks, 0, &count, &nodes);
  assert_int_equal(count, n);
  for (PetscInt i = 0; i < 4; i++) {
    const PetscInt row = nodes[i / node] * node + i % node;

    vector[i] = scale + row;
    for (PetscInt j = 0; j < 4; j++) {
      const PetscInt column = nodes[j / node] * node + j % node;

      value[4 * i + j] = j < i ? NAN : scale * (1 + row + column + 2 * (row == column));
    }
  }
  BlockMatrixMultiply(blocks, PETSC_FALSE, in, out);
  assert_int_equal(BlockMatrixAdd(blocks, 0, n, nodes, value), 0);
  assert_int_equal(BlockMatrixAddOuter(blocks, 0, n, nodes, vector), 0);
  assert_int_equal(BlockMatrixEnd(blocks, matrix), 0);
}

static void AssembledEqualsBlocks(int node, PetscBool keeps)
{
  PetscMPIInt rank, size;
  BlockMatrix blocks;
  Mat         matrix;
  Vec         x, y;
  PetscBool   changed;
  PetscReal   in[4], out[4], expected = 0, sum = 0, norm;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  {
    const PetscInt mine[4] = {ROWS * rank + 1, ROWS * rank + 4, ROWS * ((rank + 1) % size) + 2, -1};

    for (int i = 0; i < 4; i++) in[i] = mine[i] < 0 ? 0 : 1;
    assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, node, &blocks), 0);
    if (keeps) assert_int_equal(BlockMatrixKeepFactors(blocks, ROWS), 0);
    assert_int_equal(BlockMatrixKeepsFactors(blocks), keeps);
    for (int pass = 0; pass < 2; pass++) {
      for (int i = 0; i < 4; i++) out[i] = 0;
      AddBlocks(blocks, node, mine, 1 + pass, in, out, &matrix, &changed);
      assert_int_equal(changed, pass == 0);
    }
    assert_int_equal(MatCreateVecs(matrix, &x, &y), 0);
    assert_int_equal(VecSet(x, 1), 0);
    assert_int_equal(MatMult(matrix, x, y), 0);
    assert_int_equal(VecSum(y, &norm), 0);
    for (int i = 0; i < 3; i++) {
      sum += out[i];
      for (int j = 0; j < 3; j++) expected += size * (2.0 * (1 + i + j + 2 * (i == j)) + (2 + i) * (2 + j));
    }
    assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
    assert_true(PetscAbsReal(sum - expected) <= 1e-12 * sum);
    assert_true(PetscAbsReal(sum - norm) <= 1e-12 * sum);
  }
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

/* Tests a node's dofs one by one and together; the last one has no dof. Blocks are summed, or kept as they are. */
static void test_assembled_equals_blocks(void **state)
{
  (void)state;
  for (int node = 1; node <= 2; node++) {
    AssembledEqualsBlocks(node, PETSC_FALSE);
    AssembledEqualsBlocks(node, PETSC_TRUE);
  }
}

enum { FACTOR_ROWS = 6, FACTOR_STRIDE = 2 * LANES }; /* 6: a whole pass over rows and a part of one */

/* Adds K^T J + J^T K over the nodes of AddBlocks() to a sum that keeps factors, or as a matrix. */
static void AddFactored(BlockMatrix blocks, const PetscInt *dof, const PetscReal *in, PetscReal *out, Mat *matrix)
{
  const PetscInt        n                             = 4, *nodes;
  const PetscInt *const lists[]                       = {dof};
  PetscReal             K[FACTOR_ROWS][FACTOR_STRIDE] = {{0}}, J[FACTOR_ROWS][FACTOR_STRIDE] = {{0}};
  PetscReal             value[16 + BLOCK_PADDING] = {0};
  PetscInt              count;
  PetscBool             changed;

  assert_int_equal(BlockMatrixBegin(blocks, 1, &n, lists), 0);
  assert_int_equal(BlockMatrixName(blocks, 0, n, (PetscInt[]){3, 1, 2, 0}, PETSC_TRUE), 0);
  assert_int_equal(BlockMatrixPlace(blocks, ROWS, &changed), 0);
  BlockMatrixGetNodes(blocks, 0, &count, &nodes);
  for (int k = 0; k < FACTOR_ROWS; k++) {
    for (int i = 0; i < 4; i++) {
      K[k][i] = 1 + nodes[i] * k - 0.5 * k * k;
      J[k][i] = 2 - nodes[i] + k;
    }
    for (int i = 0; i < 4; i++)
      for (int j = i; j < 4; j++) value[4 * i + j] += K[k][i] * J[k][j] + J[k][i] * K[k][j];
  }
  BlockMatrixMultiply(blocks, PETSC_FALSE, in, out);
  if (BlockMatrixKeepsFactors(blocks))
    assert_int_equal(BlockMatrixAddFactors(blocks, 0, n, nodes, FACTOR_ROWS, FACTOR_STRIDE, *K, *J), 0);
  else
    assert_int_equal(BlockMatrixAdd(blocks, 0, n, nodes, value), 0);
  assert_int_equal(BlockMatrixEnd(blocks, matrix), 0);
}

/* Factors that are kept: products with the blocks, with the matrix and with the matrix that is formed of it are those
   of blocks that are summed. */
static void test_kept_factors(void **state)
{
  PetscReal   in[4] = {1, -2, 0.5, 3}, out[2][4] = {{0}}, norm, error[2];
  PetscMPIInt rank, size;
  BlockMatrix blocks[2];
  Mat         matrix[2], formed, none;
  Vec         x, y[3];

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (int keeps = 0; keeps < 2; keeps++) {
    const PetscInt mine[4] = {ROWS * rank + 1, ROWS * rank + 4, ROWS * ((rank + 1) % size) + 2, -1};

    assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, 1, &blocks[keeps]), 0);
    if (keeps) assert_int_equal(BlockMatrixKeepFactors(blocks[keeps], ROWS), 0);
    AddFactored(blocks[keeps], mine, in, out[keeps], &matrix[keeps]);
  }
  for (int i = 0; i < 4; i++) assert_true(PetscAbsReal(out[0][i] - out[1][i]) <= 1e-12 * PetscAbsReal(out[0][i]));
  assert_int_equal(BlockFactorsForm(matrix[0], &none), 0);
  assert_null(none);
  assert_int_equal(BlockFactorsForm(matrix[1], &formed), 0);
  assert_int_equal(MatCreateVecs(matrix[0], &x, &y[0]), 0);
  for (int i = 0; i < ROWS; i++) assert_int_equal(VecSetValue(x, ROWS * rank + i, 1 + rank + i * i, INSERT_VALUES), 0);
  assert_int_equal(VecAssemblyBegin(x), 0);
  assert_int_equal(VecAssemblyEnd(x), 0);
  for (int k = 0; k < 3; k++) {
    if (k) assert_int_equal(VecDuplicate(y[0], &y[k]), 0);
    assert_int_equal(MatMult(k == 2 ? formed : matrix[k], x, y[k]), 0);
  }
  assert_int_equal(VecNorm(y[0], NORM_2, &norm), 0);
  for (int k = 0; k < 2; k++) {
    assert_int_equal(VecAXPY(y[1 + k], -1, y[0]), 0);
    assert_int_equal(VecNorm(y[1 + k], NORM_2, &error[k]), 0);
    assert_true(error[k] <= 1e-12 * norm);
  }
  for (int k = 0; k < 3; k++) assert_int_equal(VecDestroy(&y[k]), 0);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(MatDestroy(&formed), 0);
  for (int k = 0; k < 2; k++) assert_int_equal(BlockMatrixDestroy(&blocks[k]), 0);
}

/* Rows that are not symmetric, beside a block that is: the matrix and the product with the blocks are their sum. */
static void test_uneven_rows(void **state)
{
  const PetscInt  n = 4, row[2] = {2, 0}, column[4] = {2, 3, 0, 1}, *nodes;
  const PetscReal vector[4 + BLOCK_PADDING] = {1, -2, 3, 0.5};
  PetscReal       in[4], out[4] = {0}, expected[4] = {0}, place[4] = {0}, rows[2 * 4], error;
  PetscMPIInt     rank, size;
  PetscInt        count;
  PetscBool       changed;
  BlockMatrix     blocks;
  Mat             matrix;
  Vec             x, y, sum;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  {
    const PetscInt        mine[4]  = {ROWS * rank + 1, ROWS * rank + 4, ROWS * ((rank + 1) % size) + 2, -1};
    const PetscInt *const lists[1] = {mine};

    for (int i = 0; i < 4; i++) in[i] = mine[i] < 0 ? 7 : 1 + mine[i];
    for (int k = 0; k < 8; k++) rows[k] = 10 * (k / 4) + k % 4 + 1;
    assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, 1, &blocks), 0);
    assert_int_equal(BlockMatrixBegin(blocks, 1, &n, lists), 0);
    assert_int_equal(BlockMatrixName(blocks, 0, n, (PetscInt[]){3, 1, 2, 0}, PETSC_TRUE), 0);
    assert_int_equal(BlockMatrixPlace(blocks, ROWS, &changed), 0);
    BlockMatrixGetNodes(blocks, 0, &count, &nodes);
    BlockMatrixMultiply(blocks, PETSC_FALSE, in, out);
    assert_int_equal(BlockMatrixAddOuter(blocks, 0, n, nodes, vector), 0);
    assert_int_equal(BlockMatrixAddRows(blocks, 0, 2, row, 4, column, rows), 0);
    assert_int_equal(BlockMatrixEnd(blocks, &matrix), 0);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) expected[nodes[i]] += vector[i] * vector[j] * in[nodes[j]];
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 4; j++) expected[row[i]] += rows[4 * i + j] * in[column[j]];
    for (int i = 0; i < 4; i++) assert_true(PetscAbsReal(out[i] - expected[i]) <= 1e-12 * PetscAbsReal(expected[i]));
    for (int i = 0; i < 4; i++) /* the entry without a dof is no column of the matrix */
      for (int j = 0; j < 4; j++)
        if (mine[nodes[i]] >= 0 && mine[nodes[j]] >= 0) place[nodes[i]] += vector[i] * vector[j] * in[nodes[j]];
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 4; j++)
        if (mine[column[j]] >= 0) place[row[i]] += rows[4 * i + j] * in[column[j]];
    assert_int_equal(MatCreateVecs(matrix, &x, &y), 0);
    assert_int_equal(VecDuplicate(y, &sum), 0);
    assert_int_equal(VecSetOption(sum, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE), 0);
    assert_int_equal(VecSetValues(sum, 4, mine, place, ADD_VALUES), 0);
    for (PetscInt i = ROWS * rank; i < ROWS * (rank + 1); i++)
      assert_int_equal(VecSetValue(x, i, 1 + i, INSERT_VALUES), 0);
  }
  assert_int_equal(VecAssemblyBegin(sum), 0);
  assert_int_equal(VecAssemblyEnd(sum), 0);
  assert_int_equal(VecAssemblyBegin(x), 0);
  assert_int_equal(VecAssemblyEnd(x), 0);
  assert_int_equal(MatMult(matrix, x, y), 0);
  assert_int_equal(VecAXPY(y, -1, sum), 0);
  assert_int_equal(VecNorm(y, NORM_INFINITY, &error), 0);
  assert_true(error <= 1e-12);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  assert_int_equal(VecDestroy(&sum), 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

/* Creates a block matrix over single dofs, and returns the dofs of this rank. */
static void CreateOwn(BlockMatrix *blocks, PetscInt mine[ROWS])
{
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt i = 0; i < ROWS; i++) mine[i] = ROWS * rank + i;
  assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, 1, blocks), 0);
}

/* Assembles blocks of ones of the given sizes. Each is over its own dofs, which start at `first`, on every rank.
   Returns whether the matrix is new, and checks the sum of its values. */
static PetscBool AssembleOwn(BlockMatrix blocks, PetscInt n, const PetscInt first[], const PetscInt m[],
                             const PetscInt *const dof[])
{
  const PetscInt nodes[] = {0, 1, 2, 3, 4, 5}, rows = ROWS;
  Mat            matrix;
  Vec            x, y;
  PetscBool      changed;
  PetscReal      value[ROWS * ROWS + BLOCK_PADDING], sum, expected = 0;
  PetscMPIInt    size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (int i = 0; i < ROWS * ROWS + BLOCK_PADDING; i++) value[i] = 1;
  assert_int_equal(BlockMatrixBegin(blocks, 1, &rows, dof), 0);
  for (PetscInt b = 0; b < n; b++) assert_int_equal(BlockMatrixName(blocks, 0, m[b], &nodes[first[b]], PETSC_FALSE), 0);
  assert_int_equal(BlockMatrixPlace(blocks, ROWS, &changed), 0);
  for (PetscInt b = 0; b < n; b++) {
    assert_int_equal(BlockMatrixAdd(blocks, 0, m[b], &nodes[first[b]], value), 0);
    expected += size * m[b] * m[b];
  }
  assert_int_equal(BlockMatrixEnd(blocks, &matrix), 0);
  assert_int_equal(MatCreateVecs(matrix, &x, &y), 0);
  assert_int_equal(VecSet(x, 1), 0);
  assert_int_equal(MatMult(matrix, x, y), 0);
  assert_int_equal(VecSum(y, &sum), 0);
  assert_true(PetscAbsReal(sum - expected) <= 1e-12 * expected);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  return changed;
}

static void test_pattern_is_kept_while_it_holds(void **state)
{
  BlockMatrix     blocks;
  PetscInt        mine[ROWS];
  const PetscInt *dof[1] = {mine};

  (void)state;
  CreateOwn(&blocks, mine);
  assert_true(AssembleOwn(blocks, 2, (const PetscInt[]){0, 3}, (const PetscInt[]){4, 3}, dof));
  assert_false(AssembleOwn(blocks, 2, (const PetscInt[]){3, 0}, (const PetscInt[]){3, 4}, dof)); /* another order */
  assert_false(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){4}, dof));       /* a part */
  assert_true(
    AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){2}, dof)); /* a small part: too many zeros */
  assert_true(
    AssembleOwn(blocks, 1, (const PetscInt[]){1}, (const PetscInt[]){2}, dof)); /* the same dofs and one more */
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

static void test_returns_to_the_marked_pattern(void **state)
{
  BlockMatrix     blocks;
  PetscInt        mine[ROWS];
  const PetscInt *dof[1] = {mine};

  (void)state;
  CreateOwn(&blocks, mine);
  assert_int_equal(BlockMatrixMark(blocks), 0);
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){ROWS}, dof));
  assert_int_equal(BlockMatrixReturn(blocks, ROWS), 0); /* no pattern was marked */
  assert_true(AssembleOwn(blocks, 2, (const PetscInt[]){0, 3}, (const PetscInt[]){4, 3}, dof));
  assert_int_equal(BlockMatrixMark(blocks), 0);
  assert_int_equal(BlockMatrixReturn(blocks, ROWS), 0); /* the same pattern */
  assert_false(AssembleOwn(blocks, 2, (const PetscInt[]){0, 3}, (const PetscInt[]){4, 3}, dof));
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){ROWS}, dof));
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){2}, dof));
  assert_int_equal(BlockMatrixReturn(blocks, ROWS), 0);
  /* in the marked pattern, whose matrix is new */
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){4}, dof));
  assert_false(AssembleOwn(blocks, 2, (const PetscInt[]){0, 3}, (const PetscInt[]){4, 3}, dof));
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

static void test_no_blocks(void **state)
{
  BlockMatrix blocks;
  Mat         matrix;
  PetscBool   changed;
  PetscReal   norm;

  (void)state;
  assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, 1, &blocks), 0);
  assert_int_equal(BlockMatrixBegin(blocks, 0, NULL, NULL), 0);
  assert_int_equal(BlockMatrixPlace(blocks, ROWS, &changed), 0);
  assert_int_equal(BlockMatrixEnd(blocks, &matrix), 0);
  assert_int_equal(MatNorm(matrix, NORM_FROBENIUS, &norm), 0);
  assert_true(norm == 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

/* The pattern couples a node with all nodes of its blocks, ascending. While the pattern is kept, this includes earlier
   blocks. */
static void test_coupled_nodes(void **state)
{
  BlockMatrix     blocks;
  PetscInt        mine[ROWS], n;
  const PetscInt *dof[1] = {mine}, *coupled;

  (void)state;
  CreateOwn(&blocks, mine);
  assert_int_equal(BlockMatrixGetCoupled(blocks, mine[0], &n, &coupled), 0);
  assert_int_equal(n, 0); /* there is no pattern yet */
  AssembleOwn(blocks, 2, (const PetscInt[]){0, 2}, (const PetscInt[]){3, 3}, dof);
  for (int pass = 0; pass < 2; pass++) {
    assert_int_equal(BlockMatrixGetCoupled(blocks, mine[2], &n, &coupled), 0);
    assert_int_equal(n, 5);
    for (PetscInt i = 0; i < n; i++) assert_int_equal(coupled[i], mine[i]);
    assert_int_equal(BlockMatrixGetCoupled(blocks, mine[4], &n, &coupled), 0);
    assert_int_equal(n, 3);
    for (PetscInt i = 0; i < n; i++) assert_int_equal(coupled[i], mine[2 + i]);
    if (pass == 0) assert_false(AssembleOwn(blocks, 2, (const PetscInt[]){0, 2}, (const PetscInt[]){3, 2}, dof));
  }
  assert_int_equal(BlockMatrixGetCoupled(blocks, mine[5], &n, &coupled), 0);
  assert_int_equal(n, 0); /* the node is in no block */
  assert_int_equal(BlockMatrixGetCoupled(blocks, -1, &n, &coupled), 0);
  assert_int_equal(n, 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_assembled_equals_blocks),
                                     cmocka_unit_test(test_pattern_is_kept_while_it_holds),
                                     cmocka_unit_test(test_returns_to_the_marked_pattern),
                                     cmocka_unit_test(test_no_blocks),
                                     cmocka_unit_test(test_coupled_nodes),
                                     cmocka_unit_test(test_kept_factors),
                                     cmocka_unit_test(test_uneven_rows)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
