/* Sizes of the elements of rigid tools in a view of gmsh: no cell of a body lies at a tool, and gmsh knows no size
   where no cell of the view is. */
#pragma once
#include "mesh/meshdata.h"
#include <stdio.h>

void ToolSizesWrite(Mesh, const PetscReal *wanted, FILE *);
