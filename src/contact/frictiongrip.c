/* Multipliers of friction, its grip: where a pair is augmented, the tractions of a converged solve become multipliers,
   as the pressures do, and take the elastic slip away. */
#include "contactimpl.h"

/* Elastic slip of a term that sticks in the last residual, over the bound of its pair; 0 where it slips. */
PetscReal FrictionTermBeyond(const ContactPair *pair, PetscInt c)
{
  return pair->now.slips[c] ? 0 : pair->friction->elastic[c] / ContactTermBound(pair, c);
}

/*@
  FrictionGripNext - finds the tractions of a pair, which are to become its multipliers.

  Not collective

  Input Parameter:
. pair - the pair, augmented, in the state of its last residual

  Output Parameter:
. grip - two components for each term; 0 where no friction acts
@*/
PetscErrorCode FrictionGripNext(const ContactPair *pair, PetscReal *grip)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    FrictionInput    in;
    FrictionTraction out;
    PetscBool        acts;

    grip[2 * c] = grip[2 * c + 1] = 0;
    PetscCall(FrictionTerm(pair, c, pair->t, &in, &out, &acts));
    if (acts) FrictionComponents(in.normal, in.along, out.traction, &grip[2 * c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionGripTake - takes over new multipliers, which stay in the cone of the pressures' multipliers.

  Not collective

  Input Parameters:
+ pair - the pair, augmented, in the state of its last residual, with new multipliers of pressures
- grip - two components for each term

  Note:
  Mixed multipliers may be out of the cone.
@*/
PetscErrorCode FrictionGripTake(ContactPair *pair, const PetscReal *grip)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal length = PetscSqrtReal(PetscSqr(grip[2 * c]) + PetscSqr(grip[2 * c + 1]));
    FrictionInput   in;
    PetscBool       found;
    PetscReal       bound = 0;

    PetscCall(FrictionTermAsk(pair, c, pair->t, &in, &found));
    if (found) bound = FrictionBound(&in, pair->now.multiplier[c]);
    for (int k = 0; k < 2; k++)
      pair->friction->grip[2 * c + k] = grip[2 * c + k] * (length > bound ? bound / length : 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
