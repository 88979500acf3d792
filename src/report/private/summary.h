/* summary.json: the run in one file, which SummaryWrite() writes once at its end. The names of its values are those of
   the user's reference. */
#pragma once
#include "runfigures.h"

PetscErrorCode SummaryWrite(const Mesh, const RunFigures *, const char *directory, const PetscReal *probes);
