/* Factorisation by MUMPS as a shell preconditioner. */
#include "linear/directsolver.h"
#include "base/petsccompat.h"
#include "matrix/sumoperator.h"

/* Number of unknowns from which on orderings are compared. Below it a factorisation is not what a run spends its time
   with. */
#define DIRECT_COMPARED 3000
/* Part of METIS's operations that another ordering may need at most to be taken instead. METIS's dissection cuts the
   work into even parts, for ranks and for large fronts, so it is preferred. */
#define DIRECT_BETTER 0.9

/* Operations of METIS's dissection for a symmetric matrix, in parts of n^2 for n unknowns, above which bodies fill
   space. There it takes 9 to 12 n^2 on rings and spheres, and no ordering takes fewer. On walls and in planes
   operations grow with n^1.5 (1 to 2 n^2 at 15,000 and 60,000 unknowns), and other orderings are tried. Source: George,
   SIAM J. Numer. Anal. 10, 1973. */
#define DIRECT_THICK 5

/* A factor L U takes this many times the operations of L D L^T with the same pattern. */
#define DIRECT_UNSYMMETRIC 2

/* The name of the shell preconditioner, by which it is recognised. */
#define DIRECT_NAME "mumps"

/* Orderings that are compared with METIS's dissection. Approximate minimum fill and degree take 0.67 to 0.8 of its
   operations on thin walls of second-order bricks, and 1.5 times as many on thick blocks. */
static const int DirectOthers[] = {FACTOR_MINIMUM_FILL, FACTOR_MINIMUM_DEGREE};

/* Factors the whole operator. Where it is a sum, P is but one term of it. */
static PetscErrorCode MakeWhole(Factor factor, Mat A, Mat P, PCFailedReason *reason)
{
  Mat whole;

  PetscFunctionBeginUser;
  PetscCall(SumOperatorMerge(A, &whole));
  PetscCall(FactorMake(factor, whole ? whole : P, reason));
  PetscCall(MatDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors P with its border, where there is one: it makes up for what P lacks of A. Where that fails A is factored. */
static PetscErrorCode DirectSolverSetUp(PC pc)
{
  Factor         factor;
  Mat            A, P;
  PCFailedReason reason = PC_NOERROR;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(PCGetOperators(pc, &A, &P));
  if (FactorHasBorder(factor)) PetscCall(FactorMake(factor, P, &reason));
  if (reason) PetscCall(FactorSetBorder(factor, NULL));
  if (reason || !FactorHasBorder(factor)) PetscCall(MakeWhole(factor, A, P, &reason));
  PetscCall(PCSetFailedReason(pc, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DirectSolverApply(PC pc, Vec b, Vec x)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(FactorSolve(factor, b, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DirectSolverDestroy(PC pc)
{
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(FactorDestroy(&factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DirectSolverSet - sets a KSP up to factor its operator by MUMPS.

  Collective

  Input Parameters:
+ ksp       - the solver; options that are set on it later take precedence
- symmetric - every operator will be symmetric; MUMPS then factors L D L^T, which need not be positive definite

  Options Database Keys:
+ -mat_mumps_icntl_<number> <integer> - one of MUMPS's integer parameters, for all direct solves
- -mat_mumps_cntl_<number> <real>     - one of MUMPS's real parameters, for all direct solves
@*/
PetscErrorCode DirectSolverSet(KSP ksp, PetscBool symmetric)
{
  PC     pc;
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(FactorCreate(PetscObjectComm((PetscObject)ksp), symmetric, &factor));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, DIRECT_NAME));
  PetscCall(PCShellSetContext(pc, factor));
  PetscCall(PCShellSetSetUp(pc, DirectSolverSetUp));
  PetscCall(PCShellSetApply(pc, DirectSolverApply));
  PetscCall(PCShellSetDestroy(pc, DirectSolverDestroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the factor of a PC that DirectSolverSet() has set up; NULL where options have put another in its place. */
static PetscErrorCode FactorOfPC(PC pc, Factor *factor)
{
  const char *name = NULL;
  PetscBool   is;

  PetscFunctionBeginUser;
  *factor = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &is));
  if (is) PetscCall(PCShellGetName(pc, &name));
  if (is) PetscCall(PetscStrcmp(name, DIRECT_NAME, &is));
  if (is) PetscCall(PCShellGetContext(pc, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DirectSolverServes - tells whether a KSP still factors its operator and solves once, whatever options have set.

  Not collective

  Input Parameter:
. ksp - after DirectSolverSet() and KSPSetFromOptions()

  Output Parameter:
. serves - it does, by MUMPS or by another factorisation
@*/
PetscErrorCode DirectSolverServes(KSP ksp, PetscBool *serves)
{
  PC     pc;
  Factor factor;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, serves));
  if (!*serves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(FactorOfPC(pc, &factor));
  if (!factor) PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, serves, PCCHOLESKY, PCLU, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DirectSolverFactor - gets the factor of a KSP.

  Not collective

  Input Parameter:
. ksp - after DirectSolverSet()

  Output Parameter:
. factor - borrowed; NULL: options have replaced it
@*/
PetscErrorCode DirectSolverFactor(KSP ksp, Factor *factor)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(FactorOfPC(pc, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the operations with an ordering; infinite where the analysis fails. */
static PetscErrorCode CountOperations(Factor factor, int ordering, Mat A, PetscReal *operations)
{
  FactorCost     cost;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(FactorSetOrdering(factor, ordering, NULL));
  PetscCall(FactorAnalyse(factor, A, &reason));
  FactorGetCost(factor, &cost);
  *operations = reason ? PETSC_INFINITY : cost.operations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DirectSolverOrder - orders the KSP's factors from now on so that a matrix takes the fewest operations.

  Collective

  Input Parameters:
+ ksp - after DirectSolverSet()
- A   - a matrix much like those to come; only its pattern counts

  Output Parameter:
. thin - A is that of walls or planes, not of bodies that fill space, and is so large that orderings matter. PETSC_FALSE
         where the user has chosen an ordering (-mat_mumps_icntl_7), which stays.

  Note:
  It takes one to three analyses. Each costs about a third of a factorisation at 10,000 unknowns, and less above.
@*/
PetscErrorCode DirectSolverOrder(KSP ksp, Mat A, PetscBool *thin)
{
  int       ordering = FACTOR_METIS;
  PetscReal best, most, operations;
  PetscInt  n;
  PetscBool chosen;
  Factor    factor;

  PetscFunctionBeginUser;
  *thin = PETSC_FALSE;
  PetscCall(DirectSolverFactor(ksp, &factor));
  PetscCall(MatGetSize(A, &n, NULL));
  if (!factor || n < DIRECT_COMPARED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FactorSetOrdering(factor, ordering, &chosen));
  if (!chosen) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CountOperations(factor, FACTOR_METIS, A, &best));
  most  = DIRECT_THICK * (PetscReal)n * (PetscReal)n;
  *thin = (PetscBool)(best <= (FactorIsSymmetric(factor) ? most : DIRECT_UNSYMMETRIC * most));
  best *= DIRECT_BETTER;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(DirectOthers) && *thin; i++) {
    PetscCall(CountOperations(factor, DirectOthers[i], A, &operations));
    if (operations >= best) continue;
    best     = operations;
    ordering = DirectOthers[i];
  }
  PetscCall(FactorSetOrdering(factor, ordering, NULL));
  PetscCall(PetscInfo(A, "MUMPS's ordering %d takes the fewest operations: %g\n", ordering, (double)best));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DirectSolverColumns - solves A X = B for dense B and X.

  Collective

  Input Parameters:
+ pc - preconditioner with A's factor, of a KSP that DirectSolverServes() accepts
- B  - right-hand sides; zeros in them save time

  Output Parameter:
. X - solutions
@*/
PetscErrorCode DirectSolverColumns(PC pc, Mat B, Mat X)
{
  Factor factor;
  Mat    factored;

  PetscFunctionBeginUser;
  PetscCall(FactorOfPC(pc, &factor));
  if (factor)
    PetscCall(FactorSolveColumns(factor, B, X));
  else {
    PetscCall(PCFactorGetMatrix(pc, &factored));
    PetscCall(MatMatSolve(factored, B, X));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
