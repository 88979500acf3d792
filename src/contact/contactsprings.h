/* Holds bodies that contact alone is to hold, until it does: weak springs from the surfaces of pairs with `stabilise:
   true` to where they were, which are relaxed and the step solved on, until no force is left in them. So an accepted
   state is an equilibrium without springs, and while nothing is touched a force moves its body on from pass to pass. */
#pragma once
#include "contact/contact.h"

typedef struct _n_Stabiliser *ContactSprings;

/* NULL where no pair asks for it. like: a vector of the free dofs. Collective. */
PetscErrorCode ContactSpringsCreate(Contact, Vec like, ContactSprings *);
PetscErrorCode ContactSpringsDestroy(ContactSprings *);
/* All springs are without force at x. Collective. */
PetscErrorCode ContactSpringsRelax(ContactSprings, Vec x);
/* Adds to the residual F, to the energy (all ranks' sum), to the tangent A. NULL: nothing to be added. Collective. */
PetscErrorCode ContactSpringsResidual(ContactSprings, Vec x, Vec F);
PetscErrorCode ContactSpringsEnergy(ContactSprings, Vec x, PetscReal *energy);
PetscErrorCode ContactSpringsTangent(ContactSprings, Mat A);
/* Norm of the springs' forces at x, and the energy in them. Collective. */
PetscErrorCode ContactSpringsLoad(ContactSprings, Vec x, PetscReal *force, PetscReal *energy);
