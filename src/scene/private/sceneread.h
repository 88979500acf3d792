/* What the readers of a scene share: values of the document by the path of a scene's part ("contact.0") and a key below
   it, and refusals of such a value. scene.c reads the whole scene with them, sceneprobe.c the probes; nothing else
   needs this header. */
#pragma once
#include "base/petsccompat.h"
#include "scene/scene.h"
#include "schema.h"

Document        *SceneDocument(Scene);
Node             SceneNode(Scene, const char *path, const char *key); /* NULL: the document has none */
int              SceneHas(Scene, const char *path, const char *key);
int              SceneReals(Scene, const char *path, const char *key,
                            double *); /* a list's numbers; returns how many, 0 if absent */
PetscErrorCode   SceneReadText(Scene, const char *path, const char *key, char **); /* a copy, or NULL */
PetscErrorCode   ScenePath(char **path, const char *list, int i);                  /* "list.i" */
const SceneBody *SceneFindBody(Scene, const char *name, int rigid);                /* NULL: none */
PetscErrorCode   SceneRefuse(Scene, const char *path, const char *key, const char *what, const char *about);
