/* Vectors of three components. Plain C. */
#pragma once
#include <math.h>

/* Sides of a wedge are more than a right angle apart: their normals have less than this product, which leaves out
   right-angled edges and their round-off. */
#define VECTORS_WEDGE (-1e-3)

static inline double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b, which must be none of both. */
static inline void Cross(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void Minus(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[d] - b[d];
}

static inline double Distance(const double a[3], const double b[3])
{
  double r[3];

  Minus(a, b, r);
  return sqrt(Dot(r, r));
}

/* The place at a part s of the way from a to b. */
static inline void Between(const double a[3], const double b[3], double s, double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = (1 - s) * a[d] + s * b[d];
}
