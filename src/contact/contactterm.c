/* One contact term: its gap, its state for the law, what the law says of it, and its tolerances. */
#include "contactimpl.h"

/* Touching start: a gap within this fraction of the face size is no gap, whatever the curvature. */
#define CONTACT_TOUCH 1e-6

/* What is left at t of the gap that the surfaces had before any load: all of an ignored overlap, a shrinking part of a
 * ramped one. */
PetscReal ContactTermOffset(const ContactPair *pair, PetscInt c, PetscReal t)
{
  return pair->now.offset[c] * (pair->scene->initial_overlap == OVERLAP_RAMP ? 1 - t : 1);
}

/* The gap below which a term presses: where it would have its multiplier's pressure, the surfaces meet at its offset.
 */
PetscReal ContactTermOnsetGap(const ContactPair *pair, PetscInt c, PetscReal t)
{
  const LawState state = ContactTermState(pair, c, t, PETSC_MAX_REAL);

  return LawOnsetGap(&state);
}

/* ContactTermGap - the weighted gap sum W f g / sum W f (length) of a term over its points with a gap; NaN without any.

   Not collective. factor, point_gap[n_slaves]: of ContactPointGaps(). *area: sum W f, or NULL. */
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

/* ContactTermBound - how far a term in contact may be from its master, on either side (length); 0 where its pair is not
 * augmented. Not collective. */
PetscReal ContactTermBound(const ContactPair *pair, PetscInt c)
{
  if (!pair->scene->augment) return 0;
  return pair->scene->g_max * (pair->scene->window_in_spacings ? pair->size[c] : 1);
}

/* Relative curvature of slave and master at a term. */
static PetscReal TermCurvature(const ContactPair *pair, PetscInt c)
{
  const PetscReal radius = pair->scene->analytic.radius;
  PetscReal       kappa  = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    kappa = PetscMax(kappa, pair->lists->kappa[pair->term_point[k]]);
  return kappa + 2 * pair->turn[c] / pair->size[c] + (radius > 0 ? 1 / radius : 0);
}

/* Size of the master's faces at a term. */
static PetscReal TermMasterSize(const ContactPair *pair, PetscInt c)
{
  PetscReal size = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    size = PetscMax(size, NeighbourListsNearestSize(pair->lists, pair->term_point[k]));
  return size;
}

/* Opening up to which a node counts as touching: what round-off and the facets' own sagitta leave between surfaces that
 * touch. */
PetscReal ContactTouchTolerance(const ContactPair *pair, PetscInt c)
{
  const PetscReal h = pair->size[c];

  return CONTACT_TOUCH * h + TermCurvature(pair, c) * (PetscSqr(h) + PetscSqr(TermMasterSize(pair, c))) / 8;
}

/* Opening of a term of surface contact whose node touches: the mean over the faces around it, where the surfaces bend
   away from each other. Hat functions of width h weigh x^2 by h^2/6, so the mean of kappa x^2/2 is kappa h^2/12 for
   each direction; half as much again for faces of unlike size. */
PetscReal ContactMeanOpening(const ContactPair *pair, PetscInt c)
{
  return CONTACT_TOUCH * pair->size[c] + (pair->mesh->dim - 1) * TermCurvature(pair, c) * PetscSqr(pair->size[c]) / 8;
}

/* What the law is to know of a term. */
LawState ContactTermState(const ContactPair *pair, PetscInt c, PetscReal t, PetscReal most)
{
  return (LawState){.penalty    = PetscMin(most, pair->now.penalty[c]),
                    .offset     = ContactTermOffset(pair, c, t),
                    .multiplier = pair->now.multiplier[c]};
}

/* What a linear step counts on of an open term: what was closed stays so, pressed or pulled; what touches at the start
   of a run resists, for a body that only contact holds. In surface contact the mean over the faces around a node that
   touches is open by their curvature: such terms are pulled, all of them, as those that only resist would hold the
   others open. */
static void TermHold(const ContactPair *pair, PetscInt c, const LawState *state, PetscReal gap, LawValue *value)
{
  const PetscBool closed = pair->held[c], means = (PetscBool)(pair->formulation.surface && pair->fit.fitted);
  const PetscReal opening = gap - LawOnsetGap(state);

  if (!closed && !(pair->touching && opening <= (means ? ContactMeanOpening(pair, c) : ContactTouchTolerance(pair, c))))
    return;
  value->stiffness = state->penalty;
  if (closed || pair->formulation.surface) value->pressure = -value->stiffness * opening;
}

/* ContactTermLaw - law, gap (length; may be NULL) and area of a term in the state of the last projection; in a linear
 * step what it counts on. Not collective.
 */
void ContactTermLaw(const ContactPair *pair, PetscInt c, PetscReal t, LawValue *value, PetscReal *gap, PetscReal *area)
{
  const LawState  state = ContactTermState(pair, c, t, pair->most);
  const PetscReal found = ContactTermGap(pair, pair->factor, pair->point_gap, c, area);

  *value = (LawValue){0, 0, 0};
  if (gap) *gap = found;
  if (PetscIsNanReal(found)) return;
  pair->law->evaluate(found, &state, value);
  if (pair->holding && value->stiffness == 0) TermHold(pair, c, &state, found, value);
}

/* ContactTermForce - what a term's own gap, of the last projection, presses with (force). Not collective.

   In surface contact it is not the nodal force, most of which may be the neighbours': they press on the faces that they
   share with it. */
PetscReal ContactTermForce(const ContactPair *pair, PetscInt c)
{
  LawValue  value;
  PetscReal area;

  if (!pair->formulation.surface) return pair->force[c];
  ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
  return value.pressure * area;
}

/* A pressure of a term presses on all of its points. */
void ContactTermPress(ContactPair *pair, PetscInt c, PetscReal pressure)
{
  if (pressure == 0) return;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    pair->point_force[pair->term_point[k]] += pressure * pair->term_weight[k] * pair->factor[pair->term_point[k]];
}
