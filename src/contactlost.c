#include "contactimpl.h"

/* Is slave point q of a term, which the present lists find behind the master by more than the term's face size, away from it or in front of it by the next
   lists, without having left past a free edge? Then the search has lost it: its term would go, and nothing would hold the bodies apart. *depth: how far behind.
 */
static PetscBool PointLost(const ContactPair *pair, PetscInt c, PetscInt q, PetscReal t, PetscReal *depth)
{
  const ContactLists next   = pair->next;
  const PetscReal    offset = ContactTermOffset(pair, c, t);
  PetscReal          gap    = NAN;
  PetscBool          found  = PETSC_FALSE;

  *depth = offset - pair->point_gap[q];
  if (!(*depth > pair->size[c])) return PETSC_FALSE;
  if (pair->master && next->facet_ptr[q] == next->facet_ptr[q + 1]) return PETSC_TRUE;
  if (pair->next_factor[q] == 0) return PETSC_FALSE;
  if (!ContactPointEvaluate(pair, pair->facets, next, q, -1, SMOOTHER_GAP, &found) && found) gap = pair->work->result.gap;
  return (PetscBool)(!(gap - offset < 0));
}

/* ContactNoteLost - remembers the slave point of a pair that is the farthest behind its master and that the next lists have lost.

   Not collective; after ContactResidual() with forces at (u, t), while the next lists wait to replace those it was found with. */
PetscErrorCode ContactNoteLost(ContactPair *pair, PetscReal t)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      PetscReal depth;

      if (!PointLost(pair, c, pair->term_point[k], t, &depth) || depth <= pair->lost.depth) continue;
      pair->lost = (ContactLost){depth, pair->size[c], pair->node[c]};
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactLocateLost - whether a slave point was lost since the last ContactGather(): pair, node (gmsh's tag) and depth of the worst, into text[size].

   Collective. *lost: the same on all ranks. A solution with such a point is none: contact is gone where it should press. */
PetscErrorCode ContactLocateLost(Contact contact, PetscBool *lost, char *text, size_t size)
{
  PetscReal worst[4] = {0, 0, 0, 0}; /* depth, face size, tag, pair */
  struct {
    double depth;
    int    rank;
  } mine = {0, 0}, most;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(contact->mesh->comm, &mine.rank));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactLost *here = &contact->pairs[p].lost;

    if (here->depth <= worst[0]) continue;
    worst[0] = mine.depth = here->depth;
    worst[1]              = here->size;
    worst[2]              = contact->mesh->node_tag[here->node];
    worst[3]              = p;
  }
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, contact->mesh->comm));
  *lost = most.depth > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*lost) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(worst, 4, MPIU_REAL, most.rank, contact->mesh->comm));
  PetscCall(PetscSNPrintf(text, size, "contact '%s': node %.0f is %.3g behind the master, face size %.3g: is the penalty too soft, or the step too large?",
                          ContactPairName(contact, (int)worst[3]), (double)worst[2], (double)worst[0], (double)worst[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
