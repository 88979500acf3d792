/* Nested dissection of the graph of a matrix's nodes, which is gathered on the first rank. */
#include "ordering.h"
#include "matrix/matrixrows.h"
#include <metis.h>

enum { ORDERING_SEED = 1 }; /* any fixed number: the same matrix then gives the same order */
#define MPI_IDX (sizeof(idx_t) == sizeof(int64_t) ? MPI_INT64_T : MPI_INT32_T)

/* The nodes of a matrix. Rows that follow each other and have the same columns belong to one node. */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  MatrixRows  rows[MATRIX_BLOCKS];
  PetscInt    n, *first; /* nodes of this rank; the first row of each, and behind the last the number of rows */
  PetscInt   *node;      /* of each row, numbered over all ranks */
  PetscInt   *other;     /* of each column that belongs to another rank; NULL: one rank */
} Nodes;

/* The graph of all nodes, on the first rank. */
typedef struct {
  idx_t n, *rows, *offsets, *neighbours; /* rows: number of rows of each node */
} Graph;

static PetscErrorCode OrderingFindNodes(Nodes *nodes)
{
  const PetscInt n_rows = nodes->rows[MATRIX_OWN].n;
  PetscInt       before;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n_rows + 1, &nodes->first, n_rows, &nodes->node));
  for (PetscInt row = 0; row < n_rows; row += MatrixRowsAlike(nodes->rows, row)) nodes->first[nodes->n++] = row;
  nodes->first[nodes->n] = n_rows;
  PetscCallMPI(MPI_Scan(&nodes->n, &before, 1, MPIU_INT, MPI_SUM, nodes->comm));
  before -= nodes->n;
  for (PetscInt i = 0; i < nodes->n; i++)
    for (PetscInt row = nodes->first[i]; row < nodes->first[i + 1]; row++) nodes->node[row] = before + i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindOtherNodes(Mat A, Nodes *nodes)
{
  const MatrixRows *others = &nodes->rows[MATRIX_OTHERS];
  PetscInt          n;
  PetscLayout       layout;
  PetscSF           sf;

  PetscFunctionBeginUser;
  if (!others->mat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(others->mat, NULL, &n));
  PetscCall(PetscMalloc1(n, &nodes->other));
  PetscCall(MatGetLayouts(A, &layout, NULL));
  PetscCall(PetscSFCreate(nodes->comm, &sf));
  PetscCall(PetscSFSetGraphLayout(sf, layout, n, NULL, PETSC_COPY_VALUES, others->global));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, nodes->node, nodes->other, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, nodes->node, nodes->other, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NodesCreate(Mat A, Nodes *nodes)
{
  PetscFunctionBeginUser;
  *nodes = (Nodes){.comm = PetscObjectComm((PetscObject)A)};
  PetscCallMPI(MPI_Comm_rank(nodes->comm, &nodes->rank));
  PetscCallMPI(MPI_Comm_size(nodes->comm, &nodes->size));
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(MatrixRowsGet(A, block, &nodes->rows[block]));
  PetscCall(OrderingFindNodes(nodes));
  PetscCall(FindOtherNodes(A, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NodesFree(Nodes *nodes)
{
  PetscFunctionBeginUser;
  for (int block = 0; block < MATRIX_BLOCKS; block++) PetscCall(MatrixRowsRestore(&nodes->rows[block]));
  PetscCall(PetscFree2(nodes->first, nodes->node));
  PetscCall(PetscFree(nodes->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the neighbours of this rank's i-th node and returns their number. Columns of one node follow each other. */
static idx_t OrderingListNeighbours(const Nodes *nodes, PetscInt i, idx_t *neighbours)
{
  const PetscInt *node[MATRIX_BLOCKS] = {nodes->node, nodes->other}, row = nodes->first[i];
  idx_t           n = 0;

  for (int block = 0; block < MATRIX_BLOCKS; block++) {
    const MatrixRows *rows = &nodes->rows[block];
    PetscInt          last = nodes->node[row];

    for (PetscInt k = rows->mat ? rows->ptr[row] : 0; rows->mat && k < rows->ptr[row + 1]; k++) {
      const PetscInt next = node[block][rows->column[k]];

      if (next != last && next != nodes->node[row]) neighbours[n++] = (idx_t)next;
      last = next;
    }
  }
  return n;
}

/* Gathers numbers on the first rank, in the order of ranks. Other ranks get none. */
static PetscErrorCode GatherNumbers(const Nodes *nodes, PetscInt n, const idx_t *mine, idx_t *n_all, idx_t **all)
{
  PetscMPIInt count, *counts, *first;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscCalloc2(nodes->size, &counts, nodes->size + 1, &first));
  PetscCallMPI(MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, nodes->comm));
  for (PetscMPIInt r = 0; r < nodes->size; r++) first[r + 1] = first[r] + counts[r];
  *n_all = first[nodes->size];
  PetscCall(PetscMalloc1(*n_all + 1, all));
  PetscCallMPI(MPI_Gatherv(mine, count, MPI_IDX, *all, counts, first, MPI_IDX, 0, nodes->comm));
  PetscCall(PetscFree2(counts, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GraphGather(const Nodes *nodes, Graph *graph)
{
  PetscInt room = 0, n = 0;
  idx_t   *rows, *degrees, *neighbours, ends;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < nodes->n; i++)
    for (int block = 0; block < MATRIX_BLOCKS; block++)
      if (nodes->rows[block].mat)
        room += nodes->rows[block].ptr[nodes->first[i] + 1] - nodes->rows[block].ptr[nodes->first[i]];
  PetscCall(PetscMalloc3(nodes->n, &rows, nodes->n, &degrees, room, &neighbours));
  for (PetscInt i = 0; i < nodes->n; i++, n += degrees[i - 1]) {
    rows[i]    = (idx_t)(nodes->first[i + 1] - nodes->first[i]);
    degrees[i] = OrderingListNeighbours(nodes, i, &neighbours[n]);
  }
  PetscCall(GatherNumbers(nodes, nodes->n, rows, &graph->n, &graph->rows));
  PetscCall(GatherNumbers(nodes, nodes->n, degrees, &graph->n, &graph->offsets));
  PetscCall(GatherNumbers(nodes, n, neighbours, &ends, &graph->neighbours));
  for (idx_t i = graph->n, before = ends; i >= 0; i--) { /* degrees become offsets */
    const idx_t degree = i < graph->n ? graph->offsets[i] : 0;

    graph->offsets[i] = before -= degree;
  }
  PetscCall(PetscFree3(rows, degrees, neighbours));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OrderingFreeGraph(Graph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(graph->rows));
  PetscCall(PetscFree(graph->offsets));
  PetscCall(PetscFree(graph->neighbours));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the places of all rows by dissection of the nodes. */
static PetscErrorCode Dissect(const Graph *graph, PetscInt **position)
{
  idx_t    n      = graph->n, options[METIS_NOPTIONS], *node, *place;
  PetscInt n_rows = 0, row = 0, *first;
  int      status = METIS_OK;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &node, n, &place, n, &first));
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED]      = ORDERING_SEED;
  options[METIS_OPTION_NUMBERING] = 0;
  for (idx_t i = 0; i < n; i++) node[i] = place[i] = i;
  if (graph->offsets[n] > 0)
    status = METIS_NodeND(&n, graph->offsets, graph->neighbours, NULL, options, node,
                          place); /* METIS wants at least one edge */
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS failed with status %d", status);
  for (idx_t k = 0; k < n; k++) {
    first[node[k]] = n_rows;
    n_rows += graph->rows[node[k]];
  }
  PetscCall(PetscMalloc1(n_rows, position));
  for (idx_t i = 0; i < n; i++)
    for (idx_t r = 0; r < graph->rows[i]; r++) (*position)[row++] = first[i] + r;
  PetscCall(PetscFree3(node, place, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OrderingFind - finds the order in which to eliminate the rows of a sparse matrix, by nested dissection of its nodes.

  Collective

  Input Parameter:
. A - AIJ, of symmetric pattern; the rows of a node follow each other and have the same columns

  Output Parameter:
. position - place of each row of all ranks, from 0; on the first rank, NULL elsewhere. The caller frees it.

  Notes:
  The rows of a node stay together. The graph of the nodes has a third of the matrix's rows and a ninth of its entries.
  The order depends on the numbering of rows, and so on the number of ranks.

  Source: George, SIAM J. Numer. Anal. 10, 1973; Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998 (METIS).
@*/
PetscErrorCode OrderingFind(Mat A, PetscInt **position)
{
  Nodes nodes;
  Graph graph;

  PetscFunctionBeginUser;
  *position = NULL;
  PetscCall(NodesCreate(A, &nodes));
  PetscCall(GraphGather(&nodes, &graph));
  if (!nodes.rank) PetscCall(Dissect(&graph, position));
  PetscCall(OrderingFreeGraph(&graph));
  PetscCall(NodesFree(&nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
