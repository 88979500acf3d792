/* The reader of the motions of tools, for scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadMotion(Scene, const char *tool, Motion *);
PetscErrorCode SceneReadPretension(Scene, SceneBody *);
PetscErrorCode SceneDestroyMotion(Motion *);
