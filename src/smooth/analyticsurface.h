/* Rigid masters with a closed form: plane, cylinder and sphere. The slave point lies outside of the body or inside of
   it (a bore). Plain C: no PETSc, no MPI, no allocation.

   AnalyticSurfaceEvaluate() gives the gap of one slave point and its variations. Such a master has no unknowns: N and M
   belong to the slave point alone, and the force on the master is minus the sum of the slave forces.

   Positions are relative to the master's point. The caller forms them as (X - point) + u. In 2D the third components
   are 0, except in the axis of a cylinder: the axis (0, 0, 1) makes a circle, and an axis in the plane makes a
   strip. In axisymmetric scenes the axis (0, 1, 0) makes the cylinder about the axis of revolution, and the centre
   of a sphere lies on that axis. */
#pragma once

/* Below this distance from the axis or centre, as a fraction of the radius, there is no unique closest point. */
#define ANALYTIC_CENTRE 1e-8

typedef enum { ANALYTIC_PLANE, ANALYTIC_CYLINDER, ANALYTIC_SPHERE } AnalyticShape;

typedef struct {
  AnalyticShape shape;
  int           inside;  /* the body surrounds the slave point: a bore */
  double        axis[3]; /* plane: normal out of the body; cylinder: its axis; of any length except 0 */
  double        radius;
} AnalyticSurface;

typedef struct {
  double gap;       /* length; negative: penetration */
  double normal[3]; /* unit, out of the body */
  double N[3];      /* [dim] */
  double M[9];      /* [dim][dim], symmetric */
  double curvature; /* 1/radius; 0 for a plane */
} AnalyticResult;

int AnalyticSurfaceEvaluate(const AnalyticSurface *, int dim, const double *X, const double *u, AnalyticResult *);
