/* Notes that signals leave, and the time limit. */
#include "base/interruption.h"
#include <math.h>
#include <signal.h>
#include <time.h>

/* A run ends when less time is left than this many times the longest time that has passed between two steps, output and
   checkpoints included. It has room for one more step, for a checkpoint that takes as long, and for the last output. */
#define INTERRUPTION_MARGIN 3.0

/* Causes in ascending order of priority. The ranks of MPI may know of different causes; the one with the highest
   priority counts. */
enum { ASKED_NONE, ASKED_LIMIT, ASKED_USR1, ASKED_TERM };
static const char *const causes[] = {NULL, "-time_limit is near", "SIGUSR1", "SIGTERM"};

static volatile sig_atomic_t note;
static double                limit, begun, last, longest;

static double Now(void)
{
  struct timespec now;

  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void TakeNote(int number)
{
  note = number == SIGTERM ? ASKED_TERM : ASKED_USR1;
}

/*@
  InterruptionInstall - lets signals leave a note from now on, and starts the time limit

  Not collective

  Input Parameter:
. limit_s - seconds since the first call of this function; 0 means no limit

  Note:
  It is called once more after PetscInitialize(), because PETSc takes SIGTERM. SIGXFSZ (a full disk quota) is ignored,
  so that the write that meets it reports the error.
@*/
void InterruptionInstall(double limit_s)
{
  struct sigaction take = {.sa_handler = TakeNote, .sa_flags = SA_RESTART}, ignore = {.sa_handler = SIG_IGN};

  if (!begun) begun = last = Now();
  limit = limit_s;
  sigemptyset(&take.sa_mask);
  sigemptyset(&ignore.sa_mask);
  sigaction(SIGUSR1, &take, NULL);
  sigaction(SIGTERM, &take, NULL);
  sigaction(SIGXFSZ, &ignore, NULL);
}

/*@
  InterruptionBegin - marks the start of the first step

  Not collective

  Note:
  The time of the set-up says nothing about how long a step takes, and neither do the steps of an earlier run.
@*/
void InterruptionBegin(void)
{
  last    = Now();
  longest = 0;
}

/*@
  InterruptionAsked - says whether and why the run is to end; to be called between two steps

  Collective

  Input Parameter:
. comm - all ranks of the run

  Output Parameter:
. why - a constant text, the same on all ranks, or NULL where nobody asks for the end
@*/
PetscErrorCode InterruptionAsked(MPI_Comm comm, const char **why)
{
  const double now   = Now();
  int          asked = note;

  PetscFunctionBeginUser;
  longest = fmax(longest, now - last);
  last    = now;
  if (limit > 0 && begun + limit - now < INTERRUPTION_MARGIN * longest) asked = PetscMax(asked, ASKED_LIMIT);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &asked, 1, MPI_INT, MPI_MAX, comm));
  *why = causes[asked];
  PetscFunctionReturn(PETSC_SUCCESS);
}
