/* Twins of a model, see twin.h. */
#include "solve/twin.h"
#include "bodies/tools.h"
#include "modelimpl.h"

/* Lists count as those of the solution where new ones move it by no more than this part of its displacements. Each move
   is some tenth of the one before. */
#define TWIN_SETTLED 1e-8
enum { TWIN_SETTLE = 20 };

/*@
  ModelSettleLists - makes contact lists at the solution and solves on with them, so that a twin can have the same ones.

  Collective

  Input Parameter:
. model - at the solution of a step, before ModelAccept()

  Output Parameters:
+ place - free displacements (length) at which the lists were made
- ok    - the solution with the new lists is found

  Note:
  The lists with which a step was solved were made elsewhere and may differ by what a step tolerates. The solution moves
  by as much.
@*/
PetscErrorCode ModelSettleLists(Model model, Vec place, PetscBool *ok)
{
  SolveReport report = {.result = SOLVE_CONVERGED};
  PetscReal   moved  = PETSC_MAX_REAL, size;
  Vec         move;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  PetscCall(VecCopy(model->x, place));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(place, &move));
  PetscCall(VecNorm(model->x, NORM_2, &size));
  for (int k = 0; k < TWIN_SETTLE && *ok && moved > TWIN_SETTLED * size; k++) {
    PetscCall(VecCopy(model->x, place));
    PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
    PetscCall(ProblemGatherLists(model->problem, model->problem->trial, model->t, model->t, 0));
    model->work->loosely = model->work->soft = model->work->left = PETSC_FALSE;
    PetscCall(LinearSolverRenew(model->work->solver));
    PetscCall(ModelNewton(model, &report));
    *ok = (PetscBool)(report.result == SOLVE_CONVERGED && !model->work->left);
    PetscCall(VecWAXPY(move, -1, place, model->x));
    PetscCall(VecNorm(move, NORM_2, &moved));
  }
  PetscCall(PetscArraycpy(model->u, model->problem->trial, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecDestroy(&move));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
