/* Middle nodes before distribution. SliceMiddlesCheck() looks for cells that share an edge or face but not its middle
   node. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceMiddlesCheck(const char *file, const SliceMesh *, Complaint *);
