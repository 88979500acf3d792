/* The DMPlex of the whole mesh on rank 0, made by hand from gmsh's cells, and the Plex point on which every node sits.
 */
#pragma once
#include "rootmesh.h"

/* Points are cells (by id), vertices, and, of second order, the faces and edges that interpolation adds. Collective. */
PetscErrorCode RootTopologyCreate(MPI_Comm, int dim, int order, const RootMesh *, DM *);
/* The vertices' coordinates on the DM, for viewers. Collective. */
PetscErrorCode RootTopologySetCoordinates(DM, int dim, const RootMesh *);
/* Fills root->point; complains where cells share an edge or face but not its middle node. Rank 0 only. */
PetscErrorCode RootTopologyPlaceNodes(DM, const char *file, RootMesh *, Complaint *);
