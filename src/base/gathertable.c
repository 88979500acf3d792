#include "base/gathertable.h"
#include <stdlib.h>

/* GatherTableCompare - orders rows by their first two columns. Not collective. */
int GatherTableCompare(const void *a, const void *b)
{
  const PetscReal *p = a, *q = b;

  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

/*
  GatherTableCreate - Joins the ranks' rows into one table, which every rank gets. Collective.

  Input: width (columns, at least 2), n and rows[n*width] of this rank. Output: table, freed with GatherTableDestroy().
*/
PetscErrorCode GatherTableCreate(MPI_Comm comm, int width, PetscInt n, const PetscReal *rows, GatherTable *table)
{
  PetscMPIInt size, mine, total = 0, *count, *start;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n * width, &mine));
  PetscCall(PetscMalloc2(size, &count, size, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    start[r] = total;
    total += count[r];
  }
  table->n     = total / width;
  table->width = width;
  PetscCall(PetscMalloc1(total + 1, &table->row)); /* never NULL, an empty table neither */
  PetscCallMPI(MPI_Allgatherv(rows, mine, MPIU_REAL, table->row, count, start, MPIU_REAL, comm));
  qsort(table->row, (size_t)table->n, (size_t)width * sizeof(PetscReal), GatherTableCompare);
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* GatherTableDestroy - Frees a table; it is empty then. Not collective. */
PetscErrorCode GatherTableDestroy(GatherTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(table->row));
  table->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
