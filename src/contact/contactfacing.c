/* Turn of the faces of a body that lie opposite other faces of it, see contactfacing.h. */
#include "contact/contactfacing.h"
#include "contactimpl.h"

/* Normals of all slave points of a pair at u, of any length. */
static PetscErrorCode PairNormals(const ContactPair *pair, const PetscReal *u, PetscReal *normal)
{
  PetscFunctionBeginUser;
  PetscCall(SlavePointsMove(pair->slaves, u, pair->t));
  PetscCall(SlavePointsNormals(pair->slaves, pair->n_images, pair->images, u, NULL, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Angle between two vectors of any length (radians); 0 where one of them is 0. */
static PetscReal Angle(const PetscReal a[3], const PetscReal b[3])
{
  PetscReal dot = 0, aa = 0, bb = 0;

  for (int d = 0; d < 3; d++) {
    dot += a[d] * b[d];
    aa += a[d] * a[d];
    bb += b[d] * b[d];
  }
  return aa > 0 && bb > 0 ? PetscAcosReal(PetscClipInterval(dot / PetscSqrtReal(aa * bb), -1, 1)) : 0;
}

/* Largest turn of this rank's slave points of a pair that have facets in their lists. */
static PetscErrorCode PairTurns(const ContactPair *pair, const PetscReal *u_0, const PetscReal *u, PetscReal *turn)
{
  const NeighbourLists lists = pair->lists;
  PetscReal           *start, *end;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * lists->n_slaves, &start, 3 * lists->n_slaves, &end));
  PetscCall(PairNormals(pair, u, end));
  PetscCall(PairNormals(pair, u_0, start));
  for (PetscInt q = 0; q < lists->n_slaves; q++)
    if (lists->nearest[q] >= 0) *turn = PetscMax(*turn, Angle(&start[3 * q], &end[3 * q]));
  PetscCall(PetscFree2(start, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactFacingTurn - returns the largest turn of a normal between two states, among slave points that have faces of
  their own body in their lists.

  Collective

  Input Parameters:
+ contact - the contact, with lists that were made at the first state
. u_0     - local displacements of that state, u_0[n_nodes*dim] (length), ghosts included
- u       - those of the second state

  Output Parameter:
. turn - the angle (radians); 0 where no body meets itself
@*/
PetscErrorCode ContactFacingTurn(Contact contact, const PetscReal *u_0, const PetscReal *u, PetscReal *turn)
{
  PetscFunctionBeginUser;
  *turn = 0;
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].one_body) PetscCall(PairTurns(&contact->pairs[p], u_0, u, turn));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, turn, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
