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
  PetscCall(MatAXPY(mat, softness, contact, SUBSET_NONZERO_PATTERN));
  PetscCall(KSPSetOperators(level, mat, mat));
  PetscCall(PetscObjectTypeCompare((PetscObject)level, KSPCHEBYSHEV, &chebyshev));
  if (chebyshev) PetscCall(KSPChebyshevEstEigSet(level, PETSC_DECIDE, PETSC_DECIDE, PETSC_DECIDE, PETSC_DECIDE));
  PetscCall(KSPSetUp(level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the non-zero entries of a row of a matrix: those in columns of this rank, and the others. */
static PetscErrorCode CountEntries(Mat mat, PetscInt row, PetscInt *own, PetscInt *others)
{
  PetscInt           begin, end, n;
  const PetscInt    *column;
  const PetscScalar *value;

  PetscFunctionBeginUser;
  *own = *others = 0;
  PetscCall(MatGetOwnershipRangeColumn(mat, &begin, &end));
  PetscCall(MatGetRow(mat, row, &n, &column, &value));
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool mine = (PetscBool)(column[k] >= begin && column[k] < end);

    if (value[k] != 0) *(mine ? own : others) += 1;
  }
  PetscCall(MatRestoreRow(mat, row, &n, &column, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a matrix for some rows of another one, with room for their non-zero entries. */
static PetscErrorCode CreateRows(Mat mat, PetscInt n, const PetscInt *row, Mat *part)
{
  PetscInt columns, *own, *others;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(mat, NULL, &columns));
  PetscCall(PetscMalloc2(n, &own, n, &others));
  for (PetscInt i = 0; i < n; i++) PetscCall(CountEntries(mat, row[i], &own[i], &others[i]));
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)mat), n, columns, PETSC_DETERMINE, PETSC_DETERMINE, 0, own, 0,
                         others, part));
  PetscCall(PetscFree2(own, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes rows of an interpolation without the zeros that are stored there for contact: most of the entries. */
static PetscErrorCode TakeRows(Mat P, IS rows, Mat *part)
{
  PetscInt        n, first;
  const PetscInt *row;

  PetscFunctionBeginUser;
  PetscCall(ISGetLocalSize(rows, &n));
  PetscCall(ISGetIndices(rows, &row));
  PetscCall(CreateRows(P, n, row, part));
  PetscCall(MatGetOwnershipRange(*part, &first, NULL));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt           entries;
    const PetscInt    *column;
    const PetscScalar *value;

    PetscCall(MatGetRow(P, row[i], &entries, &column, &value));
    for (PetscInt k = 0; k < entries; k++)
      if (value[k] != 0) PetscCall(MatSetValue(*part, first + i, column[k], value[k], INSERT_VALUES));
    PetscCall(MatRestoreRow(P, row[i], &entries, &column, &value));
  }
  PetscCall(ISRestoreIndices(rows, &row));
  PetscCall(MatAssemblyBegin(*part, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*part, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoarseContactAdd - adds contact to the coarse matrices of multigrid.

  Collective

  Input Parameters:
+ pc       - multigrid that was just made for the bodies alone; the pattern of its finest matrix has room for contact
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
      PetscCall(TakeRows(P, rows, &P));
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
