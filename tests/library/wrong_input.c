/* Wrong scenes, one after the other in one process: what the library says of each. tests/input/run calls it.

   wrong_input REPORT [SCENE.yaml | -set KEY=VALUE]...: an edit belongs to the scene before it. REPORT gets a line for
   each scene: its file, the status and the message, with tabs between. */
#include <burnish.h>
#include <string.h>

/* Runs the scene argv[0] with the edits behind it, and returns how many words they are. */
static PetscErrorCode RunWrong(Burnish burnish, FILE *report, int argc, char **argv, int *words)
{
  BurnishStatus status;
  const char   *message;

  PetscFunctionBeginUser;
  PetscCall(BurnishSetScene(burnish, argv[0]));
  for (*words = 1; *words + 1 < argc && !strcmp(argv[*words], "-set"); *words += 2)
    PetscCall(BurnishSet(burnish, argv[*words + 1]));
  PetscCall(BurnishRun(burnish, &status));
  PetscCall(BurnishGetMessage(burnish, &message));
  fprintf(report, "%s\t%d\t%s\n", argv[0], (int)status, message);
  fflush(report);
  PetscFunctionReturn(0);
}

static PetscErrorCode RunAll(int argc, char **argv)
{
  Burnish burnish;
  FILE   *report = fopen(argv[1], "w");

  PetscFunctionBeginUser;
  PetscCheck(report, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be written", argv[1]);
  PetscCall(BurnishCreate(PETSC_COMM_WORLD, &burnish));
  for (int i = 2, words = 0; i < argc; i += words) PetscCall(RunWrong(burnish, report, argc - i, &argv[i], &words));
  PetscCall(BurnishDestroy(&burnish));
  fclose(report);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (argc < 2 || PetscInitializeNoArguments() || RunAll(argc, argv)) return BURNISH_FAILED;
  return PetscFinalize() ? BURNISH_FAILED : BURNISH_DONE;
}
