/* Meshed rigid tools, which every rank gets as a whole. SliceRigidCreate() fills mesh->rigid after the
   groups are known, SliceRigidDestroy() frees it. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceRigidCreate(Scene, const SliceMesh *, Mesh);
PetscErrorCode SliceRigidDestroy(Mesh);
