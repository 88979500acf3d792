/* Points along the convex edges of a rigid tool that are sharper than a right angle, its ridges, and on right-angled
   ones where SurfaceFollowsEdges(). Contact is measured at points of the slave, and no such point sees an edge of
   the tool that stands between them: the edge sinks in until points behind it are pressed out along its sides. So
   these points take part as slave points of a pair of their own, whose master is the slave of the tool's pair. They
   have no unknowns: the motion of the tool is theirs.

   RidgeSurfaceCreate() makes a surface that has these points in the place of faces. In the plane they are the tool's
   nodes on such edges, in space they lie along the edges, not farther apart than half a face of what they press on. */
#pragma once
#include "search/surface.h"

PetscErrorCode RidgeSurfaceCreate(ContactSurface tool, ContactSurface other, Geometry, int n_images,
                                  const SurfaceImage *, ContactSurface *);
