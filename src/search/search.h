/* Who may touch whom: for the slave points of this rank, the master facets near them, from whatever rank, with what is
   needed to follow their nodes. Knows no gaps beyond the distance of candidates, no penalty.

   SearchLists() is called with the positions of the moment; the lists then stand still while the positions move
   (NeighbourListsUpdate()). Search goes in two stages: boxes of the ranks' slave nodes against boxes of facets to find
   the ranks, then a tree over the facets that arrived. There is no patch size to choose: the reach is two face sizes
   plus the largest motion asked for. */
#pragma once
#include "search/neighbourlists.h"
#include "bodies/loads.h"
#include "search/slavepoints.h"

/* How a master surface is fitted. */
typedef struct {
  PetscBool         fitted;   /* lists come with fits; PETSC_FALSE: the facets serve and nothing below is asked for */
  int               degree;   /* 2 or 4 */
  PetscBool         integral; /* through the quadrature points of the faces, weighted by area, instead of the nodes */
  double            support;  /* in spacings of the master's nodes */
  double            exponent; /* of the weight */
  FitDerivativeKind derivatives;
  PetscBool         global_frame;  /* one reference plane for all slave points */
  PetscReal         feature_angle; /* radians: lists end at sharper edges */
} FitSettings;

/* master NULL: an analytic one, which needs no lists. slaves NULL: the surface is to be looked at by itself (offset.h).
 * offset: of the master's quadrature points (integral fits), [faces][FACE_RULE_POINTS*dim], or NULL; maps: these points
 * as combinations of nodes instead, or NULL; what stands there when lists are made is taken. All are borrowed.
 * Collective. */
PetscErrorCode SearchCreate(Mesh, Scene, Loads, ContactSurface master, PetscReal slave_size, int n_images,
                            const SurfaceImage *, const FitSettings *, SlavePoints slaves, const PetscReal *offset,
                            const FaceMaps *maps, ContactSearch *);
PetscErrorCode SearchDestroy(ContactSearch *);
/* New lists for local displacements u at load parameter t, good for a relative motion of `motion`. Collective. */
PetscErrorCode SearchLists(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, NeighbourLists *);
/* The signed distance of any point to the whole master without its mirror images, by every rank looking at its own
 * facets. Collective. */
PetscErrorCode SearchDistance(ContactSearch, const PetscReal *u, PetscReal t, const PetscReal x[3], PetscReal *gap);
