/* What a rank holds of a pair while the lists stand still: contact nodes, the fit points and slave points that are made
   of them, and for each slave point the facets and fit points it is measured against. The lists stay while the
   positions move (NeighbourListsUpdate()). */
#pragma once
#include "smooth/diffusefit.h"
#include "search/surface.h"

typedef struct _n_ContactSearch *ContactSearch; /* search.h */

/* Lists reach this much beyond the support of a fit, in supports: so far a slave point may slide while they stand
 * still. */
#define NEIGHBOUR_LISTS_MARGIN 0.3

/* Which rung of the ladder a slave point stands on: fits of falling quality, then the facets. */
enum { RUNG_FACET = -1, RUNG_PLAIN = 0, RUNG_WIDER = 4, RUNG_DEGREE_2 = 6, RUNG_LINEAR = 7, RUNGS = 8 };

/* Everything a rank needs of a pair while lists are frozen. Contact nodes are the nodes that its terms touch: first
   those with unknowns (leaves of sf; roots are the local nodes of their owners), then nodes of a rigid tool. Points are
   what a smoother sees: a fixed combination of images of contact nodes, reflected, plus an offset: x = sign * (sum S
   (image of x_node)) + shift + offset. */
typedef struct {
  int          dim;
  PetscInt     n_nodes, n_deformable;
  PetscInt    *node_id; /* deformable: the mesh's rank-independent id; rigid: node of the tool */
  PetscReal   *X, *u;   /* n_nodes*dim: reference coordinates, displacement at the last update */
  PetscReal    t;       /* of the last update, NaN before */
  PetscInt    *dof;     /* n_nodes*dim global dofs, -1 where constrained or rigid */
  PetscSF      sf;
  MPI_Datatype block; /* dim reals */

  PetscInt   n_points; /* fit points */
  PetscInt  *point_ptr, *point_node;
  int       *point_side; /* of each entry: which image of the node; not 0 with live offsets only */
  PetscReal *point_S, *point_offset, *point_weight;
  int       *point_image;
  long      *point_key;         /* rank-independent: which node or quadrature point, and which image */
  PetscReal *point_X, *point_u; /* n_points*dim */

  PetscInt   n_slaves;               /* slave points, in the order asked for */
  PetscInt  *slave_ptr, *slave_node; /* the nodes of a slave point's own face come first, as in SlavePoints */
  int       *slave_side;
  PetscReal *slave_S, *slave_offset;
  PetscReal *slave_X, *slave_u; /* n_slaves*dim */

  PetscInt  *list_ptr, *list_point; /* fit points of each slave point */
  PetscInt  *fit_n;                 /* the first so many of them are fitted; 0: the facets serve */
  int       *rung;                  /* RUNG_...: how the fit was found */
  int       *degree;                /* of the fit */
  PetscReal *frame, *metric;        /* 9 and 4 for each slave point, as FitProblem wants them */
  PetscReal *centre; /* 2 for each slave point: mean of its fit points in the frame's tangents, seen from it, when the
                        lists were made */
  PetscReal *pivot, *amplified; /* guards of the fit when the lists were made */
  PetscReal *gap, *normal; /* of the fit when the lists were made, 1 and 3 for each slave point; they stand while ... */
  PetscBool  made;         /* ... nothing has moved since then */
  PetscReal *residual;     /* largest distance of a point in the inner half of the support to the fit */
  PetscInt  *facet_ptr;    /* facets of each slave point; their nodes count within the slave point's points */
  Facet     *facet;
  PetscReal *facet_size;
  int       *nearest; /* of each slave point's facets the nearest when the lists were made; -1: it has none */
  PetscReal
    *kappa; /* curvature of the master near each slave point: turn of normals over distance; 0: flat or no facet */
} *NeighbourLists;

PetscErrorCode NeighbourListsDestroy(NeighbourLists *);
/* Positions of contact nodes, fit points and slave points for local displacements u at t; *moved (may be NULL): not
 * where they were. Collective. */
PetscErrorCode NeighbourListsUpdate(ContactSearch, NeighbourLists, const PetscReal *u, PetscReal t, PetscBool *moved);
/* x[dim]: point p seen from slave point q at the last update. Not collective. */
void NeighbourListsRelative(NeighbourLists, PetscInt q, PetscInt p, PetscReal *x);
/* Where the run of points ends that are made of the same images of nodes as point p: those of a face. Not collective.
 */
PetscInt NeighbourListsAlikeEnd(NeighbourLists, PetscInt p);
/* Size (length) of the facet nearest to slave point q, 0 without any. Not collective. */
PetscReal NeighbourListsNearestSize(NeighbourLists, PetscInt q);
/* How far slave point q has slid over its fit points since the lists were made, in supports; 0 without a fit. Not
 * collective. */
PetscReal NeighbourListsSlip(NeighbourLists, PetscInt q);
/* Values of the contact nodes (n_nodes*dim) from local values x (n_nodes of the mesh * dim); rigid nodes get their
 * motion from t to t_next. Collective. */
PetscErrorCode NeighbourListsBroadcast(ContactSearch, NeighbourLists, const PetscReal *x, PetscReal t, PetscReal t_next,
                                       PetscReal *values);
/* Adds values of the contact nodes (n_nodes*dim) to y (local), complete at owned nodes; rigid nodes are left out.
 * Collective. */
PetscErrorCode NeighbourListsReduce(NeighbourLists, const PetscReal *values, PetscReal *y);
