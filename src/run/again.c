/* Runs of a scene besides, see again.h. */
#include "again.h"

enum { AGAIN_NUMBER = 32 /* characters of a load parameter */, AGAIN_FIRST_ROOM = 64 };

/* Edits of the scene besides the load parameters at which steps end: the run has no results but those of its probes,
   and nothing else cuts its steps. The last two are for scenes with friction and with yielding. */
static const char *const edits[] = {"sensitivity=[]",      "stepping.control=fixed",    "stepping.initial=1",
                                    "stepping.dt_max=1",   "output.error=false",        "output.every=0",
                                    "output.checkpoint=0", "stepping.contact_travel=0", "stepping.plastic_lag=0"};
enum { AGAIN_EDITS = PETSC_STATIC_ARRAY_LENGTH(edits), AGAIN_PLAIN = AGAIN_EDITS - 2 };

/*@
  AgainAddStep - keeps at which load parameter a step ended.

  Not collective

  Input Parameters:
+ run - the run at hand
- t   - load parameter
@*/
PetscErrorCode AgainAddStep(Run *run, PetscReal t)
{
  PetscFunctionBeginUser;
  if (run->n_ends == run->ends_room) {
    run->ends_room = PetscMax(2 * run->ends_room, AGAIN_FIRST_ROOM);
    PetscCall(PetscRealloc((size_t)run->ends_room * sizeof(PetscReal), &run->ends));
  }
  run->ends[run->n_ends++] = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the edit that says where the steps of the run besides end. */
static PetscErrorCode WriteEnds(const Run *run, int every, char **edit)
{
  const size_t size = (size_t)(run->n_ends + 2) * AGAIN_NUMBER;
  size_t       used;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, edit));
  used = (size_t)snprintf(*edit, size, "stepping.at=[");
  if (run->n_ends == 1 && every > 1)
    used += (size_t)snprintf(*edit + used, size - used, "%.17g, ", 0.5 * (double)run->ends[0]);
  for (PetscInt k = (run->n_ends + every - 1) % every; k + 1 < run->n_ends; k += every)
    used += (size_t)snprintf(*edit + used, size - used, "%.17g, ", (double)run->ends[k]);
  snprintf(*edit + used, size - used, "1]");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  AgainSolve - solves the scene once more, with edits.

  Collective

  Input Parameters:
+ run   - at its end, before its results are finished, with the ends of all its steps
. input - what the user asks for
- again - the run besides. A run of a single step is followed by one of two steps where it asks for longer ones

  Output Parameters:
+ values - of the probes at its end
. cpu_s  - CPU seconds that it took
- known  - it came to its end
@*/
PetscErrorCode AgainSolve(Run *run, const RunInput *input, const Again *again, PetscReal *values, PetscReal *cpu_s,
                          PetscBool *known)
{
  RunInput with = *input;
  RunUsage begin, end;
  char     directory[PETSC_MAX_PATH_LEN], *ends;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(directory, sizeof(directory), "%s/%s", run->directory, again->name));
  PetscCall(WriteEnds(run, again->every, &ends));
  PetscCall(PetscMalloc1(input->n_set + AGAIN_EDITS + 2, &with.set));
  PetscCall(PetscArraycpy(with.set, input->set, input->n_set));
  for (int k = 0; k < AGAIN_EDITS; k++)
    if (k < AGAIN_PLAIN ||
        (k == AGAIN_PLAIN ? ContactHasFriction(run->model->contact) : ProblemIsPlastic(run->model->problem)))
      with.set[with.n_set++] = (char *)edits[k];
  with.set[with.n_set++] = ends;
  if (again->edit) with.set[with.n_set++] = (char *)again->edit;
  with.directory = directory;
  with.overwrite = with.quiet = PETSC_TRUE;
  PetscCall(ResultsGetUsage(run->results, &begin));
  PetscCall(again->solve(run, &with, values, known));
  PetscCall(ResultsGetUsage(run->results, &end));
  *cpu_s = end.cpu_s - begin.cpu_s;
  PetscCall(PetscFree(with.set));
  PetscCall(PetscFree(ends));
  PetscFunctionReturn(PETSC_SUCCESS);
}
