/* burnish: scene -> mesh -> model -> load stepper -> results. */
#include <petsctime.h>
#include "commandline.h"
#include "errorlog.h"
#include "precheck.h"
#include "refusal.h"
#include "results.h"
#include "stepper.h"
#include "timing.h"

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

static PetscErrorCode MonitorResults(LoadStepper stepper, const StepRecord *record, void *context)
{
  PetscFunctionBeginUser;
  (void)stepper;
  PetscCall(ResultsStep(context, record));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps the model to t = 1 and writes what is to be written; the exit status says how it ended. */
static PetscErrorCode RunModel(Model model, Probes probes, Scene scene, const CommandLine *command, const char *directory, PetscLogDouble start,
                               PetscReal mesh_s, int *status)
{
  Results        results;
  RunRecord      run;
  PetscLogStage  stage;
  PetscLogDouble now;
  LoadStepper    stepper;
  StepperReport  report;

  PetscFunctionBeginUser;
  PetscCall(ResultsCreate(model, probes, scene, directory, command->quiet ? PETSC_TRUE : PETSC_FALSE, &results));
  PetscCall(ResultsStart(results));
  PetscCall(LoadStepperCreate(PETSC_COMM_WORLD, &stepper));
  PetscCall(LoadStepperSetModel(stepper, model));
  PetscCall(LoadStepperSetFromScene(stepper, scene));
  PetscCall(LoadStepperSetFromOptions(stepper));
  PetscCall(LoadStepperMonitorSet(stepper, MonitorResults, results));
  PetscCall(PetscLogStageRegister("Load steps", &stage));
  PetscCall(PetscLogStagePush(stage));
  PetscCall(LoadStepperSolve(stepper, &report));
  PetscCall(PetscLogStagePop());
  PetscCall(PetscTime(&now));
  run = (RunRecord){.status            = report.done ? "done" : "not converged",
                    .message           = report.done ? NULL : report.message,
                    .steps             = report.steps,
                    .steps_failed      = report.steps_failed,
                    .steps_repeated    = report.steps_repeated,
                    .newton_iterations = report.newton_iterations,
                    .newton_accepted   = report.newton_accepted,
                    .krylov_iterations = report.krylov_iterations,
                    .wall_s            = now - start,
                    .mesh_s            = mesh_s,
                    .way               = &report};
  PetscCall(ResultsFinish(results, &run));
  PetscCall(LoadStepperDestroy(&stepper));
  PetscCall(ResultsDestroy(&results));
  *status = report.done ? EXIT_DONE : EXIT_NOT_CONVERGED;
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

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(SceneRead(comm, command->scene, command->n_set, command->set, &scene));
  PetscCall(InsertSceneOptions(scene));
  PetscCall(PetscSNPrintf(directory, sizeof(directory), "%s%s", command->directory ? command->directory : "out/", command->directory ? "" : scene->name));
  PetscCall(ErrorLogOpen(directory));
  if (command->mode == COMMAND_RUN) PetscCall(ResultsCheckDirectory(comm, scene, directory, command->overwrite ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(MeshGenerate(comm, scene, "out", mesh_file, &mesh_s));
  if (command->mode != COMMAND_MESH) {
    TimingBegin(TIMING_SETUP);
    PetscCall(MeshCreate(comm, scene, mesh_file, &mesh));
    if (command->mode == COMMAND_CHECK) PetscCall(MeshReport(mesh, scene, stdout));
    PetscCall(MeshCheckQuality(mesh, scene));
    PetscCall(ModelCreate(scene, mesh, &model));
    PetscCall(ProbesCreate(model, scene, &probes));
    PetscCall(ModelPlace(model));
    TimingEnd(TIMING_SETUP);
    PetscCall(PrecheckModel(model, command->mode == COMMAND_CHECK ? PETSC_TRUE : PETSC_FALSE, stdout));
    TimingBegin(TIMING_SETUP);
    PetscCall(ModelSetUp(model));
    TimingEnd(TIMING_SETUP);
    if (command->mode == COMMAND_RUN) PetscCall(RunModel(model, probes, scene, command, directory, start, mesh_s, status));
    PetscCall(ProbesDestroy(&probes));
    PetscCall(ModelDestroy(&model));
    PetscCall(MeshDestroy(&mesh));
  } else
    PetscCall(PetscPrintf(comm, "%s\n", mesh_file));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  CommandLine command;
  PetscMPIInt rank;
  int         status = EXIT_DONE;

  CommandLineParse(argc, argv, &command);
  if (PetscInitialize(&command.argc, &command.argv, NULL, NULL)) return EXIT_MACHINE;
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
