/* Blocks assembled on any number of ranks give the same product as the blocks themselves; the pattern is kept while it serves. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "blockmatrix.h"

enum { ROWS = 6 }; /* of each rank */

/* Each rank adds two blocks, one a vector's product with itself, over two of its own dofs, one of the next rank, and one entry without a dof. */
static void AddBlock(BlockMatrix blocks, PetscReal scale)
{
  PetscInt  *entry;
  PetscReal *value;

  assert_int_equal(BlockMatrixReset(blocks), 0);
  assert_int_equal(BlockMatrixAdd(blocks, 0, 4, &entry, &value), 0);
  for (PetscInt i = 0; i < 4; i++) {
    entry[i] = i;
    for (PetscInt j = 0; j < 4; j++) value[4 * i + j] = scale * (1 + i + j + 2 * (i == j));
  }
  assert_int_equal(BlockMatrixAddOuter(blocks, 0, 4, &entry, &value), 0);
  for (PetscInt i = 0; i < 4; i++) {
    entry[i] = i;
    value[i] = scale + i;
  }
}

static void AssembledEqualsBlocks(int node)
{
  PetscMPIInt     rank, size;
  BlockMatrix     blocks;
  Mat             matrix;
  Vec             x, y;
  PetscBool       changed;
  PetscReal       in[4], out[4] = {0, 0, 0, 0}, sum = 0, norm;
  const PetscInt *dof[1];

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  {
    const PetscInt mine[4] = {ROWS * rank + 1, ROWS * rank + 4, ROWS * ((rank + 1) % size) + 2, -1};

    dof[0] = mine;
    assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, node, &blocks), 0);
    for (int pass = 0; pass < 2; pass++) {
      AddBlock(blocks, 1 + pass);
      assert_int_equal(BlockMatrixAssemble(blocks, ROWS, dof, &matrix, &changed), 0);
      assert_int_equal(changed, pass == 0);
    }
    assert_int_equal(MatCreateVecs(matrix, &x, &y), 0);
    assert_int_equal(VecSet(x, 1), 0);
    assert_int_equal(MatMult(matrix, x, y), 0);
    assert_int_equal(VecSum(y, &norm), 0);
    for (int i = 0; i < 4; i++) in[i] = mine[i] < 0 ? 0 : 1;
    assert_int_equal(BlockMatrixMultiply(blocks, 0, in, out), 0);
    for (int i = 0; i < 4; i++) sum += mine[i] < 0 ? 0 : out[i];
    assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD), MPI_SUCCESS);
    assert_true(PetscAbsReal(sum - norm) <= 1e-12 * sum);
  }
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

/* A node's dofs one by one or together, the last one without a dof */
static void test_assembled_equals_blocks(void **state)
{
  (void)state;
  AssembledEqualsBlocks(1);
  AssembledEqualsBlocks(2);
}

/* One block of this rank over its own dofs from `first` on. */
static void AddOwn(BlockMatrix blocks, PetscInt first, PetscInt m)
{
  PetscInt  *entry;
  PetscReal *value;

  assert_int_equal(BlockMatrixAdd(blocks, 0, m, &entry, &value), 0);
  for (PetscInt i = 0; i < m; i++) entry[i] = first + i;
  for (PetscInt i = 0; i < m * m; i++) value[i] = 1;
}

/* Assembles blocks of the given sizes, one after the other on every rank's dofs; returns whether the matrix is new, and checks the sum of its values. */
static PetscBool AssembleOwn(BlockMatrix blocks, PetscInt n, const PetscInt first[], const PetscInt m[], const PetscInt *const dof[])
{
  Mat         matrix;
  Vec         x, y;
  PetscBool   changed;
  PetscReal   sum, expected = 0;
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  assert_int_equal(BlockMatrixReset(blocks), 0);
  for (PetscInt b = 0; b < n; b++) {
    AddOwn(blocks, first[b], m[b]);
    expected += size * m[b] * m[b];
  }
  assert_int_equal(BlockMatrixAssemble(blocks, ROWS, dof, &matrix, &changed), 0);
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
  PetscMPIInt     rank;
  BlockMatrix     blocks;
  PetscInt        mine[ROWS];
  const PetscInt *dof[1] = {mine};

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt i = 0; i < ROWS; i++) mine[i] = ROWS * rank + i;
  assert_int_equal(BlockMatrixCreate(PETSC_COMM_WORLD, 1, &blocks), 0);
  assert_true(AssembleOwn(blocks, 2, (const PetscInt[]){0, 3}, (const PetscInt[]){4, 3}, dof));
  assert_false(AssembleOwn(blocks, 2, (const PetscInt[]){3, 0}, (const PetscInt[]){3, 4}, dof)); /* another order */
  assert_false(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){4}, dof));       /* a part */
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){0}, (const PetscInt[]){2}, dof));        /* a small part: too many zeros */
  assert_true(AssembleOwn(blocks, 1, (const PetscInt[]){1}, (const PetscInt[]){2}, dof));        /* the same dofs, and one more */
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
  assert_int_equal(BlockMatrixAssemble(blocks, ROWS, NULL, &matrix, &changed), 0);
  assert_int_equal(MatNorm(matrix, NORM_FROBENIUS, &norm), 0);
  assert_true(norm == 0);
  assert_int_equal(BlockMatrixDestroy(&blocks), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_assembled_equals_blocks), cmocka_unit_test(test_pattern_is_kept_while_it_holds),
                                     cmocka_unit_test(test_no_blocks)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
