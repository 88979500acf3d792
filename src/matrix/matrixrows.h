/* The rows of an AIJ matrix as it stores them, without a copy: on one rank in one block, on several in two, columns of
 * the rank itself and of others. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  Mat             mat; /* the block, sequential; NULL: there is none */
  PetscInt        n;   /* rows */
  const PetscInt *ptr, *column,
    *global;                /* columns ascending in every row; global: their numbers, NULL: they are their own */
  const PetscScalar *value; /* of each column */
} MatrixRows;

/* The column of an entry, those of the rank itself counted from `first`: its first row, or 0. Not collective. */
static inline PetscInt MatrixRowsColumn(const MatrixRows *rows, PetscInt first, PetscInt entry)
{
  return rows->global ? rows->global[rows->column[entry]] : first + rows->column[entry];
}

enum { MATRIX_OWN, MATRIX_OTHERS, MATRIX_BLOCKS };
/* Most rows of a node: one for each direction in space */
enum { MATRIX_NODE_ROWS = 3 };

/* The rows of one block. Not collective. */
PetscErrorCode MatrixRowsGet(Mat, int block, MatrixRows *);
PetscErrorCode MatrixRowsRestore(MatrixRows *);
/* How many rows from one on have the same columns, all blocks: the dofs of a node. Not collective. */
PetscInt MatrixRowsAlike(const MatrixRows rows[MATRIX_BLOCKS], PetscInt row);
