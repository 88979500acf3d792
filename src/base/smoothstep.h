/* A smooth transition, with which areas and weights fade. Plain C. */
#pragma once

/*@
  SmoothStep - rises from 0 to 1 between 0 and 1, with zero slope at both ends.

  Not collective

  Input Parameter:
. x - the argument; 0 is returned below 0, and 1 above 1
@*/
static inline double SmoothStep(double x)
{
  x = x < 0 ? 0 : x > 1 ? 1 : x;
  return x * x * (3 - 2 * x);
}
