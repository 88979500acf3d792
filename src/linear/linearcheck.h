/* A check that the linear solver's results are solutions.

   After each solve of a KSP the true residual |b - A x| / |b| is computed. A solution that leaves too much is refined
   with the present factor. What was done is counted. A direct solver reports success whatever its round-off has left,
   so a check is needed. Where iterations have finished a solve (reusedfactor.h), their residual is taken.

   Create the check once for the KSP. Ask LinearCheckLost() after each solve. */
#pragma once
#include "files/archive.h"
#include "linear/reusedfactor.h"

typedef struct {
  PetscInt   solves;
  PetscInt   refined, steps; /* solves that were refined, refinement steps that they took */
  PetscInt   inaccurate;     /* solves whose residual stayed above the limit */
  PetscReal  worst;          /* largest relative residual that was left, except by lost solves */
  KeptCounts kept;           /* of a direct solver */
} LinearCounts;

typedef struct _n_LinearCheck *LinearCheck;

PetscErrorCode LinearCheckCreate(KSP, PetscReal tolerance, ReusedFactor kept, LinearCheck *);
PetscErrorCode LinearCheckDestroy(LinearCheck *);
PetscBool      LinearCheckLost(LinearCheck);
void           LinearCheckGetCounts(LinearCheck, LinearCounts *);
PetscErrorCode LinearCheckArchive(LinearCheck, Archive);
