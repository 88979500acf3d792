/* Values of an archive that stays in memory, see archivememory.h. */
#include "archivememory.h"
#include <string.h>

/* One value, and those that were kept before it */
struct _n_Memory {
  char  *name, *value;
  size_t bytes;
  Memory before;
};

/*@
  MemorySave - keeps a copy of a value.

  Not collective

  Input Parameters:
+ memory - all values so far; NULL: none
. name   - of the value, a new one
. bytes  - length of the value
- value  - the value
@*/
PetscErrorCode MemorySave(Memory *memory, const char *name, size_t bytes, const void *value)
{
  Memory entry;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&entry));
  PetscCall(PetscStrallocpy(name, &entry->name));
  PetscCall(PetscMalloc1(bytes + 1, &entry->value)); /* a value without bytes is there too */
  PetscCall(PetscMemcpy(entry->value, value, bytes));
  entry->bytes  = bytes;
  entry->before = *memory;
  *memory       = entry;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MemoryFind - shows a value.

  Not collective

  Input Parameters:
+ memory - all values
- name   - of the value

  Output Parameters:
+ bytes - length of the value
- value - it belongs to the memory; NULL: there is none of this name
@*/
PetscErrorCode MemoryFind(Memory memory, const char *name, size_t *bytes, const void **value)
{
  PetscFunctionBeginUser;
  while (memory && strcmp(memory->name, name)) memory = memory->before;
  *bytes = memory ? memory->bytes : 0;
  *value = memory ? memory->value : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MemoryDestroy - frees all values.

  Not collective

  Input Parameter:
. memory - set to NULL; may be NULL already
@*/
PetscErrorCode MemoryDestroy(Memory *memory)
{
  PetscFunctionBeginUser;
  while (*memory) {
    Memory entry = *memory;

    *memory = entry->before;
    PetscCall(PetscFree(entry->name));
    PetscCall(PetscFree(entry->value));
    PetscCall(PetscFree(entry));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
