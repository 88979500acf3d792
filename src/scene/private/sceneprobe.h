/* The reader of the probes of a scene, for scene.c only. SceneReadProbes() is called after the bodies and the contact
   pairs have been read, because a probe may name one of them. It fills scene->probes and refuses the first mistake. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadProbes(Scene);
