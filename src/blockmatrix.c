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
  PetscInt   n_sums, *place;      /* blocks overlap: every pair of dofs once, and where each value of the blocks goes, or -1 */
  PetscReal *sum;
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
  PetscCall(PetscFree((*blocks)->place));
  PetscCall(PetscFree((*blocks)->sum));
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

/* One row of a block in the pattern */
typedef struct {
  PetscInt row, at, i; /* its global dof; the block's place in the pattern; which row of the block */
  PetscInt value;      /* the row's first value */
} BlockRow;

static int BlockRowCompare(const void *a, const void *b)
{
  const BlockRow *p = a, *q = b;

  if (p->row != q->row) return p->row < q->row ? -1 : 1;
  return p->value < q->value ? -1 : p->value > q->value;
}

/* The rows of all blocks that have a dof, those of one dof together. */
static PetscErrorCode ListRows(BlockMatrix blocks, PetscInt *n, BlockRow **rows)
{
  const PetscInt *pattern = blocks->pattern;
  PetscInt        value   = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(blocks->n_pattern, rows));
  *n = 0;
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + pattern[at]) {
    for (PetscInt i = 0; i < pattern[at]; i++, value += pattern[at])
      if (pattern[at + 1 + i] >= 0) (*rows)[(*n)++] = (BlockRow){pattern[at + 1 + i], at, i, value};
  }
  if (*n) qsort(*rows, *n, sizeof(BlockRow), BlockRowCompare);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the dofs that occur in the pattern: dofs[n] ascending; number[k] of every place k of the pattern that holds one. */
static PetscErrorCode NumberDofs(BlockMatrix blocks, PetscInt n_rows, const BlockRow *rows, PetscInt *n, PetscInt *dofs, PetscInt *number)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt k = 0; k < blocks->n_pattern; k++) number[k] = -1;
  for (PetscInt r = 0; r < n_rows; r++) {
    if (!r || rows[r].row != rows[r - 1].row) dofs[(*n)++] = rows[r].row;
    number[rows[r].at + 1 + rows[r].i] = *n - 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives every pair of dofs that some block couples one place, row by row, and every value of the blocks the place it is summed in. Blocks overlap
   several times over, so this spares the parallel matrix most of the entries. */
static PetscErrorCode NumberSums(BlockMatrix blocks, PetscInt *n_pairs, PetscInt **rows_out, PetscInt **columns_out)
{
  const PetscInt *pattern = blocks->pattern;
  PetscInt        n_rows = 0, n_dofs, n = 0, first = 0, *dofs, *number, *seen, *rows, *columns;
  BlockRow       *row;

  PetscFunctionBeginUser;
  PetscCall(ListRows(blocks, &n_rows, &row));
  PetscCall(PetscMalloc3(n_rows, &dofs, blocks->n_pattern, &number, n_rows, &seen));
  PetscCall(NumberDofs(blocks, n_rows, row, &n_dofs, dofs, number));
  PetscCall(PetscMalloc2(blocks->n_values, &rows, blocks->n_values, &columns));
  PetscCall(PetscFree(blocks->place));
  PetscCall(PetscMalloc1(blocks->n_values, &blocks->place));
  for (PetscInt k = 0; k < blocks->n_values; k++) blocks->place[k] = -1;
  for (PetscInt k = 0; k < n_dofs; k++) seen[k] = -1;
  for (PetscInt r = 0; r < n_rows; r++) {
    if (r && row[r].row != row[r - 1].row) first = n; /* places before are other rows' */
    for (PetscInt j = 0; j < pattern[row[r].at]; j++) {
      const PetscInt column = number[row[r].at + 1 + j];

      if (column < 0) continue;
      if (seen[column] < first) {
        seen[column] = n;
        rows[n]      = row[r].row;
        columns[n++] = dofs[column];
      }
      blocks->place[row[r].value + j] = seen[column];
    }
  }
  *n_pairs     = n;
  *rows_out    = rows;
  *columns_out = columns;
  PetscCall(PetscFree3(dofs, number, seen));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMatrix(BlockMatrix blocks, PetscInt size)
{
  PetscInt *rows, *columns;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&blocks->matrix));
  PetscCall(MatCreate(blocks->comm, &blocks->matrix));
  PetscCall(MatSetSizes(blocks->matrix, size, size, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(blocks->matrix, MATAIJ));
  PetscCall(NumberSums(blocks, &blocks->n_sums, &rows, &columns));
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscMalloc1(blocks->n_sums, &blocks->sum));
  PetscCall(MatSetPreallocationCOO(blocks->matrix, blocks->n_sums, rows, columns));
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
  PetscCall(PetscArrayzero(blocks->sum, blocks->n_sums));
  for (PetscInt k = 0; k < blocks->n_values; k++)
    if (blocks->place[k] >= 0) blocks->sum[blocks->place[k]] += blocks->value[k];
  PetscCall(MatSetValuesCOO(blocks->matrix, blocks->sum, INSERT_VALUES));
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
