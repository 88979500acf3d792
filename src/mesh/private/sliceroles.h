/* Pairs of which the master has a sharp edge that stands on the slave, before distribution. The slave's points beside
   the edge would be pressed out along its flanks. With the roles swapped the edge is held by the slave's faces.

   SliceRolesChoose() swaps the roles of such pairs. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceRolesChoose(Scene, const SliceMesh *, Mesh);
