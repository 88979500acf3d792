/* Internals that the files of the search share and nobody else sees: faces on their way between ranks, candidates,
   growing lists, fits that are being made.

   SearchFieldCreate() (searchfield.c) collects faces with nearbox.c and faceexchange.c, makes candidates with
   candidate.c and numbers nodes and points with neighbourlists.c. FitSupportCreate() (fitsupport.c) then prepares the
   fits, and FitSupportSlave() makes one for each slave point. Offsets and the misses of a master's nodes use
   MasterFitsCreate() and FitSupportClimb() for fits of the surface itself. */
#pragma once
#include "base/boxtree.h"
#include "boundingbox.h"
#include "cornernormals.h"
#include "facerows.h"
#include "smooth/facethull.h"
#include "search/search.h"

/* A node whose distance to a plane of symmetry is below this fraction of the model's size lies on it and has no
   image. */
#define SEARCH_ON_PLANE 1e-9

/* Cosine between the slave's reversed normal and the master's one up to which they do not oppose each other: 87
   degrees. */
#define SEARCH_OPPOSED_NOT 0.05

/* Entries of a face's lever: change of a unit normal for each length by which nodes part, for the square of that
   length, and change of a point for the length. */
enum { LEVER_NORMAL, LEVER_SQUARE, LEVER_POINT, LEVERS };

/* Which slave points may have a partner, and the state of the test that says so (partners.c). */
typedef struct {
  PetscBool *possible, any;            /* of each slave point, NULL before the first test; of any one on any rank */
  PetscBool  learns;                   /* the next lists say which points may have one; until then all may */
  PetscReal *x, *normal, *face_normal; /* of slave points and master faces */
  PetscReal  thin;                     /* thinnest element or largest face, whichever is less (length) */
  PetscReal *u, motion; /* of the mesh's nodes (length); motion for which lists were to be good (length) */
  /* Displacements of the slave points' nodes (length); how far points and normals of a face move at most for each
     length by which its nodes part, of the slave's faces and then of the master's. NULL: points are nodes. */
  PetscReal *slave_u, *lever;
  PetscReal  most_lever[LEVERS]; /* the largest of all levers on this rank */
} Partners;

/* From where the bodies came to the state of a search, and how they have moved since (way.c). */
typedef struct {
  const PetscReal *u; /* of the mesh's nodes, before; NULL: nothing is known */
  PetscReal        t, size, ahead; /* load parameter before; largest displacement since (length); times what follows */
  PetscBool        known; /* the way ahead follows from it */
  PetscReal       *way;    /* displacement of each slave point since (length), while lists are made */
  PetscReal        motion; /* for which these must be good (length) */
  PetscReal        aside;  /* by how much prescribed displacements leave the way (length) */
} SearchBefore;

struct _n_ContactSearch {
  Mesh                mesh;
  Scene               scene;
  Loads               loads;
  ContactSurface      slave, master;
  int                 n_images;
  const SurfaceImage *images;
  const FitSettings  *fit;
  SlavePoints         slaves;
  const PetscReal    *offset; /* of the quadrature points of this rank's master faces, where fits use these points */
  const FaceMaps     *maps;   /* or these points as combinations of nodes */
  const MeshTool     *tool;   /* the master, where its motion has free components; else NULL */
  const int          *first_rung; /* of each slave point, with which its fit begins; NULL: RUNG_PLAIN */
  const PetscReal    *kept;       /* 3 for each slave point: normal of the frame that its fit keeps, 0 for none; NULL */
  PetscBool           keeps_faces;   /* lists keep all faces, not only those of each slave point */
  PetscBool           listed;        /* any side of the bodies may meet any other one */
  PetscBool           one_body;      /* slave and master have faces of one body */
  const FaceMarks    *marks;         /* of each slave point, where other pairs treat some of its partners; else NULL */
  PetscReal           reach, margin; /* lengths, without the motion */
  PetscReal           fit_reach;     /* SearchFitReach() */
  PetscReal          *rigid_x;       /* of a tool's nodes (length), while faces are collected; else NULL */
  char               *rigid_known;   /* of each of them: its position has been asked for */
  PetscBool           holds;         /* between SearchStateBegin() and SearchStateEnd() */
  int                 n_blocks_held; /* blocks that have been placed since, of slave and master */
  FaceBlocks          blocks_held[2];
  PetscInt            room, points_room; /* of the facets and points of the last lists */
  Partners            partners;
  SearchBefore        before;
  NeighbourLists spare; /* lists that were given back, of which only what belongs to slave points is left, or NULL */
};

/* A face or a mirror image of it, in the present position. */
typedef struct {
  PetscInt  record;
  int       image;
  PetscInt  piece;        /* of the mesh */
  Facet     facet;        /* nodes: contact nodes until the points are numbered, then points */
  PetscInt  first, count; /* fit points of its quadrature rule */
  PetscReal centre[3], normal[3], lower[3], upper[3];
  PetscReal way_lower[3], way_upper[3]; /* least and largest displacement of its nodes before, see SearchBefore */
  FacetHull hull; /* set where any side of the bodies may meet any other one */
} Candidate;

/* The master's faces that a rank holds temporarily, with their mirror images. */
typedef struct {
  PetscInt    n_records, n_candidates;
  FaceRecord *records;
  FaceMaps    maps; /* of the records' quadrature points, or empty */
  Candidate  *candidates;
} SearchField;

/* A facet at one of its corners */
typedef struct {
  int      candidate;
  PetscInt next; /* entry of the same corner; -1: none */
} FacetAt;

/* Some facets by their corners */
typedef struct {
  PetscInt  sorted; /* how often facets have been sorted */
  PetscInt *latest; /* of every point of the lists: when a facet had a corner there last; 0: never */
  PetscInt *first;  /* of every point: its first entry then */
  PetscInt  n;
  FacetAt  *entry; /* room for the corners of all candidates */
} FacetsAt;

/* Search for the nearest facet of one slave point. */
typedef struct {
  NeighbourLists   lists;
  SlavePoints      slaves;
  const Candidate *candidates;
  CornerNormals    corners;            /* of the candidates; NULL: their surface is not smoothed */
  PetscReal        x[3], size, height; /* of the slave's face, and of the element below it (length) */
  PetscReal        outward[3];         /* unit normal out of the slave's body; 0 where it has none */
  PetscBool        listed, one_body;   /* as in the search */
  PetscBool        two_sided;          /* the master is a slave of this surface too */
  PetscReal        sharp;              /* facets that differ by more meet at a sharp edge (radians) */
  /* The slave point, and the number of nodes of its own face: a face with one of these nodes is not its master. */
  PetscInt  q, own;
  FaceMarks marks; /* of the slave point */
  PetscInt  best;
  PetscReal distance; /* of the best */
  /* Distance (length) of the nearest candidate of all, or the largest one that is searched. Distances that differ by
     less than tie are equal. */
  PetscReal least, tie;
  Foot      foot;      /* on the best candidate */
  PetscReal normal[3]; /* of the master there: where there are fits, one that does not jump from facet to facet */
  BoxTreeWay way;      /* how it moves against candidates */
  PetscBool averse;    /* a candidate within a face of the slave does not face the point */
  FacetsAt *at;        /* those at which a flank may end */
} Nearest;

/* Growing lists of all slave points. */
typedef struct {
  PetscInt   n, room;
  Facet     *facet;
  PetscReal *size;
  PetscInt   n_points, points_room, *point;
  PetscInt  *position; /* of every point in the list of the present slave point; older entries are below its start */
} ListBuffer;

/* Where a fit is made: at the slave point's foot on the facets, or at a point of the surface itself. */
typedef struct {
  PetscInt  facet; /* number of the candidate */
  double    xi[2];
  PetscReal X[3], u[3];          /* origin of the fit: their sum (length) */
  PetscReal foot[3], outward[3]; /* centre of the support (length), and outward direction */
  PetscBool upright;             /* the frame's normal is `outward`, not that of the points' plane */
  PetscBool past;                /* the foot is past a free edge of the surface */
} FitFoot;

/* The data for making the fits of a pair's slave points. */
typedef struct {
  ContactSearch  s;
  NeighbourLists lists;
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  FaceRows       rows; /* NULL in 2D and for a single reference plane */
  CornerNormals  corners;
  PetscReal     *normals, *reference;
  NodeGeometry  *geometry;
  PetscInt      *points; /* of the present slave point, with room for FIT_MAX_POINTS */
  /* taper: weights for the frame, which vanish where the list ends. */
  double   *x, *multiplier, *taper, *hoop, *workspace;
  int      *used;
  PetscReal plane[3]; /* normal of the single reference plane of a global frame */
} FitSupport;

/* Fits that are made at this rank's own faces of the master. The lists have no slave points. */
typedef struct {
  NeighbourLists lists;
  SearchField    field;
  FitSupport     fit;
} MasterFits;

/* candidate.c */
void           CandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *);
void           CandidateHull(int dim, const PetscReal *x, Candidate *);
PetscReal      CandidateBulge(const Candidate *, PetscReal size);
PetscReal      CandidateBoxDistance(int dim, const Candidate *, const PetscReal *x);
PetscErrorCode CandidatesTree(int dim, PetscInt n, const Candidate *, PetscBool facing, PetscBool moved, BoxTree *);
PetscErrorCode ListBufferAddPoint(ListBuffer *, PetscInt first, PetscInt point);
PetscErrorCode ListBufferAddPoints(ListBuffer *, PetscInt first, PetscInt n, const PetscInt *points);
/* searchbox.c */
void SearchSlaveBox(ContactSearch, PetscReal box[6]);
void SearchMasterBox(ContactSearch, const PetscReal *u, PetscReal t, const PetscBool *some, PetscReal box[6]);
void SearchFacePositions(ContactSearch, ContactSurface, PetscInt f, const PetscReal *u, PetscReal t, PetscReal *x);
void SearchFaceBox(int dim, int n, const PetscReal *x, const SurfaceImage *, PetscReal box[6]);
void SearchRigidPlace(ContactSearch, PetscInt n, PetscReal X[3]);
void SearchRigidPosition(ContactSearch, PetscInt n, PetscReal t, PetscReal x[3]);
/* faceexchange.c */
PetscErrorCode SearchExchangeFaces(ContactSearch, const NodeGeometry *, const PetscReal *u, const PetscReal *boxes,
                                   PetscReal distance, PetscInt *n, FaceRecord **);
PetscErrorCode SearchPickRigidFaces(ContactSearch, const NodeGeometry *, PetscReal t, const PetscReal box[6],
                                    PetscReal distance, PetscInt *n, FaceRecord **);
/* nearbox.c */
PetscErrorCode SearchStateBegin(ContactSearch);
PetscErrorCode SearchStateEnd(ContactSearch);
PetscErrorCode SearchBlocks(ContactSearch, ContactSurface, const PetscReal *u, FaceBlocks *);
PetscErrorCode SearchNearBox(ContactSearch, ContactSurface, const PetscReal *u, PetscReal t, const PetscReal box[6],
                             PetscReal distance, PetscInt *n, PetscInt **faces);
/* neighbourlists.c */
PetscErrorCode NeighbourListsCreateNodes(ContactSearch, SearchField *, NeighbourLists);
PetscErrorCode NeighbourListsCreatePoints(ContactSearch, PetscReal t, NeighbourLists, SearchField *);
PetscErrorCode NeighbourListsChoosePoints(ContactSearch, NeighbourLists);
PetscErrorCode NeighbourListsCreateSlaves(ContactSearch, NeighbourLists);
PetscErrorCode NeighbourListsFreeSpare(ContactSearch);
void           NeighbourListsPointGeometry(ContactSearch, NeighbourLists, const SearchField *, NodeGeometry *of_nodes,
                                           NodeGeometry *of_points);
PetscErrorCode NeighbourListsUpdateNodes(ContactSearch, NeighbourLists, const PetscReal *u, PetscReal t);
void           NeighbourListsCentre(NeighbourLists, PetscInt q, PetscReal centre[2]);
/* partners.c */
PetscBool      SearchHasPartners(ContactSearch);
PetscBool      SearchTestsPartners(ContactSearch);
PetscErrorCode SearchPartners(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal *normals);
PetscErrorCode SearchPartnersFaces(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *faces);
PetscErrorCode SearchPartnersLearn(ContactSearch, NeighbourLists, const SearchField *, BoxTree);
PetscErrorCode SearchPartnersFree(ContactSearch);
/* fitsupport.c */
PetscReal      SearchFitReach(ContactSearch);
PetscErrorCode FitSupportCreate(ContactSearch, NeighbourLists, const SearchField *, FitSupport *);
PetscErrorCode FitSupportDestroy(FitSupport *);
PetscErrorCode FitSupportSlave(FitSupport *, const Nearest *, PetscInt q, int ends, PetscInt first, ListBuffer *);
PetscErrorCode FitSupportLift(FitSupport *, const Nearest *, PetscInt q);
PetscErrorCode FitSupportClimb(FitSupport *, const FitFoot *, int first, FitProblem *, FitResult *, int *rung);
/* searchfield.c */
PetscReal        SearchListsDistance(ContactSearch, PetscReal motion);
PetscErrorCode   SearchFieldCreate(ContactSearch, const PetscReal *u, PetscReal t, const PetscReal box[6],
                                   PetscReal distance, PetscBool fits, NeighbourLists, SearchField *);
PetscErrorCode   SearchFieldDestroy(SearchField *);
const Candidate *SearchFieldOwn(const SearchField *, const Facet *);
PetscErrorCode   SearchFieldWay(ContactSearch, const SearchField *, PetscSF *faces);
/* masterfits.c */
PetscErrorCode MasterFitsCreate(ContactSearch, const PetscReal *u, PetscReal t, const PetscBool *some, MasterFits *);
PetscErrorCode MasterFitsDestroy(MasterFits *);
