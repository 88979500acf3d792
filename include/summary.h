/* summary.json: the run in one file, written once at its end. Names are those of the user's reference. */
#pragma once
#include "results.h"

/* What this program has used since it started; wall_s is set by the caller. Collective. */
PetscErrorCode SummaryCollectUsage(MPI_Comm, RunUsage *);
/* usage: of all parts of the run; restarts: their number less one; last: the last accepted step, NULL if there is none; probes: final values, NaN where there
 * is none. Collective. */
PetscErrorCode SummaryWrite(Model, Scene, const char *directory, const RunRecord *, const RunUsage *usage, PetscInt restarts, const StepRecord *last,
                            const PetscReal *probes);
