/* Factors of grids: each ordering, symmetric or not, other values, other patterns and singular ones; solves with the
 * transposed matrix; and what dissection costs. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "solution.h"

enum { EDGE = 12, DOFS = 2 };

/* Adds the block of nodes i and j: springs of k in every direction, and `skew` that only one way knows of. */
static PetscErrorCode AddBlock(Mat A, PetscInt i, PetscInt j, PetscReal k, PetscReal skew)
{
  PetscInt  first, end, rows[DOFS], columns[DOFS];
  PetscReal value[DOFS * DOFS] = {k, 0.1 * k, 0.1 * k, k};

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &first, &end));
  value[1] += i < j ? skew : i > j ? -skew : 0;
  for (int d = 0; d < DOFS; d++) {
    rows[d]    = i * DOFS + d;
    columns[d] = j * DOFS + d;
    if (rows[d] < first || rows[d] >= end) rows[d] = -1; /* another rank's */
  }
  PetscCall(MatSetValues(A, DOFS, rows, DOFS, columns, value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* EDGE^3 nodes, coupled to the six next to them; ground: stiffness of the springs that hold each. */
static PetscErrorCode Grid(PetscReal ground, PetscReal skew, Mat *A)
{
  const PetscInt n = EDGE * EDGE * EDGE, step[] = {1, EDGE, EDGE * EDGE};

  PetscFunctionBeginUser;
  PetscCall(
    MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n * DOFS, n * DOFS, 7 * DOFS, NULL, 7 * DOFS, NULL, A));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(AddBlock(*A, i, i, ground, 0));
    for (int d = 0; d < 3; d++) {
      const PetscInt j = i + step[d];

      if (i / step[d] % EDGE == EDGE - 1) continue;
      PetscCall(AddBlock(*A, i, i, 1, 0));
      PetscCall(AddBlock(*A, j, j, 1, 0));
      PetscCall(AddBlock(*A, i, j, -1, skew));
      PetscCall(AddBlock(*A, j, i, -1, skew));
    }
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MakeAndSolve(Factor factor, Mat A)
{
  PCFailedReason reason;
  PetscReal      miss;

  assert_int_equal(FactorMake(factor, A, &reason), 0);
  assert_int_equal(reason, PC_NOERROR);
  assert_int_equal(SolutionMiss(factor, A, PETSC_FALSE, &miss), 0);
  assert_true(miss < 1e-11);
}

static void Solves(PetscBool symmetric, int ordering)
{
  Factor factor;
  Mat    A;

  assert_int_equal(Grid(0.1, symmetric ? 0 : 0.3, &A), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, symmetric, &factor), 0);
  assert_int_equal(FactorSetOrdering(factor, ordering, NULL), 0);
  MakeAndSolve(factor, A);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

static void test_orderings(void **state)
{
  const int orderings[] = {FACTOR_AUTOMATIC, FACTOR_MINIMUM_DEGREE, FACTOR_MINIMUM_FILL, FACTOR_METIS};

  (void)state;
  for (size_t i = 0; i < sizeof(orderings) / sizeof(orderings[0]); i++)
    for (int symmetric = 0; symmetric < 2; symmetric++) Solves((PetscBool)symmetric, orderings[i]);
}

static void test_other_values_and_patterns(void **state)
{
  Factor factor;
  Mat    A, other;

  (void)state;
  assert_int_equal(Grid(0.1, 0, &A), 0);
  assert_int_equal(Grid(0.2, 0, &other), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, &factor), 0);
  assert_int_equal(FactorSetOrdering(factor, FACTOR_METIS, NULL), 0);
  MakeAndSolve(factor, A);
  assert_int_equal(MatScale(A, 3), 0);
  MakeAndSolve(factor, A);
  MakeAndSolve(factor, other);
  assert_int_equal(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE), 0);
  assert_int_equal(AddBlock(A, 0, EDGE * EDGE * EDGE - 1, -0.5, 0), 0);
  assert_int_equal(AddBlock(A, EDGE * EDGE * EDGE - 1, 0, -0.5, 0), 0);
  assert_int_equal(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY), 0);
  MakeAndSolve(factor, A);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
  assert_int_equal(MatDestroy(&other), 0);
}

/* Turns the rows of each node about, so that the largest entries, which pivots are chosen from, are off the diagonal.
 */
static PetscErrorCode TurnRows(Mat *A)
{
  PetscInt first, end, *from;
  IS       rows, columns;
  Mat      turned;
  Vec      none;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(*A, &first, &end));
  PetscCall(PetscMalloc1(end - first, &from));
  for (PetscInt i = first; i < end; i++) from[i - first] = i % DOFS ? i - 1 : i + 1;
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, end - first, from, PETSC_OWN_POINTER, &rows));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, end - first, first, 1, &columns));
  PetscCall(ISSetPermutation(rows));
  PetscCall(ISSetPermutation(columns));
  PetscCall(MatPermute(*A, rows, columns, &turned));
  PetscCall(MatCreateVecs(turned, &none, NULL));
  PetscCall(VecSet(none, 0));
  PetscCall(MatDiagonalSet(turned, none, INSERT_VALUES));
  PetscCall(VecDestroy(&none));
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(A));
  *A = turned;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Miss(Factor factor, Mat A, PetscBool transposed)
{
  PetscReal miss;

  assert_int_equal(SolutionMiss(factor, A, transposed, &miss), 0);
  return miss;
}

/* Solves with the transposed matrix lie where those with the matrix lay, and the other way round, though pivots are off
   the diagonal. */
static void test_transposed(void **state)
{
  Factor factor;
  Mat    A;

  (void)state;
  assert_int_equal(Grid(0.1, 0.3, &A), 0);
  assert_int_equal(TurnRows(&A), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_FALSE, &factor), 0);
  MakeAndSolve(factor, A);
  assert_true(Miss(factor, A, PETSC_TRUE) < 1e-11);
  assert_true(Miss(factor, A, PETSC_FALSE) < 1e-11);
  assert_true(Miss(factor, A, PETSC_TRUE) < 1e-11);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

/* A matrix of zeros has no factor: that is told, solutions are infinite, and the next matrix is solved with all the
 * same. */
static void test_singular(void **state)
{
  PCFailedReason reason;
  PetscReal      miss;
  Factor         factor;
  Mat            A, zero;

  (void)state;
  assert_int_equal(Grid(0.1, 0, &A), 0);
  assert_int_equal(MatDuplicate(A, MAT_COPY_VALUES, &zero), 0);
  assert_int_equal(MatScale(zero, 0), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, &factor), 0);
  assert_int_equal(FactorMake(factor, zero, &reason), 0);
  assert_int_not_equal(reason, PC_NOERROR);
  assert_int_equal(SolutionMiss(factor, zero, PETSC_FALSE, &miss), 0);
  assert_true(PetscIsInfOrNanReal(miss));
  MakeAndSolve(factor, A);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
  assert_int_equal(MatDestroy(&zero), 0);
}

static PetscReal Operations(Mat A, int ordering)
{
  PCFailedReason reason;
  FactorCost     cost;
  Factor         factor;

  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, &factor), 0);
  assert_int_equal(FactorSetOrdering(factor, ordering, NULL), 0);
  assert_int_equal(FactorAnalyse(factor, A, &reason), 0);
  assert_int_equal(reason, PC_NOERROR);
  FactorGetCost(factor, &cost);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_true(cost.entries > 0 && cost.memory_mb[0] > 0 && cost.memory_mb[1] >= cost.memory_mb[0]);
  return cost.operations;
}

/* A wrong order would take ten times as many. */
static void test_dissection_costs(void **state)
{
  Mat A;

  (void)state;
  assert_int_equal(Grid(0.1, 0, &A), 0);
  assert_true(Operations(A, FACTOR_METIS) < 1.5 * Operations(A, FACTOR_MINIMUM_DEGREE));
  assert_int_equal(MatDestroy(&A), 0);
}

static PetscReal Cost(Factor factor)
{
  FactorCost cost;

  FactorGetCost(factor, &cost);
  return cost.operations;
}

/* Another ordering counts, for a matrix that has been analysed too. */
static void test_other_ordering(void **state)
{
  PCFailedReason reason;
  PetscReal      first;
  Factor         factor;
  Mat            A;

  (void)state;
  assert_int_equal(Grid(0.1, 0, &A), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, &factor), 0);
  assert_int_equal(FactorSetOrdering(factor, FACTOR_METIS, NULL), 0);
  assert_int_equal(FactorAnalyse(factor, A, &reason), 0);
  first = Cost(factor);
  assert_int_equal(FactorSetOrdering(factor, FACTOR_MINIMUM_DEGREE, NULL), 0);
  assert_int_equal(FactorAnalyse(factor, A, &reason), 0);
  assert_true(Cost(factor) != first);
  assert_int_equal(FactorSetOrdering(factor, FACTOR_METIS, NULL), 0);
  MakeAndSolve(factor, A);
  assert_true(Cost(factor) == first);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

/* Two unknowns: from three ranks on at least one has none. */
static void test_ranks_without_rows(void **state)
{
  PetscInt first, end;
  Factor   factor;
  Mat      A;

  (void)state;
  assert_int_equal(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 2, 2, 2, NULL, 2, NULL, &A), 0);
  assert_int_equal(MatGetOwnershipRange(A, &first, &end), 0);
  for (PetscInt i = first; i < end; i++)
    for (PetscInt j = 0; j < 2; j++) assert_int_equal(MatSetValue(A, i, j, i == j ? 2 : -1, INSERT_VALUES), 0);
  assert_int_equal(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY), 0);
  assert_int_equal(FactorCreate(PETSC_COMM_WORLD, PETSC_TRUE, &factor), 0);
  MakeAndSolve(factor, A);
  MakeAndSolve(factor, A);
  assert_int_equal(FactorDestroy(&factor), 0);
  assert_int_equal(MatDestroy(&A), 0);
}

/* Whether a value of one of MUMPS's parameters is refused. */
static PetscBool Refused(const char *name, const char *value)
{
  PetscErrorCode code;

  assert_int_equal(PetscOptionsSetValue(NULL, name, value), 0);
  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  code = FactorCheckOptions();
  assert_int_equal(PetscPopErrorHandler(), 0);
  assert_int_equal(PetscOptionsClearValue(NULL, name), 0);
  return code ? PETSC_TRUE : PETSC_FALSE;
}

/* MUMPS's parameters: ranges, more than one range, parameters of the program's own, and any value where MUMPS has no
   range. */
static void test_options(void **state)
{
  (void)state;
  assert_false(Refused("-mat_mumps_icntl_7", "5"));
  assert_true(Refused("-mat_mumps_icntl_7", "8"));
  assert_true(Refused("-mat_mumps_icntl_7", "metis"));
  assert_false(Refused("-mat_mumps_icntl_8", "77"));
  assert_true(Refused("-mat_mumps_icntl_8", "-1"));
  assert_true(Refused("-mat_mumps_icntl_8", "9"));
  assert_true(Refused("-mat_mumps_icntl_10", "2"));
  assert_true(Refused("-mat_mumps_icntl_14", "-1"));
  assert_true(Refused("-mat_mumps_icntl_15", "1"));
  assert_true(Refused("-mat_mumps_icntl_18", "0"));
  assert_true(Refused("-mat_mumps_icntl_21", "1"));
  assert_false(Refused("-mat_mumps_icntl_13", "-7"));
  assert_false(Refused("-mat_mumps_cntl_1", "0.1"));
  assert_true(Refused("-mat_mumps_cntl_1", "1.5"));
  assert_true(Refused("-mat_mumps_cntl_7", "-1e-9"));
  assert_true(Refused("-mat_mumps_cntl_3", "nan"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_orderings),      cmocka_unit_test(test_other_values_and_patterns),
    cmocka_unit_test(test_singular),       cmocka_unit_test(test_dissection_costs),
    cmocka_unit_test(test_other_ordering), cmocka_unit_test(test_ranks_without_rows),
    cmocka_unit_test(test_options),        cmocka_unit_test(test_transposed)};
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
