/* Meshed rigid tools: from rank 0's file, whole, to all ranks. */
#pragma once
#include "rootmesh.h"

/* Fills mesh->rigid; refuses a tool whose surface the mesh does not have. Collective. */
PetscErrorCode RootRigidCreate(Scene, const RootMesh *, Mesh);
/* Frees mesh->rigid. Not collective. */
PetscErrorCode RootRigidDestroy(Mesh);
