#include "model.h"
#include "contactcycle.h"
#include "linearsolver.h"
#include "loosebody.h"
#include "matrixsum.h"
#include "refusal.h"
#include "smoother.h"
#include "stabiliser.h"
#include "timing.h"

/* Energy of a state with an inverted element: above any other, yet its square is a number, which the line search takes. */
#define MODEL_INVERTED 1e100
/* Times that contact lists are replaced and the step solved on before it counts as unsettled. */
#define MODEL_MAX_REGATHER 8
/* Of these, so many may be spent at a breakpoint of the scene's histories on offsets of surface contact that lag behind by little: each takes a lag to a
   twentieth, and from the next step on it would show as a jump. */
#define MODEL_MAX_SETTLE 4
/* Times that penalties are adjusted and the step solved on until their window holds. A penalty that starts 1e8 times too small needs four with
   the default clamp, neighbours that share the load two or three more. */
#define MODEL_MAX_ADJUST 12
/* Below this residual (relative to F_ref) the energies that the line search compares differ by round-off only (their differences go with the
   square of the residual); from there on it compares residuals. */
#define MODEL_ENERGY_ROUND_OFF 1e-6
/* Residuals compared as if they were energies: times this, so that any decrease beats the slope the line search expects. */
#define MODEL_RESIDUAL_WEIGHT 1e30
/* Lists are made for this multiple of the motion that the last step's rate predicts; those that check a step too, so that an equal step takes them. */
#define MODEL_MOTION_SAFETY 1.5
/* Each time the contact set repeats itself Newton's steps become this much shorter, ... */
#define MODEL_DAMPING 0.5
/* ... so often in one load step; a set that repeats itself once more ends it. */
#define MODEL_MAX_DAMPED 3
/* Iterations without any change of the set after which steps have their full length again. */
#define MODEL_STEADY 2
/* Times that the springs of stabilised pairs are relaxed. A body at rest needs two or three; one that flies covers its penetration at rest, times a
   thousand, in each. */
#define MODEL_MAX_RELAX 30
/* Round-off of the residual, in machine epsilons times stiffness times displacement: a body that is moved without any force has nothing else
   to be measured against. Measured: 0.1 to 1.5. */
#define MODEL_ROUND_OFF 16
/* Workspace of MUMPS above its estimate, in per cent. Its own 20 is too little for symmetric systems of a few thousand dofs on four ranks. */
#define MODEL_MUMPS_WORKSPACE "100"
/* How MUMPS scales symmetric systems: by the diagonal. Its own choice iterates over rows and columns, which costs a seventh of a factorisation at 10,000
   dofs; stiff penalties stand on the diagonal. */
#define MODEL_MUMPS_SCALING "1"
/* The last tangent serves once more where it should end the solve: the next residual is then about twice this one times the last contraction
   (Deuflhard, Newton Methods for Nonlinear Problems, 2004, sec. 2.2, simplified Newton), with a factor two for what that does not know. */
#define MODEL_TANGENT_REUSE 4
/* Newton is limited by its iterations, not by the line search's evaluations. */
#define MODEL_MAX_FUNCTIONS 1000000

const char *const SolveResults[] = {"converged",
                                    "Newton's method did not converge within solver.max_iterations",
                                    "the line search found no lower energy",
                                    "an element turned inside out",
                                    "the linear system is singular (is a body free to move?) or its solver failed",
                                    "the direct solver ran out of workspace (PETSc option mat_mumps_icntl_14 gives it more)",
                                    "the contact lists did not settle",
                                    "the contact set repeats itself",
                                    "contact was lost behind a master",
                                    "a body that is held by springs only (stabilise) does not come to rest",
                                    "the penetrations did not come into the window of the adjusted penalty",
                                    "not-a-number in the residual"};

typedef struct _n_ModelWork {
  LinearSolver solver;
  PetscReal   *f;     /* local residual of the last evaluation, all dofs */
  PetscReal   *trial; /* local displacements of the last evaluation */
  PetscReal   *accepted_u;
  Vec          accepted_x;
  PetscReal    accepted_t;
  Vec          forecast; /* x at forecast_t by ModelForecast() */
  PetscReal    forecast_t;
  PetscBool    forecasted; /* forecast starts from the accepted state */
  PetscReal    expected;   /* motion that the lists of this step were made for */
  PetscReal    rate;       /* largest displacement per unit of t in the last accepted step */
  PetscReal    scale;      /* force norm of the last evaluation */
  PetscReal    stiffness;  /* norm of the elastic tangent's diagonal */
  PetscInt     inverted;   /* gmsh's tag of a cell of this rank that was turned inside out in this solve, or -1 */
  PetscBool    near;       /* the iterate is so close that energies differ by round-off only */
  PetscReal    norm;       /* residual of the iterate before */
  PetscBool    balanced;   /* the residual of the iterate is within the tolerance */
  PetscInt     renewed;    /* how often that happened in this step */
  PetscBool    cycling;    /* the contact set repeats itself whatever the steps: the solve ended */
  PetscInt     cycles;     /* times it repeated itself in this load step */
  char         cycle[256]; /* the last one in words */
  PetscReal    damping;    /* of the line search when nothing repeats */
  PetscBool    left;       /* a slave point slid out of its lists: the solve ended for new ones */
  PetscInt     cuts;       /* iterations of the last Newton solve that the line search shortened */
  Vec          residual;   /* of a trial point, while near; the tangent's diagonal for a moment */
  Stabiliser   stabiliser; /* NULL: no pair asks for it */
  ContactCycle watch;      /* of the contact set; NULL: no contact */
} ModelWork;

/* ---------- residual, energy, tangent ---------- */

/* Residual at local displacements u into work->f, contact at t_contact, loads at t. ok: every element is in order, on all ranks: a line search that
   hears of a domain error on one rank alone leaves the others waiting. */
static PetscErrorCode ModelResidual(Model model, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok)
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
  *ok         = sum[3] > 0 ? PETSC_FALSE : PETSC_TRUE; /* on all ranks: line searches act on it without asking the others */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelTrial(Model model, Vec x)
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
  PetscCall(StabiliserResidual(model->work->stabiliser, x, F));
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
    PetscCall(StabiliserEnergy(work->stabiliser, x, objective));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelResidual(model, work->trial, model->t, model->t, &ok));
  PetscCall(MeshLocalToGlobal(model->mesh, work->f, work->residual));
  PetscCall(StabiliserResidual(work->stabiliser, x, work->residual));
  PetscCall(VecNorm(work->residual, NORM_2, objective));
  *objective *= MODEL_RESIDUAL_WEIGHT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A = K + C. A new contact pattern makes a new matrix under the old handle, and the solver forgets its symbolic factorisation. */
static PetscErrorCode ModelAddContact(Model model, Mat K, Mat C, PetscBool changed)
{
  KSP ksp;
  Mat B;

  PetscFunctionBeginUser;
  if (changed) {
    PetscCall(MatrixSumCreate(K, C, &B));
    PetscCall(MatHeaderReplace(model->A, &B));
    PetscCall(SNESGetKSP(model->snes, &ksp));
    PetscCall(KSPReset(ksp));
  } else
    PetscCall(MatrixSumUpdate(K, C, model->A));
  PetscCall(MatSetOption(model->A, MAT_SYMMETRIC, LoadsConservative(model->loads)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tangent at (u, t) into model->A. */
static PetscErrorCode ModelTangent(Model model, const PetscReal *u, PetscReal t)
{
  Mat       K, C;
  PetscBool changed;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_ASSEMBLY_ELASTIC);
  PetscCall(ElasticityTangent(model->elasticity, u));
  PetscCall(LoadsTangent(model->loads, t, u, model->elasticity));
  PetscCall(ElasticityMatrix(model->elasticity, &K));
  PetscCall(MatGetDiagonal(K, model->work->residual));
  PetscCall(VecNorm(model->work->residual, NORM_2, &model->work->stiffness));
  TimingEnd(TIMING_ASSEMBLY_ELASTIC);
  if (model->contact) {
    TimingBegin(TIMING_ASSEMBLY_CONTACT);
    PetscCall(ContactTangent(model->contact, u, t, &C, &changed));
    PetscCall(ModelAddContact(model, K, C, changed));
    PetscCall(LinearSolverSetContact(model->work->solver, C, changed));
    PetscCall(StabiliserTangent(model->work->stabiliser, model->A));
    TimingEnd(TIMING_ASSEMBLY_CONTACT);
  }
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
static PetscErrorCode ModelRoundOff(Model model, PetscReal *force)
{
  PetscReal most = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->mesh->n_nodes * model->mesh->dim; i++) most = PetscMax(most, PetscAbsReal(model->work->trial[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, model->mesh->comm));
  *force = MODEL_ROUND_OFF * PETSC_MACHINE_EPSILON * model->work->stiffness * most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the solve, without being a failure, when a slave point has left its lists, if new ones may still be made in this step. */
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

/* A contact set that repeats itself: shorter steps leave the cycle, as the iterates then stop between its states; if not, the solve ends. */
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

/* Keeps the tangent and its factors for the next iteration where that will be the last one anyway. norm: of this iterate, allowed: of the last. */
static PetscErrorCode ModelReuseTangent(Model model, PetscInt it, PetscReal norm, PetscReal allowed)
{
  const PetscBool reuse = it > 0 && MODEL_TANGENT_REUSE * norm * norm <= allowed * model->work->norm ? PETSC_TRUE : PETSC_FALSE;

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

/* Converged when the residual is small against the forces that balance in it, never against its own first value; or is nothing but round-off.
   Where penalties follow the penetrations, these must have settled too. */
static PetscErrorCode ModelConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm, SNESConvergedReason *reason, void *context)
{
  Model           model = context;
  const PetscReal scale = PetscMax(model->force_scale, model->work->scale);
  PetscReal       round_off, allowed;
  PetscBool       settled = PETSC_TRUE;

  PetscFunctionBeginUser;
  (void)snes;
  (void)xnorm;
  (void)snorm;
  PetscCall(ModelCountCut(model, it));
  PetscCall(ModelRoundOff(model, &round_off));
  if (model->contact) PetscCall(ContactGapsSettled(model->contact, &settled));
  *reason               = SNES_CONVERGED_ITERATING;
  model->work->near     = fnorm <= MODEL_ENERGY_ROUND_OFF * scale ? PETSC_TRUE : PETSC_FALSE;
  allowed               = PetscMax(model->scene->solver.tolerance * scale, round_off);
  model->work->balanced = fnorm <= allowed ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ModelReuseTangent(model, it, fnorm, allowed));
  PetscCall(LinearSolverSetEnough(model->work->solver, allowed));
  if (it > 0 && LinearCheckLost(model->linear))
    *reason = SNES_DIVERGED_LINEAR_SOLVE;
  else if (PetscIsInfOrNanReal(fnorm))
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
  else if (fnorm <= round_off || (model->work->balanced && settled))
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (model->contact)
    PetscCall(ModelLeaveLists(model, reason));
  if (model->contact && !*reason) PetscCall(ModelBreakCycle(model, fnorm, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- set-up ---------- */

/* Keeps the first message of an error instead of printing its trace; context: char[256]. */
static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code, PetscErrorType type,
                                  const char *message, void *context)
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

/* PETSc's options for the solver; a value that PETSc refuses is the user's mistake. */
static PetscErrorCode ModelSetFromOptions(Model model)
{
  char           message[256] = "";
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(KeepMessage, message));
  code = SNESSetFromOptions(model->snes);
  PetscCall(PetscPopErrorHandler());
  if (code) PetscCall(RefuseInput(model->mesh->comm, "a PETSc option (command line, environment or the scene's petsc) was refused: %s", message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A value for one of PETSc's options that the user has not given: MUMPS reads them as each new factor is made. */
static PetscErrorCode SetDefaultOption(const char *name, const char *value)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
  if (given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &given)); /* asked for, so that it never counts as one that nobody uses */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelCreateSNES(Model model)
{
  const PetscBool symmetric = LoadsConservative(model->loads);
  SNESLineSearch  search;
  KSP             ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESCreate(model->mesh->comm, &model->snes));
  PetscCall(SNESSetType(model->snes, SNESNEWTONLS));
  PetscCall(SNESSetFunction(model->snes, NULL, ModelFunction, model));
  PetscCall(SNESSetJacobian(model->snes, model->A, model->A, ModelJacobian, model));
  if (symmetric) PetscCall(SNESSetObjective(model->snes, ModelObjective, model));
  PetscCall(SNESSetTolerances(model->snes, 0, 0, 0, model->scene->solver.max_iterations, MODEL_MAX_FUNCTIONS));
  PetscCall(SNESSetConvergenceTest(model->snes, ModelConverged, model, NULL));
  PetscCall(SNESSetErrorIfNotConverged(model->snes, PETSC_FALSE));
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBT));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(LinearSolverCreate(ksp, model->mesh, model->scene, symmetric, &model->work->solver));
  PetscCall(LinearCheckCreate(ksp, model->scene->solver.tolerance, &model->linear));
  PetscCall(SetDefaultOption("-mat_mumps_icntl_14", MODEL_MUMPS_WORKSPACE));
  if (symmetric) PetscCall(SetDefaultOption("-mat_mumps_icntl_8", MODEL_MUMPS_SCALING));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(SNESLineSearchGetDamping(search, &model->work->damping));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelCreate - joins elasticity, loads, contact and the nonlinear solver.

   Collective. scene and mesh are borrowed. The loads come first: they settle which dofs are free. */
PetscErrorCode ModelCreate(Scene scene, Mesh mesh, Model *out)
{
  Model          model;
  const PetscInt n = mesh->n_nodes * mesh->dim;
  Mat            K;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&model));
  PetscCall(PetscNew(&model->work));
  model->scene = scene;
  model->mesh  = mesh;
  PetscCall(LoadsCreate(mesh, scene, &model->loads));
  PetscCall(ElasticityCreate(mesh, scene, &model->elasticity));
  PetscCall(ElasticitySetSymmetric(model->elasticity, LoadsConservative(model->loads)));
  if (scene->n_contacts) PetscCall(ContactCreate(mesh, scene, model->elasticity, model->loads, &model->contact));
  PetscCall(PetscCalloc4(n, &model->u, n, &model->work->f, n, &model->work->trial, n, &model->work->accepted_u));
  PetscCall(ElasticityTangent(model->elasticity, model->u));
  PetscCall(ElasticityMatrix(model->elasticity, &K));
  if (model->contact)
    PetscCall(MatDuplicate(K, MAT_COPY_VALUES, &model->A));
  else {
    PetscCall(PetscObjectReference((PetscObject)K));
    model->A = K;
  }
  PetscCall(MatCreateVecs(model->A, &model->x, NULL));
  PetscCall(VecDuplicate(model->x, &model->work->accepted_x));
  PetscCall(VecDuplicate(model->x, &model->work->forecast));
  PetscCall(VecDuplicate(model->x, &model->work->residual));
  PetscCall(ModelCreateSNES(model));
  if (model->contact) {
    PetscCall(ContactCycleCreate(model->contact, &model->work->watch));
    PetscCall(StabiliserCreate(model->contact, model->x, &model->work->stabiliser));
  }
  *out = model;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelDestroy - Collective. The scene and the mesh remain. */
PetscErrorCode ModelDestroy(Model *model)
{
  Model m = *model;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESDestroy(&m->snes));
  PetscCall(LinearSolverDestroy(&m->work->solver));
  PetscCall(LinearCheckDestroy(&m->linear));
  PetscCall(ContactCycleDestroy(&m->work->watch));
  PetscCall(StabiliserDestroy(&m->work->stabiliser));
  PetscCall(VecDestroy(&m->x));
  PetscCall(VecDestroy(&m->work->accepted_x));
  PetscCall(VecDestroy(&m->work->forecast));
  PetscCall(VecDestroy(&m->work->residual));
  PetscCall(MatDestroy(&m->A));
  PetscCall(ContactDestroy(&m->contact));
  PetscCall(ElasticityDestroy(&m->elasticity));
  PetscCall(LoadsDestroy(&m->loads));
  PetscCall(PetscFree4(m->u, m->work->f, m->work->trial, m->work->accepted_u));
  PetscCall(PetscFree(m->work));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelPlace - displacements, contact lists and gaps at t = 0, as they are: to be looked at before ModelSetUp() judges them. Collective. */
PetscErrorCode ModelPlace(Model model)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(model->loads, 0, model->u));
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGather(model->contact, model->u, 0, 0, 0));
  PetscCall(ModelResidual(model, model->u, 0, 0, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelAssemble - the tangent of the present state into model->A: to see its pattern and its cost without a solve. Collective. */
PetscErrorCode ModelAssemble(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ModelTangent(model, model->u, model->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelSetUp - the state that ModelPlace() made as the first accepted one.

   Collective. Refuses (exit 1) initial overlaps, ContactTakeOverlap(). */
PetscErrorCode ModelSetUp(Model model)
{
  PetscFunctionBeginUser;
  if (model->contact) PetscCall(ContactTakeOverlap(model->contact));
  PetscCall(ModelAccept(model));
  model->work->rate = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- one equilibrium ---------- */

/* Largest displacement of a node, or of a rigid tool, between the accepted state and (u, t). */
static PetscErrorCode ModelMotion(Model model, const PetscReal *u, PetscReal t, PetscReal *motion)
{
  const int dim = model->mesh->dim;

  PetscFunctionBeginUser;
  *motion = 0;
  for (PetscInt n = 0; n < model->mesh->n_nodes; n++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(u[n * dim + d] - model->work->accepted_u[n * dim + d]);
    *motion = PetscMax(*motion, PetscSqrtReal(square));
  }
  for (int b = 0; b < model->scene->n_bodies; b++)
    if (model->scene->bodies[b].rigid) *motion = PetscMax(*motion, LoadsRigidTravel(model->loads, b, model->work->accepted_t, t));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, motion, 1, MPIU_REAL, MPI_MAX, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why the linear solve failed */
static PetscErrorCode ModelLinearFailure(Model model, SolveResult *result)
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

/* Prediction: one linear solve with the tangent of the accepted state, for the loads, imposed displacements and tool motions of the new load
   parameter. It is the first Newton iteration, written so that what is prescribed moves with the whole body and not through it. */
static PetscErrorCode ModelPredict(Model model, SolveReport *report)
{
  ModelWork     *work = model->work;
  const PetscInt n    = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *step;
  PetscBool      ok;
  Vec            b, dx;
  KSP            ksp;
  PetscInt       its;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &b));
  PetscCall(VecDuplicate(model->x, &dx));
  PetscCall(PetscMalloc1(n, &step));
  PetscCall(PetscArraycpy(step, work->accepted_u, n));
  PetscCall(LoadsPrescribe(model->loads, model->t, step));
  for (PetscInt i = 0; i < n; i++) step[i] -= work->accepted_u[i];
  if (model->contact) PetscCall(ContactPredict(model->contact, PETSC_TRUE, (PetscBool)(work->accepted_t == 0))); /* touching: a body that only contact holds */
  PetscCall(LinearSolverRenew(work->solver));
  PetscCall(ModelTangent(model, work->accepted_u, work->accepted_t));
  PetscCall(ModelResidual(model, work->accepted_u, model->t, work->accepted_t, &ok));
  if (model->contact) PetscCall(ContactPredict(model->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(ElasticityMultiplyLocal(model->elasticity, step, work->f));
  if (model->contact) PetscCall(ContactMultiply(model->contact, step, work->accepted_t, model->t, work->f));
  PetscCall(MeshLocalToGlobal(model->mesh, work->f, b));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, model->A, model->A));
  PetscCall(KSPSolve(ksp, b, dx));
  PetscCall(KSPGetIterationNumber(ksp, &its));
  report->newton++;
  report->krylov += its;
  PetscCall(VecAXPY(model->x, -1, dx));
  if (LinearCheckLost(model->linear)) PetscCall(ModelLinearFailure(model, &report->result));
  PetscCall(PetscFree(step));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&dx));
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
static PetscErrorCode ModelNewton(Model model, SolveReport *report)
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
  if (report->result == SOLVE_LINE_SEARCH && model->work->balanced) report->result = SOLVE_CONVERGED; /* gaps as settled as round-off lets them be */
  if (report->result == SOLVE_LINEAR || (report->result != SOLVE_CONVERGED && its > 0 && LinearCheckLost(model->linear)))
    PetscCall(ModelLinearFailure(model, &report->result));
  PetscCall(ModelTrial(model, model->x)); /* whatever SNES looked at last */
  report->residual = model->work->scale > 0 ? norm / PetscMax(model->force_scale, model->work->scale) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has some body elements of that formulation? Rigid tools have none. */
static PetscBool ModelHasFormulation(Scene scene, Formulation formulation)
{
  PetscBool has = PETSC_FALSE;

  for (int b = 0; b < scene->n_bodies; b++) has = (PetscBool)(has || (!scene->bodies[b].rigid && scene->bodies[b].formulation == formulation));
  return has;
}

/* Adds that the penalty is so stiff that rounding alone may keep the residual above the tolerance, where it is. */
static PetscErrorCode ModelBlamePenalty(Model model, char *text, size_t size)
{
  const PetscReal allowed = model->scene->solver.tolerance * PetscMax(model->force_scale, model->work->scale);
  PetscReal       force;
  size_t          used;

  PetscFunctionBeginUser;
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactRoundOff(model->contact, &force));
  PetscCall(PetscStrlen(text, &used));
  if (force > MODEL_ROUND_OFF * allowed)
    PetscCall(PetscSNPrintf(text + used, size - used, "; the penalty is too stiff: rounding of positions alone is a force of %.2g, the tolerance is %.2g",
                            (double)force, (double)allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is known of a failed solve: the bodies that nothing holds where the system is singular, else where to look. */
static PetscErrorCode ModelExplainFailure(Model model, SolveReport *report)
{
  const PetscBool adrift = (PetscBool)(report->result == SOLVE_LINEAR || report->result == SOLVE_ADRIFT);
  char            loose[128];

  PetscFunctionBeginUser;
  PetscCall(FailureLocate(model->mesh, model->loads, model->contact, model->work->f, model->work->inverted, &report->failure));
  report->failure.enhanced = ModelHasFormulation(model->scene, FORMULATION_ENHANCED);
  if (report->result == SOLVE_WINDOW || report->result == SOLVE_LOST) PetscFunctionReturn(PETSC_SUCCESS); /* known already */
  if (report->result == SOLVE_CYCLE) {
    PetscCall(PetscStrncpy(report->detail, report->cycle, sizeof(report->detail)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (adrift) PetscCall(LooseBodies(model->mesh, model->scene, model->loads, loose, sizeof(loose)));
  if (adrift && loose[0])
    PetscCall(PetscSNPrintf(report->detail, sizeof(report->detail), "no support and no imposed displacement holds %s%s", loose,
                            !model->contact || report->result == SOLVE_ADRIFT ? "" : " (contact may, from the start or with stabilise: true)"));
  else {
    FailureText(&report->failure, report->detail, sizeof(report->detail));
    PetscCall(ModelBlamePenalty(model, report->detail, sizeof(report->detail)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the accepted state on the way to t: its contact state, and lists for the motion to be expected. */
static PetscErrorCode ModelDepart(Model model, PetscReal t)
{
  ModelWork *work = model->work;
  PetscReal  motion, *u;

  PetscFunctionBeginUser;
  PetscCall(StabiliserRelax(work->stabiliser, work->accepted_x));
  model->t       = t;
  work->inverted = -1;
  work->cycling  = PETSC_FALSE;
  work->cycles   = 0;
  work->cycle[0] = '\0';
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &u));
  PetscCall(PetscArraycpy(u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(LoadsPrescribe(model->loads, t, u));
  PetscCall(ModelMotion(model, u, t, &motion));
  PetscCall(PetscFree(u));
  motion = PetscMax(motion, MODEL_MOTION_SAFETY * work->rate * (t - work->accepted_t));
  PetscCall(ContactRestore(model->contact));
  work->expected = motion;
  TimingBegin(TIMING_SEARCH);
  PetscCall(ContactGather(model->contact, work->accepted_u, work->accepted_t, t, motion));
  TimingEnd(TIMING_SEARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where Newton's method starts: at a forecast that has been made, in proportion to the way; else it is made now. */
static PetscErrorCode ModelStart(Model model, SolveReport *report)
{
  ModelWork *work = model->work;
  PetscReal  part;

  PetscFunctionBeginUser;
  if (!work->forecasted) {
    PetscCall(ModelPredict(model, report));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  part = (model->t - work->accepted_t) / (work->forecast_t - work->accepted_t);
  PetscCall(VecAXPBYPCZ(model->x, 1 - part, part, 0, work->accepted_x, work->forecast));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New lists after a solve, for the next one: in the middle of the way where it left the old ones, or because they do not hold. */
static PetscErrorCode ModelRenewLists(Model model, PetscBool settle, PetscBool *hold)
{
  ModelWork *work = model->work;
  PetscReal  motion;

  PetscFunctionBeginUser;
  PetscCall(ModelMotion(model, work->trial, model->t, &motion));
  if (motion > work->expected) motion *= 2; /* two bodies that the lists at the start did not let meet may have passed through each other */
  TimingBegin(TIMING_SEARCH);
  *hold = PETSC_FALSE;
  if (work->left) {
    work->renewed++;
    PetscCall(ContactListsRenew(model->contact, work->trial, model->t, motion));
  } else
    PetscCall(ContactListsHold(model->contact, work->trial, model->t, motion, settle, hold));
  TimingEnd(TIMING_SEARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves with frozen lists until they hold. */
static PetscErrorCode ModelSolveLists(Model model, SolveReport *report)
{
  PetscBool hold = PETSC_FALSE, lost = PETSC_FALSE;
  PetscInt  times = 0;

  PetscFunctionBeginUser;
  model->work->renewed = 0;
  while (!hold && report->result == SOLVE_CONVERGED) {
    model->work->left = PETSC_FALSE;
    PetscCall(ModelNewton(model, report));
    if (report->result != SOLVE_CONVERGED || !model->contact) break;
    PetscCall(ModelRenewLists(model, (PetscBool)(times < MODEL_MAX_SETTLE && model->t < 1 && SceneBreaks(model->scene, model->t)), &hold));
    PetscCall(ContactLocateLost(model->contact, &lost, report->detail, sizeof(report->detail)));
    if (lost) report->result = SOLVE_LOST;
    if (hold || lost) break;
    report->regathered++;
    if (!model->work->left && times++ == MODEL_MAX_REGATHER) report->result = SOLVE_LISTS;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy in elements and contact at the trial displacements, all ranks */
static PetscErrorCode ModelStoredEnergy(Model model, PetscReal *energy)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  *energy = 0;
  PetscCall(ElasticityResidual(model->elasticity, model->work->trial, NULL, energy, NULL, &ok));
  PetscCall(ContactResidual(model->contact, model->work->trial, model->t, NULL, energy, NULL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves, with springs where pairs are stabilised; these are relaxed and all is solved on until they carry nothing. */
static PetscErrorCode ModelSolveHeld(Model model, SolveReport *report)
{
  ModelWork *work = model->work;
  PetscReal  force, energy, stored, allowed;
  PetscInt   times = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelSolveLists(model, report));
  while (work->stabiliser && report->result == SOLVE_CONVERGED) {
    PetscCall(StabiliserLoad(work->stabiliser, model->x, &force, &energy));
    PetscCall(ModelStoredEnergy(model, &stored));
    report->taken += energy;
    report->left = stored > 0 ? energy / stored : 0;
    PetscCall(ModelRoundOff(model, &allowed));
    allowed = PetscMax(allowed, model->scene->solver.tolerance * PetscMax(model->force_scale, work->scale));
    if (force <= allowed) break;
    if (times++ == MODEL_MAX_RELAX) {
      report->result = SOLVE_ADRIFT;
      break;
    }
    report->relaxed++;
    PetscCall(StabiliserRelax(work->stabiliser, model->x));
    PetscCall(ModelSolveLists(model, report));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelSolve - equilibrium at load parameter t, from the accepted state.

   Collective. On success model->u, model->x and the contact state are the solution (not yet accepted); on failure call ModelRestore().
   Contact lists are made before, frozen in each Newton solve, and made anew after it until they hold (at most MODEL_MAX_REGATHER times); then
   penalties that are adjusted within the step, and all is solved on from there, until their window holds (at most MODEL_MAX_ADJUST times). */
PetscErrorCode ModelSolve(Model model, PetscReal t, SolveReport *report)
{
  ModelWork         *work   = model->work;
  ContactWindowState window = WINDOW_MISSED;

  PetscFunctionBeginUser;
  *report = (SolveReport){.result = SOLVE_CONVERGED};
  PetscCall(ModelDepart(model, t));
  PetscCall(ModelStart(model, report));
  while (window == WINDOW_MISSED && report->result == SOLVE_CONVERGED) {
    PetscCall(ModelSolveHeld(model, report));
    if (report->result != SOLVE_CONVERGED || !model->contact) break;
    if (report->adjusted == MODEL_MAX_ADJUST) PetscCall(ContactLocateOutside(model->contact, report->detail, sizeof(report->detail)));
    PetscCall(ContactAdjustPenalty(model->contact, &window));
    if (window == WINDOW_AT_BOUND) PetscCall(ContactLocateOutside(model->contact, report->detail, sizeof(report->detail)));
    if (window == WINDOW_AT_BOUND || (window == WINDOW_MISSED && report->adjusted++ == MODEL_MAX_ADJUST)) report->result = SOLVE_WINDOW;
  }
  report->cycles = work->cycles;
  PetscCall(PetscStrncpy(report->cycle, work->cycle, sizeof(report->cycle)));
  if (report->result == SOLVE_CONVERGED)
    PetscCall(PetscArraycpy(model->u, work->trial, model->mesh->n_nodes * model->mesh->dim));
  else
    PetscCall(ModelExplainFailure(model, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelForecast - displacements at t by one linear solve from the accepted state with its contact set, as a guess of what will touch.

   Collective. u[n_nodes*dim]: local displacements (length), prescribed ones included. Costs and failures are added to the report; the state is
   the accepted one afterwards, the contact lists are made for the way to t. The next ModelSolve() starts from the forecast instead of a
   prediction of its own, so that the solve is paid once. */
PetscErrorCode ModelForecast(Model model, PetscReal t, PetscReal *u, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ModelDepart(model, t));
  PetscCall(ModelPredict(model, report));
  PetscCall(ModelTrial(model, model->x));
  PetscCall(PetscArraycpy(u, model->work->trial, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(model->x, model->work->forecast));
  PetscCall(VecCopy(model->work->accepted_x, model->x));
  model->work->forecast_t = t;
  model->work->forecasted = report->result == SOLVE_CONVERGED ? PETSC_TRUE : PETSC_FALSE;
  model->t                = model->work->accepted_t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelGetAccepted - local displacements (length, n_nodes*dim, the model's) and load parameter of the accepted state. Not collective. */
PetscErrorCode ModelGetAccepted(Model model, const PetscReal **u, PetscReal *t)
{
  PetscFunctionBeginUser;
  *u = model->work->accepted_u;
  *t = model->work->accepted_t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- state ---------- */

/* ModelAccept - the present solution is the state to go on from and to return to. Collective. */
PetscErrorCode ModelAccept(Model model)
{
  ModelWork      *work    = model->work;
  const PetscBool stepped = model->t > work->accepted_t ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       motion;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(ModelResidual(model, model->u, model->t, model->t, &ok)); /* reactions, gaps and forces of exactly this state */
  PetscCall(ModelMotion(model, model->u, model->t, &motion));
  if (stepped) work->rate = motion / (model->t - work->accepted_t);
  model->force_scale = PetscMax(model->force_scale, work->scale);
  PetscCall(PetscArraycpy(work->accepted_u, model->u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(model->x, work->accepted_x));
  work->accepted_t = model->t;
  work->forecasted = PETSC_FALSE;
  if (model->contact) {
    PetscCall(ContactAccept(model->contact));
    if (stepped) PetscCall(ContactAdjustNextPenalty(model->contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelRestore - takes back everything since the last ModelAccept(). Collective. */
PetscErrorCode ModelRestore(Model model)
{
  ModelWork *work = model->work;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(model->u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(VecCopy(work->accepted_x, model->x));
  model->t = work->accepted_t;
  if (model->contact) {
    PetscCall(ContactRestore(model->contact));
    PetscCall(ContactGather(model->contact, model->u, model->t, model->t, 0));
  }
  PetscCall(ModelResidual(model, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The free displacements among the local ones. */
static PetscErrorCode ModelCollectFree(Model model, const PetscReal *u, Vec x)
{
  const PetscInt  n = model->mesh->n_nodes * model->mesh->dim;
  const PetscInt *dof;
  PetscInt        first, end;

  PetscFunctionBeginUser;
  PetscCall(MeshGetGlobalDofs(model->mesh, &dof));
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  for (PetscInt i = 0; i < n; i++)
    if (dof[i] >= first && dof[i] < end) PetscCall(VecSetValue(x, dof[i], u[i], INSERT_VALUES));
  PetscCall(VecAssemblyBegin(x));
  PetscCall(VecAssemblyEnd(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelArchive - saves or takes over the accepted state: displacements, load parameter, scales, contact.

   Collective. To be saved between steps; to be loaded into a model fresh from ModelCreate(), in the place of ModelSetUp(). The model then stands as
   after the ModelAccept() of that step, forces and gaps included. */
PetscErrorCode ModelArchive(Model model, Archive archive)
{
  const Mesh mesh = model->mesh;
  ModelWork *work = model->work;
  Rows       nodes;
  PetscBool  ok;

  PetscFunctionBeginUser;
  PetscCall(RowsCreate(mesh->comm, mesh->n_global, mesh->n_nodes, mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "model/displacement", &nodes, mesh->dim, work->accepted_u));
  PetscCall(RowsDestroy(&nodes));
  PetscCall(ArchiveReals(archive, "model/t", 1, &work->accepted_t));
  PetscCall(ArchiveReals(archive, "model/rate", 1, &work->rate));
  PetscCall(ArchiveReals(archive, "model/force_scale", 1, &model->force_scale));
  if (ArchiveLoads(archive)) {
    PetscCall(PetscArraycpy(model->u, work->accepted_u, mesh->n_nodes * mesh->dim));
    PetscCall(ModelCollectFree(model, model->u, model->x));
    PetscCall(VecCopy(model->x, work->accepted_x));
    model->t = work->accepted_t;
  }
  if (model->contact) PetscCall(ContactArchive(model->contact, archive, model->u, model->t));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelResidual(model, model->u, model->t, model->t, &ok));
  if (model->contact) PetscCall(ContactRestore(model->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelReaction - the force that supports and imposed displacements put on a group's nodes in the accepted state, the same on all ranks.

   Collective. Sums the residual over the group's prescribed dofs, those of its edges that it shares with other prescribed surfaces too;
   axisymmetric: over 360 degrees. force[dim..2] are 0. */
PetscErrorCode ModelReaction(Model model, const MeshGroup *group, PetscReal force[3])
{
  const int dim = model->mesh->dim;

  PetscFunctionBeginUser;
  force[0] = force[1] = force[2] = 0;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    for (int d = 0; d < dim; d++) {
      const PetscInt dof = group->nodes[i] * dim + d;
      if (LoadsPrescribed(model->loads, dof)) force[d] += model->work->f[dof];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ", NAME contact" for each smoother that some pair has */
static PetscErrorCode ModelContactEffects(Scene scene, char *text, size_t size)
{
  PetscFunctionBeginUser;
  for (int kind = 0; kind < SMOOTHER_KINDS; kind++) {
    PetscBool used = PETSC_FALSE;

    for (int c = 0; c < scene->n_contacts; c++) used = (PetscBool)(used || (int)scene->contacts[c].smoother == kind);
    if (!used) continue;
    PetscCall(PetscStrlcat(text, ", ", size));
    PetscCall(PetscStrlcat(text, SmootherNames[kind], size));
    PetscCall(PetscStrlcat(text, " contact", size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelEffects - what the scene calls for, in words with commas between, into text[size]. Not collective, same on all ranks. */
PetscErrorCode ModelEffects(Model model, char *text, size_t size)
{
  Scene     scene  = model->scene;
  PetscBool moving = PETSC_FALSE, body_force = PETSC_FALSE, adjusted = PETSC_FALSE, surface = PETSC_FALSE;
  size_t    start;

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) moving = (PetscBool)(moving || (scene->bodies[b].rigid && scene->bodies[b].motion.n));
  for (int c = 0; c < scene->n_contacts; c++) adjusted = (PetscBool)(adjusted || scene->contacts[c].adjust);
  for (int l = 0; l < scene->n_loads; l++) body_force = (PetscBool)(body_force || scene->loads[l].kind == LOAD_BODY_FORCE);
  for (int c = 0; c < scene->n_contacts; c++) surface = (PetscBool)(surface || scene->contacts[c].formulation == CONTACT_SURFACE_TO_SURFACE);
  PetscCall(PetscSNPrintf(text, size, "%s%s%s", scene->kinematics == KINEMATICS_FINITE ? "finite strain" : "small strain",
                          ModelHasFormulation(scene, FORMULATION_ENHANCED) ? ", enhanced strains" : "",
                          ModelHasFormulation(scene, FORMULATION_FBAR) ? ", mean dilatation" : ""));
  PetscCall(ModelContactEffects(scene, text, size));
  PetscCall(PetscStrlen(text, &start));
  PetscCall(PetscSNPrintf(text + start, size - start, "%s%s%s%s%s", surface ? ", surface to surface" : "", adjusted ? ", adjusted penalty" : "",
                          LoadsConservative(model->loads) ? "" : ", follower load", body_force ? ", body force" : "", moving ? ", rigid motion" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelDofs - number of free dofs on all ranks. Not collective. */
PetscErrorCode ModelDofs(Model model, PetscInt *free_dofs)
{
  PetscFunctionBeginUser;
  PetscCall(VecGetSize(model->x, free_dofs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelIsLinear - is one linear solve the answer at any t? Not collective, same on all ranks. */
PetscBool ModelIsLinear(Model model)
{
  return model->scene->kinematics == KINEMATICS_SMALL && !model->contact ? PETSC_TRUE : PETSC_FALSE;
}
