/* Clusters of cells: a smaller graph that stands for the graph of the cells. GraphClustersFind() joins neighbours on
   one rank to clusters of bounded size, GraphClustersGather() gathers the graph of the clusters on the first rank. */
#pragma once
#include "cellgraph.h"

PetscErrorCode GraphClustersFind(const CellGraph *, PetscInt largest, PetscInt *n, PetscInt cluster[]);
PetscErrorCode GraphClustersGather(const CellGraph *, PetscInt n, const PetscInt cluster[], WeightedGraph *);
