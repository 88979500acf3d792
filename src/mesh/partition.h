/* Which rank gets which cell: METIS k-way on the cells' dual graph, joined across contact, balancing cells and contact
 * cells at once. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  const char *tool;     /* "metis", or "none" on one rank */
  PetscInt    edge_cut; /* faces between cells of different ranks */
  PetscReal   imbalance_cells,
    imbalance_contact; /* largest part over the mean; 1 is perfect, also where there are no contact cells */
} Partition;

/* Pairs of cells, cell[2*n], that had better be of one rank: contact couples them */
typedef struct {
  PetscInt n, *cell;
} CellLinks;

/* Gives the DM, whose cells all are on rank 0, a partitioner that holds the partition of their graph. contact: per
 * cell; all on rank 0. Collective. */
PetscErrorCode PartitionCells(DM, const PetscInt offsets[], const PetscInt adjacency[], const PetscBool contact[],
                              const CellLinks *, Partition *);
/* A graph of cells in parts: part[n]. contact: per cell, or NULL: cells alone are balanced. Not collective. */
PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                              const PetscBool contact[], const CellLinks *, PetscInt parts, PetscInt part[],
                              PetscInt *edge_cut);
/* Largest part over the mean, of the cells counted (NULL: all); count[parts]: how many each has */
PetscReal PartitionImbalance(PetscInt n, const PetscInt part[], const PetscBool counted[], PetscInt parts,
                             PetscInt count[]);
