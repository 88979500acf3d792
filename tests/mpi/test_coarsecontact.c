/* Contact on the coarse levels of multigrid: each level gets the bodies' matrix and contact's product with the
   interpolations, softer by the level's spacing; what is kept comes back; where the bodies' matrices are kept multigrid
   does the same as where they are not; options that give eigenvalues hold. */
#include "coarsecontact.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Nodes along the sides of a rectangle; its left and right halves are the bodies, which touch in the middle. */
enum { WIDTH = 24, HEIGHT = 20, DIM = 2, MOST_LEVELS = 10 };

static const PetscReal EXACT = 1e-12, SOFTNESS = 0.25, STIFFNESS = 50;

#define EIGENVALUES "-mg_levels_ksp_chebyshev_eigenvalues"

static PetscErrorCode CreateMatrix(Mat *A)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreate(PETSC_COMM_WORLD, A));
  PetscCall(MatSetSizes(*A, PETSC_DECIDE, PETSC_DECIDE, WIDTH * HEIGHT, WIDTH * HEIGHT));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetUp(*A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a spring between two nodes. */
static PetscErrorCode Spring(Mat A, PetscInt a, PetscInt b, PetscReal stiffness)
{
  const PetscInt    node[]  = {a, b};
  const PetscScalar value[] = {stiffness, -stiffness, -stiffness, stiffness};

  return MatSetValues(A, 2, node, 2, node, value, ADD_VALUES);
}

/* The bodies, which are held a little at each node, and contact between them. */
static PetscErrorCode CreateBodies(Mat *bodies, Mat *contact)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(CreateMatrix(bodies));
  PetscCall(CreateMatrix(contact));
  for (PetscInt i = 0; i < WIDTH * HEIGHT && !rank; i++) {
    const PetscInt  column = i % WIDTH;
    const PetscBool border = (PetscBool)(column == WIDTH / 2 - 1);

    PetscCall(MatSetValue(*bodies, i, i, 0.01, ADD_VALUES));
    if (column + 1 < WIDTH) PetscCall(Spring(border ? *contact : *bodies, i, i + 1, border ? STIFFNESS : 1));
    if (i + WIDTH < WIDTH * HEIGHT) PetscCall(Spring(*bodies, i, i + WIDTH, 1));
  }
  for (int k = 0; k < 2; k++) {
    PetscCall(MatAssemblyBegin(k ? *contact : *bodies, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(k ? *contact : *bodies, MAT_FINAL_ASSEMBLY));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMultigrid(Mat bodies, PC *pc)
{
  PetscFunctionBeginUser;
  PetscCall(PCCreate(PETSC_COMM_WORLD, pc));
  PetscCall(PCSetType(*pc, PCGAMG));
  PetscCall(PCGAMGSetReuseInterpolation(*pc, PETSC_TRUE));
  PetscCall(PCGAMGSetCoarseEqLim(*pc, 12));
  PetscCall(PCSetFromOptions(*pc));
  PetscCall(PCSetOperators(*pc, bodies, bodies));
  PetscCall(PCSetUp(*pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds contact by its rows that are not empty. */
static PetscErrorCode AddContact(PC pc, Mat contact, PetscBool keep)
{
  PetscInt begin, end, n = 0, *row;
  IS       rows;
  Mat      part;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(contact, &begin, &end));
  PetscCall(PetscMalloc1(end - begin, &row));
  for (PetscInt i = begin; i < end; i++)
    if (i % WIDTH == WIDTH / 2 - 1 || i % WIDTH == WIDTH / 2) row[n++] = i;
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n, row, PETSC_OWN_POINTER, &rows));
  PetscCall(MatCreateSubMatrix(contact, rows, rows, MAT_INITIAL_MATRIX, &part));
  PetscCall(CoarseContactAdd(pc, part, rows, SOFTNESS, DIM, keep));
  PetscCall(MatDestroy(&part));
  PetscCall(ISDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Level(PC pc, PetscInt l, KSP *level, Mat *mat)
{
  PetscFunctionBeginUser;
  PetscCall(PCMGGetSmoother(pc, l, level));
  PetscCall(KSPGetOperators(*level, NULL, mat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fill(Vec v)
{
  PetscInt begin, end;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(v, &begin, &end));
  for (PetscInt i = begin; i < end; i++) PetscCall(VecSetValue(v, i, PetscSinReal(3 * i + 1.), INSERT_VALUES));
  PetscCall(VecAssemblyBegin(v));
  PetscCall(VecAssemblyEnd(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* factor P^T ... P^T C P ... P x, from level l up and down again; *product: a new vector */
static PetscErrorCode MultiplyContact(PC pc, PetscInt levels, PetscInt l, Mat contact, Vec x, Vec *product)
{
  Mat P;
  Vec fine, back;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(x, product));
  if (l == levels - 1) {
    PetscCall(MatMult(contact, x, *product));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PCMGGetInterpolation(pc, l + 1, &P));
  PetscCall(MatCreateVecs(P, NULL, &fine));
  PetscCall(MatMult(P, x, fine));
  PetscCall(MultiplyContact(pc, levels, l + 1, contact, fine, &back));
  PetscCall(MatMultTranspose(P, back, *product));
  PetscCall(VecDestroy(&fine));
  PetscCall(VecDestroy(&back));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the matrix of level l multiply like `bodies` and soft contact? */
static void CheckLevel(PC pc, PetscInt levels, PetscInt l, Mat contact, Mat bodies)
{
  PetscReal norm = 0, error = 0;
  PetscInt  rows;
  KSP       level;
  Mat       sum;
  Vec       x, expected, soft;

  assert_int_equal(Level(pc, l, &level, &sum), 0);
  assert_int_equal(MatGetSize(sum, &rows, NULL), 0);
  assert_int_equal(MatCreateVecs(sum, &x, &expected), 0);
  assert_int_equal(Fill(x), 0);
  assert_int_equal(MatMult(bodies, x, expected), 0);
  assert_int_equal(MultiplyContact(pc, levels, l, contact, x, &soft), 0);
  assert_int_equal(VecAXPY(expected, SOFTNESS * PetscSqrtReal((PetscReal)rows / (WIDTH * HEIGHT)), soft), 0);
  assert_int_equal(VecNorm(expected, NORM_2, &norm), 0);
  assert_int_equal(MatMult(sum, x, soft), 0);
  assert_int_equal(VecAXPY(soft, -1, expected), 0);
  assert_int_equal(VecNorm(soft, NORM_2, &error), 0);
  assert_true(error <= EXACT * norm);
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(VecDestroy(&soft), 0);
  assert_int_equal(VecDestroy(&expected), 0);
}

/* Adds contact twice, with new coarse matrices of the bodies in between that are products of the kept ones. */
static void test_adds_and_removes(void **state)
{
  Mat      bodies, contact, kept[MOST_LEVELS], copy[MOST_LEVELS], mat;
  PetscInt levels;
  KSP      level;
  PC       pc;

  (void)state;
  assert_int_equal(CreateBodies(&bodies, &contact), 0);
  assert_int_equal(CreateMultigrid(bodies, &pc), 0);
  assert_int_equal(PCMGGetLevels(pc, &levels), 0);
  assert_in_range(levels, 3, MOST_LEVELS);
  for (int round = 0; round < 2; round++) {
    for (PetscInt l = 0; l < levels - 1; l++) {
      assert_int_equal(Level(pc, l, &level, &kept[l]), 0);
      assert_int_equal(MatDuplicate(kept[l], MAT_COPY_VALUES, &copy[l]), 0);
    }
    assert_int_equal(AddContact(pc, contact, PETSC_TRUE), 0);
    for (PetscInt l = 0; l < levels - 1; l++) CheckLevel(pc, levels, l, contact, copy[l]);
    assert_int_equal(CoarseContactRemove(pc), 0);
    for (PetscInt l = 0; l < levels - 1; l++) {
      PetscBool same = PETSC_FALSE;

      assert_int_equal(Level(pc, l, &level, &mat), 0);
      assert_ptr_equal(mat, kept[l]);
      assert_int_equal(MatEqual(mat, copy[l], &same), 0);
      assert_true(same);
      assert_int_equal(MatDestroy(&copy[l]), 0);
    }
    assert_int_equal(MatScale(bodies, 2), 0);
    assert_int_equal(PCSetUp(pc), 0);
  }
  assert_int_equal(CoarseContactRemove(pc), 0); /* nothing is there */
  assert_int_equal(PCDestroy(&pc), 0);
  assert_int_equal(MatDestroy(&bodies), 0);
  assert_int_equal(MatDestroy(&contact), 0);
}

/* Multigrid with contact, the bodies' matrices kept or not, applied to a vector; first: without contact */
static PetscErrorCode Apply(Mat bodies, Mat contact, PetscBool keep, Vec right, Vec first, Vec with)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(CreateMultigrid(bodies, &pc));
  PetscCall(PCApply(pc, right, first));
  PetscCall(AddContact(pc, contact, keep));
  PetscCall(PCApply(pc, right, with));
  PetscCall(PCDestroy(&pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_levels_follow(void **state)
{
  PetscReal norm = 0, error = 0, change = 0;
  Mat       bodies, contact;
  Vec       right, first, with, other;

  (void)state;
  assert_int_equal(CreateBodies(&bodies, &contact), 0);
  assert_int_equal(MatCreateVecs(bodies, &right, &first), 0);
  assert_int_equal(VecDuplicate(right, &with), 0);
  assert_int_equal(VecDuplicate(right, &other), 0);
  assert_int_equal(Fill(right), 0);
  assert_int_equal(Apply(bodies, contact, PETSC_TRUE, right, first, with), 0);
  assert_int_equal(Apply(bodies, contact, PETSC_FALSE, right, first, other), 0);
  assert_int_equal(VecNorm(with, NORM_2, &norm), 0);
  assert_int_equal(VecAXPY(first, -1, with), 0);
  assert_int_equal(VecNorm(first, NORM_2, &change), 0);
  assert_int_equal(VecAXPY(other, -1, with), 0);
  assert_int_equal(VecNorm(other, NORM_2, &error), 0);
  assert_true(error <= EXACT * norm);
  assert_true(change > 1e-3 * norm);
  assert_int_equal(VecDestroy(&right), 0);
  assert_int_equal(VecDestroy(&first), 0);
  assert_int_equal(VecDestroy(&with), 0);
  assert_int_equal(VecDestroy(&other), 0);
  assert_int_equal(MatDestroy(&bodies), 0);
  assert_int_equal(MatDestroy(&contact), 0);
}

/* Multigrid of matrices that are made anew with contact, with options that give the smoothers' eigenvalues, applied to
   a vector */
static PetscErrorCode ApplyWith(const char *eigenvalues, Vec right, Vec left)
{
  Mat bodies, contact;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(CreateBodies(&bodies, &contact));
  if (eigenvalues) PetscCall(PetscOptionsSetValue(NULL, EIGENVALUES, eigenvalues));
  PetscCall(CreateMultigrid(bodies, &pc));
  PetscCall(MatScale(bodies, 2));
  PetscCall(PCSetUp(pc));
  PetscCall(AddContact(pc, contact, PETSC_TRUE));
  PetscCall(PCApply(pc, right, left));
  if (eigenvalues) PetscCall(PetscOptionsClearValue(NULL, EIGENVALUES));
  PetscCall(PCDestroy(&pc));
  PetscCall(MatDestroy(&bodies));
  PetscCall(MatDestroy(&contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_options_hold(void **state)
{
  const char *eigenvalues[] = {NULL, "0.2,2.2", "0.4,4.4"};
  PetscReal   norm = 0, apart = 0;
  Mat         bodies, contact;
  Vec         right, left[3];

  (void)state;
  assert_int_equal(CreateBodies(&bodies, &contact), 0);
  assert_int_equal(MatCreateVecs(bodies, &right, NULL), 0);
  assert_int_equal(Fill(right), 0);
  for (int k = 0; k < 3; k++) {
    assert_int_equal(VecDuplicate(right, &left[k]), 0);
    assert_int_equal(ApplyWith(eigenvalues[k], right, left[k]), 0);
    for (int l = 0; l < k; l++) {
      assert_int_equal(VecNorm(left[l], NORM_2, &norm), 0);
      assert_int_equal(VecAXPY(left[l], -1, left[k]), 0);
      assert_int_equal(VecNorm(left[l], NORM_2, &apart), 0);
      assert_int_equal(VecAXPY(left[l], 1, left[k]), 0);
      assert_true(apart > 1e-3 * norm);
    }
  }
  for (int k = 0; k < 3; k++) assert_int_equal(VecDestroy(&left[k]), 0);
  assert_int_equal(VecDestroy(&right), 0);
  assert_int_equal(MatDestroy(&bodies), 0);
  assert_int_equal(MatDestroy(&contact), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_adds_and_removes), cmocka_unit_test(test_levels_follow),
                                     cmocka_unit_test(test_options_hold)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
