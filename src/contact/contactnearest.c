/* The pair to which a place in the mesh belongs, for messages. */
#include "contactimpl.h"

/* Squared distance of a place from the nearest node of a surface on this rank, in the reference configuration. Rigid
   tools have no nodes in the mesh. */
static PetscReal SurfaceDistance2(ContactSurface surface, const PetscReal X[3])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt i = 0; surface && surface->group && i < surface->group->n_nodes; i++) {
    PetscReal Y[3], r2 = 0;

    MeshNodePlace(surface->mesh, surface->group->nodes[i], Y);
    for (int d = 0; d < 3; d++) r2 += PetscSqr(Y[d] - X[d]);
    least = PetscMin(least, r2);
  }
  return least;
}

/*@
  ContactNearestPair - finds the pair whose surfaces have the node nearest to a place.

  Collective

  Input Parameters:
+ contact - the contact; NULL: there are no pairs
. comm    - of the run
- X       - reference coordinates (length)

  Output Parameter:
. pair - its number, the same on all ranks; -1 without pairs. A node of several pairs belongs to the first one.
@*/
PetscErrorCode ContactNearestPair(Contact contact, MPI_Comm comm, const PetscReal X[3], int *pair)
{
  PetscReal nearest = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  *pair = -1;
  for (int p = 0; p < ContactPairs(contact); p++) {
    PetscReal r2 =
      PetscMin(SurfaceDistance2(contact->pairs[p].slave, X), SurfaceDistance2(contact->pairs[p].master, X));

    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r2, 1, MPIU_REAL, MPIU_MIN, comm));
    if (r2 >= nearest) continue;
    nearest = r2;
    *pair   = p;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
