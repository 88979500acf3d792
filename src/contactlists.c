#include "contactimpl.h"

/* A gap from fresh lists agrees with the solve's when it differs by less than this fraction of itself, or of the face size (round-off of a
   closest-point projection). */
#define CONTACT_GAP_AGREES    1e-6
#define CONTACT_GAP_ROUND_OFF 1e-11
/* A fit's frame may turn by 5 degrees before the step is solved again with a new one. */
#define CONTACT_FRAME_COSINE 0.9962
/* An open node whose fresh fit finds it this much of the largest penetration behind the master was open by mistake. */
#define CONTACT_FIT_AGREES 0.1
/* The area factor past a free edge is frozen in a solve; a change above this makes the step solve again. */
#define CONTACT_FACTOR_AGREES 1e-2

static PetscReal SmoothStep(PetscReal x)
{
  x = PetscMax(0, PetscMin(1, x));
  return x * x * (3 - 2 * x);
}

/* Area factors of the slave points for these lists: 1 inside, fading to 0 one face size past a free edge. */
static PetscErrorCode PairFactors(const ContactPair *pair, ContactLists lists, PetscReal *factor)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscBool found;

    factor[q] = 0;
    PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, -1, SMOOTHER_GAP, &found));
    if (found && !pair->master)
      factor[q] = 1;
    else if (found)
      factor[q] = 1 - SmoothStep(pair->work->result.beyond / lists->facet_size[lists->facet_ptr[q] + pair->work->result.seed]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairTakeLists(ContactPair *pair, ContactLists lists, const PetscReal *factor)
{
  PetscFunctionBeginUser;
  PetscCall(ListsDestroy(&pair->lists));
  pair->lists = lists;
  PetscCall(PetscArraycpy(pair->factor, factor, lists->n_slaves));
  for (PetscInt q = 0; q < lists->n_slaves; q++) pair->seed[q] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGather - new lists, and with them new area factors, for all pairs; the blocks of the last tangent are dropped.

   Collective. u[n_nodes*dim]: local displacements (length), ghosts included; t: load parameter, for rigid tools; motion: relative motion
   (length) that the lists must be good for. The contact state is not touched. */
PetscErrorCode ContactGather(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(BlockMatrixReset(contact->blocks)); /* its blocks speak of the old lists */
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];
    ContactLists lists;
    PetscReal   *factor;

    PetscCall(SearchLists(pair->search, u, t, motion, &lists));
    PetscCall(PetscMalloc1(lists->n_slaves, &factor));
    PetscCall(PairFactors(pair, lists, factor));
    PetscCall(PairTakeLists(pair, lists, factor));
    PetscCall(PetscFree(factor));
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A fit point's rank-independent key: node, tool or body, mirror image. */
static PetscInt PointKey(ContactLists lists, PetscInt p)
{
  const PetscInt node = lists->point_node[p];

  return (2 * lists->node_id[node] + (node >= lists->n_deformable)) * SURFACE_MAX_IMAGES + lists->point_image[p];
}

/* Is every point that now lies inside the support of the old fit of slave point q in its list, and has the frame stayed? */
static PetscBool FitHolds(ContactLists old, ContactLists fresh, PetscInt q)
{
  const int        dim   = old->dim;
  const PetscReal *frame = &old->frame[9 * q], *turned = &fresh->frame[9 * q], *metric = &old->metric[4 * q];
  PetscReal        cosine = 0;

  for (int d = 0; d < dim; d++) cosine += frame[3 * (dim - 1) + d] * turned[3 * (dim - 1) + d];
  if (cosine < CONTACT_FRAME_COSINE || old->degree[q] != fresh->degree[q]) return PETSC_FALSE;
  for (PetscInt i = fresh->list_ptr[q]; i < fresh->list_ptr[q] + fresh->fit_n[q]; i++) {
    const PetscInt p = fresh->list_point[i], key = PointKey(fresh, p);
    PetscReal      y[2] = {0, 0}, rho2 = 0;
    PetscBool      known = PETSC_FALSE;

    for (int a = 0; a < dim - 1; a++)
      for (int d = 0; d < dim; d++)
        y[a] += frame[3 * a + d] * ((fresh->point_X[p * dim + d] - fresh->slave_X[q * dim + d]) + (fresh->point_u[p * dim + d] - fresh->slave_u[q * dim + d]));
    for (int a = 0; a < dim - 1; a++)
      for (int b = 0; b < dim - 1; b++) rho2 += y[a] * metric[2 * a + b] * y[b];
    if (rho2 >= 1) continue;
    for (PetscInt k = old->list_ptr[q]; !known && k < old->list_ptr[q] + old->fit_n[q]; k++)
      known = PointKey(old, old->list_point[k]) == key ? PETSC_TRUE : PETSC_FALSE;
    if (!known) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Do fresh lists say the same of this term as the solve did? Open is open. On facets a closed gap must agree; on a fit, whose gap changes a
   little with its frame, frame and points must. The area factor must agree on both. depth: the largest penetration of the pair. */
static PetscBool TermAgrees(const ContactPair *pair, ContactLists fresh, PetscInt c, PetscReal gap, const PetscReal *factor, PetscReal t, PetscReal depth)
{
  const PetscReal offset = ContactTermOffset(pair, c, t), old = pair->now.gap[c];

  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscBool fitted    = (PetscBool)(pair->lists->fit_n[q] && fresh->fit_n[q]);
    const PetscReal tolerance = fitted ? CONTACT_FIT_AGREES * depth : CONTACT_GAP_AGREES * PetscAbsReal(old) + CONTACT_GAP_ROUND_OFF * pair->size[c];

    if (!(old - offset < 0) && !(gap - offset < (fitted ? -tolerance : 0))) continue;
    if (PetscAbsReal(factor[q] - pair->factor[q]) > CONTACT_FACTOR_AGREES) return PETSC_FALSE;
    if (fitted && old - offset < 0) {
      if (PetscIsNanReal(gap) || !FitHolds(pair->lists, fresh, q)) return PETSC_FALSE;
    } else if (!(PetscAbsReal(gap - old) <= tolerance))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Largest penetration of the pair, all ranks, at the last residual. */
static PetscErrorCode PairDepth(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *depth)
{
  PetscFunctionBeginUser;
  *depth = 0;
  for (PetscInt c = 0; c < pair->n; c++)
    if (!PetscIsNanReal(pair->now.gap[c])) *depth = PetscMax(*depth, ContactTermOffset(pair, c, t) - pair->now.gap[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, depth, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsHold - whether lists made afresh at the solution say the same of every term as those it was found with.

   Collective. u, t: of the last ContactResidual() with forces; motion: as of ContactGather(). *hold: the same on all ranks; if it is
   PETSC_FALSE the fresh lists of all pairs have replaced the old, and the problem is to be solved again. */
PetscErrorCode ContactListsHold(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *hold)
{
  ContactLists *lists;
  PetscReal   **factor;
  int           agree = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(PetscMalloc2(contact->n_pairs, &lists, contact->n_pairs, &factor));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];
    PetscReal    depth;

    PetscCall(PairDepth(contact, pair, t, &depth));
    PetscCall(SearchLists(pair->search, u, t, motion, &lists[p]));
    PetscCall(PetscMalloc1(lists[p]->n_slaves, &factor[p]));
    PetscCall(PairFactors(pair, lists[p], factor[p]));
    for (PetscInt c = 0; c < pair->n; c++) {
      PetscReal gap;

      PetscCall(ContactTermGap(pair, lists[p], factor[p], NULL, c, &gap));
      agree = agree && TermAgrees(pair, lists[p], c, gap, factor[p], t, depth);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &agree, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *hold = agree ? PETSC_TRUE : PETSC_FALSE;
  for (int p = 0; p < contact->n_pairs; p++) {
    if (agree)
      PetscCall(ListsDestroy(&lists[p]));
    else
      PetscCall(PairTakeLists(&contact->pairs[p], lists[p], factor[p]));
    PetscCall(PetscFree(factor[p]));
  }
  if (!agree) PetscCall(BlockMatrixReset(contact->blocks));
  PetscCall(PetscFree2(lists, factor));
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
