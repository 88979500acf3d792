/* Prescribed motion of a rigid body: displacement and rotation components, each a value times its history. Plain C. */
#pragma once
#include "scene/history.h"

typedef struct {
  int     component; /* 0..2: ux uy uz; 3..5: rx ry rz (degrees) */
  double  value;
  History history;
} MotionComponent;

/* A translation of point and a rotation about it by the vector (rx, ry, rz). */
typedef struct {
  double           point[3];
  int              n;
  MotionComponent *components;
} Motion;

void MotionPlace(const Motion *, double t, const double X[3], double x[3]); /* where a point of the body is at t */
void MotionTurn(const Motion *, double t, const double V[3], double v[3]);  /* a direction fixed to the body */
