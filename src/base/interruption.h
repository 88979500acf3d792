/* What ends a run before its end: SIGUSR1 or SIGTERM on any one rank, or a time limit that comes near. Signals only
   leave a note, which is read between two steps. One for each process, as signals are. */
#pragma once
#include "base/petsccompat.h"

/* From here on signals leave a note, and the time limit runs (seconds; 0: none). To be called again once PETSc, which
   takes SIGTERM, has started: the clock is that of the first call. Not collective. */
void InterruptionInstall(double limit);
/* The first step begins. Not collective. */
void InterruptionBegin(void);
/* Between two steps: why the run is to end, in words, or NULL. The same on all ranks. Collective. */
PetscErrorCode InterruptionAsked(MPI_Comm, const char **why);
