/* The reader of the material of a body, for scene.c only. It fills body->material and refuses the first mistake. It is
   called after kinematics and the body's formulation have been read. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadMaterial(Scene, SceneBody *);
