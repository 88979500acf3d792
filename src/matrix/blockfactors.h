/* A sum of symmetric blocks over numbered nodes that is not formed: each block is kept as its factors K and J, of which
   it is K^T J + J^T K. A product with a vector reads the factors, which is far less work than to form the blocks, where
   only few products are asked for. Contact by fits is such a sum, where the solver takes contact as a border
   (linear/borderedfactor.h).

   BlockFactorsPlace() gives the nodes their dofs, BlockFactorsClear() begins a new sum and BlockFactorsAdd() adds a
   block to it. BlockFactorsGet() returns the sum as a matrix that multiplies, and BlockFactorsForm() makes an AIJ
   matrix of that one. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_BlockFactors *BlockFactors;

/* A block: factor (K^T J + J^T K). K and J have `depth` rows of `stride` numbers each. Without K the block is J itself,
   which is symmetric, and of which only the upper triangle is read; factor and depth do not count then. */
typedef struct {
  PetscInt         depth, stride;
  PetscReal        factor;
  const PetscReal *K, *J;
} BlockFactor;

PetscErrorCode BlockFactorsCreate(MPI_Comm, int size, BlockFactors *);
PetscErrorCode BlockFactorsDestroy(BlockFactors *);
PetscErrorCode BlockFactorsPlace(BlockFactors, PetscInt rows, PetscInt n, const PetscInt dof[]);
PetscErrorCode BlockFactorsReset(BlockFactors);
void           BlockFactorsClear(BlockFactors);
PetscErrorCode BlockFactorsAdd(BlockFactors, PetscInt n, const PetscInt number[], const BlockFactor *);
Mat            BlockFactorsGet(BlockFactors);
PetscErrorCode BlockFactorsForm(Mat, Mat *);

void BlockFactorMultiply(PetscInt m, const BlockFactor *, const PetscReal *x, PetscReal *y);
