/* Gap and variations against a rigid plane, cylinder or sphere.

   P is the projection normal to the axis of a cylinder; for a sphere P = 1. With r = P x, n = r/|r| and s = 1 outside,
   s = -1 inside:
       g = s (|r| - R),   N = s n,   M = s (P - n n^T)/|r|
   For a plane g = n.x, N = n, M = 0.

   Stiff penalties turn what rounding leaves of a gap into forces. So x = X + u is not formed for the gap, as it would
   round u to the digits of X. With R_0 = P X it is |r| - R = (|R_0| - R) + (2 R_0 + P u).u/(|r| + |R_0|). */
#include "smooth/analyticsurface.h"
#include <math.h>
#include <string.h>

static double VectorLength(const double a[3])
{
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double Product(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void EvaluatePlane(const double X[3], const double u[3], const double axis[3], AnalyticResult *out)
{
  out->curvature = 0;
  out->gap       = Product(axis, X) + Product(axis, u);
  for (int c = 0; c < 3; c++) out->normal[c] = axis[c];
}

static int EvaluateRound(const AnalyticSurface *master, int dim, const double X[3], const double u[3],
                         const double axis[3], AnalyticResult *out)
{
  const double side = master->inside ? -1 : 1;
  double       P[3][3], first[3] = {0}, r[3] = {0}, both[3], length, before;

  for (int c = 0; c < 3; c++) {
    for (int d = 0; d < 3; d++) {
      P[c][d] = (c == d) - (master->shape == ANALYTIC_CYLINDER ? axis[c] * axis[d] : 0);
      first[c] += P[c][d] * X[d];
      r[c] += P[c][d] * (X[d] + u[d]);
    }
  }
  length = VectorLength(r);
  before = VectorLength(first);
  if (!(length > ANALYTIC_CENTRE * master->radius)) return 0;
  for (int c = 0; c < 3; c++) both[c] = first[c] + r[c];
  out->gap       = side * ((before - master->radius) + Product(both, u) / (length + before));
  out->curvature = 1 / master->radius;
  for (int c = 0; c < 3; c++) out->normal[c] = side * r[c] / length;
  for (int c = 0; c < dim; c++) {
    for (int d = 0; d < dim; d++) out->M[c * dim + d] = side * (P[c][d] - out->normal[c] * out->normal[d]) / length;
  }
  return 1;
}

/*@
  AnalyticSurfaceEvaluate - computes the gap of a slave point to a rigid plane, cylinder or sphere, with first and
  second variation.

  Not collective

  Input Parameters:
+ master - shape of the rigid body
. dim    - 2 or 3
. X      - reference position of the slave point relative to the master's point (length), X[dim]; that point lies on the
           plane, on the cylinder's axis, or is the sphere's centre
- u      - displacement of the slave point (length), u[dim]

  Output Parameter:
. out - gap, normal, N[dim], M[dim*dim] and curvature

  Note:
  Returns 0, with nothing valid in out, on the axis of a cylinder, at the centre of a sphere, or where the axis has no
  length. Plain C.
@*/
int AnalyticSurfaceEvaluate(const AnalyticSurface *master, int dim, const double *X, const double *u,
                            AnalyticResult *out)
{
  const double length      = VectorLength(master->axis);
  double       position[3] = {0}, displacement[3] = {0}, axis[3];

  memset(out, 0, sizeof(*out));
  if (master->shape != ANALYTIC_SPHERE && !(length > 0)) return 0;
  for (int c = 0; c < 3; c++) axis[c] = length > 0 ? master->axis[c] / length : 0;
  memcpy(position, X, dim * sizeof(double));
  memcpy(displacement, u, dim * sizeof(double));
  if (master->shape == ANALYTIC_PLANE)
    EvaluatePlane(position, displacement, axis, out);
  else if (!EvaluateRound(master, dim, position, displacement, axis, out))
    return 0;
  memcpy(out->N, out->normal, dim * sizeof(double));
  return 1;
}
