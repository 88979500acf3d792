/* Stiffer penalties: for trial, and for good where penetration leaves too large an error. */
#include "contactimpl.h"

/*@
  ContactScalePenalty - multiplies what the penalties count for in energy, force and tangent, until the next call.

  Not collective

  Input Parameters:
+ contact - the contact
- factor  - the same on all ranks; 1 ends it

  Note:
  The penalties themselves do not change.
@*/
PetscErrorCode ContactScalePenalty(Contact contact, PetscReal factor)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) contact->pairs[p].trial_factor = factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStiffen - multiplies the penalties of a pair in the present state.

  Not collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- factor  - the same on all ranks

  Note:
  For pairs whose penalties do not follow the penetrations.
@*/
PetscErrorCode ContactStiffen(Contact contact, int p, PetscReal factor)
{
  ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) pair->now.penalty[c] *= factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairLoad - sums up how a pair presses.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces
. p       - number of the pair
- u       - local displacements of that residual, u[n_nodes*dim] (length)

  Output Parameter:
. load - force, mean pressure and largest pressure
@*/
PetscErrorCode ContactPairLoad(Contact contact, int p, const PetscReal *u, ContactLoad *load)
{
  ContactNodes nodes;
  PetscReal    sum[2] = {0, 0}, most = 0;

  PetscFunctionBeginUser;
  PetscCall(ContactGetNodes(contact, p, u, &nodes));
  for (PetscInt c = 0; c < nodes.n; c++) {
    if (!(nodes.force[c] > 0)) continue;
    sum[0] += nodes.force[c];
    sum[1] += nodes.force[c] * nodes.pressure[c];
    most = PetscMax(most, nodes.pressure[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  *load = (ContactLoad){.force = sum[0], .pressure = sum[0] > 0 ? sum[1] / sum[0] : 0, .peak = most};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairInitialPenalty - returns the penalty of a pair at the start of the run (force per length and area).

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair
@*/
PetscReal ContactPairInitialPenalty(Contact contact, int p)
{
  return contact->pairs[p].initial;
}
