/* The line search of Newton's method: what it compares, and longer steps where contact cuts them. */
#include "modelimpl.h"
#include "base/timing.h"

/* Energy of a state with an inverted element. It is above that of any other state, and its square, which the line
   search forms, is still a number. */
#define LINE_INVERTED 1e100
/* Below this residual, relative to F_ref, the energies that the line search compares differ by round-off only, because
   their differences go with the square of the residual. From there on residuals are compared. */
#define LINE_ENERGY_ROUND_OFF 1e-6
/* The line search expects an energy that falls by a part of its slope. A residual is multiplied by this weight, so that
   any decrease of it is enough. */
#define LINE_RESIDUAL_WEIGHT 1e30
/* The least energy is sought on up to this many times the length to which backtracking cut the step. The last length
   that backtracking refused was at most ten times as long. */
#define LINE_AHEAD 10
/* A step longer than this part of the full one has not been cut, because backtracking cuts by a half or more. */
#define LINE_UNCUT 0.75
/* Over this part of Newton's step nothing changes but what jumps. */
#define LINE_TRIFLE 1e-3
/* Energies that differ by less than this many machine epsilons of the energy differ by round-off only. */
#define LINE_RISE 64
/* Bisections for the least energy. There are that many because a stiff penalty bends the energy within a small part of
   the step. */
#define LINE_BISECTIONS 50

/* Potential energy at x with that of the contact springs; LINE_INVERTED where an element is inverted. */
static PetscErrorCode ObjectiveEnergy(Model model, Vec x, PetscReal *objective)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_POTENTIAL, objective, &ok));
  if (ok)
    model->work->energy = *objective;
  else
    *objective = LINE_INVERTED;
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

/* Before the search: changes Newton's step so that its contact is right at its end, measures its length, and chooses
   the objective anew from the slope of the energy. */
static PetscErrorCode ModelMeasureStep(SNESLineSearch search, Vec x, Vec y, PetscBool *changed, void *context)
{
  Model     model = context;
  SNES      snes;
  Vec       F;
  PetscReal slope, energy;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ModelSolveLinearContact(model, model->problem->trial, NULL, model->t, y));
  *changed = PETSC_TRUE;
  PetscCall(VecNorm(y, NORM_2, &model->work->step));
  if (model->work->objective == OBJECTIVE_RESIDUAL || !LoadsConservative(model->problem->loads))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  if (model->work->energy == 0)
    PetscCall(SNESComputeObjective(snes, x, &energy)); /* none was evaluated in this load step */
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(VecDotRealPart(F, y, &slope));
  ModelChooseObjective(model, NAN, slope);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After the search: w is x - cut y, and Newton's step ends at x - full y. PETSc's releases differ in whether y is now
   the whole step or what is left of it. */
static PetscErrorCode StepLength(Model model, Vec x, Vec y, Vec w, PetscReal *cut, PetscReal *full)
{
  PetscReal xy, wy, yy;

  PetscFunctionBeginUser;
  PetscCall(VecDotRealPart(x, y, &xy));
  PetscCall(VecDotRealPart(w, y, &wy));
  PetscCall(VecDotRealPart(y, y, &yy));
  *cut  = yy > 0 ? (xy - wy) / yy : 1;
  *full = yy > 0 ? model->work->step / PetscSqrtReal(yy) : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the line the gaps at x - lambda y. */
static PetscErrorCode LinePlace(Model model, int place, PetscReal lambda, Vec x, Vec y, Vec w)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(w, -lambda, y, x));
  PetscCall(ProblemSetTrial(model->problem, w, model->t));
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(ContactLineSet(model->work->line, place, lambda, model->problem->trial, model->t));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the place on the line, between 0 and `to`, where the energy is least. The contact energy is taken from the gaps
   on the line, all other energy from its tangent at 0. slope and curvature are those of the whole energy at 0. */
static PetscErrorCode LineLeast(Model model, PetscReal slope, PetscReal curvature, PetscReal to, PetscReal *least)
{
  PetscReal from = 0, start[2], here;

  PetscFunctionBeginUser;
  ContactLineSlope(model->work->line, 0, &start[0], &start[1]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, start, 2, MPIU_REAL, MPI_SUM, model->mesh->comm));
  for (int i = 0; i < LINE_BISECTIONS; i++) {
    *least = 0.5 * (from + to);
    ContactLineSlope(model->work->line, *least, &here, NULL);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &here, 1, MPIU_REAL, MPI_SUM, model->mesh->comm));
    if (here + slope - start[0] + *least * (curvature - start[1]) < 0)
      from = *least;
    else
      to = *least;
  }
  *least = 0.5 * (from + to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Second derivative of the energy along y, by the last tangent. */
static PetscErrorCode Curvature(Model model, Vec y, PetscReal *curvature)
{
  Vec Ay;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &Ay));
  PetscCall(MatMult(model->problem->A, y, Ay));
  PetscCall(VecDotRealPart(y, Ay, curvature));
  PetscCall(VecDestroy(&Ay));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After backtracking has cut a step: goes to the place on it where the energy is least, if the energy is lower there.

   A term that closes puts a kink into the energy. Backtracking stops before the first kink, at a distance that follows
   from its factors. The tangent there does not contain that term, so that the next step meets the same kink, and with
   stiff penalties the iterates approach it very slowly. The place of least energy is behind the kink. Source: Sun 1997,
   Math. Program. 76, 451-467: with exact line searches Newton's method for convex piecewise quadratic functions ends
   after finitely many steps. */
static PetscErrorCode ModelLengthenStep(SNESLineSearch search, Vec x, Vec y, Vec w, PetscBool *changed_y,
                                        PetscBool *changed_w, void *context)
{
  Model     model = context;
  SNES      snes;
  Vec       F;
  PetscReal cut = 1, full = 1, damping, slope, curvature, ahead, least, before, after;

  PetscFunctionBeginUser;
  *changed_y = *changed_w = PETSC_FALSE;
  PetscCall(SNESLineSearchGetDamping(search, &damping));
  PetscCall(StepLength(model, x, y, w, &cut, &full));
  if (cut > LINE_UNCUT * damping * full || model->work->objective == OBJECTIVE_RESIDUAL)
    PetscFunctionReturn(PETSC_SUCCESS);
  ahead = PetscMin(LINE_AHEAD * cut, damping * full);
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(VecDotRealPart(F, y, &slope));
  PetscCall(SNESComputeObjective(snes, w, &before));
  PetscCall(LinePlace(model, 0, 0, x, y, w));
  PetscCall(LinePlace(model, 1, cut, x, y, w));
  PetscCall(LinePlace(model, 2, ahead, x, y, w));
  PetscCall(Curvature(model, y, &curvature));
  PetscCall(LineLeast(model, -slope, curvature, ahead, &least));
  PetscCall(VecWAXPY(w, -least, y, x));
  PetscCall(SNESComputeObjective(snes, w, &after));
  PetscCall(PetscInfo(snes, "%g of the step instead of %g: energy %.16g instead of %.16g\n", (double)(least / full),
                      (double)(cut / full), (double)after, (double)before));
  *changed_w = PETSC_TRUE;
  if (after < before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecWAXPY(w, -cut, y, x));
  model->work->energy = before;
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
  if (!work->line || !y || work->objective == OBJECTIVE_RESIDUAL) PetscFunctionReturn(PETSC_SUCCESS);
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

/*@
  ModelCreateLineSearch - gives the line search of the model's SNES its objective and what it does where contact cuts a
  step.

  Collective

  Input Parameter:
. model - its SNES has its line search

  Note:
  With follower loads there is no energy. SNES then compares residuals by itself, and steps are not lengthened.
@*/
PetscErrorCode ModelCreateLineSearch(Model model)
{
  SNESLineSearch search;

  PetscFunctionBeginUser;
  if (LoadsConservative(model->problem->loads)) PetscCall(SNESSetObjective(model->snes, ModelObjective, model));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetPreCheck(search, ModelMeasureStep, model));
  if (!LoadsConservative(model->problem->loads)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactLineCreate(model->contact, &model->work->line));
  PetscCall(SNESLineSearchSetPostCheck(search, ModelLengthenStep, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
