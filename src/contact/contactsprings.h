/* Weak springs that hold bodies which contact alone is to hold, until it does.

   They join the surfaces of pairs with `stabilise: true` to where these were. After a solve the springs are relaxed and
   the step is solved again, until no force is left in them. So an accepted state is an equilibrium without springs, and
   while nothing touches, a force moves its body on from pass to pass. All functions accept NULL for no springs. */
#pragma once
#include "contact/contact.h"

typedef struct _n_Stabiliser *ContactSprings;

PetscErrorCode ContactSpringsCreate(Contact, Vec like, ContactSprings *);
PetscErrorCode ContactSpringsDestroy(ContactSprings *);
PetscErrorCode ContactSpringsRelax(ContactSprings, Vec x);
PetscErrorCode ContactSpringsResidual(ContactSprings, Vec x, Vec F);
PetscErrorCode ContactSpringsEnergy(ContactSprings, Vec x, PetscReal *energy);
PetscErrorCode ContactSpringsTangent(ContactSprings, Mat A);
PetscErrorCode ContactSpringsLoad(ContactSprings, Vec x, PetscReal *force, PetscReal *energy);
