/* Shows that the reader of scene files reads a scene or refuses it with a message, whatever bytes the file has, and
   that all its memory is freed. */
#include "fuzz.h"
#include "base/errorlog.h"
#include "base/refusal.h"
#include "scene/scene.h"

/* Number of allocations of PETSc that are not freed yet */
static long Allocations;

static PetscErrorCode Allocate(size_t size, PetscBool clear, int line, const char *function, const char *file,
                               void **result)
{
  (void)line;
  (void)function;
  (void)file;
  *result = NULL;
  if (!size) return 0;
  *result = clear ? calloc(1, size) : malloc(size);
  if (!*result) abort();
  Allocations++;
  return 0;
}

static PetscErrorCode Release(void *pointer, int line, const char *function, const char *file)
{
  (void)line;
  (void)function;
  (void)file;
  if (pointer) Allocations--;
  free(pointer);
  return 0;
}

static PetscErrorCode Reallocate(size_t size, int line, const char *function, const char *file, void **result)
{
  if (!*result) return Allocate(size, PETSC_FALSE, line, function, file, result);
  *result = realloc(*result, size);
  if (!*result) abort();
  return 0;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  if (PetscMallocSet(Allocate, Release, Reallocate)) abort();
  FuzzStart();
  if (ErrorLogBegin()) abort(); /* With its error handler, refusals print no trace. */
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const long           before  = Allocations;
  Scene                scene   = NULL;
  char                *message = NULL;
  const PetscErrorCode code    = SceneRead(PETSC_COMM_SELF, FuzzFile(data, size), 0, NULL, &scene);

  if (RefusalTake(&message)) abort();
  if (code != (message ? REFUSED : 0) || (message && !message[0])) abort(); /* A refusal must have a message. */
  if (PetscFree(message) || SceneDestroy(&scene)) abort();
  if (Allocations != before) abort(); /* All memory must be free. */
  return 0;
}
