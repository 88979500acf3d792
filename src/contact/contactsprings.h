/* Holds bodies that contact alone is to hold, until it does: weak springs from the surfaces of pairs with `stabilise: true` to where they were, which are
   relaxed and the step solved on, until no force is left in them. So an accepted state is an equilibrium without springs, and while nothing is
   touched a force moves its body on from pass to pass. */
#pragma once
#include "contact/contact.h"

typedef struct _n_Stabiliser *Stabiliser;

/* NULL where no pair asks for it. like: a vector of the free dofs. Collective. */
PetscErrorCode StabiliserCreate(Contact, Vec like, Stabiliser *);
PetscErrorCode StabiliserDestroy(Stabiliser *);
/* All springs are without force at x. Collective. */
PetscErrorCode StabiliserRelax(Stabiliser, Vec x);
/* Adds to the residual F, to the energy (all ranks' sum), to the tangent A. NULL: nothing to be added. Collective. */
PetscErrorCode StabiliserResidual(Stabiliser, Vec x, Vec F);
PetscErrorCode StabiliserEnergy(Stabiliser, Vec x, PetscReal *energy);
PetscErrorCode StabiliserTangent(Stabiliser, Mat A);
/* Norm of the springs' forces at x, and the energy in them. Collective. */
PetscErrorCode StabiliserLoad(Stabiliser, Vec x, PetscReal *force, PetscReal *energy);
