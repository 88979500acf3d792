/* Sizes of elements: those of a mesh, and those wanted of the next one as a view that gmsh reads (mesh.sizes).

   MeshCellSizes() gives the present ones, MeshSizesWrite() writes wanted ones: each node gets the geometric mean of
   those of its cells, and then at most what its neighbours' sizes and a bounded growth allow. gmsh interpolates between
   the corners of the cells. Rigid tools have a size each, and do not become coarser. The file does not depend on the
   number of ranks. */
#pragma once
#include "mesh/meshdata.h"

void           MeshCellSizes(Mesh, PetscReal *size, PetscReal *measure);
PetscErrorCode MeshSizesWrite(Mesh, const PetscReal *size, const PetscReal *tool, const char *file);
