/* Quality of a mesh. MeshReport() prints bodies, surfaces, rigid tools and the partition, for -check and for the first
   lines of a run. MeshCheckQuality() refuses inverted cells, and MeshCheckFormulations() refuses cells for which their
   body's formulation has no kernel. Call both checks before anything is computed on the mesh. */
#pragma once
#include "mesh/meshdata.h"
#include <stdio.h>

PetscErrorCode MeshReport(Mesh, Scene, FILE *);
PetscErrorCode MeshCheckQuality(Mesh, Scene);
PetscErrorCode MeshCheckFormulations(Mesh, Scene);
