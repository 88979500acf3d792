/* How the distribution of a mesh makes the nodes of pressurenodes.h: whether there are any, and their arrays. */
#pragma once
#include "mesh/pressurenodes.h"
#include "slicemesh.h"

PetscErrorCode PressureNodesExist(Scene, const SliceMesh *, Mesh);
void           PressureNodesPlace(Mesh);
