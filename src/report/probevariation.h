/* First variations of probes, for estimates of their error (solve/adjoint.h).

   ProbeVary() gives that of one probe, or says why there is none: a value that jumps from node to node, such as a peak
   or the end of a contact zone, has no error that first variations tell. */
#pragma once
#include "report/probe.h"
#include "solve/adjoint.h"

PetscErrorCode ProbeVary(Probes, int i, Functional *, const char **why);
PetscErrorCode ProbeVariationFree(Functional *);
