/* The penalties of another contact, for a model that stands beside it. */
#include "contactimpl.h"

/*@
  ContactFollow - gives all terms the penalties that the terms of another contact have come to, each over the penalty at
  the start of the run.

  Not collective

  Input Parameters:
+ contact - fresh, after ContactTakeOverlap()
- leader  - on a mesh with the same nodes and faces

  Output Parameter:
. same - the two have the same terms on this rank; else nothing is done
@*/
PetscErrorCode ContactFollow(Contact contact, Contact leader, PetscBool *same)
{
  PetscFunctionBeginUser;
  *same = (PetscBool)(contact->n_pairs == leader->n_pairs);
  for (int p = 0; p < contact->n_pairs && *same; p++) *same = (PetscBool)(contact->pairs[p].n == leader->pairs[p].n);
  for (int p = 0; p < contact->n_pairs && *same; p++) {
    ContactPair *pair = &contact->pairs[p], *other = &leader->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++)
      pair->now.penalty[c] = pair->accepted.penalty[c] = pair->initial * other->now.penalty[c] / other->initial;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
