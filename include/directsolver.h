/* Factorisation by MUMPS, wherever a system is solved directly. */
#pragma once
#include "petsccompat.h"

/* Sets a KSP up to factor its operator; symmetric: every operator will be. Options set on the KSP later win. Collective. */
PetscErrorCode DirectSolverSet(KSP, PetscBool symmetric);
/* Does it, after options, factor its operator and solve once? Not collective. */
PetscErrorCode DirectSolverServes(KSP, PetscBool *);
/* Is its preconditioner, after options, a factorisation by MUMPS, and a symmetric one? Not collective. */
PetscErrorCode DirectSolverFind(KSP, PetscBool *mumps, PetscBool *cholesky);
/* Chooses the ordering of all factors from now on: the one that needs the fewest operations for A, a matrix much like those to come. Collective. */
PetscErrorCode DirectSolverOrder(Mat A, PetscBool symmetric);
/* X = A^-1 B for dense B and X, with the factor of A; that most of B is zero is made use of. Collective. */
PetscErrorCode DirectSolverColumns(Mat factored, Mat B, Mat X);
