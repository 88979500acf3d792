/* The rows of an AIJ matrix in single precision, block by block and in the order of a sweep.

   Sweeps and products are limited by memory: a block of 3 x 3 values with its column takes 40 bytes here, where AIJ
   takes 84 to 108. Products are summed in double precision. BlockRowsCreate() copies the matrix; BlockRowsProduct()
   multiplies some blocks with a vector.

   Measured: gaussseidel.h with this copy against PETSc's PCSOR, which reads AIJ, in the same multigrid (spheres of
   962,000 unknowns, one rank, CPU time of the run): PCSOR takes 1.40 times as much, and 27 Krylov iterations instead
   of 23. */
#pragma once
#include "base/lanes.h"
#include "matrix/matrixrows.h"
#include "sweeporder.h"

/* Most rows of a block. */
enum { BLOCKROWS_SIZE = MATRIX_NODE_ROWS };
/* Numbers in the vector as which a column of a block is read. The last ones of them are not used. */
enum { BLOCKROWS_LANES = 4 };
/* Number of values by which memory is fetched ahead. Rows are too short for the processor to predict where they
   continue; fetching ahead makes sweeps 1.4 times as fast. */
enum { BLOCKROWS_AHEAD = 1024 };

/* The parts of a row: blocks of nodes that are swept before the row's node; its own block, and those of nodes that are
   swept after it. */
enum { BLOCKROWS_BEFORE, BLOCKROWS_AFTER, BLOCKROWS_PARTS };

typedef struct {
  PetscInt *first;  /* first block of each place */
  PetscInt *column; /* of each block: the first row of its other node */
  float    *value;  /* column-major */
} BlockPart;

typedef struct {
  BlockPart part[BLOCKROWS_PARTS];
} *BlockRows;

/* Four numbers that are added and multiplied at once; in an array they need not be aligned. */
typedef double BlockDoubles __attribute__((vector_size(BLOCKROWS_LANES * sizeof(double))));
typedef double BlockDoublesInArray
  __attribute__((vector_size(BLOCKROWS_LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

PetscErrorCode BlockRowsCreate(Mat, SweepOrder, BlockRows *);
PetscErrorCode BlockRowsDestroy(BlockRows *);

/* Reads a column of a block. It is written so that the compiler makes one instruction of it. */
LANES_INLINE BlockDoubles BlockColumn(const float *value)
{
  return (BlockDoubles){value[0], value[1], value[2], value[3]};
}

/* Multiplies the blocks from, from + step and so on before `to` with x. size (rows of a block) and step are constants
   where this is called. */
LANES_INLINE BlockDoubles BlockRowsProduct(const int size, const BlockPart *part, PetscInt from, PetscInt to,
                                           const int step, const PetscReal *x)
{
  BlockDoubles sum[BLOCKROWS_SIZE] = {{0}}; /* one for each column; a single sum would wait for itself */

  for (PetscInt k = from; k != to; k += step) {
    __builtin_prefetch(&part->value[k * size * size + step * BLOCKROWS_AHEAD]);
    for (int c = 0; c < size; c++) sum[c] += BlockColumn(&part->value[(k * size + c) * size]) * x[part->column[k] + c];
  }
  for (int c = 1; c < size; c++) sum[0] += sum[c];
  return sum[0];
}
