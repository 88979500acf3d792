/* A partition of cells that one process has whole, in lists of neighbours, for tests and studies of METIS' parts. */
#pragma once
#include "mesh/partition.h"

/* Counts the cells of each part that count, those with counted[] or with NULL all, count[parts], and returns the ratio
   of the largest part to the mean, 1 if no cell counts. */
static PetscReal PartitionImbalance(PetscInt n, const PetscInt part[], const PetscBool counted[], PetscInt parts,
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

/* Finds the part of each of n cells, part[n]. Their neighbours are adjacency[offsets[c]] on. contact: whether each has
   a face in contact, which is a second weight; NULL: only cells are balanced. links: pairs of cells that should be in
   one part. edge_cut: pairs of neighbours in different parts. */
static PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
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
