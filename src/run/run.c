/* Scene, mesh, model, load steps, results: one after the other. */
#include "run.h"
#include <petsctime.h>
#include <string.h>
#include "base/errorlog.h"
#include "base/explanation.h"
#include "base/interruption.h"
#include "base/refusal.h"
#include "historyerror.h"
#include "report/precheck.h"
#include "report/rundirectory.h"
#include "sensitivity.h"

/* Tells whether a PETSc option may write files or run scripts: a viewer with a file's name (ascii:FILE), a viewer that
   always writes one, a name of a file, and solvers in Python. */
static PetscBool OptionReachesOut(const char *key, const char *value)
{
  static const char *const viewers[] = {"binary", "hdf5", "vtk", "matlab", "saws", "socket", "python"};
  const size_t             length    = strlen(key);

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(viewers); k++)
    if (!strcmp(value, viewers[k])) return PETSC_TRUE;
  if (strchr(value, ':') || strstr(key, "python")) return PETSC_TRUE;
  return length >= 8 && !strcmp(key + length - 8, "filename") ? PETSC_TRUE : PETSC_FALSE;
}

/* Puts the scene's PETSc options into PETSc's database, below those of the environment and of the command line: only
   options that nobody has set. The database belongs to the process, so that RunDestroy() takes them out again. A value
   such as ascii:FILE has PETSc write a file, which a scene may do only if the user trusts it. */
static PetscErrorCode RunInsertOptions(Run *run, PetscBool trust)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(run->scene->n_petsc, &run->options));
  for (int i = 0; i < run->scene->n_petsc; i++) {
    char      key[256];
    PetscBool set;

    if (!trust && OptionReachesOut(run->scene->petsc[i].key, run->scene->petsc[i].value))
      PetscCall(RefuseInput(run->comm,
                            "%s: '%s' writes a file or runs a script; allowed: other options (-trust on the command "
                            "line allows these, for a scene that you trust)",
                            SceneWhere(run->scene, "petsc", run->scene->petsc[i].key), run->scene->petsc[i].value));
    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s", run->scene->petsc[i].key));
    PetscCall(PetscOptionsHasName(NULL, NULL, key, &set));
    if (set) continue;
    PetscCall(PetscOptionsSetValue(NULL, key, run->scene->petsc[i].value));
    PetscCall(PetscStrallocpy(key, &run->options[run->n_options++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the scene file, chooses the directory and makes the mesh file. */
static PetscErrorCode RunOpen(Run *run, const RunInput *input)
{
  PetscFunctionBeginUser;
  if (!input->scene) PetscCall(RefuseInput(run->comm, "no scene file"));
  if (input->directory && !input->directory[0])
    PetscCall(RefuseInput(run->comm, "the directory of the results has no name; allowed: a path"));
  PetscCall(SceneRead(run->comm, input->scene, input->n_set, input->set, &run->scene));
  PetscCall(SensitivitiesCheck(run));
  PetscCall(SceneLoadRoutines(run->scene, run->comm, input->trust));
  PetscCall(RunInsertOptions(run, input->trust));
  PetscCall(PetscSNPrintf(run->directory, sizeof(run->directory), "%s%s", input->directory ? input->directory : "out/",
                          input->directory ? "" : run->scene->name));
  run->refines = (PetscBool)(run->scene->accuracy.probe >= 0 && input->task == RUN_SOLVE);
  if (run->refines) {
    const size_t used = strlen(run->directory);

    PetscCall(
      PetscSNPrintf(run->directory + used, sizeof(run->directory) - used, "/mesh-%d", PetscMax(input->mesh, 1)));
  }
  if (input->task != RUN_MESH) PetscCall(RunDirectoryCheckPath(run->comm, run->directory));
  PetscCall(ErrorLogSetDirectory(run->directory));
  if (input->task == RUN_SOLVE) PetscCall(RunDirectoryCheck(run->comm, run->scene, run->directory, input->overwrite));
  PetscCall(MeshGenerate(run->comm, run->scene, "out", input->trust, run->mesh_file, &run->mesh_s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the scene and the mesh file out of the checkpoint of an earlier run. */
static PetscErrorCode RunReopen(Run *run, const RunInput *input)
{
  PetscFunctionBeginUser;
  if (input->task != RUN_SOLVE)
    PetscCall(RefuseInput(run->comm, "a restart has neither a check nor a mesh to make; allowed: a run of it"));
  PetscCall(PetscStrncpy(run->directory, input->restart, sizeof(run->directory)));
  PetscCall(RunDirectoryCheckPath(run->comm, run->directory));
  PetscCall(ErrorLogSetDirectory(run->directory));
  PetscCall(CheckpointOpen(run->comm, run->directory, &run->checkpoint));
  PetscCall(CheckpointReadScene(run->checkpoint, input->n_set, input->set, &run->scene));
  PetscCall(SensitivitiesCheck(run));
  PetscCall(SceneLoadRoutines(run->scene, run->comm, input->trust));
  PetscCall(RunInsertOptions(run, input->trust));
  PetscCall(RunDirectoryCheckRestart(run->comm, run->scene, run->directory));
  PetscCall(CheckpointMeshFile(run->checkpoint, run->mesh_file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes mesh, model and probes. A new run is checked, and its state at t = 0 becomes the first accepted one. */
static PetscErrorCode RunSetUp(Run *run, const RunInput *input)
{
  PetscFunctionBeginUser;
  TimingBegin(TIMING_SETUP);
  PetscCall(MeshCreate(run->comm, run->scene, run->mesh_file, &run->mesh));
  if (input->task == RUN_CHECK) PetscCall(MeshReport(run->mesh, run->scene, stdout));
  PetscCall(MeshCheckQuality(run->mesh, run->scene));
  if (input->task == RUN_SOLVE && !run->checkpoint)
    PetscCall(CheckpointCreate(run->comm, run->directory, run->mesh_file, &run->checkpoint));
  PetscCall(MeshCheckFormulations(run->mesh, run->scene));
  PetscCall(ModelCreate(run->scene, run->mesh, &run->model));
  PetscCall(ProbesCreate(run->model, run->scene, &run->probes));
  if (!input->restart) {
    if (input->task == RUN_CHECK && run->model->contact) ContactFitAll(run->model->contact);
    PetscCall(ModelPlace(run->model, input->task == RUN_SOLVE ? run->scene->stepping.initial : 0));
    TimingEnd(TIMING_SETUP);
    PetscCall(PrecheckModel(run->model, input->task == RUN_CHECK ? PETSC_TRUE : PETSC_FALSE, stdout));
    TimingBegin(TIMING_SETUP);
    PetscCall(ModelSetUp(run->model));
    PetscCall(SensitivitiesCheckModel(run, input));
  }
  TimingEnd(TIMING_SETUP);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Between two steps: results, a checkpoint if one is due, and the end of the run if somebody asks for it. */
static PetscErrorCode RunMonitor(LoadStepper stepper, const StepRecord *record, void *context)
{
  Run        *run   = context;
  const int   every = run->scene->output.checkpoint;
  const char *why;

  PetscFunctionBeginUser;
  PetscCall(ResultsStep(run->results, record));
  if (run->scene->output.error == SCENE_ERROR_HISTORY || run->scene->n_sensitivities)
    PetscCall(AgainAddStep(run, record->t));
  PetscCall(InterruptionAsked(run->comm, &why));
  if (why || (every && record->step % every == 0)) {
    PetscCall(CheckpointWrite(run->checkpoint));
    run->kept = record->step;
  }
  if (!why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(run->message, sizeof(run->message), "%s: ended after step %" PetscInt_FMT ", t = %g", why,
                          record->step, (double)record->t));
  PetscCall(LoadStepperStop(stepper));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the solution of the last step. */
static PetscErrorCode RunLastSolution(void *context)
{
  Run *run = context;

  PetscFunctionBeginUser;
  PetscCall(ResultsLastSolution(run->results));
  PetscCall(SensitivitiesFind(run, run->input));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes results and stepper, ready for the first step. */
static PetscErrorCode RunCreateStepper(Run *run, const RunInput *input)
{
  PetscFunctionBeginUser;
  PetscCall(
    ResultsCreate(run->model, run->probes, run->scene, run->directory, input->quiet || run->refines, &run->results));
  PetscCall(LoadStepperCreate(run->comm, &run->stepper));
  PetscCall(LoadStepperSetModel(run->stepper, run->model));
  PetscCall(LoadStepperSetFromScene(run->stepper, run->scene));
  PetscCall(LoadStepperSetFromOptions(run->stepper));
  PetscCall(LoadStepperMonitorSet(run->stepper, RunMonitor, run));
  if (run->scene->output.error || run->scene->n_sensitivities)
    PetscCall(LoadStepperLastSet(run->stepper, RunLastSolution, run));
  PetscCall(CheckpointSetRun(run->checkpoint, run->scene, run->model, run->stepper, run->results));
  if (input->restart) PetscCall(CheckpointRead(run->checkpoint));
  PetscCall(ResultsStart(run->results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The load steps as a stage of -log_view. PETSc keeps stages for the process and refuses a second one of the same
   name. */
static PetscErrorCode RunSolveSteps(Run *run, StepperReport *report)
{
  PetscLogStage stage;

  PetscFunctionBeginUser;
  PetscCall(PetscLogStageGetId("Load steps", &stage));
  if (stage < 0) PetscCall(PetscLogStageRegister("Load steps", &stage));
  PetscCall(PetscLogStagePush(stage));
  InterruptionBegin();
  PetscCall(LoadStepperSolve(run->stepper, report));
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves a scene besides, and gives its probes. */
static PetscErrorCode RunAgain(const Run *run, const RunInput *input, PetscReal *values, PetscBool *known)
{
  Run              again = {.comm = run->comm};
  const PetscReal *found;
  BurnishStatus    status;
  PetscErrorCode   code;
  char            *message = NULL;

  PetscFunctionBeginUser;
  code = RunScene(&again, input, &status);
  if (code && code != REFUSED) PetscCall(code);
  if (code) PetscCall(RefusalTake(&message)); /* nobody is told, and the next refusal has its own */
  PetscCall(PetscFree(message));
  *known = (PetscBool)(!code && status == BURNISH_DONE);
  if (*known) {
    PetscCall(ResultsGetProbes(again.results, &found));
    PetscCall(PetscArraycpy(values, found, run->scene->n_probes));
  }
  PetscCall(RunDestroy(&again));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps the model to t = 1 and writes what is to be written. */
static PetscErrorCode RunSolve(Run *run, const RunInput *input, BurnishStatus *status)
{
  static const char *const names[] =
    {[BURNISH_DONE] = "done", [BURNISH_NOT_CONVERGED] = "not converged", [BURNISH_STOPPED] = "stopped"};
  StepperReport  report;
  RunRecord      record;
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(RunCreateStepper(run, input));
  PetscCall(RunSolveSteps(run, &report));
  if (report.done) PetscCall(HistoryErrorFind(run, input, RunAgain));
  if (report.done) PetscCall(SensitivitiesFindByRuns(run, input, RunAgain));
  if (!report.done && run->kept != report.steps) PetscCall(CheckpointWrite(run->checkpoint));
  *status = report.done ? BURNISH_DONE : report.stopped ? BURNISH_STOPPED : BURNISH_NOT_CONVERGED;
  if (*status == BURNISH_DONE) run->message[0] = '\0';
  if (*status == BURNISH_NOT_CONVERGED || report.leaks)
    PetscCall(PetscStrncpy(run->message, report.message, sizeof(run->message)));
  ExplanationAppend(run->message, sizeof(run->message),
                    *status == BURNISH_STOPPED ? EXPLANATION_STOPPED : EXPLANATION_UNSOLVED);
  PetscCall(PetscTime(&now));
  record = (RunRecord){.status  = names[*status],
                       .message = run->message[0] ? run->message : NULL,
                       .wall_s  = now - run->start,
                       .mesh_s  = run->mesh_s,
                       .way     = &report};
  PetscCall(ResultsFinish(run->results, &record));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunScene - takes a scene from its file to its results

  Collective

  Input Parameters:
+ run   - all zero but for its communicator
- input - what the user asks for

  Output Parameter:
. status - BURNISH_DONE, BURNISH_NOT_CONVERGED or BURNISH_STOPPED

  Note:
  Returns REFUSED for wrong input (refusal.h). The caller calls RunDestroy() after REFUSED too. After other errors it
  does not, because other ranks may not have failed.
@*/
PetscErrorCode RunScene(Run *run, const RunInput *input, BurnishStatus *status)
{
  PetscFunctionBeginUser;
  run->kept = -1;
  *status   = BURNISH_DONE;
  PetscCall(PetscTime(&run->start));
  run->input = input;
  PetscCall((input->restart ? RunReopen : RunOpen)(run, input));
  if (input->task != RUN_MESH) PetscCall(RunSetUp(run, input));
  if (input->task == RUN_SOLVE) PetscCall(RunSolve(run, input, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RunDestroy - frees all objects of a run and takes the scene's options out of PETSc's database

  Collective
@*/
PetscErrorCode RunDestroy(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LoadStepperDestroy(&run->stepper));
  PetscCall(ResultsDestroy(&run->results));
  PetscCall(ProbesDestroy(&run->probes));
  PetscCall(ModelDestroy(&run->model));
  PetscCall(MeshDestroy(&run->mesh));
  PetscCall(CheckpointDestroy(&run->checkpoint));
  for (int i = 0; i < run->n_options; i++) {
    PetscCall(PetscOptionsClearValue(NULL, run->options[i]));
    PetscCall(PetscFree(run->options[i]));
  }
  PetscCall(PetscFree(run->options));
  PetscCall(PetscFree(run->ends));
  PetscCall(SceneDestroy(&run->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
