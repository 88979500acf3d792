/* Unknowns of a mesh: the free dofs, their global numbers, and the exchange of nodal values between ranks.
   MeshSetConstraints() sets which dofs are prescribed; call it before any vector is created. MeshCreateVector() makes
   vectors of the free dofs. MeshGlobalToLocal() and MeshLocalToGlobal() exchange values between local arrays, which
   have every dof, and global vectors, which have the free ones. MeshCreateLocal() makes local arrays that are there on
   ranks without nodes too. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshSetConstraints(Mesh, const PetscBool *constrained);
PetscErrorCode MeshGetGlobalDofs(Mesh, const PetscInt **dofs);
PetscErrorCode MeshCreateVector(Mesh, Vec *x);
PetscErrorCode MeshGlobalToLocal(Mesh, Vec x, PetscReal *u);
PetscErrorCode MeshCollectFree(Mesh, const PetscReal *u, Vec x);
PetscErrorCode MeshLocalToGlobal(Mesh, const PetscReal *f, Vec F);
PetscErrorCode MeshSumNodes(Mesh, PetscInt block, PetscReal *values);
PetscErrorCode MeshCreateLocal(Mesh, PetscInt block, PetscReal **values);
