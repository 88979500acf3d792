/* The graph of the cells, shared out by their places, see cellgraph.h. */
#include "cellgraph.h"
#include "cellfaces.h"
#include "base/exchange.h"
#include "base/integerset.h"
#include "tagranges.h"

/* Bits of a place's key in all, which an integer of 32 bits has room for. */
enum { KEY_BITS = 30 };

/* Vertices */

/* Lowest corner of the bodies' bounding box, and its longest side. */
static PetscErrorCode FindBox(const SliceMesh *slice, PetscReal low[3], PetscReal *side)
{
  PetscReal ends[6]; /* -lowest, then highest */

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) ends[k] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < 3 * slice->n_nodes; i++) {
    ends[i % 3]     = PetscMax(ends[i % 3], -slice->coords[i]);
    ends[3 + i % 3] = PetscMax(ends[3 + i % 3], slice->coords[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 6, MPIU_REAL, MPI_MAX, slice->comm));
  *side = 0;
  for (int k = 0; k < 3; k++) {
    low[k] = -ends[k];
    *side  = PetscMax(*side, ends[3 + k] + ends[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Key of the place of a cell's centre: bits of its coordinates in turn, so that cells with near keys are near. */
static PetscInt PlaceKey(const SliceMesh *slice, PetscInt cell, const PetscReal low[3], PetscReal side)
{
  const Element  *element = slice->cell_block[cell]->element;
  const PetscInt *nodes   = SliceMeshCellNodes(slice, cell);
  const int       bits    = KEY_BITS / element->dim;
  PetscInt        key     = 0, at[3];

  for (int d = 0; d < element->dim; d++) {
    PetscReal x = 0;

    for (int k = 0; k < element->corners; k++) x += slice->coords[3 * nodes[k] + d] / element->corners;
    at[d] = (PetscInt)((x - low[d]) / side * (PetscReal)(1 << bits));
    at[d] = PetscMax(0, PetscMin(at[d], (1 << bits) - 1));
  }
  for (int b = bits - 1; b >= 0; b--)
    for (int d = 0; d < element->dim; d++) key = 2 * key + (at[d] >> b & 1);
  return key;
}

/* Chooses the ranks of the slice's cells in the graph. */
static PetscErrorCode ChooseRanks(const SliceMesh *slice, PetscBool whole, PetscMPIInt to[])
{
  PetscReal low[3], side;
  PetscInt *key, *first;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(to, slice->n_cells));
  if (whole) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindBox(slice, low, &side));
  PetscCall(PetscMalloc1(slice->n_cells, &key));
  for (PetscInt c = 0; c < slice->n_cells; c++) key[c] = PlaceKey(slice, c, low, side);
  PetscCall(TagRangesChoose(slice->comm, slice->n_cells, key, &first));
  for (PetscInt c = 0; c < slice->n_cells; c++) to[c] = TagRangesRank(slice->size, first, key[c]);
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the vertices: those of a rank in the order of their cells' ids. */
static PetscErrorCode NumberVertices(const SliceMesh *slice, const PetscMPIInt to[], CellGraph *graph,
                                     PetscInt vertex[])
{
  PetscInt *count, *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(graph->size, &count, graph->size, &next));
  PetscCall(PetscCalloc1(graph->size + 1, &graph->start));
  for (PetscInt c = 0; c < slice->n_cells; c++) count[to[c]]++;
  PetscCallMPI(MPI_Exscan(count, next, graph->size, MPIU_INT, MPI_SUM, graph->comm)); /* sets nothing on rank 0 */
  PetscCallMPI(MPI_Allreduce(count, graph->start + 1, graph->size, MPIU_INT, MPI_SUM, graph->comm));
  for (PetscMPIInt r = 0; r < graph->size; r++) graph->start[r + 1] += graph->start[r];
  for (PetscInt c = 0; c < slice->n_cells; c++) vertex[c] = graph->start[to[c]] + next[to[c]]++;
  graph->n = graph->start[graph->rank + 1] - graph->start[graph->rank];
  PetscCall(PetscFree2(count, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the vertices. */
static PetscErrorCode CreateVertices(const SliceMesh *slice, const PetscBool contact[], CellGraph *graph,
                                     PetscInt vertex[])
{
  PetscMPIInt *to;
  int         *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(slice->n_cells, &to, slice->n_cells, &mine));
  PetscCall(ChooseRanks(slice, graph->whole, to));
  PetscCall(NumberVertices(slice, to, graph, vertex));
  PetscCall(SliceMeshSF(slice, graph->start, slice->n_cells, vertex, &graph->cells));
  PetscCall(PetscMalloc1(graph->n, &graph->contact));
  for (PetscInt c = 0; c < slice->n_cells; c++) mine[c] = contact[c] ? 1 : 0;
  PetscCall(PetscSFReduceBegin(graph->cells, MPI_INT, mine, graph->contact, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(graph->cells, MPI_INT, mine, graph->contact, MPI_REPLACE));
  PetscCall(PetscFree2(to, mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edges */

/* An edge of a vertex of this rank */
typedef struct {
  PetscInt from, to;
} GraphEdge;

/* Replaces ids of cells by the numbers of their vertices. vertex: of the slice's cells */
static PetscErrorCode ReplaceIds(const SliceMesh *slice, const PetscInt vertex[], PetscInt n, PetscInt ids[])
{
  const PetscInt *const list = ids;
  IntegerSet            set;
  PetscInt             *found;
  PetscSF               sf;

  PetscFunctionBeginUser;
  PetscCall(IntegerSetCreate(1, &n, &list, &set));
  PetscCall(SliceMeshSF(slice, slice->cell_start, set.n, set.value, &sf));
  PetscCall(PetscMalloc1(set.n, &found));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, vertex, found, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, vertex, found, MPI_REPLACE));
  for (PetscInt i = 0; i < n; i++) ids[i] = found[IntegerSetPlace(&set, ids[i])];
  PetscCall(PetscFree(found));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(IntegerSetDestroy(&set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Packs the pair i / 2 of vertices, seen from one end. */
static void PackEdge(const void *context, PetscInt i, void *packed)
{
  const PetscInt *vertex = context;
  GraphEdge      *edge   = packed;

  edge->from = vertex[i];
  edge->to   = vertex[i ^ 1];
}

/* Sends pairs of cells to the ranks of both ends, and frees them. */
static PetscErrorCode SendPairs(const SliceMesh *slice, const CellGraph *graph, const PetscInt vertex[],
                                PetscInt n_pairs, PetscInt **pairs, PetscInt *n, GraphEdge **edges)
{
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  PetscCall(ReplaceIds(slice, vertex, 2 * n_pairs, *pairs));
  PetscCall(PetscMalloc1(2 * n_pairs, &to));
  for (PetscInt i = 0; i < 2 * n_pairs; i++) to[i] = SliceMeshRankOf(slice, graph->start, (*pairs)[i]);
  PetscCall(ExchangeRecords(graph->comm, sizeof(GraphEdge), 2 * n_pairs, to, PackEdge, *pairs, n, (void **)edges));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a vertex one of another rank? */
static PetscBool IsGhost(const CellGraph *graph, PetscInt vertex)
{
  return (PetscBool)(vertex < graph->start[graph->rank] || vertex >= graph->start[graph->rank + 1]);
}

/* Numbers the neighbours on this rank, those on other ranks as ghosts. */
static PetscErrorCode NumberNeighbours(const SliceMesh *slice, CellGraph *graph)
{
  PetscInt   n = 0, *list;
  IntegerSet set;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < graph->offsets[graph->n]; k++) n += IsGhost(graph, graph->neighbours[k]);
  PetscCall(PetscMalloc1(n, &list));
  n = 0;
  for (PetscInt k = 0; k < graph->offsets[graph->n]; k++)
    if (IsGhost(graph, graph->neighbours[k])) list[n++] = graph->neighbours[k];
  PetscCall(IntegerSetCreate(1, &n, (const PetscInt *const *)&list, &set));
  PetscCall(PetscFree(list));
  graph->n_ghosts = set.n;
  PetscCall(SliceMeshSF(slice, graph->start, set.n, set.value, &graph->ghosts));
  for (PetscInt k = 0; k < graph->offsets[graph->n]; k++) {
    PetscInt *to = &graph->neighbours[k];

    *to = IsGhost(graph, *to) ? graph->n + IntegerSetPlace(&set, *to) : *to - graph->start[graph->rank];
  }
  PetscCall(IntegerSetDestroy(&set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the lists of neighbours of the edges across faces and of those across contact. */
static PetscErrorCode CreateEdges(const PetscInt n[2], GraphEdge *const edges[2], CellGraph *graph)
{
  static const int weight[2] = {1, CELL_LINK_WEIGHT};
  PetscInt        *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(graph->n + 1, &graph->offsets));
  PetscCall(PetscMalloc1(n[0] + n[1], &graph->neighbours));
  PetscCall(PetscMalloc1(n[0] + n[1], &graph->weight));
  PetscCall(PetscMalloc1(graph->n, &next));
  for (int kind = 0; kind < 2; kind++)
    for (PetscInt i = 0; i < n[kind]; i++) graph->offsets[edges[kind][i].from - graph->start[graph->rank] + 1]++;
  for (PetscInt v = 0; v < graph->n; v++) graph->offsets[v + 1] += graph->offsets[v];
  PetscCall(PetscArraycpy(next, graph->offsets, graph->n));
  for (int kind = 0; kind < 2; kind++) {
    for (PetscInt i = 0; i < n[kind]; i++) {
      const PetscInt at = next[edges[kind][i].from - graph->start[graph->rank]]++;

      graph->neighbours[at] = edges[kind][i].to;
      graph->weight[at]     = weight[kind];
    }
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellGraphCreate - makes the graph of the cells.

  Collective

  Input Parameters:
+ slice   - after CellFacesCreate(); the faces of its cells are freed as soon as they are not needed
. contact - for each of its cells, whether it has a face in contact
. links   - on the first rank: cells that face each other across contact; freed
- whole   - most cells of a graph that is whole on the first rank

  Output Parameter:
. graph - to be freed with CellGraphDestroy()
@*/
PetscErrorCode CellGraphCreate(SliceMesh *slice, const PetscBool contact[], CellLinks *links, PetscInt whole,
                               CellGraph *graph)
{
  PetscInt   n[2], *pairs, *vertex;
  GraphEdge *edges[2];

  PetscFunctionBeginUser;
  *graph = (CellGraph){.comm  = slice->comm,
                       .rank  = slice->rank,
                       .size  = slice->size,
                       .whole = (PetscBool)(slice->cell_start[slice->size] <= whole)};
  PetscCall(PetscMalloc1(slice->n_cells, &vertex));
  PetscCall(CreateVertices(slice, contact, graph, vertex));
  PetscCall(CellFacesPairs(slice, &n[0], &pairs));
  PetscCall(CellFacesFree(slice));
  PetscCall(SendPairs(slice, graph, vertex, n[0], &pairs, &n[0], &edges[0]));
  PetscCall(SendPairs(slice, graph, vertex, links->n, &links->cell, &n[1], &edges[1]));
  PetscCall(PetscFree(vertex));
  PetscCall(CreateEdges(n, edges, graph));
  for (int kind = 0; kind < 2; kind++) PetscCall(PetscFree(edges[kind]));
  PetscCall(NumberNeighbours(slice, graph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellGraphFetch - fetches the values of the ghosts.

  Collective

  Input Parameters:
+ graph  - from CellGraphCreate()
- values - of this rank's vertices, followed by those of its ghosts, which are set [n + n_ghosts]
@*/
PetscErrorCode CellGraphFetch(const CellGraph *graph, PetscInt values[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(graph->ghosts, MPIU_INT, values, values + graph->n, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(graph->ghosts, MPIU_INT, values, values + graph->n, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellGraphDestroy - frees a graph.

  Collective

  Input Parameter:
. graph - from CellGraphCreate()
@*/
PetscErrorCode CellGraphDestroy(CellGraph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(graph->start));
  PetscCall(PetscFree(graph->contact));
  PetscCall(PetscFree(graph->offsets));
  PetscCall(PetscFree(graph->neighbours));
  PetscCall(PetscFree(graph->weight));
  PetscCall(PetscSFDestroy(&graph->ghosts));
  PetscCall(PetscSFDestroy(&graph->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
