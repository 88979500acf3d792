/* What the files of the search share and nobody else sees: faces on their way between ranks, candidates, growing lists, fits in the making. */
#pragma once
#include "neighbourhood.h"
#include "search.h"

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
  PetscInt            n_slaves;
  const PetscInt     *slaves;
  PetscReal           reach, margin; /* lengths, without the motion */
};

/* A master face on its way to a rank that may need it. Plain bytes: ranks of one run have one architecture. */
typedef struct {
  Facet        facet; /* nodes: numbers in id[] order on arrival, later contact nodes */
  PetscReal    size;
  PetscInt     id[FACE_MAX_NODES], owner[FACE_MAX_NODES], local[FACE_MAX_NODES];
  PetscReal    X[FACE_MAX_NODES * 3];
  NodeGeometry geometry[FACE_MAX_NODES]; /* fits only */
} FaceRecord;

/* A face or a mirror image of it, in the current position. */
typedef struct {
  PetscInt  record;
  int       image;
  Facet     facet; /* nodes: contact nodes until the points are numbered, then points */
  PetscReal centre[3], normal[3], lower[3], upper[3];
} Candidate;

/* One slave point looking for its nearest facet. */
typedef struct {
  ContactLists     lists;
  const Candidate *candidates;
  PetscReal        x[3], normal[3];
  PetscInt         node; /* contact node of the slave point: it is not its own master */
  PetscInt         best;
  Foot             foot; /* on the best */
} Nearest;

/* Lists of all slave points, growing. */
typedef struct {
  PetscInt   n, room;
  Facet     *facet;
  PetscReal *size;
  PetscInt   n_points, points_room, *point;
  PetscInt  *position; /* of every point in the present slave point's list; older entries are below its start */
} ListBuffer;

/* The fits of a pair's slave points in the making. */
typedef struct {
  ContactSearch  s;
  ContactLists   lists;
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  PetscReal     *normals, *reference;
  NodeGeometry  *geometry;
  PetscInt      *points;                             /* of the slave point at hand, FIT_MAX_POINTS */
  double        *x, *multiplier, *taper, *workspace; /* taper: weights of the frame, which fall to nothing where the list ends */
  int           *used;
  PetscReal      plane[3]; /* normal of the one reference plane of a global frame */
} Fitting;

/* faceexchange.c */
void           SearchSlaveBox(ContactSearch, const PetscReal *u, PetscReal box[6]);
PetscBool      SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance);
void           SearchRigidPosition(ContactSearch, PetscInt n, PetscReal t, PetscReal x[3]);
PetscErrorCode SearchExchangeFaces(ContactSearch, const NodeGeometry *, const PetscReal *u, const PetscReal *boxes, PetscReal distance, PetscInt *n,
                                   FaceRecord **);
PetscErrorCode SearchPickRigidFaces(ContactSearch, const NodeGeometry *, PetscReal t, const PetscReal box[6], PetscReal distance, PetscInt *n, FaceRecord **);
/* lists.c */
PetscErrorCode ListsCreateNodes(ContactSearch, PetscInt n_records, FaceRecord *, ContactLists);
PetscErrorCode ListsCreatePoints(ContactSearch, ContactLists, PetscInt n_candidates, Candidate *);
PetscErrorCode ListsCreateSlaves(ContactSearch, ContactLists);
void           ListsPointGeometry(ContactSearch, ContactLists, PetscInt n_records, const FaceRecord *, NodeGeometry *of_nodes, NodeGeometry *of_points);
PetscErrorCode ListsUpdateNodes(ContactSearch, ContactLists, const PetscReal *u, PetscReal t);
void           ListsSlaveMap(const ContactLists, PetscInt q, const PetscReal *x, PetscReal *y);
/* fitting.c */
PetscReal      SearchFitReach(ContactSearch);
PetscErrorCode FittingCreate(ContactSearch, ContactLists, PetscInt n_records, const FaceRecord *, PetscInt n, const Candidate *, Fitting *);
PetscErrorCode FittingDestroy(Fitting *);
PetscErrorCode FittingSlave(Fitting *, const Nearest *, PetscInt q, PetscInt first, ListBuffer *);
/* search.c */
void           SearchCandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *);
PetscErrorCode ListBufferAddPoint(ListBuffer *, PetscInt first, PetscInt point);
