/* One facet as a polynomial map x(xi) over its reference polygon, and the projection onto it: the closest point, its
   region, normal and angle. Plain C: no PETSc, no MPI, no allocation. Knows no neighbours: the competition of facets,
   edges and corners is facet.c's.

   All positions are relative to the slave point, so that the point to be projected is the origin. A 2D facet is the 3D
   one extruded: second tangent e_z, no sides across it; its end points are the edges of the extruded one. */
#pragma once
#include "smooth/facet.h"

enum { FACET_POLYNOMIAL_MAX_SIDES = 4 };

/* Reference polygon. Side s runs from corner s to the next; inside: offset + normal.xi >= 0 (1 or 2, `width`, at the
 * far end). */
typedef struct {
  int    sides;
  double low, width, centre[2];
  double offset[FACET_POLYNOMIAL_MAX_SIDES], normal[FACET_POLYNOMIAL_MAX_SIDES][2],
    tangent[FACET_POLYNOMIAL_MAX_SIDES][2];
} FacetPolynomialDomain;

typedef struct {
  double centre[3], radius;
} FacetPolynomialSphere;

/* The facet as a polynomial: x = sum c[i][j] xi^i eta^j */
typedef struct {
  const FacetPolynomialDomain *domain;
  int                          flat; /* affine: one start is enough */
  double                       c[3][3][3], size;
} FacetPolynomial;

typedef struct {
  double x[3], x1[3], x2[3], x11[3], x12[3], x22[3];
} FacetPolynomialLocal;

/* A point of a patch and the sides it is held at */
typedef struct {
  double   xi[2], x[3];
  unsigned active;
  int      converged;
} FacetPolynomialPoint;

static inline double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Nodes of a facet as points in space; returns how many. */
int FacetPolynomialGather(int dim, const Facet *, const double *x, double X[FACE_MAX_NODES][3]);
/* A sphere that holds the facet, also between its nodes. */
void FacetPolynomialBound(ElementType, double (*X)[3], FacetPolynomialSphere *);
/* size: diameter of that sphere */
void FacetPolynomialCreate(ElementType, double (*X)[3], double size, FacetPolynomial *);
void FacetPolynomialOfFacet(int dim, const Facet *, const double *x, FacetPolynomial *);
void FacetPolynomialEvaluate(const FacetPolynomial *, const double xi[2], FacetPolynomialLocal *);
/* Unit normal at xi, or at the facet's centre where there is none at xi (a collapsed side); 0 if there is none at all.
 */
void FacetPolynomialNormal(const FacetPolynomial *, const double xi[2], double normal[3]);
/* Angle of the facet at a point: of the corner, or half a turn. */
double FacetPolynomialAngle(const FacetPolynomial *, const FacetPolynomialPoint *);
/* From a point to a local minimum of the distance over the polygon with the given limits of its sides (0, or negative
 * where extended). */
void FacetPolynomialDescend(const FacetPolynomial *, const double limit[], FacetPolynomialPoint *);
/* Closest point over the polygon itself. */
void FacetPolynomialClosest(const FacetPolynomial *, FacetPolynomialPoint *);
/* Which region a point is in, and which edge or corner. */
void FacetPolynomialClassify(const FacetPolynomial *, const FacetPolynomialPoint *, FootRegion *, int *feature);
