/* A matrix that is a sum of small dense blocks over scattered dofs: what contact adds to the tangent. Blocks are gathered on each rank over
   the entries of rank-local vectors (one per contact pair), multiplied as they stand, or assembled into a parallel matrix over the global
   dofs, whose pattern is kept as long as it holds the blocks, with zeros where none asks for an entry.

     BlockMatrixReset(); BlockMatrixAdd() per block; then BlockMatrixAssemble(), BlockMatrixMultiply() */
#pragma once
#include "archive.h"

typedef struct _n_BlockMatrix *BlockMatrix;

/* size: the dofs of a node, which stand next to each other in every block. Collective. */
PetscErrorCode BlockMatrixCreate(MPI_Comm, int size, BlockMatrix *);
PetscErrorCode BlockMatrixDestroy(BlockMatrix *);
PetscErrorCode BlockMatrixReset(BlockMatrix);
/* A block of size m over entries of vector `list`: entry[m] to be written, value[m*m] (row-major, symmetric) to be added to (it is zero). Both are valid
   until the next call. Not collective. */
PetscErrorCode BlockMatrixAdd(BlockMatrix, int list, PetscInt m, PetscInt **entry, PetscReal **value);
/* A block v v^T over such entries: value[m] is v. Not collective. */
PetscErrorCode BlockMatrixAddOuter(BlockMatrix, int list, PetscInt m, PetscInt **entry, PetscReal **value);
/* The matrix over global dofs (n rows on this rank); dof[list][entry]: global dof, or -1 for an entry without one. It stays the block matrix's.
 *changed: its pattern is new. Collective. */
PetscErrorCode BlockMatrixAssemble(BlockMatrix, PetscInt n, const PetscInt *const dof[], Mat *, PetscBool *changed);
/* y += (blocks of list) x for rank-local vectors. Not collective. */
PetscErrorCode BlockMatrixMultiply(BlockMatrix, int list, const PetscReal *x, PetscReal *y);

/* The pattern that is kept, on one rank: another one orders the solver's sums in another way. On several it is found anew. Collective. */
PetscErrorCode BlockMatrixArchive(BlockMatrix, Archive, const char *name, PetscInt n);
