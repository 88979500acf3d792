/* The readers of a body's yield stress and hardening, and the check of a user's routine, for scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadPlasticity(Scene, SceneBody *);
PetscErrorCode SceneCheckRoutine(Scene, const SceneBody *);
