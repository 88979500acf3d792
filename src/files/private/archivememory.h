/* Values of an archive that stays in memory: each rank keeps its own, by name.

   MemorySave() keeps a copy of a value, MemoryFind() shows it, MemoryDestroy() frees all. */
#pragma once
#include "base/petsccompat.h"

typedef struct _n_Memory *Memory;

PetscErrorCode MemorySave(Memory *, const char *name, size_t bytes, const void *value);
PetscErrorCode MemoryFind(Memory, const char *name, size_t *bytes, const void **value);
PetscErrorCode MemoryDestroy(Memory *);
