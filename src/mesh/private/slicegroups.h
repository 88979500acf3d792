/* The physical groups before distribution: the faces of cells that belong to a group, and marks of its nodes. With the
   marks, a rank knows a group's nodes after distribution also where the group's faces are on another rank. Call
   SliceGroupsShare() first, then SliceGroupsFind(). SliceGroupsCheckUses() and SliceGroupsContactCells() serve
   afterwards. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceGroupsShare(Scene, Mesh, const SliceMesh *);
PetscErrorCode SliceGroupsFind(Scene, const char *file, SliceMesh *, Mesh, Complaint *);
void           SliceGroupsCheckUses(Scene, const SliceMesh *, Mesh, Complaint *);
PetscErrorCode SliceGroupsContactCells(Scene, const SliceMesh *, Mesh, PetscBool **contact);
