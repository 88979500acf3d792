/* The traditional contact smoother: the master surface is the union of its facets, and the gap is the signed distance
   to it. Plain C: no PETSc, no MPI, no allocation.

   FacetClosest() finds the foot of a slave point on a list of facets. FacetFirstVariation() and FacetSecondVariation()
   then give the derivatives of the gap at that foot. FacetProject() does the same as FacetClosest() for a single facet.

   The closest point may lie over the interior of a facet, on an edge (3D) or at a vertex. The gap is continuous
   everywhere. A slave point that leaves a facet therefore passes to the neighbour without losing contact, across convex
   and concave edges. All positions are relative to the slave point: d = x_node - x_slave.

   Beyond a free edge of the surface (a bit of free_edges) the facet is extended. The foot may leave the reference
   domain there, and `beyond` gives the distance (a length), so that the caller can fade the contact out. The facet
   is chosen by the distance to the true facets without extension. An extension therefore never hides a facet that is
   really there.

   At an edge where the list of facets ends, though the surface goes on (a bit of cut_edges), a slave point is never
   inside: what is there is not its master. A foot on such an edge has a positive gap. */
#pragma once
#include "kernels/element.h"

/* Guards. Lengths are relative to the facet's size, which is the diameter of its bounding sphere. Where the slave
   point is far away, its distance is added to that size. */

/* How far an extension reaches past a free edge, in widths of the facet. The caller's fading ends within one width. */
#define FACET_EXTENSION 1.0
/* Feet that are nearer to each other than this are one point, whose normals make the pseudo-normal. This is well
   above the feet's own error of 1e-12. */
#define FACET_COINCIDENT 1e-9
/* Distances that differ by less than this tie, and a tangential part of the residual below it counts as none. It is
   the rounding of positions. */
#define FACET_TIE 1e-12
/* Nearer than this to an edge or vertex the direction to it is noise. The pseudo-normal is used there, and terms in
   1/gap are left out. */
#define FACET_TOUCHING 1e-10
/* Hessian of the distance over the metric. Below this the Hessian does not count as positive: the point is at the
   centre of curvature. */
#define FACET_FOCAL 1e-8
/* Share of the predicted decrease that a step must reach. It is the usual value for Armijo's rule. */
#define FACET_DESCENT 1e-4
/* Squared sine of the angle between the tangents, or squared length of a tangent over the squared size. Below this a
   facet is degenerate at that point. */
#define FACET_FLAT 1e-20
enum {
  /* Newton's method takes 3 to 6 iterations. The rest is for points near a centre of curvature. */
  FACET_ITERATIONS = 50,
  /* Most facets that can share one closest point. It is far above the valence of any vertex. */
  FACET_TIES = 48
};

typedef struct {
  ElementType type;                  /* EDGE2, EDGE3 (2D), TRI3, TRI6, QUAD4, QUAD9 (3D) */
  int         nodes[FACE_MAX_NODES]; /* indices into the position array */
  /* Bit e is set if there is no neighbour at edge e (3D; ElementGet(type)->edge_corners) or at end e (2D): the
     surface ends there. */
  int  free_edges;
  int  cut_edges; /* the same bits: the neighbour there is left out of the list, and the foot ends there */
  long tag;       /* does not depend on the ranks; ties go to the smallest */
} Facet;

typedef enum { FOOT_INTERIOR, FOOT_EDGE, FOOT_VERTEX } FootRegion;

typedef struct {
  int        facet; /* index into the list */
  FootRegion region;
  int        feature; /* which edge or corner of the facet, -1 in the interior */
  double     xi[2];   /* on the facet; outside the reference domain where it is extended */
  double     gap;     /* length; positive: open, negative: penetration */
  /* Unit normal at the foot, out of the master (2D: last component 0). x_slave - foot = gap * normal. */
  double normal[3];
  /* Distance past a free edge (length), 0 inside. Where the extension ends it is at least the facet's size, and the
     gap is positive. */
  double beyond;
  /* 0: the projection onto the chosen facet did not converge, and the closest iterate is returned. */
  int converged;
} Foot;

int    FacetClosest(int dim, int n, const Facet *facets, const double *x, int seed, Foot *foot);
void   FacetProject(int dim, const Facet *facet, const double *x, Foot *foot);
double FacetSize(int dim, const Facet *facet, const double *x);
void   FacetFirstVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *N);
void   FacetSecondVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *M);
