/* Factors over the load parameter t, and the prescribed motions of rigid bodies that are built from them. Plain C.

   A History is a piecewise linear factor. HistoryValue() gives its value at t, HistorySlope() its slope;
   HistoryBreaks() tells where its slope may change. A Motion is a translation of the point and a rotation about it by
   the vector (rx, ry, rz); each of its components is a value times a history. MotionPlace() moves a point with the
   body, MotionTurn() a direction. */
#pragma once

typedef struct {
  int     n;     /* number of breakpoints, at least 2 */
  double *t, *v; /* load parameter (strictly increasing) and factor at each breakpoint [n] */
} History;

typedef struct {
  int     component; /* 0 to 2 for ux, uy, uz; 3 to 5 for rx, ry, rz */
  double  value;     /* length for ux, uy, uz; degrees for rx, ry, rz */
  History history;
} MotionComponent;

typedef struct {
  double           point[3]; /* about which the body rotates (length) */
  int              n;
  MotionComponent *components;
} Motion;

double HistoryValue(const History *, double t);
double HistorySlope(const History *, double t);
int    HistoryBreaks(const History *, double t);
void   MotionPlace(const Motion *, double t, const double X[3], double x[3]);
void   MotionTurn(const Motion *, double t, const double V[3], double v[3]);
