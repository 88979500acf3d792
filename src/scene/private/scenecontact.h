/* The reader of contact pairs, for scene.c only. */
#pragma once
#include "scene/scene.h"

PetscErrorCode SceneReadContacts(Scene);
PetscErrorCode SceneDestroyContact(SceneContact *);
PetscErrorCode SceneDestroyContacts(Scene);
