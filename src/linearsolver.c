#include "linearsolver.h"
#include "directsolver.h"
#include "multigrid.h"

/* solver.type auto: iterative above this many unknowns in space. Two thick rings of first-order bricks: equal CPU time at 16,000, at 120,000 a fifth of it
   and a third of the memory; thin walls of second-order bricks take three times the iterations. */
#define LINEAR_DIRECT_DOFS 60000
/* The residual asked for: this part of the right-hand side, ... */
#define LINEAR_TOLERANCE 1e-4
/* ... but not below this part of what ends Newton's method. */
#define LINEAR_SHARE 0.1
/* Most iterations, and directions that are kept */
#define LINEAR_ITERATIONS 1000
#define LINEAR_RESTART    100

struct _n_LinearSolver {
  KSP       ksp;
  Multigrid multigrid; /* NULL: direct */
};

/* GMRES, as a tangent may be indefinite far from equilibrium; preconditioned from the right, so that its residual is the true one. */
static PetscErrorCode SetIterative(LinearSolver solver, Mesh mesh, PetscBool axisymmetric, PetscBool symmetric)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPSetType(solver->ksp, KSPGMRES));
  PetscCall(KSPSetPCSide(solver->ksp, PC_RIGHT));
  PetscCall(KSPGMRESSetRestart(solver->ksp, LINEAR_RESTART));
  PetscCall(KSPSetTolerances(solver->ksp, LINEAR_TOLERANCE, 0, PETSC_DEFAULT, LINEAR_ITERATIONS));
  PetscCall(KSPGetPC(solver->ksp, &pc));
  PetscCall(MultigridCreate(mesh, axisymmetric, symmetric, pc, &solver->multigrid));
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
  (*solver)->ksp = ksp;
  if (type == SOLVER_AUTO) type = mesh->dim == 3 && mesh->dim * mesh->n_global > LINEAR_DIRECT_DOFS ? SOLVER_ITERATIVE : SOLVER_DIRECT;
  if (type == SOLVER_DIRECT)
    PetscCall(DirectSolverSet(ksp, symmetric));
  else
    PetscCall(SetIterative(*solver, mesh, axisymmetric, symmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverDestroy - Collective. The KSP, destroyed before, is the caller's. */
PetscErrorCode LinearSolverDestroy(LinearSolver *solver)
{
  PetscFunctionBeginUser;
  if (!*solver) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MultigridDestroy(&(*solver)->multigrid));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverSetContact - the contact part C of the next operator K + C; changed: the operator has a new pattern. Collective. */
PetscErrorCode LinearSolverSetContact(LinearSolver solver, Mat C, PetscBool changed)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(MultigridSetContact(solver->multigrid, C, changed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverRenew - nothing made for operators of the past serves the next one, so that a step repeats itself to the last bit. Not collective. */
PetscErrorCode LinearSolverRenew(LinearSolver solver)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(MultigridRenew(solver->multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LinearSolverSetEnough - residual: 2-norm (a force) that ends the nonlinear solver's iterations. Logically collective. */
PetscErrorCode LinearSolverSetEnough(LinearSolver solver, PetscReal residual)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(KSPSetTolerances(solver->ksp, PETSC_DEFAULT, LINEAR_SHARE * residual, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}
