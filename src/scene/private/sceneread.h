/* Functions that the readers of a scene share. They address a value by the path of a part of the scene ("contact.0")
   and a key below it.

   SceneNode(), SceneHas(), SceneReals(), SceneReadText(), SceneReadPairs() and SceneReadValue() give the value.
   ScenePairsDestroy() frees pairs. SceneFilePath() makes the path of a file. SceneReadFactors() and
   SceneReadHistory() give factors over the load parameter. SceneFindBody() finds a body by its name. SceneRefuse()
   refuses a value, SceneRefuseRigid() a surface of a rigid tool. ScenePath() makes the path of a list's entry. scene.c
   reads the whole scene with these functions, and the files of its parts use them. No file outside this folder needs
   this header. */
#pragma once
#include "base/petsccompat.h"
#include "scene/scene.h"
#include "schema.h"

Document        *SceneDocument(Scene);
Node             SceneNode(Scene, const char *path, const char *key);
int              SceneHas(Scene, const char *path, const char *key);
int              SceneReals(Scene, const char *path, const char *key, double *);
PetscErrorCode   SceneReadText(Scene, const char *path, const char *key, char **);
PetscErrorCode   SceneReadValue(Scene, const char *path, const char *key, double *value, Expression *);
PetscErrorCode   SceneReadFactors(Scene, const char *path, const char *key, History *);
PetscErrorCode   SceneReadPairs(Scene, const char *key, int *n, ScenePair **);
PetscErrorCode   ScenePairsDestroy(int n, ScenePair **);
PetscErrorCode   SceneReadHistory(Scene, const char *path, History *);
PetscBool        SceneFilePath(Scene, const char *file, char *path, size_t size);
PetscErrorCode   ScenePath(char **path, const char *list, int i);
const SceneBody *SceneFindBody(Scene, const char *name, int rigid);
PetscErrorCode   SceneRefuse(Scene, const char *path, const char *key, const char *what, const char *about);
PetscErrorCode   SceneRefuseRigid(Scene, const char *path, const char *key, const char *surface);
