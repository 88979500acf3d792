/* The lists of a pair: everything that a rank holds of it while the lists stand still. They hold the contact nodes, the
   fit points and slave points that are made of these nodes, and for each slave point the facets and fit points against
   which it is measured.

   SearchLists() (search.h) makes lists, and NeighbourListsDestroy() frees them. NeighbourListsGiveBack() leaves their
   room to the search's next ones. NeighbourListsUpdate() moves the
   positions while the lists stay, and NeighbourListsTakeOffsets() gives the points other offsets.
   NeighbourListsRelative() gives a point as a slave point sees it.
   NeighbourListsBroadcast() and NeighbourListsReduce() take values from the mesh's nodes to the contact nodes and
   back. NeighbourListsSlip() tells how far a slave point has slid since the lists were made, and
   NeighbourListsFitReaches() whether its fit still serves there. NeighbourListsOpposed() tells how well a slave point's
   normal opposes another one. */
#pragma once
#include "smooth/diffusefit.h"
#include "search/surface.h"

typedef struct _n_ContactSearch *ContactSearch; /* in search.h */

/* Lists reach beyond the support of a fit by this part of the support. A slave point may slide so far while the
   lists stand still. */
#define NEIGHBOUR_LISTS_MARGIN 0.3

/* Depth behind the master, in faces of the slave, at which a point past the end of the facets that it faces no longer
   counts as behind them. Penetrations are much smaller. Deeper points hang over a free edge, or are in front of another
   side of the master, which is nearer then. */
#define NEIGHBOUR_LISTS_DEEP 0.25

/* The rung of the ladder of fall-backs on which a slave point's fit was found: fits of decreasing quality, then the
   facets. RUNG_UNASKED: the point is too far away for contact, and no fit was tried. */
enum {
  RUNG_UNASKED   = -2,
  RUNG_FACET     = -1,
  RUNG_PLAIN     = 0,
  RUNG_WIDER     = 4,
  RUNG_QUADRATIC = 5,
  RUNG_DEGREE_2  = 6,
  RUNG_LINEAR    = 7
};
enum { RUNGS = 8 };

/* Contact nodes are the nodes that the terms of the pair touch. Nodes with unknowns come first (leaves of sf, whose
   roots are the local nodes of their owners), then nodes of a rigid tool. Points are what a smoother sees: a fixed
   combination of images of contact nodes, reflected, plus a shift and an offset: x = sign * (sum S (image of
   x_node)) + shift + offset. In fits of revolution it is a point of a ring, turned into the meridian plane: its radius
   is multiplied by the cosine of its angle. */
typedef struct {
  int          dim;
  PetscInt     n_nodes, n_deformable;
  PetscInt     tool;    /* first of the two nodes of a tool with unknowns, the last deformable ones; -1: no such tool */
  PetscInt    *node_id; /* deformable: the mesh's rank-independent id; rigid: node of the tool */
  PetscReal   *X, *u;   /* n_nodes*dim: reference coordinates, and displacement at the last update (length) */
  PetscReal    t;       /* load parameter of the last update, NaN before */
  PetscInt    *dof;     /* n_nodes*dim global dofs; -1 where constrained or rigid */
  PetscSF      sf;
  MPI_Datatype block; /* dim reals */

  PetscInt   n_points; /* fit points */
  PetscInt  *point_ptr, *point_node;
  int       *point_side; /* of each entry: image of the node; nonzero only with live offsets */
  PetscReal *point_S, *point_offset, *point_weight;
  int       *point_image;
  long      *point_key; /* rank-independent: the node or quadrature point, the image, the place on a ring */
  PetscReal *point_cosine, *point_hoop; /* of its angle; distance along the hoop (length). NULL: there are no rings */
  PetscReal *point_X, *point_u;         /* n_points*dim */
  /* Of each fit point: the first of the points, one after the other, that are made of the same images of nodes at the
     same angle, like those of a face. */
  PetscInt *point_alike;
  PetscInt  n_moving, *moving; /* fit points that NeighbourListsUpdate() moves, ascending */
  /* Faces whose quadrature points have held offsets that may change: the fit points of face i are first_held[i] to
     first_held[i + 1] - 1, and home_held[i] says where the face lives. */
  PetscInt     n_held, *first_held;
  PetscSFNode *home_held;

  PetscBool empty;    /* no slave point on any rank was searched: none can have a facet */
  PetscInt  n_slaves; /* slave points, in the order in which they were given */
  /* Those that may have a partner, ascending. The others have no facets, and no nodes, positions or normals. */
  PetscInt   n_near, *near;
  PetscInt  *slave_ptr, *slave_node; /* the nodes of a slave point's own face come first, as in SlavePoints */
  int       *slave_side;
  PetscReal *slave_S, *slave_offset;
  PetscReal *slave_X, *slave_u; /* n_slaves*dim */
  PetscReal *slave_normal;      /* n_slaves*3, out of the slave's body, when the lists were made; of any length */

  PetscInt  *list_ptr, *list_point; /* fit points of each slave point */
  PetscInt  *fit_n;                 /* so many of them, the first ones, are fitted; 0: the facets are used */
  int       *rung;                  /* RUNG_...: how the fit was found */
  int       *degree;                /* of the fit */
  PetscReal *frame, *metric;        /* 9 and 4 entries for each slave point, as in FitProblem */
  FitBend   *bend;                  /* of each slave point, as in FitProblem; NULL: no fit is bent */
  /* Of each slave point: what is subtracted from the gap of the facets where these serve, see FitSupportLift(): height
     of the smooth surface over them (length). NULL: 0 for all. */
  PetscReal *lift;
  /* 2 for each slave point: mean of its fit points when the lists were made, in the frame's tangents, relative to
     it. */
  PetscReal *centre;
  PetscReal *pivot, *amplified; /* guards of the fit when the lists were made */
  /* Gap and normal of the fit when the lists were made, 1 and 3 entries for each slave point. They are valid while
     made is true. */
  PetscReal *gap, *normal;
  PetscBool  made;      /* nothing has moved since the lists were made */
  PetscReal *residual;  /* largest distance to the fit of a point in the inner half of the support */
  PetscInt  *facet_ptr; /* facets of each slave point; their nodes count within its list of points */
  Facet     *facet;
  PetscReal *facet_size;
  int       *nearest; /* which of each slave point's facets was nearest when the lists were made; -1: it has none */
  /* Curvature of the master near each slave point: turn of normals over distance; 0: flat, or no facet. */
  PetscReal *kappa;
  /* Part of each slave point's area that takes part: less than 1 where its normal hardly opposes the master's, and near
     a convex edge where what it faces of the master ends. */
  PetscReal *share;
  PetscBool *averse;  /* the master is near each slave point, but does not face it */
  PetscInt   n_faces; /* all faces of the master around this rank's slave points, by ascending tag; 0: not kept */
  Facet     *face;    /* their nodes count among all points */
} *NeighbourLists;

PetscErrorCode NeighbourListsDestroy(NeighbourLists *);
PetscErrorCode NeighbourListsGiveBack(ContactSearch, NeighbourLists *);
PetscErrorCode NeighbourListsUpdate(ContactSearch, NeighbourLists, const PetscReal *u, PetscReal t, PetscBool *moved);
PetscErrorCode NeighbourListsTakeOffsets(ContactSearch, NeighbourLists, PetscBool *changed);
void           NeighbourListsRelative(NeighbourLists, PetscInt q, PetscInt p, PetscReal *x);
PetscErrorCode NeighbourListsFindAlike(NeighbourLists);
PetscErrorCode NeighbourListsFindMoving(NeighbourLists);
PetscInt       NeighbourListsAlikeEnd(NeighbourLists, PetscInt p);
PetscReal      NeighbourListsNearestSize(NeighbourLists, PetscInt q);
PetscReal      NeighbourListsSlip(NeighbourLists, PetscInt q);
PetscBool      NeighbourListsFitReaches(NeighbourLists, PetscInt q);
PetscReal      NeighbourListsOpposing(const PetscReal own[3], const PetscReal normal[3]);
PetscReal      NeighbourListsOpposed(NeighbourLists, PetscInt q, const PetscReal normal[3]);
PetscBool      NeighbourListsSquare(NeighbourLists, PetscInt q, const PetscReal normal[3]);
PetscReal      NeighbourListsAverse(NeighbourLists, PetscInt q, const PetscReal normal[3]);
PetscInt       NeighbourListsFindFace(NeighbourLists, long tag);
PetscErrorCode NeighbourListsBroadcast(ContactSearch, NeighbourLists, const PetscReal *x, PetscReal t, PetscReal t_next,
                                       PetscReal *values);
PetscErrorCode NeighbourListsReduce(NeighbourLists, const PetscReal *values, PetscReal *y);
