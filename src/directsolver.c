#include "directsolver.h"

/* Workspace of MUMPS above its estimate, in per cent. Its own 20 is too little for symmetric systems of a few thousand dofs on four ranks. */
#define DIRECT_WORKSPACE "100"
/* How MUMPS scales symmetric systems: by the diagonal. Its own choice iterates over rows and columns, which costs a seventh of a factorisation at 10,000
   dofs; stiff penalties stand on the diagonal. */
#define DIRECT_SCALING "1"
/* Unknowns from which on orderings are compared: below, a factorisation is not what a run spends its time with. */
#define DIRECT_COMPARED 4000

/* MUMPS's orderings that are compared, its own choice first: that goes by the number of unknowns, while approximate minimum fill (2) and degree (0) take 0.67
   to 0.8 of its operations on thin walls of second-order bricks, and 1.5 times as many on thick blocks. */
static const char *const DirectOrderings[] = {"7", "2", "0"};
#define DIRECT_ORDERING "-mat_mumps_icntl_7"

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

/* DirectSolverSet - sets a KSP up to factor its operator.

   Collective. symmetric: every operator will be; MUMPS then factors L D L^T, which need not be positive definite.
   Options Database Keys: those of the KSP, and MUMPS's own (-mat_mumps_icntl_...) for all direct solves. */
PetscErrorCode DirectSolverSet(KSP ksp, PetscBool symmetric)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(SetDefaultOption("-mat_mumps_icntl_14", DIRECT_WORKSPACE));
  if (symmetric) PetscCall(SetDefaultOption("-mat_mumps_icntl_8", DIRECT_SCALING));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* DirectSolverServes - does a KSP still factor and solve once, whatever options have said? Not collective. */
PetscErrorCode DirectSolverServes(KSP ksp, PetscBool *serves)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, serves));
  if (!*serves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, serves, PCCHOLESKY, PCLU, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* DirectSolverFind - is a KSP's preconditioner a factorisation by MUMPS, and a symmetric one? Not collective. */
PetscErrorCode DirectSolverFind(KSP ksp, PetscBool *mumps, PetscBool *cholesky)
{
  PC            pc;
  PetscBool     lu;
  MatSolverType type = NULL;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, cholesky));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  *mumps = PETSC_FALSE;
  if (*cholesky || lu) PetscCall(PCFactorGetMatSolverType(pc, &type));
  if (type) PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, mumps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Operations of a factorisation of A with MUMPS's options as they are, by its analysis */
static PetscErrorCode CountOperations(Mat A, PetscBool symmetric, PetscReal *operations)
{
  MatFactorInfo info;
  Mat           F;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, symmetric ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU, &F));
  if (symmetric)
    PetscCall(MatCholeskyFactorSymbolic(F, A, NULL, &info));
  else
    PetscCall(MatLUFactorSymbolic(F, A, NULL, NULL, &info));
  PetscCall(MatMumpsGetRinfog(F, 1, operations));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* DirectSolverOrder - all factors from now on are ordered as needs the fewest operations for A.

   Collective. A: a matrix much like those to come; only its pattern counts. Costs three analyses, each about a third of a factorisation at 10,000 unknowns and
   less above. One that the user has chosen (-mat_mumps_icntl_7) stays. */
PetscErrorCode DirectSolverOrder(Mat A, PetscBool symmetric)
{
  const char *ordering = DirectOrderings[0];
  PetscReal   best     = PETSC_MAX_REAL, operations;
  PetscInt    n;
  PetscBool   given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, DIRECT_ORDERING, &given));
  PetscCall(MatGetSize(A, &n, NULL));
  if (given || n < DIRECT_COMPARED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, symmetric));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(DirectOrderings); i++) {
    PetscCall(PetscOptionsSetValue(NULL, DIRECT_ORDERING, DirectOrderings[i])); /* MatMumpsSetIcntl() comes too late or is forgotten, by PETSc's version */
    PetscCall(CountOperations(A, symmetric, &operations));
    if (operations >= best) continue;
    best     = operations;
    ordering = DirectOrderings[i];
  }
  PetscCall(PetscOptionsSetValue(NULL, DIRECT_ORDERING, ordering));
  PetscCall(PetscInfo(A, "MUMPS's ordering %s takes the fewest operations: %g\n", ordering, (double)best));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The entries of a dense matrix of one rank that differ from zero, transposed. */
static PetscErrorCode SparseRows(Mat B, Mat *rows)
{
  PetscInt           m, n, *nonzeros, *place;
  const PetscScalar *b;
  PetscScalar       *value;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, &m, &n));
  PetscCall(PetscCalloc1(n, &nonzeros));
  PetscCall(PetscMalloc2(m, &place, m, &value));
  PetscCall(MatDenseGetArrayRead(B, &b));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < m; i++) nonzeros[j] += b[j * m + i] != 0;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, n, m, 0, nonzeros, rows));
  for (PetscInt j = 0; j < n; j++) {
    PetscInt k = 0;

    for (PetscInt i = 0; i < m && k < nonzeros[j]; i++) {
      place[k] = i;
      value[k] = b[j * m + i];
      k += value[k] != 0;
    }
    PetscCall(MatSetValues(*rows, 1, &j, k, place, value, INSERT_VALUES));
  }
  PetscCall(MatDenseRestoreArrayRead(B, &b));
  PetscCall(MatAssemblyBegin(*rows, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*rows, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(place, value));
  PetscCall(PetscFree(nonzeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* DirectSolverColumns - X = A^-1 B for dense B and X.

   Collective. factored: A's factor. B with few entries that differ from zero, as forces on contact nodes have: on one rank MUMPS is given these alone, and
   eliminates only what they reach (its ICNTL(20)), half of the solve's time. On more ranks it would want them gathered on the first. */
PetscErrorCode DirectSolverColumns(Mat factored, Mat B, Mat X)
{
  MatSolverType type;
  PetscMPIInt   size;
  PetscBool     mumps;
  Mat           rows, sparse;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)B), &size));
  PetscCall(MatFactorGetSolverType(factored, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (size > 1 || !mumps) {
    PetscCall(MatMatSolve(factored, B, X));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SparseRows(B, &rows));
  PetscCall(MatCreateTranspose(rows, &sparse));
  PetscCall(MatMatSolve(factored, sparse, X));
  PetscCall(MatDestroy(&sparse));
  PetscCall(MatDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
