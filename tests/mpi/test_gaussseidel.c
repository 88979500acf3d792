/* A sweep of Gauss-Seidel's method across ranks is symmetric and leaves no eigenvalue of the operator above 1, which
 * sweeps of each rank for itself do; one rank's is PETSc's to single precision, values that change are taken over, and
 * the smoother with its residual is Chebyshev's iterations with sweeps. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "gaussseidel.h"

enum { SIDE = 12, DOFS = 2, MOST = 3, POWERS = 300 };

static const PetscReal EXACT = 1e-12, SINGLE = 1e-6, LEAST = 0.1, LARGEST = 1.1;

/* Springs between the neighbours of a square of nodes, diagonals too, and a stiff one between every node and the
 * opposite one, whose rank is another. */
static PetscErrorCode Square(int dofs, PetscReal stiff, Mat *A)
{
  const PetscReal spring[MOST][MOST] = {{2, 0.5, 0.1}, {0.5, 1, 0.3}, {0.1, 0.3, 3}};
  const PetscInt  n                  = SIDE * SIDE;
  PetscMPIInt     rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(MatCreate(PETSC_COMM_WORLD, A));
  PetscCall(MatSetSizes(*A, PETSC_DECIDE, PETSC_DECIDE, n * dofs, n * dofs));
  PetscCall(MatSetBlockSize(*A, dofs));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetUp(*A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  for (PetscInt a = 0; a < n && !rank; a++) {
    const PetscInt others[] = {(a + 1) % SIDE ? a + 1 : -1, a + SIDE < n ? a + SIDE : -1,
                               (a + 1) % SIDE && a + SIDE < n ? a + SIDE + 1 : -1, n - 1 - a};

    for (int k = 0; k < 4; k++) {
      const PetscInt  b      = others[k];
      const PetscReal factor = k == 3 ? stiff : 1;

      for (int i = 0; i < dofs && b >= 0; i++) {
        for (int j = 0; j < dofs; j++) {
          PetscCall(MatSetValue(*A, a * dofs + i, a * dofs + j, factor * spring[i][j] + (i == j) * 1e-3, ADD_VALUES));
          PetscCall(MatSetValue(*A, b * dofs + i, b * dofs + j, factor * spring[i][j], ADD_VALUES));
          PetscCall(MatSetValue(*A, a * dofs + i, b * dofs + j, -factor * spring[i][j], ADD_VALUES));
          PetscCall(MatSetValue(*A, b * dofs + i, a * dofs + j, -factor * spring[i][j], ADD_VALUES));
        }
      }
    }
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Sweeps(Mat A, PetscBool across, PC *pc)
{
  PetscFunctionBeginUser;
  PetscCall(PCCreate(PETSC_COMM_WORLD, pc));
  PetscCall(PCSetOperators(*pc, A, A));
  if (across)
    PetscCall(GaussSeidelSet(*pc, LEAST, LARGEST));
  else
    PetscCall(PCSetType(*pc, PCSOR));
  PetscCall(PCSetUp(*pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fill(Vec v, PetscInt seed)
{
  PetscInt begin, end;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(v, &begin, &end));
  for (PetscInt i = begin; i < end; i++)
    PetscCall(VecSetValue(v, i, PetscSinReal((PetscReal)(seed * (i + 1) * (i + 3))), INSERT_VALUES));
  PetscCall(VecAssemblyBegin(v));
  PetscCall(VecAssemblyEnd(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest eigenvalue of the preconditioned operator by the power method, from below */
static PetscErrorCode Largest(Mat A, PC pc, PetscReal *largest)
{
  Vec x, y;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, &y));
  PetscCall(Fill(x, 1));
  for (int k = 0; k < POWERS; k++) {
    PetscCall(VecNormalize(x, NULL));
    PetscCall(MatMult(A, x, y));
    PetscCall(PCApply(pc, y, x));
  }
  PetscCall(VecNorm(x, NORM_2, largest));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_no_eigenvalue_above_one(void **state)
{
  const PetscReal stiff[] = {0, 1, 100};
  PetscMPIInt     size;

  (void)state;
  assert_int_equal(MPI_Comm_size(PETSC_COMM_WORLD, &size), 0);
  for (int k = 0; k < 3; k++) {
    Mat       A;
    PC        across, apart;
    PetscReal largest = 0, others = 0;

    assert_int_equal(Square(DOFS, stiff[k], &A), 0);
    assert_int_equal(Sweeps(A, PETSC_TRUE, &across), 0);
    assert_int_equal(Sweeps(A, PETSC_FALSE, &apart), 0);
    assert_int_equal(Largest(A, across, &largest), 0);
    assert_int_equal(Largest(A, apart, &others), 0);
    assert_true(largest <= 1 + SINGLE && largest > 0.9);
    assert_true(size == 1 || others > 1.2);
    assert_int_equal(PCDestroy(&across), 0);
    assert_int_equal(PCDestroy(&apart), 0);
    assert_int_equal(MatDestroy(&A), 0);
  }
}

static void test_symmetric(void **state)
{
  Mat       A;
  PC        pc;
  Vec       x, y, left;
  PetscReal one = 0, other = 0;

  (void)state;
  assert_int_equal(Square(DOFS, 3, &A), 0);
  assert_int_equal(Sweeps(A, PETSC_TRUE, &pc), 0);
  assert_int_equal(MatCreateVecs(A, &x, &y), 0);
  assert_int_equal(VecDuplicate(x, &left), 0);
  assert_int_equal(Fill(x, 1), 0);
  assert_int_equal(Fill(y, 2), 0);
  assert_int_equal(PCApply(pc, x, left), 0);
  assert_int_equal(VecDot(left, y, &one), 0);
  assert_int_equal(PCApply(pc, y, left), 0);
  assert_int_equal(VecDot(left, x, &other), 0);
  assert_true(PetscAbsReal(one - other) <= EXACT * PetscAbsReal(one));
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  assert_int_equal(VecDestroy(&left), 0);
  assert_int_equal(PCDestroy(&pc), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

/* Twice the matrix takes half the sweep; on one rank it is PETSc's, whose blocks are the same. */
static void test_follows_values(void **state)
{
  Mat         A;
  PC          pc, petsc;
  Vec         x, first, second;
  PetscReal   scale = 0, error = 0;
  PetscMPIInt size;

  (void)state;
  assert_int_equal(MPI_Comm_size(PETSC_COMM_WORLD, &size), 0);
  assert_int_equal(Square(DOFS, 1, &A), 0);
  assert_int_equal(Sweeps(A, PETSC_TRUE, &pc), 0);
  assert_int_equal(Sweeps(A, PETSC_FALSE, &petsc), 0);
  assert_int_equal(MatCreateVecs(A, &x, &first), 0);
  assert_int_equal(VecDuplicate(x, &second), 0);
  assert_int_equal(Fill(x, 1), 0);
  assert_int_equal(PCApply(pc, x, first), 0);
  assert_int_equal(VecNorm(first, NORM_2, &scale), 0);
  if (size == 1) {
    assert_int_equal(PCApply(petsc, x, second), 0);
    assert_int_equal(VecAXPY(second, -1, first), 0);
    assert_int_equal(VecNorm(second, NORM_2, &error), 0);
    assert_true(error <= SINGLE * scale);
  }
  assert_int_equal(MatScale(A, 2), 0);
  assert_int_equal(PCApply(pc, x, second), 0);
  assert_int_equal(VecAXPY(second, -0.5, first), 0);
  assert_int_equal(VecNorm(second, NORM_2, &error), 0);
  assert_true(error <= EXACT * scale);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&first), 0);
  assert_int_equal(VecDestroy(&second), 0);
  assert_int_equal(PCDestroy(&pc), 0);
  assert_int_equal(PCDestroy(&petsc), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

/* x after some iterations for b, from a guess; chebyshev: PETSc's, with matrix products in double precision */
static PetscErrorCode Iterate(Mat A, PC pc, PetscBool chebyshev, PetscInt iterations, PetscBool guess, Vec b, Vec x)
{
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetPC(ksp, pc));
  PetscCall(KSPSetType(ksp, chebyshev ? KSPCHEBYSHEV : KSPRICHARDSON));
  if (chebyshev) PetscCall(KSPChebyshevSetEigenvalues(ksp, LARGEST, LEAST));
  PetscCall(KSPSetNormType(ksp, KSP_NORM_NONE));
  PetscCall(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, iterations));
  PetscCall(KSPSetInitialGuessNonzero(ksp, guess));
  PetscCall(Fill(x, 4));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CheckSmoother(int dofs)
{
  Mat       A, swept;
  PC        pc;
  Vec       b, x, exact;
  PetscReal scale = 0, error = 0;

  assert_int_equal(Square(dofs, 3, &A), 0);
  assert_int_equal(Sweeps(A, PETSC_TRUE, &pc), 0);
  assert_int_equal(MatCreateVecs(A, &b, &x), 0);
  assert_int_equal(VecDuplicate(x, &exact), 0);
  assert_int_equal(Fill(b, 1), 0);
  for (int k = 0; k < 6; k++) {
    assert_int_equal(Iterate(A, pc, PETSC_TRUE, 1 + k / 2, k % 2 ? PETSC_TRUE : PETSC_FALSE, b, exact), 0);
    assert_int_equal(Iterate(A, pc, PETSC_FALSE, 1 + k / 2, k % 2 ? PETSC_TRUE : PETSC_FALSE, b, x), 0);
    assert_int_equal(VecNorm(exact, NORM_2, &scale), 0);
    assert_int_equal(VecAXPY(x, -1, exact), 0);
    assert_int_equal(VecNorm(x, NORM_2, &error), 0);
    assert_true(error <= SINGLE * scale);
  }
  assert_int_equal(GaussSeidelGetMat(pc, &swept), 0);
  assert_int_equal(GaussSeidelResidual(swept, b, exact, x), 0);
  assert_int_equal(VecNorm(x, NORM_2, &scale), 0);
  assert_int_equal(MatMultAdd(A, exact, x, x), 0);
  assert_int_equal(VecAXPY(x, -1, b), 0);
  assert_int_equal(VecNorm(x, NORM_2, &error), 0);
  assert_true(error <= SINGLE * scale);
  assert_int_equal(VecDestroy(&b), 0);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&exact), 0);
  assert_int_equal(MatDestroy(&swept), 0);
  assert_int_equal(PCDestroy(&pc), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

static void test_smooths(void **state)
{
  (void)state;
  for (int dofs = 1; dofs <= MOST; dofs++) CheckSmoother(dofs);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_eigenvalue_above_one), cmocka_unit_test(test_symmetric),
                                     cmocka_unit_test(test_follows_values), cmocka_unit_test(test_smooths)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
