#include "blockmatrix.h"
#include "nodematrix.h"

/* A pattern is kept while it holds what the blocks need, with zeros elsewhere, and is at most this many times as large: a new one costs the sum with
   other matrices and the solver's analysis (half of a factorisation at 10,000 dofs), a zero costs fill. Contact that moves on seldom reaches it. */
#define BLOCK_SLACK 1.5

/* Values are kept in pieces of this many or more, which never move: as one array that grows they are copied, and need twice the memory. */
#define BLOCK_PIECE (1 << 20)

typedef struct {
  int        list;
  PetscInt   m, entry; /* size; first place in the array */
  PetscReal *value;
  PetscBool  outer; /* the values are a vector v, the block is v v^T */
} Block;

typedef struct {
  PetscInt   n, room;
  PetscReal *value;
} BlockPiece;

/* One row of nodes of a block. Targets: a column of nodes in the block, and the pair of the row, counted from its first, that it is added to. */
typedef struct {
  PetscInt at, block, node;       /* the block's place in the pattern, its number, which of its rows */
  PetscInt first_target, targets; /* pairs up to the diagonal: all blocks are symmetric */
} BlockRow;

struct _n_BlockMatrix {
  MPI_Comm    comm;
  int         size;                                                       /* of a node: its dofs */
  PetscInt    n, room, n_entries, entries_room, n_pieces, piece, n_pairs; /* piece: that is being filled; n_pairs: of nodes, over all blocks */
  Block      *block;
  PetscInt   *entry;
  BlockPiece *pieces;
  NodeMatrix  matrix;
  PetscInt    n_pattern, *pattern; /* of the blocks: number of nodes and nodes' keys of block after block; key: the first dof, -1 without any */
  PetscInt    n_nodes, *key, *dof; /* of the matrix: keys ascending, dofs (n_nodes*size) */
  PetscInt   *pair_ptr, *pair;     /* blocks overlap: every pair of nodes once, row by row, ascending */
  PetscInt   *mirror;              /* of the pairs below the diagonal: the pair with row and column swapped */
  PetscInt   *row_ptr, *target;    /* of each node, its rows in the blocks; where these are added */
  BlockRow   *row;
  PetscReal  *sum;      /* over the pairs, block by block */
  PetscBool   restored; /* the matrix is not the one that its user knows */
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
  for (PetscInt k = 0; k < (*blocks)->n_pieces; k++) PetscCall(PetscFree((*blocks)->pieces[k].value));
  PetscCall(PetscFree((*blocks)->pieces));
  PetscCall(PetscFree((*blocks)->pattern));
  PetscCall(PetscFree((*blocks)->key));
  PetscCall(PetscFree((*blocks)->dof));
  PetscCall(PetscFree((*blocks)->pair_ptr));
  PetscCall(PetscFree((*blocks)->pair));
  PetscCall(PetscFree((*blocks)->mirror));
  PetscCall(PetscFree((*blocks)->row_ptr));
  PetscCall(PetscFree((*blocks)->target));
  PetscCall(PetscFree((*blocks)->row));
  PetscCall(PetscFree((*blocks)->sum));
  PetscCall(NodeMatrixDestroy(&(*blocks)->matrix));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixReset - drops all blocks; the assembled matrix and its pattern stay. Not collective. */
PetscErrorCode BlockMatrixReset(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  blocks->n = blocks->n_entries = blocks->piece = blocks->n_pairs = 0;
  for (PetscInt k = 0; k < blocks->n_pieces; k++) blocks->pieces[k].n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for n values, which are zero, until the next reset. */
static PetscErrorCode TakeValues(BlockMatrix blocks, PetscInt n, PetscReal **value)
{
  PetscFunctionBeginUser;
  while (blocks->piece < blocks->n_pieces && blocks->pieces[blocks->piece].n + n > blocks->pieces[blocks->piece].room) blocks->piece++;
  if (blocks->piece == blocks->n_pieces) {
    const PetscInt room = PetscMax(n, BLOCK_PIECE);

    PetscCall(PetscRealloc((blocks->n_pieces + 1) * sizeof(BlockPiece), &blocks->pieces));
    blocks->pieces[blocks->n_pieces] = (BlockPiece){.room = room};
    PetscCall(PetscMalloc1(room, &blocks->pieces[blocks->n_pieces++].value));
  }
  *value = &blocks->pieces[blocks->piece].value[blocks->pieces[blocks->piece].n];
  blocks->pieces[blocks->piece].n += n;
  PetscCall(PetscArrayzero(*value, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for a block of size m with n values, which are zero. */
static PetscErrorCode AddBlock(BlockMatrix blocks, int list, PetscInt m, PetscInt n, PetscInt **entry, PetscReal **value)
{
  PetscFunctionBeginUser;
  if (blocks->n == blocks->room) PetscCall(PetscRealloc((blocks->room = 2 * blocks->room + 64) * sizeof(Block), &blocks->block));
  if (blocks->n_entries + m > blocks->entries_room)
    PetscCall(PetscRealloc((blocks->entries_room = 2 * (blocks->entries_room + m)) * sizeof(PetscInt), &blocks->entry));
  *entry = &blocks->entry[blocks->n_entries];
  PetscCall(TakeValues(blocks, n, value));
  blocks->block[blocks->n++] = (Block){.list = list, .m = m, .entry = blocks->n_entries, .value = *value};
  blocks->n_entries += m;
  blocks->n_pairs += PetscSqr(m / blocks->size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAdd - a new block over entries of rank-local vector `list` (contact: the pair's number).

   Not collective. m: size of the block, whole nodes. entry[m]: to be written, node by node; value[m*m]: row-major (force per length), zero, to be added to.
   Both stand until the next call: growing moves them. */
PetscErrorCode BlockMatrixAdd(BlockMatrix blocks, int list, PetscInt m, PetscInt **entry, PetscReal **value)
{
  PetscFunctionBeginUser;
  PetscCall(AddBlock(blocks, list, m, m * m, entry, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAddOuter - as BlockMatrixAdd() for a block v v^T, which is never written out: value[m] is v. Not collective. */
PetscErrorCode BlockMatrixAddOuter(BlockMatrix blocks, int list, PetscInt m, PetscInt **entry, PetscReal **value)
{
  PetscFunctionBeginUser;
  PetscCall(AddBlock(blocks, list, m, m, entry, value));
  blocks->block[blocks->n - 1].outer = PETSC_TRUE;
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

/* The rows of all blocks, those of one node together, in the blocks' order. */
static PetscErrorCode GroupRows(BlockMatrix blocks, const PetscInt *number)
{
  PetscInt *ptr, block = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->row_ptr));
  PetscCall(PetscFree(blocks->row));
  PetscCall(PetscCalloc1(blocks->n_nodes + 2, &ptr));
  PetscCall(PetscMalloc1(blocks->n_pattern, &blocks->row));
  for (PetscInt k = 0; k < blocks->n_pattern; k++)
    if (number[k] >= 0) ptr[number[k] + 2]++;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) ptr[r + 2] += ptr[r + 1];
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at], block++) {
    for (PetscInt i = 1; i <= blocks->pattern[at]; i++) /* moves ptr[r + 1] from the start of r's to their end */
      if (number[at + i] >= 0) blocks->row[ptr[number[at + i] + 1]++] = (BlockRow){.at = at, .block = block, .node = i - 1};
  }
  blocks->row_ptr = ptr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of nodes that some block couples, each once, row by row. Blocks overlap several times over, so this spares the parallel matrix most of
   the entries. seen[n_nodes]: scratch. */
static PetscErrorCode ListPairs(BlockMatrix blocks, const PetscInt *number, PetscInt *seen)
{
  const BlockRow *row = blocks->row;
  PetscInt        n   = 0, *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->pair_ptr));
  PetscCall(PetscFree(blocks->pair));
  PetscCall(PetscMalloc1(blocks->n_pairs, &pair));
  PetscCall(PetscMalloc1(blocks->n_nodes + 1, &blocks->pair_ptr));
  for (PetscInt r = 0; r < blocks->n_nodes; r++) seen[r] = -1;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    blocks->pair_ptr[r] = n;
    for (PetscInt k = blocks->row_ptr[r]; k < blocks->row_ptr[r + 1]; k++) {
      for (PetscInt j = 1; j <= blocks->pattern[row[k].at]; j++) {
        const PetscInt column = number[row[k].at + j];

        if (column < 0 || seen[column] >= blocks->pair_ptr[r]) continue;
        seen[column] = n;
        pair[n++]    = column;
      }
    }
    PetscCall(PetscSortInt(n - blocks->pair_ptr[r], &pair[blocks->pair_ptr[r]])); /* so the matrix need not sort its rows */
  }
  blocks->pair_ptr[blocks->n_nodes] = n;
  PetscCall(PetscMalloc1(n, &blocks->pair));
  PetscCall(PetscArraycpy(blocks->pair, pair, n));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the image of each pair below the diagonal. */
static PetscErrorCode ListMirrors(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->mirror));
  PetscCall(PetscMalloc1(blocks->pair_ptr[blocks->n_nodes], &blocks->mirror));
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    for (PetscInt k = blocks->pair_ptr[r]; k < blocks->pair_ptr[r + 1] && blocks->pair[k] < r; k++) {
      const PetscInt first = blocks->pair_ptr[blocks->pair[k]], n = blocks->pair_ptr[blocks->pair[k] + 1] - first;

      PetscCall(PetscFindInt(r, n, &blocks->pair[first], &blocks->mirror[k]));
      blocks->mirror[k] += first;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives every pair in the blocks its place in the sums; *used: how many get one, -1: one is missing. seen[2*n_nodes]: scratch. */
static PetscErrorCode PlacePairs(BlockMatrix blocks, const PetscInt *number, PetscInt *seen, PetscInt *used)
{
  PetscInt *met = seen + blocks->n_nodes, n = 0; /* met: the last row in which a column was asked for */

  PetscFunctionBeginUser;
  *used = 0;
  PetscCall(PetscFree(blocks->target));
  PetscCall(PetscMalloc1(2 * blocks->n_pairs, &blocks->target));
  for (PetscInt r = 0; r < blocks->n_nodes; r++) seen[r] = met[r] = -1;
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    const PetscInt first = blocks->pair_ptr[r];

    for (PetscInt k = first; k < blocks->pair_ptr[r + 1]; k++) seen[blocks->pair[k]] = k;
    for (PetscInt k = blocks->row_ptr[r]; k < blocks->row_ptr[r + 1]; k++) {
      BlockRow *row = &blocks->row[k];

      row->first_target = n;
      for (PetscInt j = 0; j < blocks->pattern[row->at]; j++) {
        const PetscInt column = number[row->at + 1 + j];

        if (column < 0) continue;
        if (seen[column] < first) {
          *used = -1;
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        *used += met[column] != r;
        met[column] = r;
        if (column > r) continue;
        blocks->target[2 * n]     = j;
        blocks->target[2 * n + 1] = seen[column] - first;
        n++;
      }
      row->targets = n - row->first_target;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a place for every pair. fresh: among pairs listed anew; else among those that are there, if these hold all and are not far too many: *placed. */
static PetscErrorCode PlacePattern(BlockMatrix blocks, const PetscInt *const dof[], PetscBool fresh, PetscBool *placed)
{
  PetscInt *number, *seen, used = -1;

  PetscFunctionBeginUser;
  if (fresh) PetscCall(ListNodes(blocks, dof));
  PetscCall(PetscMalloc2(blocks->n_pattern, &number, 2 * blocks->n_nodes, &seen));
  PetscCall(NumberNodes(blocks, number, placed));
  if (*placed) {
    PetscCall(GroupRows(blocks, number));
    if (fresh) PetscCall(ListPairs(blocks, number, seen));
    if (fresh) PetscCall(ListMirrors(blocks));
    PetscCall(PlacePairs(blocks, number, seen, &used));
    *placed = used >= 0 && blocks->pair_ptr[blocks->n_nodes] <= BLOCK_SLACK * used ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree2(number, seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A matrix of `rows` rows on this rank with the pairs that are listed. */
static PetscErrorCode CreateMatrix(BlockMatrix blocks, PetscInt rows)
{
  const NodePairs pairs = {blocks->size, blocks->n_nodes, blocks->dof, blocks->pair_ptr, blocks->pair};

  PetscFunctionBeginUser;
  PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscCall(NodeMatrixCreate(blocks->comm, rows, &pairs, &blocks->matrix));
  PetscCall(NodeMatrixJoin(blocks->matrix, NULL));
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscMalloc1(blocks->pair_ptr[blocks->n_nodes] * PetscSqr(blocks->size), &blocks->sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds one row of nodes of a block to the sums of its node; size and outer constants where this is called, so that the loops over a node's dofs unroll. */
static inline void SumRow(const int size, const PetscBool outer, PetscInt m, PetscInt node, const PetscReal *value, PetscInt n, const PetscInt *target,
                          PetscReal *sum)
{
  const PetscReal *row = outer ? value : value + node * size * m;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *from = row + target[2 * k] * size;
    PetscReal       *to   = sum + target[2 * k + 1] * size * size;

    for (int d = 0; d < size; d++)
      for (int e = 0; e < size; e++) to[d * size + e] += outer ? value[node * size + d] * from[e] : from[d * m + e];
  }
}

/* The upper triangle from the lower one. */
static void Mirror(BlockMatrix blocks)
{
  const int size = blocks->size;

  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    for (PetscInt k = blocks->pair_ptr[r]; k < blocks->pair_ptr[r + 1] && blocks->pair[k] < r; k++) {
      const PetscReal *from = &blocks->sum[k * PetscSqr(size)];
      PetscReal       *to   = &blocks->sum[blocks->mirror[k] * PetscSqr(size)];

      for (int d = 0; d < size; d++)
        for (int e = 0; e < size; e++) to[e * size + d] = from[d * size + e];
    }
  }
}

/* Row of nodes by row of nodes, so that what is added to stays at hand. */
static PetscErrorCode SumBlocks(BlockMatrix blocks)
{
  const int size = blocks->size;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(blocks->sum, blocks->pair_ptr[blocks->n_nodes] * PetscSqr(size)));
  for (PetscInt r = 0; r < blocks->n_nodes; r++) {
    PetscReal *const sum = &blocks->sum[blocks->pair_ptr[r] * PetscSqr(size)];

    for (PetscInt k = blocks->row_ptr[r]; k < blocks->row_ptr[r + 1]; k++) {
      const BlockRow  *row    = &blocks->row[k];
      const Block     *block  = &blocks->block[row->block];
      const PetscReal *value  = block->value;
      const PetscInt  *target = &blocks->target[2 * row->first_target];

      if (size == 3 && block->outer)
        SumRow(3, PETSC_TRUE, block->m, row->node, value, row->targets, target, sum);
      else if (size == 3)
        SumRow(3, PETSC_FALSE, block->m, row->node, value, row->targets, target, sum);
      else
        SumRow(size, block->outer, block->m, row->node, value, row->targets, target, sum);
    }
  }
  Mirror(blocks);
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
  PetscCall(NodeMatrixSet(blocks->matrix, blocks->sum));
  *matrix          = NodeMatrixGet(blocks->matrix);
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
    const PetscReal *value = block->value;
    PetscReal        along = 0;

    if (block->list != list) continue;
    for (PetscInt i = 0; i < block->m && block->outer; i++) along += value[i] * x[entry[i]];
    for (PetscInt i = 0; i < block->m && block->outer; i++) y[entry[i]] += value[i] * along;
    for (PetscInt i = 0; i < block->m && !block->outer; i++)
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
  blocks->n_nodes = n[0];
  PetscCall(ListMirrors(blocks));
  blocks->n_pattern = 0; /* where the next blocks stand in it is found then */
  PetscCall(CreateMatrix(blocks, rows));
  blocks->restored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
