/* Parts of a graph of cells, found by METIS with its k-way method. Cells that face each other across contact are joined
   by links. Cells and contact cells are balanced at the same time. PartitionWeighted() does this for a graph with
   weights, which WeightedGraphFree() frees. How the ranks of a run get their cells is in private/cellpartition.h. */
#pragma once
#include "base/petsccompat.h"

/* How far the largest part may exceed the mean, as a factor. Cells decide the cost of every Newton iteration, contact
   cells decide a small part of it. */
#define PARTITION_CELL_TOLERANCE    1.03f
#define PARTITION_CONTACT_TOLERANCE 1.10f

/* Weight of a link relative to a face between cells. A slave node is coupled to about twenty nodes of the master, a
   node of a face to nine nodes beyond it. What couples ranks is sent in every tangent and every sweep. */
enum { CELL_LINK_WEIGHT = 4 };

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

/* Vertices that stand for one or more cells, and the edges between them in lists of neighbours. */
typedef struct {
  PetscInt  n, *offsets, *neighbours, *weight; /* weight: of each neighbour */
  PetscInt *cells, *contact; /* of each vertex: number of cells, NULL: one; cells in contact, NULL: none */
} WeightedGraph;

PetscErrorCode WeightedGraphFree(WeightedGraph *);
PetscErrorCode PartitionWeighted(WeightedGraph *, PetscInt parts, PetscInt part[]);
