/* The choice between the direct and the iterative solver, and its tolerances. */
#include "linear/linearsolver.h"
#include "base/freememory.h"
#include "linear/directsolver.h"
#include "linear/reusedfactor.h"
#include "multigrid.h"

/* Number of unknowns from which on the factor of a tangent may serve later ones. With fewer a factorisation is worth
   few solves. Measured: 60 Newton iterations on a cup that is flattened (956 unknowns) take no less time, 98 on a pipe
   between plates with enhanced elements (2065) take the same, 90 on that pipe with second-order elements (3406) a tenth
   less. */
#define LINEAR_KEPT_DOFS 3000
/* Residual that is asked for of an iterative solver, in parts of the right-hand side. */
#define LINEAR_TOLERANCE 1e-4
/* Residual that is asked for where the solution is the prediction of a load step, in parts of LINEAR_TOLERANCE. Contact
   that the prediction finds open or closed by mistake costs a Newton iteration more. With this value rings and spheres
   take up to a tenth fewer Krylov iterations in all. */
#define LINEAR_PREDICTION 0.01
/* Least residual that is asked for, in parts of the residual that ends Newton's method. */
#define LINEAR_SHARE 0.1
/* Most Krylov iterations of a solve, and directions that GMRES keeps. */
#define LINEAR_ITERATIONS 1000
#define LINEAR_RESTART    100

/* Relative residual above which a solution with the transposed operator is not taken: those are weights of an error
   estimate, for which three digits are enough. */
#define LINEAR_TRANSPOSED 1e-3
/* A factor that was made for an earlier operator serves for such a solution where refinement with it leaves this
   relative residual, each step of it no more than the second part of what was left before. Where the operator is that
   of bodies that keep their volume, round-off leaves more, and no factor of its own would leave less: a residual is
   round-off that is below the last part of the operator's norm times that of the solution (measured: a fifth of it). */
#define LINEAR_AT_HAND   1e-12
#define LINEAR_NEAR      0.1
#define LINEAR_ROUND_OFF (0.5 * PETSC_MACHINE_EPSILON)

struct _n_LinearSolver {
  KSP          ksp;
  Multigrid    multigrid; /* NULL: direct */
  ReusedFactor kept;      /* NULL: iterative, or each tangent is factored */
  Corotation   turn;      /* rotations of the bodies for kept; NULL: none */
  PetscBool    symmetric, borders;
  PetscReal    usual; /* tolerance outside of predictions */
};

/* Is the stiffness of the bodies the same in all steps? */
static PetscBool StiffnessStays(Scene scene)
{
  PetscBool stays = (PetscBool)(scene->kinematics == KINEMATICS_SMALL && !SceneIsPlastic(scene) &&
                                !SceneHasRoutine(scene) && !SceneSupportsChange(scene));

  for (int s = 0; s < scene->n_supports; s++) stays = (PetscBool)(stays && !scene->supports[s].history.n);
  return stays;
}

/* Sets an iterative solver up. GMRES, as a tangent may be indefinite far from equilibrium, and as the preconditioner is
   not symmetric, whatever the tangent is. The preconditioner is on the right, so that the residual is the true one. The
   flexible kind keeps the preconditioned directions, so that the solution needs no iteration more. Directions are made
   orthogonal twice where once is not enough: else the residual rises after each restart where contact has come in far,
   and the solve of a pipe's first step ends after 1000 iterations. */
static PetscErrorCode SetIterative(LinearSolver solver, Mesh mesh, Scene scene, PetscBool symmetric)
{
  const PetscBool axisymmetric = scene->geometry == GEOMETRY_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  FreeMemoryAtOnce();
  PetscCall(KSPSetType(solver->ksp, KSPFGMRES));
  PetscCall(KSPSetPCSide(solver->ksp, PC_RIGHT));
  PetscCall(KSPGMRESSetRestart(solver->ksp, LINEAR_RESTART));
  PetscCall(KSPGMRESSetCGSRefinementType(solver->ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(solver->ksp, LINEAR_TOLERANCE, 0, PETSC_DEFAULT, LINEAR_ITERATIONS));
  PetscCall(MultigridCreate(mesh, axisymmetric, symmetric, StiffnessStays(scene), solver->ksp, &solver->multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverCreate - sets a KSP up as solver.type of the scene says.

  Collective

  Input Parameters:
+ ksp       - solver of the tangent systems
. mesh      - borrowed, its constraints set
. scene     - solver type, geometry and kinematics
- symmetric - every operator will be symmetric

  Output Parameter:
. solver - destroy it with LinearSolverDestroy(), after the KSP

  Options Database Keys:
+ -ksp_...       - those of the KSP, read by the caller later
. -bodies_...    - multigrid of the iterative solver (MultigridCreate())
- -interface_... - direct solve of the iterative solver
@*/
PetscErrorCode LinearSolverCreate(KSP ksp, Mesh mesh, Scene scene, PetscBool symmetric, LinearSolver *solver)
{
  SolverType type = scene->solver.type;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(solver));
  (*solver)->ksp       = ksp;
  (*solver)->symmetric = symmetric;
  if (type == SOLVER_AUTO)
    type = mesh->dim == 3 && !mesh->saddle && mesh->dim * mesh->n_global > SOLVER_DIRECT_DOFS ? SOLVER_ITERATIVE
                                                                                              : SOLVER_DIRECT;
  if (type == SOLVER_DIRECT) {
    PetscCall(DirectSolverSet(ksp, symmetric));
    if (mesh->dim * mesh->n_global >= LINEAR_KEPT_DOFS) PetscCall(ReusedFactorCreate(ksp, &(*solver)->kept));
    if ((*solver)->kept && scene->kinematics == KINEMATICS_FINITE) PetscCall(CorotationCreate(mesh, &(*solver)->turn));
    if ((*solver)->turn) PetscCall(ReusedFactorSetCorotation((*solver)->kept, (*solver)->turn));
  } else
    PetscCall(SetIterative(*solver, mesh, scene, symmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverDestroy - frees the linear solver.

  Collective

  Input Parameter:
. solver - may be NULL inside; its KSP, which is the caller's, is destroyed before
@*/
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

/*@
  LinearSolverOrder - chooses a direct solver's ordering for operators with a pattern much like that of K.

  Collective; once

  Input Parameters:
+ solver  - the linear solver
. K       - elastic part of the first operator, which a restarted run has too
- couples - contact couples many unknowns with each other

  Note:
  Call it where many operators are to come. An iterative solver has no ordering and ignores it.
@*/
PetscErrorCode LinearSolverOrder(LinearSolver solver, Mat K, PetscBool couples)
{
  PCFailedReason reason;
  PetscBool      thin = PETSC_FALSE, direct;
  Factor         factor;

  PetscFunctionBeginUser;
  if (!solver->multigrid) PetscCall(DirectSolverOrder(solver->ksp, K, &thin));
  PetscCall(
    DirectSolverServes(solver->ksp, &direct)); /* options may have made the factor a preconditioner of iterations */
  if (!thin || !couples || !direct || !solver->symmetric || !solver->kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  PetscCall(FactorPrepareBorder(factor, K, &reason));
  solver->borders = reason ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverIterates - tells whether the solver is the iterative one, which is for many unknowns and little memory.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver
@*/
PetscBool LinearSolverIterates(LinearSolver solver)
{
  return solver->multigrid ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  LinearSolverBorders - tells whether LinearSolverSetBorder() must be called for each operator.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver
@*/
PetscBool LinearSolverBorders(LinearSolver solver)
{
  return solver->borders;
}

/*@
  LinearSolverSetBorder - sets what contact adds to the next operator as a sum of v v^T.

  Collective

  Input Parameters:
+ solver - the linear solver
- border - the vectors v; borrowed until the next call

  Note:
  Call it before LinearSolverNext(). What contact adds besides that sum is small and is left to iterations.
@*/
PetscErrorCode LinearSolverSetBorder(LinearSolver solver, const Border *border)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  PetscCall(FactorSetBorder(factor, border));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverRelease - frees what serves the last operator alone, before the next one is computed.

  Collective

  Input Parameter:
. solver - the linear solver; nothing is solved with it until LinearSolverNext()
@*/
PetscErrorCode LinearSolverRelease(LinearSolver solver)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(MultigridRelease(solver->multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverNext - tells what is known of the next operator K + C before it is solved with.

  Collective

  Input Parameters:
+ solver  - the linear solver
. u       - u[n_nodes*dim]: local displacements at which the operator is the tangent (length)
. C       - contact part of the operator; NULL: none
. pattern - the operator has a new pattern
- changes - contact terms that opened, closed or changed their stiffness since the last operator

  Output Parameter:
. older - the factor of an older operator serves, and ReusedFactorUpdate() must tell it the changes
@*/
PetscErrorCode LinearSolverNext(LinearSolver solver, const PetscReal *u, Mat C, PetscBool pattern, PetscInt changes,
                                PetscBool *older)
{
  PetscFunctionBeginUser;
  *older = PETSC_FALSE;
  if (solver->turn) PetscCall(CorotationMove(solver->turn, u));
  if (solver->kept) PetscCall(ReusedFactorNext(solver->kept, changes, pattern, older));
  if (!solver->kept && pattern) PetscCall(KSPReset(solver->ksp));
  if (solver->multigrid && C) PetscCall(MultigridSetContact(solver->multigrid, C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverRenew - forgets what was made for past operators.

  Not collective

  Input Parameter:
. solver - the linear solver

  Note:
  With the direct solver what follows does not depend on what was solved before, so that a step repeats itself to the
  last bit. The iterative solver keeps the coarse spaces of multigrid: a step repeats itself to the tolerance of the
  linear solves.
@*/
PetscErrorCode LinearSolverRenew(LinearSolver solver)
{
  PetscFunctionBeginUser;
  if (solver->multigrid) PetscCall(MultigridRenew(solver->multigrid));
  if (solver->multigrid)
    PetscCall(
      KSPSetTolerances(solver->ksp, PETSC_DEFAULT, 0, PETSC_DEFAULT, PETSC_DEFAULT)); /* this was for the last step */
  if (solver->kept) PetscCall(ReusedFactorRenew(solver->kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes r = b - A^T x and its norm. */
static PetscErrorCode TransposedResidual(LinearSolver solver, Mat A, Vec b, Vec x, Vec r, PetscReal *norm)
{
  PetscFunctionBeginUser;
  PetscCall((solver->symmetric ? MatMult : MatMultTranspose)(A, x, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves A^T x = b by refinement with the factor at hand, which may be that of an operator a little earlier; r is work
   space. *solved: there is a factor, and it is near enough. */
static PetscErrorCode RefineTransposed(LinearSolver solver, Mat A, Vec b, Vec x, Vec r, PetscBool *solved)
{
  PetscReal right, left, before, most, norm;
  Factor    factor;
  Vec       d;

  PetscFunctionBeginUser;
  *solved = PETSC_FALSE;
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  if (!factor || !FactorExists(factor)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecNorm(b, NORM_2, &right));
  PetscCall(MatNorm(A, NORM_INFINITY, &most));
  PetscCall(VecDuplicate(x, &d));
  PetscCall(VecSet(x, 0));
  PetscCall(VecCopy(b, r));
  left = right;
  do {
    before = left;
    PetscCall((solver->symmetric ? FactorSolve : FactorSolveTransposed)(factor, r, d));
    PetscCall(VecAXPY(x, 1, d));
    PetscCall(TransposedResidual(solver, A, b, x, r, &left));
    PetscCall(VecNorm(x, NORM_2, &norm));
    *solved = (PetscBool)(left <= LINEAR_AT_HAND * right || left <= LINEAR_ROUND_OFF * most * norm);
  } while (!*solved && left <= LINEAR_NEAR * before);
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves A^T x = b with the factor of the KSP, and refines x once; r is work space. *found: there is a factor. */
static PetscErrorCode SolveTransposed(LinearSolver solver, Mat A, Vec b, Vec x, Vec r, PetscBool *found)
{
  Factor factor;
  Vec    d;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  *found = factor ? PETSC_TRUE : PETSC_FALSE;
  if (!factor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPSetUp(solver->ksp));
  PetscCall(FactorSolveTransposed(factor, b, x));
  PetscCall(MatMultTranspose(A, x, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecDuplicate(x, &d));
  PetscCall(FactorSolveTransposed(factor, r, d));
  PetscCall(VecAXPY(x, 1, d));
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverTransposed - solves A^T x = b with the operator of the KSP.

  Collective

  Input Parameters:
+ solver - the linear solver, after LinearSolverRenew() and LinearSolverNext()
. A      - the operator
- b      - right-hand side

  Output Parameters:
+ x      - the solution, where it was found
- solved - PETSC_FALSE: the operator is singular, or it is not symmetric and no factor of this program serves

  Note:
  A symmetric operator is solved with as it stands, by any solver. The factor at hand serves where it is near enough.
@*/
PetscErrorCode LinearSolverTransposed(LinearSolver solver, Mat A, Vec b, Vec x, PetscBool *solved)
{
  PetscReal right, left;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(b, &r));
  PetscCall(RefineTransposed(solver, A, b, x, r, solved));
  if (!*solved) {
    *solved = PETSC_TRUE;
    if (solver->symmetric)
      PetscCall(KSPSolve(solver->ksp, b, x));
    else
      PetscCall(SolveTransposed(solver, A, b, x, r, solved));
    if (*solved) {
      PetscCall(TransposedResidual(solver, A, b, x, r, &left));
      PetscCall(VecNorm(b, NORM_2, &right));
      *solved = (PetscBool)(left <= LINEAR_TRANSPOSED * right);
    }
  }
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverSetEnough - sets the residual with which the nonlinear solver will be content.

  Logically collective

  Input Parameters:
+ solver   - the linear solver
- residual - 2-norm (a force) that ends the nonlinear solver's iterations; much smaller ones are not worth iterations
@*/
PetscErrorCode LinearSolverSetEnough(LinearSolver solver, PetscReal residual)
{
  PetscFunctionBeginUser;
  if (solver->multigrid)
    PetscCall(KSPSetTolerances(solver->ksp, PETSC_DEFAULT, LINEAR_SHARE * residual, PETSC_DEFAULT, PETSC_DEFAULT));
  if (solver->kept) PetscCall(ReusedFactorSetEnough(solver->kept, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverSetStart - tells the residual that the last step's prediction has left.

  Logically collective

  Input Parameters:
+ solver   - the linear solver
- residual - 2-norm (a force) that Newton's method started from in the last step; 0: unknown

  Note:
  A prediction leaves a residual however precisely it is solved for, so a solve with an older factor may leave a small
  part of that. On a pipe between plates half of the iterations that finish solves disappear, and no Newton iteration is
  added. Iterative solvers use LINEAR_PREDICTION instead.
@*/
PetscErrorCode LinearSolverSetStart(LinearSolver solver, PetscReal residual)
{
  PetscFunctionBeginUser;
  if (solver->kept) PetscCall(ReusedFactorSetEnough(solver->kept, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverDirect - tells whether the last operator was factored, so that LinearSolverColumns() may be called.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver

  Output Parameter:
. direct - there is a factor
@*/
PetscErrorCode LinearSolverDirect(LinearSolver solver, PetscBool *direct)
{
  PetscFunctionBeginUser;
  PetscCall(DirectSolverServes(solver->ksp, direct));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverColumns - solves A X = B for dense B and X, with the operator A of the last solve.

  Collective

  Input Parameters:
+ solver - the linear solver
- B      - right-hand sides

  Output Parameters:
+ X    - solutions
- able - there is a factor of A; X is not set otherwise

  Note:
  A factor with a border leaves out a small part of A. Columns that predict contact may lack it, as the next iteration
  takes it into account.
@*/
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

/*@
  LinearSolverSetPrediction - tells whether the next solution is the prediction of a load step.

  Logically collective; on before the solve, off after it

  Input Parameters:
+ solver     - the linear solver
- predicting - a prediction is solved for more precisely, as its guess of what is in contact should hold
@*/
PetscErrorCode LinearSolverSetPrediction(LinearSolver solver, PetscBool predicting)
{
  PetscFunctionBeginUser;
  if (!solver->multigrid) PetscFunctionReturn(PETSC_SUCCESS);
  if (predicting) PetscCall(KSPGetTolerances(solver->ksp, &solver->usual, NULL, NULL, NULL));
  PetscCall(KSPSetTolerances(solver->ksp, predicting ? LINEAR_PREDICTION * solver->usual : solver->usual, PETSC_DEFAULT,
                             PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverOwnFactor - gets the factor of the operator that was solved with last.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver

  Output Parameter:
. factor - borrowed; NULL where there is none: the solver is iterative, or the factor is that of an older operator
@*/
PetscErrorCode LinearSolverOwnFactor(LinearSolver solver, Factor *factor)
{
  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(solver->ksp, factor));
  if (*factor && (!FactorExists(*factor) || (solver->kept && !ReusedFactorIsOwn(solver->kept)))) *factor = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverNegatives - gets the number of negative eigenvalues of the operator that was solved with last.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver

  Output Parameter:
. negatives - their number; -1 where it is not known: the solver is iterative, the operator is not symmetric, or the
              factor is that of an older one
@*/
PetscErrorCode LinearSolverNegatives(LinearSolver solver, PetscInt *negatives)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(LinearSolverOwnFactor(solver, &factor));
  *negatives = factor ? FactorNegatives(factor) : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverParity - tells whether the operator that was factored last has an odd number of negative eigenvalues.

  Not collective, the same on all ranks

  Input Parameter:
. solver - the linear solver

  Output Parameter:
. parity - 1: odd, 0: even; -1 where it is not known: the solver is iterative

  Note:
  Operators need not be symmetric. That operator may be an older one than that which was solved with last.
@*/
PetscErrorCode LinearSolverParity(LinearSolver solver, PetscInt *parity)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(solver->ksp, &factor));
  *parity = factor ? FactorParity(factor) : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearSolverKept - gets the factor that may serve more than one operator.

  Not collective

  Input Parameter:
. solver - the linear solver

  Note:
  The result is borrowed. It is NULL where there is none.
@*/
ReusedFactor LinearSolverKept(LinearSolver solver)
{
  return solver->kept;
}
