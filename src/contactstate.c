#include "contactstate.h"

/* ContactStateCreate - open, unstressed, gaps unknown. Not collective. n: slave nodes; penalty: force per length and area. */
PetscErrorCode ContactStateCreate(PetscInt n, PetscReal penalty, ContactState *state)
{
  PetscFunctionBeginUser;
  state->n = n;
  PetscCall(PetscCalloc5(n, &state->penalty, n, &state->status, n, &state->gap, n, &state->offset, n, &state->multiplier));
  for (PetscInt c = 0; c < n; c++) {
    state->penalty[c] = penalty;
    state->gap[c]     = NAN;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactStateCopy - everything, between states of one size. Not collective. */
PetscErrorCode ContactStateCopy(const ContactState *from, ContactState *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->penalty, from->penalty, from->n));
  PetscCall(PetscArraycpy(to->status, from->status, from->n));
  PetscCall(PetscArraycpy(to->gap, from->gap, from->n));
  PetscCall(PetscArraycpy(to->offset, from->offset, from->n));
  PetscCall(PetscArraycpy(to->multiplier, from->multiplier, from->n));
  to->raised  = from->raised;
  to->lowered = from->lowered;
  to->clamped = from->clamped;
  to->light   = from->light;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactStateDestroy - Not collective. */
PetscErrorCode ContactStateDestroy(ContactState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(state->penalty, state->status, state->gap, state->offset, state->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}
