/* Finds out whether the set of nodes in contact, and of those that slip, repeats itself from iterate to iterate. */
#include "contact/contactcycle.h"
#include "contactimpl.h"
#include "base/gathertable.h"
#include "base/hash.h"

/* Longest period that is looked for. Those seen in runs have 2 or 3. Two of the longest fit into the default number
   of iterations. */
#define CYCLE_LONGEST 8

/* A residual below this part of what it was a period before is progress, and no cycle. */
#define CYCLE_PROGRESS 0.5

/* Nodes that a message names at most. */
#define CYCLE_NAMED 8

enum { CYCLE_ITERATES = 2 * CYCLE_LONGEST + 1 };

struct _n_ContactCycle {
  Contact        contact;
  PetscInt       n;     /* terms of this rank, all pairs */
  PetscInt       looks; /* iterates of this solve */
  uint64_t       set[CYCLE_ITERATES];
  PetscReal      residual[CYCLE_ITERATES];
  unsigned char *state; /* [CYCLE_ITERATES][n] */
};

/* What a term does. What is in contact without friction counts as sticking. */
enum { TERM_OPEN, TERM_STICKS, TERM_SLIPS };

/*@
  ContactCycleCreate - makes room for the sets of a solve.

  Not collective

  Input Parameter:
. contact - the contact, borrowed

  Output Parameter:
. out - the watch for cycles
@*/
PetscErrorCode ContactCycleCreate(Contact contact, ContactCycle *out)
{
  ContactCycle cycle;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&cycle));
  cycle->contact = contact;
  for (int p = 0; p < contact->n_pairs; p++) cycle->n += contact->pairs[p].n;
  PetscCall(PetscCalloc1(CYCLE_ITERATES * cycle->n, &cycle->state));
  *out = cycle;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCycleDestroy - frees the watch.

  Not collective

  Input Parameter:
. cycle - the watch; set to NULL
@*/
PetscErrorCode ContactCycleDestroy(ContactCycle *cycle)
{
  PetscFunctionBeginUser;
  if (!*cycle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*cycle)->state));
  PetscCall(PetscFree(*cycle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCycleStart - begins a solve and forgets the iterates before.

  Not collective

  Input Parameter:
. cycle - the watch
@*/
PetscErrorCode ContactCycleStart(ContactCycle cycle)
{
  PetscFunctionBeginUser;
  cycle->looks = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the present set: its number, which is the same on all ranks, and this rank's part of it. */
static PetscErrorCode TakeSet(ContactCycle cycle, PetscInt slot)
{
  const Contact  contact = cycle->contact;
  unsigned char *state   = &cycle->state[slot * cycle->n];
  uint64_t       sum     = 0;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      const uint64_t  id    = (uint64_t)ContactTermId(pair, c) * (uint64_t)contact->n_pairs + (uint64_t)p;
      const PetscBool slips = (PetscBool)(pair->friction && pair->now.slips[c]);

      *state = pair->now.status[c] != CONTACT_CLOSED ? TERM_OPEN : slips ? TERM_SLIPS : TERM_STICKS;
      if (*state++ != TERM_OPEN) sum += HashFinish(HASH_START ^ (2 * id + slips));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, contact->mesh->comm));
  cycle->set[slot] = sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of the iterate `back` iterates ago. */
static PetscInt Slot(ContactCycle cycle, PetscInt back)
{
  return (cycle->looks - 1 - back) % CYCLE_ITERATES;
}

/* Says whether the last `period` sets came in the same order before, without progress of the residual. */
static PetscBool Repeats(ContactCycle cycle, PetscInt period)
{
  for (PetscInt i = 0; i < period; i++)
    if (cycle->set[Slot(cycle, i)] != cycle->set[Slot(cycle, i + period)]) return PETSC_FALSE;
  return (PetscBool)(cycle->residual[Slot(cycle, 0)] > CYCLE_PROGRESS * cycle->residual[Slot(cycle, period)]);
}

/*@
  ContactCycleLook - takes an iterate, and says whether the sets in contact of the last iterates repeat those before.

  Collective

  Input Parameters:
+ cycle    - the watch, once for each iterate, after its ContactResidual() with forces
- residual - a norm of the iterate's residual, the same on all ranks

  Output Parameters:
+ period - of the cycle that ends here, at least 2; 0: there is none
- steady - iterates before this one that had the same set
@*/
PetscErrorCode ContactCycleLook(ContactCycle cycle, PetscReal residual, PetscInt *period, PetscInt *steady)
{
  PetscInt known;

  PetscFunctionBeginUser;
  cycle->looks++;
  known = PetscMin(cycle->looks, CYCLE_ITERATES);
  PetscCall(TakeSet(cycle, Slot(cycle, 0)));
  cycle->residual[Slot(cycle, 0)] = residual;
  *period = *steady = 0;
  while (*steady + 1 < known && cycle->set[Slot(cycle, *steady + 1)] == cycle->set[Slot(cycle, 0)]) ++*steady;
  if (*steady) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 2; !*period && p <= CYCLE_LONGEST && 2 * p <= known; p++)
    if (Repeats(cycle, p)) *period = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether term i of this rank, of all pairs, changes within the last cycle. */
static PetscBool Changes(ContactCycle cycle, PetscInt period, PetscInt i)
{
  for (PetscInt back = 1; back < period; back++)
    if (cycle->state[Slot(cycle, back) * cycle->n + i] != cycle->state[Slot(cycle, 0) * cycle->n + i])
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Gathers the terms of all ranks that change within the last cycle: twice the pair, plus 1 for terms of faces, and
   gmsh's tag of the node or face. */
static PetscErrorCode GatherChanges(ContactCycle cycle, PetscInt period, GatherTable *table)
{
  const Contact contact = cycle->contact;
  PetscReal    *rows;
  PetscInt      n = 0, i = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * cycle->n, &rows));
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++, i++) {
      const PetscBool face = (PetscBool)(c >= pair->n_sides);

      if (!Changes(cycle, period, i)) continue;
      rows[2 * n] = 2 * p + (face ? 1 : 0);
      rows[2 * n++ + 1] =
        face ? (PetscReal)pair->slaves->faces[pair->face[c - pair->n_sides]].tag : (PetscReal)ContactTermTag(pair, c);
    }
  }
  PetscCall(GatherTableCreate(contact->mesh->comm, 2, n, rows, table));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCycleLeast - returns the least residual of the iterates of a cycle.

  Not collective, the same on all ranks

  Input Parameters:
+ cycle  - the watch
- period - of ContactCycleLook()
@*/
PetscReal ContactCycleLeast(ContactCycle cycle, PetscInt period)
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt back = 0; back < period; back++) least = PetscMin(least, cycle->residual[Slot(cycle, back)]);
  return least;
}

/*@
  ContactCycleLocate - writes the nodes and faces (gmsh's tags) that come and go in a cycle, such as "the contact set
  repeats every 3 iterations, 2 nodes come and go: node 17 of 'crown', node 21 of 'crown'".

  Collective

  Input Parameters:
+ cycle  - the watch, after ContactCycleLook() has found the period
. period - of the cycle
- size   - characters that the text holds

  Output Parameter:
. text - the message
@*/
PetscErrorCode ContactCycleLocate(ContactCycle cycle, PetscInt period, char *text, size_t size)
{
  PetscInt    faces     = 0;
  char        count[64] = "";
  GatherTable table;
  size_t      used;

  PetscFunctionBeginUser;
  PetscCall(GatherChanges(cycle, period, &table));
  for (PetscInt k = 0; k < table.n; k++) faces += (PetscInt)table.row[2 * k] % 2;
  if (faces) PetscCall(PetscSNPrintf(count, sizeof(count), " and %" PetscInt_FMT " faces", faces));
  PetscCall(PetscSNPrintf(
    text, size, "the contact set repeats every %" PetscInt_FMT " iterations, %" PetscInt_FMT " nodes%s come and go:",
    period, table.n - faces, count));
  for (PetscInt k = 0; k < PetscMin(table.n, CYCLE_NAMED); k++) {
    const int kind = (int)table.row[2 * k];

    PetscCall(PetscStrlen(text, &used));
    PetscCall(PetscSNPrintf(text + used, size - used, "%s %s %.0f of '%s'", k ? "," : "", kind % 2 ? "face" : "node",
                            (double)table.row[2 * k + 1], ContactPairName(cycle->contact, kind / 2)));
  }
  PetscCall(GatherTableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}
