#include "linear/reusedfactor.h"
#include "linear/directsolver.h"
#include "rankupdate.h"

/* A factor is kept while at most so many contact terms have come, gone or changed their stiffness since it was made.
   Each is a change of rank one, for which its update takes a fifth of a solve. */
#define REUSED_FACTOR_CHANGES 24
/* A new factor costs as much as 8 (plane problems of some thousand unknowns) to 20 (blocks of 100,000) solves with one:
 * more iterations than these are given up. */
#define REUSED_FACTOR_ITERATIONS 8
/* The residual asked for: this part of the right-hand side, which Newton's method does not notice as it contracts less
   in an iteration that is not the last; with 3e-5 some runs take one more. A factor that leaves out pressures that turn
   with the surface of a pipe between plates leaves 2e-3, an iteration with it 1e-5. */
#define REUSED_FACTOR_TOLERANCE 1e-5
/* But not below this part of what is enough. */
#define REUSED_FACTOR_SHARE 0.1

struct _n_KeptFactor {
  KSP        ksp, gmres;
  Corotation turn;    /* of the bodies since the factor was made; NULL: none */
  Vec        turned;  /* forces turned back */
  RankUpdate update;  /* of the factor to the present contact terms, turned back; NULL: none */
  PetscBool  exists;  /* a factor of this step */
  PetscBool  serves;  /* it is of an older operator than the present one */
  PetscBool  stale;   /* and that one had another pattern */
  PetscInt   changes; /* of contact terms since it was made */
  PetscReal  enough, target;
  KeptCounts counts;
};

/* Ends GMRES; its own test would take the first residual for the right-hand side. */
static PetscErrorCode Converged(KSP gmres, PetscInt it, PetscReal norm, KSPConvergedReason *reason, void *context)
{
  const ReusedFactor kept = context;

  PetscFunctionBeginUser;
  (void)gmres;
  *reason = KSP_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm))
    *reason = KSP_DIVERGED_NANORINF;
  else if (norm <= kept->target)
    *reason = KSP_CONVERGED_RTOL;
  else if (it >= REUSED_FACTOR_ITERATIONS)
    *reason = KSP_DIVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor and its update, for forces and displacements turned back to where it was made. */
static PetscErrorCode Precondition(PC shell, Vec b, Vec x)
{
  ReusedFactor kept;
  PetscBool    turn;
  PC           pc;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(shell, &kept));
  PetscCall(KSPGetPC(kept->ksp, &pc));
  turn = (PetscBool)(kept->turn && kept->serves);
  if (turn && !kept->turned) PetscCall(VecDuplicate(b, &kept->turned));
  if (turn) PetscCall(VecCopy(b, kept->turned));
  if (turn) PetscCall(CorotationApply(kept->turn, PETSC_TRUE, kept->turned));
  PetscCall(PCApply(pc, turn ? kept->turned : b, x));
  if (kept->update) PetscCall(RankUpdateApply(kept->update, x));
  if (turn) PetscCall(CorotationApply(kept->turn, PETSC_FALSE, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorCreate - Collective. The KSP is borrowed; destroy what is kept after it. */
PetscErrorCode ReusedFactorCreate(KSP ksp, ReusedFactor *out)
{
  ReusedFactor kept;
  PC           shell;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&kept));
  kept->ksp = ksp;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)ksp), &kept->gmres));
  PetscCall(KSPSetType(kept->gmres,
                       KSPFGMRES)); /* keeps what the factor has made of its directions: one solve less than GMRES */
  PetscCall(KSPGMRESSetRestart(kept->gmres, REUSED_FACTOR_ITERATIONS));
  PetscCall(KSPSetTolerances(kept->gmres, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, REUSED_FACTOR_ITERATIONS));
  PetscCall(KSPSetConvergenceTest(kept->gmres, Converged, kept, NULL));
  PetscCall(KSPGetPC(kept->gmres, &shell));
  PetscCall(PCSetType(shell, PCSHELL));
  PetscCall(PCShellSetContext(shell, kept));
  PetscCall(PCShellSetApply(shell, Precondition));
  *out = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorDestroy - Collective. */
PetscErrorCode ReusedFactorDestroy(ReusedFactor *kept)
{
  PetscFunctionBeginUser;
  if (!*kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&(*kept)->gmres));
  PetscCall(VecDestroy(&(*kept)->turned));
  PetscCall(RankUpdateDestroy(&(*kept)->update));
  PetscCall(PetscFree(*kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorSetCorotation - Not collective. */
PetscErrorCode ReusedFactorSetCorotation(ReusedFactor kept, Corotation turn)
{
  PetscFunctionBeginUser;
  kept->turn = turn;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorRenew - Not collective. */
PetscErrorCode ReusedFactorRenew(ReusedFactor kept)
{
  PetscFunctionBeginUser;
  kept->exists = PETSC_FALSE;
  kept->enough = 0; /* what the last step was content with */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorSetEnough - Logically collective. */
PetscErrorCode ReusedFactorSetEnough(ReusedFactor kept, PetscReal residual)
{
  PetscFunctionBeginUser;
  kept->enough = residual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor is, or will be, the present operator's. */
static PetscErrorCode ReusedFactorBegin(ReusedFactor kept)
{
  PetscFunctionBeginUser;
  kept->exists  = PETSC_TRUE;
  kept->serves  = PETSC_FALSE;
  kept->stale   = PETSC_FALSE;
  kept->changes = 0;
  kept->counts.made++;
  PetscCall(RankUpdateDestroy(&kept->update));
  if (kept->turn) PetscCall(CorotationBegin(kept->turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorNext - decides whether the factor at hand serves the next operator.

   Collective. changes: the same on all ranks, since the operator before. A pattern that is new makes the solver forget
   its symbolic factorisation, once there is a new factor to be made. */
PetscErrorCode ReusedFactorNext(ReusedFactor kept, PetscInt changes, PetscBool pattern, PetscBool *serves)
{
  PetscBool direct;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverServes(kept->ksp, &direct));
  kept->changes += changes;
  kept->stale  = (PetscBool)(kept->stale || pattern);
  kept->serves = (PetscBool)(direct && kept->exists && kept->changes <= REUSED_FACTOR_CHANGES);
  if (!kept->serves && kept->stale) PetscCall(KSPReset(kept->ksp));
  if (!kept->serves) PetscCall(ReusedFactorBegin(kept));
  if (kept->serves && kept->turn) PetscCall(CorotationFind(kept->turn));
  PetscCall(KSPSetReusePreconditioner(kept->ksp, kept->serves));
  *serves = kept->serves;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorUpdate - Collective. N, which is turned back to where the factor was made, and s as of RankUpdateAdd().
 */
PetscErrorCode ReusedFactorUpdate(ReusedFactor kept, Mat N, const PetscReal *s)
{
  PetscInt n;
  PC       pc;
  Vec      column;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(N, NULL, &n));
  for (PetscInt j = 0; j < n && kept->turn; j++) {
    PetscCall(MatDenseGetColumnVec(N, j, &column));
    PetscCall(CorotationApply(kept->turn, PETSC_TRUE, column));
    PetscCall(MatDenseRestoreColumnVec(N, j, &column));
  }
  PetscCall(KSPGetPC(kept->ksp, &pc));
  PetscCall(RankUpdateAdd(&kept->update, pc, N, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new factor after all. */
static PetscErrorCode FactorAnew(ReusedFactor kept, PC pc, PetscBool *failed)
{
  Mat            A, P;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(PCGetOperators(pc, &A, &P));
  PetscCall(PetscObjectReference((PetscObject)A)); /* PCReset() lets go of them */
  PetscCall(PetscObjectReference((PetscObject)P));
  if (kept->stale) PetscCall(PCReset(pc));
  PetscCall(PCSetOperators(pc, A, P));
  PetscCall(MatDestroy(&A));
  PetscCall(MatDestroy(&P));
  PetscCall(PCSetReusePreconditioner(pc, PETSC_FALSE));
  PetscCall(PCSetUp(pc));
  PetscCall(ReusedFactorBegin(kept));
  PetscCall(PCGetFailedReason(pc, &reason));
  *failed      = reason ? PETSC_TRUE : PETSC_FALSE;
  kept->exists = *failed ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorOwn - Collective. */
PetscErrorCode ReusedFactorOwn(ReusedFactor kept, PetscBool *failed)
{
  PC pc;

  PetscFunctionBeginUser;
  *failed = PETSC_FALSE;
  if (!kept->serves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetPC(kept->ksp, &pc));
  PetscCall(FactorAnew(kept, pc, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r = b - A x and its norm. What the factor at hand makes of b, before it is turned, may be further from the solution
 * than nothing is: x = 0 then. */
static PetscErrorCode Start(Mat A, Vec b, PetscReal right, Vec x, Vec r, PetscReal *left)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, left));
  if (*left < right) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecSet(x, 0));
  PetscCall(VecCopy(b, r));
  *left = right;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x + A^-1 r by GMRES, if the residual r, of norm *left, is too large; *reached: it is no more. */
static PetscErrorCode Iterate(ReusedFactor kept, Mat A, Vec r, Vec x, PetscReal *left, PetscBool *reached)
{
  KSPConvergedReason reason;
  PetscInt           iterations;
  Vec                d;

  PetscFunctionBeginUser;
  *reached = (PetscBool)(*left <= kept->target);
  if (*reached) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(x, &d));
  PetscCall(KSPSetOperators(kept->gmres, A, A));
  PetscCall(KSPSolve(kept->gmres, r, d));
  PetscCall(KSPGetConvergedReason(kept->gmres, &reason));
  PetscCall(KSPGetIterationNumber(kept->gmres, &iterations));
  PetscCall(KSPGetResidualNorm(kept->gmres, left));
  *reached = (PetscBool)(reason > 0);
  if (*reached) PetscCall(VecAXPY(x, 1, d));
  *(kept->serves ? &kept->counts.iterations : &kept->counts.finishing) += iterations;
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x = A^-1 b with a new factor, a whole one where that at hand is A's own: what its border leaves out was not small. */
static PetscErrorCode SolveAnew(ReusedFactor kept, Vec b, Vec x, PetscBool *failed)
{
  Factor factor;
  PC     pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(kept->ksp, &pc));
  if (!kept->serves) {
    PetscCall(DirectSolverFactor(kept->ksp, &factor));
    PetscCall(FactorSetBorder(factor, NULL));
    kept->stale = PETSC_TRUE; /* or the preconditioner takes it for the factor that it has */
  }
  PetscCall(FactorAnew(kept, pc, failed));
  if (!*failed) PetscCall(PCApply(pc, b, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the factor at hand of an older operator, or does it leave a part of its own out, as those with a border do? */
static PetscErrorCode IsRough(ReusedFactor kept, PetscBool *rough)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(kept->ksp, &factor));
  *rough = (PetscBool)(kept->serves || (factor && FactorHasBorder(factor)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorSolve - Collective. x: what the factor at hand makes of b. */
PetscErrorCode ReusedFactorSolve(ReusedFactor kept, Mat A, Vec b, Vec x, PetscReal *tolerance, PetscReal *norm,
                                 PetscBool *failed)
{
  PetscReal right;
  PetscBool reached = PETSC_FALSE, rough = PETSC_FALSE;
  Vec       r;

  PetscFunctionBeginUser;
  *failed = PETSC_FALSE;
  *norm   = -1;
  PetscCall(VecNorm(b, NORM_2, &right));
  PetscCall(IsRough(kept, &rough));
  if (right == 0 || !rough) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(b, &r));
  while (rough && !reached && !*failed) {
    kept->target = PetscMax(REUSED_FACTOR_TOLERANCE * right, REUSED_FACTOR_SHARE * PetscMin(kept->enough, right));
    kept->counts.served += kept->serves;
    if (kept->update) PetscCall(RankUpdateApply(kept->update, x));
    PetscCall(Start(A, b, right, x, r, norm));
    PetscCall(Iterate(kept, A, r, x, norm, &reached));
    if (!reached) PetscCall(SolveAnew(kept, b, x, failed));
    PetscCall(IsRough(kept, &rough));
  }
  if (reached) *tolerance = kept->target / right;
  if (!reached) *norm = -1;
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ReusedFactorGetCounts - what was done so far. Not collective, the same on all ranks. */
void ReusedFactorGetCounts(ReusedFactor kept, KeptCounts *counts)
{
  *counts = kept->counts;
}
