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
