/* The energy that friction takes in a step. */
#include "contactimpl.h"

static PetscReal Length(const PetscReal v[3])
{
  return PetscSqrtReal(PetscSqr(v[0]) + PetscSqr(v[1]) + PetscSqr(v[2]));
}

/* What the accepted traction of a term does along its slip while its contact ends: both go straight to their ends, the
   traction to 0. A term that stuck takes as much: it lets go of what the bodies have stored. */
static PetscReal LeftEnergy(const ContactPair *pair, PetscInt c, const FrictionInput *in)
{
  PetscReal force[2], slip[2], area;

  (void)ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
  FrictionComponents(in->normal, in->along, &pair->accepted.traction[3 * c], force);
  FrictionComponents(in->normal, in->along, in->slip, slip);
  return PetscMax(0, area * (force[0] * slip[0] + force[1] * slip[1]) / 2);
}

/* Says whether a term leaves contact in which friction acted when the step began. */
PetscBool FrictionTermLeaves(const ContactPair *pair, PetscInt c)
{
  return (PetscBool)(pair->accepted.status[c] != CONTACT_OPEN && Length(&pair->accepted.traction[3 * c]) > 0);
}

/*@
  FrictionTermEnergy - returns the energy that friction takes at a term since its step began.

  Not collective

  Input Parameters:
+ pair - the pair, projected
. c    - the term
. in   - of FrictionTermAsk()
. out  - of FrictionTerm(); NULL: the term leaves, see FrictionTermLeaves()
- area - of the slave points that take part, where it does not leave (area)

  Notes:
  The energy is never below 0. The traction along the slip is the mean of its values where the step begins and ends, as
  the trapezoidal rule has it: 0 where the term was open. Where the term stuck, or slipped the other way, it slips with
  the traction at the end.
@*/
PetscReal FrictionTermEnergy(const ContactPair *pair, PetscInt c, const FrictionInput *in, const FrictionTraction *out,
                             PetscReal area)
{
  const PetscReal *before = &pair->accepted.traction[3 * c];
  PetscReal        now, along = 0;

  if (!out) return LeftEnergy(pair, c, in);
  now = Length(out->traction);
  for (int d = 0; d < 3; d++) along += before[d] * out->traction[d];
  if (in->began > 0)
    now /= 2;
  else if (pair->accepted.slips[c] && along > 0)
    now = (now + Length(before)) / 2;
  return area * out->slipped * now;
}
