#include "linear/factor.h"
#include "modelimpl.h"
#include "base/refusal.h"
#include "matrix/sumoperator.h"
#include "base/timing.h"

/* Energy of a state with an inverted element: above any other, yet its square is a number, which the line search takes.
 */
#define MODEL_INVERTED 1e100
/* Below this residual (relative to F_ref) the energies that the line search compares differ by round-off only (their
   differences go with the square of the residual); from there on it compares residuals. */
#define MODEL_ENERGY_ROUND_OFF 1e-6
/* Residuals compared as if they were energies: times this, so that any decrease beats the slope the line search
 * expects. */
#define MODEL_RESIDUAL_WEIGHT 1e30
/* Each time the contact set repeats itself Newton's steps become this much shorter, ... */
#define MODEL_DAMPING 0.5
/* ... so often in one load step; a set that repeats itself once more ends it. */
#define MODEL_MAX_DAMPED 3
/* Iterations without any change of the set after which steps have their full length again. */
#define MODEL_STEADY 2
/* The last tangent serves once more where it should end the solve: the next residual is then about twice this one times
   the last contraction (Deuflhard, Newton Methods for Nonlinear Problems, 2004, sec. 2.2, simplified Newton), with a
   factor two for what that does not know. Not that from a first residual, which is mostly stiff motions that any
   tangent takes away: on a plate on a cylinder it promises 200 times too much. */
#define MODEL_TANGENT_REUSE 4
/* With softened penalties a solve is to find what touches, not more: this residual (relative to F_ref) is enough. Ten
   times less or three times more cost a pipe between plates more iterations. */
#define MODEL_SOFT_ENOUGH 0.1
/* Newton is limited by its iterations, not by the line search's evaluations. */
#define MODEL_MAX_FUNCTIONS 1000000

/* Residual at local displacements u into work->f, contact at t_contact, loads at t. ok: every element is in order, on
   all ranks: a line search that hears of a domain error on one rank alone leaves the others waiting. */
PetscErrorCode ModelResidual(Model model, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok)
{
  ModelWork *work   = model->work;
  PetscReal  sum[4] = {0, 0, 0, 0}; /* squares of forces in elements, loads, contact; ranks with an inverted element */
  PetscBool  mine;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(work->f, model->mesh->n_nodes * model->mesh->dim));
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ElasticityResidual(model->elasticity, u, work->f, NULL, &sum[0], &mine));
  PetscCall(LoadsResidual(model->loads, t, u, work->f, NULL, &sum[1]));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  if (!mine) work->inverted = model->mesh->cell_tag[ElasticityInvertedCell(model->elasticity)];
  if (model->contact) {
    TimingBegin(TIMING_ASSEMBLY_CONTACT);
    PetscCall(ContactResidual(model->contact, u, t_contact, work->f, NULL, &sum[2]));
    TimingEnd(TIMING_ASSEMBLY_CONTACT);
  }
  sum[3] = mine ? 0 : 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, model->mesh->comm));
  work->scale = PetscSqrtReal(PetscMax(sum[0], PetscMax(sum[1], sum[2])));
  *ok = sum[3] > 0 ? PETSC_FALSE : PETSC_TRUE; /* on all ranks: line searches act on it without asking the others */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelTrial(Model model, Vec x)
{
  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(model->loads, model->t, model->work->trial));
  PetscCall(MeshGlobalToLocal(model->mesh, x, model->work->trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelFunction(SNES snes, Vec x, Vec F, void *context)
{
  Model     model = context;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ModelTrial(model, x));
  PetscCall(ModelResidual(model, model->work->trial, model->t, model->t, &ok));
  PetscCall(MeshLocalToGlobal(model->mesh, model->work->f, F));
  PetscCall(ContactSpringsResidual(model->work->stabiliser, x, F));
  if (!ok) PetscCall(SNESSetFunctionDomainError(snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Potential energy at the trial displacements, all ranks; out of reach where an element is inverted. */
static PetscErrorCode ModelEnergy(Model model, PetscReal *energy)
{
  PetscReal sum[2] = {0, 0}; /* energy, ranks with an inverted element */
  PetscBool ok;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ElasticityResidual(model->elasticity, model->work->trial, NULL, &sum[0], NULL, &ok));
  PetscCall(LoadsResidual(model->loads, model->t, model->work->trial, NULL, &sum[0], NULL));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  if (model->contact) {
    TimingBegin(TIMING_ASSEMBLY_CONTACT);
    PetscCall(ContactResidual(model->contact, model->work->trial, model->t, NULL, &sum[0], NULL));
    TimingEnd(TIMING_ASSEMBLY_CONTACT);
  }
  sum[1] = ok ? 0 : 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, model->mesh->comm));
  *energy = sum[1] > 0 ? MODEL_INVERTED : sum[0];
  if (!(sum[1] > 0)) model->work->energy = sum[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelObjective(SNES snes, Vec x, PetscReal *objective, void *context)
{
  Model      model = context;
  ModelWork *work  = model->work;
  PetscBool  ok;

  PetscFunctionBeginUser;
  (void)snes;
  PetscCall(ModelTrial(model, x));
  if (!work->near) {
    PetscCall(ModelEnergy(model, objective));
    PetscCall(ContactSpringsEnergy(work->stabiliser, x, objective));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelResidual(model, work->trial, model->t, model->t, &ok));
  PetscCall(MeshLocalToGlobal(model->mesh, work->f, work->residual));
  PetscCall(ContactSpringsResidual(work->stabiliser, x, work->residual));
  PetscCall(VecNorm(work->residual, NORM_2, objective));
  *objective *= MODEL_RESIDUAL_WEIGHT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The contact part C of the tangent at (u, t), with its place in the matrix; how many of its terms are other ones. */
static PetscErrorCode ModelContactTangent(Model model, const PetscReal *u, PetscReal t, Mat *C, PetscBool *changed,
                                          PetscInt *terms)
{
  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(ContactTangent(model->contact, u, t, C, changed));
  if (*changed && model->A == model->P) PetscCall(ElasticityMatrixJoin(model->elasticity, *C));
  PetscCall(ContactTangentChanges(model->contact, terms));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells an older factor which contact terms have come and gone. */
static PetscErrorCode ModelUpdateFactor(Model model, PetscInt terms)
{
  PetscInt   rows;
  PetscReal *s;
  Mat        N;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(model->x, &rows));
  PetscCall(PetscMalloc1(terms, &s));
  PetscCall(ContactChangeVectors(model->contact, rows, terms, s, &N));
  PetscCall(ReusedFactorUpdate(LinearSolverKept(model->work->solver), N, s));
  PetscCall(MatDestroy(&N));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does contact couple so many unknowns that factors of bodies and contact have much more fill than those of bodies? On
   lines it does not. Where PETSc is to test the tangent, or to make its own, all of it is to be in the matrix. */
static PetscErrorCode ModelCouples(Model model, PetscBool *couples)
{
  static const char *const options[] = {"-snes_test_jacobian", "-snes_fd", "-snes_fd_color", "-snes_mf",
                                        "-snes_mf_operator"};

  PetscFunctionBeginUser;
  *couples = (PetscBool)(model->contact && model->mesh->dim == 3 && ContactHasFits(model->contact));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(options) && *couples; i++) {
    PetscBool given;

    PetscCall(PetscOptionsHasName(NULL, NULL, options[i], &given));
    if (given) *couples = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the first tangent: how the solver orders its unknowns, and whether it wants contact apart from the bodies. */
static PetscErrorCode ModelOrder(Model model)
{
  PetscBool couples = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (model->work->ordered || ModelIsLinear(model))
    PetscFunctionReturn(PETSC_SUCCESS); /* a single solve is done sooner with any */
  model->work->ordered = PETSC_TRUE;
  PetscCall(ModelCouples(model, &couples));
  PetscCall(LinearSolverOrder(model->work->solver, model->P, couples));
  if (!LinearSolverBorders(model->work->solver)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&model->A));
  PetscCall(SumOperatorCreate(model->P, &model->A));
  PetscCall(SNESSetJacobian(model->snes, model->A, model->P, NULL, NULL)); /* NULL: as it is */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What contact adds to the tangent stays apart from it: C for products, its terms for the factor. */
static PetscErrorCode ModelBorder(Model model, Mat C)
{
  Border border;

  PetscFunctionBeginUser;
  if (model->A == model->P) PetscFunctionReturn(PETSC_SUCCESS);
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(SumOperatorSet(model->A, C));
  PetscCall(ContactGetBorder(model->contact, &border));
  PetscCall(LinearSolverSetBorder(model->work->solver, &border));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tangent at (u, t) into model->A and model->P. */
PetscErrorCode ModelTangent(Model model, const PetscReal *u, PetscReal t)
{
  Mat       C       = NULL;
  PetscBool changed = PETSC_FALSE, older, joined;
  PetscInt  terms   = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelOrder(model));
  joined = (PetscBool)(model->A == model->P);
  if (model->contact) PetscCall(ModelContactTangent(model, u, t, &C, &changed, &terms));
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ElasticityTangent(model->elasticity, u));
  PetscCall(LoadsTangent(model->loads, t, u, model->elasticity));
  PetscCall(ElasticityMatrix(model->elasticity, joined ? C : NULL, model->work->residual, &model->P));
  PetscCall(VecNorm(model->work->residual, NORM_2, &model->work->stiffness));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ContactSpringsTangent(model->work->stabiliser, model->P));
  PetscCall(ModelBorder(model, C));
  PetscCall(LinearSolverNext(model->work->solver, u, C, (PetscBool)(changed && joined), terms, &older));
  PetscCall(SNESSetLagPreconditioner(model->snes, older ? -1 : 1)); /* after each tangent SNES tells the KSP so */
  if (older && terms > 0) PetscCall(ModelUpdateFactor(model, terms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelJacobian(SNES snes, Vec x, Mat J, Mat P, void *context)
{
  Model model = context;

  PetscFunctionBeginUser;
  (void)snes;
  (void)J;
  (void)P;
  PetscCall(ModelTrial(model, x));
  PetscCall(ModelTangent(model, model->work->trial, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What round-off leaves of the residual at the trial displacements. */
PetscErrorCode ModelRoundOff(Model model, PetscReal *force)
{
  PetscReal most = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->mesh->n_nodes * model->mesh->dim; i++)
    most = PetscMax(most, PetscAbsReal(model->work->trial[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, model->mesh->comm));
  *force = MODEL_ROUND_OFF * PETSC_MACHINE_EPSILON * model->work->stiffness * most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the solve, without being a failure, when a slave point has left its lists, if new ones may still be made in this
 * step. */
static PetscErrorCode ModelLeaveLists(Model model, SNESConvergedReason *reason)
{
  PetscBool within;

  PetscFunctionBeginUser;
  PetscCall(ContactListsReach(model->contact, &within));
  if (within || model->work->renewed >= MODEL_MAX_REGATHER) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->left = PETSC_TRUE;
  *reason           = SNES_CONVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A contact set that repeats itself: shorter steps leave the cycle, as the iterates then stop between its states; if
 * not, the solve ends. */
static PetscErrorCode ModelBreakCycle(Model model, PetscReal fnorm, SNESConvergedReason *reason)
{
  ModelWork     *work = model->work;
  PetscInt       period, steady;
  SNESLineSearch search;

  PetscFunctionBeginUser;
  PetscCall(ContactCycleLook(work->watch, fnorm, &period, &steady));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  if (steady >= MODEL_STEADY) PetscCall(SNESLineSearchSetDamping(search, work->damping));
  if (!period) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactCycleLocate(work->watch, period, work->cycle, sizeof(work->cycle)));
  PetscCall(PetscInfo(model->snes, "%s\n", work->cycle));
  PetscCall(ContactCycleStart(work->watch));
  PetscCall(SNESLineSearchSetDamping(search, work->damping * PetscPowRealInt(MODEL_DAMPING, ++work->cycles)));
  if (work->cycles <= MODEL_MAX_DAMPED) PetscFunctionReturn(PETSC_SUCCESS);
  work->cycling = PETSC_TRUE;
  *reason       = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the tangent and its factors for the next iteration where that will be the last one anyway. norm: of this
 * iterate, allowed: of the last. */
static PetscErrorCode ModelReuseTangent(Model model, PetscInt it, PetscReal norm, PetscReal allowed)
{
  const PetscBool reuse =
    it > 1 && MODEL_TANGENT_REUSE * norm * norm <= allowed * model->work->norm ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(SNESSetLagJacobian(model->snes, reuse ? -1 : 1));
  model->work->norm = reuse ? 0 : norm; /* 0: never twice */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts an iteration that the line search shortened. */
static PetscErrorCode ModelCountCut(Model model, PetscInt it)
{
  SNESLineSearch search;
  PetscReal      lambda;

  PetscFunctionBeginUser;
  if (!it) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchGetLambda(search, &lambda));
  if (lambda < 1) model->work->cuts++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Converged when the residual is small against the forces that balance in it, never against its own first value; or is
   nothing but round-off. Where penalties follow the penetrations, these must have settled too. */
static PetscErrorCode ModelConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                     SNESConvergedReason *reason, void *context)
{
  Model           model = context;
  const PetscReal scale = PetscMax(model->force_scale, model->work->scale);
  PetscReal       round_off, allowed;
  PetscBool       converged = PETSC_TRUE;

  PetscFunctionBeginUser;
  (void)snes;
  (void)xnorm;
  (void)snorm;
  PetscCall(ModelCountCut(model, it));
  PetscCall(ModelRoundOff(model, &round_off));
  if (model->contact) PetscCall(ContactGapsConverged(model->contact, &converged));
  *reason           = SNES_CONVERGED_ITERATING;
  model->work->near = fnorm <= MODEL_ENERGY_ROUND_OFF * scale ? PETSC_TRUE : PETSC_FALSE;
  allowed = PetscMax((model->work->soft ? MODEL_SOFT_ENOUGH : model->scene->solver.tolerance) * scale, round_off);
  model->work->balanced = fnorm <= allowed ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ModelReuseTangent(model, it, fnorm, allowed));
  if (!it && model->work->start == 0 && !model->work->soft) model->work->start = fnorm;
  PetscCall(LinearSolverSetEnough(model->work->solver, allowed));
  if (it > 0 && LinearCheckLost(model->linear))
    *reason = SNES_DIVERGED_LINEAR_SOLVE;
  else if (PetscIsInfOrNanReal(fnorm))
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
  else if (fnorm <= round_off || (model->work->balanced && (converged || model->work->soft)))
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (model->contact)
    PetscCall(ModelLeaveLists(model, reason));
  if (model->contact && !*reason) PetscCall(ModelBreakCycle(model, fnorm, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the first message of an error instead of printing its trace; context: char[256]. */
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

static PetscErrorCode CheckFactorOptions(SNES snes)
{
  (void)snes;
  return FactorCheckOptions();
}

/* Reads some of PETSc's options; a value that PETSc refuses is the user's mistake. */
static PetscErrorCode ModelReadOptions(Model model, PetscErrorCode (*read)(SNES))
{
  char           message[256] = "";
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(KeepMessage, message));
  code = read(model->snes);
  PetscCall(PetscPopErrorHandler());
  if (code)
    PetscCall(RefuseInput(model->mesh->comm,
                          "a PETSc option (command line, environment or the scene's petsc) was refused: %s", message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelCreateSNES(Model model)
{
  const PetscBool symmetric = LoadsConservative(model->loads);
  SNESLineSearch  search;
  KSP             ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESCreate(model->mesh->comm, &model->snes));
  PetscCall(SNESSetType(model->snes, SNESNEWTONLS));
  PetscCall(SNESSetFunction(model->snes, NULL, ModelFunction, model));
  PetscCall(SNESSetJacobian(model->snes, model->A, model->P, ModelJacobian, model));
  if (symmetric) PetscCall(SNESSetObjective(model->snes, ModelObjective, model));
  PetscCall(SNESSetTolerances(model->snes, 0, 0, 0, model->scene->solver.max_iterations, MODEL_MAX_FUNCTIONS));
  PetscCall(SNESSetConvergenceTest(model->snes, ModelConverged, model, NULL));
  PetscCall(SNESSetErrorIfNotConverged(model->snes, PETSC_FALSE));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBT));
  PetscCall(ModelCreateLineSearch(model));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(ModelReadOptions(model, CheckFactorOptions));
  PetscCall(LinearSolverCreate(ksp, model->mesh, model->scene, symmetric, &model->work->solver));
  PetscCall(ModelReadOptions(model, SNESSetFromOptions));
  PetscCall(
    LinearCheckCreate(ksp, model->scene->solver.tolerance, LinearSolverKept(model->work->solver), &model->linear));
  PetscCall(SNESLineSearchGetDamping(search, &model->work->damping));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why the linear solve failed */
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

/* Runs SNES once from model->x and adds what it cost. */
PetscErrorCode ModelNewton(Model model, SolveReport *report)
{
  SNESConvergedReason reason;
  PetscInt            its, krylov;
  PetscReal           norm;
  Vec                 F;
  SNESLineSearch      search;

  PetscFunctionBeginUser;
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetDamping(search, model->work->damping));
  if (model->contact) PetscCall(ContactCycleStart(model->work->watch));
  model->work->cuts = 0;
  PetscCall(SNESSolve(model->snes, NULL, model->x));
  PetscCall(SNESGetConvergedReason(model->snes, &reason));
  PetscCall(SNESGetIterationNumber(model->snes, &its));
  PetscCall(SNESGetLinearSolveIterations(model->snes, &krylov));
  PetscCall(SNESGetFunction(model->snes, &F, NULL, NULL));
  PetscCall(VecNorm(F, NORM_2, &norm));
  report->newton += its;
  report->krylov += krylov;
  report->cuts += model->work->cuts;
  report->result = ResultFromReason(reason);
  if (model->work->cycling) report->result = SOLVE_CYCLE;
  if (report->result == SOLVE_LINE_SEARCH && model->work->balanced)
    report->result = SOLVE_CONVERGED; /* gaps as settled as round-off lets them be */
  if (report->result == SOLVE_LINEAR ||
      (report->result != SOLVE_CONVERGED && its > 0 && LinearCheckLost(model->linear)))
    PetscCall(ModelLinearFailure(model, &report->result));
  PetscCall(ModelTrial(model, model->x)); /* whatever SNES looked at last */
  report->residual = model->work->scale > 0 ? norm / PetscMax(model->force_scale, model->work->scale) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
