#include "contactedge.h"
#include <math.h>

/*
  ContactEdge - Coordinate at which contact ends along a line of nodes. Plain C, not collective.

  Input: n nodes, x[n] ascending coordinates (length), p[n] nodal pressures (p > 0: loaded), max_side (1: the end at large x, 0: at small x).
  Output: spacing (length) between the last loaded and the next open node: the resolution of the answer.
  Source: Hertz's pressure is p_0 sqrt(1 - (x/a)^2) (Johnson, "Contact Mechanics", ch. 4), so p^2 has a simple zero at the edge.
*/
double ContactEdge(int n, const double *x, const double *p, int max_side, double *spacing)
{
  const int outward = max_side ? 1 : -1, end = max_side ? n - 1 : 0;
  int       last = end, inner, open;
  double    fall;

  *spacing = NAN;
  while (last >= 0 && last < n && !(p[last] > 0.0)) last -= outward;
  if (last < 0 || last >= n) return NAN;
  *spacing = 0.0;
  if (last == end) return x[last];
  open     = last + outward;
  inner    = last - outward;
  *spacing = fabs(x[open] - x[last]);
  if (inner < 0 || inner >= n || !(p[inner] > 0.0)) return 0.5 * (x[last] + x[open]);
  fall = p[inner] * p[inner] - p[last] * p[last];
  if (!(fall > 0.0)) return x[open];
  return x[last] + outward * fmin(*spacing, p[last] * p[last] / fall * fabs(x[last] - x[inner]));
}
