/* The program burnish: the command line, signals and exit statuses around the library. */
#include <signal.h>
#include <stdio.h>
#include <unistd.h>
#include "burnish.h"
#include "base/explanation.h"
#include "base/interruption.h"
#include "base/loneprocess.h"
#include "base/scripts.h"
#include "scene/commandline.h"

/* Prints the one message of wrong input. All ranks call it, rank 0 prints. */
static PetscErrorCode PrintMistake(const char *message)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) {
    fflush(stdout);
    fprintf(stderr, "burnish: %s\n", message);
    fflush(stderr);
  }
  /* Builds of PETSc for debugging list the options that nothing has looked at yet. Beside the message that is noise. */
  PetscCall(PetscOptionsSetValue(NULL, "-options_left", "0"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromCommandLine(Burnish burnish, const CommandLine *command)
{
  PetscFunctionBeginUser;
  if (command->restart)
    PetscCall(BurnishSetRestart(burnish, command->restart));
  else
    PetscCall(BurnishSetScene(burnish, command->scene));
  for (int i = 0; i < command->n_set; i++) PetscCall(BurnishSet(burnish, command->set[i]));
  PetscCall(BurnishSetDirectory(burnish, command->directory));
  PetscCall(BurnishSetOverwrite(burnish, command->overwrite ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(BurnishSetQuiet(burnish, command->quiet ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(BurnishSetTrust(burnish, command->trust ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs, checks or meshes the scene. An error of the library is in error.log already; its code is handed on without a
   second trace. */
static PetscErrorCode RunCommand(const CommandLine *command, BurnishStatus *status)
{
  Burnish        burnish;
  const char    *message, *file;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(BurnishCreate(PETSC_COMM_WORLD, &burnish));
  PetscCall(SetFromCommandLine(burnish, command));
  code = command->mode == COMMAND_CHECK  ? BurnishCheck(burnish, status)
         : command->mode == COMMAND_MESH ? BurnishMesh(burnish, status, &file)
                                         : BurnishRun(burnish, status);
  if (code) PetscFunctionReturn(code);
  PetscCall(BurnishGetMessage(burnish, &message));
  if (*status == BURNISH_WRONG_INPUT)
    PetscCall(PrintMistake(message));
  else if (command->mode == COMMAND_MESH)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n", file));
  PetscCall(BurnishDestroy(&burnish));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints what is known of the code of a message. */
static PetscErrorCode Explain(const char *code, PetscMPIInt rank, BurnishStatus *status)
{
  static const char message[] =
    "-explain: there is no such code; allowed: the code at the end of a message, or all [B120]";

  PetscFunctionBeginUser;
  if (!ExplanationPrint(code, rank ? NULL : stdout)) {
    *status = BURNISH_WRONG_INPUT;
    PetscCall(PrintMistake(message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does what the command line asks for. */
static PetscErrorCode Obey(const CommandLine *command, BurnishStatus *status)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (command->complaint[0]) {
    *status = BURNISH_WRONG_INPUT;
    PetscCall(PrintMistake(command->complaint));
  } else if (command->mode == COMMAND_HELP) {
    if (!rank) CommandLineHelp(stdout);
  } else if (command->mode == COMMAND_EXPLAIN) {
    PetscCall(Explain(command->code, rank, status));
  } else if (command->mode == COMMAND_VERSION) {
    if (!rank) CommandLineVersion(stdout);
  } else {
    const PetscErrorCode code = RunCommand(command, status);

    PetscFunctionReturn(code);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Becomes a script with two arguments, the second of which may be NULL. It returns only if that fails. */
static BurnishStatus BecomeScript(const char *name, const char *first, const char *second)
{
  char script[SCRIPTS_PATH], python[SCRIPTS_PATH];

  if (ScriptsFind(name, script, python)) {
    execlp(python, python, "-B", script, first, second, (char *)NULL);
    fprintf(stderr, "burnish: there is no Python here (%s); `make deps` installs one [B400]\n", python);
  } else
    fprintf(stderr,
            "burnish: scripts/%s is not found; set " SCRIPTS_VARIABLE " to the folder in which scripts/%s is [B400]\n",
            name, name);
  return BURNISH_FAILED;
}

/* Rank 0 has printed its message before any rank ends, because MPI_Finalize() in PetscFinalize() waits for all ranks. A
   launcher that ends the job at the first status that is not 0 therefore finds the message written. */
int main(int argc, char **argv)
{
  CommandLine   command;
  BurnishStatus status = BURNISH_DONE;

  CommandLineParse(argc, argv, &command);
  if (command.mode == COMMAND_IMPORT && !command.complaint[0])
    return BecomeScript("import_deck.py", command.deck, command.scene);
  if (command.mode == COMMAND_EVALUATE && !command.complaint[0])
    return BecomeScript("evaluate.py", command.results, command.scene);
  if (command.mode == COMMAND_RUN) InterruptionInstall(command.time_limit);
  LoneProcessPrepare();
  if (PetscInitialize(&command.argc, &command.argv, NULL, NULL)) return BURNISH_FAILED;
  signal(SIGPIPE, SIG_IGN); /* a reader of the terminal's text may leave before its end */
  if (command.mode == COMMAND_RUN) InterruptionInstall(command.time_limit); /* PETSc has taken SIGTERM */
  if (Obey(&command, &status)) MPI_Abort(PETSC_COMM_WORLD, BURNISH_FAILED); /* other ranks may wait for this one */
  if (PetscFinalize()) status = BURNISH_FAILED;
  CommandLineDestroy(&command); /* PETSc uses its argv until the end */
  return status;
}
