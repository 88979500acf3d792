/* Every face of the bodies' cells before distribution, by its corners: which cells share it. In two dimensions these
 * are edges. */
#pragma once
#include "rootmesh.h"

/* Fills root->cell_faces. Rank 0 only. */
PetscErrorCode CellFacesCreate(RootMesh *);
/* The face with these corners: how many cells have it, the first of them, that with the lowest id, at *face; 0: there
 * is none. Rank 0 only. */
PetscInt CellFacesFind(const RootMesh *, int n, const PetscInt vertices[], const CellFace **face);
/* Cells across faces: those of cell c are adjacency[offsets[c]..offsets[c + 1]); both to be freed by PetscFree(). Rank
 * 0 only. */
PetscErrorCode CellFacesNeighbours(const RootMesh *, PetscInt **offsets, PetscInt **adjacency);
