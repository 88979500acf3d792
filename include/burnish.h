/* Burnish as a library: a scene from its file to its results.

   A program creates a Burnish object, names a scene, runs it, and asks for the values of the scene's probes. It calls
   PetscInitialize() before the first and PetscFinalize() after the last of these functions. A run never ends the
   process: wrong input in the scene or in the mesh comes back as the status BURNISH_WRONG_INPUT with a message, and the
   program can go on with another scene. tests/library/library.c is a small example.

   BurnishSetScene() and BurnishSetRestart() forget the values of BurnishSet(). Directory, overwrite, quiet and trust
   stay until they are set again. A message and the path of a mesh file are valid until the next run or BurnishDestroy(). The
   value of a probe is NaN where it has none, for example without contact. Meshes that are made go to out/ in the
   working directory. One object runs at a time in a process, because PETSc's options and error handlers belong to the
   process.

   All functions are collective on the communicator of the object, unless they say otherwise. A function returns a code
   of PETSc other than 0 only for an internal error, a failure of the machine (memory, disk), or a wrong call. After
   such a code from a run, other ranks may still wait for this one, so that the program should end with MPI_Abort(). */
#ifndef BURNISH_H
#define BURNISH_H
#include <petscsys.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a run ended. These are also the exit statuses of the program burnish. */
typedef enum {
  BURNISH_DONE          = 0, /* the load parameter has reached 1 */
  BURNISH_WRONG_INPUT   = 1, /* the scene, the mesh or an option is wrong; nothing was overwritten */
  BURNISH_NOT_CONVERGED = 2, /* a load step failed; the results up to it are there */
  BURNISH_STOPPED       = 3, /* a signal or a time limit ended the run after a checkpoint */
  BURNISH_FAILED        = 4, /* internal error or failure of the machine; the trace is in error.log */
  BURNISH_INACCURATE    = 5  /* the accuracy that the scene asks for is not reached; the best results are there */
} BurnishStatus;

typedef struct _n_Burnish *Burnish;

PetscErrorCode BurnishCreate(MPI_Comm comm, Burnish *burnish);
PetscErrorCode BurnishSetScene(Burnish burnish, const char *file);
PetscErrorCode BurnishSet(Burnish burnish, const char *key_value);
PetscErrorCode BurnishSetDirectory(Burnish burnish, const char *directory);
PetscErrorCode BurnishSetRestart(Burnish burnish, const char *directory);
PetscErrorCode BurnishSetOverwrite(Burnish burnish, PetscBool overwrite);
PetscErrorCode BurnishSetQuiet(Burnish burnish, PetscBool quiet);
PetscErrorCode BurnishSetTrust(Burnish burnish, PetscBool trust);
PetscErrorCode BurnishRun(Burnish burnish, BurnishStatus *status);
PetscErrorCode BurnishCheck(Burnish burnish, BurnishStatus *status);
PetscErrorCode BurnishMesh(Burnish burnish, BurnishStatus *status, const char **file);
PetscErrorCode BurnishGetMessage(Burnish burnish, const char **message);
PetscErrorCode BurnishGetProbe(Burnish burnish, const char *name, PetscReal *value);
PetscErrorCode BurnishDestroy(Burnish *burnish);

#ifdef __cplusplus
}
#endif
#endif
