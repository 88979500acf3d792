/* Meshed rigid tools, which rank 0 reads and every rank gets as a whole. RootRigidCreate() fills mesh->rigid after the
   groups are known, RootRigidDestroy() frees it. */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootRigidCreate(Scene, const RootMesh *, Mesh);
PetscErrorCode RootRigidDestroy(Mesh);
