/* One contact term: its gap, its state for the law, what the law says of it, and its tolerances. */
#include "contactimpl.h"
#include "mesh/mesh.h"

/* Two surfaces that are apart by no more than this fraction of the face size touch, whatever their curvature. */
#define CONTACT_TOUCH 1e-6

/* Penalties over the stiffness of the bodies, about, by which a pair fades. The automatic penalty is at most this many
   times the stiffness of elements. Another figure moves where in the step the force falls, and nothing else. */
#define PRESENCE_STIFF 100
/* Least factor on a penalty. The forces of pairs that are away are 0; their penalty is only kept from being 0, because
   linear steps divide by it. */
#define PRESENCE_LEAST 1e-9

/*@
  ContactTermAddedOverlap - returns the overlap that the scene adds at a term to that of the meshes (length).

  Not collective

  Input Parameters:
+ pair - the pair
. c    - the term
- t    - load parameter

  Note:
  Without t in its expression it grows in proportion to t.
@*/
PetscReal ContactTermAddedOverlap(const ContactPair *pair, PetscInt c, PetscReal t)
{
  const SceneContact *scene = pair->scene;
  const PetscReal     part  = ExpressionUses(scene->overlap_expression, EXPRESSION_T) ? 1 : t;
  PetscReal           X[3];

  if (scene->initial_overlap != OVERLAP_ADD) return 0;
  if (!scene->overlap_expression) return part * scene->added_overlap;
  ContactTermPlace(pair, c, X);
  return part * ExpressionValue(scene->overlap_expression, X, t);
}

/*@
  ContactTermOverlap - returns what is left at t of the gap that the surfaces had at a term before any load.

  Not collective

  Input Parameters:
+ pair - the pair
. c    - the term
- t    - load parameter

  Note:
  All of an ignored overlap is left, and a shrinking part of a ramped one (length). An overlap that the scene adds is a
  gap at which the surfaces touch.
@*/
PetscReal ContactTermOverlap(const ContactPair *pair, PetscInt c, PetscReal t)
{
  if (pair->scene->initial_overlap == OVERLAP_ADD) return ContactTermAddedOverlap(pair, c, t);
  return pair->now.offset[c] * (pair->scene->initial_overlap == OVERLAP_RAMP ? 1 - t : 1);
}

/*@
  ContactTermOffset - returns g_0 of a term: the gap at which it begins to press (length).

  Not collective

  Input Parameters:
+ pair - the pair
. c    - the term
- t    - load parameter

  Note:
  The terms of ends begin to press at a depth.
@*/
PetscReal ContactTermOffset(const ContactPair *pair, PetscInt c, PetscReal t)
{
  return ContactTermOverlap(pair, c, t) - ContactEndDepth(pair, c);
}

/*@
  ContactTermOnsetGap - returns the gap below which a term presses, with its whole penalty (length).

  Not collective

  Input Parameters:
+ pair - the pair
. c    - the term
- t    - load parameter

  Note:
  There the multiplier alone would press; the surfaces meet at the term's offset.
@*/
PetscReal ContactTermOnsetGap(const ContactPair *pair, PetscInt c, PetscReal t)
{
  const LawState state = ContactTermState(pair, c, t, PETSC_MAX_REAL);

  return LawOnsetGap(&state);
}

/*@
  ContactTermGap - returns the weighted gap of a term over its slave points with a gap, sum W f g / sum W f (length);
  NaN without any.

  Not collective

  Input Parameters:
+ pair      - the pair
. factor    - area factors f of the slave points
. point_gap - gaps g of the slave points, of ContactPointGaps()
- c         - the term

  Output Parameter:
. area - sum W f; may be NULL
@*/
PetscReal ContactTermGap(const ContactPair *pair, const PetscReal *factor, const PetscReal *point_gap, PetscInt c,
                         PetscReal *area)
{
  PetscReal sum = 0, total = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k] * factor[q];

    if (PetscIsNanReal(point_gap[q]) || weight == 0) continue;
    sum += weight * point_gap[q];
    total += weight;
  }
  if (area) *area = total;
  return total > 0 ? sum / total : NAN;
}

/*@
  ContactTermBound - returns how far a term in contact may be from its master, on either side (length); 0 where its
  pair is not augmented.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term
@*/
PetscReal ContactTermBound(const ContactPair *pair, PetscInt c)
{
  if (!pair->scene->augment) return 0;
  return pair->scene->g_max * (pair->scene->window_in_spacings ? pair->size[c] : 1);
}

/* Relative curvature of slave and master at a term (one over length). */
static PetscReal TermCurvature(const ContactPair *pair, PetscInt c)
{
  const PetscReal radius = pair->scene->analytic.radius;
  PetscReal       kappa  = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    kappa = PetscMax(kappa, pair->lists->kappa[pair->term_point[k]]);
  return kappa + 2 * pair->turn[c] / pair->size[c] + (radius > 0 ? 1 / radius : 0);
}

/* Size of the master's faces at a term (length). */
static PetscReal TermMasterSize(const ContactPair *pair, PetscInt c)
{
  PetscReal size = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    size = PetscMax(size, NeighbourListsNearestSize(pair->lists, pair->term_point[k]));
  return size;
}

/*@
  ContactTouchTolerance - returns the opening up to which a node counts as touching (length).

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term

  Note:
  It is what round-off and the sagitta of the facets leave between surfaces that touch.
@*/
PetscReal ContactTouchTolerance(const ContactPair *pair, PetscInt c)
{
  const PetscReal h = pair->size[c];

  return CONTACT_TOUCH * h + TermCurvature(pair, c) * (PetscSqr(h) + PetscSqr(TermMasterSize(pair, c))) / 8;
}

/*@
  ContactMeanOpening - returns the opening of a term of surface to surface contact whose node touches (length).

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term

  Note:
  It is the mean opening over the faces around the node, where the surfaces bend away from each other. Hat functions
  of width h weigh x^2 by h^2/6, so the mean of kappa x^2/2 is kappa h^2/12 for each direction. Half as much again is
  added for faces of unlike size. A body of revolution bends along the hoop too: at the axis, where the weights grow
with the radius, the mean is kappa h^2/12 times 1.8.
@*/
PetscReal ContactMeanOpening(const ContactPair *pair, PetscInt c)
{
  const int directions = pair->geometry == GEOMETRY_PLANE_STRAIN ? 1 : 2;

  return CONTACT_TOUCH * pair->size[c] + directions * TermCurvature(pair, c) * PetscSqr(pair->size[c]) / 8;
}

/*@
  ContactPairPresence - returns the part of a pair that is there, from 0 (away) to 1.

  Not collective

  Input Parameters:
+ pair - the pair
- t    - load parameter
@*/
PetscReal ContactPairPresence(const ContactPair *pair, PetscReal t)
{
  return pair->scene->presence.n ? HistoryValue(&pair->scene->presence, t) : 1;
}

/* Factor on the penalties of a pair of which a part p is there. The pair is a spring in series with its bodies. Its
   stiffness then is p / (1 - p) times theirs, so that its force falls evenly with p where the bodies do not follow. */
static PetscReal PresenceFactor(PetscReal p)
{
  return PetscMax(p / (p + (1 - p) * PRESENCE_STIFF), PRESENCE_LEAST);
}

/*@
  ContactTermStateIn - builds what the law is to know of a term in one of the pair's states. Nobody else builds a
  LawState.

  Not collective

  Input Parameters:
+ pair  - the pair
. c     - the term
. state - the pair's present or accepted state, which gives penalty and multiplier
. t     - load parameter of that state, for the offset and for the part of the pair that is there
- most  - largest penalty that counts (force per length and area): ContactTermMost() for energy, forces and tangent;
         PETSC_MAX_REAL for the penalty as it is
@*/
LawState ContactTermStateIn(const ContactPair *pair, PetscInt c, const ContactState *state, PetscReal t, PetscReal most)
{
  const PetscReal part = PresenceFactor(ContactPairPresence(pair, t));

  return (LawState){.penalty    = part * PetscMin(most, ContactTermPenalty(pair, c, state->penalty[c])),
                    .offset     = ContactTermOffset(pair, c, t),
                    .multiplier = state->multiplier[c] - (pair->carried ? pair->carried[c] : 0)};
}

/*@
  ContactTermMost - returns the largest penalty of a term that counts for energy, forces and tangent.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term

  Note:
  ContactSoften() may limit it.
@*/
PetscReal ContactTermMost(const ContactPair *pair, PetscInt c)
{
  return pair->predicted[c] ? pair->predicted_most : pair->most;
}

/*@
  ContactTermState - builds what the law is to know of a term in the present state, as ContactTermStateIn() does.

  Not collective

  Input Parameters:
+ pair - the pair
. c    - the term
. t    - load parameter
- most - largest penalty that counts (force per length and area)
@*/
LawState ContactTermState(const ContactPair *pair, PetscInt c, PetscReal t, PetscReal most)
{
  return ContactTermStateIn(pair, c, &pair->now, t, most);
}

/* Sets the law of an open term during a linear step. A term that was closed stays closed, with pressure or tension. A
   term that touches at the start of a run gets its stiffness, because the body may be held by contact alone. In surface
   to surface contact the mean gap over the faces around a touching node is positive because of their curvature. These
   terms also get the tension that closes their gap; with the stiffness alone they would hold the others open. */
static void TermHold(const ContactPair *pair, PetscInt c, const LawState *state, PetscReal gap, LawValue *value)
{
  const PetscBool closed = pair->held[c], means = (PetscBool)(pair->formulation.surface && pair->fit.fitted);
  const PetscReal opening = gap - LawOnsetGap(state);

  if (!closed && !(pair->touching && opening <= (means ? ContactMeanOpening(pair, c) : ContactTouchTolerance(pair, c))))
    return;
  value->stiffness = state->penalty;
  if (closed || pair->formulation.surface) value->pressure = -value->stiffness * opening;
}

/*@
  ContactTermLaw - evaluates the law for a term in the state of the last projection; in a linear step, what that step
  counts on.

  Not collective

  Input Parameters:
+ pair - the pair, projected
. c    - the term
- t    - load parameter

  Output Parameters:
+ value - potential, pressure and stiffness; zeros where no master is near
. gap   - the term's gap (length); may be NULL
- area  - its present area
@*/
void ContactTermLaw(const ContactPair *pair, PetscInt c, PetscReal t, LawValue *value, PetscReal *gap, PetscReal *area)
{
  const LawState  state = ContactTermState(pair, c, t, ContactTermMost(pair, c));
  const PetscReal found = ContactTermGap(pair, pair->factor, pair->point_gap, c, area);

  *value = (LawValue){0, 0, 0};
  if (gap) *gap = found;
  if (PetscIsNanReal(found) || ContactPairPresence(pair, t) == 0) return;
  pair->law->evaluate(found, &state, value);
  if (pair->holding && value->stiffness == 0) TermHold(pair, c, &state, found, value);
}

/*@
  ContactTermTurningPressure - returns the pressure whose turning with the surface counts in a tangent.

  Not collective

  Input Parameters:
+ pair  - the pair, projected
. c     - the term
. t     - load parameter
- value - what the law says of the term

  Notes:
  In a linear step this is the pressure of the accepted state, or of the solution at which the step begins, not what
  pulls a term to its place. The state before any load is in no equilibrium: its overlaps pull, and their pressure grows
  with the penalty until the tangent is indefinite. It therefore counts for nothing there.

  A linear step along a curved way leaves its surfaces off each other by the square of its length. A stiff penalty makes
  pressures of this that are several times those at equilibrium, and the tangent would be indefinite. The pressure that
  the linear step was to lead to has no such part. At a solution both are the same; on the way the lower one counts.
@*/
PetscReal ContactTermTurningPressure(const ContactPair *pair, PetscInt c, PetscReal t, const LawValue *value)
{
  const ContactState *accepted = &pair->accepted;
  LawState            before;

  if (!pair->holding)
    return PetscIsNanReal(pair->foreseen[c]) ? value->pressure : PetscMin(value->pressure, pair->foreseen[c]);
  if (pair->solved) return pair->balanced[c];
  if (pair->touching || accepted->status[c] != CONTACT_CLOSED) return 0;
  before = ContactTermStateIn(pair, c, accepted, t, PETSC_MAX_REAL);
  return PetscMax(0, before.multiplier + before.penalty * (before.offset - accepted->gap[c]));
}

/*@
  ContactTermForce - returns the force that a term's own gap of the last projection causes.

  Not collective

  Input Parameters:
+ pair - the pair, after ContactResidual() with forces
- c    - the term

  Note:
  In surface to surface contact this is not the nodal force. Most of the nodal force may come from the neighbours,
  whose pressures act on the faces that they share with the node.
@*/
PetscReal ContactTermForce(const ContactPair *pair, PetscInt c)
{
  LawValue  value;
  PetscReal area;

  if (!pair->formulation.surface) return pair->force[c];
  ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
  return value.pressure * area;
}

/*@
  ContactTermPress - adds the forces of a term's pressure to all of its slave points.

  Not collective

  Input Parameters:
+ pair     - the pair
. c        - the term
- pressure - force per area; 0 adds nothing

  Input/Output Parameter:
. point_force - of each slave point
@*/
void ContactTermPress(const ContactPair *pair, PetscInt c, PetscReal pressure, PetscReal *point_force)
{
  if (pressure == 0) return;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    point_force[pair->term_point[k]] += pressure * pair->term_weight[k] * pair->factor[pair->term_point[k]];
}
