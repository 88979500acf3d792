/* The rows of an AIJ matrix in single precision, block by block and in the order of a sweep: for products that memory
   has to feed. A block takes 40 bytes of 3 x 3 values with their column, where AIJ takes 84 to 108. What is computed
   with it is summed in double precision. */
#pragma once
#include "base/lanes.h"
#include "matrix/matrixrows.h"
#include "sweeporder.h"

enum { BLOCKROWS_SIZE = MATRIX_NODE_ROWS }; /* most rows of a block */
enum {
  BLOCKROWS_LANES = 4
}; /* a column of a block is read as a vector of so many, of which the last ones are not used */
enum {
  BLOCKROWS_AHEAD = 1024
}; /* values are fetched so far ahead: rows are too short for the processor to see where they go on; 1.4 times as fast
    */

/* Of each node what is swept before it; itself, and what is swept after it */
enum { BLOCKROWS_BEFORE, BLOCKROWS_AFTER, BLOCKROWS_PARTS };

typedef struct {
  PetscInt *first;  /* block of each place */
  PetscInt *column; /* first row of the other node of each block, those of this rank in the order of columns */
  float    *value;  /* column-major */
} BlockPart;

typedef struct {
  BlockPart part[BLOCKROWS_PARTS];
} *BlockRows;

typedef double BlockDoubles __attribute__((vector_size(BLOCKROWS_LANES * sizeof(double))));
typedef double BlockDoublesInArray
  __attribute__((vector_size(BLOCKROWS_LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

/* Of a matrix with blocks of up to BLOCKROWS_SIZE rows. Not collective. */
PetscErrorCode BlockRowsCreate(Mat, SweepOrder, BlockRows *);
PetscErrorCode BlockRowsDestroy(BlockRows *);

/* A column of a block; written so that it takes one instruction. */
LANES_INLINE BlockDoubles BlockColumn(const float *value)
{
  return (BlockDoubles){value[0], value[1], value[2], value[3]};
}

/* Blocks from, from + step, ... before to, times x; size, rows of a block, and step are constants where this is called.
 */
LANES_INLINE BlockDoubles BlockRowsProduct(const int size, const BlockPart *part, PetscInt from, PetscInt to,
                                           const int step, const PetscReal *x)
{
  BlockDoubles sum[BLOCKROWS_SIZE] = {{0}}; /* one for each column: a single one would wait for itself */

  for (PetscInt k = from; k != to; k += step) {
    __builtin_prefetch(&part->value[k * size * size + step * BLOCKROWS_AHEAD]);
    for (int c = 0; c < size; c++) sum[c] += BlockColumn(&part->value[(k * size + c) * size]) * x[part->column[k] + c];
  }
  for (int c = 1; c < size; c++) sum[0] += sum[c];
  return sum[0];
}
