/* The order in which Gauss-Seidel's method goes through the nodes of a matrix (blocks of rows), the same method on any
   number of ranks: nodes that are coupled to other ranks are swept colour by colour of the ranks, with what the ranks
   before have found, the others meanwhile. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  int       size;        /* rows of a node */
  PetscInt  n, n_ghosts; /* nodes of this rank; of others that they are coupled to, numbered after them */
  PetscInt *node;        /* of each place */
  PetscInt *place;       /* of each node; ghosts: -1 when all of them are swept before, n: after */
  PetscInt *ghost; /* of each column of other ranks, as the matrix has it: its number of [n_ghosts], times size, and
                      which row */
  PetscInt inner, interface; /* first place of the nodes without ghosts, and of the others ... */
  PetscInt n_inner;          /* how many the former are */
  int      colours, colour;  /* of the ranks; this one's */
  PetscSF  sf;               /* from rows to those of ghosts; NULL: one rank */
} *SweepOrder;

/* The order for an AIJ matrix of symmetric pattern, whose block size is that of nodes. Collective. */
PetscErrorCode SweepOrderCreate(Mat, SweepOrder *);
PetscErrorCode SweepOrderDestroy(SweepOrder *);
/* Values of other ranks; x[(n + n_ghosts)*size]. Collective. */
PetscErrorCode SweepOrderShareBegin(SweepOrder, PetscReal *x);
PetscErrorCode SweepOrderShareEnd(SweepOrder, PetscReal *x);
