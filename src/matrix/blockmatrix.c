/* Block matrix: lists the pairs of nodes that blocks couple, adds the blocks into one sum for each pair, and hands the
   sums to a NodeMatrix. Of symmetric blocks only the sums on and above the diagonal are stored. Blocks that are not
   symmetric have sums of their own for all pairs. */
#include "matrix/blockmatrix.h"
#include "matrix/blockfactors.h"
#include "matrix/nodematrix.h"
#include "base/lanes.h"

/* Largest pattern that is kept, as a multiple of the pattern that the blocks need. A pattern that holds all blocks is
   kept, with zeros where no block has an entry. A new pattern costs the sum with other matrices and the solver's
   analysis, which is half of a factorisation at 10,000 dofs. A zero costs fill. Contact that moves on seldom reaches
   this limit. */
#define BLOCK_SLACK 1.5

/* Mark in list_number of a node that has been listed but has no number yet. */
enum { BLOCK_LISTED = -2 };

/* Numbers in one row of a pair's sum. A row is filled up to the length of one of the machine's vectors. What is beyond
   the pair's own columns is not used. */
enum { ROW = BLOCK_PADDING + 1 };
/* One row of a sum as a vector. It is aligned only to a double, because PetscMalloc() and places within arrays
   guarantee no more. */
typedef double SumRow __attribute__((vector_size(ROW * sizeof(double)), aligned(sizeof(double)), may_alias));

/* One row of nodes of a block: at is the position of the block's first node in the pattern, node says which of its
   nodes the row belongs to. */
typedef struct {
  PetscInt at, node;
} BlockRow;

/* Nodes by ascending keys with their dofs (n_nodes*size), and the pairs of nodes that blocks couple. Blocks overlap,
   but each pair is listed once, row by row, columns ascending. pair_ptr is NULL where there is no matrix. */
typedef struct {
  PetscInt n_nodes, *key, *dof, *pair_ptr, *pair;
} BlockPattern;

struct _n_BlockMatrix {
  MPI_Comm comm;
  int      size;            /* dofs of a node */
  PetscInt n_listed, *list; /* nodes of all lists, one list after another; start of each list */
  /* For every node of the lists: its key (-1: it has no free dof), and its number among the nodes of the matrix (-1: it
     is not among them). */
  PetscInt *list_key, *list_number;
  PetscInt *list_dof;           /* dofs of these nodes, size for each */
  PetscInt  n, room, *ptr, *of; /* named blocks: start of their nodes, and their lists */
  /* Nodes of the blocks, one block after another, as places in the block's list. They ascend by key; nodes without a
     key come last. */
  PetscInt   nodes_room, *node;
  NodeMatrix matrix;
  /* Where it is not NULL, it takes the place of matrix and its sums: blocks are kept as factors. */
  BlockFactors factors;
  /* Pattern that the blocks need, block after block: the number of nodes with keys, then these keys. A key is the
     node's first free global dof. */
  PetscInt     n_pattern, *pattern;
  BlockPattern own; /* nodes and pairs of the matrix */
  /* For each row: its first pair that is not below the diagonal, and the number of such pairs in the rows before it. */
  PetscInt *diagonal, *above;
  PetscInt *of_pair; /* sum of each pair; a pair below the diagonal has the sum of its mirror image */
  PetscInt *row_ptr; /* for each node, the start of its rows in row */
  BlockRow *row;
  /* seen: for each node of the matrix, the position in sum of its column in the last row that has it.
     at: numbers of the nodes of the block that is being added. */
  PetscInt        *seen, *at;
  SumRow          *sum;     /* [pairs not below the diagonal][size] */
  PetscReal       *whole;   /* [pairs][size*size]: of blocks that are not symmetric; NULL: there are none */
  PetscInt        *column;  /* of each node of the matrix: pair of its column in the last row of theirs that has it */
  PetscBool        uneven;  /* such a block was added */
  PetscInt        *coupled; /* room for the result of BlockMatrixGetCoupled() */
  PetscBool        transposed; /* the blocks are multiplied transposed */
  const PetscReal *along;      /* vector that blocks are multiplied by when they are added, or NULL */
  PetscReal       *product;
  PetscBool        restored; /* the matrix is not the one that its user knows */
  PetscBool        replaced; /* the pattern has changed since BlockMatrixMark(); marked holds the old one */
  BlockPattern     marked;
};

/*@
  BlockMatrixCreate - creates an empty block matrix.

  Collective

  Input Parameters:
+ comm - all ranks
- size - dofs of a node, 1 to 4; with 1, dofs are treated one by one

  Output Parameter:
. blocks - destroyed with BlockMatrixDestroy()

  Note:
  The dofs of a node are next to each other in every block. Blocks have an order of nodes of their own, see
  BlockMatrixSort().
@*/
PetscErrorCode BlockMatrixCreate(MPI_Comm comm, int size, BlockMatrix *blocks)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(blocks));
  (*blocks)->comm = comm;
  (*blocks)->size = size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there a matrix? */
static PetscBool HasMatrix(BlockMatrix blocks)
{
  return blocks->factors ? BlockFactorsGet(blocks->factors) != NULL : blocks->matrix != NULL;
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

/*@
  BlockMatrixDestroy - frees a block matrix and its matrix.

  Collective

  Input Parameter:
. blocks - may be NULL; set to NULL
@*/
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
  PetscCall(PetscFree((*blocks)->whole));
  PetscCall(PetscFree((*blocks)->column));
  PetscCall(PetscFree((*blocks)->coupled));
  PetscCall(NodeMatrixDestroy(&(*blocks)->matrix));
  PetscCall(BlockFactorsDestroy(&(*blocks)->factors));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixBegin - begins a new sum without blocks, over the nodes of new lists.

  Not collective

  Input Parameters:
+ blocks  - the block matrix
. n_lists - number of rank-local vectors, in contact one for each pair
. n       - number of nodes of each list
- dof     - global dofs of each list [n*size]; -1 for a dof that is left out with its row and column

  Note:
  The matrix that was assembled before and its pattern remain.
@*/
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

/*@
  BlockMatrixSort - brings nodes of a list into the order that they have in blocks.

  Not collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixBegin()
. list   - number of the list
. n      - number of nodes
- node   - places in the list, reordered

  Output Parameter:
. with - number of nodes that have dofs; these come first
@*/
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

/*@
  BlockMatrixName - announces a block over nodes of a list.

  Not collective

  Input Parameters:
+ blocks - the block matrix, before BlockMatrixPlace()
. list   - number of the list
. n      - number of nodes
. node   - places in the list, in any order
- whole  - PETSC_TRUE: BlockMatrixGetNodes() returns the nodes without dofs too

  Note:
  Blocks over some of these nodes need not be announced.
@*/
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

/*@
  BlockMatrixGetNodes - returns the nodes of a named block, in the order of BlockMatrixSort().

  Not collective

  Input Parameters:
+ blocks - the block matrix
- b      - number of the block, counted from 0 in the order of BlockMatrixName()

  Output Parameters:
+ n    - number of nodes
- node - places in the block's list, borrowed until the next BlockMatrixBegin()
@*/
void BlockMatrixGetNodes(BlockMatrix blocks, PetscInt b, PetscInt *n, const PetscInt **node)
{
  *n    = blocks->ptr[b + 1] - blocks->ptr[b];
  *node = &blocks->node[blocks->ptr[b]];
}

/* Lists the pattern that the named blocks need. */
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

/* Lists the nodes of all blocks, ascending, each once, and makes room for their dofs. */
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
  PetscCall(PetscSortRemoveDupsInt(&n, blocks->own.key)); /* nodes of several lists */
  blocks->own.n_nodes = n;
  PetscCall(PetscFree(blocks->own.dof));
  PetscCall(PetscMalloc1(n * blocks->size, &blocks->own.dof));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the number in the matrix of every node that a block has. known: all of them are among the matrix' nodes. With
   fresh, the matrix' nodes get their dofs from the lists. */
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

/* Lists the rows of all blocks by node; rows of one node keep the order of the blocks. number[n_pattern] returns the
   numbers in the matrix of the pattern's nodes. */
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
    for (PetscInt i = 0; i < blocks->pattern[at]; i++) /* moves ptr[r + 1] from the start of r's rows to their end */
      blocks->row[ptr[number[at + 1 + i] + 1]++] = (BlockRow){.at = at + 1, .node = i};
  blocks->row_ptr = ptr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the pairs on and above the diagonal that blocks couple, each once, row by row, in no order. ptr[n_nodes + 1]
   returns the start of each row; the caller frees pair. */
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

/* Lists the pairs of nodes that blocks couple, each once, row by row, columns ascending. Blocks overlap several times
   over, so this saves the parallel matrix most of the entries. Nothing is sorted: the rows that contain a node are
   found in ascending order. */
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
  for (PetscInt r = 0; r < n; r++) /* pairs below the diagonal */
    for (PetscInt k = upper_ptr[r]; k < upper_ptr[r + 1]; k++)
      if (upper[k] > r) pair[next[upper[k]]++] = r;
  for (PetscInt r = 0; r < n; r++) { /* diagonal and pairs above it */
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

/* Finds the diagonal of each row and the sum of each pair. A pair and its mirror image have one sum. */
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
  /* next: for each row, the pair below the diagonal whose mirror image comes next. The mirror images come in the order
     of rows. */
  PetscCall(PetscMalloc1(blocks->own.n_nodes, &next));
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

/* Counts how many of the matrix' pairs the blocks need; -1 if one of them is missing. */
static PetscErrorCode CountPairs(BlockMatrix blocks, const PetscInt *number, PetscInt *used)
{
  PetscInt *seen = blocks->seen, *met = blocks->at; /* met: the last row in which a column was needed */

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

/* Finds a place for every pair. With fresh, the pairs are listed anew. Without it, the present pairs are used if they
   contain all that are needed and are at most BLOCK_SLACK times as many; placed says whether. */
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

/* Creates a matrix of `rows` rows on this rank with the pairs that are listed. */
static PetscErrorCode BlockMatrixCreateMat(BlockMatrix blocks, PetscInt rows)
{
  const NodePairs pairs = {blocks->size, blocks->own.n_nodes, blocks->own.dof, blocks->own.pair_ptr, blocks->own.pair};

  PetscFunctionBeginUser;
  PetscCall(PetscFree(blocks->coupled));
  if (blocks->factors) {
    PetscCall(BlockFactorsPlace(blocks->factors, rows, blocks->own.n_nodes, blocks->own.dof));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscCall(NodeMatrixCreate(blocks->comm, rows, &pairs, &blocks->matrix));
  PetscCall(NodeMatrixJoin(blocks->matrix, NULL));
  PetscCall(PetscFree(blocks->sum));
  PetscCall(PetscFree(blocks->whole));
  PetscCall(PetscFree(blocks->column));
  PetscCall(PetscMalloc1(blocks->above[blocks->own.n_nodes] * blocks->size, &blocks->sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixKeepFactors - lets the matrix keep its blocks as factors from now on, so that it multiplies but has no
  entries.

  Collective

  Input Parameters:
+ blocks - the block matrix
- rows   - rows of the matrix on this rank, as for BlockMatrixPlace()

  Note:
  A matrix that there is becomes an empty one of the same pattern. BlockMatrixAddRows() is not possible any more.
@*/
PetscErrorCode BlockMatrixKeepFactors(BlockMatrix blocks, PetscInt rows)
{
  const PetscBool had = HasMatrix(blocks);

  PetscFunctionBeginUser;
  if (blocks->factors) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BlockFactorsCreate(blocks->comm, blocks->size, &blocks->factors));
  PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscCall(PetscFree(blocks->sum));
  if (!had) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BlockMatrixCreateMat(blocks, rows));
  blocks->restored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixKeepsFactors - says whether BlockMatrixKeepFactors() was called.

  Not collective

  Input Parameter:
. blocks - the block matrix
@*/
PetscBool BlockMatrixKeepsFactors(BlockMatrix blocks)
{
  return blocks->factors ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  BlockMatrixPlace - finds the places of all named blocks in the matrix and sets the sum to 0.

  Collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixName() for each block
- rows   - rows of the matrix on this rank

  Output Parameter:
. changed - PETSC_TRUE: the matrix is a new one; PETSC_FALSE: only its values change

  Note:
  The matrix is a parallel AIJ matrix over the global dofs and belongs to the block matrix. It is a new one if the last
  pattern did not contain some rank's blocks or was more than BLOCK_SLACK times as large as needed. A matrix that is
  kept has zeros where no block has an entry.
@*/
PetscErrorCode BlockMatrixPlace(BlockMatrix blocks, PetscInt rows, PetscBool *changed)
{
  PetscInt  n = 0, *pattern = NULL;
  PetscBool placed;
  int       all;

  PetscFunctionBeginUser;
  PetscCall(BlocksPattern(blocks, &n, &pattern));
  placed = (PetscBool)(HasMatrix(blocks) && n == blocks->n_pattern);
  if (placed && n) PetscCall(PetscArraycmp(pattern, blocks->pattern, n, &placed));
  PetscCall(PetscFree(blocks->pattern));
  blocks->pattern   = pattern;
  blocks->n_pattern = n;
  if (placed)
    PetscCall(BlockMatrixNumberNodes(blocks, PETSC_FALSE, &placed));
  else if (HasMatrix(blocks))
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
  if (blocks->factors)
    BlockFactorsClear(blocks->factors);
  else
    PetscCall(PetscArrayzero(blocks->sum, blocks->above[blocks->own.n_nodes] * blocks->size));
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) blocks->seen[r] = -1;
  blocks->uneven   = PETSC_FALSE;
  *changed         = all && !blocks->restored ? PETSC_FALSE : PETSC_TRUE;
  blocks->restored = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the places of the sums of row r. */
static inline void LookAlong(BlockMatrix blocks, PetscInt r)
{
  const PetscInt *pair = &blocks->own.pair[blocks->diagonal[r]], first = blocks->above[r],
                 n = blocks->above[r + 1] - first;

  for (PetscInt k = 0; k < n; k++) blocks->seen[pair[k]] = first + k;
}

/* Adds the upper triangle of a block to the sums. size and outer are constants in each call, so that the compiler
   unrolls the loop over a node's rows. */
static inline PetscErrorCode Sum(const int size, const PetscBool outer, BlockMatrix blocks, PetscInt n, PetscInt m,
                                 const PetscReal *value)
{
  const PetscInt *at = blocks->at, *seen = blocks->seen;
  SumRow *const   sums =
    blocks->sum; /* SumRow may alias anything: the compiler would read blocks->sum again after every sum */

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

/* y += v v^T x. */
static void MultiplyOuter(PetscInt m, const PetscReal *v, const PetscReal *x, PetscReal *y)
{
  PetscReal along = 0;

  for (PetscInt i = 0; i < m; i++) along += v[i] * x[i];
  for (PetscInt i = 0; i < m; i++) y[i] += along * v[i];
}

/* product += block * along. Most blocks have only zeros in along, because most are far from everything that moves;
   these are skipped. Of `outer` v v^T the factor J is v. */
static PetscErrorCode BlockMatrixMultiplyRows(BlockMatrix blocks, PetscInt n, const PetscInt *node, PetscBool outer,
                                              const BlockFactor *block)
{
  const int      size = blocks->size;
  const PetscInt room = LanesGroups((int)(n * size)) * LANES;
  PetscBool      any  = PETSC_FALSE;
  PetscReal     *x, *y;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) any = (PetscBool)(any || blocks->along[node[i] * size + d] != 0);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(room, &x, room, &y));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) x[i * size + d] = blocks->along[node[i] * size + d];
  if (outer)
    MultiplyOuter(n * size, block->J, x, y);
  else
    BlockFactorMultiply(n * size, block, x, y);
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < size; d++) blocks->product[node[i] * size + d] += y[i * size + d];
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers those nodes of a block that have dofs, which come first, among the nodes of the matrix. */
static PetscErrorCode NumberBlock(BlockMatrix blocks, int list, PetscInt n, const PetscInt *node, PetscInt *with)
{
  const PetscInt *number = &blocks->list_number[blocks->list[list]];

  PetscFunctionBeginUser;
  for (*with = 0; *with < n && number[node[*with]] >= 0; (*with)++) blocks->at[*with] = number[node[*with]];
  PetscCheck(*with == n || blocks->list_key[blocks->list[list] + node[*with]] < 0, PETSC_COMM_SELF,
             PETSC_ERR_ARG_OUTOFRANGE, "a node is in no named block");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(BlockMatrix blocks, int list, PetscInt n, const PetscInt *node, PetscBool outer,
                          const PetscReal *value)
{
  const PetscInt    m     = n * blocks->size;
  const BlockFactor block = {.depth = 1, .stride = m, .factor = 0.5, .K = outer ? value : NULL, .J = value};
  PetscInt          with;

  PetscFunctionBeginUser;
  PetscCall(NumberBlock(blocks, list, n, node, &with));
  if (blocks->factors)
    PetscCall(BlockFactorsAdd(blocks->factors, with, blocks->at, &block));
  else if (blocks->size == 3 && outer)
    PetscCall(Sum(3, PETSC_TRUE, blocks, with, m, value));
  else if (blocks->size == 3)
    PetscCall(Sum(3, PETSC_FALSE, blocks, with, m, value));
  else
    PetscCall(Sum(blocks->size, outer, blocks, with, m, value));
  if (blocks->along) PetscCall(BlockMatrixMultiplyRows(blocks, n, node, outer, &block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixAdd - adds a block to the sum.

  Not collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixPlace()
. list   - number of the list
. n      - number of nodes
. node   - places in the list, in the order of BlockMatrixSort(); each pair of them belongs to some named block
- value  - [(n*size)^2 + BLOCK_PADDING], symmetric, row-major (force per length); only the upper triangle is used

  Note:
  The values are added at once and not kept. Fails if a pair belongs to no named block.
@*/
PetscErrorCode BlockMatrixAdd(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[], const PetscReal value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(blocks, list, n, node, PETSC_FALSE, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixAddOuter - adds a block v v^T to the sum, without forming it.

  Not collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixPlace()
. list   - number of the list
. n      - number of nodes
. node   - as for BlockMatrixAdd()
- value  - the vector v [n*size + BLOCK_PADDING]
@*/
PetscErrorCode BlockMatrixAddOuter(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[],
                                   const PetscReal value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(blocks, list, n, node, PETSC_TRUE, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixAddFactors - adds a block K^T J + J^T K to a sum that keeps factors, without forming it.

  Not collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixKeepFactors() and BlockMatrixPlace()
. list   - number of the list
. n      - number of nodes
. node   - as for BlockMatrixAdd()
. depth  - rows of K and J
. stride - length of a row of K and J, of which n*size numbers are used; what follows them, up to a whole number of
           LANES, is finite
. K      - first factor, K[depth][stride]
- J      - second factor, J[depth][stride]

  Note:
  The factors are copied.
@*/
PetscErrorCode BlockMatrixAddFactors(BlockMatrix blocks, int list, PetscInt n, const PetscInt node[], PetscInt depth,
                                     PetscInt stride, const PetscReal K[], const PetscReal J[])
{
  const BlockFactor block = {depth, stride, 1, K, J};
  PetscInt          with;

  PetscFunctionBeginUser;
  PetscCheck(blocks->factors, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the blocks are not kept as factors");
  PetscCall(NumberBlock(blocks, list, n, node, &with));
  PetscCall(BlockFactorsAdd(blocks->factors, with, blocks->at, &block));
  if (blocks->along) PetscCall(BlockMatrixMultiplyRows(blocks, n, node, PETSC_FALSE, &block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* product += rows * along, the rows of a block that is not symmetric, or their transposed times along. */
static void MultiplyRows(BlockMatrix blocks, PetscInt n_rows, const PetscInt *row, PetscInt n, const PetscInt *node,
                         const PetscReal *value)
{
  const int size = blocks->size;

  for (PetscInt i = 0; i < n_rows * size; i++) {
    const PetscInt at  = row[i / size] * size + i % size;
    PetscReal      sum = 0;

    for (PetscInt j = 0; j < n * size; j++) {
      const PetscInt column = node[j / size] * size + j % size;

      if (blocks->transposed)
        blocks->product[column] += value[i * n * size + j] * blocks->along[at];
      else
        sum += value[i * n * size + j] * blocks->along[column];
    }
    blocks->product[at] += sum;
  }
}

/* The sums of all pairs for blocks that are not symmetric, 0 before the first of them. */
static PetscErrorCode TakeUneven(BlockMatrix blocks)
{
  const PetscInt n = blocks->own.pair_ptr[blocks->own.n_nodes] * blocks->size * blocks->size;

  PetscFunctionBeginUser;
  if (!blocks->whole) {
    PetscCall(PetscMalloc1(n, &blocks->whole));
    PetscCall(PetscMalloc1(blocks->own.n_nodes, &blocks->column));
  }
  if (!blocks->uneven) PetscCall(PetscArrayzero(blocks->whole, n));
  for (PetscInt r = 0; r < blocks->own.n_nodes && !blocks->uneven; r++) blocks->column[r] = -1;
  blocks->uneven = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the rows of node r, which is in the matrix, to the sums of its pairs. size is a constant in each call, so that
   the compiler unrolls the loops over dofs. */
static inline PetscErrorCode SumRows(const int size, BlockMatrix blocks, PetscInt r, const PetscInt *number, PetscInt n,
                                     const PetscInt *node, const PetscReal *value)
{
  const PetscInt *column = blocks->column, first = blocks->own.pair_ptr[r], end = blocks->own.pair_ptr[r + 1];

  PetscFunctionBeginUser;
  for (PetscInt k = first; k < end; k++) blocks->column[blocks->own.pair[k]] = k;
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt   c = number[node[j]], k = c < 0 ? -1 : column[c];
    const PetscReal *from = &value[j * size];
    PetscReal       *to;

    if (c < 0) continue;
    PetscCheck(k >= first && k < end, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "a block couples nodes that no named one does");
    to = &blocks->whole[k * size * size];
    for (int d = 0; d < size; d++)
      for (int e = 0; e < size; e++) to[d * size + e] += from[d * n * size + e];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixAddRows - adds some rows of a block that is not symmetric to the sum.

  Not collective

  Input Parameters:
+ blocks - the block matrix, after BlockMatrixPlace()
. list   - number of the list
. n_rows - number of nodes whose rows are added
. row    - these nodes, places in the list
. n      - number of nodes of the columns
. node   - these nodes, in any order; each pair of a row and a column belongs to some named block
- value  - [n_rows*size][n*size], row-major (force per length)

  Note:
  The values are added at once and not kept. Fails if a pair belongs to no named block.
@*/
PetscErrorCode BlockMatrixAddRows(BlockMatrix blocks, int list, PetscInt n_rows, const PetscInt row[], PetscInt n,
                                  const PetscInt node[], const PetscReal value[])
{
  const PetscInt *number = &blocks->list_number[blocks->list[list]];
  const int       size   = blocks->size;

  PetscFunctionBeginUser;
  PetscCheck(!blocks->factors, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "blocks that are factors are symmetric");
  PetscCall(TakeUneven(blocks));
  for (PetscInt i = 0; i < n_rows; i++) {
    const PetscInt   r    = number[row[i]];
    const PetscReal *from = &value[i * size * n * size];

    if (r >= 0 && size == 3) PetscCall(SumRows(3, blocks, r, number, n, node, from));
    if (r >= 0 && size != 3) PetscCall(SumRows(size, blocks, r, number, n, node, from));
  }
  if (blocks->along) MultiplyRows(blocks, n_rows, row, n, node, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixMultiply - sets vectors with which blocks are multiplied when they are added: y += block * x.

  Not collective

  Input Parameters:
+ blocks     - the block matrix
. transposed - y += block^T * x
. x          - over the nodes of the blocks' list, borrowed; NULL ends the multiplication
- y          - over the same nodes, borrowed; added to

  Note:
  Entries without a global dof are included. BlockMatrixBegin() ends the multiplication too.
@*/
void BlockMatrixMultiply(BlockMatrix blocks, PetscBool transposed, const PetscReal *x, PetscReal *y)
{
  blocks->transposed = transposed;
  blocks->along      = x;
  blocks->product    = y;
}

/* Fills the lower triangle of the sums on the diagonal. Blocks only add to the upper one. */
static void FillDiagonal(BlockMatrix blocks)
{
  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    SumRow *sum = &blocks->sum[blocks->above[r] * blocks->size];

    for (int d = 0; d < blocks->size; d++)
      for (int e = 0; e < d; e++) sum[d][e] = sum[e][d];
  }
}

/* Adds the symmetric blocks to the sums of all pairs. size as in SumRows(). */
static inline void AddSymmetric(const int size, BlockMatrix blocks)
{
  const PetscInt *ptr = blocks->own.pair_ptr, *of_pair = blocks->of_pair;
  const SumRow   *sums = blocks->sum; /* SumRow may alias anything, as in Sum() */
  PetscReal      *to   = blocks->whole;

  for (PetscInt r = 0; r < blocks->own.n_nodes; r++) {
    for (PetscInt k = ptr[r], diagonal = blocks->diagonal[r]; k < ptr[r + 1]; k++, to += size * size) {
      const SumRow *sum = &sums[of_pair[k] * size];

      for (int d = 0; d < size; d++)
        for (int e = 0; e < size; e++) to[d * size + e] += k < diagonal ? sum[e][d] : sum[d][e];
    }
  }
}

/*@
  BlockMatrixEnd - assembles the sum of all ranks' blocks.

  Collective

  Input Parameter:
. blocks - the block matrix

  Output Parameter:
. matrix - parallel AIJ matrix that belongs to the block matrix; where factors are kept, a shell matrix that multiplies
@*/
PetscErrorCode BlockMatrixEnd(BlockMatrix blocks, Mat *matrix)
{
  const NodeUpper values = {(const PetscReal *)blocks->sum, ROW, blocks->of_pair, blocks->diagonal};

  PetscFunctionBeginUser;
  if (blocks->factors) {
    *matrix = BlockFactorsGet(blocks->factors);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  FillDiagonal(blocks);
  if (blocks->uneven) {
    if (blocks->size == 3)
      AddSymmetric(3, blocks);
    else
      AddSymmetric(blocks->size, blocks);
    PetscCall(NodeMatrixSet(blocks->matrix, blocks->whole, NULL, NULL));
  } else
    PetscCall(NodeMatrixSetUpper(blocks->matrix, &values));
  *matrix = NodeMatrixGet(blocks->matrix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixGetCoupled - returns the dofs that the pattern couples with a node.

  Not collective

  Input Parameters:
+ blocks - the block matrix
- dof    - the node's first free dof; -1 if it has none

  Output Parameters:
+ n       - number of dofs; 0 if the pattern does not contain the node
- coupled - global dofs, ascending, borrowed until the next call for this block matrix
@*/
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

/* Creates the matrix of a pattern that has been restored. To its user it is a new matrix. */
static PetscErrorCode RestoreMatrix(BlockMatrix blocks, PetscInt rows)
{
  PetscFunctionBeginUser;
  PetscCall(ListSums(blocks));
  blocks->n_pattern = -1; /* belongs to no blocks yet; BlockMatrixPlace() finds the next ones in it */
  PetscCall(BlockMatrixCreateMat(blocks, rows));
  blocks->restored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixMark - marks the present pattern as the one that BlockMatrixReturn() restores.

  Not collective

  Input Parameter:
. blocks - the block matrix
@*/
PetscErrorCode BlockMatrixMark(BlockMatrix blocks)
{
  PetscFunctionBeginUser;
  PetscCall(DestroyPattern(&blocks->marked));
  blocks->replaced = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixReturn - restores the pattern of the last BlockMatrixMark().

  Collective

  Input Parameters:
+ blocks - the block matrix
- rows   - rows of the matrix on this rank, as for BlockMatrixPlace()

  Note:
  What is assembled afterwards does not depend on what was assembled since the mark. If the pattern was another one, the
  matrix of BlockMatrixEnd() is destroyed.
@*/
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
  else if (blocks->factors)
    PetscCall(BlockFactorsReset(blocks->factors));
  else
    PetscCall(NodeMatrixDestroy(&blocks->matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BlockMatrixArchive - saves or loads the pattern of the last assembled matrix.

  Collective

  Input Parameters:
+ blocks  - the block matrix
. archive - archive that saves or loads
. name    - place of the pattern in the archive
- rows    - rows of the matrix on this rank, as for BlockMatrixPlace()

  Note:
  A pattern that is kept depends on what was assembled before, and another pattern orders the solver's sums in another
  way. With the pattern, runs on one rank repeat to the last bit. On several ranks the function does nothing, because
  dofs are numbered by rank; the pattern is found anew. So it is where the unknowns change.
@*/
PetscErrorCode BlockMatrixArchive(BlockMatrix blocks, Archive archive, const char *name, PetscInt rows)
{
  static const char *names[] = {"key", "dof", "pair_ptr", "pair"};
  PetscInt         **list[]  = {&blocks->own.key, &blocks->own.dof, &blocks->own.pair_ptr, &blocks->own.pair};
  PetscInt           n[4]    = {0, 0, 0, 0};
  PetscMPIInt        size;
  PetscBool          there = HasMatrix(blocks);
  char               path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (ArchiveRenumbers(archive)) PetscFunctionReturn(PETSC_SUCCESS);
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
