/* What is looked at before anything is solved, see precheck.h. */
#include "report/precheck.h"
#include "contactreport.h"
#include "estimate.h"
#include "lawreport.h"
#include "bodies/freemodes.h"
#include "bodies/hinges.h"

static PetscErrorCode PrintEffects(Model model, FILE *stream)
{
  char        effects[512];
  PetscMPIInt rank;
  PetscInt    dofs;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  PetscCall(ModelEffects(model, effects, sizeof(effects)));
  PetscCall(ModelDofs(model, &dofs));
  if (!rank) fprintf(stream, "dofs     %" PetscInt_FMT " free\neffects  %s\n", dofs, effects);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PrecheckModel - looks for what makes a scene fail before anything is solved.

  Collective

  Input Parameters:
+ model  - after ModelPlace() and before ModelSetUp(), which refuses initial overlaps: they are reported here first
. report - print what was found: dofs, effects, rigid motions, contact pairs, cost
- stream - of rank 0, which prints

  Note:
  It refuses a body that nothing can hold, see FreeModesRefuse().
@*/
PetscErrorCode PrecheckModel(Model model, PetscBool report, FILE *stream)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(HingesWarn(model->mesh, model->scene, stderr));
  if (report) {
    PetscCall(PrintEffects(model, stream));
    PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
    if (!rank) LawReport(model->scene, stream);
    PetscCall(FreeModesReport(model->problem->modes, PETSC_TRUE, stream));
    PetscCall(ContactReport(model->contact, stream));
    PetscCall(EstimatePrint(model, stream));
  }
  PetscCall(FreeModesRefuse(model->problem->modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PrecheckMotions - prints the rigid motions that supports leave to the bodies, if there are any.

  Collective

  Input Parameters:
+ model  - after ModelPlace()
- stream - of rank 0, which prints
@*/
PetscErrorCode PrecheckMotions(Model model, FILE *stream)
{
  PetscFunctionBeginUser;
  PetscCall(FreeModesReport(model->problem->modes, PETSC_FALSE, stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}
