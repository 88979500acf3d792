/* The rows of all ranks, gathered and sorted. */
#include "base/gathertable.h"
#include <stdlib.h>

/*@
  GatherTableCompare - compares two rows by their first two columns, for qsort()

  Not collective, plain C

  Input Parameters:
+ a - a row
- b - another row

  Note:
  Returns a negative number, 0 or a positive number if row a comes before, with or after row b.
@*/
int GatherTableCompare(const void *a, const void *b)
{
  const PetscReal *p = a, *q = b;

  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

/*@
  GatherTableCreate - joins the rows of all ranks into one table, which every rank gets

  Collective

  Input Parameters:
+ comm  - the ranks
. width - number of columns, at least 2
. n     - number of rows of this rank
- rows  - [n][width]

  Output Parameter:
. table - freed with GatherTableDestroy()
@*/
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
  PetscCall(PetscMalloc1(total + 1, &table->row)); /* not NULL, even if the table is empty */
  PetscCallMPI(MPI_Allgatherv(rows, mine, MPIU_REAL, table->row, count, start, MPIU_REAL, comm));
  qsort(table->row, (size_t)table->n, (size_t)width * sizeof(PetscReal), GatherTableCompare);
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GatherTableDestroy - frees a table, which is empty then

  Not collective

  Input Parameter:
. table - the table
@*/
PetscErrorCode GatherTableDestroy(GatherTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(table->row));
  table->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
