/* Mesh files of other programs. scripts/convert_mesh.py turns one into a .msh file that is read here, once for each
   content. One rank calls MeshImport() where MeshImportNeeded() says so, and all ranks then read the file. */
#pragma once
#include "base/complaint.h"
#include "scene/scene.h"

PetscBool      MeshImportNeeded(Scene);
PetscErrorCode MeshImport(Scene, const char *directory, char *file, PetscReal *seconds, Complaint *);
