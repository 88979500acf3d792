/* Nested wall clocks, one for each purpose. */
#include "base/timing.h"
#include <mpi.h>

const char *const TimingNames[] = {"setup", "search", "fit", "assembly_elastic", "assembly_contact", "solve",
                                   "certificate", "output"};

/* Room for every purpose within every other, twice. Time of a purpose that is begun deeper counts for the one around
   it. */
enum { MAX_DEPTH = 2 * TIMING_KINDS };

static TimingKind running[MAX_DEPTH]; /* the innermost is the last; only its clock runs */
static int        depth;
static double     since, spent[TIMING_KINDS];

/* Adds the time since the last change to the purpose whose clock runs. */
static void Book(void)
{
  const double now = MPI_Wtime();

  if (depth) spent[running[depth - 1]] += now - since;
  since = now;
}

/*@
  TimingReset - stops all clocks of this rank and sets them to zero

  Not collective
@*/
void TimingReset(void)
{
  depth = 0;
  for (int kind = 0; kind < TIMING_KINDS; kind++) spent[kind] = 0;
}

/*@
  TimingBegin - starts the clock of one purpose on this rank and stops the one that runs

  Not collective

  Input Parameter:
. kind - the purpose

  Note:
  MPI must be initialised.
@*/
void TimingBegin(TimingKind kind)
{
  Book();
  if (depth < MAX_DEPTH) running[depth++] = kind;
}

/*@
  TimingEnd - stops the clock that TimingBegin() started; the one before it runs on

  Not collective

  Input Parameter:
. kind - the purpose

  Note:
  Ends also what was begun after this purpose and has not been ended.
@*/
void TimingEnd(TimingKind kind)
{
  int last = depth - 1;

  Book();
  while (last >= 0 && running[last] != kind) last--;
  if (last >= 0) depth = last;
}

/*@
  TimingSeconds - returns the wall seconds of this rank for one purpose since TimingReset()

  Not collective

  Input Parameter:
. kind - the purpose

  Note:
  Time of a clock that still runs is not in it.
@*/
double TimingSeconds(TimingKind kind)
{
  return spent[kind];
}
