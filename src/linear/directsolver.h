/* Factorisation by MUMPS, wherever a system is solved directly. */
#pragma once
#include "linear/factor.h"

/* Sets a KSP up to factor its operator; symmetric: every operator will be. Options set on the KSP later win.
 * Collective. */
PetscErrorCode DirectSolverSet(KSP, PetscBool symmetric);
/* Does it, after options, factor its operator and solve once? Not collective. */
PetscErrorCode DirectSolverServes(KSP, PetscBool *);
/* What it factors with; NULL: options have replaced it. Not collective; borrowed. */
PetscErrorCode DirectSolverFactor(KSP, Factor *);
/* Chooses the ordering of its factors from now on: the one that needs the fewest operations for A, a matrix much like
   those to come. *thin: A is that of walls or planes, not of bodies that fill space, and large enough for orderings to
   matter; no where the user has chosen one. Collective. */
PetscErrorCode DirectSolverOrder(KSP, Mat A, PetscBool *thin);
/* X = A^-1 B for dense B and X, with the preconditioner of a KSP that serves, which has A's factor; that most of B is
 * zero is made use of. Collective. */
PetscErrorCode DirectSolverColumns(PC, Mat B, Mat X);
