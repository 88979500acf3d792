/* Is what the linear solver returns a solution? After each solve of a KSP the true residual |b - A x| / |b| is looked
   at; one that is too large is refined with the factor at hand, and what was done is counted. A direct solver reports
   success whatever its round-off has left. The residual of a solve that iterations have finished (keptfactor.h) is
   theirs. */
#pragma once
#include "files/archive.h"
#include "linear/reusedfactor.h"

typedef struct {
  PetscInt   solves;
  PetscInt   refined, steps; /* solves that were refined, refinement steps that they took */
  PetscInt   inaccurate;     /* solves whose residual stayed above the limit */
  PetscReal  worst;          /* largest relative residual that was left, lost solves apart */
  KeptCounts kept;           /* of a direct solver */
} LinearCounts;

typedef struct _n_LinearCheck *LinearCheck;

/* Watches a KSP from now on. tolerance: the relative residual asked for where the solver has none of its own (direct);
   kept: what finishes its solves, NULL: nothing. Collective. */
PetscErrorCode LinearCheckCreate(KSP, PetscReal tolerance, ReusedFactor kept, LinearCheck *);
PetscErrorCode LinearCheckDestroy(LinearCheck *);
/* Has the last solve come to nothing: a failed factorisation, or a residual like that of a singular matrix? Not
 * collective, the same on all ranks. */
PetscBool LinearCheckLost(LinearCheck);
void      LinearCheckGetCounts(LinearCheck, LinearCounts *);
/* The counts of the run so far, those of the parts before a restart included. Collective. */
PetscErrorCode LinearCheckArchive(LinearCheck, Archive);
