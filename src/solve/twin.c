/* Twins of a model, see twin.h. */
#include "solve/twin.h"
#include "bodies/tools.h"
#include "modelimpl.h"

/*@
  ModelTwinFollow - gives a fresh twin the penalties of a model.

  Collective

  Input Parameters:
+ twin  - after ModelSetUp()
- model - at its solution

  Output Parameter:
. same - the meshes have the same nodes and cells on all ranks; else the twin cannot be evaluated
@*/
PetscErrorCode ModelTwinFollow(Model twin, Model model, PetscBool *same)
{
  const Mesh a = twin->mesh, b = model->mesh;
  PetscBool  mine = (PetscBool)(a->n_nodes == b->n_nodes && a->n_cells == b->n_cells && a->n_free == b->n_free);

  PetscFunctionBeginUser;
  if (mine) PetscCall(PetscArraycmp(a->node_id, b->node_id, a->n_nodes, &mine));
  if (mine) PetscCall(PetscArraycmp(a->cell_ptr, b->cell_ptr, a->n_cells + 1, &mine));
  if (mine) PetscCall(PetscArraycmp(a->cell_nodes, b->cell_nodes, a->cell_ptr[a->n_cells], &mine));
  if (mine && twin->contact) PetscCall(ContactFollow(twin->contact, model->contact, &mine));
  PetscCallMPI(MPI_Allreduce(&mine, same, sizeof(PetscBool), MPI_BYTE, MPI_BAND, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelTwinGather - makes the contact lists of a twin.

  Collective

  Input Parameters:
+ twin - after ModelTwinFollow()
. x    - free displacements of the solution of the model (length)
- t    - load parameter
@*/
PetscErrorCode ModelTwinGather(Model twin, Vec x, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(twin->problem, x, t));
  ToolsAccept(twin->mesh, twin->problem->trial, t);
  if (twin->contact) PetscCall(ProblemGatherLists(twin->problem, twin->problem->trial, t, t, 0));
  PetscCall(ContactSpringsRelax(twin->problem->springs, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelTwinEvaluate - puts a twin at free displacements, and gives its residual there.

  Collective

  Input Parameters:
+ twin - after ModelTwinGather()
. x    - free displacements (length), hardly different from those for which the lists were made
- t    - load parameter

  Output Parameters:
+ F  - residual of the free dofs (force)
- ok - no element is turned inside out
@*/
PetscErrorCode ModelTwinEvaluate(Model twin, Vec x, PetscReal t, Vec F, PetscBool *ok)
{
  const Problem problem = twin->problem;

  PetscFunctionBeginUser;
  PetscCall(VecCopy(x, twin->x));
  PetscCall(ProblemSetTrial(problem, twin->x, t));
  PetscCall(PetscArraycpy(twin->u, problem->trial, twin->mesh->n_nodes * twin->mesh->dim));
  twin->t = t;
  PetscCall(ProblemResidual(problem, problem->trial, t, t, ok));
  PetscCall(ProblemCollectResidual(problem, twin->x, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}
