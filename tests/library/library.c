/* How a program uses Burnish as a library: a wrong scene, then the same scene without the mistake, then a probe.

   mpicc library.c $(pkg-config --cflags --libs burnish) -o library; mpirun -n 2 ./library SCENE.yaml */
#include <burnish.h>

/* Runs the scene with one value changed and prints how the run ended. */
static PetscErrorCode RunWith(Burnish burnish, const char *scene, const char *key_value, BurnishStatus *status)
{
  const char *message;

  PetscFunctionBeginUser;
  PetscCall(BurnishSetScene(burnish, scene));
  PetscCall(BurnishSet(burnish, key_value));
  PetscCall(BurnishRun(burnish, status));
  PetscCall(BurnishGetMessage(burnish, &message));
  PetscCall(
    PetscPrintf(PETSC_COMM_WORLD, "%s: status %d%s%s\n", key_value, (int)*status, *message ? ": " : "", message));
  PetscFunctionReturn(0);
}

static PetscErrorCode Example(const char *scene)
{
  Burnish       burnish;
  BurnishStatus status;
  PetscReal     pressure = 0;

  PetscFunctionBeginUser;
  PetscCall(BurnishCreate(PETSC_COMM_WORLD, &burnish));
  PetscCall(BurnishSetQuiet(burnish, PETSC_TRUE));
  PetscCall(BurnishSetOverwrite(burnish, PETSC_TRUE));

  PetscCall(RunWith(burnish, scene, "bodies.0.material.E=soft", &status));
  PetscCheck(status == BURNISH_WRONG_INPUT, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "A word was taken for a modulus");

  for (int load = 10; load <= 20; load += 10) {
    char edit[64];

    PetscCall(PetscSNPrintf(edit, sizeof(edit), "loads.0.pressure=%d", load));
    PetscCall(RunWith(burnish, scene, edit, &status));
    PetscCheck(status == BURNISH_DONE, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "The scene does not run");
    PetscCall(BurnishGetProbe(burnish, "mean", &pressure));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "mean contact pressure %g\n", (double)pressure));
    PetscCheck(PetscAbsReal(pressure - load) < 1e-3 * load, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "It is not the load");
  }
  PetscCall(BurnishDestroy(&burnish));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscErrorCode code;

  if (argc < 2 || PetscInitialize(&argc, &argv, NULL, NULL)) return BURNISH_FAILED;
  code = Example(argv[1]);
  if (code) MPI_Abort(PETSC_COMM_WORLD, BURNISH_FAILED); /* other ranks may wait for this one */
  return PetscFinalize() ? BURNISH_FAILED : BURNISH_DONE;
}
