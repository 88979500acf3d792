/* Decides which rank gets which cell. METIS partitions the cells' dual graph with its k-way method. Cells that face
   each other across contact are joined by links. Cells and contact cells are balanced at the same time.
   PartitionCells() does this for a graph that is on rank 0, one part for each rank; PartitionGraph() for any parts. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  const char *tool;     /* "metis", or "none" on one rank */
  PetscInt    edge_cut; /* faces between cells of different ranks */
  /* Largest part over the mean; 1 is perfect, and also the value if there are no contact cells. */
  PetscReal imbalance_cells, imbalance_contact;
} Partition;

/* Pairs of cells [2*n] that should be on one rank, because contact couples them. */
typedef struct {
  PetscInt n, *cell;
} CellLinks;

PetscErrorCode PartitionCells(MPI_Comm, PetscInt n, PetscInt **offsets, PetscInt **adjacency, const PetscBool contact[],
                              const CellLinks *, PetscMPIInt part[], Partition *);
PetscErrorCode PartitionGraph(PetscInt n, const PetscInt offsets[], const PetscInt adjacency[],
                              const PetscBool contact[], const CellLinks *, PetscInt parts, PetscInt part[],
                              PetscInt *edge_cut);
PetscReal      PartitionImbalance(PetscInt n, const PetscInt part[], const PetscBool counted[], PetscInt parts,
                                  PetscInt count[]);
