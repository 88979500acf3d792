/* The graph of the bodies' cells before distribution, for the partition: cells that share a face are neighbours, and so
   are cells that face each other across contact, with a larger weight. A small graph is whole on the first rank, in the
   order of the cells' ids. The vertices of a larger one are shared out by the places of their cells, so that most
   neighbours are on one rank; the order of tags says nothing of places where gmsh has made tetrahedra.

   CellGraphCreate() makes it, CellGraphFetch() fetches what other ranks know of the ghosts, which are neighbours on
   other ranks, and CellGraphDestroy() frees it. */
#pragma once
#include "slicemesh.h"

/* Cells of the largest graph that is whole on the first rank. METIS takes some 20 MB for it, half of what the program
   takes without a mesh. */
enum { CELL_GRAPH_WHOLE = 100000 };

typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  PetscBool   whole;     /* all vertices are on the first rank */
  PetscInt    n, *start; /* vertices of this rank; the first one of each rank, and the number of all */
  int        *contact;   /* of each vertex, 1: its cell has a face in contact */
  /* Neighbours of each vertex: numbers of this rank's vertices, or n and more: ghosts. Those across faces come before
     those across contact. */
  PetscInt *offsets, *neighbours;
  int      *weight;   /* of each neighbour */
  PetscInt  n_ghosts; /* vertices of other ranks that are neighbours */
  PetscSF   ghosts;   /* from the ghosts to their vertices */
  PetscSF   cells;    /* from the slice's cells to their vertices */
} CellGraph;

PetscErrorCode CellGraphCreate(SliceMesh *, const PetscBool contact[], CellLinks *, PetscInt whole, CellGraph *);
PetscErrorCode CellGraphFetch(const CellGraph *, PetscInt values[]);
PetscErrorCode CellGraphDestroy(CellGraph *);
