/* summary.json: the run in one file, written once at its end. Names are those of the user's reference. */
#pragma once
#include "runfigures.h"

/* probes: final values, NaN where there is none. Not collective: for one rank. */
PetscErrorCode SummaryWrite(const Mesh, const RunFigures *, const char *directory, const PetscReal *probes);
