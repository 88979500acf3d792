/* What holds a facet: a sphere, a slab across its normal, and a cone of its normals. It tells from a few products on
   which side of a facet a point lies, where the closest point on the facet need not be known. Plain C: no PETSc, no
   MPI, no allocation. */
#pragma once
#include "smooth/facet.h"

typedef struct {
  double centre[3], radius; /* of a sphere that holds the facet (length) */
  double normal[3];         /* unit, of the middle of the facet; 0 where it has none */
  double low, high;         /* the facet lies between these heights over the centre along the normal (length) */
  double turn; /* sine of the largest angle between a normal of the facet and this one; INFINITY: unknown */
} FacetHull;

void FacetHullOf(int dim, const Facet *facet, const double *x, FacetHull *hull);
int  FacetHullSide(const FacetHull *hull, const double point[3], double tolerance);
