/* The penalty parameter of one slave node: its automatic start value, and how it follows the penetration (Chamoret et
   al. 2004, section 3). Plain C.

   PenaltyAutomatic() once for each pair, PenaltyMakeRule() once for each node, PenaltyAdjust() after each converged
   solve. */
#pragma once

/* Nodes below this share of the largest nodal force do not count as loaded: at the border of a contact zone forces go
   to zero, and penalties that followed them would go to zero too. */
#define PENALTY_LOADED 1e-3
/* Where an update aims that is followed by another solve of the same step: inside the window, as forces move a little
   when penalties do and an update that aims at the edge approaches it from outside. Parts of g_max and multiples of
   g_min. */
#define PENALTY_AIM_HIGH 0.6
#define PENALTY_AIM_LOW  1.6
/* An update that aims at the edge lands there but for round-off, which is not outside. */
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
  int           light;   /* below the window and spared, as it is not loaded */
} PenaltyUpdate;

double      PenaltyAutomatic(double slave, double master);
PenaltyRule PenaltyMakeRule(double g_min, double g_max, int inside, double clamp, double automatic, double range);
void        PenaltyAdjust(const PenaltyRule *, double penetration, double share, double penalty, PenaltyUpdate *);
