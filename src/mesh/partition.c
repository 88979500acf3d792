/* Partition of the cells by METIS. */
#include "mesh/partition.h"
#include <metis.h>

/* Seed of METIS' random numbers. Any fixed number serves: the same mesh and number of ranks then give the same
   partition. */
enum { METIS_SEED = 1 };

/* How far the largest part may exceed the mean, as a factor. Cells decide the cost of every Newton iteration, contact
   cells decide a small part of it. */
static const real_t CELL_TOLERANCE = 1.03f, CONTACT_TOLERANCE = 1.10f;

/* Weight of a link relative to a face between cells. A slave node is coupled to about twenty nodes of the master, a
   node of a face to nine nodes beyond it. What couples ranks is sent in every tangent and every sweep. */
enum { LINK_WEIGHT = 4 };

static PetscErrorCode IndexCast(PetscInt value, idx_t *index)
{
  PetscFunctionBeginUser;
  *index = (idx_t)value;
  PetscCheck((PetscInt)*index == value, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " does not fit into METIS' index type of %zu bytes", value, sizeof(idx_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells and the edges between them. Edges are faces, and links with a larger weight. */
typedef struct {
  idx_t *offsets, *neighbours, *weights;
} Graph;

static PetscErrorCode GraphCreate(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                                  const CellLinks *links, Graph *graph)
{
  const PetscInt ends  = 2 * links->n;
  idx_t          edges = 0, *next;

  PetscFunctionBeginUser;
  PetscCall(IndexCast(offsets[n] + ends, &edges));
  PetscCall(PetscCalloc1(n + 1, &graph->offsets));
  PetscCall(PetscMalloc1(edges, &graph->neighbours));
  PetscCall(PetscMalloc1(edges, &graph->weights));
  PetscCall(PetscMalloc1(n, &next));
  for (PetscInt e = 0; e < ends; e++) graph->offsets[links->cell[e] + 1]++;
  for (PetscInt c = 0; c < n; c++) {
    next[c] = graph->offsets[c];
    graph->offsets[c + 1] += next[c] + (idx_t)(offsets[c + 1] - offsets[c]);
    for (PetscInt k = offsets[c]; k < offsets[c + 1]; k++, next[c]++) {
      PetscCall(IndexCast(adjacency[k], &graph->neighbours[next[c]]));
      graph->weights[next[c]] = 1;
    }
  }
  for (PetscInt e = 0; e < ends; e++) {
    const PetscInt c = links->cell[e];

    PetscCall(IndexCast(links->cell[e ^ 1], &graph->neighbours[next[c]]));
    graph->weights[next[c]++] = LINK_WEIGHT;
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PartitionFreeGraph(Graph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(graph->offsets));
  PetscCall(PetscFree(graph->neighbours));
  PetscCall(PetscFree(graph->weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts pairs of neighbours in different parts, without links. */
static PetscInt CountCut(idx_t n, const Graph *graph, const PetscInt part[])
{
  PetscInt ends = 0;

  for (idx_t c = 0; c < n; c++)
    for (idx_t k = graph->offsets[c]; k < graph->offsets[c + 1]; k++)
      ends += graph->weights[k] != LINK_WEIGHT && part[c] != part[graph->neighbours[k]];
  return ends / 2;
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

/* Has METIS find the part of each cell, with one weight or with the weight of contact besides. weights: room for two */
static int PartitionFind(idx_t n, idx_t n_weights, const PetscBool contact[], Graph *graph, idx_t parts,
                         idx_t weights[], idx_t found[])
{
  idx_t  options[METIS_NOPTIONS], cut;
  real_t tolerance[2] = {CELL_TOLERANCE, CONTACT_TOLERANCE};

  for (idx_t c = 0; c < n; c++) {
    weights[c * n_weights] = 1;
    if (n_weights == 2) weights[c * n_weights + 1] = contact[c] ? 1 : 0;
  }
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED]      = METIS_SEED;
  options[METIS_OPTION_NUMBERING] = 0;
  return METIS_PartGraphKway(&n, &n_weights, graph->offsets, graph->neighbours, weights, NULL, graph->weights, &parts,
                             NULL, tolerance, options, &cut, found);
}

/* Partitions a graph and frees it. */
static PetscErrorCode PartitionUp(PetscInt n, Graph *graph, const PetscBool contact[], PetscInt parts, PetscInt part[],
                                  PetscInt *edge_cut)
{
  idx_t *weights, *found, n_vertices, n_weights = 1, n_parts;
  int    status;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; contact && c < n; c++)
    if (contact[c]) n_weights = 2; /* METIS cannot balance weights that are all zero */
  PetscCall(IndexCast(n, &n_vertices));
  PetscCall(IndexCast(parts, &n_parts));
  PetscCall(PetscMalloc2(n * n_weights, &weights, n, &found));
  status = PartitionFind(n_vertices, n_weights, contact, graph, n_parts, weights, found);
  if (status != METIS_OK && n_weights == 2) status = PartitionFind(n_vertices, 1, NULL, graph, n_parts, weights, found);
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS failed with status %d", status);
  for (PetscInt c = 0; c < n; c++) part[c] = (PetscInt)found[c];
  *edge_cut = CountCut(n_vertices, graph, part);
  PetscCall(PartitionFreeGraph(graph));
  PetscCall(PetscFree2(weights, found));
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

  Note:
  METIS gives up where parts are too small to be balanced by both weights; then cells alone are balanced.
@*/
PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                              const PetscBool contact[], const CellLinks *links, PetscInt parts, PetscInt part[],
                              PetscInt *edge_cut)
{
  Graph graph;

  PetscFunctionBeginUser;
  PetscCall(GraphCreate(n, offsets, adjacency, links, &graph));
  PetscCall(PartitionUp(n, &graph, contact, parts, part, edge_cut));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PartitionCells - decides which rank gets which cell.

  Collective

  Input Parameters:
+ comm      - the ranks
. n         - on rank 0: number of cells
. offsets   - on rank 0: start of each cell's neighbours in adjacency; freed as soon as METIS has a graph of its own
. adjacency - on rank 0: neighbours across faces; freed too
. contact   - on rank 0: for each cell, whether it has a face in contact; a second weight, so that contact work is
  balanced too
- links     - on rank 0: cells that face each other across contact, which are kept on one rank where that is cheap

  Output Parameters:
+ ranks     - on rank 0: the rank of each cell [n]
- partition - tool, edge cut and imbalances, the same on all ranks
@*/
PetscErrorCode PartitionCells(MPI_Comm comm, PetscInt n, PetscInt **offsets, PetscInt **adjacency,
                              const PetscBool contact[], const CellLinks *links, PetscMPIInt ranks[],
                              Partition *partition)
{
  PetscMPIInt rank, size;
  Graph       graph;
  PetscInt   *count, *part;
  PetscReal   imbalances[2] = {1, 1};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *partition = (Partition){.tool = "none", .imbalance_cells = 1, .imbalance_contact = 1};
  if (size == 1) PetscCall(PetscArrayzero(ranks, n));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  partition->tool = "metis";
  if (!rank) {
    PetscCall(GraphCreate(n, *offsets, *adjacency, links, &graph));
    PetscCall(PetscFree(*offsets));
    PetscCall(PetscFree(*adjacency));
    PetscCall(PetscMalloc2(size, &count, n, &part));
    PetscCall(PartitionUp(n, &graph, contact, size, part, &partition->edge_cut));
    imbalances[0] = PartitionImbalance(n, part, NULL, size, count);
    imbalances[1] = PartitionImbalance(n, part, contact, size, count);
    for (PetscInt c = 0; c < n; c++) ranks[c] = (PetscMPIInt)part[c];
    PetscCall(PetscFree2(count, part));
  }
  PetscCallMPI(MPI_Bcast(&partition->edge_cut, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(imbalances, 2, MPIU_REAL, 0, comm));
  partition->imbalance_cells   = imbalances[0];
  partition->imbalance_contact = imbalances[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}
