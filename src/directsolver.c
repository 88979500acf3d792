#include "directsolver.h"

/* Workspace of MUMPS above its estimate, in per cent. Its own 20 is too little for symmetric systems of a few thousand dofs on four ranks. */
#define DIRECT_WORKSPACE "100"
/* How MUMPS scales symmetric systems: by the diagonal. Its own choice iterates over rows and columns, which costs a seventh of a factorisation at 10,000
   dofs; stiff penalties stand on the diagonal. */
#define DIRECT_SCALING "1"

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
