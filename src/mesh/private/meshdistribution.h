/* From rank 0's mesh to every rank's arrays: what belongs to nodes and cells travels with their Plex points. */
#pragma once
#include "rootmesh.h"

/* Distributes mesh->dm as its partitioner says, then fills the mesh's node, cell and group arrays. Rank 0's mesh is
   reset on the way, as soon as it is packed. Collective. */
PetscErrorCode MeshDistribute(RootMesh *, Mesh);
