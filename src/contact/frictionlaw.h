/* Coulomb's law of friction at one slave node: from slip, direction of contact and pressure to the traction, with all
   its derivatives. Plain C.

   A node's slip v is the weighted sum over its slave points of their distances to where they were on the master when
   the step began. Only its part in the tangent plane counts, with P = I - n n^T and n the unit vector along `normal`.
   What the traction was when the step began is kept as two components of a length, along two tangents that turn with
   the master's material: t_1 along P along, t_2 = n x t_1. So a rigid motion of both bodies together changes nothing.
   With augmentation a multiplier, the grip, has two components in the same way: the traction without elastic slip.
       e = beta (kept_1 t_1 + kept_2 t_2 + P v + grip/stiffness)

       t = stiffness e      as long as |t| <= b(p): the node sticks
       t = b(p) e/|e|       else: it slips

   with the bound b = cohesion + mu p, or the limit where that is less. mu may depend on p. Without pressure b is 0.
   Where a fluid presses in the place of contact but does not come between the surfaces, its pressure counts in p there.
   beta is 1 where the node was in contact when the step began. Else slip counts from the touch only: beta =
   depth/(depth + began) with depth = p/stiffness. So far the node would have gone on without contact, were the surface
   as stiff across as it is along. Near the touch t = p v/began: a node that arrives within the cone of friction sticks,
   any other one slips, whatever the penalty. In two dimensions all third components are 0.

   Sources: Wriggers, Computational Contact Mechanics, 2006, ch. 5 and 10 (return map); Chamoret et al. (2004), eq. 17
   (beta, of a predicted penetration). */
#pragma once

/* What decides between sticking and slipping: the traction, or the caller. */
typedef enum { FRICTION_DECIDES, FRICTION_STICKS, FRICTION_SLIPS } FrictionState;

typedef struct {
  double coefficient; /* mu */
  double steepness;   /* dmu/dp (1 over a stress) */
  double cohesion;    /* force per area */
  double limit;       /* force per area; 0: there is none */
  double stiffness;   /* force per length of elastic slip and area */
  double normal[3];   /* of any length but 0 */
  double slip[3];     /* v (length) */
  double along[3];    /* not along the normal; of any length but 0 */
  double kept[2];     /* lengths */
  double grip[2];     /* force per area; 0 without augmentation */
  double pressure;    /* p; none below 0 counts, unless the caller has it slip: in a linear step p is signed */
  double fluid;       /* pressure of a fluid that is to be counted as one of contact, beside p */
  double expected;    /* pressure that resists turns of the slip where p is not positive and the caller has it slip */
  double rate;        /* -dp/dgap: force per length and area */
  double began;       /* gap less the gap below which there is pressure when the step began, where the node was
                         open then; else 0 (length) */
  FrictionState state;
} FrictionInput;

typedef struct {
  double        traction[3]; /* t, along the slip; the force on the slave is its negative (force per area) */
  FrictionState state;       /* FRICTION_STICKS or FRICTION_SLIPS */
  double        elastic;     /* elastic slip: the length of (t - grip)/stiffness */
  double        slipped;     /* what is left of the length of e: slip that stays (length) */
  double        by_normal[3][3], by_slip[3][3], by_along[3][3], by_gap[3]; /* derivatives of the traction */
  double        by_stiffness[3]; /* derivative of the traction by the logarithm of the stiffness */
} FrictionTraction;

void   FrictionComponents(const double normal[3], const double along[3], const double v[3], double component[2]);
double FrictionBound(const FrictionInput *, double pressure);
double FrictionCountedShare(const FrictionInput *, double pressure);
void   FrictionEvaluate(const FrictionInput *, FrictionTraction *);
