/* Every face of the bodies' cells before distribution, by its corners, and the cells that share it. In two dimensions
   the faces are edges. They are shared out by their lowest corners. CellFacesCreate() lists the faces. Then
   CellFacesFind() finds the cells of one face, CellFacesCheck() looks for bodies that are meshed twice, and
   CellFacesPairs() lists neighbours for the graph of the cells. CellFacesFree() frees the list. */
#pragma once
#include "slicemesh.h"

PetscErrorCode CellFacesCreate(SliceMesh *);
PetscErrorCode CellFacesFree(SliceMesh *);
void           CellFacesSortCorners(int n, const PetscInt ids[], PetscInt corner[CELL_FACE_CORNERS]);
PetscInt       CellFacesSame(const SliceMesh *, const CellFace *);
PetscInt       CellFacesFind(const SliceMesh *, const PetscInt corner[CELL_FACE_CORNERS], const CellFace **face);
PetscErrorCode CellFacesCheck(Scene, const char *file, const SliceMesh *, Complaint *);
PetscErrorCode CellFacesPairs(const SliceMesh *, PetscInt *n, PetscInt **pairs);
