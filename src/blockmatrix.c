#include "blockmatrix.h"

/* A pattern is kept while it holds what the blocks need, with zeros elsewhere, and is at most this many times as large: a new one costs the sum with
   other matrices and the solver's analysis (half of a factorisation at 10,000 dofs), a zero costs fill. Contact that moves on seldom reaches it. */
#define BLOCK_SLACK 1.5

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
  PetscInt   n_pattern, *pattern;     /* of the blocks: size and dofs of block after block */
  PetscInt   n_dofs, *dof;            /* of the matrix, ascending */
  PetscInt  *pair_ptr, *pair, *place; /* blocks overlap: every pair of dofs once, row by row; which pair each value of the blocks goes to, or -1 */
  PetscReal *sum;                     /* over the pairs */
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
  PetscCall(PetscFree((*blocks)->dof));
  PetscCall(PetscFree((*blocks)->pair_ptr));
  PetscCall(PetscFree((*blocks)->pair));
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
  PetscInt at;    /* the block's place in the pattern */
  PetscInt value; /* the row's first value */
} BlockRow;

/* The dofs that occur in the pattern, ascending, each once. */
static PetscErrorCode ListDofs(BlockMatrix blocks)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->dof));
  PetscCall(PetscMalloc1(blocks->n_pattern, &blocks->dof));
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++)
      if (blocks->pattern[at + i] >= 0) blocks->dof[n++] = blocks->pattern[at + i];
  }
  PetscCall(PetscSortRemoveDupsInt(&n, blocks->dof));
  blocks->n_dofs = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which of the listed dofs stands at each place of the pattern, -1: none; *known: all that stand there are listed. */
static PetscErrorCode NumberDofs(BlockMatrix blocks, PetscInt *number, PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt k = 0; k < blocks->n_pattern; k++) number[k] = -1;
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++) {
      if (blocks->pattern[at + i] < 0) continue;
      PetscCall(PetscFindInt(blocks->pattern[at + i], blocks->n_dofs, blocks->dof, &number[at + i]));
      if (number[at + i] >= 0) continue;
      number[at + i] = -1;
      *known         = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows of all blocks, those of one dof together: row[ptr[d]] to row[ptr[d + 1]], in the blocks' order. */
static PetscErrorCode GroupRows(BlockMatrix blocks, const PetscInt *number, PetscInt *ptr, BlockRow *row)
{
  PetscInt value = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(ptr, blocks->n_dofs + 2));
  for (PetscInt k = 0; k < blocks->n_pattern; k++)
    if (number[k] >= 0) ptr[number[k] + 2]++;
  for (PetscInt d = 0; d < blocks->n_dofs; d++) ptr[d + 2] += ptr[d + 1];
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++, value += blocks->pattern[at])
      if (number[at + i] >= 0) row[ptr[number[at + i] + 1]++] = (BlockRow){at, value}; /* ends with ptr[d + 1] at the end of d's */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of dofs that some block couples, each once, row by row. Blocks overlap several times over, so this spares the parallel matrix most of
   the entries. seen[n_dofs]: scratch. */
static PetscErrorCode ListPairs(BlockMatrix blocks, const PetscInt *number, const PetscInt *ptr, const BlockRow *row, PetscInt *seen)
{
  PetscInt n = 0, *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->pair_ptr));
  PetscCall(PetscFree(blocks->pair));
  PetscCall(PetscMalloc1(blocks->n_values, &pair));
  PetscCall(PetscMalloc1(blocks->n_dofs + 1, &blocks->pair_ptr));
  for (PetscInt d = 0; d < blocks->n_dofs; d++) seen[d] = -1;
  for (PetscInt d = 0; d < blocks->n_dofs; d++) {
    blocks->pair_ptr[d] = n;
    for (PetscInt r = ptr[d]; r < ptr[d + 1]; r++) {
      for (PetscInt j = 1; j <= blocks->pattern[row[r].at]; j++) {
        const PetscInt column = number[row[r].at + j];

        if (column < 0 || seen[column] >= blocks->pair_ptr[d]) continue;
        seen[column] = n;
        pair[n++]    = column;
      }
    }
  }
  blocks->pair_ptr[blocks->n_dofs] = n;
  PetscCall(PetscMalloc1(n, &blocks->pair));
  PetscCall(PetscArraycpy(blocks->pair, pair, n));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives every value of the blocks the pair it is summed in; *used: how many pairs get one, -1: a value has no pair. seen[2*n_dofs]: scratch. */
static PetscErrorCode PlaceValues(BlockMatrix blocks, const PetscInt *number, const PetscInt *ptr, const BlockRow *row, PetscInt *seen, PetscInt *used)
{
  PetscInt *met = seen + blocks->n_dofs; /* the last row in which a column was asked for */

  PetscFunctionBeginUser;
  *used = 0;
  PetscCall(PetscFree(blocks->place));
  PetscCall(PetscMalloc1(blocks->n_values, &blocks->place));
  for (PetscInt k = 0; k < blocks->n_values; k++) blocks->place[k] = -1;
  for (PetscInt d = 0; d < blocks->n_dofs; d++) seen[d] = met[d] = -1;
  for (PetscInt d = 0; d < blocks->n_dofs; d++) {
    for (PetscInt k = blocks->pair_ptr[d]; k < blocks->pair_ptr[d + 1]; k++) seen[blocks->pair[k]] = k;
    for (PetscInt r = ptr[d]; r < ptr[d + 1]; r++) {
      for (PetscInt j = 1; j <= blocks->pattern[row[r].at]; j++) {
        const PetscInt column = number[row[r].at + j];

        if (column < 0) continue;
        if (seen[column] < blocks->pair_ptr[d]) {
          *used = -1;
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        blocks->place[row[r].value + j - 1] = seen[column];
        *used += met[column] != d;
        met[column] = d;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a place for every value. fresh: in pairs of its own; else in those that are there, if these hold all and are not far too many: *placed. */
static PetscErrorCode PlacePattern(BlockMatrix blocks, PetscBool fresh, PetscBool *placed)
{
  PetscInt *number, *ptr, *seen, used = -1;
  BlockRow *row;

  PetscFunctionBeginUser;
  if (fresh) PetscCall(ListDofs(blocks));
  PetscCall(PetscMalloc4(blocks->n_pattern, &number, blocks->n_dofs + 2, &ptr, 2 * blocks->n_dofs, &seen, blocks->n_pattern, &row));
  PetscCall(NumberDofs(blocks, number, placed));
  if (*placed) {
    PetscCall(GroupRows(blocks, number, ptr, row));
    if (fresh) PetscCall(ListPairs(blocks, number, ptr, row, seen));
    PetscCall(PlaceValues(blocks, number, ptr, row, seen, &used));
    *placed = used >= 0 && blocks->pair_ptr[blocks->n_dofs] <= BLOCK_SLACK * used ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree4(number, ptr, seen, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMatrix(BlockMatrix blocks, PetscInt size)
{
  PetscBool placed;
  PetscInt *rows, *columns, n;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&blocks->matrix));
  PetscCall(MatCreate(blocks->comm, &blocks->matrix));
  PetscCall(MatSetSizes(blocks->matrix, size, size, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(blocks->matrix, MATAIJ));
  PetscCall(PlacePattern(blocks, PETSC_TRUE, &placed));
  n = blocks->pair_ptr[blocks->n_dofs];
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscMalloc1(n, &blocks->sum));
  PetscCall(PetscMalloc2(n, &rows, n, &columns));
  for (PetscInt d = 0; d < blocks->n_dofs; d++) {
    for (PetscInt k = blocks->pair_ptr[d]; k < blocks->pair_ptr[d + 1]; k++) {
      rows[k]    = blocks->dof[d];
      columns[k] = blocks->dof[blocks->pair[k]];
    }
  }
  PetscCall(MatSetPreallocationCOO(blocks->matrix, n, rows, columns));
  PetscCall(PetscFree2(rows, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAssemble - the sum of all ranks' blocks as a parallel AIJ matrix over the global dofs; it stays the block matrix's.

   Collective. size: rows of this rank; dof[list][entry]: global dof of an entry, -1 without one (its rows and columns are left out).
   *changed: the matrix is a new one, as the last one's pattern did not hold some rank's blocks or was far larger; else only its values are,
   with zeros where no block asks for an entry. */
PetscErrorCode BlockMatrixAssemble(BlockMatrix blocks, PetscInt size, const PetscInt *const dof[], Mat *matrix, PetscBool *changed)
{
  PetscInt  n = 0, *pattern = NULL;
  PetscBool placed;
  int       all;

  PetscFunctionBeginUser;
  PetscCall(BlocksPattern(blocks, dof, &n, &pattern));
  placed = (PetscBool)(blocks->matrix && n == blocks->n_pattern);
  if (placed && n) PetscCall(PetscArraycmp(pattern, blocks->pattern, n, &placed));
  PetscCall(PetscFree(blocks->pattern));
  blocks->pattern   = pattern;
  blocks->n_pattern = n;
  if (!placed && blocks->matrix) PetscCall(PlacePattern(blocks, PETSC_FALSE, &placed));
  all = placed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, blocks->comm));
  if (!all) PetscCall(CreateMatrix(blocks, size));
  PetscCall(PetscArrayzero(blocks->sum, blocks->pair_ptr[blocks->n_dofs]));
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
