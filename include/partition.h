/* Which rank gets which cell: METIS k-way on the cells' dual graph, balancing cells and contact cells at once. */
#pragma once
#include "petsccompat.h"

typedef struct {
  const char *tool;                               /* "metis", or "none" on one rank */
  PetscInt    edge_cut;                           /* faces between cells of different ranks */
  PetscReal   imbalance_cells, imbalance_contact; /* largest part over the mean; 1 is perfect, also where there are no contact cells */
} Partition;

/* Gives the DM, whose cells all are on rank 0, a partitioner that holds the partition. contact: per cell, on rank 0. Collective. */
PetscErrorCode PartitionCells(DM, const PetscBool contact[], Partition *);
