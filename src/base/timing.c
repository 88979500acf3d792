#include "base/timing.h"
#include <mpi.h>

const char *const TimingNames[] = {"setup", "search", "fit", "assembly_elastic", "assembly_contact", "solve", "output"};

/* Room for every purpose within every other, twice over; what is begun deeper counts for the purpose there. */
enum { MAX_DEPTH = 2 * TIMING_KINDS };

static TimingKind running[MAX_DEPTH]; /* the innermost last: only its clock goes */
static int        depth;
static double     since, spent[TIMING_KINDS];

/* Adds the time since the last change to the purpose whose clock goes. */
static void Book(void)
{
  const double now = MPI_Wtime();

  if (depth) spent[running[depth - 1]] += now - since;
  since = now;
}

/* TimingBegin - Starts the clock of one purpose on this rank and stops the one that goes. Not collective; MPI must be
 * initialised. */
void TimingBegin(TimingKind kind)
{
  Book();
  if (depth < MAX_DEPTH) running[depth++] = kind;
}

/* TimingEnd - Stops the clock that TimingBegin() started; the one before it goes on. Not collective. */
void TimingEnd(TimingKind kind)
{
  int last = depth - 1;

  Book();
  while (last >= 0 && running[last] != kind) last--;
  if (last >= 0) depth = last;
}

/* TimingSeconds - Wall seconds of this rank for one purpose since the program started. Not collective. */
double TimingSeconds(TimingKind kind)
{
  return spent[kind];
}
