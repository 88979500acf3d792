#include "contactedge.h"
#include <math.h>

/* A root p = c sqrt(d - y) from y = 0 to d has its force at 2/5 d. */
#define EDGE_OF_CENTROID 2.5

/* Distance from the node `inner` to the zero of the root with the force and moment of the linear functions over the two intervals beyond it */
static double RootOfMoments(double inner, double last, double first_width, double second_width)
{
  const double force  = 0.5 * (first_width * (inner + last) + second_width * last);
  const double moment = first_width * first_width * (inner + 2 * last) / 6 + second_width * last * (first_width / 2 + second_width / 6);

  return EDGE_OF_CENTROID * moment / force;
}

/*
  ContactEdge - Coordinate at which contact ends along a line of nodes. Plain C, not collective.

  Input: what the pressures are; n nodes, x[n] ascending coordinates (length), p[n] nodal pressures (p > 0: loaded), max_side (1: the end at large x, 0: at
  small x).
  Output: spacing (length) between the last loaded and the next open node: the resolution of the answer.
  Source: Hertz's pressure is p_0 sqrt(1 - (x/a)^2) (Johnson, "Contact Mechanics", ch. 4), so p^2 has a simple zero at the edge.
*/
double ContactEdge(EdgePressures pressures, int n, const double *x, const double *p, int max_side, double *spacing)
{
  const int outward = max_side ? 1 : -1, end = max_side ? n - 1 : 0;
  int       last = end, inner, open;
  double    fall, width;

  *spacing = NAN;
  while (last >= 0 && last < n && !(p[last] > 0.0)) last -= outward;
  if (last < 0 || last >= n) return NAN;
  *spacing = 0.0;
  if (last == end) return x[last];
  open     = last + outward;
  inner    = last - outward;
  *spacing = fabs(x[open] - x[last]);
  if (inner < 0 || inner >= n || !(p[inner] > 0.0)) return 0.5 * (x[last] + x[open]);
  width = fabs(x[last] - x[inner]);
  if (pressures == EDGE_OF_HATS) return x[inner] + outward * fmin(width + *spacing, RootOfMoments(p[inner], p[last], width, *spacing));
  fall = p[inner] * p[inner] - p[last] * p[last];
  if (!(fall > 0.0)) return x[open];
  return x[last] + outward * fmin(*spacing, p[last] * p[last] / fall * width);
}
