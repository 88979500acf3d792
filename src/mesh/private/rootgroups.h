/* The physical groups before distribution: which faces of which cells they are, and a label on the points of their
   nodes, so that after it a rank knows a group's nodes also where the group's faces are another rank's. */
#pragma once
#include "rootmesh.h"

/* Names, tags and dimensions from rank 0 to all, and the groups' labels, still empty. Collective. */
PetscErrorCode RootGroupsShare(DM, Mesh, const RootMesh *);
/* Finds the groups' faces and labels their points; complains of a rigid tool that shares faces with a body. Rank 0
 * only. */
PetscErrorCode RootGroupsFind(DM, Scene, const char *file, RootMesh *, Mesh, Complaint *);
/* Complains of loads and contact on a surface between cells. Rank 0 only. */
void RootGroupsCheckUses(Scene, const RootMesh *, Mesh, Complaint *);
/* Which cells have a face in contact; to be freed by PetscFree(). Rank 0 only. */
PetscErrorCode RootGroupsContactCells(Scene, const RootMesh *, Mesh, PetscBool **contact);
/* What rank 0 found, to all: how many elements a group has and whether they are the bodies'. Collective. */
PetscErrorCode RootGroupsShareCounts(Scene, Mesh);
