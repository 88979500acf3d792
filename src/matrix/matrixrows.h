/* The rows of an AIJ matrix as PETSc stores them, without a copy. On one rank they are in one block. On several ranks
   they are in two: columns that belong to the rank itself (MATRIX_OWN) and columns of other ranks (MATRIX_OTHERS). Call
   MatrixRowsGet() for each block, read, and call MatrixRowsRestore(). MatrixRowsColumn() gives the column of an entry,
   MatrixRowsAlike() finds the rows of a node. */
#pragma once
#include "base/petsccompat.h"

/* The blocks of a matrix. */
enum { MATRIX_OWN, MATRIX_OTHERS, MATRIX_BLOCKS };
/* Most rows of a node: one for each direction in space. */
enum { MATRIX_NODE_ROWS = 3 };

typedef struct {
  Mat      mat; /* the block, sequential; NULL: there is no such block */
  PetscInt n;   /* number of rows */
  /* Columns ascend in every row. global: global numbers of the columns; NULL: the columns are not renumbered. */
  const PetscInt    *ptr, *column, *global;
  const PetscScalar *value; /* of each entry */
} MatrixRows;

/* Returns the column of an entry. Columns of the rank itself are counted from `first`, which is its first row or 0. Not
   collective. */
static inline PetscInt MatrixRowsColumn(const MatrixRows *rows, PetscInt first, PetscInt entry)
{
  return rows->global ? rows->global[rows->column[entry]] : first + rows->column[entry];
}

PetscErrorCode MatrixRowsGet(Mat, int block, MatrixRows *);
PetscErrorCode MatrixRowsRestore(MatrixRows *);
PetscInt       MatrixRowsAlike(const MatrixRows rows[MATRIX_BLOCKS], PetscInt row);
