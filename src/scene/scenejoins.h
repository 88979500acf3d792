/* Surfaces of one list that are joined: sides of a sharp edge of one body, which the mesh shows and the scene does not.
   The pairs of the list, read one for each two surfaces, become those of the joined surfaces.

   SceneListedTogether() says whether a list has two surfaces meet one slave, so that they must be joined if they are
   sides of an edge. SceneJointName() names surfaces that are joined, SceneJoinSurfaces() joins them.
   SceneMayBeJoint() says whether a name can become that of a pair. */
#pragma once
#include "scene/scene.h"

PetscBool      SceneListedTogether(Scene, const char *path, const char *a, const char *b);
PetscErrorCode SceneJointName(Scene, const char *path, int n, char *parts[], char **name);
PetscErrorCode SceneJoinSurfaces(Scene, const char *path, int n, const char *const parts[], const char *joint);
PetscBool      SceneMayBeJoint(Scene, const char *name);
