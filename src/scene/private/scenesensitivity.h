/* The reader of the sensitivities that a scene asks for, for scene.c only. SceneReadSensitivities() is called after the
   probes have been read. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadSensitivities(Scene);
PetscErrorCode SceneDestroySensitivities(Scene);
