/* The readers of supports and loads, for scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadSupports(Scene);
PetscErrorCode SceneReadLoads(Scene);
