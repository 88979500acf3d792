/* What a contact pair remembers from step to step of each slave node that carries area: all that a cutback or a
   checkpoint saves and restores. */
#pragma once
#include "files/archive.h"

typedef enum { CONTACT_OPEN, CONTACT_CLOSED } ContactStatus;

typedef struct {
  PetscInt       n;
  PetscReal     *penalty; /* force per length and area */
  ContactStatus *status;
  PetscReal     *gap;                             /* weighted gap (length); NaN: no master is near */
  PetscReal     *offset;                          /* g_0, subtracted from the gap (length) */
  PetscReal     *multiplier;                      /* pressure where the gap is at its offset; 0 without augmentation */
  PetscInt       raised, lowered, clamped, light; /* what the adjustment of the penalty did so far, on this rank */
  /* Of friction, NULL without it: traction against the slip (three components, force per area), whether the node slips,
     and the length that it has slipped so far. */
  PetscBool  friction; /* there is room for these; without nodes they are NULL on a rank */
  PetscReal *traction, *slid;
  PetscBool *slips;
  PetscReal *grip;       /* the traction where there is no elastic slip, as it is stored; 0 without augmentation */
  PetscReal  stick;      /* factor on the automatic penalty of what sticks, the same on all ranks */
  PetscReal  dissipated; /* energy that friction has taken so far on this rank */
  PetscReal  turned;     /* part of it that nodes took whose slip turned much within a step */
  PetscReal  travel;     /* largest travel of contact in a step so far, see ContactTravel(); the same on all ranks */
  PetscInt   augmented;  /* times that pressures became multipliers; on rank 0 */
  PetscInt   missed;     /* steps that ended beyond the bound after all updates; on rank 0 */
} ContactState;

PetscErrorCode ContactStateCreate(PetscInt n, PetscReal penalty, PetscBool friction, ContactState *);
PetscErrorCode ContactStateCopy(const ContactState *from, ContactState *to);
PetscErrorCode ContactStateDestroy(ContactState *);
PetscErrorCode ContactStateArchive(ContactState *, Archive, const char *name, const Hdf5Table *nodes);
