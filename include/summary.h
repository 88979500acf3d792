/* summary.json: the run in one file, written once at its end. Names are those of the user's reference. */
#pragma once
#include "results.h"

/* last: the last accepted step, NULL if there is none; probes: final values, NaN where there is none. Collective. */
PetscErrorCode SummaryWrite(Model, Scene, const char *directory, const RunRecord *, const StepRecord *last, const PetscReal *probes);
