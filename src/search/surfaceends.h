/* Where the faces of a slave surface end: edges (in 2D ends) at which the surface ends, and sharp edges at which it
   turns away from what it may meet.

   SurfaceFindEnds() marks these edges in the surface's face_ends. SurfaceRule() gives the quadrature rule of a face:
   with ends, its outer points lie on its edges. */
#pragma once
#include "search/facequadrature.h"
#include "search/surface.h"

PetscErrorCode  SurfaceFindEnds(ContactSurface, PetscReal angle, int n_images, const SurfaceImage *);
const FaceRule *SurfaceRule(ContactSurface, PetscInt face, int finer);
