/* A parallel AIJ matrix that is the sum of the ranks' blocks over pairs of nodes, each rank's a block CSR over nodes of
   its own list, with room for the entries of another matrix: the elastic tangent, which contact is added to, and the
   contact matrix. A rank finds what it has for its own rows by one number for each pair and dof; only what belongs to
   rows of others goes through PETSc's COO format, whose lists are ten times as long and are sorted.

     NodeMatrixCreate(); NodeMatrixJoin(), again where the other matrix has a new pattern; NodeMatrixSet() */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_NodeMatrix *NodeMatrix;

/* Nodes of a rank and pairs of them */
typedef struct {
  int             size;         /* dofs of a node */
  PetscInt        n;            /* nodes */
  const PetscInt *dof;          /* n*size: global dofs, -1: left out; those of a node are of one rank */
  const PetscInt *ptr, *column; /* pairs of nodes, row by row, each once */
} NodePairs;

/* Values of pairs of a symmetric sum: `size` rows of `width` numbers, of which the first `size` count, for each pair on
 * the diagonal (whole) or above it */
typedef struct {
  const PetscReal *value;
  PetscInt         width;
  const PetscInt  *block; /* of each pair, where that of the pair or of its mirror image stands in value, in blocks */
  const PetscInt  *diagonal; /* of each row of pairs, the first that is not below the diagonal */
} NodeUpper;

/* For `rows` rows on this rank; the arrays of the pairs are borrowed. Collective. */
PetscErrorCode NodeMatrixCreate(MPI_Comm, PetscInt rows, const NodePairs *, NodeMatrix *);
PetscErrorCode NodeMatrixDestroy(NodeMatrix *);
/* The pattern of the pairs and of another matrix (NULL: none), without values; where the other's entries are in it is
 * noted. Collective. */
PetscErrorCode NodeMatrixJoin(NodeMatrix, Mat other);
/* The values: size x size blocks, row-major, in the order of the pairs, and those of the other matrix of the last
   NodeMatrixJoin() (NULL: not added); diagonal: of the blocks alone (NULL: not asked for). Collective. */
PetscErrorCode NodeMatrixSet(NodeMatrix, const PetscReal *value, Mat other, Vec diagonal);
/* As NodeMatrixSet() for a symmetric sum. Collective. */
PetscErrorCode NodeMatrixSetUpper(NodeMatrix, const NodeUpper *);
Mat            NodeMatrixGet(NodeMatrix); /* the same handle all the time; borrowed */
