/* Cells that face each other across contact before distribution, so that the partition may keep them on one rank.
   RootLinksFind() is called on rank 0 before PartitionCells(). */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootLinksFind(Scene, const RootMesh *, Mesh, CellLinks *);
