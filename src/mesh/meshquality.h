/* What a mesh looks like: the report on bodies, surfaces and partition, and the refusal of inverted cells and of those
 * that a formulation is not for. */
#pragma once
#include "mesh/meshdata.h"
#include <stdio.h>

/* A table of bodies (cells, nodes, volume, quality), surfaces and rigid tools, for -check and the first lines of a run.
 * Collective. */
PetscErrorCode MeshReport(Mesh, Scene, FILE *);
/* Refuses inverted elements (cell tag, body, smallest determinant). Collective. */
PetscErrorCode MeshCheckQuality(Mesh, Scene);
/* Refuses elements that their body's formulation has no kernel for (cell tag, body, element). Collective. */
PetscErrorCode MeshCheckFormulations(Mesh, Scene);
