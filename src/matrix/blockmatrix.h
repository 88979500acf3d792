/* A matrix that is a sum of small dense blocks over scattered dofs: the contact part of the tangent. Blocks are defined
   over nodes of rank-local vectors, one vector for each contact pair. They are large and overlap. So all blocks are
   named first, which gives the pattern; then their values are added one by one and not kept. The sum is a parallel
   matrix over the global dofs. Its pattern is kept as long as it contains the blocks, with zeros where no block has an
   entry.

   For each assembly call BlockMatrixBegin(), BlockMatrixName() for each block, BlockMatrixPlace(), BlockMatrixAdd(),
   BlockMatrixAddOuter() or BlockMatrixAddRows() for each block, and BlockMatrixEnd(). BlockMatrixAddRows() alone makes
   the sum unsymmetric. BlockMatrixMark() and BlockMatrixReturn() go back to an
   earlier pattern, for a load step that is repeated.

   After BlockMatrixKeepFactors() no sum is made: blocks are kept as factors (blockfactors.h), and the matrix only
   multiplies by them. BlockMatrixAddFactors() then adds blocks that were never formed. The pattern is found as before.

   Measured: with all blocks' entries in PETSc's COO format instead, CPU seconds are 1.8 times as many on two rings in
   space, 1.4 on spheres, 1.5 on a pinched pipe with the diffuse smoother and 1.04 to 1.14 with facets. */
#pragma once
#include "files/archive.h"

enum {
  /* Values that must be readable after the values of a block. A node's dofs are read as vectors of four numbers, so
     that up to three numbers beyond the last dof are read; they are not used. */
  BLOCK_PADDING = 3
};

typedef struct _n_BlockMatrix *BlockMatrix;

PetscErrorCode BlockMatrixCreate(MPI_Comm, int size, BlockMatrix *);
PetscErrorCode BlockMatrixDestroy(BlockMatrix *);
PetscErrorCode BlockMatrixBegin(BlockMatrix, int n_lists, const PetscInt n[], const PetscInt *const dof[]);
PetscErrorCode BlockMatrixSort(BlockMatrix, int list, PetscInt n, PetscInt node[], PetscInt *with);
PetscErrorCode BlockMatrixName(BlockMatrix, int list, PetscInt n, const PetscInt node[], PetscBool whole);
PetscErrorCode BlockMatrixKeepFactors(BlockMatrix, PetscInt rows);
PetscBool      BlockMatrixKeepsFactors(BlockMatrix);
PetscErrorCode BlockMatrixPlace(BlockMatrix, PetscInt rows, PetscBool *changed);
void           BlockMatrixGetNodes(BlockMatrix, PetscInt b, PetscInt *n, const PetscInt **node);
PetscErrorCode BlockMatrixAdd(BlockMatrix, int list, PetscInt n, const PetscInt node[], const PetscReal value[]);
PetscErrorCode BlockMatrixAddOuter(BlockMatrix, int list, PetscInt n, const PetscInt node[], const PetscReal v[]);
PetscErrorCode BlockMatrixAddFactors(BlockMatrix, int list, PetscInt n, const PetscInt node[], PetscInt depth,
                                     PetscInt stride, const PetscReal K[], const PetscReal J[]);
PetscErrorCode BlockMatrixAddRows(BlockMatrix, int list, PetscInt n_rows, const PetscInt row[], PetscInt n,
                                  const PetscInt node[], const PetscReal value[]);
void           BlockMatrixMultiply(BlockMatrix, PetscBool transposed, const PetscReal *x, PetscReal *y);
PetscErrorCode BlockMatrixEnd(BlockMatrix, Mat *);
PetscErrorCode BlockMatrixGetCoupled(BlockMatrix, PetscInt dof, PetscInt *n, const PetscInt **coupled);

PetscErrorCode BlockMatrixMark(BlockMatrix);
PetscErrorCode BlockMatrixReturn(BlockMatrix, PetscInt rows);
PetscErrorCode BlockMatrixArchive(BlockMatrix, Archive, const char *name, PetscInt n);
