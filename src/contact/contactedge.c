/* The end of contact along a line of nodes, from their pressures. */
#include "contact/contactedge.h"
#include <math.h>

/* Moments are taken about two nodes. The nearer one is NODES_BEYOND nodes inside the last loaded node, the other one
   NODES_APART nodes farther inside. Nearer to the edge the result jumps when a node comes into contact. Farther from
   the edge the pressure is no longer a square root of the distance. */
enum { NODES_BEYOND = 2, NODES_APART = 2 };

/* The pressure p = c sqrt(d - y) between y = 0 and d has the moment 4/15 c d^(5/2) about y = 0. This is the power
   of d. */
#define POWER_OF_MOMENT 2.5

/* Counts nodes in a row, inwards from the node `last`, over which the pressure rises. It looks at the outer half of
   the zone, or at all of it where the zone ends with the line, as a plane of symmetry may be there. */
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

/* Moment about node k of the forces from there to the node `last`; a force is a pressure times half the lengths to
   the neighbours. */
static double MomentAbout(int k, const double *x, const double *p, int last, int outward)
{
  double moment = 0.0;

  for (int i = k; i != last; i += outward)
    moment += p[i + outward] * 0.5 * fabs(x[i + 2 * outward] - x[i]) * fabs(x[i + outward] - x[k]);
  return moment;
}

/* Distance from the node `last` to the zero of the root through its pressure and its inner neighbour's; infinite
   where the pressure does not fall. */
static double RootOfPressures(const double *x, const double *p, int last, int inner)
{
  const double fall = p[inner] * p[inner] - p[last] * p[last];

  return fall > 0.0 ? p[last] * p[last] / fall * fabs(x[last] - x[inner]) : INFINITY;
}

/* Distance from the node `last` to the end of the root whose moments about two nodes farther in are those of the
   nodal forces. */
static double RootOfMoments(const double *x, const double *p, int last, int near, int far, int outward)
{
  const double ratio =
    pow(MomentAbout(far, x, p, last, outward) / MomentAbout(near, x, p, last, outward), 1 / POWER_OF_MOMENT);

  return fabs(x[near] - x[far]) / (ratio - 1) - fabs(x[last] - x[near]);
}

/*@
  ContactEdge - finds the coordinate at which contact ends along a line of nodes.

  Not collective

  Input Parameters:
+ reach    - what a loaded node says of the contact around it
. n        - number of nodes
. x        - ascending coordinates, x[n] (length)
. p        - nodal pressures, p[n], normal force over area; a node is loaded where p > 0
- max_side - 1: the end at large x; 0: at small x

  Output Parameter:
. spacing - distance of the last loaded and the open node (length), which is the resolution of the answer; 0 at the
            line's end

  Notes:
  Hertz's pressure is p_0 sqrt(1 - (x/a)^2) (Johnson, "Contact Mechanics", ch. 4), which near its edge is the root of
  the distance d. Forces at nodes keep the moment that the pressure beyond a node has about it, where functions that
  are linear between nodes carry it. The moment of a root is proportional to d^(5/2), so two moments give d. Where
  only one node falls, as in a shell whose highest pressure is at the edge, the root through two pressures serves. The
  next open node bounds the answer.

  The answer is half way to the open node where only one node is loaded, the last node of the line where that is
  loaded, and NaN where no node is. Plain C.
@*/
double ContactEdge(EdgeReach reach, int n, const double *x, const double *p, int max_side, double *spacing)
{
  const int outward = max_side ? 1 : -1, end = max_side ? n - 1 : 0;
  int       last = end, rising, near, far;
  double    beyond, least; /* distances past the last loaded node */

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
