/* What the load steps leave of error, by a second run, see historyerror.h. */
#include "historyerror.h"

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
  const Again      half = {solve, "history", 2, NULL};
  const PetscReal *values;
  PetscReal       *again, cpu_s;
  PetscBool        known;

  PetscFunctionBeginUser;
  if (run->scene->output.error != SCENE_ERROR_HISTORY || input->restart || !ModelDependsOnPath(run->model))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(run->scene->n_probes, &again));
  PetscCall(AgainSolve(run, input, &half, again, &cpu_s, &known));
  PetscCall(ResultsGetProbes(run->results, &values));
  for (int i = 0; i < run->scene->n_probes; i++)
    again[i] = run->n_ends == 1 ? 2 * (again[i] - values[i]) : values[i] - again[i];
  if (known) PetscCall(ResultsSetHistoryErrors(run->results, again, cpu_s));
  PetscCall(PetscFree(again));
  PetscFunctionReturn(PETSC_SUCCESS);
}
