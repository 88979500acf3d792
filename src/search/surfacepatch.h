/* A round patch of a contact surface: a point at the distance r from its middle counts (1 - (r / radius)^2)^2, and none
   beyond the radius. SurfacePatchAreas() integrates that over the faces: at the nodes alone it would say little of a
   patch of a few faces. */
#pragma once
#include "search/surface.h"

PetscErrorCode SurfacePatchAreas(ContactSurface, Geometry, PetscBool hats, const PetscReal middle[3], PetscReal radius,
                                 PetscReal *area);
