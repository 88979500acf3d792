/* How a symmetric matrix K + C is factored where C couples many unknowns and is nearly a sum of v v^T over few vectors,
   as contact is over its terms: K is bordered by them, (K V; V^T -1), whose factor solves with K + V V^T. K's pattern
   stays, and with it its ordering; the vectors bring far less fill than the products of all their entries with each
   other. What C is besides is left to iterations (keptfactor.h). */
#pragma once
#include "base/petsccompat.h"

/* The vectors of this rank; borrowed */
typedef struct {
  PetscInt        n;
  const PetscInt *ptr, *row; /* of vector k: row[ptr[k]] ... in the numbers of all ranks; a row may occur more than
                                once, its values are summed */
  const PetscScalar *value;
} Border;

typedef struct _n_Bordering *BorderedFactor;

/* n: rows of K on all ranks; position: in which order to eliminate them, from 0, on the first rank (elsewhere NULL);
 * copied. Collective. */
PetscErrorCode BorderedFactorCreate(MPI_Comm, PetscInt n, const PetscInt *position, BorderedFactor *);
PetscErrorCode BorderedFactorDestroy(BorderedFactor *);
/* The vectors from now on; *changed: they have other rows than those that BorderedFactorOrder() was asked about last.
 * Collective. */
PetscErrorCode BorderedFactorSet(BorderedFactor, const Border *, PetscBool *changed);
/* Vectors of all ranks. Not collective. */
PetscInt BorderedFactorCount(BorderedFactor);
/* Entries of this rank's vectors above the diagonal, each with a -1 behind it. Not collective. */
PetscInt BorderedFactorCountEntries(BorderedFactor);
/* Their rows and columns, from 0, where the vectors' unknowns follow K's. Not collective. */
void BorderedFactorNumber(BorderedFactor, PetscInt *row, PetscInt *column);
/* Their values. Not collective. */
void BorderedFactorTake(BorderedFactor, PetscScalar *value);
/* Where to eliminate each row, from 0, on the first rank; NULL on the others. The caller frees it. Collective. */
PetscErrorCode BorderedFactorOrder(BorderedFactor, PetscInt **position);
