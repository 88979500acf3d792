/* Rigid motions of bodies, and which of them a set of constraints leaves free. Plain C.

   A motion is a vector q of six numbers: rotations about x, y, z and translations along x, y, z. The velocity at x is
   translation + rotation x X. Here X is the position relative to the body's centre, divided by the body's size, so that
   all six numbers have one scale. Every constraint is a row that forbids a velocity: RigidRow() makes it, RigidAddRow()
   adds its square to a Gram matrix, RigidFree() finds the null space of that matrix and RigidReduce() makes the basis
   of the null space unique. RigidVelocity() gives a motion's velocity at a point, RigidMove() takes the point along it.
   RigidTurnRate() gives the spin of a body whose rotation vector changes, RigidTurnRateChange() how that spin changes.
   RigidCholesky(), RigidForward(), RigidBackward() and RigidSolve() work with positive definite matrices of motions. */
#pragma once

/* Number of rigid motions of a body in space */
enum { RIGID_MODES = 6 };

void RigidRow(const double x[3], const double n[3], double row[RIGID_MODES]);
void RigidAddRow(int n, const double row[], double weight, double gram[]);
int  RigidFree(int n, double gram[], double tolerance, double free[]);
void RigidReduce(int m, int n, const int columns[], double rows[]);
void RigidVelocity(const double q[RIGID_MODES], const double x[3], double v[3]);
void RigidMove(const double q[RIGID_MODES], double x[3]);
void RigidTurnRate(const double turn[3], double spin[3][3]);
void RigidTurnRateChange(const double turn[3], double change[3][3][3]);
void RigidCholesky(int n, const double *matrix, double *L);
void RigidForward(int n, const double *L, double x[]);
void RigidBackward(int n, const double *L, double x[]);
void RigidSolve(int n, const double *L, double x[]);
