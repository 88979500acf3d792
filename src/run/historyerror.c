/* What the load steps leave of error, by a second run, see historyerror.h. */
#include "historyerror.h"

enum { HISTORY_NUMBER = 32 /* characters of a load parameter */, HISTORY_FIRST_ROOM = 64 };

/* The second run's edits of the scene besides the load parameters at which its steps end: it has no results but those
   of its probes, and nothing else cuts its steps. The last two are for scenes with friction and with yielding. */
static const char *const edits[] = {"stepping.control=fixed",    "stepping.initial=1",    "stepping.dt_max=1",
                                    "output.error=false",        "output.every=0",        "output.checkpoint=0",
                                    "stepping.contact_travel=0", "stepping.plastic_lag=0"};
enum { HISTORY_EDITS = PETSC_STATIC_ARRAY_LENGTH(edits), HISTORY_PLAIN = HISTORY_EDITS - 2 };

/*@
  HistoryErrorAddStep - keeps at which load parameter a step ended.

  Not collective

  Input Parameters:
+ run - whose scene has output.error: history
- t   - load parameter
@*/
PetscErrorCode HistoryErrorAddStep(Run *run, PetscReal t)
{
  PetscFunctionBeginUser;
  if (run->n_ends == run->ends_room) {
    run->ends_room = PetscMax(2 * run->ends_room, HISTORY_FIRST_ROOM);
    PetscCall(PetscRealloc((size_t)run->ends_room * sizeof(PetscReal), &run->ends));
  }
  run->ends[run->n_ends++] = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the edit that says where the steps of the second run end. */
static PetscErrorCode WriteEnds(const Run *run, char **edit)
{
  const size_t size = (size_t)(run->n_ends + 2) * HISTORY_NUMBER;
  size_t       used;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, edit));
  used = (size_t)snprintf(*edit, size, "stepping.at=[");
  if (run->n_ends == 1) used += (size_t)snprintf(*edit + used, size - used, "%.17g, ", 0.5 * (double)run->ends[0]);
  for (PetscInt k = (run->n_ends + 1) % 2; k + 1 < run->n_ends; k += 2)
    used += (size_t)snprintf(*edit + used, size - used, "%.17g, ", (double)run->ends[k]);
  snprintf(*edit + used, size - used, "1]");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the scene with the edits, and gives its probes and its CPU seconds. *known: it came to its end. */
static PetscErrorCode SolveAgain(Run *run, const RunInput *input, RunAgainFn solve, char *ends, PetscReal *values,
                                 PetscReal *cpu_s, PetscBool *known)
{
  RunInput again = *input;
  RunUsage begin, end;
  char     directory[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(directory, sizeof(directory), "%s/history", run->directory));
  PetscCall(PetscMalloc1(input->n_set + HISTORY_EDITS + 1, &again.set));
  PetscCall(PetscArraycpy(again.set, input->set, input->n_set));
  for (int k = 0; k < HISTORY_EDITS; k++)
    if (k < HISTORY_PLAIN ||
        (k == HISTORY_PLAIN ? ContactHasFriction(run->model->contact) : ProblemIsPlastic(run->model->problem)))
      again.set[again.n_set++] = (char *)edits[k];
  again.set[again.n_set++] = ends;
  again.directory          = directory;
  again.overwrite = again.quiet = PETSC_TRUE;
  PetscCall(ResultsGetUsage(run->results, &begin));
  PetscCall(solve(run, &again, values, known));
  PetscCall(ResultsGetUsage(run->results, &end));
  *cpu_s = end.cpu_s - begin.cpu_s;
  PetscCall(PetscFree(again.set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  HistoryErrorFind - estimates what the load steps leave of error, if the scene pays for that.

  Collective

  Input Parameters:
+ run   - at its end, before its results are finished
. input - what the user asks for
- solve - solves a scene besides, and gives its probes

  Note:
  The part stays unknown where the second run does not come to its end, and for a run that was continued.
@*/
PetscErrorCode HistoryErrorFind(Run *run, const RunInput *input, RunAgainFn solve)
{
  const PetscReal *values;
  PetscReal       *again, cpu_s;
  PetscBool        known;
  char            *ends;

  PetscFunctionBeginUser;
  if (run->scene->output.error != SCENE_ERROR_HISTORY || input->restart || !ModelDependsOnPath(run->model))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(run->scene->n_probes, &again));
  PetscCall(WriteEnds(run, &ends));
  PetscCall(SolveAgain(run, input, solve, ends, again, &cpu_s, &known));
  PetscCall(ResultsGetProbes(run->results, &values));
  for (int i = 0; i < run->scene->n_probes; i++)
    again[i] = run->n_ends == 1 ? 2 * (again[i] - values[i]) : values[i] - again[i];
  if (known) PetscCall(ResultsSetHistoryErrors(run->results, again, cpu_s));
  PetscCall(PetscFree(ends));
  PetscCall(PetscFree(again));
  PetscFunctionReturn(PETSC_SUCCESS);
}
