/* Penalties and multipliers of a pair over the steps: how they follow the penetrations, and how penetrations relate
   to their window. */
#include "base/largest.h"
#include "contactimpl.h"
#include "penaltyrule.h"

/* A penetration is known well enough to be judged when the last iterate moved it by no more than this part of g_min. */
#define CONTACT_GAPS_CONVERGED 0.1

/* Number of times in one step that the penalties of a pair are adjusted until their window holds. A penalty that
   starts 1e8 times too small needs four with the default clamp. Neighbours that share the load need two or three
   more. */
#define CONTACT_MAX_ADJUST 12

/* The rule of Chamoret et al. for a term: its window, bounds and clamp. */
static PenaltyRule TermRule(const ContactPair *pair, PetscInt c)
{
  const SceneContact *scene = pair->scene;
  const PetscReal     unit  = scene->window_in_spacings ? pair->size[c] : 1;

  return PenaltyMakeRule(unit * scene->g_min, unit * scene->g_max, scene->adjust_converged, scene->clamp,
                         pair->automatic, scene->range);
}

/* Penetration of a term in the present state (length). Negative: apart; NaN: no master is near. */
static PetscReal TermPenetration(const ContactPair *pair, PetscInt c)
{
  return ContactTermOffset(pair, c, pair->t) - pair->now.gap[c];
}

/* What the rule says of a term in the present state. */
static PenaltyUpdate TermUpdate(const ContactPair *pair, PetscInt c, PetscReal largest)
{
  const PenaltyRule rule = TermRule(pair, c);
  PenaltyUpdate     update;

  PenaltyAdjust(&rule, TermPenetration(pair, c), largest > 0 ? ContactTermForce(pair, c) / largest : 0,
                pair->now.penalty[c], &update);
  return update;
}

/* How the penetrations and elastic slips of an augmented pair relate to their bound in the present state, over all
   ranks. A multiplier may also press across an opening, so that a term that is open by more than the bound and presses
   is beyond it too. */
static PetscErrorCode PairBeyond(const ContactPair *pair, ContactWindow *window)
{
  PetscInt  count[4] = {0, 0, pair->now.augmented, pair->now.missed};
  PetscReal excess   = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscReal distance =
      PetscAbsReal(pair->now.gap[c] - ContactTermOffset(pair, c, pair->t)) / ContactTermBound(pair, c);

    if (pair->now.status[c] != CONTACT_CLOSED) continue;
    if (pair->friction) distance = PetscMax(distance, FrictionTermBeyond(pair, c));
    count[0]++;
    count[1] += distance > 1;
    excess = PetscMax(excess, distance);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 4, MPIU_INT, MPI_SUM, pair->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &excess, 1, MPIU_REAL, MPI_MAX, pair->mesh->comm));
  *window = (ContactWindow){.loaded    = count[0],
                            .outside   = count[1],
                            .excess    = excess,
                            .augmented = count[2],
                            .missed    = count[3]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pressure of a term in the present state with its whole penalty: the next multiplier. */
static PetscReal TermPressure(const ContactPair *pair, PetscInt c)
{
  const LawState state = ContactTermState(pair, c, pair->t, PETSC_MAX_REAL);
  LawValue       value = {0, 0, 0};

  if (!PetscIsNanReal(pair->now.gap[c])) pair->law->evaluate(pair->now.gap[c], &state, &value);
  return value.pressure;
}

/* The pressures and tractions of a pair become its multipliers, if one of its terms is beyond the bound and updates
   are left in this step. Collective, after a converged solve, in the state of its last ContactResidual().
   WINDOW_MISSED: the step must be solved again. WINDOW_HOLDS: the state is as it was, and only terms that do not press
   lose their multipliers. A stiff body changes its forces little in a solve with a soft penalty, so from the second
   update of a step on, the pressures are mixed with those of the updates before. Steps that end beyond the bound are
   counted. Source: Simo and Laursen (1992), Computers & Structures 42, 97-116, Uzawa's update. */
static PetscErrorCode PairAugment(ContactPair *pair, ContactWindowState *state)
{
  ContactWindow  window;
  const PetscInt n = pair->friction ? 3 * pair->n : pair->n;
  PetscReal     *before, *next; /* pressures, and two components of each traction */
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCall(PairBeyond(pair, &window));
  PetscCall(PetscInfo(NULL,
                      "contact '%s' after %" PetscInt_FMT " updates: %" PetscInt_FMT " of %" PetscInt_FMT
                      " nodes beyond g_max, up to %g times\n",
                      pair->scene->name, pair->updates, window.outside, window.loaded, (double)window.excess));
  PetscCallMPI(MPI_Comm_rank(pair->mesh->comm, &rank));
  *state = window.outside && pair->updates < pair->scene->max_updates ? WINDOW_MISSED : WINDOW_HOLDS;
  if (!rank) pair->now.augmented += *state == WINDOW_MISSED; /* counts of all ranks are added up */
  if (!rank) pair->now.missed += window.outside && pair->updates == pair->scene->max_updates;
  if (!pair->updates) AndersonStart(pair->mixing);
  pair->updates += window.outside > 0;
  PetscCall(PetscMalloc2(n, &before, n, &next));
  PetscCall(PetscArraycpy(before, pair->now.multiplier, pair->n));
  for (PetscInt c = 0; c < pair->n; c++) next[c] = TermPressure(pair, c);
  if (pair->friction) {
    PetscCall(PetscArraycpy(before + pair->n, pair->friction->grip, 2 * pair->n));
    PetscCall(FrictionGripNext(pair, next + pair->n));
  }
  if (*state == WINDOW_MISSED) PetscCall(AndersonNext(pair->mixing, before, next));
  for (PetscInt c = 0; c < pair->n; c++) {
    if (pair->now.status[c] == CONTACT_OPEN)
      pair->now.multiplier[c] = 0;
    else if (*state == WINDOW_MISSED)
      pair->now.multiplier[c] = PetscMax(0, next[c]);
  }
  if (pair->friction && *state == WINDOW_MISSED) PetscCall(FrictionGripTake(pair, next + pair->n));
  PetscCall(PetscFree2(before, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether some pair adjusts its penalty within the step (converged 1) or from step to step (0). */
static PetscBool AnyAdjusts(Contact contact, int converged)
{
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].scene->adjust && contact->pairs[p].scene->adjust_converged == converged) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Says whether some pair is augmented. */
static PetscBool AnyAugments(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++)
    if (contact->pairs[p].scene->augment) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Largest force of a term of all pairs in the present state, over all ranks. */
static PetscErrorCode LargestForce(Contact contact, PetscReal *largest)
{
  PetscFunctionBeginUser;
  *largest = 0;
  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      *largest = PetscMax(*largest, ContactTermForce(&contact->pairs[p], c));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Penalties and counts of `to` follow the present penetrations, unless they did so too often in this step. count[0]
   is the number of terms that miss the window, without those whose penalty would have to fall below its bound, as a
   penetration that is too small is no error. count[1] is the number of penalties that changed. */
static PetscErrorCode PairAdjust(ContactPair *pair, PetscReal largest, ContactState *to, ContactWindowState *state)
{
  const PetscBool may      = (PetscBool)(pair->updates < CONTACT_MAX_ADJUST);
  PetscInt        count[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PenaltyUpdate update = TermUpdate(pair, c, largest);

    count[0] += update.outside > 0 || (update.outside < 0 && update.change != PENALTY_KEPT);
    count[1] += may && update.change != PENALTY_KEPT;
    if (!may) continue;
    to->penalty[c] = update.penalty;
    to->raised += update.change == PENALTY_RAISED;
    to->lowered += update.change == PENALTY_LOWERED;
    to->clamped += update.clamped;
    to->light += update.light;
    if (update.change != PENALTY_KEPT) pair->before[c] = NAN; /* no change of its gap is known with this penalty */
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, pair->mesh->comm));
  *state = !count[0] ? WINDOW_HOLDS : count[1] ? WINDOW_MISSED : WINDOW_AT_BOUND;
  pair->updates += *state == WINDOW_MISSED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactAdjustPenalty - finds new penalties for the nodes outside their window, or new multipliers, for pairs that
  are solved until the window holds.

  Collective

  Input Parameter:
. contact - the contact after a converged solve, in the state of its last ContactResidual()

  Output Parameter:
. state - WINDOW_HOLDS: nothing was changed; WINDOW_MISSED: the step must be solved again; WINDOW_AT_BOUND: nodes are
          outside, and no penalty could be changed, or they were changed too often

  Note:
  Only pairs whose scene asks for it take part. Source: Chamoret et al. (2004), eq. 16.
@*/
PetscErrorCode ContactAdjustPenalty(Contact contact, ContactWindowState *state)
{
  PetscReal largest;

  PetscFunctionBeginUser;
  *state = WINDOW_HOLDS;
  if (!AnyAdjusts(contact, 1) && !AnyAugments(contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(contact->event_adjust, 0, 0, 0, 0));
  PetscCall(LargestForce(contact, &largest));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair       *pair = &contact->pairs[p];
    ContactWindowState one  = WINDOW_HOLDS;

    if (pair->scene->adjust && pair->scene->adjust_converged) PetscCall(PairAdjust(pair, largest, &pair->now, &one));
    if (pair->scene->augment) PetscCall(PairAugment(pair, &one));
    if (one == WINDOW_MISSED || *state == WINDOW_HOLDS)
      *state = one; /* what changes for one pair may bring the others inside */
  }
  PetscCall(PetscLogEventEnd(contact->event_adjust, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactAdjustNextPenalty - finds new penalties for the next step, for pairs that are adjusted from step to step.

  Collective

  Input Parameter:
. contact - the contact, after ContactAccept()

  Note:
  The present state keeps the penalties that it was solved with; ContactRestore() brings the new ones. Source:
  Chamoret et al. (2004), eq. 16.
@*/
PetscErrorCode ContactAdjustNextPenalty(Contact contact)
{
  ContactWindowState ignored;
  PetscReal          largest;

  PetscFunctionBeginUser;
  if (!AnyAdjusts(contact, 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(contact->event_adjust, 0, 0, 0, 0));
  PetscCall(LargestForce(contact, &largest));
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (pair->scene->adjust && !pair->scene->adjust_converged)
      PetscCall(PairAdjust(pair, largest, &pair->accepted, &ignored));
  }
  PetscCall(PetscLogEventEnd(contact->event_adjust, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactGapsConverged - says whether every closed node of the pairs that adjust moved by no more than a tenth of
  g_min since the last call.

  Collective

  Input Parameter:
. contact - the contact, once for each iterate, after its ContactResidual() with forces

  Output Parameter:
. converged - the same on all ranks

  Note:
  The first call in a solve compares with the accepted state.
@*/
PetscErrorCode ContactGapsConverged(Contact contact, PetscBool *converged)
{
  int yes = 1, any = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (!pair->scene->adjust) continue;
    any = 1;
    for (PetscInt c = 0; c < pair->n; c++) {
      const PetscReal moved = PetscAbsReal(pair->now.gap[c] - pair->before[c]);

      if (pair->now.status[c] == CONTACT_CLOSED && !(moved <= CONTACT_GAPS_CONVERGED * TermRule(pair, c).g_min))
        yes = 0;
      pair->before[c] = pair->now.gap[c];
    }
  }
  if (any) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &yes, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *converged = yes ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairWindow - counts how the present penetrations of a pair relate to their window, and what the adjustment
  did so far, over all ranks.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. window - the counts
@*/
PetscErrorCode ContactPairWindow(Contact contact, int p, ContactWindow *window)
{
  const ContactPair *pair     = &contact->pairs[p];
  PetscInt           count[6] = {0, 0, pair->now.raised, pair->now.lowered, pair->now.clamped, pair->now.light};
  PetscReal          largest, excess = 0;

  PetscFunctionBeginUser;
  if (pair->scene->augment) {
    PetscCall(PairBeyond(pair, window));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LargestForce(contact, &largest));
  for (PetscInt c = 0; c < pair->n && pair->scene->adjust; c++) {
    count[0] += ContactTermForce(pair, c) >= PENALTY_LOADED * largest && pair->now.status[c] == CONTACT_CLOSED;
    count[1] += TermUpdate(pair, c, largest).outside != 0;
    if (pair->now.status[c] == CONTACT_CLOSED)
      excess = PetscMax(excess, TermPenetration(pair, c) / TermRule(pair, c).g_max);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 6, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &excess, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *window = (ContactWindow){.loaded  = count[0],
                            .outside = count[1],
                            .excess  = excess,
                            .raised  = count[2],
                            .lowered = count[3],
                            .clamped = count[4],
                            .light   = count[5]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLocateOutside - writes the pair and the node (gmsh's tag) that misses its window by the largest factor, with
  penetration and penalty.

  Collective

  Input Parameters:
+ contact - the contact
- size    - characters that the text holds

  Output Parameter:
. text - the message
@*/
PetscErrorCode ContactLocateOutside(Contact contact, char *text, size_t size)
{
  PetscReal largest,
    outermost = 0,
    worst[5]  = {-1, 0, 0, 0, 0}; /* tag, penetration, penalty, pair, whether the penalty is at its bound */
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(LargestForce(contact, &largest));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; pair->scene->adjust && c < pair->n; c++) {
      const PenaltyRule rule        = TermRule(pair, c);
      const PetscReal   penetration = TermPenetration(pair, c);
      const int         outside     = TermUpdate(pair, c, largest).outside;
      const PetscReal   factor =
        outside > 0 ? penetration / rule.g_max : rule.g_min / PetscMax(penetration, PETSC_SMALL * rule.g_min);

      if (!outside || factor <= outermost) continue;
      outermost = factor;
      worst[0]  = (PetscReal)ContactTermTag(pair, c);
      worst[1]  = penetration;
      worst[2]  = pair->now.penalty[c];
      worst[3]  = p;
      worst[4]  = outside > 0 && pair->now.penalty[c] >= rule.most;
    }
  }
  PetscCall(LargestOfRanks(contact->mesh->comm, outermost, NULL, &rank, NULL));
  PetscCallMPI(MPI_Bcast(worst, 5, MPIU_REAL, rank, contact->mesh->comm));
  PetscCall(PetscSNPrintf(text, size, "contact '%s': node %.0f is the farthest outside, penetration %g, penalty %g%s",
                          ContactPairName(contact, (int)worst[3]), (double)worst[0], (double)worst[1], (double)worst[2],
                          worst[4] > 0 ? " (penalty.range allows no more)" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSoften - limits what penalties count for in energy, force and tangent, until the next call.

  Not collective

  Input Parameters:
+ contact - the contact
. most    - multiple of a pair's automatic penalty, the same on all ranks; PETSC_MAX_REAL ends the limit
- all     - terms that the last prediction counted on are limited, too

  Note:
  The penalties themselves do not change.
@*/
PetscErrorCode ContactSoften(Contact contact, PetscReal most, PetscBool all)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    pair->most           = most < PETSC_MAX_REAL ? most * pair->automatic : PETSC_MAX_REAL;
    pair->predicted_most = all ? pair->most : PETSC_MAX_REAL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStiffest - finds the largest penalty, as a multiple of its pair's automatic one.

  Collective

  Input Parameter:
. contact - the contact

  Output Parameter:
. most - the same on all ranks
@*/
PetscErrorCode ContactStiffest(Contact contact, PetscReal *most)
{
  PetscFunctionBeginUser;
  *most = 0;
  for (int p = 0; p < contact->n_pairs; p++)
    for (PetscInt c = 0; c < contact->pairs[p].n; c++)
      *most = PetscMax(*most, contact->pairs[p].now.penalty[c] / contact->pairs[p].automatic);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
