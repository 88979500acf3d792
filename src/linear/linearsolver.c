#include "linear/linearsolver.h"
#include "linear/directsolver.h"
#include "linear/reusedfactor.h"
#include "multigrid.h"

/* solver.type auto: iterative above this many unknowns in space. Two thick rings of first-order bricks: equal CPU time
   at 16,000, at 120,000 a fifth of it and a third of the memory; thin walls of second-order bricks take three times the
   iterations. */
#define LINEAR_DIRECT_DOFS 60000
/* Unknowns from which on the factor of a tangent may serve later ones. With fewer a factorisation is worth few solves:
   60 Newton iterations of cup_flattening (956) take no less time, 98 of pipe_pinch with enhanced elements (2065) the
   same; 90 of pipe_pinch with second-order ones (3406) a tenth less. */
#define LINEAR_KEPT_DOFS 3000
/* The residual asked for: this part of the right-hand side, ... */
#define LINEAR_TOLERANCE 1e-4
/* ... and this part of that where the solution is a step's prediction: the contact that it finds open or closed by
   mistake costs a Newton iteration more, and rings and spheres take up to a tenth fewer Krylov iterations in all. */
#define LINEAR_PREDICTION 0.01
/* ... but not below this part of what ends Newton's method. */
#define LINEAR_SHARE 0.1
/* Most iterations, and directions that are kept */
#define LINEAR_ITERATIONS 1000
#define LINEAR_RESTART    100

struct _n_LinearSolver {
  KSP          ksp;
  Multigrid    multigrid; /* NULL: direct */
  ReusedFactor kept;      /* NULL: iterative, or each tangent is factored */
  Corotation   turn;      /* of the bodies, for what is kept; NULL: they do not turn */
  PetscBool    symmetric, borders;
  PetscReal    usual; /* tolerance, while a prediction is made */
};

/* GMRES, as a tangent may be indefinite far from equilibrium; preconditioned from the right, so that its residual is
   the true one. The flexible kind keeps the preconditioned directions, so that the solution needs no iteration more.
   The preconditioner is not symmetric, whatever the tangent is. */
static PetscErrorCode SetIterative(LinearSolver solver, Mesh mesh, PetscBool axisymmetric, PetscBool symmetric)
{
  PetscFunctionBeginUser;
  PetscCall(KSPSetType(solver->ksp, KSPFGMRES));
  PetscCall(KSPSetPCSide(solver->ksp, PC_RIGHT));
  PetscCall(KSPGMRESSetRestart(solver->ksp, LINEAR_RESTART));
  PetscCall(KSPSetTolerances(solver->ksp, LINEAR_TOLERANCE, 0, PETSC_DEFAULT, LINEAR_ITERATIONS));
  PetscCall(MultigridCreate(mesh, axisymmetric, symmetric, solver->ksp, &solver->multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverCreate - sets a KSP up as solver.type of the scene says.

   Collective. mesh: borrowed, its constraints set. symmetric: every operator will be. Destroy the solver after the KSP.
   Options Database Keys: those of the KSP; -bodies_..., -interface_... of the iterative solver (MultigridCreate()). */
PetscErrorCode LinearSolverCreate(KSP ksp, Mesh mesh, Scene scene, PetscBool symmetric, LinearSolver *solver)
{
  SolverType      type         = scene->solver.type;
  const PetscBool axisymmetric = scene->geometry == GEOMETRY_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(solver));
  (*solver)->ksp       = ksp;
  (*solver)->symmetric = symmetric;
  if (type == SOLVER_AUTO)
    type = mesh->dim == 3 && mesh->dim * mesh->n_global > LINEAR_DIRECT_DOFS ? SOLVER_ITERATIVE : SOLVER_DIRECT;
  if (type == SOLVER_DIRECT) {
    PetscCall(DirectSolverSet(ksp, symmetric));
    if (mesh->dim * mesh->n_global >= LINEAR_KEPT_DOFS) PetscCall(ReusedFactorCreate(ksp, &(*solver)->kept));
    if ((*solver)->kept && scene->kinematics == KINEMATICS_FINITE) PetscCall(CorotationCreate(mesh, &(*solver)->turn));
    if ((*solver)->turn) PetscCall(ReusedFactorSetCorotation((*solver)->kept, (*solver)->turn));
  } else
    PetscCall(SetIterative(*solver, mesh, axisymmetric, symmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverDestroy - Collective. The KSP, destroyed before, is the caller's. */
PetscErrorCode LinearSolverDestroy(LinearSolver *solver)
{
  PetscFunctionBeginUser;
  if (!*solver) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MultigridDestroy(&(*solver)->multigrid));
  PetscCall(ReusedFactorDestroy(&(*solver)->kept));
  PetscCall(CorotationDestroy(&(*solver)->turn));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverOrder - a direct solver's ordering for operators that are much like K. Collective; once. */
PetscErrorCode LinearSolverOrder(LinearSolver solver, Mat K, PetscBool couples)
{
  PCFailedReason reason;
  PetscBool      thin = PETSC_FALSE, direct;
  Factor         factor;

  PetscFunctionBeginUser;
  if (!solver->multigrid) PetscCall(DirectSolverOrder(solver->ksp, K, &thin));
  PetscCall(DirectSolverServes(solver->ksp, &direct)); /* options may iterate with what factors */
  if (!thin || !couples || !direct || !solver->symmetric || !solver->kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  PetscCall(FactorPrepareBorder(factor, K, &reason));
  solver->borders = reason ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverBorders - Not collective. */
PetscBool LinearSolverBorders(LinearSolver solver)
{
  return solver->borders;
}

/* LinearSolverSetBorder - Collective. What contact adds but for that sum, small beside it, is left to iterations. */
PetscErrorCode LinearSolverSetBorder(LinearSolver solver, const Border *border)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  PetscCall(FactorSetBorder(factor, border));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverNext - what is known of the next operator K + C before it is solved with.

   Collective. u[n_nodes*dim]: where it is the tangent (length); C: its contact part, NULL: none; pattern: what is
   factored has a new one; changes, *older: see ReusedFactorNext(). */
PetscErrorCode LinearSolverNext(LinearSolver solver, const PetscReal *u, Mat C, PetscBool pattern, PetscInt changes,
                                PetscBool *older)
{
  PetscFunctionBeginUser;
  *older = PETSC_FALSE;
  if (solver->turn) PetscCall(CorotationMove(solver->turn, u));
  if (solver->kept) PetscCall(ReusedFactorNext(solver->kept, changes, pattern, older));
  if (!solver->kept && pattern) PetscCall(KSPReset(solver->ksp));
  if (solver->multigrid && C) PetscCall(MultigridSetContact(solver->multigrid, C, pattern));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverRenew - nothing made for operators of the past serves the next one, so that a step repeats itself to the
 * last bit. Not collective. */
PetscErrorCode LinearSolverRenew(LinearSolver solver)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(MultigridRenew(solver->multigrid));
  if (solver->multigrid)
    PetscCall(KSPSetTolerances(solver->ksp, PETSC_DEFAULT, 0, PETSC_DEFAULT,
                               PETSC_DEFAULT)); /* what the last solve was content with */
  if (solver->kept) PetscCall(ReusedFactorRenew(solver->kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverSetEnough - residual: 2-norm (a force) that ends the nonlinear solver's iterations. Logically collective.
 */
PetscErrorCode LinearSolverSetEnough(LinearSolver solver, PetscReal residual)
{
  PetscFunctionBeginUser;
  if (solver->multigrid)
    PetscCall(KSPSetTolerances(solver->ksp, PETSC_DEFAULT, LINEAR_SHARE * residual, PETSC_DEFAULT, PETSC_DEFAULT));
  if (solver->kept) PetscCall(ReusedFactorSetEnough(solver->kept, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverSetStart - a prediction leaves a residual however precisely it is solved for, so a kept factor's solve
   may leave a small part of that: on a pipe between plates half of the iterations that finish solves go, and none of
   Newton's comes. Not for iterative solvers: LINEAR_PREDICTION.

   Logically collective. residual: 2-norm (a force) that Newton started from in the last step. */
PetscErrorCode LinearSolverSetStart(LinearSolver solver, PetscReal residual)
{
  PetscFunctionBeginUser;
  if (solver->kept) PetscCall(ReusedFactorSetEnough(solver->kept, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverDirect - is the last operator factored? Not collective, the same on all ranks. */
PetscErrorCode LinearSolverDirect(LinearSolver solver, PetscBool *direct)
{
  PetscFunctionBeginUser;
  PetscCall(DirectSolverServes(solver->ksp, direct));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverColumns - X = A^-1 B for dense B and X, A the operator of the last solve, where that was a direct one.

   Collective. *able: there is a factor, and it is A's; with a border but for what that leaves out, which columns that
   settle contact may lack: the next iteration sees it. */
PetscErrorCode LinearSolverColumns(LinearSolver solver, Mat B, Mat X, PetscBool *able)
{
  PetscBool failed = PETSC_FALSE;
  PC        pc;

  PetscFunctionBeginUser;
  PetscCall(LinearSolverDirect(solver, able));
  if (*able && solver->kept) PetscCall(ReusedFactorOwn(solver->kept, &failed));
  *able = (PetscBool)(*able && !failed);
  if (!*able) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetPC(solver->ksp, &pc));
  PetscCall(DirectSolverColumns(pc, B, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverSetPrediction - whether the next solution is a prediction, which is asked for more precisely. Logically
 * collective; on, then off. */
PetscErrorCode LinearSolverSetPrediction(LinearSolver solver, PetscBool predicting)
{
  PetscFunctionBeginUser;
  if (!solver->multigrid) PetscFunctionReturn(PETSC_SUCCESS);
  if (predicting) PetscCall(KSPGetTolerances(solver->ksp, &solver->usual, NULL, NULL, NULL));
  PetscCall(KSPSetTolerances(solver->ksp, predicting ? LINEAR_PREDICTION * solver->usual : solver->usual, PETSC_DEFAULT,
                             PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverKept - the factor that may serve more than one operator; NULL: there is none. Not collective; borrowed.
 */
ReusedFactor LinearSolverKept(LinearSolver solver)
{
  return solver->kept;
}
