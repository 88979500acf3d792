/* Memory that is free in the process and not in the system, see freememory.h. */
#include <stdlib.h>
#include "base/freememory.h"
#ifdef __GLIBC__
#include <malloc.h>
#endif

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
