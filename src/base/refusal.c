#include "base/refusal.h"
#include <stdarg.h>
#include <stdlib.h>

/* Ends MPI and PETSc in order and leaves with status 1. All ranks come here together: MPI_Finalize waits for the rank
   that printed, so that a launcher which ends the job at the first non-zero status finds the message already written.
 */
static PetscErrorCode RefusalLeave(void)
{
  int finalized;

  PetscFunctionBeginUser;
  /* builds of PETSc for debugging list options that were not looked at yet; here that would be noise beside the message
   */
  PetscCall(PetscOptionsSetValue(NULL, "-options_left", "0"));
  PetscCall(PetscFinalize());
  PetscCallMPI(MPI_Finalized(&finalized));
  if (!finalized) PetscCallMPI(MPI_Finalize());
  exit(EXIT_WRONG_INPUT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* RefuseInput - one message about a mistake that every rank knows, then the end of the program with status 1.

   Collective on all ranks of the program; rank 0 of comm prints. format: printf's, without name and newline: both are
   added. Does not return. */
PetscErrorCode RefuseInput(MPI_Comm comm, const char *format, ...)
{
  va_list     arguments;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) {
    va_start(arguments, format);
    fflush(stdout);
    fputs("burnish: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    fflush(stderr);
    va_end(arguments);
  }
  PetscCall(RefusalLeave());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* RefuseInputAnywhere - as RefuseInput() for a mistake that only some ranks know: the text of the lowest complaining
   rank is printed.

   Collective on all ranks of the program. text: this rank's complaint, or NULL. Returns only where no rank complains.
 */
PetscErrorCode RefuseInputAnywhere(MPI_Comm comm, const char *text)
{
  PetscMPIInt rank, size, complaining, length = 0;
  size_t      bytes;
  char       *message;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  complaining = text ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &complaining, 1, MPI_INT, MPI_MIN, comm));
  if (complaining == size) PetscFunctionReturn(PETSC_SUCCESS);
  if (rank == complaining) {
    PetscCall(PetscStrlen(text, &bytes));
    PetscCall(PetscMPIIntCast((PetscInt)bytes, &length));
  }
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, complaining, comm));
  PetscCall(PetscCalloc1((size_t)length + 1, &message));
  if (rank == complaining) PetscCall(PetscArraycpy(message, text, (size_t)length));
  PetscCallMPI(MPI_Bcast(message, length, MPI_CHAR, complaining, comm));
  PetscCall(RefuseInput(comm, "%s", message));
  PetscFunctionReturn(PETSC_SUCCESS);
}
