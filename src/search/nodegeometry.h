/* Geometry of the master surface at its nodes in the present position, as a fit needs it: normals, spacing and its
   anisotropy, weights.

   SurfaceNodeGeometry() computes it for the nodes near the other side when lists are made. SurfaceMeanNormal() gives the normal of one
   reference plane for the whole surface. SurfaceNodesPerFace() relates the area of a face to the area per node. */
#pragma once
#include "bodies/loads.h"
#include "search/surface.h"

typedef struct {
  PetscReal normal[3];     /* unit, area-weighted mean of the normals of the faces */
  PetscReal covariance[6]; /* xx yy zz xy yz xz of the one-ring, averaged over the ring's nodes (length^2) */
  PetscReal spacing;       /* sqrt(area per node), a length; in 2D the length per node */
  /* Multiplier of the node's weight in a fit: 1 on first-order faces, else its reference tributary area over the
     mean. */
  PetscReal weight;
} NodeGeometry;

PetscReal      SurfaceNodesPerFace(ElementType);
PetscErrorCode SurfaceNodeGeometry(ContactSurface, Geometry, Loads, const PetscReal *u, PetscReal t,
                                   const PetscBool *some, NodeGeometry *nodes);
PetscErrorCode SurfaceMeanNormal(ContactSurface, Loads, int n_images, const SurfaceImage *, const PetscReal *u,
                                 PetscReal t, PetscReal normal[3], PetscReal *cosine);
