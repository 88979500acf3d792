/* The reader of the key `mesh` of a scene, for scene.c only: SceneReadMesh() is called first of all parts, and
   SceneMeshDestroy() frees what it has read. SceneReadPairs() and ScenePairsDestroy() are for any map of keys that are
   not in the schema. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadMesh(Scene);
PetscErrorCode SceneMeshDestroy(Scene);
PetscErrorCode SceneReadPairs(Scene, const char *key, int *n, ScenePair **pairs);
PetscErrorCode ScenePairsDestroy(int n, ScenePair **pairs);
