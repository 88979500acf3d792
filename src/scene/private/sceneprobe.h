/* The reader of the probes of a scene. SceneReadProbes() comes after the bodies and the contact pairs have been read,
   as a probe may name one of them. For scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadProbes(Scene);
