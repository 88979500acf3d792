/* The DMPlex of the whole mesh on rank 0, made from gmsh's cells, and the Plex point of every node. Call
   RootTopologyCreate(), RootTopologySetCoordinates(), and RootTopologyPlaceNodes() on rank 0. */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootTopologyCreate(MPI_Comm, int dim, int order, const RootMesh *, DM *);
PetscErrorCode RootTopologySetCoordinates(DM, int dim, const RootMesh *);
PetscErrorCode RootTopologyPlaceNodes(DM, const char *file, RootMesh *, Complaint *);
