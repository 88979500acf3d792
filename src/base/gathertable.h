/* A table of reals that stands whole on every rank, put together from the ranks' rows: for what is small beside the
   mesh, such as the slave nodes of a contact pair, and must come out the same on any number of ranks. */
#pragma once
#include "base/petsccompat.h"

/* Rows of `width` reals, ascending by their first two columns. .row NULL: no table yet */
typedef struct {
  PetscInt   n;
  int        width;
  PetscReal *row;
} GatherTable;

/* rows[n*width] of this rank. Collective. */
PetscErrorCode GatherTableCreate(MPI_Comm, int width, PetscInt n, const PetscReal *rows, GatherTable *);
PetscErrorCode GatherTableDestroy(GatherTable *);
/* Negative, 0 or positive as row a comes before, with or after row b, for qsort() */
int GatherTableCompare(const void *a, const void *b);
