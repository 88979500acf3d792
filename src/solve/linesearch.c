/* The line search of Newton's method: what it compares, and how Newton's step is corrected for contact before it. */
#include "modelimpl.h"
#include "contact/contactturn.h"

/* Below this residual, relative to F_ref, the energies that the line search compares differ by round-off only, because
   their differences go with the square of the residual. From there on residuals are compared. */
#define LINE_ENERGY_ROUND_OFF 1e-6
/* PETSc's line search accepts an objective that falls by a part of its slope. The residual is multiplied by this large
   weight. Its decrease then always exceeds that part, so that any decrease is accepted. */
#define LINE_RESIDUAL_WEIGHT 1e30
/* Part of Newton's step over which smooth quantities do not change noticeably. What changes over it is a jump. */
#define LINE_TRIFLE 1e-3
/* With friction a step is shortened to 1 over 2 to this power. */
#define LINE_HALVINGS 5
/* Energies that differ by less than this many machine epsilons of the energy differ by round-off only. */
#define LINE_RISE 64

/* Potential energy at x with that of the contact springs; MODEL_INVERTED where an element is inverted. */
static PetscErrorCode ObjectiveEnergy(Model model, Vec x, PetscReal *objective)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_POTENTIAL, objective, &ok));
  if (ok)
    model->work->energy = *objective;
  else
    *objective = MODEL_INVERTED;
  PetscCall(ContactSpringsEnergy(model->problem->springs, x, objective));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norm of the residual at x, times LINE_RESIDUAL_WEIGHT. */
static PetscErrorCode ObjectiveResidual(Model model, Vec x, PetscReal *objective)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(ProblemCollectResidual(model->problem, x, model->work->residual));
  PetscCall(VecNorm(model->work->residual, NORM_2, objective));
  *objective *= LINE_RESIDUAL_WEIGHT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The objective of SNES: the one that ModelChooseObjective() chose last. */
static PetscErrorCode ModelObjective(SNES snes, Vec x, PetscReal *objective, void *context)
{
  Model model = context;

  PetscFunctionBeginUser;
  (void)snes;
  if (model->work->objective == OBJECTIVE_ENERGY)
    PetscCall(ObjectiveEnergy(model, x, objective));
  else
    PetscCall(ObjectiveResidual(model, x, objective));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelChooseObjective - chooses what the next line search compares: energies or residuals.

  Not collective

  Input Parameters:
+ model    - the model
. residual - norm of the residual at the iterate (force); NaN: not known
- slope    - of the energy along Newton's step; NaN: not known

  Note:
  Newton's convergence test calls this for each iterate with its residual. The line search calls it once more with the
  slope, which may find that energies cannot tell whether the step leads downwards. Where penalties are stiff, that
  happens long before the residual is small.
@*/
void ModelChooseObjective(Model model, PetscReal residual, PetscReal slope)
{
  const PetscBool small = (PetscBool)(residual <= LINE_ENERGY_ROUND_OFF * ProblemForceScale(model->problem));
  const PetscBool flat =
    (PetscBool)(PetscAbsReal(slope) <= LINE_RISE * PETSC_MACHINE_EPSILON * PetscAbsReal(model->work->energy));

  model->work->objective = small || flat ? OBJECTIVE_RESIDUAL : OBJECTIVE_ENERGY;
}

/* Changes Newton's step so that its contact is right at its end, and chooses the objective anew from the slope of the
   energy. Where the tangent is indefinite, Newton's step may lead uphill, to a saddle of the energy. The opposite step
   leads downhill then. With loads that follow the surface the work of the residual stands for the energy. */
static PetscErrorCode ModelMeasureStep(Model model, SNESLineSearch search, Vec x, Vec y)
{
  const PetscBool conservative = ProblemConservative(model->problem);
  SNES            snes;
  Vec             F;
  PetscReal       slope, energy;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ModelSolveLinearContact(model, model->problem->trial, NULL, model->t, y));
  if (model->work->objective == OBJECTIVE_RESIDUAL || ContactHasFriction(model->contact))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  if (conservative && model->work->energy == 0)
    PetscCall(SNESComputeObjective(snes, x, &energy)); /* none was evaluated in this load step */
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(VecDotRealPart(F, y, &slope));
  if (slope < 0) {
    PetscCall(VecScale(y, -1));
    model->work->turned++;
    model->work->uphill = PETSC_TRUE;
  }
  if (conservative) ModelChooseObjective(model, NAN, slope);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the search: the step is changed and kept, so that a cut of it can be explained. */
static PetscErrorCode ModelPrepareStep(SNESLineSearch search, Vec x, Vec y, PetscBool *changed, void *context)
{
  Model model = context;

  PetscFunctionBeginUser;
  *changed = (PetscBool)(model->contact != NULL);
  if (model->contact) PetscCall(ModelMeasureStep(model, search, x, y));
  PetscCall(VecCopy(y, model->work->step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelLocateEdge - finds out whether a failed iterate rests on an edge between facets.

  Collective

  Input Parameter:
. model - after a failed SNESSolve()

  Output Parameters:
+ found - it does
- place - a slave node on such an edge, where found

  Note:
  At such an iterate Newton's step should lower the energy, yet the energy rises over the first LINE_TRIFLE of the step,
  while the normal of a slave point in contact jumps. The edge is then the place of least energy. The facets on both
  sides push the node to the edge, and no equilibrium is near.
@*/
PetscErrorCode ModelLocateEdge(Model model, PetscBool *found, ContactPlace *place)
{
  ModelWork *work = model->work;
  Vec        y, w, F;
  PetscReal *here, before, after, slope;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(SNESGetSolutionUpdate(model->snes, &y));
  if (!model->contact || !ProblemConservative(model->problem) || !y || work->objective == OBJECTIVE_RESIDUAL)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetFunction(model->snes, &F, NULL, NULL));
  PetscCall(VecDotRealPart(F, y, &slope));
  if (!(slope > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(y, &w));
  PetscCall(VecWAXPY(w, -LINE_TRIFLE, y, model->x));
  PetscCall(SNESComputeObjective(model->snes, w, &after));
  PetscCall(SNESComputeObjective(model->snes, model->x, &before));
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &here));
  PetscCall(PetscArraycpy(here, model->problem->trial, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(ProblemSetTrial(model->problem, w, model->t));
  if (after - before > LINE_RISE * PETSC_MACHINE_EPSILON * PetscAbsReal(before))
    PetscCall(ContactLocateTurn(model->contact, here, model->problem->trial, model->t, found, place));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(PetscFree(here));
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norm of the residual at x - lambda y, in w and G. Where an element is inverted it is infinite. */
static PetscErrorCode NormAlong(SNESLineSearch search, PetscReal lambda, PetscReal *norm)
{
  SNES      snes;
  PetscBool inverted;
  Vec       x, F, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESLineSearchGetVecs(search, &x, &F, &y, &w, &G));
  PetscCall(VecWAXPY(w, -lambda, y, x));
  PetscCall(SNESComputeFunction(snes, w, G));
  PetscCall(SNESGetFunctionDomainError(snes, &inverted));
  PetscCall(VecNorm(G, NORM_2, norm));
  if (inverted || PetscIsInfOrNanReal(*norm)) *norm = PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The search where friction leaves no energy: the first of the steps 1, 1/2, 1/4, ... after which the residual is below
   the largest of the last iterates, or else that with the least residual. A search that asked for less at each iterate
   would stop where a node changes between sticking and slipping: there the residual has a kink, and may rise to
   either side. */
static PetscErrorCode ModelSearchResidual(SNESLineSearch search, void *context)
{
  Model      model = context;
  ModelWork *work  = model->work;
  PetscReal  lambda, norm, before, best = PETSC_MAX_REAL, at = 0, largest = 0;
  PetscBool  changed, changed_w;
  PetscInt   iterate;
  SNES       snes;
  Vec        x, F, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESGetIterationNumber(snes, &iterate));
  PetscCall(SNESLineSearchGetVecs(search, &x, &F, &y, &w, &G));
  PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED));
  PetscCall(SNESLineSearchGetDamping(search, &lambda));
  PetscCall(SNESLineSearchPreCheck(search, x, y, &changed));
  PetscCall(VecNorm(F, NORM_2, &before));
  work->norms[iterate % LINE_MEMORY] = before;
  for (PetscInt i = 0; i < PetscMin(iterate + 1, LINE_MEMORY); i++) largest = PetscMax(largest, work->norms[i]);
  for (int i = 0; i <= LINE_HALVINGS; i++, lambda /= 2) {
    PetscCall(NormAlong(search, lambda, &norm));
    if (norm < best) {
      best = norm;
      at   = lambda;
    }
    if (norm < largest) break;
  }
  if (best == PETSC_MAX_REAL) {
    PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_FAILED_REDUCT));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (at != lambda) PetscCall(NormAlong(search, at, &norm));
  PetscCall(SNESLineSearchPostCheck(search, x, y, w, &changed, &changed_w));
  PetscCall(VecCopy(w, x));
  PetscCall(VecCopy(G, F));
  PetscCall(SNESLineSearchSetLambda(search, at));
  PetscCall(SNESLineSearchComputeNorms(search));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCreateLineSearch - gives the line search of the model's SNES its objective and the correction of Newton's
  step for contact.

  Collective

  Input Parameter:
. model - its SNES has its line search

  Note:
  With follower loads there is no energy. The search then takes the work of the residual for it. With friction residuals
  are compared with those of several iterates.
@*/
PetscErrorCode ModelCreateLineSearch(Model model)
{
  SNESLineSearch search, *plain = &model->work->backtracking;

  PetscFunctionBeginUser;
  if (ProblemConservative(model->problem)) PetscCall(SNESSetObjective(model->snes, ModelObjective, model));
  PetscCall(SNESLineSearchCreate(model->mesh->comm, plain));
  PetscCall(SNESLineSearchSetSNES(*plain, model->snes));
  PetscCall(SNESLineSearchSetType(*plain, SNESLINESEARCHBT));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(SNESLineSearchShellSetUserFunc(
    search, ContactHasFriction(model->contact) ? ModelSearchResidual : ModelSearchRelaxed, model));
  PetscCall(SNESLineSearchSetPreCheck(search, ModelPrepareStep, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
