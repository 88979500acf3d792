/* What the files of the search share and nobody else sees: faces on their way between ranks, candidates, growing lists,
 * fits in the making. */
#pragma once
#include "neighbourhood.h"
#include "search/search.h"

/* A node this close to a plane of symmetry, as a fraction of the model's size, is on it and has no image. */
#define SEARCH_ON_PLANE 1e-9

struct _n_ContactSearch {
  Mesh                mesh;
  Scene               scene;
  Loads               loads;
  ContactSurface      slave, master;
  int                 n_images;
  const SurfaceImage *images;
  const FitSettings  *fit;
  SlavePoints         slaves;
  const PetscReal    *offset; /* of the quadrature points of this rank's master faces, where fits go through these */
  const FaceMaps     *maps;   /* or what these are made of */
  PetscReal           reach, margin; /* lengths, without the motion */
};

/* A face or a mirror image of it, in the current position. */
typedef struct {
  PetscInt  record;
  int       image;
  Facet     facet; /* nodes: contact nodes until the points are numbered, then points */
  PetscInt  first; /* fit point of its quadrature rule */
  PetscReal centre[3], normal[3], lower[3], upper[3];
} Candidate;

/* The master's faces that a rank holds for a while, with their mirror images */
typedef struct {
  PetscInt    n_records, n_candidates;
  FaceRecord *records;
  FaceMaps    maps; /* of the records' quadrature points, or empty */
  Candidate  *candidates;
} SearchField;

/* One slave point looking for its nearest facet. */
typedef struct {
  NeighbourLists   lists;
  const Candidate *candidates;
  PetscReal        x[3], normal[3];
  PetscInt         q,
    own; /* the slave point, and of how many nodes its own face is: a face with one of these is not its master */
  PetscInt  best;
  PetscReal distance; /* of the best */
  PetscReal least,
    tie;     /* of all, or as far as is looked; distances (lengths) that differ by less than the tie are equal */
  Foot foot; /* on the best */
} Nearest;

/* Lists of all slave points, growing. */
typedef struct {
  PetscInt   n, room;
  Facet     *facet;
  PetscReal *size;
  PetscInt   n_points, points_room, *point;
  PetscInt  *position; /* of every point in the present slave point's list; older entries are below its start */
} ListBuffer;

/* Where a fit is wanted: at the slave point's foot on the facets, or at a point of the surface itself */
typedef struct {
  PetscInt  facet; /* candidate */
  double    xi[2];
  PetscReal X[3], u[3];          /* origin of the fit: their sum */
  PetscReal foot[3], outward[3]; /* centre of the support; direction */
  PetscBool upright;             /* the frame's normal is `outward`, not that of the points' plane */
} FitFoot;

/* The fits of a pair's slave points in the making. */
typedef struct {
  ContactSearch  s;
  NeighbourLists lists;
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  PetscReal     *normals, *reference;
  NodeGeometry  *geometry;
  PetscInt      *points; /* of the slave point at hand, FIT_MAX_POINTS */
  double        *x, *multiplier, *taper,
    *workspace; /* taper: weights of the frame, which fall to nothing where the list ends */
  int      *used;
  PetscReal plane[3]; /* normal of the one reference plane of a global frame */
} FitSupport;

/* candidate.c */
void           CandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *);
PetscErrorCode ListBufferAddPoint(ListBuffer *, PetscInt first, PetscInt point);
/* faceexchange.c */
void           SearchSlaveBox(ContactSearch, PetscReal box[6]);
void           SearchMasterBox(ContactSearch, const PetscReal *u, PetscReal t, PetscReal box[6]);
PetscBool      SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance);
void           SearchRigidPosition(ContactSearch, PetscInt n, PetscReal t, PetscReal x[3]);
PetscErrorCode SearchExchangeFaces(ContactSearch, const NodeGeometry *, const PetscReal *u, const PetscReal *boxes,
                                   PetscReal distance, PetscInt *n, FaceRecord **);
PetscErrorCode SearchPickRigidFaces(ContactSearch, const NodeGeometry *, PetscReal t, const PetscReal box[6],
                                    PetscReal distance, PetscInt *n, FaceRecord **);
/* neighbourlists.c */
PetscErrorCode NeighbourListsCreateNodes(ContactSearch, SearchField *, NeighbourLists);
PetscErrorCode NeighbourListsCreatePoints(ContactSearch, NeighbourLists, SearchField *);
PetscErrorCode NeighbourListsCreateSlaves(ContactSearch, NeighbourLists);
void           NeighbourListsPointGeometry(ContactSearch, NeighbourLists, const SearchField *, NodeGeometry *of_nodes,
                                           NodeGeometry *of_points);
PetscErrorCode NeighbourListsUpdateNodes(ContactSearch, NeighbourLists, const PetscReal *u, PetscReal t);
void           NeighbourListsCentre(NeighbourLists, PetscInt q, PetscReal centre[2]);
/* fitsupport.c */
PetscReal      SearchFitReach(ContactSearch);
PetscErrorCode FitSupportCreate(ContactSearch, NeighbourLists, const SearchField *, FitSupport *);
PetscErrorCode FitSupportDestroy(FitSupport *);
PetscErrorCode FitSupportSlave(FitSupport *, const Nearest *, PetscInt q, PetscInt first, ListBuffer *);
PetscErrorCode FitSupportClimb(FitSupport *, const FitFoot *, FitProblem *, FitResult *, int *rung);
/* search.c */
/* The faces around a box with nodes, images and points in lists, whose slave points are not yet there. Collective. */
PetscErrorCode SearchFieldCreate(ContactSearch, const PetscReal *u, PetscReal t, const PetscReal box[6],
                                 PetscReal distance, NeighbourLists, SearchField *);
PetscErrorCode SearchFieldDestroy(SearchField *);
