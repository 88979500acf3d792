/* What a contact pair remembers from step to step: memory, copies, and a place in a checkpoint. */
#include "contact/contactstate.h"

/*@
  ContactStateCreate - makes a state in which all nodes are open, without force, and their gaps unknown.

  Not collective

  Input Parameters:
+ n        - slave nodes of this rank
. penalty  - of every node (force per length and area)
- friction - the state has room for that of friction

  Output Parameter:
. state - the state
@*/
PetscErrorCode ContactStateCreate(PetscInt n, PetscReal penalty, PetscBool friction, ContactState *state)
{
  PetscFunctionBeginUser;
  state->n        = n;
  state->friction = friction;
  state->stick    = 1;
  PetscCall(
    PetscCalloc5(n, &state->penalty, n, &state->status, n, &state->gap, n, &state->offset, n, &state->multiplier));
  for (PetscInt c = 0; c < n; c++) {
    state->penalty[c] = penalty;
    state->gap[c]     = NAN;
  }
  if (friction)
    PetscCall(PetscCalloc4(3 * n, &state->traction, n, &state->slid, n, &state->slips, 3 * n, &state->grip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStateCopy - copies a state to another one of the same size.

  Not collective

  Input Parameter:
. from - the state

  Output Parameter:
. to - the copy
@*/
PetscErrorCode ContactStateCopy(const ContactState *from, ContactState *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->penalty, from->penalty, from->n));
  PetscCall(PetscArraycpy(to->status, from->status, from->n));
  PetscCall(PetscArraycpy(to->gap, from->gap, from->n));
  PetscCall(PetscArraycpy(to->offset, from->offset, from->n));
  PetscCall(PetscArraycpy(to->multiplier, from->multiplier, from->n));
  if (from->friction) {
    PetscCall(PetscArraycpy(to->traction, from->traction, 3 * from->n));
    PetscCall(PetscArraycpy(to->slid, from->slid, from->n));
    PetscCall(PetscArraycpy(to->slips, from->slips, from->n));
    PetscCall(PetscArraycpy(to->grip, from->grip, 3 * from->n));
    to->stick      = from->stick;
    to->dissipated = from->dissipated;
    to->turned     = from->turned;
    to->travel     = from->travel;
  }
  to->raised    = from->raised;
  to->lowered   = from->lowered;
  to->clamped   = from->clamped;
  to->light     = from->light;
  to->augmented = from->augmented;
  to->missed    = from->missed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStateDestroy - frees the arrays of a state.

  Not collective

  Input Parameter:
. state - the state
@*/
PetscErrorCode ContactStateDestroy(ContactState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(state->penalty, state->status, state->gap, state->offset, state->multiplier));
  PetscCall(PetscFree4(state->traction, state->slid, state->slips, state->grip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads what belongs to friction. Energies are stored as sums over all ranks, and loaded on rank 0. */
static PetscErrorCode ArchiveFriction(ContactState *state, Archive archive, const char *name, const Hdf5Table *nodes)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)nodes->sf);
  PetscReal     *slips, energies[2] = {state->dissipated, state->turned};
  PetscMPIInt    rank;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(state->n, &slips));
  for (PetscInt c = 0; c < state->n; c++) slips[c] = state->slips[c];
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/traction", name));
  PetscCall(ArchiveRows(archive, path, nodes, 3, state->traction));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/grip", name));
  PetscCall(ArchiveRows(archive, path, nodes, 3, state->grip));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/slid", name));
  PetscCall(ArchiveRows(archive, path, nodes, 1, state->slid));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/slips", name));
  PetscCall(ArchiveRows(archive, path, nodes, 1, slips));
  for (PetscInt c = 0; c < state->n; c++) state->slips[c] = (PetscBool)(slips[c] != 0);
  PetscCall(PetscFree(slips));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energies, 2, MPIU_REAL, MPIU_SUM, comm));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/stick", name));
  PetscCall(ArchiveReals(archive, path, 1, &state->stick));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/travel", name));
  PetscCall(ArchiveReals(archive, path, 1, &state->travel));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/dissipated", name));
  PetscCall(ArchiveReals(archive, path, 2, energies));
  if (ArchiveLoads(archive)) {
    state->dissipated = rank ? 0 : energies[0];
    state->turned     = rank ? 0 : energies[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStateArchive - saves or loads a state by node.

  Collective

  Input Parameters:
+ archive - says whether it saves or loads
. name    - place in the archive
- nodes   - rows of the state's slave nodes

  Input/Output Parameter:
. state - the state

  Note:
  Counts are stored as sums over all ranks. Loaded, they are on rank 0, as only their sums matter.
@*/
PetscErrorCode ContactStateArchive(ContactState *state, Archive archive, const char *name, const Hdf5Table *nodes)
{
  PetscReal *const   values[]  = {state->penalty, NULL, state->gap, state->offset, state->multiplier};
  static const char *names[]   = {"penalty", "status", "gap", "offset", "multiplier"};
  PetscInt          *updates[] = {&state->raised, &state->lowered,   &state->clamped,
                                  &state->light,  &state->augmented, &state->missed};
  PetscInt           all[PETSC_STATIC_ARRAY_LENGTH(updates)];
  PetscReal         *status;
  PetscMPIInt        rank;
  char               path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(state->n, &status));
  for (PetscInt c = 0; c < state->n; c++) status[c] = state->status[c];
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(values); k++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", name, names[k]));
    PetscCall(ArchiveRows(archive, path, nodes, 1, values[k] ? values[k] : status));
  }
  for (PetscInt c = 0; c < state->n; c++) state->status[c] = (ContactStatus)status[c];
  PetscCall(PetscFree(status));
  if (state->friction) PetscCall(ArchiveFriction(state, archive, name, nodes));
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)nodes->sf), &rank));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(updates); k++) all[k] = *updates[k];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, PETSC_STATIC_ARRAY_LENGTH(updates), MPIU_INT, MPI_SUM,
                             PetscObjectComm((PetscObject)nodes->sf)));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/updates", name));
  PetscCall(ArchiveIntegers(archive, path, PETSC_STATIC_ARRAY_LENGTH(updates), all));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(updates) && ArchiveLoads(archive); k++)
    *updates[k] = rank ? 0 : all[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
