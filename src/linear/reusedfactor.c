/* Solves with an older factor by GMRES, with rotations and updates of low rank. */
#include "linear/reusedfactor.h"
#include "linear/directsolver.h"
#include "rankupdate.h"

/* Largest number of contact terms that may have opened, closed or changed their stiffness since the factor was made.
   Each is a change of rank one; its update takes a fifth of the time of a solve. */
#define REUSED_FACTOR_CHANGES 24
/* Most iterations of a solve with an older factor. A new factor costs as much as 8 (plane problems of some thousand
   unknowns) to 20 (blocks of 100,000) solves with one. */
#define REUSED_FACTOR_ITERATIONS 8
/* Residual that is asked for, in parts of the right-hand side. Newton's method does not notice a residual of this size,
   as it contracts less in an iteration that is not the last; with 3e-5 some runs take one iteration more. A factor that
   leaves out pressures that turn with the surface of a pipe between plates leaves 2e-3; an iteration with it leaves
   1e-5. */
#define REUSED_FACTOR_TOLERANCE 1e-5
/* Least residual that is asked for, in parts of the residual of ReusedFactorSetEnough(). */
#define REUSED_FACTOR_SHARE 0.1

struct _n_ReusedFactor {
  KSP        ksp, gmres;
  Corotation turn;    /* rotations since the factor was made; NULL: none */
  Vec        turned;  /* right-hand side, rotated back */
  RankUpdate update;  /* from the factor to the present contact terms, rotated back; NULL: none */
  PetscBool  exists;  /* there is a factor of this step */
  PetscBool  serves;  /* the factor is that of an older operator */
  PetscBool  stale;   /* that operator had another pattern */
  PetscInt   changes; /* number of changes of contact terms since the factor was made */
  PetscReal  enough, target;
  KeptCounts counts;
};

/* Ends GMRES. GMRES's own test would compare with the first residual instead of the right-hand side. */
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

/* Applies the factor and its update to a right-hand side that is rotated back to the state of the factor; rotates the
   result forward. */
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

/*@
  ReusedFactorCreate - creates the reuse of a KSP's factor.

  Collective

  Input Parameter:
. ksp - factors (KSPPREONLY); borrowed. If options have made it another solver it is left alone.

  Output Parameter:
. out - destroy it with ReusedFactorDestroy(), after the KSP
@*/
PetscErrorCode ReusedFactorCreate(KSP ksp, ReusedFactor *out)
{
  ReusedFactor kept;
  PC           shell;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&kept));
  kept->ksp = ksp;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)ksp), &kept->gmres));
  PetscCall(
    KSPSetType(kept->gmres, KSPFGMRES)); /* FGMRES keeps the preconditioned directions: one solve less than GMRES */
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

/*@
  ReusedFactorDestroy - frees the reuse of a factor.

  Collective

  Input Parameter:
. kept - may be NULL inside
@*/
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

/*@
  ReusedFactorSetCorotation - tells that the operators are tangents of bodies that rotate.

  Not collective

  Input Parameters:
+ kept - the reuse of a factor
- turn - the rotations; borrowed. CorotationMove() must give them each new state before ReusedFactorNext().
@*/
PetscErrorCode ReusedFactorSetCorotation(ReusedFactor kept, Corotation turn)
{
  PetscFunctionBeginUser;
  kept->turn = turn;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ReusedFactorRenew - has the next operator factored, whatever has changed.

  Not collective

  Input Parameter:
. kept - the reuse of a factor
@*/
PetscErrorCode ReusedFactorRenew(ReusedFactor kept)
{
  PetscFunctionBeginUser;
  kept->exists = PETSC_FALSE;
  kept->enough = 0; /* this was for the last step */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ReusedFactorSetEnough - sets the residual that is enough for the caller.

  Logically collective

  Input Parameters:
+ kept     - the reuse of a factor
- residual - 2-norm (a force), such as the one that ends Newton's method; solves may leave a small part of it
@*/
PetscErrorCode ReusedFactorSetEnough(ReusedFactor kept, PetscReal residual)
{
  PetscFunctionBeginUser;
  kept->enough = residual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes that the factor is, or will be, that of the present operator. */
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

/*@
  ReusedFactorNext - decides whether the present factor serves the next operator.

  Collective

  Input Parameters:
+ kept    - the reuse of a factor
. changes - contact terms that opened, closed or changed their stiffness since the last operator; the same on all ranks
- pattern - the operator has a new pattern

  Output Parameter:
. serves - the factor serves, and the KSP makes no new one. If there are changes, ReusedFactorUpdate() must follow.

  Notes:
  Call it before each solve with a new operator.

  With a new pattern the solver forgets its symbolic factorisation when the next factor is made.
@*/
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

/*@
  ReusedFactorUpdate - tells the older factor what has changed of the contact terms.

  Collective

  Input Parameters:
+ kept - the reuse of a factor, after ReusedFactorNext() has found that the factor serves
. N    - the changes are N diag(s) N^T; dense. It is overwritten with its columns rotated back to the factor's state.
- s    - as of RankUpdateAdd()
@*/
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

/* Makes a new factor after all. */
static PetscErrorCode FactorAnew(ReusedFactor kept, PC pc, PetscBool *failed)
{
  Mat            A, P;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(PCGetOperators(pc, &A, &P));
  PetscCall(PetscObjectReference((PetscObject)A)); /* PCReset() releases the operators */
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

/*@
  ReusedFactorOwn - makes the factor that of the present operator, where it is an older one.

  Collective

  Input Parameter:
. kept - the reuse of a factor, after ReusedFactorSolve()

  Output Parameter:
. failed - a factor had to be made and could not be

  Note:
  A factor with a border still leaves out a small part of the operator.
@*/
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

/* Computes r = b - A x and its norm. What the factor finds for b without rotations may be further from the solution
   than x = 0; x is 0 then. */
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

/* Adds A^-1 r to x by GMRES if the residual r of norm *left is too large. *reached: it no longer is. */
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

/* Solves A x = b with a new factor. If the present factor is A's own already, the part that its border leaves out was
   not small; the new factor then has no border. */
static PetscErrorCode SolveAnew(ReusedFactor kept, Vec b, Vec x, PetscBool *failed)
{
  Factor factor;
  PC     pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(kept->ksp, &pc));
  if (!kept->serves) {
    PetscCall(DirectSolverFactor(kept->ksp, &factor));
    PetscCall(FactorSetBorder(factor, NULL));
    kept->stale = PETSC_TRUE; /* otherwise the preconditioner would keep the factor that it has */
  }
  PetscCall(FactorAnew(kept, pc, failed));
  if (!*failed) PetscCall(PCApply(pc, b, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether the factor is only near A: that of an older operator, or one with a border, which leaves a part out. */
static PetscErrorCode IsRough(ReusedFactor kept, PetscBool *rough)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(DirectSolverFactor(kept->ksp, &factor));
  *rough = (PetscBool)(kept->serves || (factor && FactorHasBorder(factor)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ReusedFactorSolve - finishes the KSP's solve of A x = b, if its factor is only near A.

  Collective

  Input Parameters:
+ kept - the reuse of a factor
. A    - the operator
- b    - right-hand side

  Input and Output Parameters:
+ x         - what the KSP's factor has found for b; then the solution
- tolerance - relative residual that was asked for; unchanged where the factor alone has solved

  Output Parameters:
+ norm   - 2-norm of the residual; negative: not known
- failed - a factor had to be made and could not be

  Note:
  Iterations start from x. Where they do not converge a new factor is made.
@*/
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

/*@
  ReusedFactorIsOwn - tells whether the factor is that of the present operator.

  Not collective, the same on all ranks

  Input Parameter:
. kept - the reuse of a factor, after ReusedFactorSolve()
@*/
PetscBool ReusedFactorIsOwn(ReusedFactor kept)
{
  return (PetscBool)!kept->serves;
}

/*@
  ReusedFactorGetCounts - gets what was done so far.

  Not collective, the same on all ranks

  Input Parameter:
. kept - the reuse of a factor

  Output Parameter:
. counts - since ReusedFactorCreate()
@*/
void ReusedFactorGetCounts(ReusedFactor kept, KeptCounts *counts)
{
  *counts = kept->counts;
}
