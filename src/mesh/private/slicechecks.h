/* Checks of a mesh file against the scene, before distribution. SliceChecksBlocks() serves before cells are shared out,
   SliceChecksPlane() after it. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceChecksBlocks(Scene, const char *file, const SliceMesh *, int body[], Complaint *);
void           SliceChecksPlane(Scene, const char *file, const SliceMesh *, PetscReal size, Complaint *);
