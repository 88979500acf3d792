/* Units of what a run writes, in the words of the scene's key units, or as length, force and stress without it.

   UnitsNamed() tells whether there is that key. UnitsLength(), UnitsForce() and UnitsStress() give the units
   themselves, UnitsProbe() gives the unit of a probe's value, UnitsForces() what forces of the results are meant of:
   the whole model, a unit of thickness, 360 degrees. */
#pragma once
#include "scene/scene.h"

enum { UNITS_TEXT = 200 };

PetscBool   UnitsNamed(Scene);
const char *UnitsLength(Scene);
const char *UnitsForce(Scene);

void UnitsStress(Scene, char text[UNITS_TEXT]);
void UnitsProbe(Scene, const SceneProbe *, char text[UNITS_TEXT]);
void UnitsForces(Scene, char text[UNITS_TEXT]);
