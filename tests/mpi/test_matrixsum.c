/* The sum of two matrices equals MatAXPY()'s on any number of ranks, also refreshed with a term that has fewer entries than the sum was made for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "matrixsum.h"

enum { ROWS = 7 }; /* of each rank */

/* Entries (row, row + k*stride) for k < n, around the end; their values follow from place and scale. */
static Mat Stripes(PetscInt n, PetscInt stride, PetscReal scale)
{
  PetscInt first, end, size;
  Mat      mat;

  assert_int_equal(MatCreate(PETSC_COMM_WORLD, &mat), 0);
  assert_int_equal(MatSetSizes(mat, ROWS, ROWS, PETSC_DETERMINE, PETSC_DETERMINE), 0);
  assert_int_equal(MatSetType(mat, MATAIJ), 0);
  assert_int_equal(MatSetUp(mat), 0);
  assert_int_equal(MatGetOwnershipRange(mat, &first, &end), 0);
  assert_int_equal(MatGetSize(mat, &size, NULL), 0);
  for (PetscInt row = first; row < end; row++) {
    for (PetscInt k = 0; k < n; k++) assert_int_equal(MatSetValue(mat, row, (row + k * stride) % size, scale * (1 + row + k), INSERT_VALUES), 0);
  }
  assert_int_equal(MatAssemblyBegin(mat, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(MatAssemblyEnd(mat, MAT_FINAL_ASSEMBLY), 0);
  return mat;
}

static void AssertSum(Mat K, Mat C, Mat sum)
{
  Mat       expected;
  PetscReal norm;

  assert_int_equal(MatDuplicate(sum, MAT_COPY_VALUES, &expected), 0);
  assert_int_equal(MatAXPY(expected, -1, K, DIFFERENT_NONZERO_PATTERN), 0);
  assert_int_equal(MatAXPY(expected, -1, C, DIFFERENT_NONZERO_PATTERN), 0);
  assert_int_equal(MatNorm(expected, NORM_FROBENIUS, &norm), 0);
  assert_true(norm == 0);
  assert_int_equal(MatDestroy(&expected), 0);
}

static void test_sum(void **state)
{
  Mat K = Stripes(3, 1, 1), C = Stripes(4, 3, 10), fewer = Stripes(2, 3, 100), none = Stripes(0, 1, 1), sum;

  (void)state;
  assert_int_equal(MatrixSumCreate(K, C, &sum), 0);
  AssertSum(K, C, sum);
  assert_int_equal(MatScale(K, 0.5), 0);
  assert_int_equal(MatrixSumUpdate(K, fewer, sum), 0);
  AssertSum(K, fewer, sum);
  assert_int_equal(MatrixSumUpdate(K, none, sum), 0);
  AssertSum(K, none, sum);
  assert_int_equal(MatDestroy(&sum), 0);
  assert_int_equal(MatrixSumCreate(K, none, &sum), 0);
  AssertSum(K, none, sum);
  assert_int_equal(MatDestroy(&sum), 0);
  assert_int_equal(MatDestroy(&K), 0);
  assert_int_equal(MatDestroy(&C), 0);
  assert_int_equal(MatDestroy(&fewer), 0);
  assert_int_equal(MatDestroy(&none), 0);
}

/* A factorisation's symbolic part is kept as long as the pattern is the same. */
static void test_pattern_stays(void **state)
{
  Mat              K = Stripes(3, 1, 1), C = Stripes(4, 3, 10), sum;
  PetscObjectState before, after;

  (void)state;
  assert_int_equal(MatrixSumCreate(K, C, &sum), 0);
  assert_int_equal(MatGetNonzeroState(sum, &before), 0);
  assert_int_equal(MatrixSumUpdate(K, C, sum), 0);
  assert_int_equal(MatGetNonzeroState(sum, &after), 0);
  assert_true(before == after);
  assert_int_equal(MatDestroy(&sum), 0);
  assert_int_equal(MatDestroy(&K), 0);
  assert_int_equal(MatDestroy(&C), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sum), cmocka_unit_test(test_pattern_stays)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
