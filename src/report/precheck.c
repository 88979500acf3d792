/* What is looked at before anything is solved, see precheck.h. */
#include "report/precheck.h"
#include "contactreport.h"
#include "estimate.h"
#include "lawreport.h"
#include "bodies/freemodes.h"
#include "kernels/elementkernel.h"
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
  PrecheckPlasticity - prints the memory of plastic states, and the formulation that was chosen for plastic bodies.

  Collective

  Input Parameters:
+ model  - after ModelCreate()
- stream - of rank 0, which prints

  Note:
  It prints nothing where no body is plastic.
@*/
PetscErrorCode PrecheckPlasticity(Model model, FILE *stream)
{
  const Scene scene = model->scene;
  PetscInt64  sum[2]; /* points and their bytes */
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!SceneIsPlastic(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  sum[0] = ElasticityPlasticPoints(model->problem->elasticity, &sum[1]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_INT64, MPI_SUM, model->mesh->comm));
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  fprintf(stream, "plastic  %lld quadrature points, %lld bytes each (%.3g MB)\n", (long long)sum[0],
          (long long)(sum[0] ? sum[1] / sum[0] : 0), (double)sum[1] / 1e6);
  for (int b = 0; b < scene->n_bodies; b++) {
    const SceneBody *body = &scene->bodies[b];

    if (!body->rigid && body->chosen && MaterialGetLaw(body->material.law)->plastic)
      fprintf(stream, "         '%s' names no formulation: it is %s\n", body->name, Formulations[body->formulation]);
  }
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
    PetscCall(PrecheckPlasticity(model, stream));
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
