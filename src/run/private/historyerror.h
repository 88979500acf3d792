/* What the load steps leave of error in the probes of a run whose answer depends on the way to it, by a second run with
   half of the steps (output.error: history).

   Both runs have the same mesh. The second one ends its steps at every other load parameter at which one of the first
   ended. Laws of plastic flow and of friction are integrated by backward differences, whose error falls with the first
   power of the step: what is left is the difference of the two answers. A run of a single step is followed by one of
   two steps, and the difference counts twice. Source: Hairer, Norsett and Wanner, Solving Ordinary Differential
   Equations 1 (Springer, 1993), II.4. */
#pragma once
#include "again.h"

PetscErrorCode HistoryErrorFind(Run *, const RunInput *, RunAgainFn);
