/* Node matrix: the pattern of the sum, the places of pairs and of other matrices' entries in it, and its values. */
#include "matrix/nodematrix.h"
#include "matrix/matrixrows.h"

/* Memory that is allocated for entries, as a multiple of what a pattern needs, so that the next pattern fits too. New
   memory costs more than writing the entries. Memory that is not needed yet is not touched. */
#define NODE_MATRIX_ROOM 1.25
/* Place of a dof that is left out. */
#define NODE_MATRIX_NONE PETSC_MIN_INT
/* Under this name the matrix has its node matrix with it. */
#define NODE_MATRIX_NAME "NodeMatrix"
/* Matrices that the pattern is joined with: TERM_FOREIGN has the blocks of other ranks, TERM_OTHER is the argument of
   NodeMatrixJoin(). */
enum { TERM_FOREIGN, TERM_OTHER, TERMS };

/* Arrays of one block of the matrix: columns of the rank itself, or of others. alone is the number of entries that the
   pairs need without other terms. */
typedef struct {
  PetscInt    *ptr, *column, room, alone;
  PetscScalar *value;
} NodeBlock;

/* Columns of one row in one block while they are gathered, ascending, and room for merging. */
typedef struct {
  PetscInt *column, *room, n;
} NodeRow;

/* A matrix that the pattern was joined with, by PETSc's object id. place: for each of its entries in the first row of a
   node, the place in that row of the sum. The other rows of the node have the same places. */
typedef struct {
  PetscObjectId matrix;
  PetscInt      n[MATRIX_BLOCKS], room[MATRIX_BLOCKS], *place[MATRIX_BLOCKS];
} NodeTerm;

/* Values of the pairs: all blocks, in the order of the pairs, or, if upper is not NULL, the blocks of a symmetric
   matrix. */
typedef struct {
  const PetscReal *all;
  const NodeUpper *upper;
} NodeValues;

/* One row of a block: its first value and the distance to the next. */
typedef struct {
  const PetscReal *value;
  PetscInt         step;
} ValueRow;

struct _n_NodeMatrix {
  MPI_Comm   comm;
  NodePairs  pairs;
  PetscInt   rows, first; /* of this rank */
  PetscInt  *node;        /* for each row, its node; -1: this rank has no pairs for it */
  PetscBool *inner;       /* for each node: all columns of its pairs belong to this rank and ascend */
  PetscBool *placed;      /* for each node: the places of its pairs are those of a row without other terms */
  PetscInt   longest;     /* entries of the longest row without other terms */
  PetscInt   left_out;    /* dofs without a row, of nodes that have one */
  /* For each pair and each dof of its column, the place in the row: k in the rank's own block, -1 - k in the block of
     others. */
  PetscInt *place;
  NodeBlock block[MATRIX_BLOCKS];
  NodeTerm  term[TERMS];
  PetscInt *diagonal; /* for each row, the place of its diagonal in the rank's own block; -1: it has none */
  /* foreign: sum of what ranks have for rows of other ranks; NULL on one rank. */
  Mat            matrix, foreign;
  PetscContainer container; /* of this object */
  PetscInt       n_foreign, *foreign_node, foreign_pairs;
  PetscScalar   *foreign_value;
};

static PetscBool IsMine(NodeMatrix m, PetscInt dof)
{
  return (PetscBool)(dof >= m->first && dof < m->first + m->rows);
}

static inline PetscBool IsSymmetric(const NodeValues *values)
{
  return values->upper ? PETSC_TRUE : PETSC_FALSE;
}

/* Returns row d of pair k of a node. size and symmetric are constants where the compiler is to unroll loops. */
static inline ValueRow FindValues(const int size, const PetscBool symmetric, const NodeValues *values, PetscInt node,
                                  PetscInt k, int d)
{
  const NodeUpper *upper = values->upper;
  const PetscReal *block;

  if (!symmetric) return (ValueRow){&values->all[((size_t)k * size + d) * size], 1};
  block = &upper->value[(size_t)upper->block[k] * size * upper->width];
  return k < upper->diagonal[node] ? (ValueRow){&block[d], upper->width} : (ValueRow){&block[d * upper->width], 1};
}

/* Rows of other ranks */

/* Creates the matrix for rows of other ranks in PETSc's COO format, which ignores negative dofs. */
static PetscErrorCode CreateForeign(NodeMatrix m)
{
  const NodePairs *p    = &m->pairs;
  const PetscInt   size = p->size;
  PetscInt         n    = 0, *i, *j;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->foreign_pairs * size * size, &i, m->foreign_pairs * size * size, &j));
  PetscCall(PetscMalloc1(m->foreign_pairs * size * size, &m->foreign_value));
  for (PetscInt f = 0; f < m->n_foreign; f++) {
    const PetscInt node = m->foreign_node[f];

    for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
      for (PetscInt e = 0; e < size * size; e++, n++) {
        i[n] = p->dof[node * size + e / size];
        j[n] = p->dof[p->column[k] * size + e % size];
      }
    }
  }
  PetscCall(MatCreate(m->comm, &m->foreign));
  PetscCall(MatSetSizes(m->foreign, m->rows, m->rows, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(m->foreign, MATAIJ));
  PetscCall(MatSetPreallocationCOO(m->foreign, n, i, j));
  PetscCall(PetscFree2(i, j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetForeign(NodeMatrix m, const NodeValues *values)
{
  const NodePairs *p = &m->pairs;
  PetscInt         n = 0;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m->n_foreign; f++) {
    const PetscInt node = m->foreign_node[f];

    for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
      for (int d = 0; d < p->size; d++) {
        const ValueRow row = FindValues(p->size, IsSymmetric(values), values, node, k, d);

        for (int c = 0; c < p->size; c++) m->foreign_value[n++] = row.value[c * row.step];
      }
    }
  }
  PetscCall(MatSetValuesCOO(m->foreign, m->foreign_value, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pattern of the matrix */

/* Finds the node of every row of this rank and lists the nodes with rows of other ranks. */
static PetscErrorCode NodeMatrixFindNodes(NodeMatrix m)
{
  const NodePairs *p = &m->pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->rows, &m->node, p->n, &m->foreign_node));
  for (PetscInt r = 0; r < m->rows; r++) m->node[r] = -1;
  for (PetscInt node = 0; node < p->n; node++) {
    PetscBool foreign = PETSC_FALSE;

    for (int d = 0; d < p->size; d++) {
      const PetscInt dof = p->dof[node * p->size + d];

      if (IsMine(m, dof))
        m->node[dof - m->first] = node;
      else
        foreign = (PetscBool)(foreign || dof >= 0);
    }
    if (!foreign) continue;
    m->foreign_node[m->n_foreign++] = node;
    m->foreign_pairs += p->ptr[node + 1] - p->ptr[node];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the columns of a node's pairs that belong to this rank and to others. Returns whether all belong to this rank
   and ascend. */
static PetscBool LookAtNode(NodeMatrix m, PetscInt node, PetscInt count[MATRIX_BLOCKS])
{
  const NodePairs *p      = &m->pairs;
  PetscInt         last   = -1;
  PetscBool        rising = PETSC_TRUE;

  count[MATRIX_OWN] = count[MATRIX_OTHERS] = 0;
  for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
    for (int c = 0; c < p->size; c++) {
      const PetscInt dof = p->dof[p->column[k] * p->size + c];

      if (dof < 0) continue;
      count[IsMine(m, dof) ? MATRIX_OWN : MATRIX_OTHERS]++;
      rising = (PetscBool)(rising && dof > last);
      last   = dof;
    }
  }
  return (PetscBool)(rising && !count[MATRIX_OTHERS]);
}

/* Counts the entries that the rows of this rank need for its pairs alone, without other terms. */
static void LookAtRows(NodeMatrix m)
{
  PetscInt count[MATRIX_BLOCKS] = {0, 0};

  for (PetscInt r = 0; r < m->rows; r++) {
    const PetscInt node = m->node[r];

    if (node < 0) continue;
    if (!r || node != m->node[r - 1]) m->inner[node] = LookAtNode(m, node, count);
    for (int d = 0; d < m->pairs.size && (!r || node != m->node[r - 1]); d++)
      m->left_out += m->pairs.dof[node * m->pairs.size + d] < 0;
    for (int b = 0; b < MATRIX_BLOCKS; b++) m->block[b].alone += count[b];
    m->longest = PetscMax(m->longest, count[MATRIX_OWN] + count[MATRIX_OTHERS]);
  }
}

/*@
  NodeMatrixCreate - prepares a node matrix; NodeMatrixJoin() creates the matrix itself.

  Collective

  Input Parameters:
+ comm  - all ranks
. rows  - rows on this rank
- pairs - pairs of this rank; the arrays are borrowed

  Output Parameter:
. out - destroyed with NodeMatrixDestroy()
@*/
PetscErrorCode NodeMatrixCreate(MPI_Comm comm, PetscInt rows, const NodePairs *pairs, NodeMatrix *out)
{
  NodeMatrix  m;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  m->comm  = comm;
  m->pairs = *pairs;
  m->rows  = rows;
  PetscCallMPI(MPI_Scan(&rows, &m->first, 1, MPIU_INT, MPI_SUM, comm));
  m->first -= rows;
  PetscCall(NodeMatrixFindNodes(m));
  PetscCall(PetscCalloc2(pairs->n, &m->inner, pairs->n, &m->placed));
  LookAtRows(m);
  PetscCall(PetscMalloc2(pairs->ptr[pairs->n] * pairs->size, &m->place, rows, &m->diagonal));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size > 1) PetscCall(CreateForeign(m));
  PetscCall(PetscContainerCreate(comm, &m->container));
  PetscCall(PetscContainerSetPointer(m->container, m));
  *out = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeMatrixDestroy - frees a node matrix and its matrix.

  Collective

  Input Parameter:
. matrix - may be NULL; set to NULL
@*/
PetscErrorCode NodeMatrixDestroy(NodeMatrix *matrix)
{
  NodeMatrix m = *matrix;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&m->matrix));
  PetscCall(MatDestroy(&m->foreign));
  PetscCall(PetscContainerDestroy(&m->container));
  for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(PetscFree(m->block[b].ptr));
  for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(PetscFree2(m->block[b].column, m->block[b].value));
  for (int t = 0; t < TERMS; t++)
    for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(PetscFree(m->term[t].place[b]));
  PetscCall(PetscFree2(m->node, m->foreign_node));
  PetscCall(PetscFree2(m->inner, m->placed));
  PetscCall(PetscFree(m->foreign_value));
  PetscCall(PetscFree2(m->place, m->diagonal));
  PetscCall(PetscFree(*matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates the pattern. longest returns the number of columns that one row may have while it is gathered. */
static PetscErrorCode TakeRoom(NodeMatrix m, MatrixRows terms[TERMS][MATRIX_BLOCKS], PetscInt *longest)
{
  PetscInt need[MATRIX_BLOCKS] = {m->block[MATRIX_OWN].alone + m->left_out, m->block[MATRIX_OTHERS].alone}, most = 0;

  PetscFunctionBeginUser;
  for (int t = 0; t < TERMS; t++) {
    for (int b = 0; b < MATRIX_BLOCKS; b++) {
      const MatrixRows *term = &terms[t][b];

      for (PetscInt r = 0; term->mat && r < m->rows; r++) most = PetscMax(most, term->ptr[r + 1] - term->ptr[r]);
      need[b] += term->mat ? term->ptr[m->rows] : 0;
    }
  }
  *longest = m->longest + TERMS * MATRIX_BLOCKS * most;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    NodeBlock *block = &m->block[b];

    if (!block->ptr) PetscCall(PetscMalloc1(m->rows + 1, &block->ptr));
    if (need[b] <= block->room && block->column) continue;
    block->room = 1 + (PetscInt)(NODE_MATRIX_ROOM * need[b]); /* one more, because an allocation of 0 gives no array */
    PetscCall(PetscFree2(block->column, block->value));
    PetscCall(PetscMalloc2(block->room, &block->column, block->room, &block->value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers the columns of a row's pairs in one block, ascending; each occurs once. */
static PetscErrorCode GatherPairs(NodeMatrix m, PetscInt node, int block, NodeRow *row)
{
  const NodePairs *p     = &m->pairs;
  const PetscInt   first = block == MATRIX_OWN ? m->first : 0, size = p->size;
  PetscBool        rising = PETSC_TRUE;

  PetscFunctionBeginUser;
  row->n = 0;
  if (node < 0 || (block == MATRIX_OTHERS && m->inner[node])) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
    for (PetscInt c = 0; c < size; c++) {
      const PetscInt dof = p->dof[p->column[k] * size + c];

      if (dof < 0 || IsMine(m, dof) != (block == MATRIX_OWN)) continue;
      rising                = (PetscBool)(rising && (!row->n || dof - first > row->column[row->n - 1]));
      row->column[row->n++] = dof - first;
    }
  }
  if (!rising) PetscCall(PetscSortInt(row->n, row->column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Merges the columns of a term's row into the gathered columns; both ascend. */
static void MergeRow(const MatrixRows *term, PetscInt r, NodeRow *row)
{
  const PetscInt end = term->ptr[r + 1];
  PetscInt      *to = row->room, n = 0, i = 0, k = term->ptr[r];

  while (i < row->n && k < end) {
    const PetscInt a = row->column[i], b = MatrixRowsColumn(term, 0, k);

    to[n++] = PetscMin(a, b);
    i += a <= b;
    k += b <= a;
  }
  while (i < row->n) to[n++] = row->column[i++];
  while (k < end) to[n++] = MatrixRowsColumn(term, 0, k++);
  row->room   = row->column;
  row->column = to;
  row->n      = n;
}

/* Stores the places of a node's pairs in its row r. at: place in that row of each column of this rank. */
static PetscErrorCode PlacePairs(NodeMatrix m, PetscInt node, PetscInt r, const PetscInt *at)
{
  const NodePairs *p      = &m->pairs;
  const NodeBlock *others = &m->block[MATRIX_OTHERS];
  const PetscInt  *column = &others->column[others->ptr[r]], n = others->ptr[r + 1] - others->ptr[r];

  PetscFunctionBeginUser;
  for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
    for (int c = 0; c < p->size; c++) {
      const PetscInt dof   = p->dof[p->column[k] * p->size + c];
      PetscInt      *place = &m->place[k * p->size + c];

      if (dof < 0)
        *place = NODE_MATRIX_NONE;
      else if (IsMine(m, dof))
        *place = at[dof - m->first];
      else {
        PetscCall(PetscFindInt(dof, n, column, place));
        *place = -1 - *place;
      }
    }
  }
  m->placed[node] = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores the places of the entries of a term's row in row r of the matrix. at: as for PlacePairs(). */
static void PlaceTerm(NodeMatrix m, PetscInt r, int t, MatrixRows term[MATRIX_BLOCKS], const PetscInt *at)
{
  const MatrixRows *own = &term[MATRIX_OWN], *others = &term[MATRIX_OTHERS];
  const PetscInt   *column = &m->block[MATRIX_OTHERS].column[m->block[MATRIX_OTHERS].ptr[r]];
  PetscInt          next   = 0;

  for (PetscInt k = own->ptr[r]; k < own->ptr[r + 1]; k++) m->term[t].place[MATRIX_OWN][k] = at[own->column[k]];
  for (PetscInt k = others->mat ? others->ptr[r] : 0; others->mat && k < others->ptr[r + 1]; k++) {
    while (column[next] < MatrixRowsColumn(others, 0, k)) next++;
    m->term[t].place[MATRIX_OTHERS][k] = next;
  }
}

/* Appends a row of any kind. Columns have the numbering that PETSc requires: the rank's own columns start at 0.
   at[rows] is work space. */
static PetscErrorCode AppendRow(NodeMatrix m, PetscInt r, MatrixRows terms[TERMS][MATRIX_BLOCKS], NodeRow *row,
                                PetscInt *at)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    NodeBlock *block = &m->block[b];

    PetscCall(GatherPairs(m, m->node[r], b, row));
    for (int t = 0; t < TERMS; t++)
      if (terms[t][b].mat) MergeRow(&terms[t][b], r, row);
    PetscCall(PetscArraycpy(&block->column[block->ptr[r]], row->column, row->n));
    block->ptr[r + 1] = block->ptr[r] + row->n;
    for (PetscInt k = 0; b == MATRIX_OWN && k < row->n; k++) at[row->column[k]] = k;
  }
  for (int t = 0; t < TERMS; t++)
    if (terms[t][MATRIX_OWN].mat) PlaceTerm(m, r, t, terms[t], at);
  if (m->node[r] >= 0) PetscCall(PlacePairs(m, m->node[r], r, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends a row of an inner node in which no term has entries. Most rows of a large matrix are such rows. Nothing is
   sorted or searched. */
static void AppendInner(NodeMatrix m, PetscInt r)
{
  const NodePairs *p   = &m->pairs;
  NodeBlock       *own = &m->block[MATRIX_OWN], *others = &m->block[MATRIX_OTHERS];
  const PetscInt   node   = m->node[r];
  PetscInt        *column = &own->column[own->ptr[r]], n = 0;

  for (PetscInt k = p->ptr[node]; k < p->ptr[node + 1]; k++) {
    const PetscInt *dof = &p->dof[p->column[k] * p->size];

    for (int c = 0; c < p->size; c++) {
      if (!m->placed[node]) m->place[k * p->size + c] = dof[c] < 0 ? NODE_MATRIX_NONE : n;
      if (dof[c] >= 0) column[n++] = dof[c] - m->first;
    }
  }
  m->placed[node]    = PETSC_TRUE;
  own->ptr[r + 1]    = own->ptr[r] + n;
  others->ptr[r + 1] = others->ptr[r];
}

/* Appends a row with the columns of the row before it, which belongs to the same node. */
static PetscErrorCode AppendSame(NodeMatrix m, PetscInt r)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    NodeBlock     *block = &m->block[b];
    const PetscInt from = block->ptr[r - 1], to = block->ptr[r];

    PetscCall(PetscArraycpy(&block->column[to], &block->column[from], to - from));
    block->ptr[r + 1] = to + to - from;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends a row without entries. */
static void AppendNone(NodeMatrix m, PetscInt r)
{
  for (int b = 0; b < MATRIX_BLOCKS; b++) m->block[b].ptr[r + 1] = m->block[b].ptr[r];
}

/* Whether some term has entries in this row. */
static PetscBool IsShared(PetscInt r, MatrixRows terms[TERMS][MATRIX_BLOCKS])
{
  for (int t = 0; t < TERMS; t++)
    for (int b = 0; b < MATRIX_BLOCKS; b++)
      if (terms[t][b].mat && terms[t][b].ptr[r + 1] > terms[t][b].ptr[r]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Gets the rows of the terms; a term that is NULL has none. */
static PetscErrorCode NodeMatrixGetTerms(const Mat mats[TERMS], MatrixRows terms[TERMS][MATRIX_BLOCKS])
{
  PetscFunctionBeginUser;
  for (int t = 0; t < TERMS; t++) {
    for (int b = 0; b < MATRIX_BLOCKS; b++) {
      terms[t][b] = (MatrixRows){.mat = NULL};
      if (mats[t]) PetscCall(MatrixRowsGet(mats[t], b, &terms[t][b]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestoreTerms(MatrixRows terms[TERMS][MATRIX_BLOCKS])
{
  PetscFunctionBeginUser;
  for (int t = 0; t < TERMS; t++)
    for (int b = 0; b < MATRIX_BLOCKS; b++) PetscCall(MatrixRowsRestore(&terms[t][b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates the places of a term's entries. */
static PetscErrorCode TakeTerm(Mat mat, const MatrixRows rows[MATRIX_BLOCKS], NodeTerm *term)
{
  PetscFunctionBeginUser;
  term->matrix = 0;
  if (mat) PetscCall(PetscObjectGetId((PetscObject)mat, &term->matrix));
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    term->n[b] = rows[b].mat ? rows[b].ptr[rows[b].n] : 0;
    if (term->n[b] <= term->room[b]) continue;
    term->room[b] = (PetscInt)(NODE_MATRIX_ROOM * term->n[b]);
    PetscCall(PetscFree(term->place[b]));
    PetscCall(PetscMalloc1(term->room[b], &term->place[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether this row belongs to the same node as the row before it. */
static inline PetscBool IsSame(NodeMatrix m, PetscInt r)
{
  return (PetscBool)(r && m->node[r] >= 0 && m->node[r] == m->node[r - 1]);
}

/* Finds the place of the diagonal in row r of the pattern. */
static PetscErrorCode FindDiagonal(NodeMatrix m, PetscInt r)
{
  const NodeBlock *own = &m->block[MATRIX_OWN];

  PetscFunctionBeginUser;
  if (IsSame(m, r) && m->diagonal[r - 1] >= 0)
    m->diagonal[r] = m->diagonal[r - 1] + 1; /* both dofs are columns of both rows */
  else
    PetscCall(PetscFindInt(r, own->ptr[r + 1] - own->ptr[r], &own->column[own->ptr[r]], &m->diagonal[r]));
  m->diagonal[r] = PetscMax(m->diagonal[r], -1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the matrix from the arrays and keeps the handle that users know. */
static PetscErrorCode MakeMatrix(NodeMatrix m)
{
  NodeBlock *own = &m->block[MATRIX_OWN], *others = &m->block[MATRIX_OTHERS];
  Mat        made;

  PetscFunctionBeginUser;
  if (m->foreign)
    PetscCall(MatCreateMPIAIJWithSplitArrays(m->comm, m->rows, m->rows, PETSC_DETERMINE, PETSC_DETERMINE, own->ptr,
                                             own->column, own->value, others->ptr, others->column, others->value,
                                             &made));
  else
    PetscCall(MatCreateSeqAIJWithArrays(m->comm, m->rows, m->rows, own->ptr, own->column, own->value, &made));
  if (m->matrix)
    PetscCall(MatHeaderReplace(m->matrix, &made));
  else
    m->matrix = made;
  PetscCall(PetscObjectCompose((PetscObject)m->matrix, NODE_MATRIX_NAME, (PetscObject)m->container));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeMatrixJoin - makes the pattern of the pairs and of another matrix; the values are undefined.

  Collective

  Input Parameters:
+ m     - the node matrix
- other - AIJ matrix of the same rows, in which all rows of a node have the same columns; NULL: no other matrix

  Note:
  The pattern uses the memory of the last one if that suffices. The places of the other matrix' entries are stored for
  NodeMatrixSet(). Call it again when the other matrix has a new pattern.
@*/
PetscErrorCode NodeMatrixJoin(NodeMatrix m, Mat other)
{
  const Mat  mats[TERMS] = {[TERM_FOREIGN] = m->foreign, [TERM_OTHER] = other};
  MatrixRows terms[TERMS][MATRIX_BLOCKS];
  NodeRow    row;
  PetscInt   longest, *room, *at;

  PetscFunctionBeginUser;
  PetscCall(NodeMatrixGetTerms(mats, terms));
  for (int t = 0; t < TERMS; t++) PetscCall(TakeTerm(mats[t], terms[t], &m->term[t]));
  PetscCall(TakeRoom(m, terms, &longest));
  PetscCall(PetscMalloc2(2 * longest, &room, m->rows, &at));
  row = (NodeRow){.column = room, .room = &room[longest]};
  for (int b = 0; b < MATRIX_BLOCKS; b++) m->block[b].ptr[0] = 0;
  for (PetscInt r = 0; r < m->rows; r++) {
    if (IsSame(m, r))
      PetscCall(AppendSame(m, r));
    else if (IsShared(r, terms) || (m->node[r] >= 0 && !m->inner[m->node[r]]))
      PetscCall(AppendRow(m, r, terms, &row, at));
    else if (m->node[r] >= 0)
      AppendInner(m, r);
    else
      AppendNone(m, r);
    PetscCall(FindDiagonal(m, r));
  }
  PetscCall(PetscFree2(room, at));
  PetscCall(RestoreTerms(terms));
  PetscCall(MakeMatrix(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values of the matrix */

/* Copies one row of a node's blocks where all columns are in the order of the pairs. */
static inline void CopyRow(const int size, PetscInt n, const PetscReal *from, PetscScalar *to)
{
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < size; c++) to[k * size + c] = from[k * size * size + c];
}

/* Writes one row of a node's blocks, and zeros elsewhere. size and symmetric are constants in each call, so that the
   compiler unrolls the loop over a node's dofs. */
static inline void SetRow(const int size, const PetscBool symmetric, NodeMatrix m, PetscInt r, const NodeValues *values)
{
  const NodePairs *p    = &m->pairs;
  const PetscInt   node = m->node[r];
  PetscScalar     *to[MATRIX_BLOCKS];
  PetscInt         n[MATRIX_BLOCKS];
  int              d = 0;

  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    to[b] = &m->block[b].value[m->block[b].ptr[r]];
    n[b]  = m->block[b].ptr[r + 1] - m->block[b].ptr[r];
  }
  while (node >= 0 && p->dof[node * size + d] != m->first + r) d++;
  if (!symmetric && node >= 0 && m->placed[node] && n[MATRIX_OWN] == (p->ptr[node + 1] - p->ptr[node]) * size) {
    CopyRow(size, p->ptr[node + 1] - p->ptr[node], &values->all[((size_t)p->ptr[node] * size + d) * size],
            to[MATRIX_OWN]);
    return;
  }
  for (int b = 0; b < MATRIX_BLOCKS; b++)
    for (PetscInt k = 0; k < n[b]; k++) to[b][k] = 0;
  for (PetscInt k = node < 0 ? 0 : p->ptr[node]; node >= 0 && k < p->ptr[node + 1]; k++) {
    const ValueRow  row   = FindValues(size, symmetric, values, node, k, d);
    const PetscInt *place = &m->place[k * size];

    for (int c = 0; c < size; c++) {
      if (place[c] >= 0)
        to[MATRIX_OWN][place[c]] = row.value[c * row.step];
      else if (place[c] != NODE_MATRIX_NONE)
        to[MATRIX_OTHERS][-1 - place[c]] = row.value[c * row.step];
    }
  }
}

/* Adds row r of a term. The places of its entries are those of row `first` of the same node. */
static inline void AddRow(NodeMatrix m, PetscInt r, PetscInt first, const NodeTerm *term,
                          const MatrixRows rows[MATRIX_BLOCKS])
{
  for (int b = 0; b < MATRIX_BLOCKS; b++) {
    const MatrixRows *x = &rows[b];

    if (!x->mat) continue;
    for (PetscInt k = 0; k < x->ptr[r + 1] - x->ptr[r]; k++)
      m->block[b].value[m->block[b].ptr[r] + term->place[b][x->ptr[first] + k]] += x->value[x->ptr[r] + k];
  }
}

/* Tells users of the matrix that its values have changed. Nothing is communicated. */
static PetscErrorCode TellChange(NodeMatrix m)
{
  PetscFunctionBeginUser;
  PetscCall(MatAssemblyBegin(m->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that this is the matrix that the pattern was joined with. */
static PetscErrorCode CheckTerm(NodeMatrix m, Mat other, const MatrixRows rows[MATRIX_BLOCKS])
{
  const NodeTerm *term = &m->term[TERM_OTHER];
  PetscObjectId   matrix;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetId((PetscObject)other, &matrix));
  for (int b = 0; b < MATRIX_BLOCKS; b++)
    PetscCheck(matrix == term->matrix && (rows[b].mat ? rows[b].ptr[rows[b].n] : 0) == term->n[b], m->comm,
               PETSC_ERR_ARG_WRONGSTATE, "the pattern was joined with that of another matrix");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets all rows one by one, so that a row is still in the cache when terms are added to it. diagonal may be NULL. */
static void SetRows(NodeMatrix m, const NodeValues *values, MatrixRows terms[TERMS][MATRIX_BLOCKS],
                    PetscScalar *diagonal)
{
  for (PetscInt r = 0, first = 0; r < m->rows; r++) {
    if (!IsSame(m, r)) first = r;
    if (m->pairs.size == 3 && IsSymmetric(values))
      SetRow(3, PETSC_TRUE, m, r, values);
    else if (m->pairs.size == 3)
      SetRow(3, PETSC_FALSE, m, r, values);
    else
      SetRow(m->pairs.size, IsSymmetric(values), m, r, values);
    AddRow(m, r, first, &m->term[TERM_FOREIGN], terms[TERM_FOREIGN]);
    if (diagonal)
      diagonal[r] = m->diagonal[r] < 0 ? 0 : m->block[MATRIX_OWN].value[m->block[MATRIX_OWN].ptr[r] + m->diagonal[r]];
    AddRow(m, r, first, &m->term[TERM_OTHER], terms[TERM_OTHER]);
  }
}

static PetscErrorCode SetValues(NodeMatrix m, const NodeValues *values, Mat other, Vec diagonal)
{
  const Mat    mats[TERMS] = {[TERM_FOREIGN] = m->foreign, [TERM_OTHER] = other};
  MatrixRows   terms[TERMS][MATRIX_BLOCKS];
  PetscScalar *entry = NULL;

  PetscFunctionBeginUser;
  if (m->foreign) PetscCall(SetForeign(m, values));
  PetscCall(NodeMatrixGetTerms(mats, terms));
  if (other) PetscCall(CheckTerm(m, other, terms[TERM_OTHER]));
  if (diagonal) PetscCall(VecGetArrayWrite(diagonal, &entry));
  SetRows(m, values, terms, entry);
  if (diagonal) PetscCall(VecRestoreArrayWrite(diagonal, &entry));
  PetscCall(RestoreTerms(terms));
  PetscCall(TellChange(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeMatrixSet - computes the sum of all ranks' blocks and of another matrix.

  Collective

  Input Parameters:
+ m     - the node matrix, after NodeMatrixJoin()
. value - blocks of this rank in the order of its pairs, row-major [pairs*size*size]
- other - the matrix of the last NodeMatrixJoin(), with the pattern that it had then; NULL: nothing is added

  Output Parameter:
. diagonal - diagonal of the ranks' blocks alone; may be NULL

  Note:
  Entries of the pattern that neither the blocks nor the other matrix have become 0.
@*/
PetscErrorCode NodeMatrixSet(NodeMatrix m, const PetscReal *value, Mat other, Vec diagonal)
{
  PetscFunctionBeginUser;
  PetscCall(SetValues(m, &(NodeValues){.all = value}, other, diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeMatrixSetUpper - computes the sum of all ranks' blocks if it is symmetric on every rank.

  Collective

  Input Parameters:
+ m     - the node matrix, after NodeMatrixJoin()
- upper - blocks on and above the diagonal; of blocks on the diagonal both triangles are used
@*/
PetscErrorCode NodeMatrixSetUpper(NodeMatrix m, const NodeUpper *upper)
{
  PetscFunctionBeginUser;
  PetscCall(SetValues(m, &(NodeValues){.upper = upper}, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeMatrixGet - returns the matrix.

  Not collective

  Input Parameter:
. m - the node matrix

  Note:
  The matrix is borrowed, and its handle is the same all the time. It is undefined before the first NodeMatrixJoin().
@*/
Mat NodeMatrixGet(NodeMatrix m)
{
  return m->matrix;
}

/*@
  NodeMatrixRoom - returns for how many entries the arrays of the rank's own block have room.

  Not collective

  Input Parameter:
. matrix - from NodeMatrixGet()

  Output Parameter:
. room - at least one for each entry, and one for each dof that has no row though its node has one; 0: the matrix is
  not that of a node matrix
@*/
PetscErrorCode NodeMatrixRoom(Mat matrix, PetscInt *room)
{
  PetscContainer container;
  NodeMatrix     m = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectQuery((PetscObject)matrix, NODE_MATRIX_NAME, (PetscObject *)&container));
  if (container) PetscCall(PetscContainerGetPointer(container, (void **)&m));
  *room = m ? m->block[MATRIX_OWN].room : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
