/* Which points of the master surface a fit at a slave point may use: connected to its nearest facet without crossing a
   sharp edge, facing the same way, within the support. Works on the facets that a rank holds (its own, ghosts, mirror
   images); plain arrays, no communication. */
#pragma once
#include "search/facequadrature.h"
#include "search/nodegeometry.h"

/* Facets and points that a rank holds in the position of the moment. A point is a node or a mirror image of one. */
typedef struct {
  int                 dim;
  PetscInt            n_facets, n_points;
  const Facet        *facets;    /* nodes: points */
  const PetscReal    *normals;   /* n_facets*3, unit, position of the moment */
  const PetscReal    *reference; /* n_facets*3, unit, reference position: for feature edges */
  const PetscReal    *x;         /* n_points*dim */
  const NodeGeometry *geometry;  /* of each point, reflected with it */
  PetscReal           feature_cosine;
  const PetscInt     *first; /* integral fits: the fit points of facet f are first[f] and what its quadrature rule has;
                                NULL: the nodes are the fit points */
} SurfaceView;

typedef struct _n_Neighbourhoods *Neighbourhoods;

PetscErrorCode NeighbourhoodsCreate(const SurfaceView *, Neighbourhoods *);
PetscErrorCode NeighbourhoodsDestroy(Neighbourhoods *);
/* Points around the foot x0 with normal e3 on facet `start`, with rho^2 <= limit in the metric (inverse squared
   lengths, dim x dim, row-major 3x3, symmetric): at most max, the nearest, are written to points[], those of a facet
   together where all are, their rho^2 are (*rho2)[] until the next call; returns how many there were in *found. */
PetscErrorCode NeighbourhoodGather(Neighbourhoods, PetscInt start, const PetscReal x0[3], const PetscReal e3[3],
                                   const PetscReal metric[9], PetscReal limit, PetscInt max, PetscInt *points,
                                   const PetscReal **rho2, PetscInt *n, PetscInt *found);
