/* Lists of a pair's neighbours over a step: when they are made, whether a fresh search agrees with them, and what
   happens where it does not. */
#include "contactimpl.h"
#include "base/smoothstep.h"
#include "base/timing.h"

/* A gap from fresh lists agrees with the solve's where the two differ by less than this fraction of the gap, plus the
   next figure. */
#define CONTACT_GAP_AGREES 1e-6

/* Part of the face size by which two gaps may differ besides: the round-off of a closest-point projection. */
#define CONTACT_GAP_ROUND_OFF 1e-11

/* A fit's frame may turn by 5 degrees before the step is solved again with a new one: cosine of that angle. */
#define CONTACT_FRAME_COSINE 0.9962

/* A frame turns back if it is nearer to an earlier one than to the one in force: by this part of the angle's square.
   Frames at an angle of less than about 1e-4 are the same (1 - cosine), so that rounding decides nothing. */
#define CONTACT_FRAME_BACK 0.25
#define CONTACT_FRAME_SAME 1e-8

/* Part of the largest penetration. An open node that its fresh fit finds farther than that behind the master was open
   by mistake. */
#define CONTACT_FIT_AGREES 0.1

/* Offsets of surface to surface contact are frozen in a solve. Gaps may drift with them by this part of the
   penetration that the largest pressure causes at the automatic penalty. */
#define CONTACT_OFFSET_AGREES 0.1

/* Pressures below this part of the largest one of all pairs count as that part where gaps are compared. A body that
   lies loosely between others touches them with what rounding leaves of their forces, and its gaps would never agree
   with themselves: seven loose wires in a barrel that is crimped. */
#define CONTACT_PRESSURE_COUNTS 1e-6

/* The area factor past a free edge is frozen in a solve. A larger change than this makes the step solve again. */
#define CONTACT_FACTOR_AGREES 1e-2

/* Where the change of a factor is more than this part of that before, its secant does not lead to where it settles. */
#define FACTOR_SETTLES 0.5

/* Motions that differ by less than this fraction differ by round-off. */
#define CONTACT_SAME_MOTION 1e-9

/* Part of a slave point's area that takes part, from its foot on the facets: 1 inside, fading to 0 past a free edge.
   That takes one face size, of the slave or of the master, whichever is less. */
static PetscReal EdgeFactor(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  const PetscReal size  = pair->slaves->size[q],
                  width = PetscMin(size, lists->facet_size[lists->facet_ptr[q] + pair->work->result.seed]),
                  past = pair->work->result.beyond / width, depth = PetscMax(0, -pair->work->result.gap) / size;

  return (1 - SmoothStep(past)) * (1 - SmoothStep(2 * past) * SmoothStep(depth / NEIGHBOUR_LISTS_DEEP));
}

/* May a slave point be past a free edge: does a facet of its list have one? */
static PetscBool MayBePast(NeighbourLists lists, PetscInt q)
{
  for (PetscInt i = lists->facet_ptr[q]; i < lists->facet_ptr[q + 1]; i++)
    if (lists->facet[i].free_edges) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Area factors of the slave points for these lists: less than 1 past a free edge, and where the normals do not oppose
   each other. */
static PetscErrorCode PairFactors(const ContactPair *pair, NeighbourLists lists, PetscReal *factor)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscBool found;

    factor[q] = 0;
    if (pair->master && !MayBePast(lists, q)) { /* most points; their foot need not be found for this */
      if (lists->facet_ptr[q + 1] > lists->facet_ptr[q]) factor[q] = lists->share[q];
      continue;
    }
    PetscCall(ContactPointEvaluate(pair, pair->facets, lists, q, lists->nearest[q], SMOOTHER_GAP, &found));
    if (found && !pair->master)
      factor[q] = NeighbourListsOpposed(lists, q, pair->work->result.normal);
    else if (found)
      factor[q] = PetscMin(lists->share[q], EdgeFactor(pair, lists, q));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the slave points their offsets. */
static PetscErrorCode PairSetOffsets(ContactPair *pair)
{
  PetscFunctionBeginUser;
  if (pair->slave_offsets && OffsetsBlank(pair->slave_offsets)) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->slave_offsets && OffsetsMaps(pair->slave_offsets))
    PetscCall(SlavePointsSetMaps(pair->slaves, OffsetsMaps(pair->slave_offsets)));
  else if (pair->slave_offsets)
    PetscCall(
      SlavePointsSetOffsets(pair->slaves, OffsetsGet(pair->slave_offsets), OffsetsTouched(pair->slave_offsets)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes fresh lists and area factors, which become the pair's next ones. Empty lists stay where fresh ones would be
   empty. */
static PetscErrorCode PairSearch(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsGiveBack(pair->search, &pair->next));
  PetscCall(PairSetOffsets(pair));
  pair->next_motion = motion;
  pair->stays       = PETSC_FALSE;
  if (pair->lists && pair->lists->empty) PetscCall(SearchFindsNothing(pair->search, u, t, motion, &pair->stays));
  if (pair->stays) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SearchLists(pair->search, u, t, motion, &pair->next));
  PetscCall(PairFactors(pair, pair->next, pair->next_factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes back what slave points know of their last projection with the lists in force. */
static void PairForgetProjection(ContactPair *pair)
{
  pair->fresh     = PETSC_TRUE;
  pair->projected = PETSC_FALSE;
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) pair->seed[q] = -1;
  for (PetscInt q = 0; pair->friction && q < pair->lists->n_slaves; q++) pair->friction->facet[q] = -1;
}

/* Says whether there are lists that were made for these positions and for at least this motion: the next ones, or
   those in force. The answer is the same on all ranks. */
static PetscErrorCode PairListsServe(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion,
                                     PetscBool changed, PetscBool *serve)
{
  NeighbourLists  lists = pair->next ? pair->next : pair->lists;
  const PetscReal made  = pair->next || pair->stays ? pair->next_motion : pair->motion;
  PetscBool       moved = PETSC_TRUE;
  int             all;

  PetscFunctionBeginUser;
  if (lists && motion <= made * (1 + CONTACT_SAME_MOTION))
    PetscCall(NeighbourListsUpdate(pair->search, lists, u, t, &moved));
  all = !moved && !changed && (pair->next || pair->stays || pair->fresh);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, pair->mesh->comm));
  *serve = all ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the lists in force, with which a step from the present positions began, serve another one from there,
   and moves them back. A step that failed need not search again. The answer is the same on all ranks. */
static PetscErrorCode PairBeginsAgain(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion,
                                      PetscBool *again)
{
  PetscFunctionBeginUser;
  *again = (PetscBool)(pair->begun && motion <= pair->motion * (1 + CONTACT_SAME_MOTION));
  if (!*again) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NeighbourListsGiveBack(pair->search, &pair->next));
  pair->stays = PETSC_FALSE;
  PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, NULL));
  PairForgetProjection(pair);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Between which factors of this step that of slave point q must be: a solution with the lower one asks for more, one
   with the higher one for less. -1 and 2 where none of them is known. fresh: what the present solution asks for. */
static void FactorBracket(const ContactPair *pair, PetscInt q, PetscReal fresh, PetscReal *low, PetscReal *high)
{
  const PetscReal now = pair->factor[q];

  *low  = fresh > now ? now : pair->factor_low[q];
  *high = fresh < now ? now : pair->factor_high[q];
  if (*low < *high) return;
  if (fresh > now) /* the solution has changed so much that the other end says nothing any more */
    *high = 2;
  else
    *low = -1;
}

/* Factors follow the solution, and the solution follows the factors. Within a step a factor that would turn back is set
   between its last two values, where their secant sees no change any more. Once it is known between which two it must
   be, the secant goes on as long as the change becomes less by FACTOR_SETTLES each time. Else the factor is set to the
   middle: a soft body may answer to a little more or less area by a jump. */
static void PairDampFactors(ContactPair *pair)
{
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    const PetscBool known = (PetscBool)(pair->factor_low[q] >= 0 && pair->factor_high[q] <= 1);
    const PetscReal now = pair->factor[q], change = pair->next_factor[q] - now, before = pair->factor_change[q];
    const PetscReal secant = now - (change != before ? change * (now - pair->factor_before[q]) / (change - before) : 0);
    PetscReal       low, high;

    FactorBracket(pair, q, pair->next_factor[q], &low, &high);
    pair->factor_low[q]  = low;
    pair->factor_high[q] = high;
    if (known && change != 0 && low >= 0 && high <= 1)
      pair->next_factor[q] =
        PetscAbsReal(change) < FACTOR_SETTLES * PetscAbsReal(before) && secant > low && secant < high
          ? secant
          : (low + high) / 2;
    else if (change * before < 0)
      pair->next_factor[q] = secant;
    pair->factor_change[q] = change;
    pair->factor_before[q] = now;
  }
}

/* Rung on which the fit of a slave point stands; RUNGS: it has none. */
static int FitRung(NeighbourLists lists, PetscInt q)
{
  return lists->fit_n[q] ? lists->rung[q] : RUNGS;
}

/* A fit that falls to a lower rung a second time within a step stays there to the end of the step. The surface of that
   rung leads back to where the higher rung holds, whose surface leads to where it does not. */
static void PairKeepRungs(ContactPair *pair)
{
  for (PetscInt q = 0; q < pair->lists->n_slaves && pair->fit.fitted; q++) {
    const int next = FitRung(pair->next, q);

    if (pair->next->rung[q] == RUNG_UNASKED) continue;
    if (next <= FitRung(pair->lists, q)) continue;
    if (pair->fallen[q]) pair->first_rung[q] = PetscMax(pair->first_rung[q], next);
    pair->fallen[q] = PETSC_TRUE;
  }
}

/* Cosine of the angle between the normals of two frames. */
static PetscReal FrameCosine(int dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal cosine = 0;

  for (int d = 0; d < dim; d++) cosine += a[d] * b[d];
  return cosine;
}

/* Lets the search choose rungs and frames of all fits, and factors be what the next lists ask for. Nothing is to be
   done where nothing has been damped since the last time. *changed: the search did not choose some of the fits. */
static PetscErrorCode PairFree(ContactPair *pair, PetscBool *changed)
{
  const PetscInt n = pair->slaves->n;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (pair->undamped || n <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < n; q++) *changed = (PetscBool)(*changed || pair->first_rung[q]);
  for (PetscInt i = 0; i < 3 * n; i++) *changed = (PetscBool)(*changed || pair->frame_kept[i] != 0);
  PetscCall(PetscArrayzero(pair->first_rung, n));
  PetscCall(PetscArrayzero(pair->fallen, n));
  PetscCall(PetscArrayzero(pair->frame_before, 3 * n));
  PetscCall(PetscArrayzero(pair->frame_kept, 3 * n));
  PetscCall(PetscArrayzero(pair->turned_back, n));
  PetscCall(PetscArrayzero(pair->factor_change, n));
  for (PetscInt q = 0; q < n; q++) {
    pair->factor_low[q]  = -1;
    pair->factor_high[q] = 2;
  }
  pair->undamped = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next lists replace those in force. */
static PetscErrorCode PairTakeNext(ContactPair *pair)
{
  PetscFunctionBeginUser;
  pair->motion = pair->next_motion;
  pair->fresh  = PETSC_TRUE;
  pair->begun  = PETSC_FALSE;
  if (pair->stays) {
    pair->stays = PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(NeighbourListsGiveBack(pair->search, &pair->lists));
  pair->lists = pair->next;
  pair->next  = NULL;
  PetscCall(PetscArraycpy(pair->factor, pair->next_factor, pair->lists->n_slaves));
  PairForgetProjection(pair);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pressure of a term at a gap (force per area); negative: the term is open. */
static PetscReal TermPressure(const ContactPair *pair, PetscInt c, PetscReal gap, PetscReal t)
{
  const LawState state = ContactTermState(pair, c, t, PETSC_MAX_REAL);

  return pair->now.multiplier[c] + state.penalty * (state.offset - gap);
}

/* Largest penetration and largest pressure of this rank's terms of the pair at the last residual: most[2], raised
   where they are larger. */
static void RaiseDepth(const ContactPair *pair, PetscReal t, PetscReal most[2])
{
  for (PetscInt c = 0; c < pair->n; c++) {
    if (PetscIsNanReal(pair->now.gap[c])) continue;
    most[0] = PetscMax(most[0], ContactTermOffset(pair, c, t) - pair->now.gap[c]);
    most[1] = PetscMax(most[1], TermPressure(pair, c, pair->now.gap[c], t));
  }
}

/* Largest penetration and largest pressure of the pair at the last residual, over all ranks. */
static PetscErrorCode PairDepth(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *depth,
                                PetscReal *pressure)
{
  PetscReal most[2] = {0, 0};

  PetscFunctionBeginUser;
  RaiseDepth(pair, t, most);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *depth    = most[0];
  *pressure = most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest pressure of all pairs at the last residual, over all ranks. */
static PetscErrorCode LargestPressure(Contact contact, PetscReal t, PetscReal *pressure)
{
  PetscReal most[2] = {0, 0};

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) RaiseDepth(&contact->pairs[p], t, most);
  PetscCallMPI(MPI_Allreduce(&most[1], pressure, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Contact of a soft penalty may lie deeper than the search reaches. Lists are then made for as much motion as leads
   back out. */
static PetscErrorCode PairListsMotion(Contact contact, const ContactPair *pair, PetscReal t, PetscReal *motion)
{
  PetscReal depth, pressure;

  PetscFunctionBeginUser;
  PetscCall(PairDepth(contact, pair, t, &depth, &pressure));
  if (depth > pair->slave->max_size) *motion = PetscMax(*motion, depth);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the lists in force the present offsets. */
static PetscErrorCode PairListsTakeOffsets(ContactPair *pair)
{
  PetscBool changed;

  PetscFunctionBeginUser;
  PetscCall(PairSetOffsets(pair));
  PetscCall(NeighbourListsTakeOffsets(pair->search, pair->lists, &changed));
  if (changed) pair->projected = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lists in force take the offsets that are extrapolated to the end of the step. They were made with those of the
   accepted state. A second search for a change that is far less than the motion of a step would double its cost. */
static PetscErrorCode PairExtrapolateOffsets(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal t_next)
{
  PetscFunctionBeginUser;
  if (!pair->slave_offsets) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OffsetsExtrapolate(pair->slave_offsets, u, t, t_next));
  if (pair->master_offsets) PetscCall(OffsetsExtrapolate(pair->master_offsets, u, t, t_next));
  if (pair->lists->empty && OffsetsBlank(pair->slave_offsets)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PairListsTakeOffsets(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wants offsets on the faces of both sides that are near the other side, as lists that are good for a motion see no
   others. */
static PetscErrorCode PairWantOffsets(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion,
                                      PetscBool begins)
{
  PetscBool *slave, *master;

  PetscFunctionBeginUser;
  if (!pair->slave_offsets || !pair->master_offsets) PetscFunctionReturn(PETSC_SUCCESS);
  if (!OffsetsChoose(pair->slave_offsets) && !OffsetsChoose(pair->master_offsets)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(pair->slave->n_faces, &slave, pair->master->n_faces, &master));
  PetscCall(SearchNearFaces(pair->search, u, t, motion, slave, master));
  PetscCall(OffsetsWant(pair->slave_offsets, slave, begins));
  PetscCall(OffsetsWant(pair->master_offsets, master, begins));
  PetscCall(PetscFree2(slave, master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets of both sides at a state, where lists that are good for a motion need them. */
static PetscErrorCode PairTakeOffsets(ContactPair *pair, const PetscReal *u, PetscReal t, PetscReal motion,
                                      PetscBool begins)
{
  PetscFunctionBeginUser;
  PetscCall(PairWantOffsets(pair, u, t, motion, begins));
  if (pair->slave_offsets) PetscCall(OffsetsTake(pair->slave_offsets, u, t));
  if (pair->master_offsets) PetscCall(OffsetsTake(pair->master_offsets, u, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells, with PETSc's -info, how much contact this rank has to do. */
static PetscErrorCode PairTellWork(const ContactPair *pair)
{
  const NeighbourLists lists = pair->lists;
  PetscInt             fits  = 0;
  PetscBool            asked;

  PetscFunctionBeginUser;
  PetscCall(PetscInfoEnabled(PETSC_SMALLEST_CLASSID, &asked));
  if (!asked) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < lists->n_slaves; s++) fits += lists->fit_n[s] > 0;
  PetscCall(PetscInfo(NULL, "contact '%s': %" PetscInt_FMT " slave points, %" PetscInt_FMT " fits\n", pair->scene->name,
                      lists->n_slaves, fits));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Were the last lists gathered at a state? The answer is the same on all ranks. */
static PetscErrorCode IsGathered(Contact contact, const PetscReal *u, PetscReal t, PetscBool *gathered)
{
  PetscBool same = (PetscBool)(contact->u_gathered && contact->t_gathered == t);
  int       all;

  PetscFunctionBeginUser;
  if (same) PetscCall(PetscArraycmp(contact->u_gathered, u, contact->mesh->n_nodes * contact->mesh->dim, &same));
  all = same;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *gathered = all ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes where lists are gathered, and where they were before. *again: the last ones were gathered there too; the same
   on all ranks. */
static PetscErrorCode NoteGathered(Contact contact, const PetscReal *u, PetscReal t, PetscBool *again)
{
  const PetscInt n = contact->mesh->n_nodes * contact->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(IsGathered(contact, u, t, again));
  if (*again) PetscFunctionReturn(PETSC_SUCCESS);
  if (contact->u_gathered) {
    PetscReal *before = contact->u_before;

    contact->u_before   = contact->u_gathered;
    contact->t_before   = contact->t_gathered;
    contact->u_gathered = before;
  }
  if (!contact->u_gathered) PetscCall(PetscMalloc1(n + 1, &contact->u_gathered));
  PetscCall(PetscArraycpy(contact->u_gathered, u, n));
  contact->t_gathered = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the largest displacement of a node (length), from u_before if that is not NULL, over all ranks. */
static PetscErrorCode LargestMotion(Mesh mesh, const PetscReal *u, const PetscReal *u_before, PetscReal *motion)
{
  const int dim = mesh->dim;

  PetscFunctionBeginUser;
  *motion = 0;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(u[i * dim + d] - (u_before ? u_before[i * dim + d] : 0));
    *motion = PetscMax(*motion, square);
  }
  *motion = PetscSqrtReal(*motion);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, motion, 1, MPIU_REAL, MPIU_MAX, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds by how much prescribed displacements, on from the last ContactGather() to t_next, leave the way there (length,
   the same on all ranks). The bodies may do the same. */
static PetscErrorCode FindAside(Contact contact, PetscReal t_next, PetscReal *aside)
{
  const PetscInt   n = contact->mesh->n_nodes * contact->mesh->dim;
  const PetscReal *u = contact->u_gathered, *before = contact->u_before;
  const PetscReal  since = contact->t_gathered - contact->t_before, ahead = (t_next - contact->t_gathered) / since;
  PetscReal       *next;

  PetscFunctionBeginUser;
  *aside = 0;
  if (!before || t_next == contact->t_gathered) PetscFunctionReturn(PETSC_SUCCESS);
  *aside = PETSC_INFINITY;
  if (!(since > 0)) PetscFunctionReturn(PETSC_SUCCESS); /* bodies were moved where the load stood still */
  PetscCall(PetscMalloc1(n, &next));
  PetscCall(PetscArraycpy(next, u, n));
  PetscCall(LoadsPrescribe(contact->loads, t_next, next));
  for (PetscInt i = 0; i < n; i++)
    next[i] = LoadsPrescribed(contact->loads, i) ? next[i] - u[i] - ahead * (u[i] - before[i]) : 0;
  PetscCall(LargestMotion(contact->mesh, next, NULL, aside));
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells all searches from where the bodies came to a state. u_before NULL: nothing is known of it. aside: by how much
   prescribed displacements leave the way. */
static PetscErrorCode TellBefore(Contact contact, const PetscReal *u_before, PetscReal t_before, const PetscReal *u,
                                 PetscReal aside)
{
  PetscReal size = 0;

  PetscFunctionBeginUser;
  if (u_before) PetscCall(LargestMotion(contact->mesh, u, u_before, &size));
  for (int p = 0; p < contact->n_pairs; p++) SearchSetBefore(contact->pairs[p].search, u_before, t_before, size, aside);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactGather - makes new lists, with new offsets and area factors, for all pairs.

  Collective

  Input Parameters:
+ contact - the contact; its state is not touched
. u       - local displacements of the accepted state, u[n_nodes*dim] (length), ghosts included
. t       - its load parameter
. t_next  - load parameter to which the step goes, for the extrapolation of offsets and the penalty of what sticks
- motion  - relative motion that the lists must be good for (length)

  Note:
  Lists that ContactListsHold() made at the same place for as much motion are taken as they are, and so are those in
  force, also where a step that began with them has failed.
@*/
PetscErrorCode ContactGather(Contact contact, const PetscReal *u, PetscReal t, PetscReal t_next, PetscReal motion)
{
  PetscReal aside;
  PetscBool again;

  PetscFunctionBeginUser;
  PetscCall(NoteGathered(contact, u, t, &again));
  PetscCall(FindAside(contact, t_next, &aside));
  PetscCall(TellBefore(contact, contact->u_before, contact->t_before, u, aside));
  contact->u_begun = u;
  contact->t_begun = t;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PetscReal    needed = motion;
    PetscBool    changed, serve = PETSC_FALSE;

    PetscCall(PairListsMotion(contact, pair, t, &needed));
    if (pair->slave_offsets) PetscCall(PetscLogEventBegin(contact->event_offset, 0, 0, 0, 0));
    PetscCall(PairTakeOffsets(pair, u, t, needed, PETSC_TRUE));
    if (pair->slave_offsets) PetscCall(PetscLogEventEnd(contact->event_offset, 0, 0, 0, 0));
    PetscCall(PairFree(pair, &changed));
    changed = (PetscBool)(changed || SearchLeavesWay(pair->search));
    if (again && !changed) PetscCall(PairBeginsAgain(pair, u, t, needed, &serve));
    if (!serve) PetscCall(PairListsServe(pair, u, t, needed, changed, &serve));
    if (!serve) PetscCall(PairSearch(pair, u, t, needed));
    if (pair->next || pair->stays) PetscCall(PairTakeNext(pair));
    pair->begun = PETSC_TRUE;
    PetscCall(PairTellWork(pair));
    PetscCall(PairExtrapolateOffsets(pair, u, t, t_next));
    if (pair->friction) PetscCall(ContactPairProject(contact, pair, u, t));
    if (pair->friction) PetscCall(FrictionBegin(pair, t, t_next));
    pair->lost    = (ContactLost){0, NAN, 0, -1};
    pair->updates = 0;
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactMotionAtHand - returns the motion (length) for which ContactGather() is to make lists at the accepted state:
  that of the lists that ContactListsHold() made there, where it is enough.

  Not collective

  Input Parameters:
+ contact - the contact
. least   - relative motion that lists must be good for (length)
- motion  - relative motion that new lists are to be good for, at least as much (length)

  Note:
  The answer is the same on all ranks. A step that is longer than the one before needs lists for more motion than those
  that are ready have been made for. As long as these are good for what is expected, new ones would only add to what is
  kept in hand.
@*/
PetscReal ContactMotionAtHand(Contact contact, PetscReal least, PetscReal motion)
{
  PetscReal made = motion;

  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    if (!pair->next && !pair->stays) return motion;
    made = PetscMin(made, pair->next_motion);
  }
  return made < least ? motion : made;
}

/* Key of the point at a place in the list of slave point q. */
static long ListKey(NeighbourLists lists, PetscInt q, PetscInt place)
{
  return lists->point_key[lists->list_point[lists->list_ptr[q] + place]];
}

/* Says whether the points of two lists have the same numbers. */
static PetscBool PointsAlike(NeighbourLists old, NeighbourLists fresh)
{
  if (old->n_points != fresh->n_points) return PETSC_FALSE;
  return (PetscBool)(old->n_points == 0 ||
                     !memcmp(old->point_key, fresh->point_key, old->n_points * sizeof(*old->point_key)));
}

/* Says whether a point of fresh lists lies inside the support of the old fit of slave point q. */
static PetscBool FitSees(NeighbourLists old, NeighbourLists fresh, PetscInt q, PetscInt p)
{
  const int        dim   = old->dim;
  const PetscReal *frame = &old->frame[9 * q], *metric = &old->metric[4 * q];
  PetscReal        x[3], y[2]                          = {0, 0};

  NeighbourListsRelative(fresh, q, p, x);
  for (int a = 0; a < dim - 1; a++)
    for (int d = 0; d < dim; d++) y[a] += frame[3 * a + d] * x[d];
  if (fresh->point_hoop) y[1] = fresh->point_hoop[p];
  return (
    PetscBool)(FitDistance2(dim, old->degree[q], (const double(*)[2])metric, old->bend ? &old->bend[q] : NULL, y) < 1);
}

/* Says whether every point that now lies inside the support of the old fit of slave point q is in its list. Most points
   have the same place in the list as before. */
static PetscBool FitHoldsPoints(NeighbourLists old, NeighbourLists fresh, PetscInt q)
{
  const PetscInt n = old->fit_n[q], first = fresh->list_ptr[q];

  for (PetscInt i = first, at = 0; i < first + fresh->fit_n[q]; i++) {
    const PetscInt p     = fresh->list_point[i];
    const long     key   = fresh->point_key[p];
    PetscBool      known = PETSC_FALSE;

    if (n && ListKey(old, q, at) == key) {
      at = at + 1 < n ? at + 1 : 0;
      continue;
    }
    if (!FitSees(old, fresh, q, p)) continue;
    for (PetscInt k = 0; !known && k < n; k++) {
      const PetscInt place = (at + k) % n;

      known = ListKey(old, q, place) == key ? PETSC_TRUE : PETSC_FALSE;
      if (known) at = (place + 1) % n;
    }
    if (!known) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Says whether every point that now lies inside the support of the old fit of slave point q is in its list, and
   whether the frame has stayed. alike: PointsAlike() of both lists. */
static PetscBool FitHolds(NeighbourLists old, NeighbourLists fresh, PetscBool alike, PetscInt q)
{
  const PetscInt  normal = 9 * q + 3 * (old->dim - 1);
  const PetscReal cosine = FrameCosine(old->dim, &old->frame[normal], &fresh->frame[normal]);

  if (cosine < CONTACT_FRAME_COSINE || old->degree[q] % FIT_BENT != fresh->degree[q] % FIT_BENT) return PETSC_FALSE;
  if (alike && fresh->fit_n[q] <= old->fit_n[q] &&
      !memcmp(&old->list_point[old->list_ptr[q]], &fresh->list_point[fresh->list_ptr[q]],
              fresh->fit_n[q] * sizeof(*fresh->list_point)))
    return PETSC_TRUE;
  return FitHoldsPoints(old, fresh, q);
}

/* Says whether the gaps of a pair may drift with its lists: with offsets that are held in a solve, and with friction,
   where each change of the gaps stays in the tractions. */
static PetscBool PairDrifts(const ContactPair *pair)
{
  return (PetscBool)(pair->formulation.lags || (pair->friction && pair->fit.fitted));
}

/* A fit that the next lists make with another frame or other points, and that turns back a second time within a step,
   keeps the frame that the next lists have, to the end of the step. The frame is that of the points around the nearest
   facet, and so are the points. On a coarse bend two facets may hand a point to and fro: with the fit of either the
   solution has the other one nearest. A fit turns back where the next frame is far nearer to the last one that was
   replaced than to the one in force. Where gaps may drift by little only, frames that turn by less than 5 degrees count
   too. */
static void PairKeepFrames(ContactPair *pair)
{
  const NeighbourLists now = pair->lists, next = pair->next;
  const int            dim   = pair->mesh->dim;
  const PetscBool      alike = PointsAlike(now, next), drifts = PairDrifts(pair);

  for (PetscInt q = 0; q < now->n_slaves && pair->fit.fitted; q++) {
    const PetscInt   normal = 9 * q + 3 * (dim - 1);
    const PetscReal *frame  = &next->frame[normal];
    PetscReal       *before = &pair->frame_before[3 * q];
    const PetscBool  turns = (PetscBool)(now->fit_n[q] && next->fit_n[q] && (drifts || !FitHolds(now, next, alike, q)));
    const PetscReal  turn  = 1 - FrameCosine(dim, &now->frame[normal], frame);
    const PetscBool  back  = (PetscBool)(turns && turn > CONTACT_FRAME_SAME &&
                                       1 - FrameCosine(dim, before, frame) < CONTACT_FRAME_BACK * turn);

    for (int d = 0; d < dim; d++) {
      if (back && pair->turned_back[q]) pair->frame_kept[3 * q + d] = frame[d];
      before[d] = turns ? now->frame[normal + d] : 0;
    }
    pair->turned_back[q] = (PetscBool)(pair->turned_back[q] || back);
  }
}

/* Keeps within a step what would turn to and fro with the next lists. */
static void PairDamp(ContactPair *pair)
{
  if (pair->stays) return; /* nothing has a partner */
  pair->undamped = PETSC_FALSE;
  PairDampFactors(pair);
  PairKeepRungs(pair);
  PairKeepFrames(pair);
}

/* Whether the fit of a slave point holds, once it has been asked for. */
typedef enum { FIT_UNASKED, FIT_HOLDS_ON, FIT_IS_NEW } FitAnswer;

/* What fresh lists find at a solution. */
typedef struct {
  NeighbourLists   lists;
  PetscBool        alike;               /* PointsAlike() with the lists of the solution */
  PetscBool        lags;                /* factors and fits may lag as offsets do */
  const PetscReal *gaps, *factor;       /* of the points */
  FitAnswer       *holds;               /* FitHolds() of each point, as terms share points */
  PetscReal        depth, pressure;     /* largest ones of the pair */
  PetscReal        drift, factor_drift; /* see TermAgrees() */
  PetscReal        area_drift;          /* part of a term's area by which factors that lag may change it */
  PetscReal        t;
} Freshly;

/* By how much the factor that fresh lists ask for at slave point q differs from the one in force, or as far as it is
   known to be at most. */
static PetscReal FactorChange(const ContactPair *pair, PetscInt q, PetscReal fresh)
{
  PetscReal low, high;

  FactorBracket(pair, q, fresh, &low, &high);
  return PetscClipInterval(fresh - pair->factor[q], low - high, high - low);
}

/* Says whether fresh factors change neither the area of a term, weighted by its share of the largest pressure, nor its
   gap by more than offsets may. */
static PetscBool TermFactorsLag(const ContactPair *pair, PetscInt c, const Freshly *fresh, PetscReal share)
{
  PetscReal change = 0, whole = 0, area = 0, added = 0, moment = 0, shifted = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k], more = weight * FactorChange(pair, q, fresh->factor[q]);

    change += PetscAbsReal(more);
    whole += weight;
    if (PetscIsNanReal(fresh->gaps[q])) continue;
    area += weight * pair->factor[q];
    added += more;
    moment += weight * pair->factor[q] * fresh->gaps[q];
    shifted += more * fresh->gaps[q];
  }
  if (share * change > fresh->area_drift * whole) return PETSC_FALSE;
  return (PetscBool)(PetscAbsReal(shifted * area - added * moment) <= fresh->drift * area * (area + added));
}

/* Says whether area factors of a term agree, point by point and weighted by its share of the largest pressure, or are
   as close to a jump of what the solution asks for. */
static PetscBool TermFactorsAgree(const ContactPair *pair, PetscInt c, const Freshly *fresh, PetscReal share)
{
  if (fresh->lags) return TermFactorsLag(pair, c, fresh, share);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];

    if (share * PetscAbsReal(FactorChange(pair, q, fresh->factor[q])) > fresh->factor_drift) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* FitHolds() of slave point q. */
static PetscBool PointHolds(const ContactPair *pair, const Freshly *fresh, PetscInt q)
{
  FitAnswer *answer = &fresh->holds[q];

  if (*answer == FIT_UNASKED)
    *answer = FitHolds(pair->lists, fresh->lists, fresh->alike, q) ? FIT_HOLDS_ON : FIT_IS_NEW;
  return (PetscBool)(*answer == FIT_HOLDS_ON);
}

/* Says whether fresh lists find the same of this term as the solve did. An open term must be open, as far as gaps do
   not drift. On facets a closed gap must agree. On fits the gap changes a little with their frames, so frames and
   points must agree, and with offsets the gap must agree within `drift`. Area factors must agree on both, by
   factor_drift. At a jump of what the solution asks for, fresh factors weight the points of a term in another way, or
   leave it none: closed gaps are compared with the factors in force. Where all may lag, fresh fits may have other
   frames and points, since they say by how much the gap is wrong. depth is the largest penetration of the pair; where
   the pair is augmented and penetrations go to zero, the bound on them counts instead. */
static PetscBool TermAgrees(const ContactPair *pair, PetscInt c, const Freshly *fresh)
{
  const PetscReal gap  = ContactTermGap(pair, fresh->factor, fresh->gaps, c, NULL),
                  same = ContactTermGap(pair, pair->factor, fresh->gaps, c, NULL),
                  rest = ContactTermOnsetGap(pair, c, fresh->t), old = pair->now.gap[c],
                  own   = PetscMax(TermPressure(pair, c, old, fresh->t), TermPressure(pair, c, gap, fresh->t)),
                  share = fresh->pressure > 0 ? PetscMin(own / fresh->pressure, 1) : 1, drift = fresh->drift;
  PetscBool fitted = PETSC_TRUE, holds = PETSC_TRUE;
  PetscReal tolerance;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    fitted = (PetscBool)(fitted && pair->lists->fit_n[pair->term_point[k]] && fresh->lists->fit_n[pair->term_point[k]]);
  tolerance = fitted ? PetscMax(CONTACT_FIT_AGREES * PetscMax(fresh->depth, ContactTermBound(pair, c)), drift)
                     : CONTACT_GAP_AGREES * PetscAbsReal(old) + CONTACT_GAP_ROUND_OFF * pair->size[c] + drift;
  if (!(old - rest < 0) && !(gap - rest < -(fitted ? tolerance : drift))) return PETSC_TRUE;
  if (!TermFactorsAgree(pair, c, fresh, share)) return PETSC_FALSE;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && holds; k++)
    if (fitted && old - rest < 0 && !fresh->lags) holds = PointHolds(pair, fresh, pair->term_point[k]);
  if (!holds) return PETSC_FALSE;
  if (!fitted || old - rest >= 0) return (PetscBool)(PetscAbsReal(same - old) <= tolerance);
  return (PetscBool)(!PetscIsNanReal(same) && (!PairDrifts(pair) || PetscAbsReal(same - old) <= drift));
}

/* Has a term a gap, by the last residual or by the gaps of its points from fresh lists? */
static PetscBool TermHasGap(const ContactPair *pair, PetscInt c, const PetscReal *gaps)
{
  PetscBool has = (PetscBool)!PetscIsNanReal(pair->now.gap[c]);

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && !has; k++)
    has = (PetscBool)!PetscIsNanReal(gaps[pair->term_point[k]]);
  return has;
}

/* Says whether the pair's next lists find the same of each of this rank's terms as the last residual did. most: largest
   pressure of all pairs. */
static PetscErrorCode PairNextAgrees(Contact contact, ContactPair *pair, PetscReal t, PetscReal lag, PetscReal most,
                                     PetscBool passing, PetscBool *agrees)
{
  const PetscInt n = pair->next->n_slaves;
  PetscReal     *gaps, *factor;
  Freshly        fresh = {.lists        = pair->next,
                          .alike        = PointsAlike(pair->lists, pair->next),
                          .lags         = (PetscBool)(passing && pair->formulation.lags),
                          .factor       = pair->next_factor,
                          .factor_drift = CONTACT_FACTOR_AGREES,
                          .area_drift   = lag * CONTACT_OFFSET_AGREES,
                          .t            = t};

  PetscFunctionBeginUser;
  PetscCall(PairDepth(contact, pair, t, &fresh.depth, &fresh.pressure));
  fresh.pressure = PetscMax(fresh.pressure, CONTACT_PRESSURE_COUNTS * most);
  fresh.drift    = PairDrifts(pair) ? lag * CONTACT_OFFSET_AGREES * fresh.pressure / pair->automatic : 0;
  if (pair->friction) fresh.factor_drift = PetscMin(fresh.factor_drift, lag * CONTACT_OFFSET_AGREES);
  *agrees = PETSC_TRUE;
  PetscCall(PetscMalloc2(n, &gaps, n, &factor));
  for (PetscInt q = 0; q < n; q++) factor[q] = PetscMax(pair->factor[q], pair->next_factor[q]);
  fresh.gaps = gaps;
  PetscCall(PetscCalloc1(n, &fresh.holds));
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  PetscCall(ContactPointGaps(pair, pair->next, factor, NULL, NULL, gaps, NULL));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  for (PetscInt c = 0; c < pair->n && *agrees; c++)
    if (TermHasGap(pair, c, gaps)) *agrees = TermAgrees(pair, c, &fresh); /* few have where most have no partner */
  PetscCall(PetscFree2(gaps, factor));
  PetscCall(PetscFree(fresh.holds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next lists, which find something else, replace those in force. Where solutions turn the offsets to and fro, they
   go on with damped ones. */
static PetscErrorCode PairGoOn(ContactPair *pair)
{
  PetscBool slave = PETSC_FALSE, master = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (pair->slave_offsets) PetscCall(OffsetsDamp(pair->slave_offsets, &slave));
  if (pair->master_offsets) PetscCall(OffsetsDamp(pair->master_offsets, &master));
  PairDamp(pair);
  PetscCall(PairTakeNext(pair));
  if ((slave || master) && !pair->lists->empty) PetscCall(PairListsTakeOffsets(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactListsReach - says whether lists still hold every point that the fits of slave points near contact may ask
  for.

  Collective

  Input Parameter:
. contact - the contact, after ContactResidual()

  Output Parameter:
. within - the same on all ranks

  Note:
  A point that slides farther than the margin of its list would be fitted by a part of its neighbours, and nothing
  else would show it.
@*/
PetscErrorCode ContactListsReach(Contact contact, PetscBool *within)
{
  int all = 1, fits = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    fits += pair->fit.fitted;
    for (PetscInt q = 0; q < pair->lists->n_slaves && pair->fit.fitted; q++)
      if (pair->point_gap[q] <= pair->slave->max_size && !NeighbourListsFitReaches(pair->lists, q)) all = 0;
  }
  if (fits) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *within = all ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactListsRenew - makes new lists and area factors for all pairs in the middle of a step; offsets remain those of
  the step.

  Collective

  Input Parameters:
+ contact - the contact
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
. t       - load parameter
- motion  - relative motion that the lists must be good for (length)
@*/
PetscErrorCode ContactListsRenew(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(TellBefore(contact, contact->u_gathered, contact->t_gathered, u, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PetscReal    needed = motion;

    PetscCall(PairListsMotion(contact, pair, t, &needed));
    PetscCall(PairSearch(pair, u, t, needed));
    if (!pair->stays) PetscCall(ContactNoteLost(pair, t));
    PairDamp(pair);
    PetscCall(PairTakeNext(pair));
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactListsHold - says whether lists that are made afresh at the solution find the same of every term as those it
  was found with.

  Collective

  Input Parameters:
+ contact        - the contact
. u              - local displacements of the last ContactResidual() with forces, u[n_nodes*dim] (length), ghosts
                   included
. t              - its load parameter
. motion         - largest motion since the accepted state (length)
. next           - motion that the fresh lists must be good for, as ContactGather() may take them for the next step
                   (length)
. lag            - part of the usual drift by which offsets may lag (no unit)
- passing        - area factors and fits may lag by as much, because no answers are asked for at t

  Output Parameter:
. hold - the same on all ranks

  Notes:
  Near an edge of the master, or on a fillet that is smaller than faces of the slave, area factors and fits follow the
  solution, and the solution follows them. Rubber that rolls there would take as many lists as are allowed in each step.

  Where hold is PETSC_FALSE, the fresh lists of all pairs and fresh offsets have replaced the old ones, and the
  problem must be solved again.
@*/
PetscErrorCode ContactListsHold(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal next,
                                PetscReal lag, PetscBool passing, PetscBool *hold)
{
  PetscReal most;
  int       agree = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(LargestPressure(contact, t, &most));
  PetscCall(TellBefore(contact, contact->u_gathered, contact->t_gathered, u, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair   = &contact->pairs[p];
    PetscReal    needed = next;
    PetscBool    agrees = PETSC_TRUE, late = PETSC_FALSE, serve = PETSC_FALSE;

    if (pair->friction) PetscCall(FrictionAnchorLate(pair, u, t, contact->u_begun, contact->t_begun, &late));
    PetscCall(PairListsMotion(contact, pair, t, &needed));
    PetscCall(PairTakeOffsets(pair, u, t, needed, PETSC_FALSE));
    if (pair->next) PetscCall(PairListsServe(pair, u, t, needed, PETSC_FALSE, &serve));
    if (!serve) PetscCall(PairSearch(pair, u, t, needed));
    if (!pair->stays) {
      PetscCall(ContactNoteLost(pair, t));
      PetscCall(ContactNoteTunnelled(pair, t));
      ContactNoteJumps(pair, motion);
      PetscCall(PairNextAgrees(contact, pair, t, lag, most, passing, &agrees));
    }
    pair->fresh = PETSC_FALSE;
    agree       = agree && agrees && !late;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &agree, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *hold = agree ? PETSC_TRUE : PETSC_FALSE;
  for (int p = 0; p < contact->n_pairs && !agree; p++) PetscCall(PairGoOn(&contact->pairs[p]));
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactTakeOffsetsPart - goes back to a part of the change of the offsets that ContactListsHold() has made. The lists
  go on with those.

  Collective

  Input Parameters:
+ contact - the contact, after ContactListsHold() said that lists do not hold
- part    - of the change, from 0 to 1

  Output Parameter:
. any - there are offsets that change; else nothing was done
@*/
PetscErrorCode ContactTakeOffsetsPart(Contact contact, PetscReal part, PetscBool *any)
{
  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (!pair->formulation.lags) continue;
    *any = PETSC_TRUE;
    if (pair->slave_offsets) OffsetsTakePart(pair->slave_offsets, part);
    if (pair->master_offsets) OffsetsTakePart(pair->master_offsets, part);
    if (!pair->lists->empty) PetscCall(PairListsTakeOffsets(pair));
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads the offsets of a pair that stay, and takes them again. Gathering lists has forgotten them. */
static PetscErrorCode PairArchiveStaying(ContactPair *pair, int p, Archive archive, const PetscReal *u, PetscReal t)
{
  const Offsets      offsets[] = {pair->slave_offsets, pair->master_offsets};
  static const char *names[]   = {"slave", "master"};
  char               name[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    if (!offsets[k]) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "contact/%d/%s_offsets_staying", p, names[k]));
    PetscCall(OffsetsArchiveStaying(offsets[k], archive, name));
    if (ArchiveLoads(archive)) PetscCall(OffsetsTake(offsets[k], u, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads the state from which the bodies came to the accepted one, as if lists had last been gathered there.
   Older files do not have it. */
static PetscErrorCode ArchiveBefore(Contact contact, Archive archive, const PetscReal *u, PetscReal t)
{
  const Mesh mesh  = contact->mesh;
  PetscInt   known = 0;
  PetscBool  there = PETSC_TRUE, again = PETSC_FALSE;
  PetscReal  from = 0, *place = NULL;
  Hdf5Table  nodes;

  PetscFunctionBeginUser;
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "contact/before", &there));
  if (!there) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ArchiveLoads(archive)) {
    PetscCall(IsGathered(contact, u, t, &again));
    place = again ? contact->u_before : contact->u_gathered;
    from  = again ? contact->t_before : contact->t_gathered;
    known = place != NULL;
  }
  PetscCall(ArchiveIntegers(archive, "contact/before", 1, &known));
  PetscCall(ArchiveReals(archive, "contact/before_t", 1, &from));
  if (!known) PetscFunctionReturn(PETSC_SUCCESS);
  if (ArchiveLoads(archive)) {
    if (!contact->u_gathered) PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim + 1, &contact->u_gathered));
    place               = contact->u_gathered;
    contact->t_gathered = from;
  }
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_global, mesh->n_nodes, mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "contact/before_displacement", &nodes, mesh->dim, place));
  PetscCall(Hdf5TableDestroy(&nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactListsArchive - saves or loads the lists that are ready for the next step, by the motion that they were made
  for, the state from which the bodies came and the offsets that stayed.

  Collective

  Input Parameters:
+ contact - the contact, with the accepted state
. archive - says whether it saves or loads
. u       - local displacements of the accepted state, u[n_nodes*dim] (length), ghosts included
- t       - its load parameter

  Note:
  Loading makes lists at the accepted state, and the same fresh ones. Lists for another motion would hold the same
  neighbours in another order of sums.
@*/
PetscErrorCode ContactListsArchive(Contact contact, Archive archive, const PetscReal *u, PetscReal t)
{
  PetscReal *motion;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->n_pairs, &motion));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    motion[p] = pair->next || pair->stays ? pair->next_motion : -1;
  }
  PetscCall(ArchiveReals(archive, "contact/next_motion", contact->n_pairs, motion));
  PetscCall(ArchiveBefore(contact, archive, u, t));
  if (ArchiveLoads(archive)) PetscCall(ContactGather(contact, u, t, t, 0));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairArchiveStaying(&contact->pairs[p], p, archive, u, t));
  for (int p = 0; p < contact->n_pairs && ArchiveLoads(archive); p++)
    if (motion[p] >= 0) PetscCall(PairSearch(&contact->pairs[p], u, t, motion[p]));
  PetscCall(PetscFree(motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}
