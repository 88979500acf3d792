/* What a mesh looks like: the report on bodies, surfaces and partition, and the refusal of inverted cells. */
#pragma once
#include "meshdata.h"
#include <stdio.h>

/* A table of bodies (cells, nodes, volume, quality), surfaces and rigid tools, for -check and the first lines of a run. Collective. */
PetscErrorCode MeshReport(Mesh, Scene, FILE *);
/* Refuses inverted elements (cell tag, body, smallest determinant). Collective. */
PetscErrorCode MeshCheckQuality(Mesh, Scene);
