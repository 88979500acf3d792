/* Forces and energy of contact, and what a linear step or a prediction counts on. */
#include "contactimpl.h"

/* Direction of a term's contact: the mean of its points'. */
static void TermNormal(ContactPair *pair, PetscInt c)
{
  PetscReal *normal = &pair->normal[3 * c], length = 0;

  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    for (int d = 0; d < 3; d++)
      normal[d] +=
        pair->term_weight[k] * pair->factor[pair->term_point[k]] * pair->point_normal[3 * pair->term_point[k] + d];
  for (int d = 0; d < 3; d++) length += PetscSqr(normal[d]);
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= PetscSqrtReal(length);
}

/* Adds the forces of the loaded slave points to the contact nodes' values. */
static PetscErrorCode PairForces(ContactPair *pair, PetscReal *values)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    const PetscReal force = pair->point_force[q];

    if (force == 0) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    for (PetscInt i = v->first[q]; i < v->end[q]; i++)
      for (int d = 0; d < dim; d++) values[v->number[i] * dim + d] -= force * v->N[i * dim + d];
    for (int d = 0; d < dim && v->first[q] < v->end[q]; d++) pair->total[d] += force * v->own[q * dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normal nodal forces of terms that share their points: the points' forces by the hat functions, those of terms on
 * other ranks too. */
static PetscErrorCode PairSharedForces(ContactPair *pair)
{
  const int      dim   = pair->mesh->dim;
  NeighbourLists lists = pair->lists;
  PetscReal     *values, *nodal;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &nodal));
  for (PetscInt q = 0; q < lists->n_slaves; q++)
    for (PetscInt k = pair->slaves->ptr[q], node = lists->slave_ptr[q]; k < pair->slaves->ptr[q + 1]; k++, node++)
      values[lists->slave_node[node] * dim] += pair->slaves->hat[k] * pair->point_force[q];
  PetscCall(NeighbourListsReduce(lists, values, nodal));
  for (PetscInt c = 0; c < pair->n; c++) pair->force[c] = nodal[pair->node[c] * dim];
  PetscCall(PetscFree2(values, nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairResidual(Contact contact, ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal *f,
                                   PetscReal *energy, PetscReal *force2)
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(ContactPairProject(contact, pair, u, t));
  if (f) PetscCall(PetscArrayzero(pair->point_force, pair->lists->n_slaves));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal gap, area;

    ContactTermLaw(pair, c, t, &value, &gap, &area);
    if (energy) *energy += area * value.psi;
    if (force2) *force2 += 2 * PetscSqr(area * value.pressure); /* on the slave and on the master */
    if (!f) continue;
    pair->now.gap[c]    = gap;
    pair->now.status[c] = value.stiffness > 0 ? CONTACT_CLOSED : CONTACT_OPEN;
    ContactTermPress(pair, c, value.pressure);
    TermNormal(pair, c);
  }
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  pair->t = t;
  PetscCall(PetscArrayzero(pair->total, 3));
  PetscCall(PetscCalloc1(pair->lists->n_nodes * contact->mesh->dim, &values));
  PetscCall(PairForces(pair, values));
  PetscCall(NeighbourListsReduce(pair->lists, values, f));
  if (pair->formulation.surface) PetscCall(PairSharedForces(pair));
  for (PetscInt c = 0; c < pair->n && !pair->formulation.surface; c++)
    pair->force[c] = pair->point_force[pair->term_point[pair->term_ptr[c]]];
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactHoldActiveSet - between the two calls what is in contact at the first one stays so, pressed or pulled, in
   residual and tangent.

   Not collective. For a linear step from a solution: fresh lists and offsets move the surfaces a little, which is a
   load of the step, not an opening. touching: what is open within ContactTouchTolerance() is closed too (Chamoret et
   al. start from surfaces that touch). */
PetscErrorCode ContactHoldActiveSet(Contact contact, PetscBool holding, PetscBool touching)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    pair->holding  = holding;
    pair->touching = touching;
    for (PetscInt c = 0; c < pair->n && holding; c++)
      pair->held[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactResidual - contact forces, energy and their unassembled norm at (u, t).

   Collective, with the same arguments NULL on all ranks. u[n_nodes*dim]: local displacements (length). f[n_nodes*dim]:
   contact forces are subtracted as external ones are, complete at owned nodes; with f gaps, status and nodal forces
   become the present state. energy, force2 (sum of the squared forces of the terms on either side): this rank's, added
   to. Each of the three may be NULL.

   Source: Chamoret et al. 2004, eq. 12 and 15. */
PetscErrorCode ContactResidual(Contact contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy,
                               PetscReal *force2)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_residual, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++)
    PetscCall(PairResidual(contact, &contact->pairs[p], u, t, f, energy, force2));
  PetscCall(PetscLogEventEnd(contact->event_residual, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMarkPredicted - what is in contact now is what ContactUnpredictedEnergy() takes for foreseen. Not collective.
 */
PetscErrorCode ContactMarkPredicted(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) pair->predicted[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactUnpredictedEnergy - energy of the terms in contact at (u, t) that ContactMarkPredicted() found open, of this
   rank, added to.

   Collective. u[n_nodes*dim]: local displacements (length). */
PetscErrorCode ContactUnpredictedEnergy(Contact contact, const PetscReal *u, PetscReal t, PetscReal *energy)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(ContactPairProject(contact, pair, u, t));
    for (PetscInt c = 0; c < pair->n; c++) {
      LawValue  value;
      PetscReal area;

      ContactTermLaw(pair, c, t, &value, NULL, &area);
      if (!pair->predicted[c]) *energy += area * value.psi;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
