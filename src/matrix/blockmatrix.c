#include "matrix/blockmatrix.h"
#include "matrix/nodematrix.h"

/* A pattern is kept while it holds what the blocks need, with zeros elsewhere, and is at most this many times as large:
   a new one costs the sum with other matrices and the solver's analysis (half of a factorisation at 10,000 dofs), a
   zero costs fill. Contact that moves on seldom reaches it. */
#define BLOCK_SLACK 1.5

/* Number of a node while nodes are listed */
enum { BLOCK_LISTED = -2 };

/* A row of a pair's sum, filled up to a vector of the machine's; what is beyond the pair's own columns is not used */
enum { ROW = BLOCK_PADDING + 1 };
typedef double SumRow __attribute__((vector_size(ROW * sizeof(double)), aligned(sizeof(double)),
                                     may_alias)); /* as PetscMalloc() aligns, and within arrays */

/* One row of nodes of a block: where the block starts in the pattern, which of its rows it is */
typedef struct {
  PetscInt at, node;
} BlockRow;

/* Nodes by ascending keys with their dofs (n_nodes*size); blocks overlap: every pair of nodes once, row by row,
 * ascending; pair_ptr NULL: there is no matrix */
typedef struct {
  PetscInt n_nodes, *key, *dof, *pair_ptr, *pair;
} BlockPattern;

struct _n_BlockMatrix {
  MPI_Comm  comm;
  int       size;                   /* of a node: its dofs */
  PetscInt  n_listed, *list;        /* nodes of all lists, one list after another; where each starts */
  PetscInt *list_key, *list_number; /* of every node of the lists: its key, -1 without any; its place among those of the
                                       matrix, -1 elsewhere */
  PetscInt *list_dof;               /* size for each of these nodes */
  PetscInt  n, room, *ptr, *of;     /* named blocks: where their nodes start; their lists */
  PetscInt  nodes_room,
    *node; /* of the blocks one after another, by ascending key, those without one last: place in the list */
  NodeMatrix matrix;
  PetscInt   n_pattern,
    *pattern; /* of the blocks: number of nodes with keys and these keys of block after block; key: the first dof */
  BlockPattern own; /* of the matrix */
  PetscInt    *diagonal,
    *above; /* of each row: its first pair that is not below the diagonal; which of those of all rows that is */
  PetscInt *of_pair; /* the sum of each pair: its own, below the diagonal that of its mirror image */
  PetscInt *row_ptr; /* of each node, its rows in the blocks */
  BlockRow *row;
  PetscInt *seen,
    *at; /* of each node of the matrix: the last sum in whose column it stood; at: numbers of the block at hand */
  SumRow          *sum;     /* [pairs not below the diagonal][size] */
  PetscInt        *coupled; /* room for what BlockMatrixGetCoupled() shows */
  const PetscReal *along;   /* what blocks are multiplied with as they are added, or NULL */
  PetscReal       *product;
  PetscBool        restored; /* the matrix is not the one that its user knows */
  PetscBool        replaced; /* the pattern is not the one of BlockMatrixMark(), which is put aside */
  BlockPattern     marked;
};

/* BlockMatrixCreate - an empty one.

   Collective. size: dofs of a node, up to 4, which stand next to each other in blocks in an order of their own; 1: one
   by one. */
PetscErrorCode BlockMatrixCreate(MPI_Comm comm, int size, BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(blocks));
  (*blocks)->comm = comm;
  (*blocks)->size = size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyLists(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(blocks->list, blocks->list_key, blocks->list_number, blocks->list_dof));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyPattern(BlockPattern *pattern)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(pattern->key));
  PetscCall(PetscFree(pattern->dof));
  PetscCall(PetscFree(pattern->pair_ptr));
  PetscCall(PetscFree(pattern->pair));
  *pattern = (BlockPattern){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixDestroy - Collective. */
PetscErrorCode BlockMatrixDestroy(BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  if (!*blocks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyLists(*blocks));
  PetscCall(PetscFree((*blocks)->ptr));
  PetscCall(PetscFree((*blocks)->of));
  PetscCall(PetscFree((*blocks)->node));
  PetscCall(PetscFree((*blocks)->pattern));
  PetscCall(DestroyPattern(&(*blocks)->own));
  PetscCall(DestroyPattern(&(*blocks)->marked));
  PetscCall(PetscFree2((*blocks)->diagonal, (*blocks)->above));
  PetscCall(PetscFree((*blocks)->of_pair));
  PetscCall(PetscFree((*blocks)->row_ptr));
  PetscCall(PetscFree((*blocks)->row));
  PetscCall(PetscFree2((*blocks)->seen, (*blocks)->at));
  PetscCall(PetscFree((*blocks)->sum));
  PetscCall(PetscFree((*blocks)->coupled));
  PetscCall(NodeMatrixDestroy(&(*blocks)->matrix));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixBegin - a new sum: without blocks, over the nodes of new lists; the assembled matrix and its pattern stay.

   Not collective. n_lists: rank-local vectors (contact: one for each pair); n[list]: their nodes; dof[list][n*size]:
   global dofs, -1: none (its rows and columns are left out). */
PetscErrorCode BlockMatrixBegin(BlockMatrix blocks, int n_lists, const PetscInt n[], const PetscInt *const dof[])
{
  const int size  = blocks->size;
  PetscInt  total = 0;

  PetscFunctionBeginUser;
  PetscCall(DestroyLists(blocks));
  for (int l = 0; l < n_lists; l++) total += n[l];
  PetscCall(PetscMalloc4(n_lists, &blocks->list, total, &blocks->list_key, total, &blocks->list_number, total * size,
                         &blocks->list_dof));
  blocks->n        = 0;
  blocks->along    = NULL;
  blocks->n_listed = 0;
  for (int l = 0; l < n_lists; l++) {
    blocks->list[l] = blocks->n_listed;
    PetscCall(PetscArraycpy(&blocks->list_dof[blocks->n_listed * size], dof[l], n[l] * size));
    blocks->n_listed += n[l];
  }
  for (PetscInt i = 0; i < total; i++) {
    blocks->list_key[i] = blocks->list_number[i] = -1;
    for (int d = 0; d < size && blocks->list_key[i] < 0; d++)
      blocks->list_key[i] = PetscMax(-1, blocks->list_dof[i * size + d]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixSort - brings nodes of a list into the order in which blocks have them; *with: how many of them have dofs,
 * which come first. Not collective. */
PetscErrorCode BlockMatrixSort(BlockMatrix blocks, int list, PetscInt n, PetscInt node[], PetscInt *with)
{
  const PetscInt *key = &blocks->list_key[blocks->list[list]];
  PetscInt       *keys;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &keys));
  *with = 0;
  for (PetscInt i = 0; i < n; i++) {
    *with += key[node[i]] >= 0;
    keys[i] = key[node[i]] >= 0 ? key[node[i]] : PETSC_MAX_INT;
  }
  PetscCall(PetscSortIntWithArray(n, keys, node));
  PetscCall(PetscFree(keys));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixName - announces a block over nodes of list `list`, or, with fewer of them, blocks within it.

   Not collective, before BlockMatrixPlace(). whole: its nodes without dofs, too, are wanted by BlockMatrixGetNodes().
 */
PetscErrorCode BlockMatrixName(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[], PetscBool whole)
{
  PetscInt first, with;

  PetscFunctionBeginUser;
  if (blocks->n + 1 >= blocks->room) {
    blocks->room = 2 * blocks->room + 64;
    PetscCall(PetscRealloc(blocks->room * sizeof(PetscInt), &blocks->ptr));
    PetscCall(PetscRealloc(blocks->room * sizeof(PetscInt), &blocks->of));
  }
  if (!blocks->n) blocks->ptr[0] = 0;
  first = blocks->ptr[blocks->n];
  if (first + n > blocks->nodes_room)
    PetscCall(PetscRealloc((blocks->nodes_room = 2 * (first + n)) * sizeof(PetscInt), &blocks->node));
  PetscCall(PetscArraycpy(&blocks->node[first], node, n));
  PetscCall(BlockMatrixSort(blocks, list, n, &blocks->node[first], &with));
  blocks->of[blocks->n]    = list;
  blocks->ptr[++blocks->n] = first + (whole ? n : with);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixGetNodes - the nodes of the b-th block that was named, in its order; borrowed until BlockMatrixBegin().
 * Not collective. */
void BlockMatrixGetNodes(BlockMatrix blocks, PetscInt b, PetscInt *n, const PetscInt **node)
{
  *n    = blocks->ptr[b + 1] - blocks->ptr[b];
  *node = &blocks->node[blocks->ptr[b]];
}

/* The pattern that the named blocks need. */
static PetscErrorCode BlocksPattern(BlockMatrix blocks, PetscInt *n, PetscInt **pattern)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(blocks->n + (blocks->n ? blocks->ptr[blocks->n] : 0), pattern));
  *n = 0;
  for (PetscInt b = 0; b < blocks->n; b++) {
    const PetscInt *key = &blocks->list_key[blocks->list[blocks->of[b]]], count = (*n)++;

    for (PetscInt i = blocks->ptr[b]; i < blocks->ptr[b + 1] && key[blocks->node[i]] >= 0; i++)
      (*pattern)[(*n)++] = key[blocks->node[i]];
    (*pattern)[count] = *n - count - 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes that blocks have, ascending, each once, with room for their dofs. */
static PetscErrorCode ListNodes(BlockMatrix blocks)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->own.key));
  PetscCall(PetscMalloc1(blocks->n_pattern, &blocks->own.key));
  for (PetscInt b = 0; b < blocks->n; b++) {
    for (PetscInt i = blocks->ptr[b]; i < blocks->ptr[b + 1]; i++) {
      const PetscInt node = blocks->list[blocks->of[b]] + blocks->node[i];

      if (blocks->list_key[node] < 0 || blocks->list_number[node] == BLOCK_LISTED) continue;
      blocks->list_number[node] = BLOCK_LISTED;
      blocks->own.key[n++]      = blocks->list_key[node];
    }
  }
  PetscCall(PetscSortRemoveDupsInt(&n, blocks->own.key)); /* of several lists */
  blocks->own.n_nodes = n;
  PetscCall(PetscFree(blocks->own.dof));
  PetscCall(PetscMalloc1(n * blocks->size, &blocks->own.dof));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which node of the matrix each node of the lists is that a block has; *known: all of them are listed there. fresh: it
 * gets its dofs from there. */
static PetscErrorCode BlockMatrixNumberNodes(BlockMatrix blocks, PetscBool fresh, PetscBool *known)
{
  const int size = blocks->size;

  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt b = 0; b < blocks->n; b++) {
    const PetscInt first = blocks->list[blocks->of[b]];

    for (PetscInt i = blocks->ptr[b]; i < blocks->ptr[b + 1]; i++) {
      const PetscInt node = first + blocks->node[i];
      PetscInt      *at   = &blocks->list_number[node];

      if (*at >= 0 || blocks->list_key[node] < 0) continue;
      PetscCall(PetscFindInt(blocks->list_key[node], blocks->own.n_nodes, blocks->own.key, at));
      if (*at < 0) {
        *at    = -1;
        *known = PETSC_FALSE;
      } else if (fresh)
        PetscCall(PetscArraycpy(&blocks->own.dof[*at * size], &blocks->list_dof[node * size], size));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows of all blocks, those of one node together, in the blocks' order. number[n_pattern]: out, the nodes of the
 * pattern in the matrix. */
static PetscErrorCode GroupRows(BlockMatrix blocks, PetscInt *number)
{
  PetscInt *ptr, block = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->row_ptr));
  PetscCall(PetscFree(blocks->row));
  PetscCall(PetscCalloc1(blocks->own.n_nodes + 2, &ptr));
  PetscCall(PetscMalloc1(blocks->n_pattern, &blocks->row));
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at], block++) {
    const PetscInt first = blocks->list[blocks->of[block]], *node = &blocks->node[blocks->ptr[block]];

    for (PetscInt i = 0; i < blocks->pattern[at]; i++)
      ptr[(number[at + 1 + i] = blocks->list_number[first + node[i]]) + 2]++;
  }
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) ptr[r + 2] += ptr[r + 1];
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at])
    for (PetscInt i = 0; i < blocks->pattern[at]; i++) /* moves ptr[r + 1] from the start of r's to their end */
      blocks->row[ptr[number[at + 1 + i] + 1]++] = (BlockRow){.at = at + 1, .node = i};
  blocks->row_ptr = ptr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs on and above the diagonal that some block couples, each once, row by row, in no order. ptr[n_nodes + 1]:
 * out; *pair: out, to be freed. */
static PetscErrorCode ListUpper(BlockMatrix blocks, const PetscInt *number, PetscInt *ptr, PetscInt **pair)
{
  const BlockRow *row  = blocks->row;
  PetscInt        room = 0, *seen;

  PetscFunctionBeginUser;
  for (PetscInt at = 0; at < blocks->n_pattern; at += 1 + blocks->pattern[at])
    room += blocks->pattern[at] * (blocks->pattern[at] + 1) / 2;
  PetscCall(PetscMalloc1(room, pair));
  PetscCall(PetscMalloc1(blocks->own.n_nodes, &seen));
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) seen[r] = -1;
  ptr[0] = 0;
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    ptr[r + 1] = ptr[r];
    for (PetscInt k = blocks->row_ptr[r]; k < blocks->row_ptr[r + 1]; k++) {
      for (PetscInt j = row[k].node; j < blocks->pattern[row[k].at - 1]; j++) {
        const PetscInt column = number[row[k].at + j];

        if (seen[column] == r) continue;
        seen[column]          = r;
        (*pair)[ptr[r + 1]++] = column;
      }
    }
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of nodes that some block couples, each once, row by row, ascending. Blocks overlap several times over, so
   this spares the parallel matrix most of the entries. Nothing is sorted: who has a node in its row is found in
   ascending order. */
static PetscErrorCode ListPairs(BlockMatrix blocks, const PetscInt *number)
{
  const PetscInt n = blocks->own.n_nodes;
  PetscInt      *ptr, *next, *upper_ptr, *upper, *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->own.pair_ptr));
  PetscCall(PetscFree(blocks->own.pair));
  PetscCall(PetscCalloc1(n + 1, &ptr));
  PetscCall(PetscMalloc2(n, &next, n + 1, &upper_ptr));
  PetscCall(ListUpper(blocks, number, upper_ptr, &upper));
  for (PetscInt r = 0; r < n; r++) {
    ptr[r + 1] += upper_ptr[r + 1] - upper_ptr[r];
    for (PetscInt k = upper_ptr[r]; k < upper_ptr[r + 1]; k++) ptr[upper[k] + 1] += upper[k] > r;
  }
  for (PetscInt r = 0; r < n; r++) ptr[r + 1] += ptr[r];
  PetscCall(PetscArraycpy(next, ptr, n));
  PetscCall(PetscMalloc1(ptr[n], &pair));
  for (PetscInt r = 0; r < n; r++) /* below the diagonal */
    for (PetscInt k = upper_ptr[r]; k < upper_ptr[r + 1]; k++)
      if (upper[k] > r) pair[next[upper[k]]++] = r;
  for (PetscInt r = 0; r < n; r++) { /* and the rest */
    const PetscInt diagonal = next[r]++;

    pair[diagonal] = r;
    for (PetscInt k = ptr[r]; k < diagonal; k++) pair[next[pair[k]]++] = r;
  }
  PetscCall(PetscFree(upper));
  PetscCall(PetscFree2(next, upper_ptr));
  blocks->own.pair_ptr = ptr;
  blocks->own.pair     = pair;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the diagonal, and the sum of each pair: there is one for it and its mirror image. */
static PetscErrorCode ListSums(BlockMatrix blocks)
{
  const PetscInt *ptr = blocks->own.pair_ptr, n = ptr[blocks->own.n_nodes];
  PetscInt       *next;

  PetscFunctionBeginUser;
  PetscCall(PetscFree2(blocks->diagonal, blocks->above));
  PetscCall(PetscFree(blocks->of_pair));
  PetscCall(PetscFree2(blocks->seen, blocks->at));
  PetscCall(PetscMalloc2(blocks->own.n_nodes, &blocks->diagonal, blocks->own.n_nodes + 1, &blocks->above));
  blocks->above[0] = 0;
  PetscCall(PetscMalloc1(n, &blocks->of_pair));
  PetscCall(PetscMalloc2(blocks->own.n_nodes, &blocks->seen, blocks->own.n_nodes, &blocks->at));
  PetscCall(PetscMalloc1(
    blocks->own.n_nodes,
    &next)); /* of each row: the pair below the diagonal whose image comes next; images come in the order of rows */
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    next[r] = ptr[r];
    for (blocks->diagonal[r] = ptr[r]; blocks->diagonal[r] < ptr[r + 1] && blocks->own.pair[blocks->diagonal[r]] < r;)
      blocks->diagonal[r]++;
    blocks->above[r + 1] = blocks->above[r] + ptr[r + 1] - blocks->diagonal[r];
  }
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++)
    for (PetscInt k = blocks->diagonal[r]; k < ptr[r + 1]; k++)
      blocks->of_pair[k] = blocks->of_pair[next[blocks->own.pair[k]]++] = blocks->above[r] + k - blocks->diagonal[r];
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many of the matrix' pairs the pattern needs, -1: one is missing. */
static PetscErrorCode CountPairs(BlockMatrix blocks, const PetscInt *number, PetscInt *used)
{
  PetscInt *seen = blocks->seen, *met = blocks->at; /* met: the last row in which a column was asked for */

  PetscFunctionBeginUser;
  *used = 0;
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) seen[r] = met[r] = -1;
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    for (PetscInt k = blocks->diagonal[r]; k < blocks->own.pair_ptr[r + 1]; k++) seen[blocks->own.pair[k]] = r;
    for (PetscInt k = blocks->row_ptr[r]; k < blocks->row_ptr[r + 1]; k++) {
      const BlockRow *row = &blocks->row[k];

      for (PetscInt j = row->node; j < blocks->pattern[row->at - 1]; j++) {
        const PetscInt column = number[row->at + j];

        if (seen[column] != r) {
          *used = -1;
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        *used += met[column] == r ? 0 : column == r ? 1 : 2;
        met[column] = r;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a place for every pair. fresh: among pairs listed anew; else among those that are there, if these hold all and
 * are not far too many: *placed. */
static PetscErrorCode PlacePattern(BlockMatrix blocks, PetscBool fresh, PetscBool *placed)
{
  PetscInt *number, used;

  PetscFunctionBeginUser;
  if (fresh) PetscCall(ListNodes(blocks));
  PetscCall(BlockMatrixNumberNodes(blocks, fresh, placed));
  if (!*placed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(blocks->n_pattern, &number));
  PetscCall(GroupRows(blocks, number));
  if (fresh) {
    PetscCall(ListPairs(blocks, number));
    PetscCall(ListSums(blocks));
  } else {
    PetscCall(CountPairs(blocks, number, &used));
    *placed = used >= 0 && blocks->own.pair_ptr[blocks->own.n_nodes] <= BLOCK_SLACK * used ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A matrix of `rows` rows on this rank with the pairs that are listed. */
static PetscErrorCode BlockMatrixCreateMat(BlockMatrix blocks, PetscInt rows)
{
  const NodePairs pairs = {blocks->size, blocks->own.n_nodes, blocks->own.dof, blocks->own.pair_ptr, blocks->own.pair};

  PetscFunctionBeginUser;
  PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscCall(NodeMatrixCreate(blocks->comm, rows, &pairs, &blocks->matrix));
  PetscCall(NodeMatrixJoin(blocks->matrix, NULL));
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscFree(blocks->coupled));
  PetscCall(PetscMalloc1(blocks->above[blocks->own.n_nodes] * blocks->size, &blocks->sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixPlace - the places of all named blocks in a parallel AIJ matrix over the global dofs, which stays the
   block matrix's; the sum is 0.

   Collective. rows: of this rank. *changed: the matrix is a new one, as the last one's pattern did not hold some rank's
   blocks or was far larger; else only its values are, with zeros where no block asks for an entry. */
PetscErrorCode BlockMatrixPlace(BlockMatrix blocks, PetscInt rows, PetscBool *changed)
{
  PetscInt  n = 0, *pattern = NULL;
  PetscBool placed;
  int       all;

  PetscFunctionBeginUser;
  PetscCall(BlocksPattern(blocks, &n, &pattern));
  placed = (PetscBool)(blocks->matrix && n == blocks->n_pattern);
  if (placed && n) PetscCall(PetscArraycmp(pattern, blocks->pattern, n, &placed));
  PetscCall(PetscFree(blocks->pattern));
  blocks->pattern   = pattern;
  blocks->n_pattern = n;
  if (placed)
    PetscCall(BlockMatrixNumberNodes(blocks, PETSC_FALSE, &placed));
  else if (blocks->matrix)
    PetscCall(PlacePattern(blocks, PETSC_FALSE, &placed));
  all = placed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, blocks->comm));
  if (!all) {
    if (!blocks->replaced) {
      blocks->marked = blocks->own;
      blocks->own    = (BlockPattern){0};
    }
    blocks->replaced = PETSC_TRUE;
    for (PetscInt i = 0; i < blocks->n_listed; i++) blocks->list_number[i] = -1;
    PetscCall(PlacePattern(blocks, PETSC_TRUE, &placed));
    PetscCall(BlockMatrixCreateMat(blocks, rows));
  }
  PetscCall(PetscArrayzero(blocks->sum, blocks->above[blocks->own.n_nodes] * blocks->size));
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) blocks->seen[r] = -1;
  *changed         = all && !blocks->restored ? PETSC_FALSE : PETSC_TRUE;
  blocks->restored = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes where the sums of a row stand. */
static inline void LookAlong(BlockMatrix blocks, PetscInt r)
{
  const PetscInt *pair = &blocks->own.pair[blocks->diagonal[r]], first = blocks->above[r],
                 n = blocks->above[r + 1] - first;

  for (PetscInt k = 0; k < n; k++) blocks->seen[pair[k]] = first + k;
}

/* Adds the upper triangle of a block to the sums; size and outer constants where this is called, so that the loop over
 * a node's rows unrolls. */
static inline PetscErrorCode Sum(const int size, const PetscBool outer, BlockMatrix blocks, PetscInt n, PetscInt m,
                                 const PetscReal *value)
{
  const PetscInt *at = blocks->at, *seen = blocks->seen;
  SumRow *const   sums = blocks->sum; /* else it would be read again after every sum, which may be anything */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt   first = blocks->above[at[i]], end = blocks->above[at[i] + 1];
    const PetscReal *row = outer ? value : value + i * size * m;

    LookAlong(blocks, at[i]);
    for (PetscInt j = i; j < n; j++) {
      const PetscInt   k    = seen[at[j]];
      const PetscReal *from = row + j * size;
      SumRow          *sum  = &sums[k * size];

      PetscCheck(k >= first && k < end, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "a block couples nodes that no named one does");
      for (int d = 0; d < size; d++) {
        if (outer)
          sum[d] += value[i * size + d] * *(const SumRow *)from;
        else
          sum[d] += *(const SumRow *)(from + d * m);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += A x from the upper triangle. */
static void MultiplyUpper(PetscInt m, const PetscReal *A, const PetscReal *x, PetscReal *y)
{
  for (PetscInt i = 0; i < m; i++) {
    const PetscReal *row = A + i * m;
    PetscReal        sum = row[i] * x[i];

    for (PetscInt j = i + 1; j < m; j++) {
      sum += row[j] * x[j];
      y[j] += row[j] * x[i];
    }
    y[i] += sum;
  }
}

/* y += v v^T x */
static void MultiplyOuter(PetscInt m, const PetscReal *v, const PetscReal *x, PetscReal *y)
{
  PetscReal along = 0;

  for (PetscInt i = 0; i < m; i++) along += v[i] * x[i];
  for (PetscInt i = 0; i < m; i++) y[i] += along * v[i];
}

/* product += block along; most blocks are far from all that moves. */
static PetscErrorCode BlockMatrixMultiplyRows(BlockMatrix blocks, PetscInt n, const PetscInt *node, PetscBool outer,
                                              const PetscReal *value)
{
  const int  size = blocks->size;
  PetscBool  any  = PETSC_FALSE;
  PetscReal *x, *y;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) any = (PetscBool)(any || blocks->along[node[i] * size + d] != 0);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n * size, &x, n * size, &y));
  PetscCall(PetscArrayzero(y, n * size));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) x[i * size + d] = blocks->along[node[i] * size + d];
  if (outer)
    MultiplyOuter(n * size, value, x, y);
  else
    MultiplyUpper(n * size, value, x, y);
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) blocks->product[node[i] * size + d] += y[i * size + d];
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(BlockMatrix blocks, int list, PetscInt n, const PetscInt *node, PetscBool outer,
                          const PetscReal *value)
{
  const PetscInt *number = &blocks->list_number[blocks->list[list]];
  PetscInt        with   = 0;

  PetscFunctionBeginUser;
  for (; with < n && number[node[with]] >= 0; with++) blocks->at[with] = number[node[with]];
  PetscCheck(with == n || blocks->list_key[blocks->list[list] + node[with]] < 0, PETSC_COMM_SELF,
             PETSC_ERR_ARG_OUTOFRANGE, "a node is in no named block");
  if (blocks->size == 3 && outer)
    PetscCall(Sum(3, PETSC_TRUE, blocks, with, n * 3, value));
  else if (blocks->size == 3)
    PetscCall(Sum(3, PETSC_FALSE, blocks, with, n * 3, value));
  else
    PetscCall(Sum(blocks->size, outer, blocks, with, n * blocks->size, value));
  if (blocks->along) PetscCall(BlockMatrixMultiplyRows(blocks, n, node, outer, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAdd - adds a block over nodes of list `list`, in the order of BlockMatrixSort(), all pairs of which some
   named block has.

   Not collective, after BlockMatrixPlace(). value[(n*size)^2 + BLOCK_PADDING]: symmetric, row-major (force per length);
   what is below the diagonal, and the padding, is not used. */
PetscErrorCode BlockMatrixAdd(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[], const PetscReal value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(blocks, list, n, node, PETSC_FALSE, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixAddOuter - as BlockMatrixAdd() for a block v v^T, which is never written out: value[n*size +
 * BLOCK_PADDING] is v. Not collective. */
PetscErrorCode BlockMatrixAddOuter(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[],
                                   const PetscReal value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(blocks, list, n, node, PETSC_TRUE, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixMultiply - from now on blocks are multiplied as they are added: y += block x, entries without a global dof
   included.

   Not collective. x, y: over the nodes of the blocks' list, borrowed; NULL: not any more. */
void BlockMatrixMultiply(BlockMatrix blocks, const PetscReal *x, PetscReal *y)
{
  blocks->along   = x;
  blocks->product = y;
}

/* Fills the sums on the diagonal, of which blocks have the upper triangle. */
static void FillDiagonal(BlockMatrix blocks)
{
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    SumRow *sum = &blocks->sum[blocks->above[r] * blocks->size];

    for (int d = 0; d < blocks->size; d++)
      for (int e = 0; e < d; e++) sum[d][e] = sum[e][d];
  }
}

/* BlockMatrixEnd - the sum of all ranks' blocks. Collective. */
PetscErrorCode BlockMatrixEnd(BlockMatrix blocks, Mat *matrix)
{
  const NodeUpper values = {(const PetscReal *)blocks->sum, ROW, blocks->of_pair, blocks->diagonal};

  PetscFunctionBeginUser;
  FillDiagonal(blocks);
  PetscCall(NodeMatrixSetUpper(blocks->matrix, &values));
  *matrix = NodeMatrixGet(blocks->matrix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixGetCoupled - Not collective. dof: its node's first one that is free, -1: none is. */
PetscErrorCode BlockMatrixGetCoupled(BlockMatrix blocks, PetscInt dof, PetscInt *n, const PetscInt **coupled)
{
  const BlockPattern *own  = &blocks->own;
  const int           size = blocks->size;
  PetscInt            r    = -1;

  PetscFunctionBeginUser;
  *n = 0;
  if (dof >= 0 && own->n_nodes) PetscCall(PetscFindInt(dof, own->n_nodes, own->key, &r));
  if (r < 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (!blocks->coupled) PetscCall(PetscMalloc1(own->n_nodes * size, &blocks->coupled));
  for (PetscInt k = own->pair_ptr[r]; k < own->pair_ptr[r + 1]; k++) {
    for (int d = 0; d < size; d++) {
      const PetscInt column = own->dof[own->pair[k] * size + d];

      if (column >= 0) blocks->coupled[(*n)++] = column;
    }
  }
  *coupled = blocks->coupled;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pattern that has been put back gets its matrix, which is a new one to its user. */
static PetscErrorCode RestoreMatrix(BlockMatrix blocks, PetscInt rows)
{
  PetscFunctionBeginUser;
  PetscCall(ListSums(blocks));
  blocks->n_pattern = -1; /* no blocks' as yet: where the next ones stand in it is found then */
  PetscCall(BlockMatrixCreateMat(blocks, rows));
  blocks->restored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixMark - Not collective. */
PetscErrorCode BlockMatrixMark(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  PetscCall(DestroyPattern(&blocks->marked));
  blocks->replaced = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixReturn - the pattern is again the one of the last BlockMatrixMark(): what is assembled from now on does
   not depend on what was since.

   Collective. rows: of this rank, as for BlockMatrixPlace(). The matrix of BlockMatrixEnd() is gone if the pattern was
   another one. */
PetscErrorCode BlockMatrixReturn(BlockMatrix blocks, PetscInt rows)
{
  PetscFunctionBeginUser;
  if (!blocks->replaced) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyPattern(&blocks->own));
  blocks->own      = blocks->marked;
  blocks->marked   = (BlockPattern){0};
  blocks->replaced = PETSC_FALSE;
  if (blocks->own.pair_ptr)
    PetscCall(RestoreMatrix(blocks, rows));
  else
    PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* BlockMatrixArchive - saves or takes over the pattern of the last assembled matrix.

   Collective. name: where it stands in the archive; rows: of this rank, as for BlockMatrixPlace(). A pattern that is
   kept depends on what was assembled before. Dofs are numbered by rank, so that it serves on one rank only, where runs
   repeat to the last bit. */
PetscErrorCode BlockMatrixArchive(BlockMatrix blocks, Archive archive, const char *name, PetscInt rows)
{
  static const char *names[] = {"key", "dof", "pair_ptr", "pair"};
  PetscInt         **list[]  = {&blocks->own.key, &blocks->own.dof, &blocks->own.pair_ptr, &blocks->own.pair};
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
    n[0] = blocks->own.n_nodes;
    n[1] = blocks->own.n_nodes * blocks->size;
    n[2] = blocks->own.n_nodes + 1;
    n[3] = blocks->own.pair_ptr[blocks->own.n_nodes];
  }
  for (int k = 0; k < 4; k++) {
    if (ArchiveLoads(archive)) PetscCall(PetscFree(*list[k]));
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", name, names[k]));
    PetscCall(ArchiveIntegerList(archive, path, &n[k], list[k]));
  }
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  blocks->own.n_nodes = n[0];
  PetscCall(RestoreMatrix(blocks, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
