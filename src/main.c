/* burnish: scene -> mesh -> model -> load stepper -> results. */
#include <signal.h>
#include <petsctime.h>
#include "report/checkpoint.h"
#include "scene/commandline.h"
#include "base/errorlog.h"
#include "base/interruption.h"
#include "report/precheck.h"
#include "base/refusal.h"
#include "report/results.h"
#include "report/rundirectory.h"
#include "step/stepper.h"
#include "base/timing.h"

/* The scene's PETSc options, below the environment's and the command line's: only those that nobody has set. */
static PetscErrorCode InsertSceneOptions(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_petsc; i++) {
    char      key[256];
    PetscBool set;

    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s", scene->petsc[i].key));
    PetscCall(PetscOptionsHasName(NULL, NULL, key, &set));
    if (!set) PetscCall(PetscOptionsSetValue(NULL, key, scene->petsc[i].value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What happens between two steps */
typedef struct {
  Scene      scene;
  Results    results;
  Checkpoint checkpoint;
  PetscInt   kept;         /* step of the last checkpoint, -1: none */
  char       message[256]; /* why the run was stopped */
} Watch;

static PetscErrorCode WatchStep(LoadStepper stepper, const StepRecord *record, void *context)
{
  Watch      *watch = context;
  const int   every = watch->scene->output.checkpoint;
  const char *why;

  PetscFunctionBeginUser;
  PetscCall(ResultsStep(watch->results, record));
  PetscCall(InterruptionAsked(PETSC_COMM_WORLD, &why));
  if (why || (every && record->step % every == 0)) {
    PetscCall(CheckpointWrite(watch->checkpoint));
    watch->kept = record->step;
  }
  if (!why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(watch->message, sizeof(watch->message), "%s: ended after step %" PetscInt_FMT ", t = %g", why,
                          record->step, (double)record->t));
  PetscCall(LoadStepperStop(stepper));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps the model to t = 1 and writes what is to be written; the exit status says how it ended. */
static PetscErrorCode RunModel(Model model, Probes probes, Scene scene, Checkpoint checkpoint,
                               const CommandLine *command, const char *directory, PetscLogDouble start,
                               PetscReal mesh_s, int *status)
{
  Watch          watch = {.scene = scene, .checkpoint = checkpoint, .kept = -1};
  RunRecord      run;
  PetscLogStage  stage;
  PetscLogDouble now;
  LoadStepper    stepper;
  StepperReport  report;

  PetscFunctionBeginUser;
  PetscCall(ResultsCreate(model, probes, scene, directory, command->quiet ? PETSC_TRUE : PETSC_FALSE, &watch.results));
  PetscCall(LoadStepperCreate(PETSC_COMM_WORLD, &stepper));
  PetscCall(LoadStepperSetModel(stepper, model));
  PetscCall(LoadStepperSetFromScene(stepper, scene));
  PetscCall(LoadStepperSetFromOptions(stepper));
  PetscCall(LoadStepperMonitorSet(stepper, WatchStep, &watch));
  PetscCall(CheckpointSetRun(checkpoint, scene, model, stepper, watch.results));
  if (command->restart) PetscCall(CheckpointRead(checkpoint));
  PetscCall(ResultsStart(watch.results));
  PetscCall(PetscLogStageRegister("Load steps", &stage));
  PetscCall(PetscLogStagePush(stage));
  InterruptionBegin();
  PetscCall(LoadStepperSolve(stepper, &report));
  PetscCall(PetscLogStagePop());
  if (!report.done && watch.kept != report.steps) PetscCall(CheckpointWrite(checkpoint));
  PetscCall(PetscTime(&now));
  run = (RunRecord){.status  = report.done      ? "done"
                               : report.stopped ? "stopped"
                                                : "not converged",
                    .message = report.done      ? NULL
                               : report.stopped ? watch.message
                                                : report.message,
                    .wall_s  = now - start,
                    .mesh_s  = mesh_s,
                    .way     = &report};
  PetscCall(ResultsFinish(watch.results, &run));
  PetscCall(LoadStepperDestroy(&stepper));
  PetscCall(ResultsDestroy(&watch.results));
  *status = report.done ? EXIT_DONE : report.stopped ? EXIT_STOPPED : EXIT_NOT_CONVERGED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A scene and its mesh file, from the scene's own files. */
static PetscErrorCode OpenScene(MPI_Comm comm, const CommandLine *command, char *directory, Scene *scene,
                                char *mesh_file, PetscReal *mesh_s, Checkpoint *checkpoint)
{
  PetscFunctionBeginUser;
  *checkpoint = NULL;
  PetscCall(SceneRead(comm, command->scene, command->n_set, command->set, scene));
  PetscCall(InsertSceneOptions(*scene));
  PetscCall(PetscSNPrintf(directory, PETSC_MAX_PATH_LEN, "%s%s", command->directory ? command->directory : "out/",
                          command->directory ? "" : (*scene)->name));
  if (command->mode != COMMAND_MESH) PetscCall(RunDirectoryCheckPath(comm, directory));
  PetscCall(ErrorLogOpen(directory));
  if (command->mode == COMMAND_RUN)
    PetscCall(RunDirectoryCheck(comm, *scene, directory, command->overwrite ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(MeshGenerate(comm, *scene, "out", mesh_file, mesh_s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same from a run's checkpoint. */
static PetscErrorCode ReopenScene(MPI_Comm comm, const CommandLine *command, char *directory, Scene *scene,
                                  char *mesh_file, PetscReal *mesh_s, Checkpoint *checkpoint)
{
  PetscFunctionBeginUser;
  *mesh_s = 0;
  PetscCall(PetscStrncpy(directory, command->restart, PETSC_MAX_PATH_LEN));
  PetscCall(RunDirectoryCheckPath(comm, directory));
  PetscCall(ErrorLogOpen(directory));
  PetscCall(CheckpointOpen(comm, directory, checkpoint));
  PetscCall(CheckpointReadScene(*checkpoint, command->n_set, command->set, scene));
  PetscCall(InsertSceneOptions(*scene));
  PetscCall(RunDirectoryCheckRestart(comm, *scene, directory));
  PetscCall(CheckpointMeshFile(*checkpoint, mesh_file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunScene(const CommandLine *command, int *status)
{
  MPI_Comm       comm = PETSC_COMM_WORLD;
  char           directory[PETSC_MAX_PATH_LEN], mesh_file[PETSC_MAX_PATH_LEN];
  PetscReal      mesh_s;
  PetscLogDouble start;
  Scene          scene;
  Mesh           mesh;
  Model          model;
  Probes         probes;
  Checkpoint     checkpoint = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(
    (command->restart ? ReopenScene : OpenScene)(comm, command, directory, &scene, mesh_file, &mesh_s, &checkpoint));
  if (command->mode != COMMAND_MESH) {
    TimingBegin(TIMING_SETUP);
    PetscCall(MeshCreate(comm, scene, mesh_file, &mesh));
    if (command->mode == COMMAND_CHECK) PetscCall(MeshReport(mesh, scene, stdout));
    PetscCall(MeshCheckQuality(mesh, scene));
    if (command->mode == COMMAND_RUN && !checkpoint)
      PetscCall(CheckpointCreate(comm, directory, mesh_file, &checkpoint));
    PetscCall(MeshCheckFormulations(mesh, scene));
    PetscCall(ModelCreate(scene, mesh, &model));
    PetscCall(ProbesCreate(model, scene, &probes));
    if (!command->restart) {
      PetscCall(ModelPlace(model, command->mode == COMMAND_RUN ? scene->stepping.initial : 0));
      TimingEnd(TIMING_SETUP);
      PetscCall(PrecheckModel(model, command->mode == COMMAND_CHECK ? PETSC_TRUE : PETSC_FALSE, stdout));
      TimingBegin(TIMING_SETUP);
      PetscCall(ModelSetUp(model));
    }
    TimingEnd(TIMING_SETUP);
    if (command->mode == COMMAND_RUN)
      PetscCall(RunModel(model, probes, scene, checkpoint, command, directory, start, mesh_s, status));
    PetscCall(ProbesDestroy(&probes));
    PetscCall(ModelDestroy(&model));
    PetscCall(MeshDestroy(&mesh));
  } else
    PetscCall(PetscPrintf(comm, "%s\n", mesh_file));
  PetscCall(CheckpointDestroy(&checkpoint));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  CommandLine command;
  PetscMPIInt rank;
  int         status = EXIT_DONE;

  CommandLineParse(argc, argv, &command);
  if (command.mode == COMMAND_RUN) InterruptionInstall(command.time_limit);
  if (PetscInitialize(&command.argc, &command.argv, NULL, NULL)) return EXIT_MACHINE;
  signal(SIGPIPE, SIG_IGN); /* who reads the terminal's text may leave before its end */
  if (command.mode == COMMAND_RUN) InterruptionInstall(command.time_limit); /* PETSc has taken SIGTERM */
  if (command.complaint[0]) PetscCall(RefuseInput(PETSC_COMM_WORLD, "%s", command.complaint));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (command.mode == COMMAND_HELP && !rank)
    CommandLineHelp(stdout);
  else if (command.mode == COMMAND_VERSION && !rank)
    CommandLineVersion(stdout);
  else if (command.mode != COMMAND_HELP && command.mode != COMMAND_VERSION && RunScene(&command, &status))
    MPI_Abort(PETSC_COMM_WORLD, EXIT_MACHINE); /* the other ranks may wait for this one for ever */
  if (PetscFinalize()) status = EXIT_MACHINE;
  CommandLineDestroy(&command); /* PETSc holds its argv until the end */
  return status;
}
