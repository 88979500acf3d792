/* What a fit wants to know of the master surface at its nodes, in the position of the moment: normals, spacing and its
 * anisotropy, weights. */
#pragma once
#include "bodies/loads.h"
#include "search/surface.h"

typedef struct {
  PetscReal normal[3];     /* unit, area-weighted mean of the faces' */
  PetscReal covariance[6]; /* xx yy zz xy yz xz of the one-ring, averaged over the ring's nodes */
  PetscReal spacing;       /* sqrt(area per node), a length; in 2D the length per node */
  PetscReal weight; /* multiplier of the node's weight in a fit: 1 on first-order faces, else its reference tributary
                       area over the mean */
} NodeGeometry;

/* Nodes that a face of this type brings to the surface when many tile it: area per node = area of the face over this.
 */
PetscReal SurfaceNodesPerFace(ElementType);
/* Complete on every copy of a node; rigid tools: nodes of the tool at t. Collective. */
PetscErrorCode SurfaceNodeGeometry(ContactSurface, Loads, const PetscReal *u, PetscReal t, NodeGeometry *nodes);
/* Unit mean normal of the whole surface (area-weighted) and, unless NULL, the smallest cosine of a face's normal with
 * it. Collective. */
PetscErrorCode SurfaceMeanNormal(ContactSurface, Loads, int n_images, const SurfaceImage *, const PetscReal *u,
                                 PetscReal t, PetscReal normal[3], PetscReal *cosine);
