/* The reader of the material of a body, for scene.c only. SceneReadMaterial() fills body->material and refuses the
   first mistake; it is called after kinematics has been read. SceneCheckIncompressible() also needs the formulation. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadMaterial(Scene, SceneBody *);
PetscErrorCode SceneCheckIncompressible(Scene, const SceneBody *);
