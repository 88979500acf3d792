/* Running gmsh on a .geo file: once for each content, parameters and gmsh version, into a file named by their hash. One
 * rank does it. */
#pragma once
#include "base/complaint.h"
#include "scene/scene.h"

/* Makes the scene's .msh from its .geo, or finds the one made before. file has room for PETSC_MAX_PATH_LEN. Not
 * collective. */
PetscErrorCode GmshGenerate(Scene, const char *directory, char *file, PetscReal *seconds, Complaint *);
