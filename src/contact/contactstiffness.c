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
  ContactPairLoad - sums the normal forces of a pair's slave nodes, and finds the largest pressure.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces
. p       - number of the pair
- u       - local displacements of that residual, u[n_nodes*dim] (length)

  Output Parameters:
+ force    - sum over the nodes (force; axisymmetric: over 360 degrees)
- pressure - largest one (force per area)
@*/
PetscErrorCode ContactPairLoad(Contact contact, int p, const PetscReal *u, PetscReal *force, PetscReal *pressure)
{
  ContactNodes nodes;

  PetscFunctionBeginUser;
  *force = *pressure = 0;
  PetscCall(ContactGetNodes(contact, p, u, &nodes));
  for (PetscInt c = 0; c < nodes.n; c++) {
    *force += PetscAbsReal(nodes.force[c]);
    if (nodes.force[c] > 0) *pressure = PetscMax(*pressure, nodes.pressure[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 1, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pressure, 1, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
