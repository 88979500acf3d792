/* The parameters of a scene's .geo that refine its mesh, with their present values: those that the scene names, or else
   those that the .geo declares (accuracy.densities in the scene reference). MeshDensitiesFind() finds them,
   MeshDensityText() gives the value that makes elements smaller by a factor. */
#pragma once
#include "scene/scene.h"

enum { MESH_DENSITY_TEXT = 160 };

typedef struct {
  char        name[128];
  PetscReal   value;
  DensityKind kind;
} MeshDensity;

PetscErrorCode MeshDensitiesFind(MPI_Comm, Scene, PetscBool trust, int *n, MeshDensity **, PetscBool *structured);
void           MeshDensityText(const MeshDensity *, PetscReal factor, char text[MESH_DENSITY_TEXT]);
