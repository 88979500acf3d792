/* Rigid tools with free motions and the nodes that carry their unknowns. MeshToolsList() finds the tools of a scene
   before the mesh is distributed, MeshToolsPlaceNodes() fills their nodes,
   MeshToolsMeasureBolts() measures bolts, which have such nodes too. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshToolsList(Scene, Mesh);
PetscErrorCode MeshToolsPlaceNodes(Mesh);
PetscErrorCode MeshToolsMeasureBolts(Scene, Mesh);
