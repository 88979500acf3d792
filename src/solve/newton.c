/* Newton's method with the present contact lists: SNES and its convergence test. */
#include "base/refusal.h"
#include "linear/factor.h"
#include "modelimpl.h"

/* Each time the contact set repeats itself, Newton's steps are shortened by this factor. */
#define NEWTON_DAMPING 0.5
/* Steps are shortened this many times in one load step. A contact set that repeats itself once more ends the solve. */
#define NEWTON_MAX_DAMPED 3
/* After this many iterations without a change of the contact set, steps have their full length again. */
#define NEWTON_STEADY 2
/* After a contact set that repeats itself, the springs of free bodies are relaxed at the first iterate whose residual
   is below this multiple of the least one of the repeated sets. */
#define NEWTON_SLACK 2
/* With softened penalties a solve only has to find which nodes touch. This residual, relative to F_ref, is enough. A
   value ten times smaller or three times larger cost a pipe between plates more iterations. */
#define NEWTON_SOFT_ENOUGH 0.1
/* A solve after which contact lists are checked, and are likely to change, only has to find what they will be. This
   residual, relative to F_ref, is enough: new offsets bring ten times as much and more. With 1e-5 an O-ring of first
   order takes 36 instead of 34 iterations. */
#define NEWTON_LOOSELY 1e-4
/* Where several motions are held, what is left besides may be this part of the force that holds them. Their parts of a
   step are long and cancel, and rounding of that keeps what is left above the tolerance. */
#define NEWTON_HELD_REST 1e-4
/* A solve ends after NEWTON_CRAWLS steps in a row of which the line search left less than NEWTON_CRAWL: it does not get
   away from where it is. A tube on a barb (nu 0.5) then takes 447 iterations instead of 677, with the same steps. Where
   there is friction, a tool that little holds may turn by small parts of steps. */
#define NEWTON_CRAWL  0.05
#define NEWTON_CRAWLS 4
/* With friction a solve ends where its least residual has not fallen to NEWTON_STALL of itself within NEWTON_WAITS of
   the iterations that it may take. Of a hundred ordinary scenes none converged after that; in piles of loose bodies,
   where most attempts of long steps fail, it saves a third of what these take. */
#define NEWTON_STALL 0.9
#define NEWTON_WAITS 0.6
/* So does a solve after so many steps in a row of less than this part of its longest one, without a lower residual. The
   contact problem of a linear step may have no end where a body gives way, and none is what is left of the step. */
enum { NEWTON_NULL_STEPS = 2 };
#define NEWTON_NULL 1e-8
/* Where a viscous restraint may help, a solve ends after so many iterations in a row whose tangents are indefinite.
   Newton's method then wanders between equilibria that lie below the one that is lost, and each of them is as good to
   it as the one to which the bodies would move. Where it comes to one at once, it has taken fewer. */
#define NEWTON_UNSTABLE 6
/* Newton's method is limited by its iterations, not by this number of evaluations in the line search. */
#define NEWTON_MAX_FUNCTIONS 1000000

/* The function of SNES: the residual F of the free dofs at x. */
static PetscErrorCode ModelFunction(SNES snes, Vec x, Vec F, void *context)
{
  Model     model = context;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(ProblemCollectResidual(model->problem, x, F));
  if (!ok) PetscCall(SNESSetFunctionDomainError(snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelStepFrom - tells that a linear step from a state has led to the iterate. The next tangent extrapolates stresses
  from there.

  Not collective

  Input Parameters:
+ model - the model
- u     - local displacements u[n_nodes*dim] (length) of that state
@*/
PetscErrorCode ModelStepFrom(Model model, const PetscReal *u)
{
  PetscFunctionBeginUser;
  model->work->shortened = model->work->uphill = PETSC_FALSE;
  if (model->work->extrapolates)
    PetscCall(PetscArraycpy(model->work->from, u, model->mesh->n_nodes * model->mesh->dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelStepFromSolved - tells that the iterate is a state in equilibrium.

  Not collective

  Input Parameters:
+ model - the model
- u     - local displacements u[n_nodes*dim] (length) of that state
@*/
PetscErrorCode ModelStepFromSolved(Model model, const PetscReal *u)
{
  PetscFunctionBeginUser;
  PetscCall(ModelStepFrom(model, u));
  if (model->work->extrapolates)
    PetscCall(PetscArraycpy(model->work->solved, u, model->mesh->n_nodes * model->mesh->dim));
  if (model->contact) ContactForgetForeseen(model->contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the number of the present iteration, and the part of the step before it that was taken. */
static PetscErrorCode ModelLastStep(Model model, PetscInt *iteration, PetscReal *lambda)
{
  SNESLineSearch search;

  PetscFunctionBeginUser;
  PetscCall(SNESGetIterationNumber(model->snes, iteration));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchGetLambda(search, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The state from which the tangent at the present iterate extrapolates stresses. It is the iterate before, since
   pressure changes along a full step as the step's linear problem says. Before the first iterate that is where the
   prediction started. A shortened step has left the volumes somewhere; its pressures are those of the last equilibrium.
   *part: of the step, that was taken. */
static PetscErrorCode ModelReference(Model model, StressReference *reference, PetscReal *part)
{
  ModelWork *work = model->work;
  PetscInt   iteration;
  PetscReal  lambda;

  PetscFunctionBeginUser;
  PetscCall(ModelLastStep(model, &iteration, &lambda));
  if (iteration > 0) work->shortened = (PetscBool)(lambda < 1 && !work->relaxed.linear);
  *reference = work->shortened ? (StressReference){work->solved, 0, 0} : (StressReference){work->from, 1, 0};
  *part      = iteration > 0 && !work->shortened ? lambda : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the multipliers of incompressible bodies take part in Newton's iteration: their pressures become those of the
   linear step that led to the iterate, and the residual of SNES is that of these pressures. They have changed already
   where the iterate is a solution. */
static PetscErrorCode ModelFollow(Model model, Vec x, StressReference *reference, PetscReal part)
{
  Vec F;

  PetscFunctionBeginUser;
  if (!ElasticityAugments(model->problem->elasticity)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!model->work->augmented) {
    PetscCall(ElasticityFollow(model->problem->elasticity, model->problem->trial, reference, part));
    PetscCall(SNESGetFunction(model->snes, &F, NULL, NULL));
    PetscCall(ModelFunction(model->snes, x, F, model));
  }
  model->work->augmented = PETSC_FALSE;
  reference->held        = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the shift of the tangent at x. */
static PetscErrorCode ModelShift(Model model, Vec x)
{
  PetscInt  iteration;
  PetscReal lambda;

  PetscFunctionBeginUser;
  PetscCall(ModelLastStep(model, &iteration, &lambda));
  PetscCall(ModelShiftNext(model, x, iteration, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets the pressures that the last linear step was to lead to where a motion is held and a fluid presses. The body
   goes along the motion as far as its search finds right, and what the fluid wets changes on the way: what the step
   foresaw is far from where it ends. A coarse O-ring in space (30 %, then 4 MPa of fluid) takes 14 steps, 1 failed, and
   343 iterations; with the pressures foreseen, it failed at 1.1 MPa after 985. A thin ring that is crumpled, without a
   fluid, needs them. */
static void ModelForgetWhereHeld(Model model)
{
  if (model->contact && model->work->hold.wanted && model->problem->fluids) ContactForgetForeseen(model->contact);
}

/* The Jacobian of SNES: the tangent at x. */
static PetscErrorCode ModelJacobian(SNES snes, Vec x, Mat J, Mat P, void *context)
{
  Model           model = context;
  StressReference reference;
  PetscReal       part = 1;
  PetscBool       extrapolates;

  PetscFunctionBeginUser;
  (void)snes;
  (void)J;
  (void)P;
  PetscCall(ModelShift(model, x));
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  ModelForgetWhereHeld(model);
  extrapolates = (PetscBool)(model->work->extrapolates && !model->work->uphill);
  if (extrapolates) {
    PetscCall(ModelReference(model, &reference, &part));
    PetscCall(ModelFollow(model, x, &reference, part));
  }
  PetscCall(ModelTangent(model, model->problem->trial, extrapolates ? &reference : NULL, model->t));
  PetscCall(ModelReleaseTangent(model));
  PetscCall(ModelStepFrom(model, model->problem->trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for the states from which stresses are extrapolated, if elements do that. The tangent that PETSc is to
   test against differences must be their limit. */
static PetscErrorCode ModelCreateReference(Model model)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscBool      test;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_test_jacobian", &test));
  model->work->foresees = (PetscBool)!test;
  if (test) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ElasticityExtrapolates(model->problem->elasticity, &model->work->extrapolates, &model->work->rubber));
  if (model->work->extrapolates) PetscCall(PetscCalloc2(n, &model->work->solved, n, &model->work->from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the solve when a slave point has left its lists, if new lists may still be made in this step. That is not a
   failure. */
static PetscErrorCode ModelLeaveLists(Model model, SNESConvergedReason *reason)
{
  PetscBool within;

  PetscFunctionBeginUser;
  PetscCall(ContactListsReach(model->contact, &within));
  within = (PetscBool)(within && !(model->work->shift.on && model->work->shift.wanted > 0));
  if (within || model->work->renewed >= ModelShiftIterations(model, MODEL_MAX_REGATHER))
    PetscFunctionReturn(PETSC_SUCCESS);
  model->work->left = PETSC_TRUE;
  *reason           = SNES_CONVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Relaxes the springs of free bodies at an iterate of a contact set that repeats itself. A body with play on two sides
   touches now one of them and now the other: each step takes it as far as its springs, which are weak, ask for, and the
   contact that it meets there sends it back. The springs are no part of the problem, and where they are without a force
   the body may rest. */
static PetscErrorCode ModelRelaxSprings(Model model, Vec x, Vec F)
{
  ModelWork *work = model->work;
  PetscReal  norm;

  PetscFunctionBeginUser;
  if (work->slack == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecNorm(F, NORM_2, &norm));
  if (!(norm <= work->slack)) PetscFunctionReturn(PETSC_SUCCESS);
  work->slack         = 0;
  work->relaxed.waits = PETSC_FALSE;
  PetscCall(ContactSpringsSlacken(model->problem->springs, x));
  PetscCall(ModelFunction(model->snes, x, F, model));
  PetscCall(PetscInfo(model->snes, "springs relaxed at a repeated contact set\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shortens Newton's steps when the contact set repeats itself. The iterates then stop between the states of the cycle
   and leave it. If they do not, the solve ends. */
static PetscErrorCode ModelBreakCycle(Model model, PetscReal fnorm, SNESConvergedReason *reason)
{
  ModelWork     *work = model->work;
  PetscInt       period, steady;
  SNESLineSearch search;

  PetscFunctionBeginUser;
  PetscCall(ContactCycleLook(work->watch, fnorm, &period, &steady));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  if (steady >= NEWTON_STEADY) PetscCall(SNESLineSearchSetDamping(search, work->damping));
  if (!period) PetscFunctionReturn(PETSC_SUCCESS);
  if (model->problem->springs) work->slack = NEWTON_SLACK * ContactCycleLeast(work->watch, period);
  PetscCall(ContactCycleLocate(work->watch, period, work->cycle, sizeof(work->cycle)));
  PetscCall(PetscInfo(model->snes, "%s\n", work->cycle));
  PetscCall(ContactCycleStart(work->watch));
  PetscCall(SNESLineSearchSetDamping(search, work->damping * PetscPowRealInt(NEWTON_DAMPING, ++work->cycles)));
  if (work->cycles <= NEWTON_MAX_DAMPED) PetscFunctionReturn(PETSC_SUCCESS);
  work->cycling = PETSC_TRUE;
  *reason       = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve that crawls. A step along a soft motion that is taken as far as cells may turn is no sign of that. Where
   bodies yield, steps are short while the yielding zone finds its place, and grow again: a strip bent into a die takes
   12 load steps, and 20 with four failed ones if such solves end. */
static PetscErrorCode ModelStopCrawl(Model model, SNESConvergedReason *reason)
{
  ModelWork     *work = model->work;
  SNESLineSearch search;
  PetscReal      lambda;

  PetscFunctionBeginUser;
  if (work->relaxed.linear || ProblemIsPlastic(model->problem) || ContactHasFriction(model->contact))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchGetLambda(search, &lambda));
  work->crawls = lambda < NEWTON_CRAWL ? work->crawls + 1 : 0;
  if (work->crawls == NEWTON_CRAWLS) *reason = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve with friction whose residuals do not fall any more. They may rise for long where what sticks begins to
   slip, so that the last of them tells nothing, but the least of them does. */
static PetscErrorCode ModelStopStall(Model model, PetscInt it, PetscReal step, PetscReal fnorm,
                                     SNESConvergedReason *reason)
{
  ModelWork *work = model->work;
  PetscBool  lower;
  PetscInt   most;

  PetscFunctionBeginUser;
  if (!ContactHasFriction(model->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  lower         = (PetscBool)(it == 0 || fnorm < NEWTON_STALL * work->least);
  work->longest = it == 0 ? 0 : PetscMax(work->longest, step);
  work->nulls   = lower || step > NEWTON_NULL * work->longest ? 0 : work->nulls + 1;
  if (lower) {
    work->least    = fnorm;
    work->least_at = it;
  }
  PetscCall(SNESGetTolerances(model->snes, NULL, NULL, NULL, &most, NULL));
  if (it - work->least_at > NEWTON_WAITS * most || work->nulls == NEWTON_NULL_STEPS) {
    work->stuck = PETSC_TRUE;
    *reason     = SNES_DIVERGED_MAX_IT;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends a solve that wanders where equilibrium is not stable, if a restraint may help then. Nodes with pressures have
   negative eigenvalues of their own. */
static PetscErrorCode ModelStopUnstable(Model model, SNESConvergedReason *reason)
{
  ModelWork *work = model->work;
  PetscInt   negatives;

  PetscFunctionBeginUser;
  if (!model->doubts || model->mesh->saddle || !ProblemConservative(model->problem)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearSolverNegatives(work->solver, &negatives));
  if (negatives >= 0) work->indefinite = negatives ? work->indefinite + 1 : 0;
  if (work->indefinite < NEWTON_UNSTABLE) PetscFunctionReturn(PETSC_SUCCESS);
  work->unstable = PETSC_TRUE;
  *reason        = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The convergence test of SNES. A solve has converged when its residual is small against the forces that balance in it,
   or is round-off only. It is never measured against its own first value. Where penalties follow the penetrations, the
   penetrations must have settled too. */
static PetscErrorCode ModelConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                     SNESConvergedReason *reason, void *context)
{
  Model           model = context;
  const PetscReal scale = ProblemForceScale(model->problem);
  PetscReal       round_off, tolerance, allowed;
  PetscReal       force;
  PetscBool       converged = PETSC_TRUE, holds = PETSC_TRUE;
  Vec             x, F;

  PetscFunctionBeginUser;
  PetscCall(SNESGetSolution(snes, &x));
  (void)xnorm;
  if (it > 0) PetscCall(ModelCountCut(model, x));
  PetscCall(ProblemRoundOff(model->problem, &round_off));
  PetscCall(SNESGetFunction(snes, &F, NULL, NULL));
  if (it > 0) PetscCall(ModelRelaxSprings(model, x, F));
  PetscCall(ModelHeldResidual(model, F, &fnorm, &force));
  if (model->contact) PetscCall(ContactGapsConverged(model->contact, &converged));
  *reason = SNES_CONVERGED_ITERATING;
  ModelChooseObjective(model, fnorm, NAN);
  tolerance = PetscMax(model->scene->solver.tolerance * scale, round_off);
  allowed   = tolerance;
  if (model->work->nearly < 0 && !model->work->soft && converged &&
      fnorm <= PetscMax(NEWTON_LOOSELY * scale, tolerance))
    model->work->nearly = it;
  if (model->work->loosely) allowed = PetscMax(NEWTON_LOOSELY * scale, tolerance);
  if (model->work->soft) allowed = PetscMax(NEWTON_SOFT_ENOUGH * scale, round_off);
  if (model->work->hold.known > 1) allowed = PetscMax(allowed, NEWTON_HELD_REST * force);
  if (fnorm <= PetscMax(NEWTON_LOOSELY * scale, allowed) && force != 0) PetscCall(ModelJudgeHeld(model, &holds));
  if (!holds) fnorm = PetscSqrtReal(PetscSqr(fnorm) + PetscSqr(force));
  model->work->balanced = holds && fnorm <= allowed ? PETSC_TRUE : PETSC_FALSE;
  if (!it && model->work->start == 0 && !model->work->soft) model->work->start = fnorm;
  PetscCall(LinearSolverSetEnough(model->work->solver, model->work->soft ? allowed : tolerance));
  if (it > 0 && LinearCheckLost(model->linear))
    *reason = SNES_DIVERGED_LINEAR_SOLVE;
  else if (PetscIsInfOrNanReal(fnorm))
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
  else if (fnorm <= round_off || (model->work->balanced && (converged || model->work->soft)))
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (model->contact)
    PetscCall(ModelLeaveLists(model, reason));
  if (model->contact && !*reason) PetscCall(ModelBreakCycle(model, fnorm, reason));
  if (it > 0 && !*reason && model->work->hold.futile && ModelMayDrag(model)) *reason = SNES_DIVERGED_LINE_SEARCH;
  if (it > 0 && !*reason && !model->work->shift.on) PetscCall(ModelStopCrawl(model, reason));
  if (it > 0 && !*reason && !model->work->shift.on) PetscCall(ModelStopUnstable(model, reason));
  if (!*reason && !model->work->shift.on) PetscCall(ModelStopStall(model, it, snorm, fnorm, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the first message of an error, in context: char[256], instead of printing its trace. */
static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *context)
{
  char *kept = context;

  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  (void)type;
  if (message && message[0] && !kept[0]) snprintf(kept, 256, "%.*s", (int)strcspn(message, "\n"), message);
  return code;
}

/* FactorCheckOptions() in the form that ModelReadOptions() calls. */
static PetscErrorCode CheckFactorOptions(SNES snes)
{
  (void)snes;
  return FactorCheckOptions();
}

/* Reads some of PETSc's options. A value that PETSc refuses is wrong input and is refused as such. The ranks agree on
   it, because some values are wrong on one rank only, for example a file that rank 0 cannot open. */
static PetscErrorCode ModelReadOptions(Model model, PetscErrorCode (*read)(SNES))
{
  char           message[256] = "", text[400];
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(KeepMessage, message));
  code = read(model->snes);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscSNPrintf(text, sizeof(text),
                          "a PETSc option (command line, environment or the scene's petsc) was refused: %s", message));
  PetscCall(RefuseInputAnywhere(model->mesh->comm, code ? text : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCreateSNES - creates Newton's method with its line search, its linear solver and the check of linear solves.

  Collective

  Input Parameter:
. model - it has its problem

  Note:
  PETSc's options are read here and override the scene. Options that PETSc refuses are refused as wrong input.
@*/
PetscErrorCode ModelCreateSNES(Model model)
{
  const PetscBool symmetric = ProblemConservative(model->problem);
  SNESLineSearch  search;
  KSP             ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESCreate(model->mesh->comm, &model->snes));
  PetscCall(SNESSetType(model->snes, SNESNEWTONLS));
  PetscCall(SNESSetFunction(model->snes, NULL, ModelFunction, model));
  PetscCall(SNESSetJacobian(model->snes, model->problem->A, model->problem->P, ModelJacobian, model));
  PetscCall(SNESSetTolerances(model->snes, 0, 0, 0, model->scene->solver.max_iterations, NEWTON_MAX_FUNCTIONS));
  PetscCall(SNESSetConvergenceTest(model->snes, ModelConverged, model, NULL));
  PetscCall(SNESSetErrorIfNotConverged(model->snes, PETSC_FALSE));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(ModelCreateLineSearch(model));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(ModelReadOptions(model, CheckFactorOptions));
  PetscCall(LinearSolverCreate(ksp, model->mesh, model->scene, symmetric, &model->work->solver));
  PetscCall(ModelReadOptions(model, SNESSetFromOptions));
  PetscCall(
    LinearCheckCreate(ksp, model->scene->solver.tolerance, LinearSolverKept(model->work->solver), &model->linear));
  PetscCall(SNESLineSearchGetDamping(search, &model->work->damping));
  PetscCall(ModelCreateReference(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelLinearFailure - finds out why the last linear solve failed.

  Not collective, the same on all ranks

  Input Parameter:
. model - after a failed linear solve

  Output Parameter:
. result - SOLVE_WORKSPACE where the direct solver ran out of memory, else SOLVE_LINEAR
@*/
PetscErrorCode ModelLinearFailure(Model model, SolveResult *result)
{
  KSP            ksp;
  PC             pc;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetFailedReason(pc, &reason));
  *result = reason == PC_FACTOR_OUTMEMORY ? SOLVE_WORKSPACE : SOLVE_LINEAR;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc's reason for the end of a solve in the model's words. */
static SolveResult ResultFromReason(SNESConvergedReason reason)
{
  if (reason > 0) return SOLVE_CONVERGED;
  switch (reason) {
  case SNES_DIVERGED_MAX_IT: return SOLVE_ITERATIONS;
  case SNES_DIVERGED_FUNCTION_DOMAIN: return SOLVE_DOMAIN;
  case SNES_DIVERGED_LINEAR_SOLVE: return SOLVE_LINEAR;
  case SNES_DIVERGED_FUNCTION_NANORINF: return SOLVE_NAN;
  default: return SOLVE_LINE_SEARCH;
  }
}

/* Lets SNES solve. A solve that goes on has the iterations that it has left. */
static PetscErrorCode ModelIterate(Model model)
{
  PetscReal absolute, relative, step;
  PetscInt  usual, most, functions;

  PetscFunctionBeginUser;
  PetscCall(SNESGetTolerances(model->snes, &absolute, &relative, &step, &usual, &functions));
  most = ModelShiftIterations(model, usual);
  PetscCall(
    SNESSetTolerances(model->snes, absolute, relative, step, PetscMax(0, most - model->work->begun), functions));
  PetscCall(SNESSolve(model->snes, NULL, model->x));
  PetscCall(SNESSetTolerances(model->snes, absolute, relative, step, usual, functions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelNewton - runs Newton's method once, from model->x, with the present contact lists.

  Collective

  Input Parameters:
+ model  - with a first iterate in model->x
- report - costs and failures are added to it

  Output Parameters:
+ model  - model->x and problem->trial are the last iterate
- report - report->result says how the solve ended

  Note:
  A solve that ended because a slave point left its lists counts as converged, with work->left set. So does a line
  search without success whose residual is within the tolerance: the gaps have then settled as far as round-off lets
  them.
@*/
PetscErrorCode ModelNewton(Model model, SolveReport *report)
{
  SNESConvergedReason reason;
  PetscInt            its, krylov;
  PetscReal           norm;
  Vec                 F;
  SNESLineSearch      search;

  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&model->work->tangent_x)); /* contact lists may be others than those of the last tangent */
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetDamping(search, model->work->damping));
  if (model->contact) PetscCall(ContactCycleStart(model->work->watch));
  model->work->turned           = 0;
  model->work->crawls           = 0;
  model->work->indefinite       = 0;
  model->work->slack            = 0;
  model->work->unstable         = PETSC_FALSE;
  model->work->stuck            = PETSC_FALSE;
  model->work->stalled          = PETSC_FALSE;
  model->work->relaxed.waits    = PETSC_FALSE;
  model->work->relaxed.turns    = PETSC_FALSE;
  model->work->relaxed.farthest = MODEL_FARTHEST;
  ModelHeldBeginSolve(model);
  PetscCall(PetscArrayzero(model->work->cuts, CUT_CAUSES));
  PetscCall(ModelIterate(model));
  PetscCall(SNESGetConvergedReason(model->snes, &reason));
  PetscCall(SNESGetIterationNumber(model->snes, &its));
  PetscCall(SNESGetLinearSolveIterations(model->snes, &krylov));
  PetscCall(SNESGetFunction(model->snes, &F, NULL, NULL));
  PetscCall(VecNorm(F, NORM_2, &norm));
  report->newton += its;
  report->krylov += krylov;
  for (int cause = 0; cause < CUT_CAUSES; cause++) report->cuts[cause] += model->work->cuts[cause];
  report->turned += model->work->turned;
  report->result = ResultFromReason(reason);
  if (model->work->cycling) report->result = SOLVE_CYCLE;
  if (model->work->unstable) report->result = SOLVE_UNSTABLE;
  if (model->work->stuck) report->result = SOLVE_STALLED;
  if (report->result == SOLVE_LINE_SEARCH && model->work->balanced) report->result = SOLVE_CONVERGED;
  if (report->result == SOLVE_LINEAR ||
      (report->result != SOLVE_CONVERGED && its > 0 && LinearCheckLost(model->linear)))
    PetscCall(ModelLinearFailure(model, &report->result));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t)); /* SNES may have evaluated another point last */
  if (report->result == SOLVE_CONVERGED && !model->work->soft && !model->work->left && !model->work->loosely)
    PetscCall(ModelStepFromSolved(model, model->problem->trial));
  report->residual = model->problem->force > 0 ? norm / ProblemForceScale(model->problem) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
