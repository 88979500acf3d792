/* The parts of the cells, from those of clusters where there are many, see cellpartition.h. */
#include "cellpartition.h"
#include "graphclusters.h"
#include "graphrefine.h"

/* Least number of clusters for each part, so that parts can be balanced to a few per cent. */
enum { PART_CLUSTERS = 100 };

/* Most cells of a cluster: as many as there are ranks, so that the graph of the clusters is about as large as what each
   rank has of the graph of the cells. */
static PetscInt LargestCluster(const CellGraph *graph)
{
  return PetscMax(2, PetscMin(graph->size, graph->start[graph->size] / (PART_CLUSTERS * graph->size)));
}

/* Makes METIS' input of a graph that is whole on the first rank. */
static PetscErrorCode CopyGraph(const CellGraph *graph, WeightedGraph *copy)
{
  const PetscInt n = graph->n, n_edges = graph->offsets[n];

  PetscFunctionBeginUser;
  *copy = (WeightedGraph){.n = n};
  PetscCall(PetscMalloc1(n + 1, &copy->offsets));
  PetscCall(PetscMalloc1(n_edges, &copy->neighbours));
  PetscCall(PetscMalloc1(n_edges, &copy->weight));
  PetscCall(PetscMalloc1(n, &copy->contact));
  PetscCall(PetscArraycpy(copy->offsets, graph->offsets, n + 1));
  PetscCall(PetscArraycpy(copy->neighbours, graph->neighbours, n_edges));
  for (PetscInt k = 0; k < n_edges; k++) copy->weight[k] = graph->weight[k];
  for (PetscInt v = 0; v < n; v++) copy->contact[v] = graph->contact[v];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PartitionWhole(const CellGraph *graph, PetscInt part[])
{
  WeightedGraph copy;

  PetscFunctionBeginUser;
  if (graph->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CopyGraph(graph, &copy));
  PetscCall(PartitionWeighted(&copy, graph->size, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has METIS find the parts of the clusters of all ranks. found: of this rank's ones [n] */
static PetscErrorCode PartitionCoarse(const CellGraph *graph, WeightedGraph *coarse, PetscInt n, PetscInt found[])
{
  PetscInt    *all = NULL;
  PetscMPIInt *counts, *starts, mine, end = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &mine));
  PetscCall(PetscMalloc2(graph->size, &counts, graph->size, &starts));
  PetscCallMPI(MPI_Gather(&mine, 1, MPI_INT, counts, 1, MPI_INT, 0, graph->comm));
  for (PetscMPIInt r = 0; !graph->rank && r < graph->size; r++) {
    starts[r] = end;
    end += counts[r];
  }
  if (!graph->rank) {
    PetscCall(PetscMalloc1(coarse->n, &all));
    PetscCall(PartitionWeighted(coarse, graph->size, all));
  }
  PetscCallMPI(MPI_Scatterv(all, counts, starts, MPIU_INT, found, mine, MPIU_INT, 0, graph->comm));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PartitionClusters(const CellGraph *graph, PetscInt part[])
{
  PetscInt      n, *cluster, *found;
  WeightedGraph coarse;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(graph->n, &cluster));
  PetscCall(GraphClustersFind(graph, LargestCluster(graph), &n, cluster));
  PetscCall(GraphClustersGather(graph, n, cluster, &coarse));
  PetscCall(PetscMalloc1(n, &found));
  PetscCall(PartitionCoarse(graph, &coarse, n, found));
  for (PetscInt v = 0; v < graph->n; v++) part[v] = found[cluster[v]];
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(cluster));
  PetscCall(GraphRefine(graph, graph->size, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ratio of the largest part to the mean, 1 if there is nothing in them. */
static PetscReal Imbalance(PetscInt parts, const PetscInt count[])
{
  PetscReal total = 0, largest = 0;

  for (PetscInt p = 0; p < parts; p++) {
    total += (PetscReal)count[p];
    largest = PetscMax(largest, (PetscReal)count[p]);
  }
  return total > 0 ? largest * (PetscReal)parts / total : 1;
}

/* Computes edge cut and imbalances. part: with those of the ghosts */
static PetscErrorCode Measure(const CellGraph *graph, PetscInt part[], Partition *partition)
{
  const PetscMPIInt size = graph->size;
  PetscInt         *count, *ends;

  PetscFunctionBeginUser;
  PetscCall(CellGraphFetch(graph, part));
  PetscCall(PetscCalloc1(2 * size + 1, &count)); /* cells, cells in contact, ends of edges that are cut */
  ends = count + 2 * size;
  for (PetscInt v = 0; v < graph->n; v++) {
    count[part[v]]++;
    count[size + part[v]] += graph->contact[v];
    for (PetscInt k = graph->offsets[v]; k < graph->offsets[v + 1]; k++)
      *ends += graph->weight[k] != CELL_LINK_WEIGHT && part[v] != part[graph->neighbours[k]];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2 * size + 1, MPIU_INT, MPI_SUM, graph->comm));
  partition->edge_cut          = *ends / 2;
  partition->imbalance_cells   = Imbalance(size, count);
  partition->imbalance_contact = Imbalance(size, count + size);
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CellPartition - decides which rank gets which cell.

  Collective

  Input Parameter:
. graph - the graph of the cells, on at least two ranks

  Output Parameters:
+ part      - rank of each cell of the slice
- partition - tool, edge cut and imbalances, the same on all ranks
@*/
PetscErrorCode CellPartition(const CellGraph *graph, PetscMPIInt part[], Partition *partition)
{
  PetscInt    *found;
  PetscMPIInt *ranks;

  PetscFunctionBeginUser;
  *partition = (Partition){.tool = "metis"};
  PetscCall(PetscMalloc1(graph->n + graph->n_ghosts, &found));
  if (graph->whole)
    PetscCall(PartitionWhole(graph, found));
  else
    PetscCall(PartitionClusters(graph, found));
  PetscCall(Measure(graph, found, partition));
  PetscCall(PetscMalloc1(graph->n, &ranks));
  for (PetscInt v = 0; v < graph->n; v++) ranks[v] = (PetscMPIInt)found[v];
  PetscCall(PetscSFBcastBegin(graph->cells, MPI_INT, ranks, part, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(graph->cells, MPI_INT, ranks, part, MPI_REPLACE));
  PetscCall(PetscFree(ranks));
  PetscCall(PetscFree(found));
  PetscFunctionReturn(PETSC_SUCCESS);
}
