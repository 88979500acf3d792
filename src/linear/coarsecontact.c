/* The contact part of coarse matrices: products with the interpolations, softer on each level. */
#include "coarsecontact.h"

/* Name under which the solver of a level keeps the matrix of the bodies alone. */
#define COARSE_BODIES "bodies alone"

/* Finds the number of nodes of a level on all ranks. */
static PetscErrorCode CountNodes(KSP level, PetscReal *nodes)
{
  Mat      mat;
  PetscInt rows, size;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(level, NULL, &mat));
  PetscCall(MatGetSize(mat, &rows, NULL));
  PetscCall(MatGetBlockSize(mat, &size));
  *nodes = (PetscReal)rows / size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a level another matrix, for its smoother and its residual. */
static PetscErrorCode SetLevel(PC pc, PetscInt l, KSP level, Mat mat)
{
  PetscFunctionBeginUser;
  PetscCall(KSPSetOperators(level, mat, mat));
  if (l > 0) PetscCall(PCMGSetResidual(pc, l, PCMGResidualDefault, mat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds contact to the matrix of a level, and has the level's solver follow it. keep: to a copy of it. A smoother that
   has estimated the eigenvalues which it damps does so again; where options give them, or where they came with the
   interpolation, they stay: contact on a level is no stiffer than the bodies, and new estimates save no iteration. */
static PetscErrorCode AddToLevel(PC pc, PetscInt l, KSP level, PetscReal softness, Mat contact, PetscBool keep)
{
  Mat bodies, sum;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(level, NULL, &bodies));
  if (keep) {
    PetscCall(PetscObjectCompose((PetscObject)level, COARSE_BODIES, (PetscObject)bodies));
    PetscCall(MatDuplicate(bodies, MAT_COPY_VALUES, &sum));
  } else {
    sum = bodies;
    PetscCall(PetscObjectReference((PetscObject)sum));
  }
  PetscCall(MatAXPY(sum, softness, contact, DIFFERENT_NONZERO_PATTERN));
  PetscCall(SetLevel(pc, l, level, sum));
  PetscCall(MatDestroy(&sum));
  PetscCall(KSPSetUp(level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoarseContactAdd - adds contact to the coarse matrices of multigrid.

  Collective

  Input Parameters:
+ pc       - multigrid that was just made for the bodies alone
. contact  - matrix of contact in the rows that it couples, with its full stiffness
. rows     - these rows of the finest level, those of this rank
. softness - stiffness of contact on the finest level, in parts of its full stiffness
. dim      - dimension of space
- keep     - the matrices of the bodies alone stay as well, for CoarseContactRemove(); else contact is added to them
@*/
PetscErrorCode CoarseContactAdd(PC pc, Mat contact, IS rows, PetscReal softness, int dim, PetscBool keep)
{
  PetscInt  levels;
  PetscReal finest, nodes;
  Mat       added = contact, P, coarse;
  KSP       level;

  PetscFunctionBeginUser;
  PetscCall(PCMGGetLevels(pc, &levels));
  PetscCall(PCMGGetSmoother(pc, levels - 1, &level));
  PetscCall(CountNodes(level, &finest));
  for (PetscInt l = levels - 1; l > 0; l--) {
    PetscCall(PCMGGetInterpolation(pc, l, &P));
    if (l == levels - 1)
      PetscCall(MatCreateSubMatrix(P, rows, NULL, MAT_INITIAL_MATRIX, &P));
    else
      PetscCall(PetscObjectReference((PetscObject)P));
    PetscCall(MatPtAP(added, P, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &coarse));
    PetscCall(MatDestroy(&P));
    if (added != contact) PetscCall(MatDestroy(&added));
    added = coarse;
    PetscCall(PCMGGetSmoother(pc, l - 1, &level));
    PetscCall(CountNodes(level, &nodes));
    PetscCall(AddToLevel(pc, l - 1, level, softness * PetscPowReal(nodes / finest, 1.0 / dim), added, keep));
  }
  if (added != contact) PetscCall(MatDestroy(&added));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoarseContactRemove - gives the coarse levels of multigrid the matrices of the bodies alone again, where these were
  kept.

  Collective

  Input Parameter:
. pc - multigrid

  Note:
  The levels' solvers are not set up.
@*/
PetscErrorCode CoarseContactRemove(PC pc)
{
  PetscInt levels;

  PetscFunctionBeginUser;
  PetscCall(PCMGGetLevels(pc, &levels));
  for (PetscInt l = 0; l < levels - 1; l++) {
    KSP         level;
    PetscObject bodies;

    PetscCall(PCMGGetSmoother(pc, l, &level));
    PetscCall(PetscObjectQuery((PetscObject)level, COARSE_BODIES, &bodies));
    if (!bodies) continue;
    PetscCall(SetLevel(pc, l, level, (Mat)bodies));
    PetscCall(PetscObjectCompose((PetscObject)level, COARSE_BODIES, NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
