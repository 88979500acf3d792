#include "shell.h"

/* ShellFind - *context (the address of a pointer): what PCShellSetContext() gave the preconditioner that
 * PCShellSetName() named so. Not collective. */
PetscErrorCode ShellFind(PC pc, const char *name, void *context)
{
  const char *own = NULL;
  PetscBool   is;

  PetscFunctionBeginUser;
  *(void **)context = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &is));
  if (is) PetscCall(PCShellGetName(pc, &own));
  if (is) PetscCall(PetscStrcmp(own, name, &is));
  if (is) PetscCall(PCShellGetContext(pc, context));
  PetscFunctionReturn(PETSC_SUCCESS);
}
