/* The contact part of coarse matrices: products with the interpolations, softer on each level. */
#include "coarsecontact.h"

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

/* Adds contact to the matrix of a level, and has the level's solver follow it. The largest eigenvalue that a smoother
   damps is no longer that of the bodies alone. */
static PetscErrorCode AddToLevel(KSP level, PetscReal softness, Mat contact)
{
  Mat       mat;
  PetscBool chebyshev;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(level, NULL, &mat));
  PetscCall(MatAXPY(mat, softness, contact, DIFFERENT_NONZERO_PATTERN));
  PetscCall(KSPSetOperators(level, mat, mat));
  PetscCall(PetscObjectTypeCompare((PetscObject)level, KSPCHEBYSHEV, &chebyshev));
  if (chebyshev) PetscCall(KSPChebyshevEstEigSet(level, PETSC_DECIDE, PETSC_DECIDE, PETSC_DECIDE, PETSC_DECIDE));
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
- dim      - dimension of space
@*/
PetscErrorCode CoarseContactAdd(PC pc, Mat contact, IS rows, PetscReal softness, int dim)
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
    PetscCall(AddToLevel(level, softness * PetscPowReal(nodes / finest, 1.0 / dim), added));
  }
  if (added != contact) PetscCall(MatDestroy(&added));
  PetscFunctionReturn(PETSC_SUCCESS);
}
