/* Which cells face each other across contact before distribution, so that the partition may keep them on one rank. */
#pragma once
#include "rootmesh.h"

/* Every cell of a slave surface and the nearest one of its master; their array to be freed by PetscFree(). Rank 0 only.
 */
PetscErrorCode RootLinksFind(Scene, const RootMesh *, Mesh, CellLinks *);
