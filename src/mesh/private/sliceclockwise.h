/* Plane surfaces whose cells run clockwise in the file, before distribution. SliceClockwiseTurn() turns them. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceClockwiseTurn(SliceMesh *);
