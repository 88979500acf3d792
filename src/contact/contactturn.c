/* Slave points in contact that go over an edge between two facets, where their normal jumps. */
#include "base/largest.h"
#include "contact/contactturn.h"
#include "contactimpl.h"

/* Sine of the smallest turn of a normal that counts as a jump. The two states that are compared differ by a very small
   part of a step, over which a normal on one facet turns by far less. */
#define TURN_AT_ONCE 1e-4

/* Finds the point of a pair whose normal turns most from u to u_ahead, among those that its term's pressure acts on. */
static PetscErrorCode PairTurn(Contact contact, ContactPair *pair, const PetscReal *u, const PetscReal *u_ahead,
                               PetscReal t, PetscReal *most, ContactPlace *place)
{
  const NeighbourLists lists = pair->lists;
  PetscReal           *before;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * lists->n_slaves, &before));
  PetscCall(ContactPairProject(contact, pair, u, t));
  PetscCall(PetscArraycpy(before, pair->point_normal, 3 * lists->n_slaves));
  PetscCall(ContactPairProject(contact, pair, u_ahead, t));
  for (PetscInt c = 0; c < pair->n_sides; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      const PetscInt q    = pair->term_point[k];
      PetscReal      turn = 0;

      for (int d = 0; d < 3; d++) turn += PetscSqr(pair->point_normal[3 * q + d] - before[3 * q + d]);
      if (pair->point_force[q] == 0 || !(PetscSqrtReal(turn) > *most)) continue;
      *most      = PetscSqrtReal(turn);
      place->tag = ContactTermTag(pair, c);
      ContactTermPlace(pair, c, place->X);
    }
  }
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLocateTurn - looks for a slave node in contact with a point that goes over an edge between facets from u to
  u_ahead.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
. u_ahead - displacements that differ from u by very little
- t       - load parameter

  Output Parameters:
+ found - the same on all ranks
- place - the node, where found is PETSC_TRUE
@*/
PetscErrorCode ContactLocateTurn(Contact contact, const PetscReal *u, const PetscReal *u_ahead, PetscReal t,
                                 PetscBool *found, ContactPlace *place)
{
  Mesh         mesh      = contact->mesh;
  PetscReal    values[4] = {0}, mine = TURN_AT_ONCE, most;
  ContactPlace at = {.tag = -1};
  PetscMPIInt  rank;
  PetscBool    here;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (pair->master && !pair->fit.fitted) PetscCall(PairTurn(contact, pair, u, u_ahead, t, &mine, &at));
  }
  PetscCall(LargestOfRanks(mesh->comm, mine, &most, &rank, &here));
  *found = most > TURN_AT_ONCE ? PETSC_TRUE : PETSC_FALSE;
  if (*found && here) {
    values[0] = (PetscReal)at.tag;
    PetscCall(PetscArraycpy(&values[1], at.X, 3));
  }
  PetscCallMPI(MPI_Bcast(values, 4, MPIU_REAL, rank, mesh->comm));
  *place = (ContactPlace){.tag = (PetscInt)values[0], .X = {values[1], values[2], values[3]}};
  PetscFunctionReturn(PETSC_SUCCESS);
}
