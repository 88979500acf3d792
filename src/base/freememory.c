/* Memory that is free in the process and not in the system, see freememory.h. */
#include <stdlib.h>
#include "base/freememory.h"
#ifdef __GLIBC__
  #include <malloc.h>
#endif

/* Size (bytes) from which on an array has pages of its own. There are some tens of such arrays in a run of a million
   unknowns. */
#define FREE_MEMORY_LARGE (1 << 24)
/* Most arrays with pages of their own: the C library's own bound. */
#define FREE_MEMORY_ARRAYS 65536

/*@
  FreeMemoryReturn - gives what this process has freed back to the system.

  Not collective

  Note:
  It does nothing where the C library is not glibc.
@*/
void FreeMemoryReturn(void)
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/*@
  FreeMemoryAtOnce - has large arrays go back to the system as soon as they are freed, from now on.

  Not collective

  Note:
  It does nothing where the C library is not glibc.
@*/
void FreeMemoryAtOnce(void)
{
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, FREE_MEMORY_LARGE);
  mallopt(M_MMAP_MAX, FREE_MEMORY_ARRAYS);
#endif
}
