/* Factors over the load parameter t, and the motions of rigid bodies that are built from them. Plain C.

   A History is a piecewise linear factor. HistoryValue() gives its value at t, HistoryFactor() does so too, and gives 1
   where there is none. HistorySlope() gives its slope; HistoryBreaks() tells where this may change. A Motion is a
   translation of the point and a rotation about it by the vector (rx, ry, rz); each of its components is a value times
   a history, or an expression of t. MotionComponents() gives the six numbers at t, MotionPlace() moves a point with the
   body, MotionTurn() a direction.

   Components of a motion may be free: they are unknowns of the problem. MotionSet() tells their values at the iterate,
   MotionAccept() those of the accepted state. */
#pragma once
#include "scene/expression.h"

/* Components of a motion: ux, uy, uz, rx, ry, rz */
enum { MOTION_COMPONENTS = 6 };

typedef struct {
  int     n;     /* number of breakpoints, at least 2; 0: no history */
  double *t, *v; /* load parameter (strictly increasing) and factor at each breakpoint [n] */
} History;

typedef struct {
  int        component;  /* 0 to 2 for ux, uy, uz; 3 to 5 for rx, ry, rz */
  double     value;      /* length for ux, uy, uz; degrees for rx, ry, rz */
  Expression expression; /* of t, in the place of value and history; NULL: there is none */
  History    history;
} MotionComponent;

/* Values of the free components at a load parameter. */
typedef struct {
  double t, value[MOTION_COMPONENTS]; /* lengths and radians */
} FreeComponents;

typedef struct {
  double           point[3]; /* about which the body rotates (length) */
  int              n;
  MotionComponent *components;
  int              n_free, free[MOTION_COMPONENTS]; /* whether a component is an unknown */
  FreeComponents   now, accepted;                   /* of the free components */
  /* Force and moment on the body along its free components: numbers times the history, or expressions of t. */
  double     thickness; /* of the plane, by which forces are divided; 0: 1 */
  double     force[MOTION_COMPONENTS];
  Expression force_expression[MOTION_COMPONENTS];
  History    history;
} Motion;

double HistoryValue(const History *, double t);
double HistoryFactor(const History *, double t);
double HistorySlope(const History *, double t);
int    HistoryBreaks(const History *, double t);
void   MotionComponents(const Motion *, double t, double q[MOTION_COMPONENTS]);
void   MotionPlace(const Motion *, double t, const double X[3], double x[3]);
void   MotionTurn(const Motion *, double t, const double V[3], double v[3]);
void   MotionSet(Motion *, double t, const double q[MOTION_COMPONENTS]);
void   MotionAccept(Motion *, double t, const double q[MOTION_COMPONENTS]);
double MotionForce(const Motion *, double t, int component);
