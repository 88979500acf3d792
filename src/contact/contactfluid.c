/* A fluid between the surfaces of a pair: what it carries, the contact does not. */
#include "contactimpl.h"
#include <float.h>

/*@
  ContactSetCarried - sets the force that a fluid carries at each slave node of a pair.

  Not collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
. carried - carried[n_nodes] by local node: normal force; 0 where no fluid is
- dry     - dry[n_nodes]: 1 where the fluid's load lies ahead of it, on surfaces that touch, else 0; not used without
            friction

  Note:
  A term presses what its penalty and its multiplier give beyond this force. So where the fluid's own load is this
  force, fluid and contact together press as much as the larger of the two, and whether the fluid is there does not
  matter where the contact alone presses more. Where the surfaces are dry, all of it counts in the bound of friction.
@*/
PetscErrorCode ContactSetCarried(Contact contact, int p, const PetscReal *carried, const PetscReal *dry)
{
  ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  if (!pair->carried) PetscCall(PetscMalloc1(pair->n, &pair->carried));
  if (!pair->carried_dry && pair->friction) PetscCall(PetscMalloc1(pair->n, &pair->carried_dry));
  for (PetscInt c = 0; c < pair->n_nodes; c++) { /* a fluid leaves no terms of faces, see ContactFacesServe() */
    pair->carried[c] = carried[pair->node[c]] / pair->whole[c];
    for (PetscInt i = pair->first_side[c]; i < pair->first_side[c + 1]; i++) pair->carried[i] = pair->carried[c];
  }
  for (PetscInt c = 0; c < pair->n && pair->friction; c++) pair->carried_dry[c] = dry[pair->node[c]] * pair->carried[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTermForces - gets the forces that the terms of a pair press with at their nodes in the state of the last
  residual.

  Not collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces
. p       - number of the pair
- touch   - gap up to which surfaces touch (length)

  Input/Output Parameter:
. force - force[n_nodes] by local node: normal force that the term's own gap causes, beyond what a fluid carries; the
          smallest positive number where the surfaces touch without force; a larger value of another pair stays

  Note:
  Only nodes of this rank have terms.
@*/
PetscErrorCode ContactTermForces(Contact contact, int p, PetscReal touch, PetscReal *force)
{
  const ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal least = PetscAbsReal(pair->now.gap[c]) <= touch ? DBL_MIN : 0; /* NaN: no master is near */

    force[pair->node[c]] = PetscMax(force[pair->node[c]], PetscMax(least, ContactTermForce(pair, c)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactDryReactions - adds the normal forces of a pair's dry terms on the nodes of its master.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Input/Output Parameter:
. reaction - reaction[n_nodes*dim] by node of the mesh, complete at owned nodes

  Note:
  Dry are the terms of which a fluid carries nothing. The forces are those in the displacements of the last residual.
@*/
PetscErrorCode ContactDryReactions(Contact contact, int p, PetscReal *reaction)
{
  const ContactPair *pair = &contact->pairs[p];
  const int          dim  = pair->mesh->dim;
  PetscReal         *point, *values, *own;

  PetscFunctionBeginUser;
  PetscCall(
    PetscCalloc3(pair->lists->n_slaves, &point, pair->lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &own));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    if (pair->carried && pair->carried[c] > 0) continue;
    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    ContactTermPress(pair, c, value.pressure, point);
  }
  PetscCall(ContactPointForces(pair, point, values));
  PetscCall(ContactPointReactions(pair, point, values, own));
  for (PetscInt i = 0; i < pair->mesh->n_nodes * dim; i++) reaction[i] += own[i];
  PetscCall(PetscFree3(point, values, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairFiner - tells how fine the quadrature rule of a pair's slave is, see FaceRuleGet().

  Not collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Note:
  It returns FACE_RULE_PLAIN in node to surface.
@*/
int ContactPairFiner(Contact contact, int p)
{
  return contact->pairs[p].formulation.surface ? contact->pairs[p].slaves->finer : FACE_RULE_PLAIN;
}
