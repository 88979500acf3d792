/* One facet as a polynomial map x(xi) over its reference polygon, and the projection onto it: the closest point, its region, normal and angle.
   Plain C: no PETSc, no MPI, no allocation. Knows no neighbours: the competition of facets, edges and corners is facet.c's.

   All positions are relative to the slave point, so that the point to be projected is the origin. A 2D facet is the 3D one extruded: second
   tangent e_z, no sides across it; its end points are the edges of the extruded one. */
#pragma once
#include "smooth/facet.h"

enum { PATCH_MAX_SIDES = 4 };

/* Reference polygon. Side s runs from corner s to the next; inside: offset + normal.xi >= 0 (1 or 2, `width`, at the far end). */
typedef struct {
  int    sides;
  double low, width, centre[2];
  double offset[PATCH_MAX_SIDES], normal[PATCH_MAX_SIDES][2], tangent[PATCH_MAX_SIDES][2];
} PatchDomain;

typedef struct {
  double centre[3], radius;
} PatchSphere;

/* The facet as a polynomial: x = sum c[i][j] xi^i eta^j */
typedef struct {
  const PatchDomain *domain;
  int                flat; /* affine: one start is enough */
  double             c[3][3][3], size;
} Patch;

typedef struct {
  double x[3], x1[3], x2[3], x11[3], x12[3], x22[3];
} PatchLocal;

/* A point of a patch and the sides it is held at */
typedef struct {
  double   xi[2], x[3];
  unsigned active;
  int      converged;
} PatchPoint;

static inline double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Nodes of a facet as points in space; returns how many. */
int PatchGather(int dim, const Facet *, const double *x, double X[FACE_MAX_NODES][3]);
/* A sphere that holds the facet, also between its nodes. */
void PatchBound(ElementType, double (*X)[3], PatchSphere *);
/* size: diameter of that sphere */
void PatchCreate(ElementType, double (*X)[3], double size, Patch *);
void PatchOfFacet(int dim, const Facet *, const double *x, Patch *);
void PatchEvaluate(const Patch *, const double xi[2], PatchLocal *);
/* Unit normal at xi, or at the facet's centre where there is none at xi (a collapsed side); 0 if there is none at all. */
void PatchNormal(const Patch *, const double xi[2], double normal[3]);
/* Angle of the facet at a point: of the corner, or half a turn. */
double PatchAngle(const Patch *, const PatchPoint *);
/* From a point to a local minimum of the distance over the polygon with the given limits of its sides (0, or negative where extended). */
void PatchDescend(const Patch *, const double limit[], PatchPoint *);
/* Closest point over the polygon itself. */
void PatchClosest(const Patch *, PatchPoint *);
/* Which region a point is in, and which edge or corner. */
void PatchClassify(const Patch *, const PatchPoint *, FootRegion *, int *feature);
