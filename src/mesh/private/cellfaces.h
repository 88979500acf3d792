/* Every face of the bodies' cells before distribution, by its corners, and the cells that share it. In two dimensions
   the faces are edges. All functions are called on rank 0 only. CellFacesCreate() lists the faces in the RootMesh. Then
   CellFacesFind() finds the cells of one face, CellFacesCheck() looks for bodies that are meshed twice, and
   CellFacesNeighbours() computes the graph of cells, which the partition needs. CellFacesFree() frees the list. */
#pragma once
#include "rootmesh.h"

PetscErrorCode CellFacesCreate(RootMesh *);
PetscInt       CellFacesFind(const RootMesh *, int n, const PetscInt vertices[], const CellFace **face);
void           CellFacesCheck(Scene, const char *file, const RootMesh *, Complaint *);
PetscErrorCode CellFacesFree(RootMesh *);
PetscErrorCode CellFacesNeighbours(const RootMesh *, PetscInt **offsets, PetscInt **adjacency);
