/* Distribution of the mesh from rank 0 to every rank's arrays. MeshDistribute() is called once, after the partition is
   known. */
#pragma once
#include "rootmesh.h"

PetscErrorCode MeshDistribute(RootMesh *, const PetscMPIInt part[], Mesh);
