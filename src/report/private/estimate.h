/* What a solve will cost, before any is made: memory and time of the direct solver from its own symbolic analysis of
   the tangent at t = 0, assembly by the clock. Contact that grows on the way adds to both. */
#pragma once
#include <stdio.h>
#include "solve/model.h"

typedef struct {
  PetscBool known;          /* PETSc's options left the direct solver in place */
  PetscInt  dofs;           /* free */
  PetscReal nonzeros;       /* of the tangent; of the bodies' where contact is a border of its factor */
  PetscReal entries, flops; /* of the factor; to make it */
  PetscReal solver_mb[2];   /* of the direct solver: largest rank, all ranks */
  PetscReal memory_mb[2];   /* with all the rest */
  PetscReal assembly_s, analysis_s, factor_s,
    iteration_s; /* CPU, slowest rank; analysis: once for each new pattern of contact */
} Estimate;

/* After ModelPlace(). Collective. */
PetscErrorCode EstimateModel(Model, Estimate *);
/* The same in three lines; rank 0 prints. Collective. */
PetscErrorCode EstimatePrint(Model, FILE *);
