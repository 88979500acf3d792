/* Distribution of the mesh from the ranks' slices to their arrays. MeshDistribute() is called once, after the partition
   is known. */
#pragma once
#include "slicemesh.h"

PetscErrorCode MeshDistribute(SliceMesh *, const PetscMPIInt part[], Mesh);
