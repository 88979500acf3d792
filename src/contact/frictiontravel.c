/* How far contact with friction travels along its slave in a step. A term that was open when the step began counts slip
   from the touch only (frictionlaw.h), and what that is in a long step is not known well: a node that sticks from then
   on loses part of its slip. This matters where contact goes on along the slave, as where a wheel rolls: nodes come in
   at one end and leave at the other. */
#include "contactimpl.h"

/* The normal force of a term in the accepted state. Its gap then counts: new lists and offsets give another one. */
static PetscReal AcceptedForce(const ContactPair *pair, PetscInt c, PetscReal t)
{
  const LawState  state = ContactTermState(pair, c, t, ContactTermMost(pair, c));
  const PetscReal gap   = pair->accepted.gap[c];
  LawValue        value = {0, 0, 0};
  PetscReal       area;

  if (pair->accepted.status[c] == CONTACT_OPEN || PetscIsNanReal(gap)) return 0;
  (void)ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
  pair->law->evaluate(gap, &state, &value);
  return PetscMax(0, value.pressure) * area;
}

/* Remembers how the terms press where a step begins. Before any load no force is in equilibrium: what overlaps there,
   as the faces of a coarse mesh do, presses nothing yet. */
void FrictionTravelBegin(ContactPair *pair, PetscReal t)
{
  for (PetscInt c = 0; c < pair->n; c++) pair->friction->pressed[c] = t > 0 ? AcceptedForce(pair, c, t) : 0;
}

/* The force of a pair at nodes that came into contact in the step and stick now, or at nodes that left it where that is
   less, as a part of the larger one of the forces before and now. Where contact only grows, or only shrinks, it does
   not travel, and a load that begins in the step has not travelled. */
static PetscErrorCode PairTravel(const ContactPair *pair, PetscReal *travel)
{
  PetscReal sum[4] = {0, 0, 0, 0}; /* before, of it left; now, of it come in */

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal before = pair->friction->pressed[c], now = ContactTermForce(pair, c);

    sum[0] += before;
    sum[1] += now > 0 ? 0 : before;
    sum[2] += now;
    sum[3] += before > 0 || pair->now.slips[c] ? 0 : now;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPIU_SUM, pair->mesh->comm));
  *travel = sum[0] > 0 && sum[2] > 0 ? PetscMin(sum[1], sum[3]) / PetscMax(sum[0], sum[2]) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTravel - says how far contact with friction has travelled along its slave since the step began.

  Collective

  Input Parameter:
. contact - after ContactResidual() with forces

  Output Parameter:
. travel - the largest one of the pairs, a part of the force of contact; 0 without friction

  Note:
  The largest travel so far becomes part of the pairs' present state.
@*/
PetscErrorCode ContactTravel(Contact contact, PetscReal *travel)
{
  PetscFunctionBeginUser;
  *travel = 0;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];
    PetscReal    own;

    if (!pair->friction) continue;
    PetscCall(PairTravel(pair, &own));
    pair->now.travel = PetscMax(pair->accepted.travel, own);
    *travel          = PetscMax(*travel, own);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
