/* Gap and variations against a rigid plane, cylinder or sphere.

   P is the projection normal to the axis of a cylinder; for a sphere P = 1. With r = P x, n = r/|r| and s = 1 outside,
   s = -1 inside:
       g = s (|r| - R),   N = s n,   M = s (P - n n^T)/|r|
   For a plane g = n.x, N = n, M = 0. */
#include "smooth/analyticsurface.h"
#include <math.h>
#include <string.h>

static double VectorLength(const double a[3])
{
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static void EvaluatePlane(const double x[3], const double axis[3], AnalyticResult *out)
{
  out->curvature = 0;
  out->gap       = 0;
  for (int c = 0; c < 3; c++) {
    out->normal[c] = axis[c];
    out->gap += axis[c] * x[c];
  }
}

static int EvaluateRound(const AnalyticSurface *master, int dim, const double x[3], const double axis[3],
                         AnalyticResult *out)
{
  const double side = master->inside ? -1 : 1;
  double       P[3][3], r[3] = {0}, length;

  for (int c = 0; c < 3; c++) {
    for (int d = 0; d < 3; d++) {
      P[c][d] = (c == d) - (master->shape == ANALYTIC_CYLINDER ? axis[c] * axis[d] : 0);
      r[c] += P[c][d] * x[d];
    }
  }
  length = VectorLength(r);
  if (!(length > ANALYTIC_CENTRE * master->radius)) return 0;
  out->gap       = side * (length - master->radius);
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
- x      - position of the slave point relative to the master's point (length), x[dim]; that point lies on the plane, on
           the cylinder's axis, or is the sphere's centre

  Output Parameter:
. out - gap, normal, N[dim], M[dim*dim] and curvature

  Note:
  Returns 0, with nothing valid in out, on the axis of a cylinder, at the centre of a sphere, or where the axis has no
  length. Plain C.
@*/
int AnalyticSurfaceEvaluate(const AnalyticSurface *master, int dim, const double *x, AnalyticResult *out)
{
  const double length      = VectorLength(master->axis);
  double       position[3] = {0}, axis[3];

  memset(out, 0, sizeof(*out));
  if (master->shape != ANALYTIC_SPHERE && !(length > 0)) return 0;
  for (int c = 0; c < 3; c++) axis[c] = length > 0 ? master->axis[c] / length : 0;
  memcpy(position, x, dim * sizeof(double));
  if (master->shape == ANALYTIC_PLANE)
    EvaluatePlane(position, axis, out);
  else if (!EvaluateRound(master, dim, position, axis, out))
    return 0;
  memcpy(out->N, out->normal, dim * sizeof(double));
  return 1;
}
