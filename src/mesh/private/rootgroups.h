/* The physical groups before distribution: the faces of cells that belong to a group, and a label on the points of its
   nodes. With the label, a rank knows a group's nodes after distribution also where the group's faces are on another
   rank. Call RootGroupsShare() first, then RootGroupsFind() on rank 0, and RootGroupsShareCounts().
   RootGroupsCheckUses() and RootGroupsContactCells() serve on rank 0 after RootGroupsFind(). */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootGroupsShare(DM, Scene, Mesh, const RootMesh *);
PetscErrorCode RootGroupsFind(DM, Scene, const char *file, RootMesh *, Mesh, Complaint *);
void           RootGroupsCheckUses(Scene, const RootMesh *, Mesh, Complaint *);
PetscErrorCode RootGroupsContactCells(Scene, const RootMesh *, Mesh, PetscBool **contact);
PetscErrorCode RootGroupsShareCounts(Scene, Mesh);
