/* Factorisation by MUMPS, wherever a system is solved directly. */
#pragma once
#include "petsccompat.h"

/* Sets a KSP up to factor its operator; symmetric: every operator will be. Options set on the KSP later win. Collective. */
PetscErrorCode DirectSolverSet(KSP, PetscBool symmetric);
