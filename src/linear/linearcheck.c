/* True residuals of linear solves, and refinement of solutions that leave too much. */
#include "linear/linearcheck.h"
#include "base/timing.h"

/* Residual, in multiples of the tolerance asked for, up to which a solution is left as it is. Newton's method contracts
   all the same. */
#define LINEAR_SLACK 100
/* Relative residual above which a matrix is taken for singular. A direct solve of a regular system leaves 1e-12 to
   1e-7, stiff penalties included; a residual that is still above this limit after refinement is that of a singular
   system. */
#define LINEAR_SINGULAR 1e-3
/* Most steps of refinement. Each step reduces the residual by the same factor, so that a refinement that converges at a
   useful speed has converged after this number. */
#define LINEAR_MAX_REFINE 8
/* Part of the residual that a refinement step may leave. A step that leaves more does not help. */
#define LINEAR_HELPS 0.5

struct _n_LinearCheck {
  PetscReal    tolerance;
  ReusedFactor kept;
  PetscBool    lost;
  LinearCounts counts;
  KeptCounts   before; /* of the parts of the run before a restart */
};

static PetscErrorCode SolveBegins(KSP ksp, Vec b, Vec x, void *context)
{
  PetscFunctionBeginUser;
  (void)ksp;
  (void)b;
  (void)x;
  (void)context;
  TimingBegin(TIMING_SOLVE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes r = b - A x and its norm. */
static PetscErrorCode TrueResidual(Mat A, Vec b, Vec x, Vec r, PetscReal *norm)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds A^-1 r to x with the present factor, until the residual is at most `enough` or a step no longer helps. */
static PetscErrorCode Refine(KSP ksp, Mat A, Vec b, Vec x, Vec r, PetscReal enough, PetscReal *norm, PetscInt *steps)
{
  PetscReal before = PETSC_MAX_REAL;
  PC        pc;
  Vec       d;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(VecDuplicate(x, &d));
  for (PetscInt i = 0; i < LINEAR_MAX_REFINE; i++) {
    if (!(*norm > enough) || !(*norm <= LINEAR_HELPS * before)) break; /* also if a norm is not a number */
    before = *norm;
    PetscCall(PCApply(pc, r, d));
    PetscCall(VecAXPY(x, 1, d));
    PetscCall(TrueResidual(A, b, x, r, norm));
    ++*steps;
    if (*norm < before) continue;
    PetscCall(VecAXPY(x, -1, d));
    *norm = before;
  }
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The relative residual that the solver was asked for. An iterative solver has its own tolerances. right: norm of the
   right-hand side */
static PetscErrorCode AskedFor(LinearCheck check, KSP ksp, PetscReal right, PetscReal *tolerance)
{
  PetscReal least;
  PetscBool direct;

  PetscFunctionBeginUser;
  *tolerance = check->tolerance;
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &direct));
  if (direct) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetTolerances(ksp, tolerance, &least, NULL, NULL));
  if (right > 0) *tolerance = PetscMax(*tolerance, least / right);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckSolution(LinearCheck check, KSP ksp, Vec b, Vec x)
{
  PetscReal right, norm = -1, tolerance, own;
  PetscBool failed = PETSC_FALSE;
  PetscInt  steps  = 0;
  Mat       A;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(ksp, &A, NULL));
  PetscCall(VecNorm(b, NORM_2, &right));
  PetscCall(AskedFor(check, ksp, right, &tolerance));
  own = tolerance;
  if (check->kept) PetscCall(ReusedFactorSolve(check->kept, A, b, x, &tolerance, &norm, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(b, &r));
  if (norm < 0) PetscCall(TrueResidual(A, b, x, r, &norm));
  if (norm > LINEAR_SLACK * tolerance * right)
    PetscCall(Refine(ksp, A, b, x, r, LINEAR_SLACK * tolerance * right, &norm, &steps));
  PetscCall(VecDestroy(&r));
  /* A norm that is not a number is lost, too. */
  check->lost = norm <= PetscMax(LINEAR_SINGULAR, tolerance) * right ? PETSC_FALSE : PETSC_TRUE;
  check->counts.refined += steps > 0;
  check->counts.steps += steps;
  if (check->lost || right == 0) PetscFunctionReturn(PETSC_SUCCESS);
  check->counts.inaccurate += norm > LINEAR_SLACK * tolerance * right;
  /* Solves that ended where it is enough for Newton's method do not count. */
  if (tolerance == own) check->counts.worst = PetscMax(check->counts.worst, norm / right);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveEnds(KSP ksp, Vec b, Vec x, void *context)
{
  LinearCheck        check = context;
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  check->counts.solves++;
  check->lost = PETSC_TRUE;
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  if (reason >= 0) PetscCall(CheckSolution(check, ksp, b, x));
  TimingEnd(TIMING_SOLVE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearCheckCreate - creates a check of every solution of a KSP.

  Collective

  Input Parameters:
+ ksp       - is watched from now on
. tolerance - relative residual that is asked for of a direct solver; an iterative one has its own
- kept      - finishes the KSP's solves; borrowed. NULL: nothing does.

  Output Parameter:
. check - destroy it with LinearCheckDestroy(), after the KSP

  Notes:
  A solution that misses the tolerance by more than LINEAR_SLACK is refined. The solves are timed (TIMING_SOLVE).

  Source: Higham, Accuracy and Stability of Numerical Algorithms, chapter 12 (refinement in fixed precision).
@*/
PetscErrorCode LinearCheckCreate(KSP ksp, PetscReal tolerance, ReusedFactor kept, LinearCheck *check)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(check));
  (*check)->tolerance = tolerance;
  (*check)->kept      = kept;
  PetscCall(KSPSetPreSolve(ksp, SolveBegins, NULL));
  PetscCall(KSPSetPostSolve(ksp, SolveEnds, *check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearCheckDestroy - frees the check.

  Not collective

  Input Parameter:
. check - may be NULL inside
@*/
PetscErrorCode LinearCheckDestroy(LinearCheck *check)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LinearCheckLost - tells whether the last solve has failed.

  Not collective, the same on all ranks

  Input Parameter:
. check - the check

  Note:
  A solve fails if the factorisation does, if the iterations do, or if the residual is one that only a singular matrix
  leaves.
@*/
PetscBool LinearCheckLost(LinearCheck check)
{
  return check->lost;
}

/*@
  LinearCheckGetCounts - gets what was done in the whole run, before a restart too.

  Not collective, the same on all ranks

  Input Parameter:
. check - the check

  Output Parameter:
. counts - of solves, refinements and factors
@*/
void LinearCheckGetCounts(LinearCheck check, LinearCounts *counts)
{
  *counts = check->counts;
  if (check->kept) ReusedFactorGetCounts(check->kept, &counts->kept);
  counts->kept.made += check->before.made;
  counts->kept.served += check->before.served;
  counts->kept.iterations += check->before.iterations;
  counts->kept.finishing += check->before.finishing;
}

/*@
  LinearCheckArchive - saves the counts of the whole run, or loads them.

  Collective

  Input Parameters:
+ check   - its counts go on from the loaded ones
- archive - saves or loads
@*/
PetscErrorCode LinearCheckArchive(LinearCheck check, Archive archive)
{
  LinearCounts counts;
  PetscInt    *number[] = {&counts.solves,    &counts.refined,     &counts.steps,           &counts.inaccurate,
                           &counts.kept.made, &counts.kept.served, &counts.kept.iterations, &counts.kept.finishing};

  PetscFunctionBeginUser;
  LinearCheckGetCounts(check, &counts);
  PetscCall(ArchiveIntegersAt(archive, "linear/counts", PETSC_STATIC_ARRAY_LENGTH(number), number));
  PetscCall(ArchiveReals(archive, "linear/worst", 1, &counts.worst));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  check->before      = counts.kept;
  check->counts      = counts;
  check->counts.kept = (KeptCounts){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
