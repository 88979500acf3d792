/* Slave points that were lost behind their master, passed through it or jumped out of it since the step began. */
#include "base/largest.h"
#include "contactimpl.h"

/* A foot that is this little past the edge of a facet is on it, in face sizes. Nodes often lie exactly over nodes. */
#define LOST_ON_FACET 1e-6

/* Half of what a search of all sides takes for entered, so that a point is noticed before the search leaves it out. */
#define LOST_OF_ENTERED 0.5

/* Depth behind the master from which a slave point without contact is lost (length): a face; where the search tells
   partners from the point's own walls, what it does so by. */
static PetscReal DepthThatCounts(const ContactPair *pair, PetscInt c, PetscInt q)
{
  return pair->scene->listed ? LOST_OF_ENTERED * SEARCH_ENTERED * pair->slaves->height[q] : pair->size[c];
}

/* Gaps of slave points, each found once although terms share them. */
typedef struct {
  PetscBool *known;
  PetscReal *gap, *past; /* past: how far the foot is past a free edge, where that is asked for */
} PointGaps;

static PetscErrorCode PointGapsCreate(const ContactPair *pair, PointGaps *gaps)
{
  const PetscInt n = pair->lists->n_slaves;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &gaps->known));
  PetscCall(PetscMalloc2(n, &gaps->gap, n, &gaps->past));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PointGapsDestroy(PointGaps *gaps)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(gaps->known));
  PetscCall(PetscFree2(gaps->gap, gaps->past));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gap of slave point q. Where its fit does not reach there any more, it is that over the facets. */
static PetscReal ReachedGap(const ContactPair *pair, PetscInt q, PointGaps *gaps)
{
  PetscBool found = PETSC_FALSE;

  if (gaps->known[q]) return gaps->gap[q];
  gaps->known[q] = PETSC_TRUE;
  gaps->gap[q]   = pair->point_gap[q];
  if (!NeighbourListsFitReaches(pair->lists, q) &&
      !ContactPointEvaluate(pair, pair->facets, pair->lists, q, -1, SMOOTHER_GAP, &found) && found)
    gaps->gap[q] = pair->work->result.gap;
  return gaps->gap[q];
}

/* Gap of slave point q as the next lists find it: that over the facets, or behind them over the smooth surface, which
   may stand out from the facets of a coarse round body by more than counts as depth. NAN where no master is near. */
static PetscReal NextGap(const ContactPair *pair, PetscInt q, PetscReal offset)
{
  const Smoother *surfaces[2] = {pair->facets, pair->smoother};
  PetscReal       gap         = NAN;
  PetscBool       found       = PETSC_FALSE;

  for (int s = 0; s < 2 && !(gap < 0); s++)
    if (!ContactPointEvaluate(pair, surfaces[s], pair->next, q, -1, SMOOTHER_GAP, &found) && found)
      gap = pair->work->result.gap - offset;
  return gap;
}

/* Says whether the search has lost slave point q of a term. That is so where the present lists find it behind the
   master by more than counts, the next lists find it away from the master or in front of it, and it has
   not left past a free edge. Its term would vanish, and nothing would hold the bodies apart. A term that does not press
   holds nothing: in surface to surface contact it has points on faces that slide around an edge of the master, and the
   lists of the step's start find these behind the side from which they come. */
static PetscBool PointLost(const ContactPair *pair, PetscInt c, PetscInt q, PetscReal t, PointGaps *gaps,
                           ContactLost *lost)
{
  const NeighbourLists next   = pair->next;
  const PetscReal      offset = ContactTermOffset(pair, c, t);

  *lost = (ContactLost){offset - ReachedGap(pair, q, gaps), NAN, pair->size[c], ContactTermTag(pair, c)};
  if (!(lost->depth > DepthThatCounts(pair, c, q))) return PETSC_FALSE;
  if (pair->master && next->facet_ptr[q] == next->facet_ptr[q + 1]) return PETSC_TRUE;
  if (pair->next_factor[q] == 0) return PETSC_FALSE;
  lost->gap = NextGap(pair, q, offset);
  return (PetscBool)(!(lost->gap < 0));
}

/* Keeps the deeper one of two lost points. */
static void KeepDeepest(ContactPair *pair, const ContactLost *lost)
{
  if (lost->depth > pair->lost.depth) pair->lost = *lost;
}

/*@
  ContactNoteLost - notes the slave point that is the farthest behind its master and that the next lists have lost.

  Not collective

  Input Parameters:
+ pair - the pair, after ContactResidual() with forces at (u, t), before its next lists replace those in force
- t    - load parameter
@*/
PetscErrorCode ContactNoteLost(ContactPair *pair, PetscReal t)
{
  PointGaps gaps;

  PetscFunctionBeginUser;
  PetscCall(PointGapsCreate(pair, &gaps));
  for (PetscInt c = 0; c < pair->n_sides; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && pair->force[c] != 0; k++) {
      ContactLost lost;

      if (PointLost(pair, c, pair->term_point[k], t, &gaps, &lost)) KeepDeepest(pair, &lost);
    }
  }
  PetscCall(PointGapsDestroy(&gaps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the gap of slave point q over the very facet that was nearest to it when the lists were made. */
static void NearestGap(const ContactPair *pair, PetscInt q, PointGaps *gaps)
{
  const NeighbourLists lists = pair->lists;
  const int            dim   = lists->dim;
  Facet                facet = lists->facet[lists->facet_ptr[q] + lists->nearest[q]];
  PetscReal            x[FACE_MAX_NODES * 3];
  Foot                 foot;

  if (gaps->known[q]) return;
  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    NeighbourListsRelative(lists, q, lists->list_point[lists->list_ptr[q] + facet.nodes[a]], &x[a * dim]);
    facet.nodes[a] = a;
  }
  facet.free_edges =
    (1 << ElementGet(facet.type)->corners) - 1; /* only a free edge tells a foot past it from one on it */
  FacetProject(dim, &facet, x, &foot);
  gaps->known[q] = PETSC_TRUE;
  gaps->gap[q]   = foot.gap;
  gaps->past[q]  = foot.beyond;
}

/* Says whether slave point q, which is open, is behind the very facet that was nearest to it when the lists were
   made. It has then passed through the master, and another part of it is nearer now. A fit that reaches there knows no
   other part, and lies off the facets of a coarse round body. */
static PetscBool PointTunnelled(const ContactPair *pair, PetscInt c, PetscInt q, PetscReal t, PointGaps *gaps,
                                ContactLost *lost)
{
  const PetscReal offset = ContactTermOffset(pair, c, t);

  if (!(pair->point_gap[q] - offset >= 0)) return PETSC_FALSE;
  if (pair->lists->fit_n[q] && NeighbourListsFitReaches(pair->lists, q)) return PETSC_FALSE;
  NearestGap(pair, q, gaps);
  *lost = (ContactLost){offset - gaps->gap[q], pair->point_gap[q] - offset, pair->size[c], ContactTermTag(pair, c)};
  return (PetscBool)(gaps->past[q] <= LOST_ON_FACET * lost->size && lost->depth > DepthThatCounts(pair, c, q));
}

/*@
  ContactNoteTunnelled - notes the open slave point that has passed the farthest through its master since the lists
  were made, by more than a face size.

  Not collective

  Input Parameters:
+ pair - the pair, after ContactResidual() with forces at (u, t)
- t    - load parameter

  Note:
  Only what was near when the lists were made is known. A point that starts farther away and leaps over the master in
  one step is not seen, nor is a passage through something thinner than a face size.
@*/
PetscErrorCode ContactNoteTunnelled(ContactPair *pair, PetscReal t)
{
  const PetscInt *nearest = pair->lists->nearest; /* of most points none */
  PointGaps       gaps;

  PetscFunctionBeginUser;
  PetscCall(PointGapsCreate(pair, &gaps));
  for (PetscInt c = 0; c < pair->n_sides && pair->master; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      ContactLost lost;

      if (nearest[pair->term_point[k]] >= 0 && PointTunnelled(pair, c, pair->term_point[k], t, &gaps, &lost))
        KeepDeepest(pair, &lost);
    }
  }
  PetscCall(PointGapsDestroy(&gaps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactNoteJumps - notes the term that was closed, is open, and came out of its master faster than anything moved.

  Not collective

  Input Parameters:
+ pair   - the pair, after ContactResidual() with forces
- motion - of any node or tool since the accepted state (length)

  Note:
  Another part of the master, in front of the node, has become the nearest one, and the node is still behind the
  first. An analytic surface has no other part: a tool of that shape that leaves is not among what moved.
@*/
void ContactNoteJumps(ContactPair *pair, PetscReal motion)
{
  if (!pair->master) return;
  for (PetscInt c = 0; c < pair->n_sides; c++) {
    const PetscReal   jump = pair->now.gap[c] - pair->accepted.gap[c];
    const ContactLost lost = {-pair->accepted.gap[c], pair->now.gap[c], pair->size[c], ContactTermTag(pair, c)};

    if (pair->accepted.status[c] == CONTACT_CLOSED && pair->now.status[c] == CONTACT_OPEN &&
        jump > 2 * motion + lost.size)
      KeepDeepest(pair, &lost);
  }
}

/*@
  ContactForgetLost - forgets the slave points that were lost, where a solution before them is taken again.

  Not collective

  Input Parameter:
. contact - the contact
@*/
void ContactForgetLost(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++) contact->pairs[p].lost = (ContactLost){0, NAN, 0, -1};
}

/*@
  ContactLocateLost - says whether a slave point was lost since the last ContactGather(), and writes pair, node
  (gmsh's tag) and depth of the worst.

  Collective

  Input Parameters:
+ contact - the contact
- size    - characters that the text holds

  Output Parameters:
+ lost - the same on all ranks
- text - the message, where lost is PETSC_TRUE

  Note:
  A solution with such a point is no solution: contact is missing where it should press.
@*/
PetscErrorCode ContactLocateLost(Contact contact, PetscBool *lost, char *text, size_t size)
{
  PetscReal   worst[5] = {0, 0, 0, 0, 0}, most; /* depth, gap, face size, tag, pair */
  char        now[64]  = "with no master near";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactLost *here = &contact->pairs[p].lost;

    if (here->depth <= worst[0] || ContactPairPresence(&contact->pairs[p], contact->pairs[p].t) < 1) continue;
    worst[0] = here->depth;
    worst[1] = here->gap;
    worst[2] = here->size;
    worst[3] = (PetscReal)here->tag;
    worst[4] = p;
  }
  PetscCall(LargestOfRanks(contact->mesh->comm, worst[0], &most, &rank, NULL));
  *lost = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*lost) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(worst, 5, MPIU_REAL, rank, contact->mesh->comm));
  if (!PetscIsNanReal(worst[1]))
    PetscCall(PetscSNPrintf(now, sizeof(now), "%.3g in front of another part of it", (double)worst[1]));
  PetscCall(PetscSNPrintf(
    text, size,
    "contact '%s': node %.0f was %.3g behind its master and is found %s (face size %.3g): is the penalty too soft?",
    ContactPairName(contact, (int)worst[4]), (double)worst[3], (double)worst[0], now, (double)worst[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
