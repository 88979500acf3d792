/* Which points lie in a body. MeshPointsInBody() asks the cells of all ranks. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshPointsInBody(Mesh, int body, double core, PetscInt n, const PetscReal *x, PetscBool *inside);
