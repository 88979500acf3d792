#include "contact/contactedge.h"
#include <math.h>

/* Nodes from the one that moments are taken about to the last loaded one, and between the two they are taken about:
   nearer to the edge the answer jumps as nodes come into contact, farther from it the pressure is no root. */
enum { NODES_BEYOND = 2, NODES_APART = 2 };
/* A root p = c sqrt(d - y) from y = 0 to d has the moment 4/15 c d^(5/2) about y = 0. */
#define POWER_OF_MOMENT 2.5

/* Nodes in a row inwards from the node `last` over which the pressure rises, in the outer half of the zone, or all of
   it where it ends with the line: there may be a plane of symmetry */
static int RisingNodes(int n, const double *p, int last, int outward)
{
  int loaded = 0, rising = 0, most, node = last - outward;

  for (; node >= 0 && node < n && p[node] > 0.0; node -= outward) {
    rising += rising == loaded && p[node] > p[node + outward];
    loaded++;
  }
  most = node < 0 || node == n ? loaded : (loaded + 1) / 2;
  return rising < most ? rising : most;
}

/* Moment about node k of the forces from there to the node `last`: pressures times half the lengths to the neighbours
 */
static double MomentAbout(int k, const double *x, const double *p, int last, int outward)
{
  double moment = 0.0;

  for (int i = k; i != last; i += outward)
    moment += p[i + outward] * 0.5 * fabs(x[i + 2 * outward] - x[i]) * fabs(x[i + outward] - x[k]);
  return moment;
}

/* Distance from the node `last` to the zero of the root through its pressure and its inner neighbour's; infinite where
 * none falls so */
static double RootOfPressures(const double *x, const double *p, int last, int inner)
{
  const double fall = p[inner] * p[inner] - p[last] * p[last];

  return fall > 0.0 ? p[last] * p[last] / fall * fabs(x[last] - x[inner]) : INFINITY;
}

/* Distance from the node `last` to the end of the root with the moments of the nodal forces about two nodes farther in
 */
static double RootOfMoments(const double *x, const double *p, int last, int near, int far, int outward)
{
  const double ratio =
    pow(MomentAbout(far, x, p, last, outward) / MomentAbout(near, x, p, last, outward), 1 / POWER_OF_MOMENT);

  return fabs(x[near] - x[far]) / (ratio - 1) - fabs(x[last] - x[near]);
}

/*
  ContactEdge - Coordinate at which contact ends along a line of nodes. Plain C, not collective.

  Input: what loaded nodes say; n nodes, x[n] ascending coordinates (length), p[n] nodal pressures (p > 0: loaded),
  max_side (1: the end at large x, 0: at small x). Output: spacing (length) between the last loaded and the next open
  node: the resolution of the answer. Source: Hertz's pressure is p_0 sqrt(1 - (x/a)^2) (Johnson, "Contact Mechanics",
  ch. 4), near its edge the root of the distance d. Forces at nodes keep the moment that the pressure beyond a node has
  about it, where functions linear between nodes carry it; a root's goes as d^(5/2): two of them give d.
*/
double ContactEdge(EdgeReach reach, int n, const double *x, const double *p, int max_side, double *spacing)
{
  const int outward = max_side ? 1 : -1, end = max_side ? n - 1 : 0;
  int       last = end, rising, near, far;
  double    beyond, least; /* of the last loaded node */

  *spacing = NAN;
  while (last >= 0 && last < n && !(p[last] > 0.0)) last -= outward;
  if (last < 0 || last >= n) return NAN;
  *spacing = 0.0;
  if (last == end) return x[last];
  *spacing = fabs(x[last + outward] - x[last]);
  if (last == n - 1 - end || !(p[last - outward] > 0.0)) return 0.5 * (x[last] + x[last + outward]);
  rising = RisingNodes(n, p, last, outward);
  near   = last - outward * (rising > NODES_BEYOND ? NODES_BEYOND : 1);
  far    = last - outward * (rising < NODES_BEYOND + NODES_APART ? rising : NODES_BEYOND + NODES_APART);
  beyond = rising < 2 ? RootOfPressures(x, p, last, near) : RootOfMoments(x, p, last, near, far, outward);
  least  = reach == EDGE_AT_NODES ? 0.0 : -fabs(x[last] - x[last - outward]);
  return x[last] + outward * fmax(least, fmin(*spacing, beyond));
}
