/* Unknowns of a mesh: which dofs are free, their global numbers, and the exchange of nodal values between ranks. */
#pragma once
#include "mesh/meshdata.h"

/* Marks constrained local dofs (n_nodes*dim; OR-ed over the ranks that share a node), makes the sections. Before any
 * vector. Collective. */
PetscErrorCode MeshSetConstraints(Mesh, const PetscBool *constrained);
/* Global number of every local dof (n_nodes*dim), -1 where constrained; belongs to the mesh. Not collective. */
PetscErrorCode MeshGetGlobalDofs(Mesh, const PetscInt **dofs);
/* x (global, free dofs) into u (n_nodes*dim local, ghosts too); constrained entries of u are left alone. Collective. */
PetscErrorCode MeshGlobalToLocal(Mesh, Vec x, PetscReal *u);
/* The free values among local ones u (n_nodes*dim), ghosts left out. Not collective. */
PetscErrorCode MeshCollectFree(Mesh, const PetscReal *u, Vec x);
/* F = sum over ranks of the free dofs of f (n_nodes*dim local contributions). Collective. */
PetscErrorCode MeshLocalToGlobal(Mesh, const PetscReal *f, Vec F);
/* Sums values (n_nodes*block) over all ranks' copies of a node; the sum stands on every copy. Collective. */
PetscErrorCode MeshSumNodes(Mesh, PetscInt block, PetscReal *values);
