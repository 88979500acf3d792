#include "penaltylaw.h"
#include <math.h>

/* PenaltyAutomatic - stiffness (force per length and area) of the softer side of a pair. Not collective.

   slave, master: E over the height of the elements below the surface, area-weighted mean; 0 for a rigid side. The
   penalty spring is in series with the layer of elements on either side; measured against the softer one it neither
   dominates the conditioning nor lets bodies of unlike stiffness sink into each other. */
double PenaltyAutomatic(double slave, double master)
{
  if (master <= 0) return slave;
  return slave < master ? slave : master;
}

/* PenaltyMakeRule - the rule for a node of that window. Not collective.

   g_min < g_max: window (length); inside: updates aim inside the window, else at its edges, which is eq. 16 to the
   letter; clamp > 1: largest factor of one update; automatic: automatic penalty (force per length and area); range > 1:
   largest factor away from it. */
PenaltyRule PenaltyMakeRule(double g_min, double g_max, int inside, double clamp, double automatic, double range)
{
  const double middle = sqrt(g_min * g_max); /* a narrow window has no room for two aims */
  const double edge   = inside ? 0 : PENALTY_EDGE;

  return (PenaltyRule){.g_min = g_min * (1 - edge),
                       .g_max = g_max * (1 + edge),
                       .low   = inside ? fmin(PENALTY_AIM_LOW * g_min, middle) : g_min,
                       .high  = inside ? fmax(PENALTY_AIM_HIGH * g_max, middle) : g_max,
                       .clamp = clamp,
                       .least = automatic / range,
                       .most  = automatic * range};
}

/* PenaltyAdjust - the penalty of a node after a converged solve. Not collective.

   penetration: |g| (length), 0 at rest; negative (apart): the node says nothing of its penalty. share: the node's force
   over the largest nodal force. A node that is not loaded is never lowered: it would follow a force that goes to zero;
   beyond g_max every node is raised. A penalty that starts beyond its bounds is not moved farther out. Source: Chamoret
   et al. 2004, eq. 16. */
void PenaltyAdjust(const PenaltyRule *rule, double penetration, double share, double penalty, PenaltyUpdate *update)
{
  double factor, wanted;

  *update       = (PenaltyUpdate){.penalty = penalty};
  update->light = penetration > 0 && penetration < rule->g_min && share < PENALTY_LOADED;
  if (penetration > rule->g_max)
    update->outside = 1;
  else if (penetration >= 0 && penetration < rule->g_min && share >= PENALTY_LOADED)
    update->outside = -1;
  else
    return;
  factor = penetration / (update->outside > 0 ? rule->high : rule->low);
  wanted = fmax(1 / rule->clamp, fmin(rule->clamp, factor)) * penalty;
  update->penalty =
    update->outside > 0 ? fmin(wanted, fmax(rule->most, penalty)) : fmax(wanted, fmin(rule->least, penalty));
  update->clamped = update->penalty != factor * penalty;
  if (update->penalty != penalty) update->change = update->penalty > penalty ? PENALTY_RAISED : PENALTY_LOWERED;
}
