/* Columns of an inverse: those of forces on few unknowns, of a force on all of them and of none. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "linear/directsolver.h"

enum { SIZE = 40, COLUMNS = 4 };

/* A chain of springs of 1 between walls */
static PetscErrorCode Chain(Mat *A)
{
  PetscInt first, end;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, SIZE, SIZE, 3, NULL, 3, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &first, &end));
  for (PetscInt i = first; i < end; i++) {
    PetscCall(MatSetValue(*A, i, i, 2, INSERT_VALUES));
    if (i > 0) PetscCall(MatSetValue(*A, i, i - 1, -1, INSERT_VALUES));
    if (i < SIZE - 1) PetscCall(MatSetValue(*A, i, i + 1, -1, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force on unknown i: of column 0 on both ends, of column 1 on the one in the middle, of column 2 on none, of column 3
 * on all of them */
static PetscScalar Force(PetscInt i, PetscInt column)
{
  return column == 0 ? (i == 0) - 2 * (i == SIZE - 1) : column == 1 ? i == SIZE / 2 : column == 3 ? 1 + i : 0;
}

static PetscErrorCode Forces(Mat A, PetscInt columns, Mat *B)
{
  PetscInt first, end;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &first, &end));
  PetscCall(MatCreateDense(PETSC_COMM_WORLD, end - first, PETSC_DECIDE, SIZE, columns, NULL, B));
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = first; i < end; i++)
      PetscCall(MatSetValue(*B, i, j, Force(i, columns == 1 ? 2 : j), INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*B, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*B, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest entry of A X - B */
static PetscErrorCode Miss(PetscInt columns, PetscReal *miss)
{
  Mat A, B, X, AX;
  KSP ksp;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(Chain(&A));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(DirectSolverSet(ksp, PETSC_TRUE));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetUp(ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(Forces(A, columns, &B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(DirectSolverColumns(pc, B, X));
  PetscCall(MatMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
  PetscCall(MatAXPY(AX, -1, B, SAME_NONZERO_PATTERN));
  PetscCall(MatNorm(AX, NORM_FROBENIUS, miss));
  PetscCall(MatDestroy(&AX));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&B));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_columns(void **state)
{
  PetscReal miss;

  (void)state;
  assert_int_equal(Miss(COLUMNS, &miss), 0);
  assert_true(miss < 1e-10);
}

static void test_no_force_at_all(void **state)
{
  PetscReal miss;

  (void)state;
  assert_int_equal(Miss(1, &miss), 0);
  assert_true(miss == 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_columns), cmocka_unit_test(test_no_force_at_all)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
