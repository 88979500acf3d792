/* Surfaces of one list that are sides of a sharp convex edge, before distribution. Past the edge each of them alone
   would press back what is in front of the other. They become one group, a new one, that the pairs of the list have in
   their place.

   SliceJoinsAdd() finds them, adds the groups with their faces and has the scene's pairs take them. */
#pragma once
#include "slicemesh.h"

PetscErrorCode SliceJoinsAdd(Scene, SliceMesh *, Mesh);
