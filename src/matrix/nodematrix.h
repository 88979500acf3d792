/* A parallel AIJ matrix that is the sum of the ranks' blocks over pairs of nodes. Each rank's part is a block CSR
   matrix over nodes of its own list. The pattern has room for the entries of another matrix. The elastic tangent, to
   which contact is added, and the contact matrix are such matrices. A rank finds the entries for its own rows by one
   number for each pair and dof. Only entries for rows of other ranks go through PETSc's COO format, whose lists are ten
   times as long and are sorted.

   Call NodeMatrixCreate() once, NodeMatrixJoin() for each new pattern of the other matrix, and NodeMatrixSet() or
   NodeMatrixSetUpper() for the values. NodeMatrixGet() returns the matrix.

   Measured: with PETSc's COO format for all entries instead, CPU seconds are 1.5 times as many on a pinched pipe with
   facets, 1.2 times on rings, 1.03 times with the diffuse smoother; memory is 1.1 to 1.6 times as much. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_NodeMatrix *NodeMatrix;

/* Nodes of a rank and pairs of them. */
typedef struct {
  int             size;         /* dofs of a node */
  PetscInt        n;            /* number of nodes */
  const PetscInt *dof;          /* n*size global dofs, -1: left out; all dofs of a node belong to one rank */
  const PetscInt *ptr, *column; /* pairs of nodes, row by row, each once */
} NodePairs;

/* Values of the pairs of a symmetric sum. A pair on the diagonal (whole) or above it has `size` rows of `width`
   numbers, of which the first `size` are used. */
typedef struct {
  const PetscReal *value;
  PetscInt         width;
  /* For each pair: place of its block, or of its mirror image's block, in value, counted in blocks. */
  const PetscInt *block;
  const PetscInt *diagonal; /* for each row of pairs, the first pair that is not below the diagonal */
} NodeUpper;

PetscErrorCode NodeMatrixCreate(MPI_Comm, PetscInt rows, const NodePairs *, NodeMatrix *);
PetscErrorCode NodeMatrixDestroy(NodeMatrix *);
PetscErrorCode NodeMatrixJoin(NodeMatrix, Mat other);
PetscErrorCode NodeMatrixSet(NodeMatrix, const PetscReal *value, Mat other, Vec diagonal);
PetscErrorCode NodeMatrixSetUpper(NodeMatrix, const NodeUpper *);
Mat            NodeMatrixGet(NodeMatrix);
PetscErrorCode NodeMatrixRoom(Mat, PetscInt *room);
