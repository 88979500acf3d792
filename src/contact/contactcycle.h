/* Does the set of nodes in contact repeat itself from one iterate of a solve to the next? The set is known by a number
   that does not depend on the ranks, made from the ids of its nodes; a cycle is a sequence of sets that came twice in a
   row without the residual becoming smaller. */
#pragma once
#include "contact/contact.h"

typedef struct _n_ContactCycle *ContactCycle;

PetscErrorCode ContactCycleCreate(Contact, ContactCycle *);
PetscErrorCode ContactCycleDestroy(ContactCycle *);
/* A solve begins: what came before is forgotten. Not collective. */
PetscErrorCode ContactCycleStart(ContactCycle);
/* The iterate of the last ContactResidual() with forces, and its residual. *period: iterates after which the set
 *repeats, 0: it does not; steady: iterates for which it has not changed. Collective. */
PetscErrorCode ContactCycleLook(ContactCycle, PetscReal residual, PetscInt *period, PetscInt *steady);
/* The nodes (gmsh's tags) that come and go in a cycle of that period, just found. Collective. */
PetscErrorCode ContactCycleLocate(ContactCycle, PetscInt period, char *text, size_t size);
