/* What a contact pair remembers from step to step, of each slave node that carries area: all that a cutback or a
   checkpoint saves and restores. */
#pragma once
#include "files/archive.h"

typedef enum { CONTACT_OPEN, CONTACT_CLOSED } ContactStatus;

/* All state that a cutback saves and restores: per pair, per slave node of this rank that carries area. */
typedef struct {
  PetscInt       n;
  PetscReal     *penalty; /* force per length and area */
  ContactStatus *status;
  PetscReal     *gap;                             /* weighted gap; NaN: no master near */
  PetscReal     *offset;                          /* g_0, subtracted from the gap */
  PetscReal     *multiplier;                      /* pressure at no penetration; 0 without augmentation */
  PetscInt       raised, lowered, clamped, light; /* what the adjustment of the penalty did so far, on this rank */
  PetscInt       augmented,
    missed; /* times pressures became multipliers; steps that ended beyond the bound all the same; on rank 0 */
} ContactState;

PetscErrorCode ContactStateCreate(PetscInt n, PetscReal penalty, ContactState *);
PetscErrorCode ContactStateCopy(const ContactState *from, ContactState *to);
PetscErrorCode ContactStateDestroy(ContactState *);
PetscErrorCode ContactStateArchive(ContactState *, Archive, const char *name,
                                   const Hdf5Table *nodes); /* nodes: of its n slave nodes */
