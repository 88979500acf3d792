#include "blockmatrix.h"

typedef struct {
  int      list;
  PetscInt m, entry, value; /* size; first places in the arrays */
} Block;

struct _n_BlockMatrix {
  MPI_Comm   comm;
  PetscInt   n, room, n_entries, entries_room, n_values, values_room;
  Block     *block;
  PetscInt  *entry;
  PetscReal *value;
  Mat        matrix;
  PetscInt   n_pattern, *pattern; /* of the matrix: size and dofs of block after block */
};

/* BlockMatrixCreate - an empty one. Collective. */
PetscErrorCode BlockMatrixCreate(MPI_Comm comm, BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(blocks));
  (*blocks)->comm = comm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixDestroy - Collective. */
PetscErrorCode BlockMatrixDestroy(BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  if (!*blocks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*blocks)->block));
  PetscCall(PetscFree((*blocks)->entry));
  PetscCall(PetscFree((*blocks)->value));
  PetscCall(PetscFree((*blocks)->pattern));
  PetscCall(MatDestroy(&(*blocks)->matrix));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixReset - drops all blocks; the assembled matrix and its pattern stay. Not collective. */
PetscErrorCode BlockMatrixReset(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  blocks->n = blocks->n_entries = blocks->n_values = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAdd - a new block over entries of rank-local vector `list` (contact: the pair's number).

   Not collective. m: size of the block. entry[m]: to be written; value[m*m]: row-major (force per length), zero, to be added to. Both stand
   until the next call: growing moves them. */
PetscErrorCode BlockMatrixAdd(BlockMatrix blocks, int list, PetscInt m, PetscInt **entry, PetscReal **value)
{
  PetscFunctionBeginUser;
  if (blocks->n == blocks->room) PetscCall(PetscRealloc((blocks->room = 2 * blocks->room + 64) * sizeof(Block), &blocks->block));
  if (blocks->n_entries + m > blocks->entries_room)
    PetscCall(PetscRealloc((blocks->entries_room = 2 * (blocks->entries_room + m)) * sizeof(PetscInt), &blocks->entry));
  if (blocks->n_values + m * m > blocks->values_room)
    PetscCall(PetscRealloc((blocks->values_room = 2 * (blocks->values_room + m * m)) * sizeof(PetscReal), &blocks->value));
  *entry = &blocks->entry[blocks->n_entries];
  *value = &blocks->value[blocks->n_values];
  PetscCall(PetscArrayzero(*value, m * m));
  blocks->block[blocks->n++] = (Block){list, m, blocks->n_entries, blocks->n_values};
  blocks->n_entries += m;
  blocks->n_values += m * m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pattern that the present blocks need. */
static PetscErrorCode BlocksPattern(BlockMatrix blocks, const PetscInt *const dof[], PetscInt *n, PetscInt **pattern)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(blocks->n + blocks->n_entries, pattern));
  *n = 0;
  for (PetscInt b = 0; b < blocks->n; b++) {
    const Block *block = &blocks->block[b];

    (*pattern)[(*n)++] = block->m;
    for (PetscInt i = 0; i < block->m; i++) (*pattern)[(*n)++] = dof[block->list][blocks->entry[block->entry + i]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMatrix(BlockMatrix blocks, PetscInt size)
{
  const PetscInt *pattern = blocks->pattern;
  PetscInt       *rows, *columns;
  PetscCount      n = 0;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&blocks->matrix));
  PetscCall(MatCreate(blocks->comm, &blocks->matrix));
  PetscCall(MatSetSizes(blocks->matrix, size, size, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(blocks->matrix, MATAIJ));
  PetscCall(PetscMalloc2(blocks->n_values, &rows, blocks->n_values, &columns));
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + pattern[at]) {
    const PetscInt m = pattern[at], *dof = &pattern[at + 1];

    for (PetscInt i = 0; i < m; i++) {
      for (PetscInt j = 0; j < m; j++, n++) {
        rows[n]    = dof[i] < 0 || dof[j] < 0 ? -1 : dof[i]; /* negative entries are left out of the matrix */
        columns[n] = dof[i] < 0 || dof[j] < 0 ? -1 : dof[j];
      }
    }
  }
  PetscCall(MatSetPreallocationCOO(blocks->matrix, n, rows, columns));
  PetscCall(PetscFree2(rows, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAssemble - the sum of all ranks' blocks as a parallel AIJ matrix over the global dofs; it stays the block matrix's.

   Collective. size: rows of this rank; dof[list][entry]: global dof of an entry, -1 without one (its rows and columns are left out).
   *changed: some rank's blocks ask for another pattern than last time, so that the matrix is a new one; else only its values are. */
PetscErrorCode BlockMatrixAssemble(BlockMatrix blocks, PetscInt size, const PetscInt *const dof[], Mat *matrix, PetscBool *changed)
{
  PetscInt  n = 0, *pattern = NULL;
  PetscBool same;
  int       all;

  PetscFunctionBeginUser;
  PetscCall(BlocksPattern(blocks, dof, &n, &pattern));
  same = (PetscBool)(blocks->matrix && n == blocks->n_pattern);
  if (same && n) PetscCall(PetscArraycmp(pattern, blocks->pattern, n, &same));
  all = same;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, blocks->comm));
  PetscCall(PetscFree(blocks->pattern));
  blocks->pattern   = pattern;
  blocks->n_pattern = n;
  if (!all) PetscCall(CreateMatrix(blocks, size));
  PetscCall(MatSetValuesCOO(blocks->matrix, blocks->value, INSERT_VALUES));
  *matrix  = blocks->matrix;
  *changed = all ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixMultiply - y += (this rank's blocks of `list`) x, entries without a global dof included.

   Not collective. x, y: over the entries of that rank-local vector. */
PetscErrorCode BlockMatrixMultiply(BlockMatrix blocks, int list, const PetscReal *x, PetscReal *y)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < blocks->n; b++) {
    const Block     *block = &blocks->block[b];
    const PetscInt  *entry = &blocks->entry[block->entry];
    const PetscReal *value = &blocks->value[block->value];

    if (block->list != list) continue;
    for (PetscInt i = 0; i < block->m; i++)
      for (PetscInt j = 0; j < block->m; j++) y[entry[i]] += value[i * block->m + j] * x[entry[j]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
