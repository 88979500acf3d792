#include "timing.h"
#include <mpi.h>

const char *const TimingNames[] = {"setup", "search", "fit", "assembly_elastic", "assembly_contact", "solve", "output"};

static double begun[TIMING_KINDS], spent[TIMING_KINDS];

/* TimingBegin - Starts the clock of one purpose on this rank. Not collective; MPI must be initialised. */
void TimingBegin(TimingKind kind)
{
  begun[kind] = MPI_Wtime();
}

/* TimingEnd - Stops the clock that TimingBegin() started and adds the time. Not collective. */
void TimingEnd(TimingKind kind)
{
  spent[kind] += MPI_Wtime() - begun[kind];
}

/* TimingSeconds - Wall seconds of this rank for one purpose since the program started. Not collective. */
double TimingSeconds(TimingKind kind)
{
  return spent[kind];
}
