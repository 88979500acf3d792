/* The penalty parameter of one slave node: its automatic value, and how it follows the penetration. */
#include "penaltyrule.h"
#include <math.h>

/*@
  PenaltyAutomatic - computes the automatic penalty of a pair, which is the stiffness of its softer side (force per
  length and area).

  Not collective

  Input Parameters:
+ slave  - E over the height of the elements below the surface, area-weighted mean
- master - the same of the master; 0 for a rigid side

  Note:
  The penalty spring is in series with the layer of elements on either side. Measured against the softer one, it
  neither dominates the conditioning nor lets bodies of unlike stiffness sink into each other. Plain C.
@*/
double PenaltyAutomatic(double slave, double master)
{
  if (master <= 0) return slave;
  return slave < master ? slave : master;
}

/*@
  PenaltyMakeRule - makes the rule for a node from its window and the pair's bounds.

  Not collective

  Input Parameters:
+ g_min     - smallest penetration of the window (length)
. g_max     - largest one (length), above g_min
. inside    - updates aim inside the window; else at its edges, which is eq. 16 of Chamoret et al. (2004) to the
              letter
. clamp     - largest factor of one update, above 1
. automatic - automatic penalty (force per length and area)
- range     - largest factor away from it, above 1

  Note:
  Plain C.
@*/
PenaltyRule PenaltyMakeRule(double g_min, double g_max, int inside, double clamp, double automatic, double range)
{
  const double middle = sqrt(g_min * g_max); /* of a narrow window, which has no room for two aims */
  const double edge   = inside ? 0 : PENALTY_EDGE;

  return (PenaltyRule){.g_min = g_min * (1 - edge),
                       .g_max = g_max * (1 + edge),
                       .low   = inside ? fmin(PENALTY_AIM_LOW * g_min, middle) : g_min,
                       .high  = inside ? fmax(PENALTY_AIM_HIGH * g_max, middle) : g_max,
                       .clamp = clamp,
                       .least = automatic / range,
                       .most  = automatic * range};
}

/*@
  PenaltyAdjust - computes a node's next penalty from its penetration after a converged solve, eq. 16 of Chamoret et
  al. (2004).

  Not collective

  Input Parameters:
+ rule        - window and guards, from PenaltyMakeRule()
. penetration - of the node (length), 0 at rest; negative: apart, which says nothing of its penalty
. share       - the node's force over the largest nodal force
- penalty     - present penalty (force per length and area)

  Output Parameter:
. update - next penalty, and why

  Note:
  A node that is not loaded is never lowered, as its penalty would follow a force that goes to zero. Beyond g_max
  every node is raised. A penalty that starts beyond its bounds is not moved farther out. Plain C.
@*/
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
