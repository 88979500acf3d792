/* Functions that the benches of the kernels share. Seconds() returns the CPU time of the process, which other work on
   the machine does not lengthen. Random() returns a random number in an interval. */
#pragma once
#include <stdlib.h>
#include <time.h>

static inline double Seconds(void)
{
  struct timespec now;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline double Random(double low, double high)
{
  return low + (high - low) * rand() / RAND_MAX;
}
