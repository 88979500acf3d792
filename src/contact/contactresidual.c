/* Forces and energy of contact, and what a linear step or a prediction counts on. */
#include "contactimpl.h"

/* Direction of a term's contact: the mean of its points' normals. */
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

/*@
  ContactPointForces - adds normal forces of slave points to the values of the contact nodes.

  Not collective

  Input Parameters:
+ pair        - the pair, projected
- point_force - of each slave point

  Input/Output Parameter:
. values - forces over the contact nodes, subtracted as external ones are
@*/
PetscErrorCode ContactPointForces(const ContactPair *pair, const PetscReal *point_force, PetscReal *values)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    if (point_force[q] == 0) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    for (PetscInt i = v->first[q]; i < v->end[q]; i++)
      for (int d = 0; d < dim; d++) values[v->number[i] * dim + d] -= point_force[q] * v->N[i * dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force on this rank's terms. */
static void PairTotal(ContactPair *pair)
{
  const int                dim = pair->mesh->dim;
  const ContactVariations *v   = pair->variations;

  for (int d = 0; d < 3; d++) pair->total[d] = 0;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++)
    for (int d = 0; d < dim && pair->point_force[q] != 0 && v->first[q] < v->end[q]; d++)
      pair->total[d] += pair->point_force[q] * v->own[q * dim + d];
}

/*@
  ContactPointReactions - finds the forces on the nodes of a master: those on all contact nodes without those on the
  slave points themselves.

  Collective

  Input Parameters:
+ pair        - the pair, projected
. point_force - normal force of each slave point
- values      - what ContactPointForces() makes of them

  Output Parameter:
. reaction - reaction[n_nodes*dim] by node of the mesh, complete at owned nodes
@*/
PetscErrorCode ContactPointReactions(const ContactPair *pair, const PetscReal *point_force, const PetscReal *values,
                                     PetscReal *reaction)
{
  const int            dim   = pair->mesh->dim;
  const NeighbourLists lists = pair->lists;
  PetscReal           *on_master;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(lists->n_nodes * dim, &on_master));
  for (PetscInt i = 0; i < lists->n_nodes * dim; i++) on_master[i] = -values[i];
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    if (point_force[q] == 0 || pair->variations->first[q] == pair->variations->end[q]) continue;
    for (PetscInt k = lists->slave_ptr[q]; k < lists->slave_ptr[q + 1]; k++)
      for (int d = 0; d < dim; d++)
        on_master[lists->slave_node[k] * dim + d] -= point_force[q] * lists->slave_S[k] *
                                                     pair->images[lists->slave_side[k]].sign[d] *
                                                     pair->variations->own[q * dim + d];
  }
  PetscCall(PetscArrayzero(reaction, pair->mesh->n_nodes * dim));
  PetscCall(NeighbourListsReduce(lists, on_master, reaction));
  PetscCall(PetscFree(on_master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactNodalForces - finds the normal forces of slave nodes from those of slave points.

  Collective

  Input Parameters:
+ pair        - the pair
- point_force - of each slave point

  Output Parameter:
. force - of each term that is a node

  Note:
  Where terms share their points, the hat functions distribute the points' forces, also to terms of other ranks.
@*/
PetscErrorCode ContactNodalForces(const ContactPair *pair, const PetscReal *point_force, PetscReal *force)
{
  const int      dim   = pair->mesh->dim;
  NeighbourLists lists = pair->lists;
  PetscReal     *values, *nodal;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n_nodes && !pair->formulation.surface; c++)
    force[c] = point_force[pair->term_point[pair->term_ptr[c]]];
  if (!pair->formulation.surface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &nodal));
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q = lists->near[i];

    for (PetscInt k = pair->slaves->ptr[q], node = lists->slave_ptr[q]; k < pair->slaves->ptr[q + 1]; k++, node++)
      values[lists->slave_node[node] * dim] += pair->slaves->hat[k] * point_force[q];
  }
  PetscCall(NeighbourListsReduce(lists, values, nodal));
  for (PetscInt c = 0; c < pair->n_nodes; c++) force[c] = nodal[pair->node[c] * dim];
  PetscCall(PetscFree2(values, nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do forces from outside act in a pair, of a tool or of mirror images? */
static PetscBool HasOuter(const ContactPair *pair)
{
  return (PetscBool)(!pair->master || pair->master->rigid || pair->slave->rigid || pair->n_images > 1);
}

/* Number of the scene's pair to which a pair belongs. */
static ptrdiff_t PairOf(Contact contact, const ContactPair *pair)
{
  return ContactIsRidge(pair) ? pair->tool_pair : pair - contact->pairs;
}

/* Forces, energy and squared forces of one pair. */
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
    ContactTermPress(pair, c, value.pressure, pair->point_force);
    TermNormal(pair, c);
  }
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  pair->t = t;
  PetscCall(PetscCalloc1(pair->lists->n_nodes * contact->mesh->dim, &values));
  PetscCall(ContactPointForces(pair, pair->point_force, values));
  PairTotal(pair);
  if (pair->scene->share < 1) PetscCall(ContactPointReactions(pair, pair->point_force, values, pair->reaction));
  if (pair->friction) PetscCall(FrictionResidual(pair, t, values));
  if (pair->tool) PetscCall(ContactToolForces(pair, values));
  if (contact->hold)
    ContactPairHold(contact, pair, t, values, &contact->hold[PairOf(contact, pair) * MOTION_COMPONENTS]);
  PetscCall(NeighbourListsReduce(pair->lists, values, f));
  if (contact->outer && HasOuter(pair)) PetscCall(NeighbourListsReduce(pair->lists, values, contact->outer));
  PetscCall(ContactNodalForces(pair, pair->point_force, pair->force));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactWatchOuter - from now on adds the forces of tools and of pairs with mirror images to a second array as well.

  Not collective

  Input Parameters:
+ contact - the contact
- outer   - [n_nodes*dim], of MeshCreateLocal(), to which ContactResidual() adds as to its own; borrowed. NULL ends it
@*/
void ContactWatchOuter(Contact contact, PetscReal *outer)
{
  contact->outer = outer;
}

/*@
  ContactHoldActiveSet - begins or ends a linear step, in which what is in contact stays so, pressed or pulled, in
  residual and tangent.

  Not collective

  Input Parameters:
+ contact  - the contact
. holding  - PETSC_TRUE begins the step at the present state, PETSC_FALSE ends it
- touching - what is open within ContactTouchTolerance() is closed too; Chamoret et al. (2004) start from surfaces
             that touch

  Note:
  Fresh lists and offsets move the surfaces a little. In a linear step from a solution this is a load of the step, not
  an opening.
@*/
PetscErrorCode ContactHoldActiveSet(Contact contact, PetscBool holding, PetscBool touching)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    pair->holding  = holding;
    pair->solved   = PETSC_FALSE;
    pair->touching = touching;
    for (PetscInt c = 0; c < pair->n && holding; c++)
      pair->held[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactHoldSolved - begins a linear step from a solution whose lists have just been replaced: what is in contact there
  stays so.

  Not collective

  Input Parameters:
+ contact - the contact, whose last ContactResidual() was at the solution; ContactHoldActiveSet() ends the step
- again   - the step is begun once more from the same solution; there may have been residuals since

  Note:
  The pressures of the solution are in balance with the stresses of the bodies and with fluids, and they turn with the
  surface. Fresh lists and offsets change gaps by more than a stiff penalty lets them close, and their pressures are
  those of no equilibrium. Nor are those of the accepted state where the load has grown since. With friction they are
  those of the accepted state all the same, as for the tractions: a rivet that is formed takes five times as many steps
  with the others.
@*/
PetscErrorCode ContactHoldSolved(Contact contact, PetscBool again)
{
  PetscFunctionBeginUser;
  if (!again) PetscCall(ContactHoldActiveSet(contact, PETSC_TRUE, PETSC_FALSE));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    pair->holding = PETSC_TRUE;
    pair->solved  = pair->friction ? PETSC_FALSE : PETSC_TRUE;
    for (PetscInt c = 0; c < pair->n && !again; c++) {
      const LawState state = ContactTermState(pair, c, pair->t, ContactTermMost(pair, c));
      LawValue       value = {0, 0, 0};

      if (pair->held[c]) pair->law->evaluate(pair->now.gap[c], &state, &value);
      pair->balanced[c] = value.pressure;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactHoldExpected - begins a linear step, in which what is in contact stays so, and what pressed at the end of the
  linear step to the present state is pulled there.

  Collective

  Input Parameters:
+ contact - the contact, after a linear step from the present state was found; ContactHoldActiveSet() ends the new one
- last    - nothing was noted of the end of that step, and what was noted last is of the step before

  Output Parameter:
. any - something of that is open at the present state; else no step is begun. The same on all ranks

  Note:
  Surfaces are curved and bodies turn, so that a linear step leaves a little open of what it is to close. That may be
  all that holds a body. ContactDropExpected() follows where the new step is not taken.
@*/
PetscErrorCode ContactHoldExpected(Contact contact, PetscBool last, PetscBool *any)
{
  int open = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (last) PetscCall(PetscArraycpy(pair->arrived, pair->expected, pair->n));
    for (PetscInt c = 0; c < pair->n; c++) open |= pair->arrived[c] && pair->now.status[c] != CONTACT_CLOSED;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &open, 1, MPI_INT, MPI_LOR, contact->mesh->comm));
  *any = (PetscBool)open;
  if (!open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactHoldActiveSet(contact, PETSC_TRUE, PETSC_FALSE));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) pair->held[c] = (PetscBool)(pair->held[c] || pair->arrived[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactDropExpected - forgets what the step of ContactHoldExpected() was to press, because it is not taken.

  Not collective

  Input Parameter:
. contact - the contact
@*/
PetscErrorCode ContactDropExpected(Contact contact)
{
  PetscFunctionBeginUser;
  ContactForgetForeseen(contact);
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(PetscArraycpy(pair->expected, pair->arrived, pair->n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactResidual - computes contact forces, energy and the sum of squared forces at (u, t).

  Collective

  Input Parameters:
+ contact - the contact, with lists
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
- t       - load parameter

  Input/Output Parameters:
+ f      - contact forces are subtracted as external ones are, f[n_nodes*dim], complete at owned nodes; or NULL
. energy - this rank's energy is added; or NULL
- force2 - the sum of the squared forces of this rank's terms, on either side, is added; or NULL

  Notes:
  With f, the gaps, status and nodal forces become the present state. Each of the three is NULL on all ranks or on
  none, see MeshCreateLocal().

  Source: Chamoret et al. (2004), eqs 12 and 15.
@*/
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

/*@
  ContactMarkPredicted - notes what is in contact now as what a prediction counts on.

  Not collective

  Input Parameter:
. contact - the contact
@*/
PetscErrorCode ContactMarkPredicted(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) pair->predicted[c] = (PetscBool)(pair->now.status[c] == CONTACT_CLOSED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPredictionMissed - says whether a prediction counted on surface to surface contact, whose mean gaps it closed,
and the present state has no contact.

  Collective

  Input Parameter:
. contact - the contact, after ContactResidual() with forces

  Output Parameter:
. missed - the same on all ranks
@*/
PetscErrorCode ContactPredictionMissed(Contact contact, PetscBool *missed)
{
  int found[2] = {0, 0}; /* predicted; closed */

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      found[0] = found[0] || (pair->formulation.surface && pair->predicted[c]);
      found[1] = found[1] || pair->now.status[c] == CONTACT_CLOSED;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPI_INT, MPI_LOR, contact->mesh->comm));
  *missed = (PetscBool)(found[0] && !found[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactUnpredictedEnergy - adds the energy of those terms in contact at (u, t) that the prediction did not count on.

  Collective

  Input Parameters:
+ contact - the contact
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
- t       - load parameter

  Input/Output Parameter:
. energy - this rank's energy is added
@*/
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
