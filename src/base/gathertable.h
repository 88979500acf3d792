/* A table of reals that is whole on every rank, put together from the rows of all ranks.

   It is for data that is small beside the mesh, such as the slave nodes of a contact pair, and that must be the same on
   any number of ranks. GatherTableCreate() joins and sorts the rows, GatherTableDestroy() frees the table. */
#pragma once
#include "base/petsccompat.h"

typedef struct {
  PetscInt   n;     /* rows, ascending by their first two columns */
  int        width; /* columns */
  PetscReal *row;   /* NULL: there is no table yet */
} GatherTable;

PetscErrorCode GatherTableCreate(MPI_Comm, int width, PetscInt n, const PetscReal *rows, GatherTable *);
PetscErrorCode GatherTableDestroy(GatherTable *);
int            GatherTableCompare(const void *a, const void *b);
