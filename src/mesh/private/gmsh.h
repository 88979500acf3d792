/* gmsh runs on a .geo file once for each content of the file, parameters and gmsh version. The mesh file has a name
   from the hash of these. One rank calls GmshGenerate(), and all ranks then read the file. */
#pragma once
#include "base/complaint.h"
#include "scene/scene.h"

PetscErrorCode GmshGenerate(Scene, const char *directory, PetscBool trust, char *file, PetscReal *seconds, Complaint *);
