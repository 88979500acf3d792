/* Rigid motions of bodies as vectors of six numbers, and which of them a set of constraints leaves free. Plain C.

   A motion is q = (rotation x, y, z, translation x, y, z): the velocity at x is translation + rotation * x, x relative
   to a body's centre and in units of its size, so that all six are of one scale. Constraints are collected as the sum
   of squares of what they forbid (a Gram matrix); RigidFree() finds what they do not see. */
#pragma once

enum { RIGID_MODES = 6 };

/* row[6]: the velocity of every motion at x along direction n */
void RigidRow(const double x[3], const double n[3], double row[RIGID_MODES]);
/* gram += weight * row row^T, both of n entries */
void RigidAddRow(int n, const double row[], double weight, double gram[]);
/* Null space of the n x n positive semidefinite gram, which is overwritten. free: room for n x n, returned rows of n;
 * returns how many. */
int RigidFree(int n, double gram[], double tolerance, double free[]);
/* Reduced row echelon form of m rows of n: the one basis of their span that depends on nothing else. columns[n]: the
 * order in which columns are cleared. */
void RigidReduce(int m, int n, const int columns[], double rows[]);
