/* The line search of Newton's method: what it compares, and how Newton's step is corrected for contact before it. */
#include "bodies/tools.h"
#include "contact/contactturn.h"
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* A step that leads uphill is not turned round where the residual is below this part of F_ref: the step ends at the
   equilibrium that is near. Away from it bodies that can move with next to no energy would go far. An O-ring (quad9,
   full integration, nu 0.4999) that would roll about its own cord takes 25 iterations, and 58 with a failed step if
   such steps are turned. */
#define LINE_NEAR 1e-4
/* A solve with friction has stalled if its residual is still above this part of that LINE_MEMORY iterations before. */
#define LINE_STALL 0.9

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
/* A residual that falls below this part of itself needs no other look at the step: Newton's method converges. */
#define LINE_PLAIN 0.5
/* With friction the work that is done against the residual must fall by this part of what its slope promises. */
#define LINE_FALL 1e-4
/* With friction a step serves after which the same tangent asks for less than this part of it. */
#define LINE_NATURAL 0.5
/* Energies that differ by less than this many machine epsilons of the energy differ by round-off only. */
#define LINE_RISE 64

/* Potential energy at x with that of contact springs and damping; MODEL_INVERTED where an element is inverted. */
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
  PetscCall(DofSpringsEnergy(model->problem->damping, x, objective));
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

/* Computes the part z of Newton's step that mends the residuals F of pressures at nodes alone, and the slope of the
   energy along the rest of the step y. Collective. */
static PetscErrorCode ModelSplitStep(Model model, SNES snes, Vec F, Vec y, Vec z, PetscReal *slope)
{
  const Mesh     mesh = model->mesh;
  const PetscInt n    = mesh->n_nodes * mesh->dim;
  PetscReal     *f, all, mended;
  KSP            ksp;
  Vec            rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &f));
  PetscCall(VecDuplicate(F, &rows));
  PetscCall(MeshGlobalToLocal(mesh, F, f));
  for (PetscInt i = 0; i < n; i++)
    if (!IsPressureNode(mesh, i / mesh->dim)) f[i] = 0;
  PetscCall(MeshCollectFree(mesh, f, rows));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSolve(ksp, rows, z));
  PetscCall(VecAYPX(rows, -1, F)); /* the residuals of displacements */
  PetscCall(VecDotRealPart(rows, y, &all));
  PetscCall(VecDotRealPart(rows, z, &mended));
  *slope = all - mended;
  PetscCall(VecDestroy(&rows));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the residual F is so small that the iterate counts as in equilibrium. */
static PetscErrorCode ModelNearEquilibrium(Model model, Vec F, PetscBool *near)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(F, NORM_2, &norm));
  *near = (PetscBool)(norm <= LINE_NEAR * ProblemForceScale(model->problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the softest motion of a step round, where its stiffness is below 0, if the step leads downhill then. *turned:
   it does. What contact and volumes need is in the rest of the step, and stays. Of 16 O-rings that are squeezed by 30 %
   and pressed by a fluid, one has a failed step instead of four where the whole step is turned. */
static PetscErrorCode ModelTurnSoft(Model model, Vec F, Vec y, PetscReal slope, PetscBool *turned)
{
  PetscReal stiffness, along;
  Vec       soft;

  PetscFunctionBeginUser;
  *turned = PETSC_FALSE;
  if (model->work->hold.wanted) PetscFunctionReturn(PETSC_SUCCESS); /* it is held */
  PetscCall(VecDuplicate(y, &soft));
  PetscCall(ModelSoftPart(model, y, soft, &stiffness));
  PetscCall(VecDotRealPart(F, soft, &along));
  *turned = (PetscBool)(stiffness < 0 && slope - 2 * along > 0);
  if (*turned) PetscCall(VecAXPY(y, -2, soft));
  PetscCall(VecDestroy(&soft));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns a step round that leads uphill, unless an equilibrium is near and the search has found no other way. Where the
   tangent is indefinite, Newton's step may lead to a saddle of the energy, and the opposite step leads downhill. With
   loads that follow the surface the work of the residual stands for the energy. Where nodes have pressures, the part of
   the step that makes up for changes of the volume stays as it is: turned round it would double them. Along the rest
   the linear problem keeps the volume, and its slope is that of the energy of displacements. */
static PetscErrorCode ModelTurnStep(Model model, SNES snes, Vec F, Vec y, PetscReal slope)
{
  PetscBool near = PETSC_FALSE, turned;
  PetscReal rest = slope;
  Vec       z;

  PetscFunctionBeginUser;
  if (slope >= 0 || PetscIsInfOrNanReal(slope)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelNearEquilibrium(model, F, &near));
  if (near && !model->work->relaxed.turns) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(y, &z));
  if (model->mesh->saddle) PetscCall(ModelSplitStep(model, snes, F, y, z, &rest));
  turned = (PetscBool)(rest >= 0);
  if (!turned) PetscCall(ModelTurnSoft(model, F, y, rest, &turned));
  if (!turned && model->mesh->saddle) PetscCall(VecAXPY(y, -2, z));
  if (!turned) PetscCall(VecScale(y, -1));
  PetscCall(VecDestroy(&z));
  if (rest >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->turned++;
  model->work->uphill = (PetscBool)!turned;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the linear step from the iterate x anew, with the contact held that ContactHoldExpected() has begun to hold,
   and ends that. *ok: no element is inverted, and the step was found. It is of no use otherwise. */
static PetscErrorCode ModelSolveHolding(Model model, SNES snes, Vec step, PetscBool *ok)
{
  const Problem problem = model->problem;
  KSP           ksp;
  Vec           b;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(step, &b));
  PetscCall(LinearSolverRenew(model->work->solver));
  PetscCall(ModelTangent(model, problem->trial, NULL, model->t));
  PetscCall(ProblemResidual(problem, problem->trial, model->t, model->t, ok));
  PetscCall(ProblemCollectResidual(problem, model->x, b));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSetOperators(ksp, problem->A, problem->P));
  PetscCall(KSPSolve(ksp, b, step));
  *ok = (PetscBool)(*ok && !LinearCheckLost(model->linear));
  if (*ok) PetscCall(ModelSolveLinearContact(model, problem->trial, NULL, model->t, b, step));
  PetscCall(ContactHoldActiveSet(model->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(VecDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces a step that leads uphill by one in which what pressed at the end of the step before is held, if that leads
   downhill. Where bodies yield, contact alone often holds them, and a tangent without what a step has just missed has
   soft motions to both sides. Turned round, such a step drives the body into what it has missed. */
static PetscErrorCode ModelHoldStep(Model model, SNES snes, Vec F, Vec y, PetscReal *slope)
{
  PetscBool any, ok;
  PetscReal held;
  Vec       step;

  PetscFunctionBeginUser;
  if (*slope >= 0 || !model->contact || !ProblemIsPlastic(model->problem)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactHoldExpected(model->contact, PETSC_FALSE, &any));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(y, &step));
  PetscCall(ModelSolveHolding(model, snes, step, &ok));
  PetscCall(VecDotRealPart(F, step, &held));
  PetscCall(PetscInfo(snes, "a step that leads uphill is made anew with contact held: slope %g\n", (double)held));
  if (ok && held > 0) {
    PetscCall(VecCopy(step, y));
    *slope = held;
  } else
    PetscCall(ContactDropExpected(model->contact));
  PetscCall(VecDestroy(&step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces a step with friction whose contact problem has not been solved by one in which what pressed at the end of
   the step before is held, if that is shorter. The step before has missed what it was to press, because bodies turn. A
   tangent without that lets a sheet between tools go far, and next to all its contact changes on the way. A steel sheet
   of 1 mm that is drawn to a channel takes 170 iterations for the first 3.8 mm in place of 279. A longer step leads
   away: that of a brake block that sticks, past a snap, to an equilibrium that is not stable. A step whose solution
   goes farther than the terms were chosen for, twice, stays as it is. */
static PetscErrorCode ModelHoldUnsettled(Model model, SNES snes, Vec y)
{
  PetscReal length, held;
  PetscBool any, ok;
  Vec       step;

  PetscFunctionBeginUser;
  if (!model->work->unsettled || model->work->beyond) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactHoldExpected(model->contact, PETSC_TRUE, &any));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(y, &step));
  PetscCall(ModelSolveHolding(model, snes, step, &ok));
  PetscCall(VecNorm(y, NORM_2, &length));
  PetscCall(VecNorm(step, NORM_2, &held));
  PetscCall(PetscInfo(snes,
                      "a step with unsettled contact is made anew with contact held, %ssettled: %g of its length\n",
                      model->work->unsettled ? "not " : "", (double)(held / length)));
  if (ok && held < length)
    PetscCall(VecCopy(step, y));
  else {
    PetscCall(ContactDropExpected(model->contact));
    model->work->unsettled = PETSC_TRUE;
  }
  PetscCall(VecDestroy(&step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes whether the last iterations of a solve with friction have hardly lowered the residual. The contact problem of a
   linear step may then be one whose answer leads to and fro over a kink, as where a roller passes from node to node. As
   long as that is so, it is not relaxed. */
static PetscErrorCode ModelFindStall(Model model, SNESLineSearch search)
{
  ModelWork *work = model->work;
  SNES       snes;
  PetscInt   iterate;
  PetscReal  norm;
  Vec        F;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESGetIterationNumber(snes, &iterate));
  if (!ContactHasFriction(model->contact) || iterate < LINE_MEMORY) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(VecNorm(F, NORM_2, &norm));
  work->stalled = (PetscBool)(norm > LINE_STALL * work->norms[iterate % LINE_MEMORY]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes Newton's step so that its contact is right at its end, and chooses the objective anew from the slope of the
   energy. A step that leads uphill is turned round, unless residuals are compared: the opposite step raises them. */
static PetscErrorCode ModelMeasureStep(Model model, SNESLineSearch search, Vec x, Vec y)
{
  const PetscBool conservative = ProblemConservative(model->problem);
  SNES            snes;
  PetscReal       slope, energy;
  PetscBool       near = PETSC_FALSE;
  Vec             F;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  if (model->contact) PetscCall(ModelFindStall(model, search));
  PetscCall(SNESLineSearchGetVecs(search, NULL, &F, NULL, NULL, NULL));
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(ModelShiftStep(model, x, F, y));
  if (model->contact && ModelMayRoll(model)) {
    PetscCall(ModelNearEquilibrium(model, F, &near));
    PetscCall(ModelHoldMotion(model, x, F, y, near));
  }
  PetscCall(ModelSolveLinearContact(model, model->problem->trial, NULL, model->t, F, y));
  if (ContactHasFriction(model->contact)) PetscCall(ModelHoldUnsettled(model, snes, y));
  if (model->work->objective == OBJECTIVE_RESIDUAL || ContactHasFriction(model->contact))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (model->contact && conservative && model->work->energy == 0)
    PetscCall(SNESComputeObjective(snes, x, &energy)); /* none was evaluated in this load step */
  PetscCall(VecDotRealPart(F, y, &slope));
  if (model->contact && conservative) ModelChooseObjective(model, NAN, slope);
  if (model->work->objective != OBJECTIVE_ENERGY) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelHoldStep(model, snes, F, y, &slope));
  PetscCall(ModelTurnStep(model, snes, F, y, slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the search: the step is changed and kept, so that a cut of it can be explained. */
static PetscErrorCode ModelPrepareStep(SNESLineSearch search, Vec x, Vec y, PetscBool *changed, void *context)
{
  Model model = context;

  PetscFunctionBeginUser;
  *changed = PETSC_TRUE;
  PetscCall(ModelMeasureStep(model, search, x, y));
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

/* A search where friction leaves no energy: the parts 1, 1/2, 1/4, ... of the step, and the residuals there. */
typedef struct {
  SNESLineSearch search;
  PetscReal      first;                    /* the part that is tried first */
  PetscReal      slope, before, largest;   /* F . y; norm of F, and the largest of the last iterates */
  PetscReal      norm[LINE_HALVINGS + 2];  /* of the residual; PETSC_MAX_REAL where an element is inverted */
  PetscReal      along[LINE_HALVINGS + 2]; /* residual . y */
  int            known;                    /* parts that have been evaluated */
} Halvings;

/* Evaluates the residual at part i of the step, in w and G. */
static PetscErrorCode EvaluatePart(Halvings *h, int i)
{
  const PetscReal lambda = h->first / (1 << i);
  SNES            snes;
  PetscBool       inverted;
  Vec             x, F, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(h->search, &snes));
  PetscCall(SNESLineSearchGetVecs(h->search, &x, &F, &y, &w, &G));
  PetscCall(VecWAXPY(w, -lambda, y, x));
  PetscCall(SNESComputeFunction(snes, w, G));
  PetscCall(SNESGetFunctionDomainError(snes, &inverted));
  PetscCall(VecNorm(G, NORM_2, &h->norm[i]));
  PetscCall(VecDotRealPart(G, y, &h->along[i]));
  if (inverted || PetscIsInfOrNanReal(h->norm[i])) h->norm[i] = PETSC_MAX_REAL;
  h->known = PetscMax(h->known, i + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The farthest that a step may move a node: what contact lists are made for, or the largest mean face of a slave. */
static PetscErrorCode MostMotion(Model model, PetscReal *most)
{
  PetscFunctionBeginUser;
  *most = model->problem->expected;
  for (int p = 0; p < ContactPairs(model->contact); p++) {
    const MeshGroup *slave;
    PetscReal        size;

    PetscCall(ContactPairSurface(model->contact, p, &slave, &size));
    *most = PetscMax(*most, size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of the step x - y that is tried first: all that the search allows, unless it turns a tool too far, or moves
   a body past all that the contact knows. Where all that touches a tool slips, little resists its turn, and a linear
   step would spin it. Of a body that slips along its load nothing is left but weak springs: a linear step carries it
   off, to where it has no contact and only its load is out of balance. One that has gone farther than that since the
   accepted state has left its contact. It is not held back: the springs then tell that nothing else holds it. */
static PetscErrorCode FirstPart(Model model, SNESLineSearch search, Vec x, Vec y, PetscReal *first)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *u, *v, turn, motion, gone, most;
  Vec            end;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetDamping(search, first));
  PetscCall(PetscCalloc2(n, &u, n, &v));
  PetscCall(VecDuplicate(x, &end));
  PetscCall(VecWAXPY(end, -1, y, x));
  PetscCall(ProblemDisplacements(model->problem, x, model->t, u));
  PetscCall(ProblemDisplacements(model->problem, end, model->t, v));
  turn = ToolsTurn(model->mesh, u, v, NULL);
  if (turn * *first > MODEL_FARTHEST) *first = MODEL_FARTHEST / turn;
  PetscCall(ProblemMotion(model->problem, u, model->t, v, model->t, &motion));
  PetscCall(MostMotion(model, &most));
  if (motion * *first > most) {
    PetscCall(ProblemMotion(model->problem, model->work->accepted_u, model->work->accepted_t, u, model->t, &gone));
    if (gone <= most) *first = most / motion;
  }
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates what is missing to judge part i of the step. *serves: the residual falls to less than LINE_PLAIN of itself,
   or the work that is done against it on the way, by Simpson's rule, is that of an energy that falls. *stands: w and G
   are those of part i. */
static PetscErrorCode PartServes(Halvings *h, int i, PetscBool *serves, PetscBool *stands)
{
  const PetscReal lambda = h->first / (1 << i);
  PetscReal       rise;

  PetscFunctionBeginUser;
  *stands = (PetscBool)(h->known <= i);
  if (*stands) PetscCall(EvaluatePart(h, i));
  *serves = (PetscBool)(h->norm[i] < LINE_PLAIN * h->before);
  if (*serves || h->norm[i] == PETSC_MAX_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  if (h->known <= i + 1) PetscCall(EvaluatePart(h, i + 1));
  *stands = PETSC_FALSE;
  rise    = -lambda / 6 * (h->slope + 4 * h->along[i + 1] + h->along[i]);
  *serves = (PetscBool)(h->norm[i + 1] < PETSC_MAX_REAL && rise <= -LINE_FALL * lambda * h->slope);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether Newton's method converges from the end of the step x - y, although neither residual nor work falls on
   the way: the step that the same tangent asks for there is less than LINE_NATURAL of y. A soft motion along a bend is
   such a step. What is stiff across it is out of balance at its end by the square of the step, and the next step
   corrects that. Source: Deuflhard, the natural monotonicity test, Newton Methods for Nonlinear Problems, 2004. */
static PetscErrorCode EndServes(Model model, Halvings *h, PetscBool *serves)
{
  PetscReal whole, next;
  PetscBool direct;
  SNES      snes;
  KSP       ksp;
  Vec       x, F, y, w, G, z;

  PetscFunctionBeginUser;
  *serves = PETSC_FALSE;
  PetscCall(LinearSolverDirect(model->work->solver, &direct));
  if (!direct || h->first < 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESLineSearchGetSNES(h->search, &snes));
  PetscCall(SNESLineSearchGetVecs(h->search, &x, &F, &y, &w, &G));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(EvaluatePart(h, 0));
  if (h->norm[0] == PETSC_MAX_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(y, &z));
  PetscCall(KSPSolve(ksp, G, z));
  PetscCall(VecNorm(y, NORM_2, &whole));
  PetscCall(VecNorm(z, NORM_2, &next));
  PetscCall(PetscInfo(snes, "the next step is %g of this one\n", (double)(next / whole)));
  *serves = (PetscBool)(next < LINE_NATURAL * whole);
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the largest part of the step after which the residual is below the largest of the last iterates, or else that
   with the least residual. */
static PetscErrorCode LeastResidual(Halvings *h, int *best)
{
  PetscFunctionBeginUser;
  *best = 0;
  for (int i = 0; i <= LINE_HALVINGS; i++) {
    if (h->known <= i) PetscCall(EvaluatePart(h, i));
    if (h->norm[i] < h->norm[*best]) *best = i;
    if (h->norm[i] < h->largest) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the part of the step: the first of 1, 1/2, 1/4, ... that serves. *stands: w and G are those of that part. A
   step of no length, which only asks for new contact lists, is taken. */
static PetscErrorCode ChoosePart(Model model, Halvings *h, int *best, PetscBool *stands)
{
  PetscBool serves = PETSC_FALSE, end = PETSC_FALSE;
  PetscReal length;
  Vec       y;

  PetscFunctionBeginUser;
  *best   = 0;
  *stands = PETSC_FALSE;
  PetscCall(SNESLineSearchGetVecs(h->search, NULL, NULL, &y, NULL, NULL));
  PetscCall(VecNorm(y, NORM_2, &length));
  if (length == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i <= LINE_HALVINGS && h->slope > 0 && !serves; i++)
    PetscCall(PartServes(h, *best = i, &serves, stands));
  if (serves && *best == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(EndServes(model, h, &end));
  *stands = end;
  if (end) *best = 0;
  if (!end && !serves) PetscCall(LeastResidual(h, best));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the part of the step at which the search stands: w and G are those there. */
static PetscErrorCode EndSearch(const Halvings *h, PetscReal part)
{
  PetscBool changed, changed_w;
  Vec       x, F, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetVecs(h->search, &x, &F, &y, &w, &G));
  PetscCall(SNESLineSearchPostCheck(h->search, x, y, w, &changed, &changed_w));
  PetscCall(VecCopy(w, x));
  PetscCall(VecCopy(G, F));
  PetscCall(SNESLineSearchSetLambda(h->search, part));
  PetscCall(SNESLineSearchComputeNorms(h->search));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The search where friction leaves no energy. It takes the first of the steps 1, 1/2, 1/4, ... on which the work that
   is done against the residual falls as an energy would. Residuals alone mislead it: where bodies flow plastically, or
   what sticks begins to slip, they rise on the way to an equilibrium, and fall on a way to states in which all slips.
   Where no work falls they decide. A search that asked for less of them at each iterate would stop where a node changes
   between sticking and slipping: there the residual has a kink, and may rise to either side. */
static PetscErrorCode ModelSearchWork(SNESLineSearch search, void *context)
{
  Model      model = context;
  ModelWork *work  = model->work;
  Halvings   h     = {.search = search};
  PetscBool  changed, stands;
  PetscReal  part;
  PetscInt   iterate;
  int        best;
  SNES       snes;
  Vec        x, F, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESGetIterationNumber(snes, &iterate));
  PetscCall(SNESLineSearchGetVecs(search, &x, &F, &y, &w, &G));
  PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED));
  PetscCall(SNESLineSearchPreCheck(search, x, y, &changed));
  PetscCall(FirstPart(model, search, x, y, &h.first));
  PetscCall(VecNorm(F, NORM_2, &h.before));
  PetscCall(VecDotRealPart(F, y, &h.slope));
  work->norms[iterate % LINE_MEMORY] = h.before;
  for (int i = 0; i < PetscMin(iterate + 1, LINE_MEMORY); i++) h.largest = PetscMax(h.largest, work->norms[i]);
  if (h.slope > 0 && ProblemIsPlastic(model->problem)) {
    PetscCall(ModelSearchSlope(model, search, h.slope, h.first, &part));
    if (part > 0) {
      PetscCall(EndSearch(&h, part));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  PetscCall(ChoosePart(model, &h, &best, &stands));
  if (h.norm[best] == PETSC_MAX_REAL) {
    PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_FAILED_REDUCT));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!stands) PetscCall(EvaluatePart(&h, best));
  PetscCall(EndSearch(&h, h.first / (1 << best)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCreateLineSearch - gives the line search of the model's SNES its objective and the correction of Newton's
  step for contact.

  Collective

  Input Parameter:
. model - its SNES has its line search

  Note:
  With follower loads there is no energy. The search then takes the work of the residual for it, with friction too.
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
    search, ContactHasFriction(model->contact) ? ModelSearchWork : ModelSearchRelaxed, model));
  PetscCall(SNESLineSearchSetPreCheck(search, ModelPrepareStep, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
