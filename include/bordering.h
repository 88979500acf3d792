/* How a symmetric matrix A = K + C is factored where C couples many unknowns and is nearly a sum of v v^T over few vectors, as contact is over its terms: K is
   bordered by them, (K V; V^T -1), whose factor solves with K + V V^T. K's pattern stays, and with it its ordering; the vectors bring far less fill than the
   products of all their entries with each other. What C is besides is left to iterations (keptfactor.h). */
#pragma once
#include "petsccompat.h"

/* The vectors of this rank, and C; borrowed */
typedef struct {
  Mat                sum; /* C, whose entries A holds */
  PetscInt           n;
  const PetscInt    *ptr, *row; /* of vector k: row[ptr[k]] ... in the numbers of all ranks; a row may occur more than once, its values are summed */
  const PetscScalar *value;
} Border;

typedef struct _n_Bordering *Bordering;

/* K: AIJ, of symmetric pattern, without C; position: in which order to eliminate its rows, from 0, on the first rank (elsewhere NULL); copied. Collective. */
PetscErrorCode BorderingCreate(Mat K, const PetscInt *position, Bordering *);
PetscErrorCode BorderingDestroy(Bordering *);
/* The vectors from now on; *changed: others or more rows than before. Collective. */
PetscErrorCode BorderingSet(Bordering, const Border *, PetscBool *changed);
/* Vectors of all ranks. Not collective. */
PetscInt BorderingCount(Bordering);
/* Entries of this rank on and above the diagonal: K's, which are the same all the time; behind them the vectors', with the -1. */
enum { BORDERING_BODIES, BORDERING_VECTORS, BORDERING_PARTS };
void BorderingCountEntries(Bordering, PetscInt n[BORDERING_PARTS]);
/* Their rows and columns, from 0; the vectors' last in the numbering. Not collective. */
void BorderingNumber(Bordering, int part, PetscInt *row, PetscInt *column);
/* Their values, both parts. A: K + C as it is now. Not collective. */
PetscErrorCode BorderingTake(Bordering, Mat A, PetscScalar *value);
/* Where to eliminate each row, from 0, on the first rank; NULL on the others. The caller frees it. Collective. */
PetscErrorCode BorderingOrder(Bordering, PetscInt **position);
