/* Why a run gets long and what to change, see runlength.h. */
#include "runlength.h"
#include <stdio.h>
#include <sys/stat.h>

/* Results of more bytes need a reason that the user knows of. */
#define RUN_LARGE_BYTES 1e9
/* The size at the end is foretold from this part of it on. Earlier, first small steps would foretell too much. */
#define RUN_FORETOLD 0.1
/* Attempts that fail cut dt. From this part of the steps on they are the reason for many steps. */
#define RUN_FAILED 0.05

/* Number of load parameters within the run at which a motion changes its rate. */
static PetscInt MotionLandings(const Motion *motion)
{
  PetscInt n = motion->history.n ? motion->history.n - 2 : 0;

  for (int m = 0; m < motion->n; m++) n += motion->components[m].history.n - 2;
  return n;
}

/* Number of load parameters on which steps must end. */
static PetscInt Landings(Scene scene)
{
  PetscInt n = scene->stepping.n_at;

  for (int l = 0; l < scene->n_loads; l++) n += scene->loads[l].history.n - 2;
  for (int b = 0; b < scene->n_bodies; b++) n += MotionLandings(&scene->bodies[b].motion);
  for (int c = 0; c < scene->n_contacts; c++) n += MotionLandings(&scene->contacts[c].motion);
  return n;
}

/*@
  RunStepsAreMany - says why a run takes many steps, and what to change.

  Not collective

  Input Parameters:
+ scene  - of the run
. steps  - accepted steps so far
- failed - attempts that failed

  Output Parameter:
. text - a line [RUN_LENGTH_TEXT], if the steps are many

  Note:
  It returns 1 if the steps are many, else 0.
@*/
int RunStepsAreMany(Scene scene, PetscInt steps, PetscInt failed, char *text)
{
  int n;

  if (steps <= RUN_MANY_STEPS) return 0;
  n = snprintf(text, RUN_LENGTH_TEXT, "%lld steps: ", (long long)steps);
  if (failed > RUN_FAILED * steps)
    snprintf(text + n, RUN_LENGTH_TEXT - n,
             "%lld attempts failed and cut dt; a finer mesh of the slave where contact changes", (long long)failed);
  else if (scene->stepping.control == STEP_FIXED)
    snprintf(text + n, RUN_LENGTH_TEXT - n,
             "stepping.control: fixed takes stepping.initial = %g; a larger one, or control: iterations",
             scene->stepping.initial);
  else if (scene->stepping.dt_max * RUN_MANY_STEPS <= 1)
    snprintf(text + n, RUN_LENGTH_TEXT - n, "stepping.dt_max = %g allows no longer ones; a larger dt_max",
             scene->stepping.dt_max);
  else if (2 * Landings(scene) > steps)
    snprintf(text + n, RUN_LENGTH_TEXT - n,
             "they end on %lld load parameters of stepping.at and of histories; fewer of these",
             (long long)Landings(scene));
  else if (scene->stepping.control == STEP_CONTACT)
    snprintf(text + n, RUN_LENGTH_TEXT - n,
             "stepping.control: contact lets few nodes come into contact in each; a larger stepping.N_c or "
             "N_c_fraction, or control: iterations");
  else
    snprintf(text + n, RUN_LENGTH_TEXT - n,
             "solves take many iterations, so that stepping.control: iterations keeps dt small; control: fixed with "
             "stepping.initial: %g goes on with longer steps",
             2.0 / RUN_MANY_STEPS);
  return 1;
}

/*@
  RunResultsAreLarge - says that the results are large, or will be, and what to change.

  Not collective

  Input Parameters:
+ scene - of the run
. bytes - size of results.vtkhdf
- t     - load parameter to which they were written

  Output Parameter:
. text - a line [RUN_LENGTH_TEXT], if the results are large

  Note:
  It returns 1 if the results are large, else 0.
@*/
int RunResultsAreLarge(Scene scene, PetscReal bytes, PetscReal t, char *text)
{
  const PetscReal foretold = t > 0 && bytes >= RUN_FORETOLD * RUN_LARGE_BYTES ? bytes / t : bytes;

  if (foretold <= RUN_LARGE_BYTES) return 0;
  snprintf(text, RUN_LENGTH_TEXT,
           "results.vtkhdf %s %.1f GB with output.every: %d; output.every: %d, or fewer output.fields",
           t < 1 ? "will have" : "has", (double)foretold / 1e9, scene->output.every,
           (int)PetscCeilReal(foretold / RUN_LARGE_BYTES) * PetscMax(scene->output.every, 1));
  return 1;
}

/*@
  RunResultsBytes - returns the size of the results that have been written.

  Not collective

  Input Parameter:
. directory - of the run
@*/
PetscReal RunResultsBytes(const char *directory)
{
  char        path[PETSC_MAX_PATH_LEN];
  struct stat file;

  snprintf(path, sizeof(path), "%s/results.vtkhdf", directory);
  return stat(path, &file) ? 0 : (PetscReal)file.st_size;
}
