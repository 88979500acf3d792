/* The physical groups before distribution: the faces of cells that belong to a group, and marks of its nodes. With the
   marks, a rank knows a group's nodes after distribution also where the group's faces are on another rank. Call
   RootGroupsShare() first, then RootGroupsFind() on rank 0, and RootGroupsShareCounts(). RootGroupsCheckUses() and
   RootGroupsContactCells() serve on rank 0 after RootGroupsFind(). */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootGroupsShare(Scene, Mesh, const RootMesh *);
PetscErrorCode RootGroupsFind(Scene, const char *file, RootMesh *, Mesh, Complaint *);
void           RootGroupsCheckUses(Scene, const RootMesh *, Mesh, Complaint *);
PetscErrorCode RootGroupsContactCells(Scene, const RootMesh *, Mesh, PetscBool **contact);
PetscErrorCode RootGroupsShareCounts(Scene, Mesh);
