/* What ends a run before its end: SIGUSR1 or SIGTERM on any rank, or a time limit that comes near.

   InterruptionInstall() belongs to the program, not to the library: a program that does not call it keeps its own
   signal handlers, and its runs end by themselves only. A signal leaves a note. InterruptionBegin() marks the first
   step, and InterruptionAsked() reads the note between two steps.

   The state belongs to the process as a whole, because signals and the time limit of a job do. */
#pragma once
#include "base/petsccompat.h"

void           InterruptionInstall(double limit);
void           InterruptionBegin(void);
PetscErrorCode InterruptionAsked(MPI_Comm, const char **why);
