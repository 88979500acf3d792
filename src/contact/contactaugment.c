#include "contactimpl.h"

/* ContactTermBound - how far a term in contact may be from its master, on either side (length); 0 where its pair is not
 * augmented. Not collective. */
PetscReal ContactTermBound(const ContactPair *pair, PetscInt c)
{
  if (!pair->scene->augment) return 0;
  return pair->scene->g_max * (pair->scene->window_in_spacings ? pair->size[c] : 1);
}

/* ContactPairBeyond - how the penetrations of an augmented pair stand to their bound in the present state, all ranks.

   Collective. A multiplier may press across an opening as well: what is open by more than the bound and pressed is
   beyond it too. */
PetscErrorCode ContactPairBeyond(const ContactPair *pair, ContactWindow *window)
{
  PetscInt  count[4] = {0, 0, pair->now.augmented, pair->now.missed};
  PetscReal excess   = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal distance =
      PetscAbsReal(pair->now.gap[c] - ContactTermOffset(pair, c, pair->t)) / ContactTermBound(pair, c);

    if (pair->now.status[c] != CONTACT_CLOSED) continue;
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

static PetscReal TermPressure(const ContactPair *pair, PetscInt c)
{
  const LawState state = {pair->now.penalty[c], ContactTermOffset(pair, c, pair->t), pair->now.multiplier[c]};
  LawValue       value = {0, 0, 0};

  if (!PetscIsNanReal(pair->now.gap[c])) pair->law->evaluate(pair->now.gap[c], &state, &value);
  return value.pressure;
}

/* ContactPairAugment - the pressures of a pair become its multipliers, if one of its terms is beyond the bound and they
   may once more in this step.

   Collective, after a converged solve, in the state of its last ContactResidual(). WINDOW_MISSED: the step is to be
   solved again; WINDOW_HOLDS: the state is as it was: only terms that do not press lose their multipliers. A stiff body
   changes its forces little in a solve with a soft penalty; from the second update of a step on, the pressures are
   mixed with those of the updates before. Steps that end beyond the bound are counted.

   Source: Simo and Laursen 1992, Computers & Structures 42, 97-116, Uzawa's update. */
PetscErrorCode ContactPairAugment(ContactPair *pair, ContactWindowState *state)
{
  ContactWindow window;
  PetscReal    *pressure;
  PetscMPIInt   rank;

  PetscFunctionBeginUser;
  PetscCall(ContactPairBeyond(pair, &window));
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
  PetscCall(PetscMalloc1(pair->n, &pressure));
  for (PetscInt c = 0; c < pair->n; c++) pressure[c] = TermPressure(pair, c);
  if (*state == WINDOW_MISSED) PetscCall(AndersonNext(pair->mixing, pair->now.multiplier, pressure));
  for (PetscInt c = 0; c < pair->n; c++) {
    if (pair->now.status[c] == CONTACT_OPEN)
      pair->now.multiplier[c] = 0;
    else if (*state == WINDOW_MISSED)
      pair->now.multiplier[c] = PetscMax(0, pressure[c]);
  }
  PetscCall(PetscFree(pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
