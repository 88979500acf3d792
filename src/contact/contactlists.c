#include "contactimpl.h"
#include "base/timing.h"

/* A gap from fresh lists agrees with the solve's when it differs by less than this fraction of itself, or of the face
   size (round-off of a closest-point projection). */
#define CONTACT_GAP_AGREES    1e-6
#define CONTACT_GAP_ROUND_OFF 1e-11
/* A fit's frame may turn by 5 degrees before the step is solved again with a new one. */
#define CONTACT_FRAME_COSINE 0.9962
/* An open node whose fresh fit finds it this much of the largest penetration behind the master was open by mistake. */
#define CONTACT_FIT_AGREES 0.1
/* Offsets of surface contact are frozen in a solve; gaps may drift with them by this part of what the largest pressure
 * presses the automatic penalty in. */
#define CONTACT_OFFSET_AGREES 0.1
/* Where histories break offsets are not carried on to the next step: what they lag behind would come as a jump in it,
 * so they have to agree so much better. */
#define CONTACT_OFFSET_CURRENT 1e-5
/* The area factor past a free edge is frozen in a solve; a change above this makes the step solve again. */
#define CONTACT_FACTOR_AGREES 1e-2
/* Motions that differ by less than this fraction differ by round-off. */
#define CONTACT_SAME_MOTION 1e-9

static PetscReal SmoothStep(PetscReal x)
{
  x = PetscMax(0, PetscMin(1, x));
  return x * x * (3 - 2 * x);
}

/* Area factors of the slave points for these lists: 1 inside, fading to 0 one face size past a free edge. */
static PetscErrorCode PairFactors(const ContactPair *pair, NeighbourLists lists, PetscReal *factor)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscBool found;

    factor[q] = 0;
    PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, lists->nearest[q], SMOOTHER_GAP, &found));
    if (found && !pair->master)
      factor[q] = 1;
    else if (found)
      factor[q] =
        1 - SmoothStep(pair->work->result.beyond / lists->facet_size[lists->facet_ptr[q] + pair->work->result.seed]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fresh lists and area factors become the pair's next ones. */
static PetscErrorCode PairSearch(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsDestroy(&pair->next));
  if (pair->slave_offsets && OffsetsMaps(pair->slave_offsets))
    PetscCall(SlavePointsSetMaps(pair->slaves, OffsetsMaps(pair->slave_offsets)));
  else if (pair->slave_offsets)
    PetscCall(SlavePointsSetOffsets(pair->slaves, OffsetsGet(pair->slave_offsets)));
  PetscCall(SearchLists(pair->search, u, t, motion, &pair->next));
  PetscCall(PairFactors(pair, pair->next, pair->next_factor));
  pair->next_motion = motion;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are there lists that were made for these positions and for that much motion: the next ones, or those in force? The
 * same on all ranks. */
static PetscErrorCode PairListsServe(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion,
                                     PetscBool changed, PetscBool *serve)
{
  NeighbourLists  lists = pair->next ? pair->next : pair->lists;
  const PetscReal made  = pair->next ? pair->next_motion : pair->motion;
  PetscBool       moved = PETSC_TRUE;
  int             all;

  PetscFunctionBeginUser;
  if (lists && motion <= made * (1 + CONTACT_SAME_MOTION))
    PetscCall(NeighbourListsUpdate(pair->search, lists, u, t, &moved));
  all = !moved && !changed && (pair->next || pair->fresh);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, pair->mesh->comm));
  *serve = all ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next lists replace those that serve. */
static PetscErrorCode PairTakeNext(ContactPair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsDestroy(&pair->lists));
  pair->lists     = pair->next;
  pair->motion    = pair->next_motion;
  pair->fresh     = PETSC_TRUE;
  pair->next      = NULL;
  pair->projected = PETSC_FALSE;
  PetscCall(PetscArraycpy(pair->factor, pair->next_factor, pair->lists->n_slaves));
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) pair->seed[q] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest penetration of the pair and largest pressure, all ranks, at the last residual. */
static PetscErrorCode PairDepth(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *depth,
                                PetscReal *pressure)
{
  PetscReal most[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscReal penetration;

    if (PetscIsNanReal(pair->now.gap[c])) continue;
    penetration = ContactTermOffset(pair, c, t) - pair->now.gap[c];
    most[0]     = PetscMax(most[0], penetration);
    most[1]     = PetscMax(most[1], pair->now.multiplier[c] + penetration * pair->now.penalty[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *depth    = most[0];
  *pressure = most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A soft penalty's contact may lie deeper than the search reaches: then lists are made for as much motion as leads back
 * out. */
static PetscErrorCode PairListsMotion(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *motion)
{
  PetscReal depth, pressure;

  PetscFunctionBeginUser;
  PetscCall(PairDepth(contact, pair, t, &depth, &pressure));
  if (depth > pair->slave->max_size) *motion = PetscMax(*motion, depth);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGather - new lists, and with them new offsets and area factors, for all pairs.

   Collective. u[n_nodes*dim]: local displacements (length) of the accepted state, ghosts included; t: its load
   parameter; t_next: where the step goes; motion: relative motion (length) that the lists must be good for. Those that
   ContactListsHold() made at the same place for as much motion are taken as they are, and so are those in force. The
   contact state is not touched. */
PetscErrorCode ContactGather(Contact contact, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair    = &contact->pairs[p];
    PetscReal    needed  = motion;
    PetscBool    changed = PETSC_FALSE, serve;

    PetscCall(PairListsMotion(contact, pair, t, &needed));
    if (pair->slave_offsets) PetscCall(PetscLogEventBegin(contact->event_offset, 0, 0, 0, 0));
    if (pair->slave_offsets) PetscCall(OffsetsExtrapolate(pair->slave_offsets, u, t, t_next, &changed));
    if (pair->master_offsets) PetscCall(OffsetsExtrapolate(pair->master_offsets, u, t, t_next, &changed));
    if (pair->slave_offsets) PetscCall(PetscLogEventEnd(contact->event_offset, 0, 0, 0, 0));
    PetscCall(PairListsServe(pair, u, t, needed, changed, &serve));
    if (!serve) PetscCall(PairSearch(pair, u, t, needed));
    if (pair->next) PetscCall(PairTakeNext(pair));
    pair->lost    = (ContactLost){0, NAN, 0, -1};
    pair->updates = 0;
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is every point that now lies inside the support of the old fit of slave point q in its list, and has the frame
 * stayed? */
static PetscBool FitHolds(NeighbourLists old, NeighbourLists fresh, PetscInt q)
{
  const int        dim   = old->dim;
  const PetscReal *frame = &old->frame[9 * q], *turned = &fresh->frame[9 * q], *metric = &old->metric[4 * q];
  const PetscInt   n      = old->fit_n[q];
  PetscInt         at     = 0;
  PetscReal        cosine = 0;

  for (int d = 0; d < dim; d++) cosine += frame[3 * (dim - 1) + d] * turned[3 * (dim - 1) + d];
  if (cosine < CONTACT_FRAME_COSINE || old->degree[q] != fresh->degree[q]) return PETSC_FALSE;
  for (PetscInt i = fresh->list_ptr[q]; i < fresh->list_ptr[q] + fresh->fit_n[q]; i++) {
    const PetscInt p   = fresh->list_point[i];
    const long     key = fresh->point_key[p];
    PetscReal      x[3], y[2] = {0, 0}, rho2 = 0;
    PetscBool      known = PETSC_FALSE;

    NeighbourListsRelative(fresh, q, p, x);
    for (int a = 0; a < dim - 1; a++)
      for (int d = 0; d < dim; d++) y[a] += frame[3 * a + d] * x[d];
    for (int a = 0; a < dim - 1; a++)
      for (int b = 0; b < dim - 1; b++) rho2 += y[a] * metric[2 * a + b] * y[b];
    if (rho2 >= 1) continue;
    for (PetscInt k = 0; !known && k < n; k++) { /* most points have the places that they had */
      const PetscInt place = (at + k) % n;

      known = old->point_key[old->list_point[old->list_ptr[q] + place]] == key ? PETSC_TRUE : PETSC_FALSE;
      if (known) at = (place + 1) % n;
    }
    if (!known) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Do fresh lists say the same of this term as the solve did? Open is open. On facets a closed gap must agree; on fits,
   whose gap changes a little with their frames, frames and points must, and with offsets the gap within `drift`. The
   area factors must agree on both. depth: the largest penetration of the pair; where it is augmented down to nothing,
   what it may be counts. */
static PetscBool TermAgrees(const ContactPair *pair, NeighbourLists fresh, PetscInt c, PetscReal gap,
                            const PetscReal *factor, PetscReal t, PetscReal depth, PetscReal drift)
{
  const PetscReal rest = ContactTermOnsetGap(pair, c, t), old = pair->now.gap[c];
  PetscBool       fitted = PETSC_TRUE;
  PetscReal       tolerance;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    fitted = (PetscBool)(fitted && pair->lists->fit_n[pair->term_point[k]] && fresh->fit_n[pair->term_point[k]]);
  tolerance = fitted ? PetscMax(CONTACT_FIT_AGREES * PetscMax(depth, ContactTermBound(pair, c)), drift)
                     : CONTACT_GAP_AGREES * PetscAbsReal(old) + CONTACT_GAP_ROUND_OFF * pair->size[c] + drift;
  if (!(old - rest < 0) && !(gap - rest < (fitted ? -tolerance : 0))) return PETSC_TRUE;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (PetscAbsReal(factor[q] - pair->factor[q]) > CONTACT_FACTOR_AGREES) return PETSC_FALSE;
    if (fitted && old - rest < 0 && !FitHolds(pair->lists, fresh, q)) return PETSC_FALSE;
  }
  if (!fitted || old - rest >= 0) return (PetscBool)(PetscAbsReal(gap - old) <= tolerance);
  return (PetscBool)(!PetscIsNanReal(gap) && (!pair->formulation.lags || PetscAbsReal(gap - old) <= drift));
}

/* Do the pair's next lists say the same of each of this rank's terms as the last residual? */
static PetscErrorCode PairNextAgrees(Contact contact, ContactPair *pair, PetscReal t, PetscBool update_offsets,
                                     PetscBool *agrees)
{
  PetscReal depth = 0, pressure = 0, drift, *gaps;

  PetscFunctionBeginUser;
  PetscCall(PairDepth(contact, pair, t, &depth, &pressure));
  drift = pair->formulation.lags ? CONTACT_OFFSET_AGREES * pressure / pair->automatic : 0;
  if (update_offsets) drift *= CONTACT_OFFSET_CURRENT;
  *agrees = PETSC_TRUE;
  PetscCall(PetscMalloc1(pair->next->n_slaves, &gaps));
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  PetscCall(ContactPointGaps(pair, pair->next, pair->next_factor, NULL, NULL, gaps, NULL));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  for (PetscInt c = 0; c < pair->n && *agrees; c++)
    *agrees = TermAgrees(pair, pair->next, c, ContactTermGap(pair, pair->next_factor, gaps, c, NULL), pair->next_factor,
                         t, depth, drift);
  PetscCall(PetscFree(gaps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsReach - whether lists still hold every point that the fits of slave points near contact may ask for: a
   point that slides further than the lists' margin would be fitted by a part of its neighbours, and nothing would show
   it.

   Collective. To be called after ContactResidual(). *within: the same on all ranks. */
PetscErrorCode ContactListsReach(Contact contact, PetscBool *within)
{
  int all = 1, fits = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    fits += pair->fit.fitted;
    for (PetscInt q = 0; q < pair->lists->n_slaves && pair->fit.fitted; q++)
      if (pair->point_gap[q] <= pair->slave->max_size && NeighbourListsSlip(pair->lists, q) > NEIGHBOUR_LISTS_MARGIN)
        all = 0;
  }
  if (fits) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *within = all ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsRenew - new lists and area factors for all pairs in the middle of a step; offsets are those of the step.

   Collective. u, t, motion: as of ContactGather(). */
PetscErrorCode ContactListsRenew(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PetscReal    needed = motion;

    PetscCall(PairListsMotion(contact, pair, t, &needed));
    PetscCall(PairSearch(pair, u, t, needed));
    PetscCall(ContactNoteLost(pair, t));
    PetscCall(PairTakeNext(pair));
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsHold - whether lists made afresh at the solution say the same of every term as those it was found with.

   Collective. u, t: of the last ContactResidual() with forces; motion: since the accepted state (length); next: that
   the fresh lists must be good for, as ContactGather() may take them for the next step. *hold: the same on all ranks;
   if it is PETSC_FALSE the fresh lists of all pairs, and fresh offsets, have replaced the old, and the problem is to be
   solved again. */
PetscErrorCode ContactListsHold(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal next,
                                PetscBool update_offsets, PetscBool *hold)
{
  int agree = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PetscReal    needed = next;
    PetscBool    agrees = PETSC_TRUE;

    PetscCall(PairListsMotion(contact, pair, t, &needed));
    if (pair->slave_offsets) PetscCall(OffsetsTake(pair->slave_offsets, u, t));
    if (pair->master_offsets) PetscCall(OffsetsTake(pair->master_offsets, u, t));
    PetscCall(PairSearch(pair, u, t, needed));
    PetscCall(ContactNoteLost(pair, t));
    ContactNoteTunnelled(pair, t);
    ContactNoteJumps(pair, motion);
    PetscCall(PairNextAgrees(contact, pair, t, update_offsets, &agrees));
    pair->fresh = PETSC_FALSE;
    agree       = agree && agrees;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &agree, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *hold = agree ? PETSC_TRUE : PETSC_FALSE;
  for (int p = 0; p < contact->n_pairs && !agree; p++) PetscCall(PairTakeNext(&contact->pairs[p]));
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsArchive - the fresh lists that stand ready for the next step, by the motion they were made for; loading:
   lists at the accepted state (u, t), and the same fresh ones. Other lists would list as much, in another order of
   sums.

   Collective. u, t: as of ContactGather(). */
PetscErrorCode ContactListsArchive(Contact contact, Archive archive, const PetscReal *u, PetscReal t)
{
  PetscReal *motion;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->n_pairs, &motion));
  for (int p = 0; p < contact->n_pairs; p++) motion[p] = contact->pairs[p].next ? contact->pairs[p].next_motion : -1;
  PetscCall(ArchiveReals(archive, "contact/next_motion", contact->n_pairs, motion));
  if (ArchiveLoads(archive)) PetscCall(ContactGather(contact, u, t, t, 0));
  for (int p = 0; p < contact->n_pairs && ArchiveLoads(archive); p++)
    if (motion[p] >= 0) PetscCall(PairSearch(&contact->pairs[p], u, t, motion[p]));
  PetscCall(PetscFree(motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}
