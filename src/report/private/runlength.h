/* Runs that get long: many steps or large results, why, and what to change. The progress says it as soon as it is
   known, and the last screen as advice. */
#pragma once
#include "scene/scene.h"

enum { RUN_LENGTH_TEXT = 400 /* characters of a line */ };

int       RunStepsAreMany(Scene, PetscInt steps, PetscInt failed, char *text);
int       RunResultsAreLarge(Scene, PetscReal bytes, PetscReal t, char *text);
PetscReal RunResultsBytes(const char *directory);
