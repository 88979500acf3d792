/* The DMPlex of the mesh: each rank makes it of its own cells and nodes after the distribution, and no rank holds more.
   Point c is local cell c. Its cone lists all its nodes in gmsh's order; there are no edges and faces. Point
   n_cells + n is local node n, with a dof for each component. The DM knows the owners of nodes, numbers the free dofs,
   and makes the vectors of the unknowns. MeshPlexCreate() makes it. MeshPlexNumberDofs() numbers the dofs, again
   whenever other ones are prescribed; the DM is then a new one of the same points. MeshPlexView() shows it. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshPlexCreate(Mesh);
PetscErrorCode MeshPlexNumberDofs(Mesh, const PetscBool constrained[]);
PetscErrorCode MeshPlexView(Mesh);
