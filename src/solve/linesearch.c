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

/* Before the search: Newton's step with the contact that it ends in; how long Newton's step is; and whether energies
   can tell whether it leads downwards, which where penalties are stiff ends long before the residual is small. */
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
    PetscCall(SNESComputeObjective(snes, x, &energy)); /* none was evaluated since the step began */
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(VecDotRealPart(F, y, &slope));
  ModelChooseObjective(model, NAN, slope);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After it: w is x - cut y, and x - full y is where Newton's step ends. Releases of PETSc differ in whether y is the
 * whole step by now or what is left of it.
 */
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

/* Gaps at x - lambda y, for the line. */
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

/* Where on the line up to `to` the energy is least: contact by its gaps, all else by its tangent at 0, where the slope
   of the sum is `slope` and its curvature by the whole tangent `curvature`. */
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

/* The curvature of the energy along y by the last tangent. */
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

/* Where backtracking cut a step: the place on it where the energy is least, if that is lower. Backtracking stops before
   the first kink that a term which closes puts into the energy, as far from it as its factors will have it; the tangent
   there knows nothing of that term, the next step runs into the same kink, and with stiff penalties the iterates creep
   up to it. The least place is behind the kink. (Sun 1997, Math. Program. 76, 451-467: with exact line searches
   Newton's method for convex piecewise quadratic functions ends after finitely many steps.) */
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

/* ModelLocateEdge - does the failed iterate rest on an edge between facets? Newton's step is to lower the energy, yet
   it rises from the first trifle on, while the normal of a slave point in contact jumps: the edge is the lowest place,
   the forces of the facets on either side push to the edge, and no equilibrium is near.

   Collective, after a failed SNESSolve(). place: a slave node there. */
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

/* ModelCreateLineSearch - what the line search of the model's SNES does where contact cuts a step. Collective. */
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
