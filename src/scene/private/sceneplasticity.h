/* The reader of a body's yield stress and hardening, for scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadPlasticity(Scene, SceneBody *);
