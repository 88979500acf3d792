/* Runs of a scene besides the one at hand, with edits, for what needs the whole way to the end: what load steps leave
   of error, and derivatives where the answer depends on the way.

   Such a run ends its steps where those of the run at hand did, or at every so many of these places, and nothing else
   cuts them. AgainAddStep() keeps the places. Its results are those of its probes alone. */
#pragma once
#include "run.h"

/* Solves a scene with the probes of a run, and gives them. known: it came to its end. */
typedef PetscErrorCode (*RunAgainFn)(const Run *, const RunInput *, PetscReal *values, PetscBool *known);

/* A run besides */
typedef struct {
  RunAgainFn  solve;
  const char *name;  /* of its directory in that of the run at hand */
  int         every; /* so many steps of the run at hand are one of it */
  const char *edit;  /* of the scene; NULL: none */
} Again;

PetscErrorCode AgainAddStep(Run *, PetscReal t);
PetscErrorCode AgainSolve(Run *, const RunInput *, const Again *, PetscReal *values, PetscReal *cpu_s,
                          PetscBool *known);
