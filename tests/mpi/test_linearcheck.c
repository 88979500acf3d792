/* Linear solves by a factor that is not quite the matrix's are refined and counted; what refinement cannot help is
 * counted apart or lost; good ones are left alone. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "linear/linearcheck.h"

enum { SIZE = 40 };

/* Diagonal: the solver's factor of row i is d (1 + wrong), so that each refinement leaves `wrong` of the residual. */
static PetscErrorCode Diagonal(PetscReal wrong, Mat *A)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, SIZE, SIZE, 1, NULL, 0, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &first, &last));
  for (PetscInt i = first; i < last; i++) PetscCall(MatSetValue(*A, i, i, (1 + i) * (1 + wrong), INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One solve with a tolerance of 1e-8: its counts, whether it was lost, and the largest error of the solution, which is
 * 1 */
static PetscErrorCode Solve(PetscReal wrong, LinearCounts *counts, PetscBool *lost, PetscReal *error)
{
  Mat         A, P;
  Vec         x, b;
  KSP         ksp;
  PC          pc;
  LinearCheck check;

  PetscFunctionBeginUser;
  PetscCall(Diagonal(0, &A));
  PetscCall(Diagonal(wrong, &P));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecSet(x, 1));
  PetscCall(MatMult(A, x, b));
  PetscCall(VecZeroEntries(x));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCJACOBI));
  PetscCall(KSPSetOperators(ksp, A, P));
  PetscCall(LinearCheckCreate(ksp, 1e-8, NULL, &check));
  PetscCall(KSPSolve(ksp, b, x));
  LinearCheckGetCounts(check, counts);
  *lost = LinearCheckLost(check);
  PetscCall(VecShift(x, -1));
  PetscCall(VecNorm(x, NORM_INFINITY, error));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(LinearCheckDestroy(&check));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(MatDestroy(&A));
  PetscCall(MatDestroy(&P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_good_solve_is_left_alone(void **state)
{
  LinearCounts counts;
  PetscBool    lost;
  PetscReal    error;

  (void)state;
  assert_int_equal(Solve(1e-7, &counts, &lost, &error), 0);
  assert_false(lost);
  assert_true(counts.solves == 1 && counts.refined == 0 && counts.steps == 0 && counts.inaccurate == 0);
  assert_true(counts.worst > 0.9e-7 && counts.worst < 1.1e-7);
}

static void test_refinement_helps(void **state)
{
  LinearCounts counts;
  PetscBool    lost;
  PetscReal    error;

  (void)state;
  assert_int_equal(Solve(0.01, &counts, &lost, &error), 0);
  assert_false(lost);
  assert_true(counts.refined == 1 && counts.steps == 2 && counts.inaccurate == 0); /* leaves 0.01/1.01 in each solve */
  assert_true(counts.worst < 1e-6 && error < 1e-6);
}

static void test_slow_refinement_is_told(void **state)
{
  LinearCounts counts;
  PetscBool    lost;
  PetscReal    error;

  (void)state;
  assert_int_equal(Solve(0.4, &counts, &lost, &error),
                   0); /* leaves 0.4/1.4 in each step: eight of them leave 1.3e-5 of the first 0.29 */
  assert_false(lost);
  assert_true(counts.refined == 1 && counts.steps == 8 && counts.inaccurate == 1);
  assert_true(counts.worst > 1e-6 && counts.worst < 1e-4);
}

static void test_hopeless_solve_is_lost(void **state)
{
  LinearCounts counts;
  PetscBool    lost;
  PetscReal    error;

  (void)state;
  assert_int_equal(Solve(-0.7, &counts, &lost, &error), 0); /* grows by 2.3 in each step */
  assert_true(lost);
  assert_int_equal(counts.steps, 1);
  assert_true(error < 2.4); /* the step that did not help was taken back */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_good_solve_is_left_alone), cmocka_unit_test(test_refinement_helps),
    cmocka_unit_test(test_slow_refinement_is_told), cmocka_unit_test(test_hopeless_solve_is_lost)};
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
