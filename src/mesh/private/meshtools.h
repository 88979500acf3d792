/* Rigid tools with free motions and the nodes that carry their unknowns. MeshToolsList() finds the tools of a scene
   before the mesh is distributed, MeshToolsPlaceNodes() fills their nodes. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshToolsList(Scene, Mesh);
PetscErrorCode MeshToolsPlaceNodes(Mesh);
