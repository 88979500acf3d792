#include "base/interruption.h"
#include <math.h>
#include <signal.h>
#include <time.h>

/* The run ends when less time is left than this many times the longest that passed between two steps, output and
   checkpoints included: one step more, a checkpoint that takes as long, and the last output. */
#define INTERRUPTION_MARGIN 3.0

/* The strongest last: ranks may know of different ones. */
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

/* InterruptionInstall - also has a full quota (SIGXFSZ) reported by the write that meets it. Not collective. */
void InterruptionInstall(double seconds)
{
  struct sigaction take = {.sa_handler = TakeNote, .sa_flags = SA_RESTART}, ignore = {.sa_handler = SIG_IGN};

  if (!begun) begun = last = Now();
  limit = seconds;
  sigemptyset(&take.sa_mask);
  sigemptyset(&ignore.sa_mask);
  sigaction(SIGUSR1, &take, NULL);
  sigaction(SIGTERM, &take, NULL);
  sigaction(SIGXFSZ, &ignore, NULL);
}

/* InterruptionBegin - what came before was set-up and says nothing of how long a step takes. Not collective. */
void InterruptionBegin(void)
{
  last = Now();
}

/* InterruptionAsked - Collective. *why: a constant text. */
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
