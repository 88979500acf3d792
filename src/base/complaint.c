#include "base/complaint.h"
#include "base/refusal.h"
#include <stdarg.h>

/*
  Complain - writes down a mistake unless an earlier one stands there already

  Not Collective

  Input Parameters:
+ complaint - where the first mistake is kept
- format    - and its arguments, as for printf
*/
void Complain(Complaint *complaint, const char *format, ...)
{
  va_list arguments;

  if (complaint->text[0]) return;
  va_start(arguments, format);
  vsnprintf(complaint->text, sizeof(complaint->text), format, arguments);
  va_end(arguments);
}

/*
  ComplaintRefuse - ends the program if any rank has a complaint

  Collective

  Input Parameters:
+ comm      - all ranks
- complaint - this rank's; empty if it has none
*/
PetscErrorCode ComplaintRefuse(MPI_Comm comm, const Complaint *complaint)
{
  PetscFunctionBeginUser;
  PetscCall(RefuseInputAnywhere(comm, complaint->text[0] ? complaint->text : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
