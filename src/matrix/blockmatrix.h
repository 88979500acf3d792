/* A matrix that is a sum of small dense blocks over scattered dofs: what contact adds to the tangent. Blocks stand over
   nodes of rank-local vectors (one per contact pair). They are large and overlap: first all are named, which gives the
   pattern, then their values are added one by one and nowhere kept. The sum is a parallel matrix over the global dofs,
   whose pattern is kept as long as it holds the blocks, with zeros where none asks for an entry.

     BlockMatrixBegin(); BlockMatrixName() per block; BlockMatrixPlace(); BlockMatrixAdd() per block; BlockMatrixEnd()
 */
#pragma once
#include "files/archive.h"

enum {
  BLOCK_PADDING = 3
}; /* a node's dofs are read as vectors of four: so many values more stand behind those of a block */

typedef struct _n_BlockMatrix *BlockMatrix;

/* size: the dofs of a node, up to 4, which stand next to each other in every block. Collective. */
PetscErrorCode BlockMatrixCreate(MPI_Comm, int size, BlockMatrix *);
PetscErrorCode BlockMatrixDestroy(BlockMatrix *);
/* n[list]: nodes of the rank-local vectors; dof[list][n*size]: global dof, or -1 for an entry without one. Not
 * collective. */
PetscErrorCode BlockMatrixBegin(BlockMatrix, int n_lists, const PetscInt n[], const PetscInt *const dof[]);
/* The order of nodes in a block; *with: those with dofs, which come first. Not collective. */
PetscErrorCode BlockMatrixSort(BlockMatrix, int list, PetscInt n, PetscInt node[], PetscInt *with);
/* A block over nodes of a list, in any order; whole: those without dofs too. Not collective. */
PetscErrorCode BlockMatrixName(BlockMatrix, int list, PetscInt n, const PetscInt node[], PetscBool whole);
/* The pattern, with `rows` rows on this rank; *changed: it is new. Collective. */
PetscErrorCode BlockMatrixPlace(BlockMatrix, PetscInt rows, PetscBool *changed);
/* The nodes of block b, counted as they were named, in its order. */
void BlockMatrixGetNodes(BlockMatrix, PetscInt b, PetscInt *n, const PetscInt **node);
/* Adds a block within a named one, nodes in the order of BlockMatrixSort(): value[(n*size)^2 + BLOCK_PADDING], of which
   the upper triangle is used, or v[n*size + BLOCK_PADDING] for v v^T. Not collective. */
PetscErrorCode BlockMatrixAdd(BlockMatrix, int list, PetscInt n, const PetscInt node[], const PetscReal value[]);
PetscErrorCode BlockMatrixAddOuter(BlockMatrix, int list, PetscInt n, const PetscInt node[], const PetscReal v[]);
/* y += x times each block that is added from now on, for rank-local vectors of its list; NULL: no more. Not collective.
 */
void BlockMatrixMultiply(BlockMatrix, const PetscReal *x, PetscReal *y);
/* The matrix; it stays the block matrix's. Collective. */
PetscErrorCode BlockMatrixEnd(BlockMatrix, Mat *);
/* The dofs, ascending, that the pattern couples with the node of which `dof` is the first (-1: it has none); n 0: it
   lacks that. Borrowed until the next call for this block matrix. Not collective. */
PetscErrorCode BlockMatrixGetCoupled(BlockMatrix, PetscInt dof, PetscInt *n, const PetscInt **coupled);

/* The pattern of now is the one that BlockMatrixReturn() goes back to. Not collective. */
PetscErrorCode BlockMatrixMark(BlockMatrix);
PetscErrorCode BlockMatrixReturn(BlockMatrix, PetscInt rows); /* Collective */
/* The pattern that is kept, on one rank: another one orders the solver's sums in another way. On several it is found
 * anew. Collective. */
PetscErrorCode BlockMatrixArchive(BlockMatrix, Archive, const char *name, PetscInt n);
