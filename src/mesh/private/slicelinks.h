/* Cells that face each other across contact before distribution, so that the partition may keep them on one rank.
   SliceLinksFind() is called before CellGraphCreate(). */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceLinksFind(Scene, const SliceMesh *, Mesh, CellLinks *);
