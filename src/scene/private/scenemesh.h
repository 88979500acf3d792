/* The reader of the key `mesh` of a scene, for scene.c only: SceneReadMesh() is called first of all parts, and
   SceneMeshDestroy() frees what it has read. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadMesh(Scene);
PetscErrorCode SceneMeshDestroy(Scene);
