#include "model.h"
#include "matrixsum.h"
#include "refusal.h"
#include "timing.h"

/* Energy of a state with an inverted element: above any other, yet its square is a number, which the line search takes. */
#define MODEL_INVERTED 1e100
/* Times that contact lists are replaced and the step solved on before it counts as unsettled. */
#define MODEL_MAX_REGATHER 8
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
/* A direct solve of a regular system leaves a relative residual of 1e-12 to 1e-7, stiff penalties included; above this the system is singular. */
#define MODEL_SINGULAR 1e-3
/* Round-off of the residual, in machine epsilons times stiffness times displacement: a body that is moved without any force has nothing else
   to be measured against. Measured: 0.1 to 1.5. */
#define MODEL_ROUND_OFF 16
/* Workspace of MUMPS above its estimate, in per cent. Its own 20 is too little for symmetric systems of a few thousand dofs on four ranks. */
#define MODEL_MUMPS_WORKSPACE "100"
/* How MUMPS scales symmetric systems: by the diagonal. Its own choice iterates over rows and columns, which costs a seventh of a factorisation at 10,000
   dofs; stiff penalties stand on the diagonal. */
#define MODEL_MUMPS_SCALING "1"
/* Newton is limited by its iterations, not by the line search's evaluations. */
#define MODEL_MAX_FUNCTIONS 1000000

const char *const SolveResults[] = {"converged",
                                    "Newton's method did not converge within solver.max_iterations",
                                    "the line search found no lower energy",
                                    "an element turned inside out",
                                    "the linear system is singular (is a body free to move?) or its solver failed",
                                    "the direct solver ran out of workspace (PETSc option mat_mumps_icntl_14 gives it more)",
                                    "the contact lists did not settle",
                                    "the penetrations did not come into the window of the adjusted penalty",
                                    "not-a-number in the residual"};

typedef struct _n_ModelWork {
  PetscReal *f;     /* local residual of the last evaluation, all dofs */
  PetscReal *trial; /* local displacements of the last evaluation */
  PetscReal *accepted_u;
  Vec        accepted_x;
  PetscReal  accepted_t;
  Vec        forecast; /* x at forecast_t by ModelForecast() */
  PetscReal  forecast_t;
  PetscBool  forecasted; /* forecast starts from the accepted state */
  PetscReal  rate;       /* largest displacement per unit of t in the last accepted step */
  PetscReal  scale;      /* force norm of the last evaluation */
  PetscReal  stiffness;  /* norm of the elastic tangent's diagonal */
  PetscInt   inverted;   /* gmsh's tag of a cell of this rank that was turned inside out in this solve, or -1 */
  PetscBool  near;       /* the iterate is so close that energies differ by round-off only */
  PetscBool  balanced;   /* the residual of the iterate is within the tolerance */
  PetscInt   renewed;    /* how often that happened in this step */
  PetscBool  left;       /* a slave point slid out of its lists: the solve ended for new ones */
  Vec        residual;   /* of a trial point, while near; the tangent's diagonal for a moment */
} ModelWork;

/* ---------- residual, energy, tangent ---------- */

/* Residual at local displacements u into work->f, contact at t_contact, loads at t; energy over all ranks on request. ok: every element is in order. */
static PetscErrorCode ModelResidual(Model model, const PetscReal *u, PetscReal t, PetscReal t_contact, PetscBool *ok)
{
  ModelWork *work   = model->work;
  PetscReal  sum[3] = {0, 0, 0};
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
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, model->mesh->comm));
  work->scale = PetscSqrtReal(PetscMax(sum[0], PetscMax(sum[1], sum[2])));
  *ok         = mine;
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
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelResidual(model, work->trial, model->t, model->t, &ok));
  PetscCall(MeshLocalToGlobal(model->mesh, work->f, work->residual));
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

/* Converged when the residual is small against the forces that balance in it, never against its own first value; or is nothing but round-off.
   Where penalties follow the penetrations, these must have settled too. */
static PetscErrorCode ModelConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm, SNESConvergedReason *reason, void *context)
{
  Model           model = context;
  const PetscReal scale = PetscMax(model->force_scale, model->work->scale);
  PetscReal       round_off;
  PetscBool       settled = PETSC_TRUE;

  PetscFunctionBeginUser;
  (void)snes;
  (void)it;
  (void)xnorm;
  (void)snorm;
  PetscCall(ModelRoundOff(model, &round_off));
  if (model->contact) PetscCall(ContactGapsSettled(model->contact, &settled));
  *reason               = SNES_CONVERGED_ITERATING;
  model->work->near     = fnorm <= MODEL_ENERGY_ROUND_OFF * scale ? PETSC_TRUE : PETSC_FALSE;
  model->work->balanced = fnorm <= PetscMax(model->scene->solver.tolerance * scale, round_off) ? PETSC_TRUE : PETSC_FALSE;
  if (PetscIsInfOrNanReal(fnorm))
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
  else if (fnorm <= round_off || (model->work->balanced && settled))
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (model->contact)
    PetscCall(ModelLeaveLists(model, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- set-up ---------- */

static PetscErrorCode LinearSolveBegins(KSP ksp, Vec b, Vec x, void *context)
{
  PetscFunctionBeginUser;
  (void)ksp;
  (void)b;
  (void)x;
  (void)context;
  TimingBegin(TIMING_SOLVE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinearSolveEnds(KSP ksp, Vec b, Vec x, void *context)
{
  PetscFunctionBeginUser;
  (void)ksp;
  (void)b;
  (void)x;
  (void)context;
  TimingEnd(TIMING_SOLVE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
  PC              pc;

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
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPSetPreSolve(ksp, LinearSolveBegins, NULL));
  PetscCall(KSPSetPostSolve(ksp, LinearSolveEnds, NULL));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(SetDefaultOption("-mat_mumps_icntl_14", MODEL_MUMPS_WORKSPACE));
  if (symmetric) PetscCall(SetDefaultOption("-mat_mumps_icntl_8", MODEL_MUMPS_SCALING));
  PetscCall(ModelSetFromOptions(model));
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

/* ModelSetUp - contact lists at t = 0 and the state there as the first accepted one.

   Collective. Refuses (exit 1) initial overlaps, ContactTakeOverlap(). */
PetscErrorCode ModelSetUp(Model model)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LoadsPrescribe(model->loads, 0, model->u));
  if (model->contact) {
    PetscCall(ContactGather(model->contact, model->u, 0, 0, 0));
    PetscCall(ModelResidual(model, model->u, 0, 0, &ok));
    PetscCall(ContactTakeOverlap(model->contact));
  }
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
  ModelWork         *work = model->work;
  const PetscInt     n    = model->mesh->n_nodes * model->mesh->dim;
  PetscReal         *step;
  PetscBool          ok;
  Vec                b, dx;
  KSP                ksp;
  KSPConvergedReason reason;
  PetscInt           its;
  PetscReal          norm, left;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &b));
  PetscCall(VecDuplicate(model->x, &dx));
  PetscCall(PetscMalloc1(n, &step));
  PetscCall(PetscArraycpy(step, work->accepted_u, n));
  PetscCall(LoadsPrescribe(model->loads, model->t, step));
  for (PetscInt i = 0; i < n; i++) step[i] -= work->accepted_u[i];
  if (model->contact) PetscCall(ContactPredict(model->contact, PETSC_TRUE, (PetscBool)(work->accepted_t == 0))); /* touching: a body that only contact holds */
  PetscCall(ModelTangent(model, work->accepted_u, work->accepted_t));
  PetscCall(ModelResidual(model, work->accepted_u, model->t, work->accepted_t, &ok));
  if (model->contact) PetscCall(ContactPredict(model->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(ElasticityMultiplyLocal(model->elasticity, step, work->f));
  if (model->contact) PetscCall(ContactMultiply(model->contact, step, work->accepted_t, model->t, work->f));
  PetscCall(MeshLocalToGlobal(model->mesh, work->f, b));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, model->A, model->A));
  PetscCall(KSPSolve(ksp, b, dx));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetIterationNumber(ksp, &its));
  report->newton++;
  report->krylov += its;
  PetscCall(VecAXPY(model->x, -1, dx));
  PetscCall(VecNorm(b, NORM_2, &norm));
  PetscCall(VecScale(dx, -1));
  PetscCall(MatMultAdd(model->A, dx, b, b));
  PetscCall(VecNorm(b, NORM_2, &left));
  if (reason < 0 || !(left <= MODEL_SINGULAR * norm)) PetscCall(ModelLinearFailure(model, &report->result));
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

  PetscFunctionBeginUser;
  PetscCall(SNESSolve(model->snes, NULL, model->x));
  PetscCall(SNESGetConvergedReason(model->snes, &reason));
  PetscCall(SNESGetIterationNumber(model->snes, &its));
  PetscCall(SNESGetLinearSolveIterations(model->snes, &krylov));
  PetscCall(SNESGetFunction(model->snes, &F, NULL, NULL));
  PetscCall(VecNorm(F, NORM_2, &norm));
  report->newton += its;
  report->krylov += krylov;
  report->result = ResultFromReason(reason);
  if (report->result == SOLVE_LINE_SEARCH && model->work->balanced) report->result = SOLVE_CONVERGED; /* gaps as settled as round-off lets them be */
  if (report->result == SOLVE_LINEAR) PetscCall(ModelLinearFailure(model, &report->result));
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

/* Where to look when a step fails: an inverted element, the node with the largest residual. */
static PetscErrorCode ModelLocateFailure(Model model, char *text, size_t size)
{
  Mesh       mesh = model->mesh;
  const int  dim  = mesh->dim;
  PetscReal *f, place[4] = {0, 0, 0, 0};
  PetscInt   inverted     = model->work->inverted;
  char       element[128] = "";
  struct {
    double value;
    int    rank;
  } mine = {0, 0}, most;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
  PetscCall(PetscMalloc1(mesh->n_nodes * dim, &f));
  PetscCall(PetscArraycpy(f, model->work->f, mesh->n_nodes * dim));
  PetscCall(MeshSumNodes(mesh, dim, f));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    double square = 0;

    for (int d = 0; d < dim; d++)
      if (!LoadsPrescribed(model->loads, n * dim + d)) square += PetscSqr(f[n * dim + d]);
    if (!(square > mine.value) || PetscIsInfOrNanReal(square)) continue;
    mine.value = square;
    place[0]   = mesh->node_tag[n];
    for (int d = 0; d < dim; d++) place[1 + d] = mesh->coords[n * dim + d] + mesh->centre[d];
  }
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh->comm));
  PetscCallMPI(MPI_Bcast(place, 4, MPIU_REAL, most.rank, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &inverted, 1, MPIU_INT, MPI_MAX, mesh->comm));
  if (inverted >= 0)
    PetscCall(PetscSNPrintf(element, sizeof(element), "element %" PetscInt_FMT " was inverted%s on the way; ", inverted,
                            ModelHasFormulation(model->scene, FORMULATION_ENHANCED) ? ", or its enhanced strains found no equilibrium," : ""));
  PetscCall(
    PetscSNPrintf(text, size, "%slargest residual at node %.0f (%g, %g, %g)", element, (double)place[0], (double)place[1], (double)place[2], (double)place[3]));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the accepted state on the way to t: its contact state, and lists for the motion to be expected. */
static PetscErrorCode ModelDepart(Model model, PetscReal t)
{
  ModelWork *work = model->work;
  PetscReal  motion, *u;

  PetscFunctionBeginUser;
  model->t       = t;
  work->inverted = -1;
  if (!model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &u));
  PetscCall(PetscArraycpy(u, work->accepted_u, model->mesh->n_nodes * model->mesh->dim));
  PetscCall(LoadsPrescribe(model->loads, t, u));
  PetscCall(ModelMotion(model, u, t, &motion));
  PetscCall(PetscFree(u));
  motion = PetscMax(motion, MODEL_MOTION_SAFETY * work->rate * (t - work->accepted_t));
  PetscCall(ContactRestore(model->contact));
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
static PetscErrorCode ModelRenewLists(Model model, PetscBool *hold)
{
  ModelWork *work = model->work;
  PetscReal  motion;

  PetscFunctionBeginUser;
  PetscCall(ModelMotion(model, work->trial, model->t, &motion));
  TimingBegin(TIMING_SEARCH);
  *hold = PETSC_FALSE;
  if (work->left) {
    work->renewed++;
    PetscCall(ContactListsRenew(model->contact, work->trial, model->t, motion));
  } else
    PetscCall(ContactListsHold(model->contact, work->trial, model->t, motion, hold));
  TimingEnd(TIMING_SEARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves with frozen lists until they hold. */
static PetscErrorCode ModelSolveLists(Model model, SolveReport *report)
{
  PetscBool hold  = PETSC_FALSE;
  PetscInt  times = 0;

  PetscFunctionBeginUser;
  model->work->renewed = 0;
  while (!hold && report->result == SOLVE_CONVERGED) {
    model->work->left = PETSC_FALSE;
    PetscCall(ModelNewton(model, report));
    if (report->result != SOLVE_CONVERGED || !model->contact) break;
    PetscCall(ModelRenewLists(model, &hold));
    if (hold) break;
    report->regathered++;
    if (!model->work->left && times++ == MODEL_MAX_REGATHER) report->result = SOLVE_LISTS;
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
    PetscCall(ModelSolveLists(model, report));
    if (report->result != SOLVE_CONVERGED || !model->contact) break;
    if (report->adjusted == MODEL_MAX_ADJUST) PetscCall(ContactLocateOutside(model->contact, report->detail, sizeof(report->detail)));
    PetscCall(ContactAdjustPenalty(model->contact, &window));
    if (window == WINDOW_AT_BOUND) PetscCall(ContactLocateOutside(model->contact, report->detail, sizeof(report->detail)));
    if (window == WINDOW_AT_BOUND || (window == WINDOW_MISSED && report->adjusted++ == MODEL_MAX_ADJUST)) report->result = SOLVE_WINDOW;
  }
  if (report->result == SOLVE_CONVERGED)
    PetscCall(PetscArraycpy(model->u, work->trial, model->mesh->n_nodes * model->mesh->dim));
  else if (report->result != SOLVE_WINDOW)
    PetscCall(ModelLocateFailure(model, report->detail, sizeof(report->detail)));
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

static const char *ModelContactEffect(Scene scene)
{
  int diffuse = 0;

  for (int c = 0; c < scene->n_contacts; c++) diffuse += scene->contacts[c].smoother == SMOOTHER_DIFFUSE;
  if (!scene->n_contacts) return "";
  return diffuse == scene->n_contacts ? ", diffuse contact" : diffuse ? ", facet contact, diffuse contact" : ", facet contact";
}

/* ModelEffects - what the scene calls for, in words with commas between, into text[size]. Not collective, same on all ranks. */
PetscErrorCode ModelEffects(Model model, char *text, size_t size)
{
  Scene     scene  = model->scene;
  PetscBool moving = PETSC_FALSE, body_force = PETSC_FALSE, adjusted = PETSC_FALSE, surface = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) moving = (PetscBool)(moving || (scene->bodies[b].rigid && scene->bodies[b].motion.n));
  for (int c = 0; c < scene->n_contacts; c++) adjusted = (PetscBool)(adjusted || scene->contacts[c].adjust);
  for (int l = 0; l < scene->n_loads; l++) body_force = (PetscBool)(body_force || scene->loads[l].kind == LOAD_BODY_FORCE);
  for (int c = 0; c < scene->n_contacts; c++) surface = (PetscBool)(surface || scene->contacts[c].formulation == CONTACT_SURFACE_TO_SURFACE);
  PetscCall(PetscSNPrintf(text, size, "%s%s%s%s%s%s%s%s%s", scene->kinematics == KINEMATICS_FINITE ? "finite strain" : "small strain",
                          ModelHasFormulation(scene, FORMULATION_ENHANCED) ? ", enhanced strains" : "",
                          ModelHasFormulation(scene, FORMULATION_FBAR) ? ", mean dilatation" : "", ModelContactEffect(scene),
                          surface ? ", surface to surface" : "", adjusted ? ", adjusted penalty" : "", LoadsConservative(model->loads) ? "" : ", follower load",
                          body_force ? ", body force" : "", moving ? ", rigid motion" : ""));
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
