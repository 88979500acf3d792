/* Stiffer penalties where penetration leaves too large an error, and how pairs press. */
#include "contactimpl.h"

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
  if (pair->ridge) PetscCall(ContactStiffen(contact, pair->ridge, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStiffenStick - multiplies the penalty of what sticks in a pair, in the present state.

  Not collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- factor  - the same on all ranks

  Note:
  For pairs whose scene names neither that penalty nor an elastic slip. What the step began with of elastic slip stays,
  so that its traction grows by the factor, and equilibrium takes the slip back.
@*/
PetscErrorCode ContactStiffenStick(Contact contact, int p, PetscReal factor)
{
  ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  pair->now.stick *= factor;
  if (pair->friction) pair->friction->stiffness *= factor;
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
. load - force, mean pressure, largest pressure and friction
@*/
PetscErrorCode ContactPairLoad(Contact contact, int p, const PetscReal *u, ContactLoad *load)
{
  const Friction friction = contact->pairs[p].friction;
  const int      ridge    = contact->pairs[p].ridge;
  ContactNodes   nodes;
  PetscReal      sum[6] = {0}, most = 0; /* force, by pressure, friction; force of edges, which have no pressure */

  PetscFunctionBeginUser;
  for (PetscInt c = 0; ridge && c < contact->pairs[ridge].n; c++) sum[5] += contact->pairs[ridge].force[c];
  PetscCall(ContactGetNodes(contact, p, u, &nodes));
  for (PetscInt c = 0; c < nodes.n; c++) {
    for (int d = 0; d < 3 && friction; d++) sum[2 + d] += friction->nodal[3 * c + d];
    if (!(nodes.force[c] > 0)) continue;
    sum[0] += nodes.force[c];
    sum[1] += nodes.force[c] * nodes.pressure[c];
    most = PetscMax(most, nodes.pressure[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  *load = (ContactLoad){.force    = sum[0] + sum[5],
                        .pressure = sum[0] > 0 ? sum[1] / sum[0] : 0,
                        .peak     = most,
                        .friction = {sum[2], sum[3], sum[4]},
                        .rubs     = PetscSqrtReal(PetscSqr(sum[2]) + PetscSqr(sum[3]) + PetscSqr(sum[4]))};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairStick - returns the factor on the automatic penalty of what sticks in a pair.

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair
@*/
PetscReal ContactPairStick(Contact contact, int p)
{
  return contact->pairs[p].now.stick;
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
