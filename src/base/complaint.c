/* The first mistake that one rank finds, and its refusal by all ranks. */
#include "base/complaint.h"
#include "base/refusal.h"
#include <stdarg.h>

/*@
  Complain - writes a mistake down unless there is an earlier one

  Not collective

  Input Parameters:
+ complaint - keeps the first mistake
. format    - of the message, as for printf()
- ...       - arguments of the format
@*/
void Complain(Complaint *complaint, const char *format, ...)
{
  va_list arguments;

  if (complaint->text[0]) return;
  va_start(arguments, format);
  vsnprintf(complaint->text, sizeof(complaint->text), format, arguments);
  va_end(arguments);
}

/*@
  ComplaintAnywhere - says whether any rank has a complaint

  Collective

  Input Parameters:
+ comm      - all ranks
- complaint - of this rank; empty if it has none

  Output Parameter:
. anywhere - the same on all ranks
@*/
PetscErrorCode ComplaintAnywhere(MPI_Comm comm, const Complaint *complaint, PetscBool *anywhere)
{
  PetscFunctionBeginUser;
  *anywhere = complaint->text[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, anywhere, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ComplaintRefuse - refuses the input if any rank has a complaint

  Collective

  Input Parameters:
+ comm      - all ranks
- complaint - of this rank; empty if it has none

  Note:
  Returns REFUSED on all ranks if there is a complaint, see RefuseInputAnywhere().
@*/
PetscErrorCode ComplaintRefuse(MPI_Comm comm, const Complaint *complaint)
{
  PetscFunctionBeginUser;
  PetscCall(RefuseInputAnywhere(comm, complaint->text[0] ? complaint->text : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
