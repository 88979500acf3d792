/* Negative eigenvalues of chains of springs, symmetric and not, from their factors. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "linear/negativemode.h"

enum { LINKS = 60 };

/* A chain whose ends are held: eigenvalues 2 a - 2 sqrt(b c) cos(k pi/(LINKS + 1)) with a = 1 + shift/2, b = 1 + skew,
   c = 1 - skew. */
static PetscErrorCode Chain(PetscReal shift, PetscReal skew, Mat *A)
{
  PetscInt first, end;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, LINKS, LINKS, 3, NULL, 2, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &first, &end));
  for (PetscInt i = first; i < end; i++) {
    PetscCall(MatSetValue(*A, i, i, 2 + shift, INSERT_VALUES));
    if (i > 0) PetscCall(MatSetValue(*A, i, i - 1, -1 + skew, INSERT_VALUES));
    if (i < LINKS - 1) PetscCall(MatSetValue(*A, i, i + 1, -1 - skew, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Eigenvalue(PetscReal shift, PetscReal skew, int k)
{
  return 2 + shift - 2 * PetscSqrtReal(1 - skew * skew) * PetscCosReal(k * PETSC_PI / (LINKS + 1));
}

/* The negative eigenvalue that is found, and how far A mode is from eigenvalue mode, over the eigenvalue. */
static PetscReal Found(PetscReal shift, PetscReal skew, PetscReal *miss)
{
  Factor         factor;
  Mat            A;
  Vec            mode, image;
  PCFailedReason reason;
  PetscReal      eigenvalue;
  PetscInt       first, end;

  assert_int_equal(Chain(shift, skew, &A), 0);
  assert_int_equal(MatCreateVecs(A, &mode, &image), 0);
  assert_int_equal(VecGetOwnershipRange(mode, &first, &end), 0);
  for (PetscInt i = first; i < end; i++)
    assert_int_equal(VecSetValue(mode, i, PetscSinReal(7 * i * i + 1), INSERT_VALUES), 0);
  assert_int_equal(VecAssemblyBegin(mode), 0);
  assert_int_equal(VecAssemblyEnd(mode), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, skew == 0, &factor), 0);
  assert_int_equal(FactorMake(factor, A, &reason), 0);
  assert_int_equal(reason, PC_NOERROR);
  assert_int_equal(NegativeModeFind(factor, mode, &eigenvalue), 0);
  assert_int_equal(MatMult(A, mode, image), 0);
  assert_int_equal(VecAXPY(image, -eigenvalue, mode), 0);
  assert_int_equal(VecNorm(image, NORM_2, miss), 0);
  if (eigenvalue < 0) *miss /= -eigenvalue;
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(VecDestroy(&mode), 0);
  assert_int_equal(VecDestroy(&image), 0);
  assert_int_equal(MatDestroy(&A), 0);
  return eigenvalue;
}

/* A shift between two eigenvalues leaves those below it negative. Without one below it none is found. */
static void test_chain(void **state)
{
  static const PetscReal skews[] = {0, 1e-3};
  PetscReal              miss;

  (void)state;
  for (int s = 0; s < 2; s++) {
    for (int below = 1; below < 4; below++) {
      const PetscReal shift    = -(Eigenvalue(0, skews[s], below) + Eigenvalue(0, skews[s], below + 1)) / 2;
      const PetscReal expected = Eigenvalue(shift, skews[s], below), found = Found(shift, skews[s], &miss);

      assert_true(PetscAbsReal(found / expected - 1) < 0.1);
      assert_true(miss < 0.5);
    }
    assert_true(Found(-0.9 * Eigenvalue(0, skews[s], 1), skews[s], &miss) == 0);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_chain)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
