/* Rigid masters with a closed form: plane, cylinder, sphere, from outside or inside (a bore). Plain C: no PETSc, no
   MPI, no allocation. They have no unknowns: N and M are the slave point's own, and the force on the master is minus
   the sum of the slave forces.

   Positions are relative to the master's point, formed as (X - point) + u by the caller. In 2D third components are 0,
   but for the axis of a cylinder: (0, 0, 1) is a circle, one in the plane a strip (axisymmetric: (0, 1, 0) is the
   cylinder about the axis; a sphere has its centre there). */
#pragma once

#define ANALYTIC_CENTRE 1e-8 /* distance from axis or centre, over the radius, below which there is no closest point \
                              */

typedef enum { ANALYTIC_PLANE, ANALYTIC_CYLINDER, ANALYTIC_SPHERE } AnalyticShape;

typedef struct {
  AnalyticShape shape;
  int           inside;  /* the body is around the slave point: a bore */
  double        axis[3]; /* plane: normal out of the body; cylinder: its axis; of any length but 0 */
  double        radius;
} AnalyticSurface;

typedef struct {
  double gap;       /* < 0: penetration */
  double normal[3]; /* unit, out of the body */
  double N[3];      /* [dim] */
  double M[9];      /* [dim][dim], symmetric */
  double curvature; /* 1/radius, 0 for a plane */
} AnalyticResult;

/* x[dim]: slave point relative to the master's point (on the plane, on the axis, the centre). Returns 0 on the axis or
 * at the centre. */
int AnalyticSurfaceEvaluate(const AnalyticSurface *, int dim, const double *x, AnalyticResult *);
