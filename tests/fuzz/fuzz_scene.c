/* Whatever bytes stand in a scene file, its reader reads a scene or refuses it by a message, and frees a scene that it
 * read. */
#include "fuzz.h"
#include <setjmp.h>
#include <stdarg.h>
#include "base/refusal.h"
#include "scene/scene.h"

/* A refusal ends the program; here it ends the input, and what was allocated on the way is freed for it. */
static jmp_buf Refused;
static char    Message[1 << 16];

typedef struct _n_Allocation {
  struct _n_Allocation *next, *previous;
} Allocation;
static Allocation Allocations = {&Allocations, &Allocations};
enum { HEAD = 64 }; /* before each allocation, aligned as PETSc wants it */

static PetscErrorCode Allocate(size_t size, PetscBool clear, int line, const char *function, const char *file,
                               void **result)
{
  Allocation *a;

  (void)line;
  (void)function;
  (void)file;
  *result = NULL;
  if (!size) return 0;
  a = clear ? calloc(1, HEAD + size) : malloc(HEAD + size);
  if (!a) abort();
  *a                = (Allocation){Allocations.next, &Allocations};
  a->next->previous = a->previous->next = a;
  *result                               = (char *)a + HEAD;
  return 0;
}

static PetscErrorCode Release(void *pointer, int line, const char *function, const char *file)
{
  Allocation *a = pointer ? (Allocation *)((char *)pointer - HEAD) : NULL;

  (void)line;
  (void)function;
  (void)file;
  if (!a) return 0;
  a->next->previous = a->previous;
  a->previous->next = a->next;
  free(a);
  return 0;
}

static PetscErrorCode Reallocate(size_t size, int line, const char *function, const char *file, void **result)
{
  Allocation *a = *result ? realloc((char *)*result - HEAD, HEAD + size) : NULL;

  if (!*result) return Allocate(size, PETSC_FALSE, line, function, file, result);
  if (!a) abort();
  a->next->previous = a->previous->next = a;
  *result                               = (char *)a + HEAD;
  return 0;
}

PetscErrorCode RefuseInput(MPI_Comm comm, const char *format, ...)
{
  va_list arguments;

  (void)comm;
  va_start(arguments, format);
  vsnprintf(Message, sizeof(Message), format, arguments);
  va_end(arguments);
  if (!Message[0]) abort(); /* a refusal says something */
  longjmp(Refused, 1);
}

PetscErrorCode RefuseInputAnywhere(MPI_Comm comm, const char *text)
{
  return text ? RefuseInput(comm, "%s", text) : 0;
}

/* For the leak sanitiser: what libyaml holds when a scene is refused is not freed, as the program ends. */
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
  return "detect_leaks=0";
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  if (PetscMallocSet(Allocate, Release, Reallocate)) abort();
  FuzzStart();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  Allocation *const before = Allocations.next; /* newer ones stand in front of it */
  Scene             scene  = NULL;

  if (!setjmp(Refused)) {
    if (SceneRead(PETSC_COMM_SELF, FuzzFile(data, size), 0, NULL, &scene) || SceneDestroy(&scene)) abort();
    if (Allocations.next != before) abort(); /* something was not freed */
    return 0;
  }
  while (Allocations.next != before) Release((char *)Allocations.next + HEAD, 0, NULL, NULL);
  return 0;
}
