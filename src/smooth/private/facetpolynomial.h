/* One facet as a polynomial map x(xi) over its reference polygon, and the projection onto it. Plain C: no PETSc, no
   MPI, no allocation.

   FacetPolynomialOfFacet() makes the polynomial of a facet. FacetPolynomialClosest() finds the closest point on it, and
   FacetPolynomialClassify() tells whether that point is in the interior, on an edge or at a corner.
   FacetPolynomialNormal() and FacetPolynomialAngle() describe the facet at a point. FacetPolynomialDescend() also
   serves facets that are extended past their sides. The part knows no neighbours: facet.c chooses between facets, edges
   and corners.

   All positions are relative to the slave point, so that the point to be projected is the origin. A 2D facet is
   extruded to a 3D one: its second tangent is e_z, and there are no sides across that direction. Its end points are
   the edges of the extruded facet. */
#pragma once
#include "smooth/facet.h"

enum { FACET_POLYNOMIAL_MAX_SIDES = 4 };

/* Reference polygon. Side s runs from corner s to the next one. Inside offset + normal.xi >= 0 holds for each side;
   the value at the far end is 1 or 2, which is `width`. */
typedef struct {
  int    sides;
  double low, width, centre[2];
  double offset[FACET_POLYNOMIAL_MAX_SIDES], normal[FACET_POLYNOMIAL_MAX_SIDES][2],
    tangent[FACET_POLYNOMIAL_MAX_SIDES][2];
} FacetPolynomialDomain;

typedef struct {
  double centre[3], radius;
} FacetPolynomialSphere;

/* The facet as a polynomial: x = sum c[i][j] xi^i eta^j. */
typedef struct {
  const FacetPolynomialDomain *domain;
  int                          flat; /* affine: one start of the descent is enough */
  double                       c[3][3][3], size;
} FacetPolynomial;

typedef struct {
  double x[3], x1[3], x2[3], x11[3], x12[3], x22[3];
} FacetPolynomialLocal;

/* A point of the polynomial and the sides at which it is held. */
typedef struct {
  double   xi[2], x[3];
  unsigned active;
  int      converged;
} FacetPolynomialPoint;

static inline double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int    FacetPolynomialGather(int dim, const Facet *, const double *x, double X[FACE_MAX_NODES][3]);
void   FacetPolynomialControl(ElementType, double (*X)[3], double (*control)[3]);
void   FacetPolynomialBound(ElementType, double (*X)[3], FacetPolynomialSphere *);
void   FacetPolynomialCreate(ElementType, double (*X)[3], double size, FacetPolynomial *);
void   FacetPolynomialOfFacet(int dim, const Facet *, const double *x, FacetPolynomial *);
void   FacetPolynomialEvaluate(const FacetPolynomial *, const double xi[2], FacetPolynomialLocal *);
void   FacetPolynomialNormal(const FacetPolynomial *, const double xi[2], double normal[3]);
double FacetPolynomialAngle(const FacetPolynomial *, const FacetPolynomialPoint *);
void   FacetPolynomialDescend(const FacetPolynomial *, const double limit[], FacetPolynomialPoint *);
void   FacetPolynomialClosest(const FacetPolynomial *, FacetPolynomialPoint *);
void   FacetPolynomialClassify(const FacetPolynomial *, const FacetPolynomialPoint *, FootRegion *, int *feature);
