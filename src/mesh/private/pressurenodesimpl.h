/* How the distribution of a mesh makes the nodes of pressurenodes.h: whether there are any, and their arrays. */
#pragma once
#include "mesh/pressurenodes.h"
#include "rootmesh.h"

PetscErrorCode PressureNodesExist(Scene, const RootMesh *, Mesh);
void           PressureNodesPlace(Mesh);
