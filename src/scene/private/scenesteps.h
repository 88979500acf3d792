/* Steps with names, and what acts during some of them.

   SceneReadSteps() reads stepping.steps and puts a history in the place of each `during` of the document, before
   anything reads histories. The text of the scene has these histories from then on. Supports that prescribe
   displacements keep their `during`, which SceneReadSpan() reads. */
#pragma once
#include "sceneread.h"

PetscErrorCode SceneReadSteps(Scene);
PetscErrorCode SceneReadSpan(Scene, const char *path, SceneSpan *);
PetscErrorCode SceneDestroySteps(Scene);
