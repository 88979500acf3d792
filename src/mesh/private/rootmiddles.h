/* Middle nodes before distribution. RootMiddlesCheck() looks for cells that share an edge or face but not its middle
   node. */
#pragma once
#include "rootmesh.h"

PetscErrorCode RootMiddlesCheck(const char *file, const RootMesh *, Complaint *);
