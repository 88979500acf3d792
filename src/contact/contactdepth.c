/* How deep a pair stands in its master, as the certificate counts it. */
#include "contactimpl.h"

/* Size of the faces on both sides of a term, the smaller one. */
static PetscReal SmallerSize(const ContactPair *pair, PetscInt c)
{
  PetscReal size = pair->size[c];

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscReal other = NeighbourListsNearestSize(pair->lists, pair->term_point[k]);

    if (other > 0) size = PetscMin(size, other);
  }
  return size;
}

/* Mean gap of a term over its slave points that are not past a free edge of the master (length); NaN without any. There
   the master goes on in thought only: a point that is behind it there stands in nothing. */
static PetscErrorCode GapWithin(const ContactPair *pair, PetscInt c, PetscReal *gap)
{
  const NeighbourLists lists = pair->lists;
  PetscReal            sum = 0, total = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k] * pair->factor[q];
    PetscBool       found  = PETSC_TRUE;

    if (PetscIsNanReal(pair->point_gap[q]) || weight == 0) continue;
    if (pair->master)
      PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, lists->nearest[q], SMOOTHER_GAP, &found));
    if (pair->master && (!found || pair->work->result.beyond > 0)) continue;
    sum += weight * pair->point_gap[q];
    total += weight;
  }
  *gap = total > 0 ? sum / total : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairDepth - finds how deep what is in contact of a pair stands in the master.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual()
- p       - number of the pair

  Output Parameter:
. over_h - largest penetration over the size of the smaller face there

  Note:
  What is past a free edge of the master stands in nothing and does not count.
@*/
PetscErrorCode ContactPairDepth(Contact contact, int p, PetscReal *over_h)
{
  const ContactPair *pair  = &contact->pairs[p];
  PetscReal          edges = 0;

  PetscFunctionBeginUser;
  *over_h = 0;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal offset = ContactTermOffset(pair, c, pair->t), size = SmallerSize(pair, c);
    PetscReal       gap = NAN;

    if (pair->now.status[c] != CONTACT_CLOSED || offset - pair->now.gap[c] <= *over_h * size) continue;
    PetscCall(GapWithin(pair, c, &gap));
    if (!PetscIsNanReal(gap)) *over_h = PetscMax(*over_h, (offset - gap) / size);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, over_h, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  if (pair->ridge) PetscCall(ContactPairDepth(contact, pair->ridge, &edges));
  *over_h = PetscMax(*over_h, edges);
  PetscFunctionReturn(PETSC_SUCCESS);
}
