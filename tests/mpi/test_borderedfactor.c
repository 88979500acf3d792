/* Factors with a border: two plates of springs, K, and links from nodes of one to many of the other, C, which is a sum
 * of v v^T. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>
#include "linear/directsolver.h"
#include "linear/reusedfactor.h"
#include "linear/linearcheck.h"
#include "solution.h"
#include "matrix/sumoperator.h"

enum {
  EDGE   = 24,
  DOFS   = 2,
  PLATE  = EDGE * EDGE,
  NODES  = 2 * PLATE,
  REACH  = 2,
  LINKED = 1 + (2 * REACH + 1) * (2 * REACH + 1),
  MOST   = 3 * EDGE
};

/* Links of this rank, which may be between rows of others. */
typedef struct {
  PetscInt    n, ptr[MOST + 1], row[MOST * LINKED * DOFS];
  PetscScalar value[MOST * LINKED * DOFS];
  Border      border;
} Links;

typedef struct {
  Mat   K, C, A;
  Links links;
} Plates;

static PetscErrorCode NewMatrix(PetscInt row, Mat *A)
{
  PetscFunctionBeginUser;
  PetscCall(
    MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, NODES * DOFS, NODES * DOFS, row, NULL, row, NULL, A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Assemble(Mat A)
{
  PetscFunctionBeginUser;
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds k times the block of nodes i and j, on the first rank. */
static PetscErrorCode AddBlock(Mat A, PetscInt i, PetscInt j, PetscReal k)
{
  const PetscInt  rows[DOFS] = {i * DOFS, i * DOFS + 1}, columns[DOFS] = {j * DOFS, j * DOFS + 1};
  const PetscReal value[DOFS * DOFS] = {k, 0.1 * k, 0.1 * k, k};

  PetscFunctionBeginUser;
  PetscCall(MatSetValues(A, DOFS, rows, DOFS, columns, value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two plates of springs; ground: what holds each node of the second one, those of the first are held. */
static PetscErrorCode AddPlates(PetscReal ground, Mat K)
{
  const PetscInt step[] = {1, EDGE};
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (PetscInt i = 0; i < NODES && !rank; i++) {
    PetscCall(AddBlock(K, i, i, i < PLATE ? 0.1 : ground));
    for (int d = 0; d < 2; d++) {
      const PetscInt j = i + step[d];

      if (i % PLATE / step[d] % EDGE == EDGE - 1) continue;
      PetscCall(AddBlock(K, i, i, 1));
      PetscCall(AddBlock(K, j, j, 1));
      PetscCall(AddBlock(K, i, j, -1));
      PetscCall(AddBlock(K, j, i, -1));
    }
  }
  PetscCall(Assemble(K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A link of stiffness k^2 from a node of the second plate to those around the same place of the first one */
static void AddLink(Links *links, PetscInt place, PetscReal k)
{
  const PetscInt x = place % EDGE, y = place / EDGE;
  PetscInt       n = links->ptr[links->n], around = 0;

  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt i = 0; i < PLATE; i++) {
      if (PetscAbsInt(i % EDGE - x) > REACH || PetscAbsInt(i / EDGE - y) > REACH) continue;
      around += pass == 0;
      for (int d = 0; d < DOFS && pass == 1; d++) {
        links->row[n]     = i * DOFS + d;
        links->value[n++] = -k * (d == 0 ? 1 : 0.5) / around;
      }
    }
  }
  for (int d = 0; d < DOFS; d++) {
    links->row[n]     = (PLATE + place) * DOFS + d;
    links->value[n++] = k * (d == 0 ? 1 : 0.5);
  }
  links->ptr[++links->n] = n;
}

/* A strip of links along the plates, shared by the ranks in turn. */
static PetscErrorCode AddLinks(PetscInt from, PetscInt n, PetscReal k, Links *links)
{
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  links->n = links->ptr[0] = 0;
  for (PetscInt i = 0; i < n; i++)
    if ((i + 1) % size == rank) AddLink(links, from + i, k * (1 + 0.1 * (PetscReal)(i % 3)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C and A from the links. */
static PetscErrorCode Sum(Plates *plates)
{
  Links *links = &plates->links;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&plates->C));
  PetscCall(MatDestroy(&plates->A));
  PetscCall(NewMatrix(LINKED * DOFS, &plates->C));
  for (PetscInt v = 0; v < links->n; v++) {
    const PetscInt   n = links->ptr[v + 1] - links->ptr[v], *row = &links->row[links->ptr[v]];
    const PetscReal *value = &links->value[links->ptr[v]];

    for (PetscInt i = 0; i < n; i++)
      for (PetscInt j = 0; j < n; j++)
        PetscCall(MatSetValue(plates->C, row[i], row[j], value[i] * value[j], ADD_VALUES));
  }
  PetscCall(Assemble(plates->C));
  PetscCall(MatDuplicate(plates->K, MAT_COPY_VALUES, &plates->A));
  PetscCall(MatAXPY(plates->A, 1, plates->C, DIFFERENT_NONZERO_PATTERN));
  links->border = (Border){.n = links->n, .ptr = links->ptr, .row = links->row, .value = links->value};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PlatesCreate(PetscReal ground, Plates *plates)
{
  memset(plates, 0, sizeof(*plates));
  assert_int_equal(NewMatrix(5 * DOFS, &plates->K), 0);
  assert_int_equal(AddPlates(ground, plates->K), 0);
}

static void PlatesDestroy(Plates *plates)
{
  assert_int_equal(MatDestroy(&plates->K), 0);
  assert_int_equal(MatDestroy(&plates->C), 0);
  assert_int_equal(MatDestroy(&plates->A), 0);
}

static void NewFactor(Mat K, Factor *factor)
{
  PCFailedReason reason;

  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, factor), 0);
  assert_int_equal(FactorPrepareBorder(*factor, K, &reason), 0);
  assert_int_equal(reason, PC_NOERROR);
}

/* Largest relative residual of a solution, and of columns solved for at once */
static PetscErrorCode Miss(Factor factor, Mat A, PetscReal *miss)
{
  PetscInt  rows;
  PetscReal left;
  Mat       B, X, R;

  PetscFunctionBeginUser;
  PetscCall(SolutionMiss(factor, A, PETSC_FALSE, miss));
  PetscCall(MatGetLocalSize(A, &rows, NULL));
  PetscCall(MatCreateDense(PETSC_COMM_WORLD, rows, PETSC_DECIDE, PETSC_DETERMINE, 3, NULL, &B));
  for (PetscInt j = 0; j < 3; j++) PetscCall(MatSetValue(B, 7 + 5 * j, j, 1, INSERT_VALUES));
  PetscCall(Assemble(B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(FactorSolveColumns(factor, B, X));
  PetscCall(MatMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &R));
  PetscCall(MatAXPY(R, -1, B, SAME_NONZERO_PATTERN));
  PetscCall(MatNorm(R, NORM_FROBENIUS, &left));
  *miss = PetscMax(*miss, left);
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&R));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MakeAndSolve(Factor factor, const Plates *plates, PetscBool bordered)
{
  PCFailedReason reason;
  PetscReal      miss;

  assert_int_equal(FactorSetBorder(factor, bordered ? &plates->links.border : NULL), 0);
  assert_int_equal(FactorMake(factor, bordered ? plates->K : plates->A, &reason), 0);
  assert_int_equal(reason, PC_NOERROR);
  assert_int_equal(Miss(factor, plates->A, &miss), 0);
  assert_true(miss < 1e-10);
}

static PetscReal Operations(Factor factor)
{
  FactorCost cost;

  FactorGetCost(factor, &cost);
  return cost.operations;
}

/* The same solutions as with the sum, for other values, more links, other ones and none; and with the sum in between.
 */
static void test_links(void **state)
{
  static Plates plates;
  PetscReal     operations;
  Factor        factor;

  (void)state;
  PlatesCreate(0.1, &plates);
  NewFactor(plates.K, &factor);
  assert_int_equal(AddLinks(2 * EDGE, EDGE, 10, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  operations = Operations(factor);
  assert_int_equal(AddLinks(2 * EDGE, EDGE, 20, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  assert_true(Operations(factor) == operations);
  assert_int_equal(AddLinks(EDGE, MOST, 20, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  operations = Operations(factor);
  MakeAndSolve(factor, &plates, PETSC_FALSE);
  assert_true(Operations(factor) != operations);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  assert_true(Operations(factor) == operations);
  assert_int_equal(AddLinks(0, 0, 20, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  assert_int_equal(FactorDestroy(&factor), 0);
  PlatesDestroy(&plates);
}

/* Links that hold the second plate in both directions, and their sum. */
static PetscErrorCode HoldPlate(Plates *plates)
{
  PetscFunctionBeginUser;
  PetscCall(AddLinks(EDGE, MOST, 3, &plates->links));
  for (PetscInt v = 0; v < plates->links.n; v++) {
    const PetscInt end = plates->links.ptr[v + 1];

    for (PetscInt k = plates->links.ptr[v]; k < end; k++)
      if (k % DOFS == v % DOFS) plates->links.value[k] *= 0.1;
  }
  PetscCall(Sum(plates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K alone is singular where only the links hold the second plate, or where it has no stiffness at all in a node. */
static void test_plate_held_by_links(void **state)
{
  static Plates plates;
  Factor        factor;

  (void)state;
  PlatesCreate(0, &plates);
  assert_int_equal(HoldPlate(&plates), 0);
  NewFactor(plates.K, &factor);
  MakeAndSolve(factor, &plates, PETSC_TRUE);
  assert_int_equal(FactorDestroy(&factor), 0);
  PlatesDestroy(&plates);
}

/* The sum of K and C multiplies as A does, and is A when it is merged; other matrices are no such sums. */
static void test_sum_of_terms(void **state)
{
  static Plates plates;
  PetscReal     miss, norm;
  Mat           sum, whole;
  Vec           x, y, z;

  (void)state;
  PlatesCreate(0.1, &plates);
  assert_int_equal(AddLinks(2 * EDGE, EDGE, 10, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  assert_int_equal(SumOperatorCreate(plates.K, &sum), 0);
  assert_int_equal(MatCreateVecs(sum, &x, &y), 0);
  assert_int_equal(VecDuplicate(y, &z), 0);
  assert_int_equal(VecSetRandom(x, NULL), 0);
  for (int terms = 1; terms <= 2; terms++) {
    const Mat A = terms == 1 ? plates.K : plates.A;

    if (terms == 2) assert_int_equal(SumOperatorSet(sum, plates.C), 0);
    assert_int_equal(MatMult(sum, x, y), 0);
    assert_int_equal(MatMult(A, x, z), 0);
    assert_int_equal(VecNorm(z, NORM_2, &norm), 0);
    assert_int_equal(VecAXPY(z, -1, y), 0);
    assert_int_equal(VecNorm(z, NORM_2, &miss), 0);
    assert_true(miss < 1e-14 * norm);
    assert_int_equal(SumOperatorMerge(sum, &whole), 0);
    assert_int_equal(MatAXPY(whole, -1, A, DIFFERENT_NONZERO_PATTERN), 0);
    assert_int_equal(MatNorm(whole, NORM_FROBENIUS, &miss), 0);
    assert_true(miss < 1e-14 * norm);
    assert_int_equal(MatDestroy(&whole), 0);
  }
  assert_int_equal(SumOperatorMerge(plates.A, &whole), 0);
  assert_null(whole);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&y), 0);
  assert_int_equal(VecDestroy(&z), 0);
  assert_int_equal(MatDestroy(&sum), 0);
  PlatesDestroy(&plates);
}

/* A solver of K and C that is told of the first `told` links of each rank, their stiffness taken `times` as large:
 * relative residual, and what it took */
static void SolveTold(Plates *plates, PetscInt told, PetscReal times, PetscReal *miss, LinearCounts *counts)
{
  Links         *links  = &plates->links;
  Border         border = links->border;
  PetscReal      right;
  PCFailedReason reason;
  PetscBool      serves;
  LinearCheck    check;
  ReusedFactor   kept;
  Factor         factor;
  Mat            sum;
  Vec            b, x, r;
  KSP            ksp;

  border.n = PetscMin(told, links->n);
  for (PetscInt k = 0; k < links->ptr[links->n]; k++) links->value[k] *= PetscSqrtReal(times);
  assert_int_equal(SumOperatorCreate(plates->K, &sum), 0);
  assert_int_equal(SumOperatorSet(sum, plates->C), 0);
  assert_int_equal(MatCreateVecs(sum, &x, &b), 0);
  assert_int_equal(VecDuplicate(b, &r), 0);
  assert_int_equal(VecSetRandom(b, NULL), 0);
  assert_int_equal(KSPCreate(PETSC_COMM_WORLD, &ksp), 0);
  assert_int_equal(DirectSolverSet(ksp, PETSC_TRUE), 0);
  assert_int_equal(ReusedFactorCreate(ksp, &kept), 0);
  assert_int_equal(LinearCheckCreate(ksp, 1e-8, kept, &check), 0);
  assert_int_equal(DirectSolverFactor(ksp, &factor), 0);
  assert_int_equal(FactorPrepareBorder(factor, plates->K, &reason), 0);
  assert_int_equal(FactorSetBorder(factor, &border), 0);
  assert_int_equal(ReusedFactorNext(kept, 0, PETSC_TRUE, &serves), 0);
  assert_int_equal(KSPSetOperators(ksp, sum, plates->K), 0);
  assert_int_equal(KSPSolve(ksp, b, x), 0);
  assert_false(LinearCheckLost(check));
  LinearCheckGetCounts(check, counts);
  assert_int_equal(MatMult(plates->A, x, r), 0);
  assert_int_equal(VecAXPY(r, -1, b), 0);
  assert_int_equal(VecNorm(r, NORM_2, miss), 0);
  assert_int_equal(VecNorm(b, NORM_2, &right), 0);
  *miss /= right;
  assert_int_equal(VecDestroy(&b), 0);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&r), 0);
  assert_int_equal(MatDestroy(&sum), 0);
  assert_int_equal(KSPDestroy(&ksp), 0);
  assert_int_equal(LinearCheckDestroy(&check), 0);
  assert_int_equal(ReusedFactorDestroy(&kept), 0);
}

/* What the border leaves out of C is made up for by iterations where it is small, else by a factor of the whole; so is
 * a bordered factor that cannot be. */
static void test_solver_makes_up_for_what_is_left_out(void **state)
{
  const PetscInt loose = (PLATE + EDGE + 4) * DOFS; /* held by a link only */
  static Plates  plates;
  LinearCounts   counts;
  PetscReal      miss;

  (void)state;
  PlatesCreate(0.1, &plates);
  assert_int_equal(AddLinks(2 * EDGE, EDGE, 10, &plates.links), 0);
  assert_int_equal(Sum(&plates), 0);
  SolveTold(&plates, MOST, 1, &miss, &counts);
  assert_true(miss < 1e-10 && counts.kept.made == 1 && counts.kept.finishing == 0);
  SolveTold(&plates, MOST, 1.01, &miss, &counts);
  assert_true(miss < 1.1e-5 && counts.kept.made == 1 && counts.kept.finishing > 0 && counts.kept.finishing < 4);
  SolveTold(&plates, 0, 1, &miss, &counts);
  assert_true(miss < 1e-10 && counts.kept.made == 2);
  PlatesDestroy(&plates);
  PlatesCreate(0.1, &plates);
  assert_int_equal(MatSetOption(plates.K, MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE), 0);
  assert_int_equal(MatZeroRowsColumns(plates.K, 1, &loose, 0, NULL, NULL), 0);
  assert_int_equal(HoldPlate(&plates), 0);
  SolveTold(&plates, 0, 1, &miss, &counts); /* K alone cannot be factored */
  assert_true(miss < 1e-10 && counts.kept.made == 1 && counts.kept.finishing == 0);
  PlatesDestroy(&plates);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_links), cmocka_unit_test(test_plate_held_by_links),
                                     cmocka_unit_test(test_sum_of_terms),
                                     cmocka_unit_test(test_solver_makes_up_for_what_is_left_out)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
