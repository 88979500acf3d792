/* What each element leaves of the error of each probe, in results.vtkhdf.

   ErrorFieldsWrite() adds the group /error once at the end of a run: centres (n x 3, reference coordinates) and, by the
   name of each probe that has an estimate, n shares in the probe's units, true less computed, whose sum is the part of
   the bodies. Rows are ordered by gmsh's tags of the cells: the same on any number of ranks. */
#pragma once
#include "probeerrors.h"

PetscErrorCode ErrorFieldsWrite(Mesh, Scene, ProbeErrors, const char *directory);
