/* A matrix over more rows and columns than another one, with the same entries and without a copy of them: for a while
   the other matrix lends its arrays. Its rows and columns keep their order; a row that it does not have has one entry,
   on the diagonal. Multigrid needs all dofs of a node, but the tangent has the free ones only.

   WideMatrixBorrow() takes the arrays, WideMatrixAdd() adds a third matrix to their values, and WideMatrixCreate()
   makes the wide matrix from them, with all entries or without those that are 0. WideMatrixReturn() gives the arrays
   back as they were. In between nobody may read the lender, and nobody may read the wide matrix afterwards. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_WideMatrix *WideMatrix;

/* Where the rows and columns of the lender are in the wide matrix. */
typedef struct {
  PetscInt        n;        /* rows of this rank in the wide matrix */
  const PetscInt *row;      /* of each row of this rank, its row in the wide matrix, counted from this rank's first */
  PetscInt       *ghost;    /* of each column of other ranks, its column in the wide matrix; NULL: there are none */
  PetscReal       diagonal; /* of the rows that the lender does not have */
} WideRows;

PetscErrorCode WideMatrixBorrow(Mat lender, const WideRows *, PetscInt size, WideMatrix *loan);
PetscErrorCode WideMatrixAdd(WideMatrix loan, PetscReal factor, Mat term);
PetscErrorCode WideMatrixCreate(WideMatrix loan, PetscBool full, Mat *wide);
PetscErrorCode WideMatrixReturn(WideMatrix *loan);
