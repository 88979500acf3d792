/* A solve with shifted tangents, for load steps that Newton's method fails at. */
#include "modelimpl.h"

/* The first shift is this part of the mean stiffness of the elements at most. That is stiff against any motion of many
   elements together, which is what becomes unstable, and soft against that of one element. */
#define DAMPED_FIRST 1e-2
/* Nor would springs that stiff take more than this part of what the bodies store, if they go on moving as fast for the
   load as before: thin walls are far softer than their elements. It is the part above which the run warns of damping.
 */
#define DAMPED_SHARE 1e-2

/* Chooses the first shift, and finds the elements' mean stiffness. No node is expected to move farther than the one
   that moved the farthest in the last load step, for the same load. */
static PetscErrorCode ChooseFirst(Model model, PetscReal *first, PetscReal *mean)
{
  const Problem   problem = model->problem;
  const PetscReal motion  = model->work->rate * (model->t - model->work->accepted_t);
  PetscReal       stored, moving;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(DofSpringsMean(problem->damping, problem->diagonal, mean));
  *first = DAMPED_FIRST * *mean;
  PetscCall(ProblemEnergy(problem, model->work->accepted_u, model->work->accepted_t, ENERGY_ELASTIC, &stored, &ok));
  PetscCall(DofSpringsMoving(problem->damping, motion, &moving));
  if (ok && stored > 0 && moving > 0) *first = PetscMin(*first, DAMPED_SHARE * stored / moving);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolveDamped - finds a static equilibrium by Newton's method with shifted tangents.

  Collective

  Input Parameters:
+ model  - the model
. start  - begins the load step and sets the first iterate
. solve  - finds the equilibrium of the present problem from the first iterate
- report - costs and failures are added to it

  Note:
  Tangents remain shifted until ModelShiftEnd(), which tells the energy that was taken away. There is no force on the
  bodies but those of the problem, so that what converges is an equilibrium of it.
@*/
PetscErrorCode ModelSolveDamped(Model model, ModelStage start, ModelStage solve, SolveReport *report)
{
  const Problem problem = model->problem;
  PetscReal     first = 0, mean = 0;

  PetscFunctionBeginUser;
  if (!problem->damping) PetscCall(DampingCreate(model->mesh, model->scene, model->x, &problem->damping));
  PetscCall(ChooseFirst(model, &first, &mean));
  PetscCall(ModelShiftBegin(model, first, mean));
  PetscCall((*start)(model, report));
  if (report->result == SOLVE_CONVERGED) PetscCall((*solve)(model, report));
  PetscCall(PetscInfo(model->snes, "solve with shifted tangents: %s\n", SolveResults[report->result]));
  report->damped = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}
