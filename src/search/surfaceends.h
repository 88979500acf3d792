/* Where the faces of a slave surface end: edges (in 2D ends) at which the surface ends, and sharp edges at which it
   turns away from what it may meet.

   SurfaceEdgeFrame() gives normal and way out at an edge. SurfaceFindEnds() marks these edges in the surface's
   face_ends. SurfaceRule() gives the quadrature rule of a face: with ends, its outer points lie on its edges. */
#pragma once
#include "search/facequadrature.h"
#include "search/surface.h"

void            SurfaceEdgeFrame(ContactSurface, const Facet *, int edge, PetscReal normal[3], PetscReal out[3]);
PetscErrorCode  SurfaceFindEnds(ContactSurface, PetscReal angle, int n_images, const SurfaceImage *);
const FaceRule *SurfaceRule(ContactSurface, PetscInt face, int finer);
