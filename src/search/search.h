/* The search for contact partners: for the slave points of this rank it lists the master facets near them, from
   whatever rank, with the data that are needed to follow their nodes. It knows no gaps beyond the distance of
   candidates, and no penalty.

   SearchCreate() holds the parts that do not change in a run. SearchLists() makes new lists at the present positions.
   The lists then stand still while the positions move (NeighbourListsUpdate()). SearchDistance() gives the distance of
   a single point to the master, SearchLeastDistance() that of all slave points.

   The search has two stages. The boxes of the ranks' slave nodes are compared with the boxes of facets to find the
   ranks; then a tree is built over the facets that arrived. There is no patch size to choose: the reach is two face
   sizes plus the motion for which the lists must be good. SearchSetBefore() says from where the bodies came; each facet
   then counts with its own motion against a slave point. */
#pragma once
#include "search/neighbourlists.h"
#include "bodies/loads.h"
#include "bodies/tools.h"
#include "search/slavepoints.h"

/* Where any side of the bodies may meet any other one: part of the element's height below a slave point, and of the
   reference distance to a facet behind it, up to which the point has entered what faces it. A wall has at least one
   element, so its own far side is nearer than that only where it is compressed to a quarter. */
#define SEARCH_ENTERED 0.25

/* How a master surface is fitted. */
typedef struct {
  PetscBool fitted; /* lists come with fits; PETSC_FALSE: the facets are used, and nothing below is read */
  int       degree; /* 2 or 4 */
  /* Fit through the quadrature points of the faces, weighted by area, instead of the nodes. */
  PetscBool integral;
  /* Axisymmetric integral fits see the whole body of revolution: each quadrature point is a ring of points. */
  PetscBool         revolved;
  double            support;  /* in spacings of the master's nodes */
  double            exponent; /* of the weight */
  FitDerivativeKind derivatives;
  PetscBool         global_frame;  /* one reference plane for all slave points */
  PetscReal         feature_angle; /* radians; fits end at edges that are sharper */
  PetscBool         fades;         /* points fade towards another flank, see FlankShare() */
  PetscBool         far;           /* points are fitted that are far away, too: they press there, or are reported */
} FitSettings;

int            FitDegreeCode(const FitSettings *, int degree);
PetscErrorCode SearchCreate(Mesh, Scene, Loads, ContactSurface master, PetscReal slave_size, int n_images,
                            const SurfaceImage *, const FitSettings *, SlavePoints slaves, const PetscReal *offset,
                            const FaceMaps *maps, ContactSearch *);
PetscErrorCode SearchDestroy(ContactSearch *);
void           SearchKeepFaces(ContactSearch);
void           SearchAllSides(ContactSearch, PetscBool one_body);
void           SearchSetTool(ContactSearch, const MeshTool *);
void           SearchSetMarks(ContactSearch, const FaceMarks *);
void           SearchSetRungs(ContactSearch, const int *first);
void           SearchSetBefore(ContactSearch, const PetscReal *u, PetscReal t, PetscReal size, PetscReal aside);
PetscBool      SearchLeavesWay(ContactSearch);
void           SearchSetFrames(ContactSearch, const PetscReal *kept);
PetscErrorCode SearchLists(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, NeighbourLists *);
PetscErrorCode SearchFindsNothing(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *nothing);
PetscErrorCode SearchNearFaces(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *slave,
                               PetscBool *master);
PetscErrorCode SearchLeastDistance(ContactSearch, const PetscReal *u, PetscReal t, PetscReal *distance);
PetscErrorCode SearchMasterMiss(ContactSearch, const PetscReal *u, PetscReal t, PetscReal *miss);
PetscErrorCode SearchDistance(ContactSearch, const PetscReal *u, PetscReal t, const PetscReal x[3], PetscReal *gap);
