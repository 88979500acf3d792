/* Partition of the cells by METIS. */
#include "mesh/partition.h"
#include <metis.h>

/* Seed of METIS' random numbers. Any fixed number serves: the same mesh and number of ranks then give the same
   partition. */
enum { METIS_SEED = 1 };

static PetscErrorCode IndexCast(PetscInt value, idx_t *index)
{
  PetscFunctionBeginUser;
  *index = (idx_t)value;
  PetscCheck((PetscInt)*index == value, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " does not fit into METIS' index type of %zu bytes", value, sizeof(idx_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What METIS is given */
typedef struct {
  idx_t  n, n_weights, *offsets, *neighbours, *edge_weights, *weights; /* weights: n_weights of each vertex */
  real_t tolerance[2];
} MetisGraph;

/* Makes an array of METIS of one of PETSc and frees this one. */
static PetscErrorCode TakeArray(PetscInt n, PetscInt **from, idx_t **to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, to));
  for (PetscInt i = 0; i < n; i++) PetscCall(IndexCast((*from)[i], &(*to)[i]));
  PetscCall(PetscFree(*from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes METIS' graph of a graph and frees this one. */
static PetscErrorCode TakeGraph(WeightedGraph *from, MetisGraph *to)
{
  const PetscInt n = from->n, n_edges = from->offsets[n];

  PetscFunctionBeginUser;
  *to = (MetisGraph){.n_weights = 1, .tolerance = {PARTITION_CELL_TOLERANCE, PARTITION_CONTACT_TOLERANCE}};
  for (PetscInt v = 0; from->contact && v < n; v++)
    if (from->contact[v]) to->n_weights = 2; /* METIS cannot balance weights that are all zero */
  PetscCall(IndexCast(n, &to->n));
  PetscCall(TakeArray(n + 1, &from->offsets, &to->offsets));
  PetscCall(TakeArray(n_edges, &from->neighbours, &to->neighbours));
  PetscCall(TakeArray(n_edges, &from->weight, &to->edge_weights));
  PetscCall(PetscMalloc1(n * to->n_weights, &to->weights));
  for (PetscInt v = 0; v < n; v++) {
    PetscCall(IndexCast(from->cells ? from->cells[v] : 1, &to->weights[v * to->n_weights]));
    if (to->n_weights == 2) PetscCall(IndexCast(from->contact[v], &to->weights[v * to->n_weights + 1]));
  }
  PetscCall(WeightedGraphFree(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves out the second weight. */
static void DropContact(MetisGraph *graph)
{
  for (idx_t v = 0; v < graph->n; v++) graph->weights[v] = graph->weights[2 * v];
  graph->n_weights = 1;
}

/* Has METIS find the part of each vertex. Returns its status. */
static int FindParts(MetisGraph *graph, idx_t parts, idx_t found[])
{
  idx_t options[METIS_NOPTIONS], cut;

  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED]      = METIS_SEED;
  options[METIS_OPTION_NUMBERING] = 0;
  return METIS_PartGraphKway(&graph->n, &graph->n_weights, graph->offsets, graph->neighbours, graph->weights, NULL,
                             graph->edge_weights, &parts, NULL, graph->tolerance, options, &cut, found);
}

/*@
  WeightedGraphFree - frees a graph.

  Not collective

  Input Parameter:
. graph - empty afterwards
@*/
PetscErrorCode WeightedGraphFree(WeightedGraph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(graph->offsets));
  PetscCall(PetscFree(graph->neighbours));
  PetscCall(PetscFree(graph->weight));
  PetscCall(PetscFree(graph->cells));
  PetscCall(PetscFree(graph->contact));
  graph->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PartitionWeighted - partitions a graph with METIS' k-way method.

  Not collective

  Input Parameters:
+ graph - freed
- parts - number of parts, at least 2

  Output Parameter:
. part - part of each vertex [n]

  Note:
  METIS gives up where parts are too small to be balanced by both weights; then cells alone are balanced.
@*/
PetscErrorCode PartitionWeighted(WeightedGraph *graph, PetscInt parts, PetscInt part[])
{
  MetisGraph metis;
  idx_t      n_parts, *found;
  int        status;

  PetscFunctionBeginUser;
  PetscCall(TakeGraph(graph, &metis));
  PetscCall(IndexCast(parts, &n_parts));
  PetscCall(PetscMalloc1(metis.n, &found));
  status = FindParts(&metis, n_parts, found);
  if (status != METIS_OK && metis.n_weights == 2) {
    DropContact(&metis);
    status = FindParts(&metis, n_parts, found);
  }
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS failed with status %d", status);
  for (idx_t v = 0; v < metis.n; v++) part[v] = (PetscInt)found[v];
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(metis.offsets));
  PetscCall(PetscFree(metis.neighbours));
  PetscCall(PetscFree(metis.edge_weights));
  PetscCall(PetscFree(metis.weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PartitionImbalance - computes the ratio of the largest part to the mean.

  Not collective

  Input Parameters:
+ n       - number of cells
. part    - part of each cell
. counted - for each cell, whether it counts; NULL: all cells count
- parts   - number of parts

  Output Parameter:
. count - number of cells that count in each part [parts]

  Note:
  Returns 1 if no cell counts.
@*/
PetscReal PartitionImbalance(PetscInt n, const PetscInt part[], const PetscBool counted[], PetscInt parts,
                             PetscInt count[])
{
  PetscInt total = 0, largest = 0;

  for (PetscInt p = 0; p < parts; p++) count[p] = 0;
  for (PetscInt c = 0; c < n; c++) {
    if (counted && !counted[c]) continue;
    total++;
    count[part[c]]++;
    largest = PetscMax(largest, count[part[c]]);
  }
  return total ? (PetscReal)largest * parts / (PetscReal)total : 1;
}

/* Makes a graph of lists of neighbours and of links, which come last in them. */
static PetscErrorCode CreateGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                                  const PetscBool contact[], const CellLinks *links, WeightedGraph *graph)
{
  const PetscInt ends = 2 * links->n, edges = offsets[n] + ends;
  PetscInt      *next;

  PetscFunctionBeginUser;
  *graph = (WeightedGraph){.n = n};
  PetscCall(PetscCalloc1(n + 1, &graph->offsets));
  PetscCall(PetscMalloc1(edges, &graph->neighbours));
  PetscCall(PetscMalloc1(edges, &graph->weight));
  if (contact) PetscCall(PetscMalloc1(n, &graph->contact));
  PetscCall(PetscMalloc1(n, &next));
  for (PetscInt e = 0; e < ends; e++) graph->offsets[links->cell[e] + 1]++;
  for (PetscInt c = 0; c < n; c++) {
    next[c] = graph->offsets[c];
    graph->offsets[c + 1] += next[c] + offsets[c + 1] - offsets[c];
    for (PetscInt k = offsets[c]; k < offsets[c + 1]; k++, next[c]++) {
      graph->neighbours[next[c]] = adjacency[k];
      graph->weight[next[c]]     = 1;
    }
    if (contact) graph->contact[c] = contact[c] ? 1 : 0;
  }
  for (PetscInt e = 0; e < ends; e++) {
    const PetscInt at = next[links->cell[e]]++;

    graph->neighbours[at] = links->cell[e ^ 1];
    graph->weight[at]     = CELL_LINK_WEIGHT;
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PartitionGraph - partitions a graph of cells with METIS' k-way method.

  Not collective

  Input Parameters:
+ n         - number of cells
. offsets   - start of each cell's neighbours in adjacency [n + 1]
. adjacency - neighbours
. contact   - for each cell, whether it has a face in contact, which is a second weight; NULL: only cells are balanced
. links     - pairs of cells that should be in one part
- parts     - number of parts, at least 2

  Output Parameters:
+ part     - part of each cell [n]
- edge_cut - pairs of neighbours in different parts
@*/
PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                              const PetscBool contact[], const CellLinks *links, PetscInt parts, PetscInt part[],
                              PetscInt *edge_cut)
{
  WeightedGraph graph;

  PetscFunctionBeginUser;
  PetscCall(CreateGraph(n, offsets, adjacency, contact, links, &graph));
  PetscCall(PartitionWeighted(&graph, parts, part));
  *edge_cut = 0;
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = offsets[c]; k < offsets[c + 1]; k++) *edge_cut += part[c] != part[adjacency[k]];
  *edge_cut /= 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}
