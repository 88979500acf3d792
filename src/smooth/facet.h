/* The traditional contact smoother: the master surface is its facets, the gap is the signed distance to them. Plain C:
   no PETSc, no MPI, no allocation.

   The gap of a slave point is its signed distance to the union of the facets in its list: over the interior of a facet,
   an edge (3D) or a vertex, whichever holds the closest point. It is continuous everywhere; so a slave point that
   leaves a facet goes over to the neighbour, across convex and concave edges, without losing contact. All positions are
   relative to the slave point: d = x_node - x_slave.

   Beyond a free edge of the surface (a bit of free_edges) the facet is extended: the foot may leave the reference
   domain there, and `beyond` says by how far (a length), so that the caller can fade the contact out. The facet is
   chosen by the distance to the true, unextended facets, so an extension never hides a facet that is really there. */
#pragma once
#include "kernels/element.h"

/* Guards. Lengths are relative to the facet's size (diameter of its bounding sphere), plus the distance where the point
 * is far. */
#define FACET_EXTENSION \
  1.0 /* how far an extension reaches past a free edge, in widths of the facet: the caller's fading ends within one */
#define FACET_COINCIDENT                                                                                               \
  1e-9 /* feet nearer than this are one point, whose normals make the pseudo-normal; well above their own error, 1e-12 \
        */
#define FACET_TIE \
  1e-12 /* distances nearer than this tie, and a tangential residual below it is none: rounding of positions */
#define FACET_TOUCHING                                                                                                 \
  1e-10 /* nearer to an edge or vertex the direction to it is noise: the pseudo-normal serves, terms in 1/gap are left \
           out */
#define FACET_FOCAL \
  1e-8 /* Hessian of the distance over the metric, below which it counts as not positive: the centre of curvature */
#define FACET_DESCENT 1e-4 /* share of the predicted decrease that a step must reach: Armijo's usual figure */
#define FACET_FLAT                                                                                             \
  1e-20 /* squared sine between the tangents, or squared length of one over the size's, below which a facet is \
           degenerate there */
enum {
  FACET_ITERATIONS = 50, /* Newton takes 3 to 6; the rest is for points near a centre of curvature */
  FACET_TIES       = 48  /* facets that can share one closest point: far above the valence of any vertex */
};

typedef struct {
  ElementType type;                  /* EDGE2, EDGE3 (2D), TRI3, TRI6, QUAD4, QUAD9 (3D) */
  int         nodes[FACE_MAX_NODES]; /* indices into the position array */
  int free_edges; /* bit e: no neighbour at edge e (3D; ElementGet(type)->edge_corners) or end e (2D): the surface ends
                     there */
  long tag;       /* rank-independent key: ties go to the smallest */
} Facet;

typedef enum { FOOT_INTERIOR, FOOT_EDGE, FOOT_VERTEX } FootRegion;

typedef struct {
  int        facet; /* index into the list */
  FootRegion region;
  int        feature; /* which edge or corner of the facet, -1 in the interior */
  double     xi[2];   /* foot point on the facet, outside the reference domain where it is extended */
  double     gap;     /* > 0 open, < 0 penetration */
  double
    normal[3]; /* unit normal at the foot, out of the master (2D: last component 0); (x_slave - foot) = gap * normal */
  double beyond; /* distance past a free edge, 0 inside; at least the facet's size where the extension ends (gap > 0
                    there) */
  int converged; /* 0: the projection onto the winning facet did not converge (the closest iterate is returned) */
} Foot;

/* Closest point over a list of facets. x: positions of the nodes relative to the slave point, [node][dim]; seed: facet
   to try first or -1. Returns 0 if the list is empty. */
int FacetClosest(int dim, int n, const Facet *facets, const double *x, int seed, Foot *foot);
/* Closest point of one facet (as FacetClosest for a list of one, no pseudo-normal from neighbours). */
void FacetProject(int dim, const Facet *facet, const double *x, Foot *foot);
/* Largest extent of the facet: the diameter of a sphere that holds it. */
double FacetSize(int dim, const Facet *facet, const double *x);
/* First variation: N[(1+nodes)*dim], the slave point first, then the winning facet's nodes in its order. */
void FacetFirstVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *N);
/* Second variation: M[((1+nodes)*dim)^2], symmetric, exact for the region the foot is in. */
void FacetSecondVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *M);
