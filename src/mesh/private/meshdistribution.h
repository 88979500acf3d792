/* Distribution of the mesh from rank 0 to every rank's arrays. The data of nodes and cells travel with their points in
   the Plex. MeshDistribute() is called once, after the partition is known. */
#pragma once
#include "rootmesh.h"

PetscErrorCode MeshDistribute(RootMesh *, Mesh);
