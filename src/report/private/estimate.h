/* What a solve will cost, before any is made. EstimateModel() takes memory and time of the direct solver from its own
   symbolic analysis of the tangent at t = 0 and measures the assembly. EstimatePrint() prints it. Contact that grows
   during the run adds to both. */
#pragma once
#include <stdio.h>
#include "solve/model.h"

typedef struct {
  PetscBool known;        /* PETSc's options left the direct solver in place */
  PetscInt  dofs;         /* free */
  PetscReal nonzeros;     /* of the tangent; of the bodies' tangent where contact is a border of its factor */
  PetscReal entries;      /* of the factor */
  PetscReal flops;        /* to make the factor */
  PetscReal solver_mb[2]; /* of the direct solver: largest rank, all ranks */
  PetscReal memory_mb[2]; /* with all the rest */
  PetscReal assembly_s;   /* this and the following: CPU time on the slowest rank */
  PetscReal analysis_s;   /* once for each new pattern of contact */
  PetscReal factor_s, iteration_s;
} Estimate;

PetscErrorCode EstimateModel(Model, Estimate *);
PetscErrorCode EstimatePrint(Model, FILE *);
