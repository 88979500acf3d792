#include "keptfactor.h"
#include "directsolver.h"
#include "rankupdate.h"

/* A factor is kept while at most so many contact terms have come, gone or changed their stiffness since it was made. Each is a change of rank one, for which
   its update takes a fifth of a solve. */
#define KEPT_CHANGES 24
/* A new factor costs as much as 8 (plane problems of some thousand unknowns) to 20 (blocks of 100,000) solves with one: more iterations than these are given
 * up. */
#define KEPT_ITERATIONS 8
/* The residual asked for: this part of the right-hand side, which Newton's method does not notice as it contracts less in an iteration that is not the last,
 * ... */
#define KEPT_TOLERANCE 1e-5
/* ... but not below this part of what ends Newton's method. */
#define KEPT_SHARE 0.1

struct _n_KeptFactor {
  KSP        ksp, gmres;
  NodeTurn   turn;    /* of the bodies since the factor was made; NULL: none */
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
  const KeptFactor kept = context;

  PetscFunctionBeginUser;
  (void)gmres;
  *reason = KSP_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm))
    *reason = KSP_DIVERGED_NANORINF;
  else if (norm <= kept->target)
    *reason = KSP_CONVERGED_RTOL;
  else if (it >= KEPT_ITERATIONS)
    *reason = KSP_DIVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor and its update, for forces and displacements turned back to where it was made. */
static PetscErrorCode Precondition(PC shell, Vec b, Vec x)
{
  KeptFactor kept;
  PC         pc;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(shell, &kept));
  PetscCall(KSPGetPC(kept->ksp, &pc));
  if (kept->turn && !kept->turned) PetscCall(VecDuplicate(b, &kept->turned));
  if (kept->turn) PetscCall(VecCopy(b, kept->turned));
  if (kept->turn) PetscCall(NodeTurnApply(kept->turn, PETSC_TRUE, kept->turned));
  PetscCall(PCApply(pc, kept->turn ? kept->turned : b, x));
  if (kept->update) PetscCall(RankUpdateApply(kept->update, x));
  if (kept->turn) PetscCall(NodeTurnApply(kept->turn, PETSC_FALSE, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorCreate - Collective. The KSP is borrowed; destroy what is kept after it. */
PetscErrorCode KeptFactorCreate(KSP ksp, KeptFactor *out)
{
  KeptFactor kept;
  PC         shell;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&kept));
  kept->ksp = ksp;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)ksp), &kept->gmres));
  PetscCall(KSPSetType(kept->gmres, KSPFGMRES)); /* keeps what the factor has made of its directions: one solve less than GMRES */
  PetscCall(KSPGMRESSetRestart(kept->gmres, KEPT_ITERATIONS));
  PetscCall(KSPSetTolerances(kept->gmres, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, KEPT_ITERATIONS));
  PetscCall(KSPSetConvergenceTest(kept->gmres, Converged, kept, NULL));
  PetscCall(KSPSetInitialGuessNonzero(kept->gmres, PETSC_TRUE));
  PetscCall(KSPGetPC(kept->gmres, &shell));
  PetscCall(PCSetType(shell, PCSHELL));
  PetscCall(PCShellSetContext(shell, kept));
  PetscCall(PCShellSetApply(shell, Precondition));
  *out = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorDestroy - Collective. */
PetscErrorCode KeptFactorDestroy(KeptFactor *kept)
{
  PetscFunctionBeginUser;
  if (!*kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&(*kept)->gmres));
  PetscCall(VecDestroy(&(*kept)->turned));
  PetscCall(RankUpdateDestroy(&(*kept)->update));
  PetscCall(PetscFree(*kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorSetTurn - Not collective. */
PetscErrorCode KeptFactorSetTurn(KeptFactor kept, NodeTurn turn)
{
  PetscFunctionBeginUser;
  kept->turn = turn;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorRenew - Not collective. */
PetscErrorCode KeptFactorRenew(KeptFactor kept)
{
  PetscFunctionBeginUser;
  kept->exists = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorSetEnough - Logically collective. */
PetscErrorCode KeptFactorSetEnough(KeptFactor kept, PetscReal residual)
{
  PetscFunctionBeginUser;
  kept->enough = residual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor is, or will be, the present operator's. */
static PetscErrorCode Begin(KeptFactor kept)
{
  PetscFunctionBeginUser;
  kept->exists  = PETSC_TRUE;
  kept->serves  = PETSC_FALSE;
  kept->stale   = PETSC_FALSE;
  kept->changes = 0;
  kept->counts.made++;
  PetscCall(RankUpdateDestroy(&kept->update));
  if (kept->turn) PetscCall(NodeTurnBegin(kept->turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorNext - decides whether the factor at hand serves the next operator.

   Collective. changes: the same on all ranks, since the operator before. A pattern that is new makes the solver forget its symbolic factorisation,
   once there is a new factor to be made. */
PetscErrorCode KeptFactorNext(KeptFactor kept, PetscInt changes, PetscBool pattern, PetscBool *serves)
{
  PetscBool direct;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverServes(kept->ksp, &direct));
  kept->changes += changes;
  kept->stale  = (PetscBool)(kept->stale || pattern);
  kept->serves = (PetscBool)(direct && kept->exists && kept->changes <= KEPT_CHANGES);
  if (!kept->serves && kept->stale) PetscCall(KSPReset(kept->ksp));
  if (!kept->serves) PetscCall(Begin(kept));
  if (kept->serves && kept->turn) PetscCall(NodeTurnFind(kept->turn));
  PetscCall(KSPSetReusePreconditioner(kept->ksp, kept->serves));
  *serves = kept->serves;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorUpdate - Collective. N, which is turned back to where the factor was made, and s as of RankUpdateAdd(). */
PetscErrorCode KeptFactorUpdate(KeptFactor kept, Mat N, const PetscReal *s)
{
  PetscInt n;
  PC       pc;
  Vec      column;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(N, NULL, &n));
  for (PetscInt j = 0; j < n && kept->turn; j++) {
    PetscCall(MatDenseGetColumnVec(N, j, &column));
    PetscCall(NodeTurnApply(kept->turn, PETSC_TRUE, column));
    PetscCall(MatDenseRestoreColumnVec(N, j, &column));
  }
  PetscCall(KSPGetPC(kept->ksp, &pc));
  PetscCall(RankUpdateAdd(&kept->update, pc, N, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new factor after all. */
static PetscErrorCode FactorAnew(KeptFactor kept, PC pc, Mat A, PetscBool *failed)
{
  PCFailedReason reason;

  PetscFunctionBeginUser;
  if (kept->stale) PetscCall(PCReset(pc));
  PetscCall(PCSetOperators(pc, A, A));
  PetscCall(PCSetReusePreconditioner(pc, PETSC_FALSE));
  PetscCall(PCSetUp(pc));
  PetscCall(Begin(kept));
  PetscCall(PCGetFailedReason(pc, &reason));
  *failed      = reason ? PETSC_TRUE : PETSC_FALSE;
  kept->exists = *failed ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorOwn - Collective. */
PetscErrorCode KeptFactorOwn(KeptFactor kept, Mat A, PetscBool *failed)
{
  PC pc;

  PetscFunctionBeginUser;
  *failed = PETSC_FALSE;
  if (!kept->serves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetPC(kept->ksp, &pc));
  PetscCall(FactorAnew(kept, pc, A, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the factor at hand makes of b, before it is turned, may be further from the solution than nothing is. */
static PetscErrorCode ChooseStart(Mat A, Vec b, PetscReal right, Vec x)
{
  PetscReal left;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(b, &r));
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &left));
  if (!(left < right)) PetscCall(VecSet(x, 0));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorSolve - Collective. x: what the factor at hand makes of b. */
PetscErrorCode KeptFactorSolve(KeptFactor kept, Mat A, Vec b, Vec x, PetscReal *tolerance, PetscBool *failed)
{
  KSPConvergedReason reason;
  PetscInt           iterations;
  PetscReal          right;
  PC                 pc;

  PetscFunctionBeginUser;
  *failed = PETSC_FALSE;
  PetscCall(VecNorm(b, NORM_2, &right));
  if (!kept->serves || right == 0) PetscFunctionReturn(PETSC_SUCCESS);
  kept->target = PetscMax(KEPT_TOLERANCE * right, KEPT_SHARE * kept->enough);
  PetscCall(KSPGetPC(kept->ksp, &pc));
  if (kept->update) PetscCall(RankUpdateApply(kept->update, x));
  if (kept->turn) PetscCall(ChooseStart(A, b, right, x));
  PetscCall(KSPSetOperators(kept->gmres, A, A));
  PetscCall(KSPSolve(kept->gmres, b, x));
  PetscCall(KSPGetConvergedReason(kept->gmres, &reason));
  PetscCall(KSPGetIterationNumber(kept->gmres, &iterations));
  kept->counts.served++;
  kept->counts.iterations += iterations;
  if (reason > 0)
    *tolerance = kept->target / right;
  else
    PetscCall(FactorAnew(kept, pc, A, failed));
  if (reason <= 0 && !*failed) PetscCall(PCApply(pc, b, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KeptFactorGetCounts - what was done so far. Not collective, the same on all ranks. */
void KeptFactorGetCounts(KeptFactor kept, KeptCounts *counts)
{
  *counts = kept->counts;
}
