/* A factor with an update solves with the changed matrix; changes that come one after another add up, opposite ones
 * cancel, and one that leaves the matrix singular leaves the solution of the old one. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "linear/directsolver.h"
#include "rankupdate.h"

enum { SIZE = 40, CHANGES = 3 };

/* A chain of springs, the first row held; some others by springs of s that act on the difference to their neighbour's
 * neighbour. */
static PetscErrorCode Chain(PetscInt n, const PetscReal *s, Mat *A)
{
  const PetscReal   spring[]  = {1, -1, -1, 1};
  const PetscMPIInt first_one = 0;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, SIZE, SIZE, 5, NULL, 5, NULL, A));
  for (PetscInt i = 0; i < SIZE - 1 && rank == first_one; i++) {
    const PetscInt ends[] = {i, i + 1};

    PetscCall(MatSetValues(*A, 2, ends, 2, ends, spring, ADD_VALUES));
  }
  if (rank == first_one) PetscCall(MatSetValue(*A, 0, 0, 1, ADD_VALUES));
  for (PetscInt k = 0; k < n && rank == first_one; k++) {
    const PetscInt  ends[] = {12 * k + 1, 12 * k + 3};
    const PetscReal more[] = {s[k], -s[k], -s[k], s[k]};

    PetscCall(MatSetValues(*A, 2, ends, 2, ends, more, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vectors of springs first to end - 1 of Chain() */
static PetscErrorCode Vectors(Mat A, PetscInt first, PetscInt end, Mat *N)
{
  PetscInt    m;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(MatGetLocalSize(A, &m, NULL));
  PetscCall(MatCreateDense(PETSC_COMM_WORLD, m, PETSC_DECIDE, SIZE, end - first, NULL, N));
  for (PetscInt k = first; k < end && !rank; k++) {
    PetscCall(MatSetValue(*N, 12 * k + 1, k - first, 1, ADD_VALUES));
    PetscCall(MatSetValue(*N, 12 * k + 3, k - first, -1, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(*N, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*N, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  KSP        ksp;
  Mat        A;
  Vec        b, x, r;
  RankUpdate update;
} Case;

static void Begin(Case *t)
{
  *t = (Case){.update = NULL};
  assert_int_equal(Chain(0, NULL, &t->A), 0);
  assert_int_equal(KSPCreate(PETSC_COMM_WORLD, &t->ksp), 0);
  assert_int_equal(DirectSolverSet(t->ksp, PETSC_TRUE), 0);
  assert_int_equal(KSPSetOperators(t->ksp, t->A, t->A), 0);
  assert_int_equal(MatCreateVecs(t->A, &t->x, &t->b), 0);
  assert_int_equal(VecDuplicate(t->b, &t->r), 0);
  assert_int_equal(VecSet(t->b, 1), 0);
  assert_int_equal(KSPSolve(t->ksp, t->b, t->x), 0);
}

static void End(Case *t)
{
  assert_int_equal(RankUpdateDestroy(&t->update), 0);
  assert_int_equal(KSPDestroy(&t->ksp), 0);
  assert_int_equal(MatDestroy(&t->A), 0);
  assert_int_equal(VecDestroy(&t->b), 0);
  assert_int_equal(VecDestroy(&t->x), 0);
  assert_int_equal(VecDestroy(&t->r), 0);
}

static void Add(Case *t, PetscInt first, PetscInt end, const PetscReal *s)
{
  PC  pc;
  Mat N;

  assert_int_equal(KSPGetPC(t->ksp, &pc), 0);
  assert_int_equal(Vectors(t->A, first, end, &N), 0);
  assert_int_equal(RankUpdateAdd(&t->update, pc, N, s), 0);
  assert_int_equal(MatDestroy(&N), 0);
}

/* Relative residual of the updated solution in the chain with springs s */
static PetscReal Residual(Case *t, PetscInt n, const PetscReal *s)
{
  PetscReal norm, right;
  Mat       changed;

  assert_int_equal(KSPSolve(t->ksp, t->b, t->x), 0);
  assert_int_equal(RankUpdateApply(t->update, t->x), 0);
  assert_int_equal(Chain(n, s, &changed), 0);
  assert_int_equal(MatMult(changed, t->x, t->r), 0);
  assert_int_equal(MatDestroy(&changed), 0);
  assert_int_equal(VecAXPY(t->r, -1, t->b), 0);
  assert_int_equal(VecNorm(t->r, NORM_2, &norm), 0);
  assert_int_equal(VecNorm(t->b, NORM_2, &right), 0);
  return norm / right;
}

static void test_changes_add_up(void **state)
{
  const PetscReal s[CHANGES] = {100, -0.3, 5};
  Case            t;

  (void)state;
  Begin(&t);
  Add(&t, 0, 2, s);
  assert_true(Residual(&t, 2, s) < 1e-11);
  Add(&t, 2, 3, &s[2]);
  assert_true(Residual(&t, 3, s) < 1e-11);
  End(&t);
}

/* Exactly, but for what cancels in the core. */
static void test_opposite_changes_cancel(void **state)
{
  const PetscReal s[CHANGES] = {100, 7, 5}, back[CHANGES] = {-100, -7, -5}, none[CHANGES] = {0, 0, 0};
  Case            t;

  (void)state;
  Begin(&t);
  Add(&t, 0, 3, s);
  Add(&t, 0, 3, back);
  assert_true(Residual(&t, 3, none) < 1e-9);
  End(&t);
}

/* A spring of -1/2 beside two of 1 in a row: nothing holds the far end. */
static void test_singular_sum_is_left_alone(void **state)
{
  const PetscReal s[] = {-0.5};
  Case            t;

  (void)state;
  Begin(&t);
  Add(&t, 0, 1, s);
  assert_true(Residual(&t, 0, NULL) < 1e-11 ||
              !(Residual(&t, 1, s) < 1e-3)); /* the core's pivot may be round-off instead of zero */
  End(&t);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_changes_add_up),
                                     cmocka_unit_test(test_opposite_changes_cancel),
                                     cmocka_unit_test(test_singular_sum_is_left_alone)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
