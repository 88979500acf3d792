/* Reads the mesh of a scene and shares its cells and nodes out by their tags. SliceRead() fills a slice. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceRead(Scene, const char *file, SliceMesh *, Mesh, Complaint *);
