/* Wrong input as an error code with a message. */
#include "base/refusal.h"
#include <stdarg.h>

/* The message of the refusal that is on its way up; NULL where there is none. */
static char *refusal_message;

/*@
  RefuseInput - keeps the message about a mistake that every rank knows and returns the code of refusals

  Collective

  Input Parameters:
+ comm   - all ranks of the run
. format - of the message, as for printf(), without a newline at its end
- ...    - arguments of the format

  Note:
  Returns REFUSED on all ranks. A message that is kept already stays, since it is the first mistake.
@*/
PetscErrorCode RefuseInput(MPI_Comm comm, const char *format, ...)
{
  va_list arguments;
  int     length;

  PetscFunctionBeginUser;
  (void)comm;
  if (refusal_message) PetscFunctionReturn(REFUSED);
  va_start(arguments, format);
  length = vsnprintf(NULL, 0, format, arguments);
  va_end(arguments);
  PetscCheck(length >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "vsnprintf() cannot write a message");
  PetscCall(PetscMalloc1(length + 1, &refusal_message));
  va_start(arguments, format);
  vsnprintf(refusal_message, (size_t)length + 1, format, arguments);
  va_end(arguments);
  PetscFunctionReturn(REFUSED);
}

/*@
  RefuseInputAnywhere - refuses a mistake that only some ranks know; the message of the lowest of them is kept

  Collective

  Input Parameters:
+ comm - all ranks of the run
- text - message of this rank, or NULL where it has none

  Note:
  Returns REFUSED on all ranks if any rank has a message, and 0 otherwise.
@*/
PetscErrorCode RefuseInputAnywhere(MPI_Comm comm, const char *text)
{
  PetscMPIInt    rank, size, complaining, length = 0;
  size_t         bytes;
  char          *message;
  PetscErrorCode code;

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
  code = RefuseInput(comm, "%s", message);
  PetscCall(PetscFree(message));
  PetscFunctionReturn(code);
}

/*@
  RefusalIsPending - tells whether a refusal has been made whose message nobody has taken yet

  Not collective
@*/
PetscBool RefusalIsPending(void)
{
  return refusal_message ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  RefusalTake - hands the message of a refusal over and so ends the refusal

  Not collective

  Output Parameter:
. message - the caller frees it with PetscFree(); NULL where there is no refusal
@*/
PetscErrorCode RefusalTake(char **message)
{
  PetscFunctionBeginUser;
  *message        = refusal_message;
  refusal_message = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
