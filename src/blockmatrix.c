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
  int        size; /* of a node: its dofs */
  PetscInt   n, room, n_entries, entries_room, n_values, values_room;
  Block     *block;
  PetscInt  *entry;
  PetscReal *value;
  Mat        matrix;
  PetscInt   n_pattern, *pattern; /* of the blocks: number of nodes and nodes' keys of block after block; key: the first dof, -1 without any */
  PetscInt   n_nodes, *key, *dof; /* of the matrix: keys ascending, dofs (n_nodes*size) */
  PetscInt  *pair_ptr, *pair;     /* blocks overlap: every pair of nodes once, row by row */
  PetscBool  restored;            /* the matrix is not the one that its user knows */
  PetscInt  *place, *stride;      /* of the blocks' pairs: the place of the first value in the sums, or -1; of the blocks' rows: to the next row of dofs */
  PetscReal *sum;                 /* over the pairs, row of dofs by row of dofs */
};

/* BlockMatrixCreate - an empty one.

   Collective. size: entries come in runs of so many, the dofs of a node, in an order of their own; 1: one by one. */
PetscErrorCode BlockMatrixCreate(MPI_Comm comm, int size, BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(blocks));
  (*blocks)->comm = comm;
  (*blocks)->size = size;
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
  PetscCall(PetscFree((*blocks)->key));
  PetscCall(PetscFree((*blocks)->dof));
  PetscCall(PetscFree((*blocks)->pair_ptr));
  PetscCall(PetscFree((*blocks)->pair));
  PetscCall(PetscFree((*blocks)->place));
  PetscCall(PetscFree((*blocks)->stride));
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

   Not collective. m: size of the block, whole nodes. entry[m]: to be written, node by node; value[m*m]: row-major (force per length), zero, to be added to.
   Both stand until the next call: growing moves them. */
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
  const int size = blocks->size;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(blocks->n + blocks->n_entries / size, pattern));
  *n = 0;
  for (PetscInt b = 0; b < blocks->n; b++) {
    const Block *block = &blocks->block[b];

    (*pattern)[(*n)++] = block->m / size;
    for (PetscInt i = 0; i < block->m; i += size) {
      PetscInt key = -1;

      for (int d = 0; d < size && key < 0; d++) key = dof[block->list][blocks->entry[block->entry + i + d]];
      (*pattern)[(*n)++] = PetscMax(key, -1);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One row of nodes of a block in the pattern */
typedef struct {
  PetscInt at;            /* the block's place in the pattern */
  PetscInt number, first; /* of the row and of its first pair, over all blocks */
} BlockRow;

/* The nodes that occur in the pattern, ascending, each once, with their dofs. */
static PetscErrorCode ListNodes(BlockMatrix blocks, const PetscInt *const dof[])
{
  const int size = blocks->size;
  PetscInt  n = 0, at = 0, number;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->key));
  PetscCall(PetscFree(blocks->dof));
  PetscCall(PetscMalloc1(blocks->n_pattern, &blocks->key));
  for (at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++)
      if (blocks->pattern[at + i] >= 0) blocks->key[n++] = blocks->pattern[at + i];
  }
  PetscCall(PetscSortRemoveDupsInt(&n, blocks->key));
  blocks->n_nodes = n;
  PetscCall(PetscMalloc1(n * size, &blocks->dof));
  at = 0;
  for (PetscInt b = 0; b < blocks->n; b++, at++) {
    const Block *block = &blocks->block[b];

    for (PetscInt i = 0; i < block->m; i += size) {
      if (blocks->pattern[++at] < 0) continue;
      PetscCall(PetscFindInt(blocks->pattern[at], n, blocks->key, &number));
      for (int d = 0; d < size; d++) blocks->dof[number * size + d] = dof[block->list][blocks->entry[block->entry + i + d]];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which of the listed nodes stands at each place of the pattern, -1: none; *known: all that stand there are listed. */
static PetscErrorCode NumberNodes(BlockMatrix blocks, PetscInt *number, PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt k = 0; k < blocks->n_pattern; k++) number[k] = -1;
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++) {
      if (blocks->pattern[at + i] < 0) continue;
      PetscCall(PetscFindInt(blocks->pattern[at + i], blocks->n_nodes, blocks->key, &number[at + i]));
      if (number[at + i] >= 0) continue;
      number[at + i] = -1;
      *known         = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows of all blocks, those of one node together: row[ptr[r]] to row[ptr[r + 1]], in the blocks' order. */
static PetscErrorCode GroupRows(BlockMatrix blocks, const PetscInt *number, PetscInt *ptr, BlockRow *row)
{
  PetscInt rows = 0, pairs = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(ptr, blocks->n_nodes + 2));
  for (PetscInt k = 0; k < blocks->n_pattern; k++)
    if (number[k] >= 0) ptr[number[k] + 2]++;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) ptr[r + 2] += ptr[r + 1];
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at]) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++, rows++, pairs += blocks->pattern[at])
      if (number[at + i] >= 0) row[ptr[number[at + i] + 1]++] = (BlockRow){at, rows, pairs}; /* moves ptr[r + 1] from the start of r's to their end */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of nodes that some block couples, each once, row by row. Blocks overlap several times over, so this spares the parallel matrix most of
   the entries. seen[n_nodes]: scratch. */
static PetscErrorCode ListPairs(BlockMatrix blocks, const PetscInt *number, const PetscInt *ptr, const BlockRow *row, PetscInt *seen)
{
  PetscInt n = 0, *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->pair_ptr));
  PetscCall(PetscFree(blocks->pair));
  PetscCall(PetscMalloc1(blocks->n_values / PetscSqr(blocks->size), &pair));
  PetscCall(PetscMalloc1(blocks->n_nodes + 1, &blocks->pair_ptr));
  for (PetscInt r = 0; r < blocks->n_nodes; r++) seen[r] = -1;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    blocks->pair_ptr[r] = n;
    for (PetscInt k = ptr[r]; k < ptr[r + 1]; k++) {
      for (PetscInt j = 1; j <= blocks->pattern[row[k].at]; j++) {
        const PetscInt column = number[row[k].at + j];

        if (column < 0 || seen[column] >= blocks->pair_ptr[r]) continue;
        seen[column] = n;
        pair[n++]    = column;
      }
    }
  }
  blocks->pair_ptr[blocks->n_nodes] = n;
  PetscCall(PetscMalloc1(n, &blocks->pair));
  PetscCall(PetscArraycpy(blocks->pair, pair, n));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives every pair in the blocks its place in the sums; *used: how many get one, -1: one is missing. seen[2*n_nodes]: scratch. */
static PetscErrorCode PlacePairs(BlockMatrix blocks, const PetscInt *number, const PetscInt *ptr, const BlockRow *row, PetscInt *seen, PetscInt *used)
{
  const int      size = blocks->size;
  const PetscInt n    = blocks->n_values / PetscSqr(size);
  PetscInt      *met  = seen + blocks->n_nodes; /* the last row in which a column was asked for */

  PetscFunctionBeginUser;
  *used = 0;
  PetscCall(PetscFree(blocks->place));
  PetscCall(PetscFree(blocks->stride));
  PetscCall(PetscMalloc1(n, &blocks->place));
  PetscCall(PetscMalloc1(blocks->n_entries / size, &blocks->stride));
  for (PetscInt k = 0; k < n; k++) blocks->place[k] = -1;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) seen[r] = met[r] = -1;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    const PetscInt first = blocks->pair_ptr[r], end = blocks->pair_ptr[r + 1];

    for (PetscInt k = first; k < end; k++) seen[blocks->pair[k]] = k;
    for (PetscInt k = ptr[r]; k < ptr[r + 1]; k++) {
      blocks->stride[row[k].number] = (end - first) * size;
      for (PetscInt j = 1; j <= blocks->pattern[row[k].at]; j++) {
        const PetscInt column = number[row[k].at + j];

        if (column < 0) continue;
        if (seen[column] < first) {
          *used = -1;
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        blocks->place[row[k].first + j - 1] = first * PetscSqr(size) + (seen[column] - first) * size;
        *used += met[column] != r;
        met[column] = r;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a place for every pair. fresh: among pairs listed anew; else among those that are there, if these hold all and are not far too many: *placed. */
static PetscErrorCode PlacePattern(BlockMatrix blocks, const PetscInt *const dof[], PetscBool fresh, PetscBool *placed)
{
  PetscInt *number, *ptr, *seen, used = -1;
  BlockRow *row;

  PetscFunctionBeginUser;
  if (fresh) PetscCall(ListNodes(blocks, dof));
  PetscCall(PetscMalloc4(blocks->n_pattern, &number, blocks->n_nodes + 2, &ptr, 2 * blocks->n_nodes, &seen, blocks->n_pattern, &row));
  PetscCall(NumberNodes(blocks, number, placed));
  if (*placed) {
    PetscCall(GroupRows(blocks, number, ptr, row));
    if (fresh) PetscCall(ListPairs(blocks, number, ptr, row, seen));
    PetscCall(PlacePairs(blocks, number, ptr, row, seen, &used));
    *placed = used >= 0 && blocks->pair_ptr[blocks->n_nodes] <= BLOCK_SLACK * used ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree4(number, ptr, seen, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A matrix of `rows` rows on this rank with the pairs that are listed; entries without a dof are left out by PETSc. */
static PetscErrorCode CreateMatrix(BlockMatrix blocks, PetscInt rows)
{
  const int size = blocks->size;
  PetscInt *i, *j, n, at = 0;

  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&blocks->matrix));
  PetscCall(MatCreate(blocks->comm, &blocks->matrix));
  PetscCall(MatSetSizes(blocks->matrix, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(blocks->matrix, MATAIJ));
  n = blocks->pair_ptr[blocks->n_nodes] * PetscSqr(size);
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscMalloc1(n, &blocks->sum));
  PetscCall(PetscMalloc2(n, &i, n, &j));
  for (PetscInt row = 0; row < blocks->n_nodes * size; row++) {
    for (PetscInt k = blocks->pair_ptr[row / size] * size; k < blocks->pair_ptr[row / size + 1] * size; k++, at++) {
      i[at] = blocks->dof[row];
      j[at] = blocks->dof[blocks->pair[k / size] * size + k % size];
    }
  }
  PetscCall(MatSetPreallocationCOO(blocks->matrix, n, i, j));
  PetscCall(PetscFree2(i, j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds one block to the sums; size a constant where this is called, so that the loops over a node's dofs unroll. */
static inline void SumBlock(const int size, PetscInt m, const PetscReal *value, const PetscInt *place, const PetscInt *stride, PetscReal *sum)
{
  for (PetscInt i = 0; i < m; i += size, stride++) {
    for (PetscInt j = 0; j < m; j += size, place++) {
      if (*place < 0) continue;
      for (int d = 0; d < size; d++)
        for (int e = 0; e < size; e++) sum[*place + d * *stride + e] += value[(i + d) * m + j + e];
    }
  }
}

static PetscErrorCode SumBlocks(BlockMatrix blocks)
{
  const int       size  = blocks->size;
  const PetscInt *place = blocks->place, *stride = blocks->stride;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(blocks->sum, blocks->pair_ptr[blocks->n_nodes] * PetscSqr(size)));
  for (PetscInt b = 0; b < blocks->n; b++) {
    const PetscInt   m     = blocks->block[b].m;
    const PetscReal *value = &blocks->value[blocks->block[b].value];

    if (size == 3)
      SumBlock(3, m, value, place, stride, blocks->sum);
    else if (size == 2)
      SumBlock(2, m, value, place, stride, blocks->sum);
    else
      SumBlock(size, m, value, place, stride, blocks->sum);
    place += PetscSqr(m / size);
    stride += m / size;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAssemble - the sum of all ranks' blocks as a parallel AIJ matrix over the global dofs; it stays the block matrix's.

   Collective. rows: of this rank; dof[list][entry]: global dof of an entry, -1 without one (its rows and columns are left out).
   *changed: the matrix is a new one, as the last one's pattern did not hold some rank's blocks or was far larger; else only its values are,
   with zeros where no block asks for an entry. */
PetscErrorCode BlockMatrixAssemble(BlockMatrix blocks, PetscInt rows, const PetscInt *const dof[], Mat *matrix, PetscBool *changed)
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
  if (!placed && blocks->matrix) PetscCall(PlacePattern(blocks, dof, PETSC_FALSE, &placed));
  all = placed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, blocks->comm));
  if (!all) {
    PetscCall(PlacePattern(blocks, dof, PETSC_TRUE, &placed));
    PetscCall(CreateMatrix(blocks, rows));
  }
  PetscCall(SumBlocks(blocks));
  PetscCall(MatSetValuesCOO(blocks->matrix, blocks->sum, INSERT_VALUES));
  *matrix          = blocks->matrix;
  *changed         = all && !blocks->restored ? PETSC_FALSE : PETSC_TRUE;
  blocks->restored = PETSC_FALSE;
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

/* BlockMatrixArchive - saves or takes over the pattern of the last assembled matrix.

   Collective. name: where it stands in the archive; rows: of this rank, as for BlockMatrixAssemble(). A pattern that is kept depends on what was
   assembled before. Dofs are numbered by rank, so that it serves on one rank only, where runs repeat to the last bit. */
PetscErrorCode BlockMatrixArchive(BlockMatrix blocks, Archive archive, const char *name, PetscInt rows)
{
  static const char *names[] = {"key", "dof", "pair_ptr", "pair"};
  PetscInt         **list[]  = {&blocks->key, &blocks->dof, &blocks->pair_ptr, &blocks->pair};
  PetscInt           n[4]    = {0, 0, 0, 0};
  PetscMPIInt        size;
  PetscBool          there = blocks->matrix ? PETSC_TRUE : PETSC_FALSE;
  char               path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(blocks->comm, &size));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/key", name));
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, path, &there));
  if (size > 1 || !there) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ArchiveLoads(archive)) {
    n[0] = blocks->n_nodes;
    n[1] = blocks->n_nodes * blocks->size;
    n[2] = blocks->n_nodes + 1;
    n[3] = blocks->pair_ptr[blocks->n_nodes];
  }
  for (int k = 0; k < 4; k++) {
    if (ArchiveLoads(archive)) PetscCall(PetscFree(*list[k]));
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", name, names[k]));
    PetscCall(ArchiveIntegerList(archive, path, &n[k], list[k]));
  }
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  blocks->n_nodes   = n[0];
  blocks->n_pattern = 0; /* where the next blocks stand in it is found then */
  PetscCall(CreateMatrix(blocks, rows));
  blocks->restored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
