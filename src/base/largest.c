/* The largest value of all ranks, see largest.h. */
#include "base/largest.h"

/*@
  LargestOfRanks - finds the largest value of all ranks, and the rank that has it.

  Collective

  Input Parameters:
+ comm - all ranks
- mine - value of this rank

  Output Parameters:
+ most - the largest one; may be NULL
. rank - that has it, the lowest of several
- here - it is this rank; may be NULL
@*/
PetscErrorCode LargestOfRanks(MPI_Comm comm, PetscReal mine, PetscReal *most, PetscMPIInt *rank, PetscBool *here)
{
  struct {
    double value;
    int    rank;
  } own = {(double)mine, 0}, largest;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &own.rank));
  PetscCallMPI(MPI_Allreduce(&own, &largest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  if (most) *most = (PetscReal)largest.value;
  *rank = largest.rank;
  if (here) *here = (PetscBool)(largest.rank == own.rank);
  PetscFunctionReturn(PETSC_SUCCESS);
}
