/* Clusters grow from one cell by the neighbour that has most edges with them, see graphclusters.h. */
#include "graphclusters.h"
#include "base/exchange.h"

/* A cluster that grows, and what waits */
typedef struct {
  const CellGraph *graph;
  PetscInt        *cluster;         /* of each vertex, -1: none yet */
  PetscInt        *bond;            /* of each vertex, weight of its edges with the cluster that grows */
  PetscInt         n_front, *front; /* vertices with such edges and without a cluster */
  /* Vertices beside earlier clusters, each once: next ones start there, so that few are left between clusters. */
  PetscInt   n_waiting, next, *waiting;
  PetscBool *waits;
} Growth;

static PetscErrorCode CreateGrowth(const CellGraph *graph, PetscInt cluster[], Growth *growth)
{
  PetscFunctionBeginUser;
  *growth = (Growth){.graph = graph, .cluster = cluster};
  PetscCall(PetscCalloc2(graph->n, &growth->bond, graph->n, &growth->waits));
  PetscCall(PetscMalloc2(graph->n, &growth->front, graph->n, &growth->waiting));
  for (PetscInt v = 0; v < graph->n; v++) cluster[v] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeGrowth(Growth *growth)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(growth->bond, growth->waits));
  PetscCall(PetscFree2(growth->front, growth->waiting));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a vertex to the cluster that grows. */
static void AddVertex(Growth *growth, PetscInt v, PetscInt cluster)
{
  const CellGraph *graph = growth->graph;

  growth->cluster[v] = cluster;
  for (PetscInt k = graph->offsets[v]; k < graph->offsets[v + 1]; k++) {
    const PetscInt to = graph->neighbours[k];

    if (to >= graph->n || growth->cluster[to] >= 0) continue;
    if (!growth->bond[to]) growth->front[growth->n_front++] = to;
    growth->bond[to] += graph->weight[k];
  }
}

/* Takes the vertex with the strongest bond out of the front; of equal ones the first that came there. */
static PetscInt TakeStrongest(Growth *growth)
{
  PetscInt best = 0, v;

  for (PetscInt i = 1; i < growth->n_front; i++)
    if (growth->bond[growth->front[i]] > growth->bond[growth->front[best]]) best = i;
  v = growth->front[best];
  growth->n_front--;
  for (PetscInt i = best; i < growth->n_front; i++) growth->front[i] = growth->front[i + 1];
  return v;
}

/* Grows a cluster from a vertex, and leaves the rest of its front waiting. */
static void Grow(Growth *growth, PetscInt v, PetscInt largest, PetscInt cluster)
{
  AddVertex(growth, v, cluster);
  for (PetscInt size = 1; size < largest && growth->n_front; size++) AddVertex(growth, TakeStrongest(growth), cluster);
  for (PetscInt i = 0; i < growth->n_front; i++) {
    const PetscInt rest = growth->front[i];

    growth->bond[rest] = 0;
    if (growth->waits[rest]) continue;
    growth->waits[rest]                  = PETSC_TRUE;
    growth->waiting[growth->n_waiting++] = rest;
  }
  growth->n_front = 0;
}

/*@
  GraphClustersFind - joins neighbours on one rank to clusters.

  Not collective

  Input Parameters:
+ graph   - the graph of the cells
- largest - most cells of a cluster

  Output Parameters:
+ n       - number of clusters of this rank
- cluster - of each vertex, numbered on this rank [n of the graph]
@*/
PetscErrorCode GraphClustersFind(const CellGraph *graph, PetscInt largest, PetscInt *n, PetscInt cluster[])
{
  Growth growth;

  PetscFunctionBeginUser;
  PetscCall(CreateGrowth(graph, cluster, &growth));
  *n = 0;
  for (PetscInt v = 0; v < graph->n; v++) {
    if (cluster[v] < 0) Grow(&growth, v, largest, (*n)++);
    for (; growth.next < growth.n_waiting; growth.next++)
      if (cluster[growth.waiting[growth.next]] < 0) Grow(&growth, growth.waiting[growth.next], largest, (*n)++);
  }
  PetscCall(FreeGrowth(&growth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The graph of the clusters */

/* Counts the cells of each cluster and lists them: those of cluster i start at start[i]. */
static PetscErrorCode ListCells(const CellGraph *graph, PetscInt n, const PetscInt cluster[], PetscInt **start,
                                PetscInt **cell, WeightedGraph *coarse)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &coarse->cells));
  PetscCall(PetscCalloc1(n, &coarse->contact));
  PetscCall(PetscCalloc1(n + 1, start));
  PetscCall(PetscMalloc1(graph->n, cell));
  for (PetscInt v = 0; v < graph->n; v++) {
    coarse->cells[cluster[v]]++;
    coarse->contact[cluster[v]] += graph->contact[v];
  }
  for (PetscInt i = 0; i < n; i++) (*start)[i + 1] = (*start)[i] + coarse->cells[i];
  for (PetscInt v = graph->n; v-- > 0;) (*cell)[--(*start)[cluster[v] + 1]] = v;
  for (PetscInt i = 0; i < n; i++) (*start)[i] = (*start)[i + 1];
  (*start)[n] = graph->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the neighbours of a cluster, ascending, and the weights of all edges with each of them. n: their number;
   number: of the cluster of each vertex and ghost, among those of all ranks */
static PetscErrorCode ListNeighbours(const CellGraph *graph, PetscInt n_cells, const PetscInt cell[],
                                     const PetscInt number[], PetscInt neighbours[], PetscInt weight[], PetscInt *n)
{
  PetscInt all = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n_cells; i++) {
    for (PetscInt k = graph->offsets[cell[i]]; k < graph->offsets[cell[i] + 1]; k++) {
      if (number[graph->neighbours[k]] == number[cell[i]]) continue;
      neighbours[all] = number[graph->neighbours[k]];
      weight[all++]   = graph->weight[k];
    }
  }
  PetscCall(PetscSortIntWithArray(all, neighbours, weight));
  *n = 0;
  for (PetscInt i = 0; i < all; i++) {
    if (i && neighbours[i] == neighbours[*n - 1])
      weight[*n - 1] += weight[i];
    else {
      neighbours[*n] = neighbours[i];
      weight[(*n)++] = weight[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the graph of this rank's clusters. Neighbours are numbered among those of all ranks. */
static PetscErrorCode Contract(const CellGraph *graph, PetscInt n, const PetscInt cluster[], WeightedGraph *coarse)
{
  PetscInt *cluster_start, *number, *start, *cell, degree = 0;

  PetscFunctionBeginUser;
  *coarse = (WeightedGraph){.n = n};
  PetscCall(ListCells(graph, n, cluster, &start, &cell, coarse));
  PetscCall(ExchangeStarts(graph->comm, n, &cluster_start));
  PetscCall(PetscMalloc1(graph->n + graph->n_ghosts, &number));
  for (PetscInt v = 0; v < graph->n; v++) number[v] = cluster_start[graph->rank] + cluster[v];
  PetscCall(CellGraphFetch(graph, number));
  PetscCall(PetscMalloc1(n + 1, &coarse->offsets));
  PetscCall(PetscMalloc1(graph->offsets[graph->n], &coarse->neighbours));
  PetscCall(PetscMalloc1(graph->offsets[graph->n], &coarse->weight));
  coarse->offsets[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at = coarse->offsets[i];

    PetscCall(ListNeighbours(graph, start[i + 1] - start[i], cell + start[i], number, coarse->neighbours + at,
                             coarse->weight + at, &degree));
    coarse->offsets[i + 1] = at + degree;
  }
  PetscCall(PetscFree(number));
  PetscCall(PetscFree(cluster_start));
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers integers of all ranks on the first one, in the order of the ranks, and frees this rank's. before: entries
   that are left free in front of them */
static PetscErrorCode Gather(const CellGraph *graph, PetscInt n, PetscInt before, PetscInt **values, PetscInt *n_all)
{
  PetscInt    *start, *all = NULL;
  PetscMPIInt *counts, *starts;

  PetscFunctionBeginUser;
  PetscCall(ExchangeStarts(graph->comm, n, &start));
  PetscCall(PetscMalloc2(graph->size, &counts, graph->size, &starts));
  for (PetscMPIInt r = 0; r < graph->size; r++) {
    PetscCall(PetscMPIIntCast(start[r + 1] - start[r], &counts[r]));
    PetscCall(PetscMPIIntCast(start[r], &starts[r]));
  }
  *n_all = start[graph->size];
  if (!graph->rank) PetscCall(PetscMalloc1(before + *n_all, &all));
  PetscCallMPI(MPI_Gatherv(*values, counts[graph->rank], MPIU_INT, graph->rank ? NULL : all + before, counts, starts,
                           MPIU_INT, 0, graph->comm));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(*values));
  *values = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GraphClustersGather - makes the graph of the clusters of all ranks.

  Collective

  Input Parameters:
+ graph   - the graph of the cells
. n       - number of clusters of this rank
- cluster - of each vertex

  Output Parameter:
. coarse - on the first rank: clusters rank by rank, with their cells, and the weights of all edges between two of them;
  empty on other ranks
@*/
PetscErrorCode GraphClustersGather(const CellGraph *graph, PetscInt n, const PetscInt cluster[], WeightedGraph *coarse)
{
  PetscInt n_edges, n_all;

  PetscFunctionBeginUser;
  PetscCall(Contract(graph, n, cluster, coarse));
  n_edges = coarse->offsets[n];
  for (PetscInt i = 0; i < n; i++)
    coarse->offsets[i] = coarse->offsets[i + 1] - coarse->offsets[i]; /* numbers of edges */
  PetscCall(Gather(graph, n, 1, &coarse->offsets, &coarse->n));
  PetscCall(Gather(graph, n, 0, &coarse->cells, &n_all));
  PetscCall(Gather(graph, n, 0, &coarse->contact, &n_all));
  PetscCall(Gather(graph, n_edges, 0, &coarse->neighbours, &n_all));
  PetscCall(Gather(graph, n_edges, 0, &coarse->weight, &n_all));
  if (graph->rank) coarse->n = 0;
  if (graph->rank) PetscFunctionReturn(PETSC_SUCCESS);
  coarse->offsets[0] = 0;
  for (PetscInt i = 0; i < coarse->n; i++) coarse->offsets[i + 1] += coarse->offsets[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}
