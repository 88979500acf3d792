/* The first iterate of Newton's method: a linear step from the accepted or the extrapolated state. */
#include "base/timing.h"
#include "modelimpl.h"

/* A prediction has at most this many pieces. The rest of the way is then taken at once. */
#define PREDICTION_PIECES 8
/* Penalties of softened contact during a prediction in pieces, in automatic penalties. It must turn the bodies back; it
   need not hold them exactly. penaltyramp.c has the same bound. */
#define PREDICTION_SOFT 0.1
/* Where the step after new lists goes too far, this part of the last change of the offsets is left, so many times. */
#define PREDICTION_OFFSETS 0.5
enum { PREDICTION_LESS = 3 };
/* Most repetitions of a run's first step to where a body touches. Each squares the opening, over the radius. */
#define PREDICTION_TOUCHES 3

/* Moves model->x by one linear solve with the present tangent, which is that at (u, t), and the residual in problem->f.
   carried: local displacements that belong to the step besides the free ones; may be NULL. */
static PetscErrorCode ModelStepLinear(Model model, const PetscReal *u, const PetscReal *carried, PetscReal t,
                                      SolveReport *report)
{
  Vec      b, dx;
  KSP      ksp;
  PetscInt its;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &b));
  PetscCall(VecDuplicate(model->x, &dx));
  PetscCall(ProblemCollectResidual(model->problem, model->x, b));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, model->problem->A, model->problem->P));
  PetscCall(ModelReleaseTangent(model));
  if (!model->work->extrapolated) PetscCall(LinearSolverSetPrediction(model->work->solver, PETSC_TRUE));
  PetscCall(KSPSolve(ksp, b, dx));
  if (!model->work->extrapolated) PetscCall(LinearSolverSetPrediction(model->work->solver, PETSC_FALSE));
  PetscCall(KSPGetIterationNumber(ksp, &its));
  report->newton++;
  report->krylov += its;
  if (LinearCheckLost(model->linear)) PetscCall(ModelLinearFailure(model, &report->result));
  PetscCall(ModelShiftSolve(model, u, model->x, b, dx));
  PetscCall(ModelSolveLinearContact(model, u, carried, t, b, dx));
  PetscCall(VecAXPY(model->x, -1, dx));
  PetscCall(ModelStepFrom(model, u));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves model->x from the state (u, t) by one linear solve with the tangent of that state. The loads, imposed
   displacements and tool motions are those at model->t. The step is a Newton iteration in which the whole body follows
   the prescribed displacements. The tangent extrapolates stresses from `reference`, unless that is NULL. With
   holding, terms in contact stay in contact, and with touching terms that touch are in contact, as contact alone may
   hold a body. */
static PetscErrorCode ModelStepLoads(Model model, const PetscReal *u, const StressReference *reference, PetscReal t,
                                     PetscBool holding, PetscBool touching, SolveReport *report)
{
  ModelWork     *work = model->work;
  const PetscInt n    = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *step;
  PetscBool      ok;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &step));
  PetscCall(PetscArraycpy(step, u, n));
  PetscCall(LoadsPrescribe(model->problem->loads, model->t, step));
  for (PetscInt i = 0; i < n; i++) step[i] -= u[i];
  if (holding) PetscCall(ContactHoldActiveSet(model->contact, PETSC_TRUE, touching));
  PetscCall(LinearSolverRenew(work->solver));
  PetscCall(LinearSolverSetStart(work->solver, work->accepted_start));
  if (model->contact) PetscCall(ContactMultiplyBegin(model->contact, step, t, model->t));
  PetscCall(ModelTangent(model, u, reference, t));
  PetscCall(ProblemResidual(model->problem, u, model->t, t, &ok));
  if (holding) PetscCall(ContactMarkPredicted(model->contact));
  PetscCall(ElasticityMultiplyLocal(model->problem->elasticity, step, model->problem->f));
  if (model->contact) PetscCall(ContactMultiplyEnd(model->contact, model->problem->f));
  PetscCall(ModelStepLinear(model, u, step, t, report));
  if (holding) PetscCall(ContactHoldActiveSet(model->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(PetscFree(step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelExtrapolate - extrapolates the accepted states to a load parameter.

  Collective

  Input Parameters:
+ model - the model
- t     - load parameter

  Output Parameters:
+ u      - local displacements u[n_nodes*dim] (length), prescribed ones included
. x      - the free ones of these; set only where smooth
- smooth - the accepted states are so smooth that the extrapolation is better than a step with the tangent
@*/
PetscErrorCode ModelExtrapolate(Model model, PetscReal t, PetscReal *u, Vec x, PetscBool *smooth)
{
  PetscFunctionBeginUser;
  *smooth = PETSC_FALSE;
  if (model->work->extrapolation) PetscCall(ExtrapolationEvaluate(model->work->extrapolation, t, u, smooth));
  if (!*smooth) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LoadsPrescribe(model->problem->loads, t, u));
  PetscCall(MeshCollectFree(model->mesh, u, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes new contact lists at (u, t) on the way, if the present ones do not reach there. */
static PetscErrorCode ModelReachOn(Model model, const PetscReal *u, PetscReal t, SolveReport *report)
{
  PetscReal motion;
  PetscBool ok, within;

  PetscFunctionBeginUser;
  PetscCall(ProblemResidual(model->problem, u, t, t, &ok));
  PetscCall(ContactListsReach(model->contact, &within));
  if (within) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemMotion(model->problem, model->work->accepted_u, model->work->accepted_t, u, t, &motion));
  TimingBegin(TIMING_SEARCH);
  PetscCall(ContactListsRenew(model->contact, u, t, PetscMax(motion, model->problem->expected)));
  TimingEnd(TIMING_SEARCH);
  report->regathered++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the lists again with which the way to model->t begins. */
static PetscErrorCode ModelReturnLists(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ProblemGatherLists(model->problem, model->work->accepted_u, model->work->accepted_t, model->t,
                               model->problem->expected));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes new contact lists at the extrapolated state u, if the present ones do not reach there. A fit from which its
   slave point has slid away sees a rim of its points only: gaps are right, but their variations are those of rounding,
   and so would be the tangent. An extrapolation that loses a slave point behind its master is not used. */
static PetscErrorCode ModelReachExtrapolated(Model model, const PetscReal *u, PetscBool *renewed, SolveReport *report)
{
  const PetscInt before = report->regathered;
  PetscBool      lost   = PETSC_FALSE;

  PetscFunctionBeginUser;
  *renewed = PETSC_FALSE;
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelReachOn(model, u, model->t, report));
  PetscCall(ContactRestore(model->contact)); /* the step holds what was in contact in the accepted state */
  *renewed = (PetscBool)(report->regathered > before);
  if (*renewed) PetscCall(ContactLocateLost(model->contact, &lost, report->detail, sizeof(report->detail)));
  if (lost) model->work->extrapolated = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A linear step from the extrapolated state, which is Newton's first iteration from there. That state is in no
   equilibrium: an extrapolation changes volumes by a little, and what that does to the pressure of stiff ones must not
   get into the tangent, which has that of the accepted state. Three rings on each other (quad9, nu 0.499) take 32
   iterations, and else 299 with two failed steps. Without rubber the tangent is the state's own: a steel sheet whose
   hole is expanded would take 241 iterations instead of 132. work->extrapolated: the step was made and did not go far.
 */
static PetscErrorCode ModelPredictFromExtrapolation(Model model, SolveReport *report)
{
  ModelWork            *work     = model->work;
  const StressReference accepted = {work->solved, 0, 0}, *reference = NULL;
  const PetscInt        n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal            *u, *v, turn;
  PetscBool             renewed = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (work->rubber && !ProblemIsPlastic(model->problem)) reference = &accepted;
  PetscCall(PetscMalloc2(n, &u, n, &v));
  PetscCall(ModelExtrapolate(model, model->t, u, model->x, &work->extrapolated));
  if (work->extrapolated)
    PetscCall(ProblemInOrder(model->problem, work->accepted_u, work->accepted_t, u, model->t, &work->extrapolated));
  if (work->extrapolated) PetscCall(ModelReachExtrapolated(model, u, &renewed, report));
  if (work->extrapolated) {
    PetscCall(ModelStepLoads(model, u, reference, model->t, (PetscBool)(model->contact != NULL), PETSC_FALSE, report));
    PetscCall(ProblemDisplacements(model->problem, model->x, model->t, v));
    PetscCall(ModelLargestTurn(model, u, v, &turn));
    work->extrapolated = (PetscBool)(report->result == SOLVE_CONVERGED && turn <= MODEL_FARTHEST);
  }
  if (renewed && !work->extrapolated) PetscCall(ModelReturnLists(model));
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Repeats the first linear step of a run from where it led to, as long as it counted on contact and has met none:
   closing the gap of a node bends the way, and a body that contact alone holds would be free. The gap that is left is
   quadratic in the one before. */
static PetscErrorCode ModelStepToTouch(Model model, SolveReport *report)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *u;
  PetscBool      ok, missed = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &u));
  for (int k = 0; k < PREDICTION_TOUCHES && missed && report->result == SOLVE_CONVERGED; k++) {
    PetscCall(ProblemDisplacements(model->problem, model->x, model->t, u));
    PetscCall(ProblemResidual(model->problem, u, model->t, model->t, &ok));
    PetscCall(ContactPredictionMissed(model->contact, &missed));
    missed = (PetscBool)(missed && ok);
    if (missed) PetscCall(ModelStepLoads(model, u, NULL, model->t, PETSC_TRUE, PETSC_TRUE, report));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelPredict - computes displacements at model->t by one linear solve, into model->x.

  Collective

  Input Parameters:
+ model  - it stands at the accepted state; the contact lists are those for the way to model->t
- report - costs and failures are added to it

  Note:
  The step starts from the extrapolated state where the accepted states are smooth, else from the accepted state. A
  failure at the extrapolated state is not reported, because a singular tangent there says nothing of the tangent at the
  accepted state.
@*/
PetscErrorCode ModelPredict(Model model, SolveReport *report)
{
  const SolveReport before   = *report;
  const PetscBool   touching = (PetscBool)(model->contact && model->work->settled);

  PetscFunctionBeginUser;
  PetscCall(ModelPredictFromExtrapolation(model, report));
  if (model->work->extrapolated) PetscFunctionReturn(PETSC_SUCCESS);
  *report = before;
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscCall(VecCopy(model->work->accepted_x, model->x));
  PetscCall(ModelStepLoads(model, model->work->accepted_u, NULL, model->work->accepted_t,
                           (PetscBool)(model->contact != NULL), touching, report));
  if (touching && report->result == SOLVE_CONVERGED) PetscCall(ModelStepToTouch(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether displacements u at t are farther from the accepted state than the model is large, and than the step is
   expected to move anything. With friction the pieces of a prediction have all contact softened, and a body that it
   does not hold flies there. Nothing turns it back, and contact lists for such a motion have every face near every
   other. */
static PetscErrorCode ModelFliesAway(Model model, const PetscReal *u, PetscReal t, PetscBool *away)
{
  PetscReal motion;

  PetscFunctionBeginUser;
  *away = PETSC_FALSE;
  if (!model->contact || !ContactHasFriction(model->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemMotion(model->problem, model->work->accepted_u, model->work->accepted_t, u, t, &motion));
  *away = (PetscBool)(motion > PetscMax(model->mesh->size, model->problem->expected));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a prediction with contact: sets model->x to the accepted state if the prediction failed, flies away, has
   inverted an element, or has not found its contact and is farther from balance than that state. Close to a limit of
   the stability that contact gives a linear step goes far, however little the load changes, and its pieces lead away
   from every equilibrium. A tool that leaves by much more than bodies spring back drags them along where the prediction
   holds contact. A prediction that lists do not reach is judged with new ones: in the accepted state what is prescribed
   moves alone, and stiff cells beside it are far from balance. */
static PetscErrorCode ModelStayBehind(Model model, SolveReport *report)
{
  const Problem problem = model->problem;
  PetscReal     here = PETSC_INFINITY, there = PETSC_INFINITY;
  PetscBool     ok = PETSC_FALSE, stands, away = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(problem, model->x, model->t));
  PetscCall(ModelFliesAway(model, problem->trial, model->t, &away));
  if (report->result == SOLVE_CONVERGED && !away) {
    if (model->work->unsettled) PetscCall(ModelResidualAt(model, model->work->accepted_x, &stands, &here));
    PetscCall(ModelResidualAt(model, model->x, &ok, &there));
    if (ok && here < there && there == PETSC_INFINITY) {
      PetscCall(ModelReachOn(model, problem->trial, model->t, report));
      PetscCall(ModelResidualAt(model, model->x, &ok, &there));
    }
  }
  if (ok && !(here < there)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(model->snes, "the prediction goes too far: the step starts from the accepted state\n"));
  PetscCall(VecCopy(model->work->accepted_x, model->x));
  PetscCall(ProblemSetTrial(problem, model->x, model->t));
  PetscCall(ModelReachOn(model, problem->trial, model->t, report));
  ContactForgetLost(model->contact);
  PetscCall(ModelStepFromSolved(model, model->work->accepted_u));
  problem->inverted = -1;
  report->result    = SOLVE_CONVERGED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Repeats the prediction x in pieces, from the accepted state, until the rest of the way is short. all: the contact
   that the first linear step counted on is softened, too. strict: ends where a piece is followed by a longer way than
   before, or fails; then *settled is false. So it is where a piece ends far away. *pieces: those that were made. */
static PetscErrorCode ModelPredictPieces(Model model, Vec x, PetscBool all, PetscBool strict, PetscInt *pieces,
                                         PetscBool *settled, SolveReport *report)
{
  const StressReference reference = {model->work->solved, 0, 0};
  const PetscInt        n         = model->mesh->n_nodes * model->mesh->dim;
  PetscReal             t = model->work->accepted_t, before = PETSC_MAX_REAL, turn, part, *u, *v;
  PetscBool             away = PETSC_FALSE;
  Vec                   from;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &from));
  PetscCall(VecCopy(model->work->accepted_x, from));
  PetscCall(VecCopy(x, model->x));
  PetscCall(PetscCalloc2(n, &u, n, &v));
  PetscCall(PetscArraycpy(u, model->work->accepted_u, n));
  if (model->contact) PetscCall(ContactSoften(model->contact, PREDICTION_SOFT, all));
  *settled = PETSC_FALSE;
  for (*pieces = 0; *pieces < PREDICTION_PIECES && report->result == SOLVE_CONVERGED && !away; ++*pieces) {
    PetscCall(ProblemDisplacements(model->problem, model->x, model->t, v));
    PetscCall(ModelLargestTurn(model, u, v, &turn));
    *settled = (PetscBool)(turn <= MODEL_FARTHEST);
    if (*settled || (strict && turn >= before)) break;
    before = turn;
    part   = MODEL_FARTHEST / turn;
    t += part * (model->t - t);
    PetscCall(VecAXPBY(model->x, 1 - part, part, from));
    PetscCall(VecCopy(model->x, from));
    PetscCall(ProblemDisplacements(model->problem, from, t, u));
    PetscCall(ModelFliesAway(model, u, t, &away));
    if (away) continue;
    if (model->contact) PetscCall(ModelReachOn(model, u, t, report));
    PetscCall(ModelStepLoads(model, u, reference.u ? &reference : NULL, t, PETSC_FALSE, PETSC_FALSE, report));
  }
  if (model->contact) PetscCall(ContactSoften(model->contact, PETSC_MAX_REAL, PETSC_FALSE));
  PetscCall(PetscInfo(model->snes, "prediction in %" PetscInt_FMT " pieces, %s contact softened: %s\n", *pieces,
                      all ? "all" : "new", *settled ? "settled" : "not settled"));
  PetscCall(PetscFree2(u, v));
  PetscCall(VecDestroy(&from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Repeats the prediction x in pieces: first with all contact softened, then, without friction, with the new one alone.
   Each way ends where it grows longer. *far: turn of cells in x, over the largest one. */
static PetscErrorCode ModelPredictStrictly(Model model, Vec x, PetscReal *far, PetscInt *pieces, PetscBool *settled,
                                           SolveReport *report)
{
  const SolveResult result = report->result;
  const int         ways   = ContactHasFriction(model->contact) ? 1 : 2;
  PetscReal         turn, *v;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &v));
  PetscCall(ProblemDisplacements(model->problem, x, model->t, v));
  PetscCall(ModelLargestTurn(model, model->work->accepted_u, v, &turn));
  PetscCall(PetscFree(v));
  *far = turn / MODEL_FARTHEST;
  for (int keep = 0; keep < ways && !*settled; keep++) {
    report->result       = result;
    model->work->softens = (PetscBool)!keep;
    PetscCall(ModelPredictPieces(model, x, !keep, PETSC_TRUE, pieces, settled, report));
    if (!*pieces) model->work->softens = (PetscBool)(ways == 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelPredictFar - repeats the prediction in pieces, where it went too far for one linear step.

  Collective

  Input Parameters:
+ model  - after ModelPredict()
- report - costs and failures are added to it

  Notes:
  Each piece is a part of the way, from which the next linear step continues with the tangent there. None of the states
  on the way is in equilibrium, and their stresses must not get into the tangent. It has those of the accepted
  state, as after a shortened step of Newton's method.

  At first all contact is softened. What is pressed together may then spring back, so that the pieces lead away from
  every equilibrium: a way that is longer after a piece than before it says so. Then the pieces are made anew, and
  contact that the first linear step counted on keeps its penalty. Not so with friction: a linear step takes what sticks
  along, although most of it will slip. If all ways grow longer, the step is too long: it is not begun where a shorter
  one may be tried. Else the first way is gone to its end, with the lists that it began with. An O-ring in space that
  friction holds would be sent 6e6 mm away by the first 2 MPa of a fluid, and lists on the way took minutes.
@*/
PetscErrorCode ModelPredictFar(Model model, SolveReport *report)
{
  const PetscBool   keeps   = (PetscBool)(model->contact && !ContactHasFriction(model->contact));
  const PetscBool   strict  = (PetscBool)(keeps || (model->contact && model->shortens));
  const SolveResult result  = report->result;
  PetscBool         settled = PETSC_FALSE;
  PetscInt          pieces  = 0;
  Vec               x;

  PetscFunctionBeginUser;
  model->work->softens = (PetscBool)!keeps;
  if (model->scene->kinematics == KINEMATICS_SMALL || model->work->extrapolated) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(model->x, &x));
  PetscCall(VecCopy(model->x, x));
  if (strict) PetscCall(ModelPredictStrictly(model, x, &report->far, &pieces, &settled, report));
  if (strict && !settled && model->shortens)
    report->result = SOLVE_FAR;
  else if (!settled) {
    report->result       = result;
    model->work->softens = PETSC_TRUE;
    if (strict) PetscCall(ModelReturnLists(model));
    PetscCall(ModelPredictPieces(model, x, PETSC_TRUE, PETSC_FALSE, &pieces, &settled, report));
  }
  if ((pieces || model->work->unsettled) && model->contact && report->result != SOLVE_FAR)
    PetscCall(ModelStayBehind(model, report));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back to free displacements x if the linear step from there turns cells too far and ends farther from balance
   than it began: bodies roll in it, and no part of it is to be trusted. *back: that was done. */
static PetscErrorCode ModelTakeBack(Model model, Vec x, PetscBool *back)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal      turn, here, there, *u, *v;
  PetscBool      ok, inside;

  PetscFunctionBeginUser;
  *back = PETSC_FALSE;
  PetscCall(PetscMalloc2(n, &u, n, &v));
  PetscCall(ProblemDisplacements(model->problem, x, model->t, u));
  PetscCall(ProblemDisplacements(model->problem, model->x, model->t, v));
  PetscCall(ModelLargestTurn(model, u, v, &turn));
  if (turn > MODEL_FARTHEST) {
    PetscCall(ModelResidualAt(model, model->x, &inside, &there));
    PetscCall(ModelResidualAt(model, x, &ok, &here));
    *back = (PetscBool)(ok && (!inside || here < there));
  }
  if (*back) {
    PetscCall(PetscInfo(model->snes, "new lists: the first step turns cells by %g\n", (double)turn));
    PetscCall(VecCopy(x, model->x));
    PetscCall(ModelStepFromSolved(model, u));
    model->problem->inverted = -1;
  }
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the linear step from the solution at which lists have been replaced, in which contact is held. again: it is
   made once more from the same solution. */
static PetscErrorCode ModelStepHeld(Model model, PetscBool again, SolveReport *report)
{
  const Problem problem = model->problem;
  PetscBool     ok;

  PetscFunctionBeginUser;
  PetscCall(ContactHoldSolved(model->contact, again));
  PetscCall(ModelTangent(model, problem->trial, NULL, model->t));
  PetscCall(ProblemResidual(problem, problem->trial, model->t, model->t, &ok));
  PetscCall(ModelStepLinear(model, problem->trial, NULL, model->t, report));
  PetscCall(ContactHoldActiveSet(model->contact, PETSC_FALSE, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelFollowLists - makes the first iteration after lists have been replaced at a solution, in which contact is held.

  Collective

  Input Parameters:
+ model  - after ProblemRenewLists()
- report - costs and failures are added to it

  Note:
  New lists and their offsets move the surfaces by more than a stiff penalty lets them overlap. Nodes that this would
  open would release the bodies, which would then fly apart. What fewer nodes do not hold any more is tied. Where
  rubber that may roll answers by too long a step, the offsets take a part of their change, and the next solutions
  bring the rest.
@*/
PetscErrorCode ModelFollowLists(Model model, SolveReport *report)
{
  const Problem   problem = model->problem;
  const PetscBool rolls   = ModelMayRoll(model);
  PetscBool       back, tied;
  Vec             x = NULL;

  PetscFunctionBeginUser;
  if (rolls) {
    PetscCall(VecDuplicate(model->x, &x));
    PetscCall(VecCopy(model->x, x));
  }
  if (problem->bodies) {
    PetscCall(FreeBodiesTie(problem->bodies, problem->trial, model->t, model->t, PETSC_FALSE, PETSC_FALSE,
                            problem->springs, &tied));
    PetscCall(ContactSpringsRelax(problem->springs, model->x));
    problem->tied = (PetscBool)(problem->tied || tied);
  }
  PetscCall(ModelStepHeld(model, PETSC_FALSE, report));
  for (int k = 0; rolls && report->result == SOLVE_CONVERGED; k++) {
    PetscCall(ModelTakeBack(model, x, &back));
    if (!back || k == PREDICTION_LESS) break;
    PetscCall(ContactTakeOffsetsPart(model->contact, PREDICTION_OFFSETS, &back));
    if (!back) break;
    PetscCall(ModelStepHeld(model, PETSC_TRUE, report));
  }
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
