/* Where the faces of a slave surface end: edges (in 2D ends) at which the surface ends, and sharp edges at which it
   turns away from what it may meet.

   SurfaceEdgeFrame() gives normal and way out at an edge. SurfaceFindEnds() marks these edges in the surface's
   face_ends. SurfaceRule() gives the quadrature rule of a face: with ends, its outer points lie on its edges. */
#pragma once
#include "search/facequadrature.h"
#include "search/surface.h"

/* Edges at which the surface turns by at least this angle are right-angled or sharper: what meshes round off is less
   (radians). */
#define SURFACE_SQUARE (80 * PETSC_PI / 180)

void            SurfaceEdgeFrame(ContactSurface, const Facet *, int edge, PetscReal normal[3], PetscReal out[3]);
PetscBool       SurfaceFollowsEdges(Mesh, Geometry);
PetscErrorCode  SurfaceEdgeLengths(ContactSurface, PetscReal angle, int n_images, const SurfaceImage *,
                                   PetscReal *length, PetscInt *n);
PetscErrorCode  SurfaceFindEnds(ContactSurface, PetscReal angle, int n_images, const SurfaceImage *);
const FaceRule *SurfaceRule(ContactSurface, PetscInt face, int finer);
