/* The points of the master surface that a fit at a slave point may use: connected to its nearest facet without crossing
   a sharp edge, facing the same way, and within the support. The part works on the facets that a rank holds (its own,
   ghosts, mirror images), with plain arrays and without communication.

   NeighbourhoodsCreate() links the facets of a SurfaceView once, and NeighbourhoodGather() is then called for each
   fit. */
#pragma once
#include "search/facequadrature.h"
#include "search/nodegeometry.h"

/* Facets and points that a rank holds, in the present position. A point is a node or a mirror image of one. */
typedef struct {
  int                 dim;
  PetscInt            n_facets, n_points;
  const Facet        *facets;    /* nodes: points */
  const PetscReal    *normals;   /* n_facets*3, unit, present position */
  const PetscReal    *reference; /* n_facets*3, unit, reference position: for feature edges */
  const PetscReal    *x;         /* n_points*dim */
  const NodeGeometry *geometry;  /* of each point, reflected with it */
  PetscReal           feature_cosine;
  /* For integral fits the fit points of facet f are first[f] to first[f] + count[f] - 1. NULL: the nodes are the fit
     points. */
  const PetscInt  *first, *count;
  const PetscReal *hoop; /* of each point, for fits of revolution; NULL: none */
} SurfaceView;

/* Do two facets that meet continue each other, and do not form a sharp edge? */
static inline PetscBool SurfaceViewContinues(const SurfaceView *view, PetscInt f, PetscInt g)
{
  const PetscReal *a = &view->reference[3 * f], *b = &view->reference[3 * g];

  return (PetscBool)(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] >= view->feature_cosine);
}

/* A support: its metric and how it bends, in space. */
typedef struct {
  PetscReal metric[9]; /* row-major 3x3, symmetric, inverse squared lengths */
  PetscBool bent;
  PetscReal along[3], across[3], h[2]; /* where it is bent: unit vectors, and coefficients as in FitBend */
} NeighbourhoodSupport;

/* Facets and points whose normal makes a larger angle with that of the frame belong to another flank: cos 60
   degrees. */
#define NEIGHBOURHOOD_COSINE 0.5

typedef struct _n_Neighbourhoods *Neighbourhoods;

PetscErrorCode NeighbourhoodsCreate(const SurfaceView *, Neighbourhoods *);
PetscErrorCode NeighbourhoodsDestroy(Neighbourhoods *);
PetscBool      NeighbourhoodsIsSharp(Neighbourhoods, PetscInt f);
PetscBool      NeighbourhoodsIsFolded(Neighbourhoods, PetscInt f);
PetscBool      NeighbourhoodsMeetSharply(Neighbourhoods, PetscInt f, PetscInt g);
PetscInt       NeighbourhoodsLinkCount(Neighbourhoods);
PetscInt       NeighbourhoodsLinks(Neighbourhoods, PetscInt f, PetscInt *first, const PetscInt **links);
PetscErrorCode NeighbourhoodGather(Neighbourhoods, PetscInt start, const PetscReal x0[3], const PetscReal e3[3],
                                   const NeighbourhoodSupport *, PetscReal limit, PetscInt max, PetscInt *points,
                                   const PetscReal **rho2, PetscInt *n, PetscInt *found);
