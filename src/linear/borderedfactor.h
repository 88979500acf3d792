/* The border of a symmetric matrix K, for the factor of K + C where C couples many unknowns and is nearly a sum of v
   v^T over few vectors v. Contact is such a C, with one vector for each contact term.

   The bordered matrix (K V; V^T -1) is factored; its factor solves with K + V V^T. The pattern of K stays, and with it
   the ordering of K. The vectors bring far less fill than the products of all their entries with each other would. What
   else C has is left to iterations (reusedfactor.h).

   The object does not factor. It gives the entries of the border and the order of elimination to factor.h. Call
   BorderedFactorSet() for each new set of vectors, and BorderedFactorOrder() where that has found another pattern. */
#pragma once
#include "base/petsccompat.h"

/* The vectors of this rank; the arrays are borrowed. Vector k has the entries ptr[k] to ptr[k + 1] - 1. */
typedef struct {
  PetscInt        n;         /* number of vectors */
  const PetscInt *ptr, *row; /* row: number among the rows of all ranks. The values of a row that occurs more than once
                                are summed. */
  const PetscScalar *value;
} Border;

typedef struct _n_BorderedFactor *BorderedFactor;

PetscErrorCode BorderedFactorCreate(MPI_Comm, PetscInt n, const PetscInt *position, BorderedFactor *);
PetscErrorCode BorderedFactorDestroy(BorderedFactor *);
PetscErrorCode BorderedFactorSet(BorderedFactor, const Border *, PetscBool *changed);
PetscInt       BorderedFactorCount(BorderedFactor);
PetscInt       BorderedFactorCountEntries(BorderedFactor);
void           BorderedFactorNumber(BorderedFactor, PetscInt *row, PetscInt *column);
void           BorderedFactorTake(BorderedFactor, PetscScalar *value);
PetscErrorCode BorderedFactorOrder(BorderedFactor, PetscInt **position);
