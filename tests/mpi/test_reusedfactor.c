/* A factor serves later operators while few contact terms have changed, to the residual asked for, sooner if it is told
 * of them; after too many changes, a new step, or where GMRES does not get there, a new one is made, of new patterns
 * too. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "linear/directsolver.h"
#include "linear/linearcheck.h"

enum { SIZE = 60 };

typedef struct {
  KSP          ksp;
  ReusedFactor kept;
  LinearCheck  check;
} Solver;

/* A chain of springs held at both ends; some rows get another one to the ground. far: couples the ends of the chain,
 * which is another pattern */
static PetscErrorCode Chain(PetscInt stiff, PetscReal by, PetscBool far, Mat *A)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, SIZE, SIZE, 4, NULL, 4, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &first, &last));
  for (PetscInt i = first; i < last; i++) {
    PetscCall(
      MatSetValue(*A, i, i, 2 + (i % 7 == 0 && i / 7 < stiff ? by : 0) + (far && i % (SIZE - 1) == 0), INSERT_VALUES));
    if (i > 0) PetscCall(MatSetValue(*A, i, i - 1, -1, INSERT_VALUES));
    if (i < SIZE - 1) PetscCall(MatSetValue(*A, i, i + 1, -1, INSERT_VALUES));
    if (far && i % (SIZE - 1) == 0) PetscCall(MatSetValue(*A, i, SIZE - 1 - i, -1, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells the factor of the springs to the ground of rows first to end - 1. */
static PetscErrorCode Tell(Solver *s, Mat A, PetscInt first, PetscInt end, PetscReal by)
{
  PetscReal by_each[SIZE];
  PetscInt  m;
  Mat       N;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &m, NULL));
  PetscCall(MatCreateDense(PETSC_COMM_WORLD, m, PETSC_DECIDE, SIZE, end - first, NULL, &N));
  for (PetscInt k = 0; k < end - first; k++) {
    by_each[k] = by;
    PetscCall(MatSetValue(N, 7 * (first + k), k, 1, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(N, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(N, MAT_FINAL_ASSEMBLY));
  PetscCall(ReusedFactorUpdate(s->kept, N, by_each));
  PetscCall(MatDestroy(&N));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolverCreate(Solver *s)
{
  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &s->ksp));
  PetscCall(DirectSolverSet(s->ksp, PETSC_TRUE));
  PetscCall(ReusedFactorCreate(s->ksp, &s->kept));
  PetscCall(LinearCheckCreate(s->ksp, 1e-8, s->kept, &s->check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolverDestroy(Solver *s)
{
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(LinearCheckDestroy(&s->check));
  PetscCall(ReusedFactorDestroy(&s->kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One solve with the next operator: its relative residual. told: of the springs from which on the factor is told of
 * them, -1: not at all */
static PetscReal SolveTold(Solver *s, PetscInt stiff, PetscReal by, PetscBool far, PetscInt changes, PetscBool pattern,
                           PetscInt told)
{
  PetscBool serves;
  Mat       A;
  Vec       b, x, r;
  PetscReal norm, right;

  assert_int_equal(Chain(stiff, by, far, &A), 0);
  assert_int_equal(MatCreateVecs(A, &x, &b), 0);
  assert_int_equal(VecDuplicate(b, &r), 0);
  assert_int_equal(VecSet(b, 1), 0);
  assert_int_equal(ReusedFactorNext(s->kept, changes, pattern, &serves), 0);
  if (told >= 0 && serves) assert_int_equal(Tell(s, A, told, stiff, by), 0);
  assert_int_equal(KSPSetOperators(s->ksp, A, A), 0);
  assert_int_equal(KSPSolve(s->ksp, b, x), 0);
  assert_false(LinearCheckLost(s->check));
  assert_int_equal(MatMult(A, x, r), 0);
  assert_int_equal(VecAXPY(r, -1, b), 0);
  assert_int_equal(VecNorm(r, NORM_2, &norm), 0);
  assert_int_equal(VecNorm(b, NORM_2, &right), 0);
  assert_int_equal(VecDestroy(&b), 0);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&r), 0);
  assert_int_equal(MatDestroy(&A), 0);
  return norm / right;
}

static PetscReal Solve(Solver *s, PetscInt stiff, PetscReal by, PetscBool far, PetscInt changes, PetscBool pattern)
{
  return SolveTold(s, stiff, by, far, changes, pattern, -1);
}

static KeptCounts Counts(const Solver *s)
{
  LinearCounts counts;

  LinearCheckGetCounts(s->check, &counts);
  return counts.kept;
}

static void test_factor_serves_until_much_has_changed(void **state)
{
  Solver s;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 100, PETSC_TRUE) < 1e-12); /* the first one is factored */
  assert_true(Solve(&s, 2, 100, PETSC_FALSE, 2, PETSC_FALSE) < 1e-5);
  assert_true(Counts(&s).made == 1 && Counts(&s).served == 1 && Counts(&s).iterations <= 3); /* of rank two */
  assert_true(Solve(&s, 4, 100, PETSC_FALSE, 23, PETSC_FALSE) < 1e-12);                      /* 25 changes by now */
  assert_true(Counts(&s).made == 2 && Counts(&s).served == 1);
  assert_int_equal(SolverDestroy(&s), 0);
}

static void test_told_of_changes_it_needs_no_iterations(void **state)
{
  Solver s;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 0, PETSC_TRUE) < 1e-12);
  assert_true(SolveTold(&s, 5, 1000, PETSC_FALSE, 5, PETSC_FALSE, 0) < 1e-5);
  assert_true(SolveTold(&s, 9, 1000, PETSC_FALSE, 4, PETSC_FALSE, 5) < 1e-5); /* four more */
  assert_true(Counts(&s).made == 1 && Counts(&s).served == 2 && Counts(&s).iterations == 0);
  assert_true(Solve(&s, 9, 1000, PETSC_FALSE, 16, PETSC_FALSE) < 1e-12);
  assert_true(Solve(&s, 9, 1010, PETSC_FALSE, 0, PETSC_FALSE) < 1e-5); /* the new factor has forgotten the changes */
  assert_true(Counts(&s).made == 2 && Counts(&s).served == 3 && Counts(&s).iterations <= 3);
  assert_int_equal(SolverDestroy(&s), 0);
}

static void test_new_step_has_its_own_factor(void **state)
{
  Solver s;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 0, PETSC_TRUE) < 1e-12);
  assert_int_equal(ReusedFactorRenew(s.kept), 0);
  assert_true(Solve(&s, 1, 1, PETSC_FALSE, 0, PETSC_FALSE) < 1e-12);
  assert_true(Counts(&s).made == 2 && Counts(&s).served == 0);
  assert_int_equal(SolverDestroy(&s), 0);
}

/* More springs than iterations are allowed for come unannounced. */
static void test_gives_up_and_factors(void **state)
{
  LinearCounts counts;
  Solver       s;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 0, PETSC_TRUE) < 1e-12);
  assert_true(Solve(&s, 9, 1000, PETSC_FALSE, 0, PETSC_FALSE) < 1e-12);
  assert_true(Counts(&s).made == 2 && Counts(&s).served == 1 && Counts(&s).iterations == 8);
  assert_true(Solve(&s, 9, 1010, PETSC_FALSE, 0, PETSC_FALSE) < 1e-5); /* the new factor serves */
  assert_true(Counts(&s).made == 2 && Counts(&s).served == 2 && Counts(&s).iterations <= 8 + 3);
  LinearCheckGetCounts(s.check, &counts);
  assert_true(counts.refined == 0 && counts.inaccurate == 0);
  assert_int_equal(SolverDestroy(&s), 0);
}

static void test_new_pattern_is_served_and_factored(void **state)
{
  Solver s;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 0, PETSC_TRUE) < 1e-12);
  assert_true(Solve(&s, 0, 0, PETSC_TRUE, 1, PETSC_TRUE) < 1e-5);
  assert_true(Counts(&s).made == 1);
  assert_true(Solve(&s, 1, 1, PETSC_TRUE, 24, PETSC_FALSE) < 1e-12);
  assert_true(Counts(&s).made == 2);
  assert_int_equal(SolverDestroy(&s), 0);
}

/* What ends Newton's method is enough, however small the right-hand side. */
static void test_no_more_than_enough(void **state)
{
  Solver    s;
  PetscReal residual;

  (void)state;
  assert_int_equal(SolverCreate(&s), 0);
  assert_true(Solve(&s, 0, 0, PETSC_FALSE, 0, PETSC_TRUE) < 1e-12);
  assert_int_equal(ReusedFactorSetEnough(s.kept, PetscSqrtReal(SIZE)), 0); /* the norm of the right-hand side */
  residual = Solve(&s, 3, 0.1, PETSC_FALSE, 3, PETSC_FALSE);
  assert_true(residual > 1e-5 && residual <= 0.1);
  assert_int_equal(SolverDestroy(&s), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_factor_serves_until_much_has_changed),
                                     cmocka_unit_test(test_told_of_changes_it_needs_no_iterations),
                                     cmocka_unit_test(test_new_step_has_its_own_factor),
                                     cmocka_unit_test(test_gives_up_and_factors),
                                     cmocka_unit_test(test_new_pattern_is_served_and_factored),
                                     cmocka_unit_test(test_no_more_than_enough)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
