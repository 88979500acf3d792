/* The penalty parameter of one slave node: its automatic start value, and how it follows the penetration (Chamoret et
   al. 2004, section 3). Plain C.

   PenaltyAutomatic() is called once for each pair, PenaltyMakeRule() once for each node, PenaltyAdjust() after each
   converged solve. */
#pragma once

/* Nodes below this share of the largest nodal force do not count as loaded. At the border of a contact zone forces go
   to zero, and penalties that followed them would go to zero too. */
#define PENALTY_LOADED 1e-3
/* An update that is followed by another solve of the same step aims inside the window, from above at this part of
   g_max. Forces change a little when penalties do, so that an update that aims at the edge approaches it from outside.
 */
#define PENALTY_AIM_HIGH 0.6
/* The same from below: multiple of g_min. */
#define PENALTY_AIM_LOW 1.6
/* An update that aims at the edge lands there within round-off, which is not outside the window: part of g_min and
 * g_max. */
#define PENALTY_EDGE 1e-9

typedef struct {
  double g_min, g_max; /* window of the penetration (length) */
  double low, high;    /* where an update aims from below and from above (length) */
  double clamp;        /* the largest factor of one update, and one over the smallest */
  double least, most;  /* bounds of the penalty (force per length and area) */
} PenaltyRule;

typedef enum { PENALTY_KEPT, PENALTY_RAISED, PENALTY_LOWERED } PenaltyChange;

typedef struct {
  double        penalty;
  PenaltyChange change;
  int           outside; /* of the window, on a side that binds this node: -1 below, 1 above, 0 not */
  int           clamped; /* the factor or a bound cut the update short */
  int           light;   /* below the window, and left as it is because it is not loaded */
} PenaltyUpdate;

double      PenaltyAutomatic(double slave, double master);
PenaltyRule PenaltyMakeRule(double g_min, double g_max, int inside, double clamp, double automatic, double range);
void        PenaltyAdjust(const PenaltyRule *, double penetration, double share, double penalty, PenaltyUpdate *);
