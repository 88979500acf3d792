#include "linear/directsolver.h"
#include "base/petsccompat.h"
#include "matrix/sumoperator.h"

/* Unknowns from which on orderings are compared: below, a factorisation is not what a run spends its time with. */
#define DIRECT_COMPARED 3000
/* Takes METIS's dissection unless another ordering needs less than this part of its operations: it cuts the work into
   even parts, for ranks and for large fronts. */
#define DIRECT_BETTER 0.9

/* Where dissection of n unknowns takes more than this many n^2 operations they fill space (9 to 12 n^2 on rings and
   spheres), and nothing does with fewer. On walls and in planes it goes with n^1.5 (1 to 2 n^2 at 15,000 and 60,000),
   and others are looked at. Source: George, SIAM J. Numer. Anal. 10, 1973. */
#define DIRECT_THICK 5

/* What the factorisation is called, among preconditioners. */
#define DIRECT_NAME "mumps"

/* Orderings that are compared with METIS's dissection: approximate minimum fill and degree take 0.67 to 0.8 of its
   operations on thin walls of second-order bricks, and 1.5 times as many on thick blocks. */
static const int DirectOthers[] = {FACTOR_MINIMUM_FILL, FACTOR_MINIMUM_DEGREE};

/* Factors all of the operator: where it is a sum, P is but one term of it. */
static PetscErrorCode MakeWhole(Factor factor, Mat A, Mat P, PCFailedReason *reason)
{
  Mat whole;

  PetscFunctionBeginUser;
  PetscCall(SumOperatorMerge(A, &whole));
  PetscCall(FactorMake(factor, whole ? whole : P, reason));
  PetscCall(MatDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a border makes up for what P lacks of A, and its factor fails, that of A is made. */
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

/* DirectSolverSet - sets a KSP up to factor its operator.

   Collective. symmetric: every operator will be; MUMPS then factors L D L^T, which need not be positive definite.
   Options Database Keys: those of the KSP, and MUMPS's own (-mat_mumps_icntl_...) for all direct solves. */
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

/* DirectSolverServes - does a KSP still factor and solve once, whatever options have said? Not collective. */
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

/* DirectSolverFactor - Not collective; borrowed. */
PetscErrorCode DirectSolverFactor(KSP ksp, Factor *factor)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(FactorOfPC(pc, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Operations with an ordering; infinite where the analysis fails */
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

/* DirectSolverOrder - the KSP's factors from now on are ordered as needs the fewest operations for A.

   Collective. A: a matrix much like those to come; only its pattern counts. Costs one to three analyses, each about a
   third of a factorisation at 10,000 unknowns and less above. One that the user has chosen (-mat_mumps_icntl_7) stays.
 */
PetscErrorCode DirectSolverOrder(KSP ksp, Mat A, PetscBool *thin)
{
  int       ordering = FACTOR_METIS;
  PetscReal best, operations;
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
  *thin = (PetscBool)(best <= DIRECT_THICK * (PetscReal)n * (PetscReal)n);
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

/* DirectSolverColumns - X = A^-1 B for dense B and X. Collective. */
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
