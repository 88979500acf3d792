/* The reader of the accuracy that a scene asks for, for scene.c only. SceneReadAccuracy() is called after probes and
   output have been read: it finds the probe, and has the errors of the probes estimated. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadAccuracy(Scene);
