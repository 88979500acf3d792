/* Factorisation by MUMPS as the preconditioner of a KSP that applies it once. Every system that is solved directly is
   solved by this: tangents, and the contact interface of the iterative solver.

   DirectSolverSet() sets a KSP up. DirectSolverOrder() compares orderings, once, where many factors are to come. The
   other functions find what options have left of the set-up, and give the factor for further solves. */
#pragma once
#include "linear/factor.h"

PetscErrorCode DirectSolverSet(KSP, PetscBool symmetric);
PetscErrorCode DirectSolverServes(KSP, PetscBool *);
PetscErrorCode DirectSolverFactor(KSP, Factor *);
PetscErrorCode DirectSolverOrder(KSP, Mat A, PetscBool *thin);
PetscErrorCode DirectSolverColumns(PC, Mat B, Mat X);
