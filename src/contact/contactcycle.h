/* Finds out whether the set of nodes in contact repeats itself from one iterate of a solve to the next.

   A set is known by a number that is made from the ids of its nodes and does not depend on the ranks. A cycle is a
   sequence of sets that came twice in a row without the residual becoming smaller. Each solve begins with
   ContactCycleStart(); ContactCycleLook() takes every iterate; ContactCycleLocate() names the nodes of a cycle. */
#pragma once
#include "contact/contact.h"

typedef struct _n_ContactCycle *ContactCycle;

PetscErrorCode ContactCycleCreate(Contact, ContactCycle *);
PetscErrorCode ContactCycleDestroy(ContactCycle *);
PetscErrorCode ContactCycleStart(ContactCycle);
PetscErrorCode ContactCycleLook(ContactCycle, PetscReal residual, PetscInt *period, PetscInt *steady);
PetscReal      ContactCycleLeast(ContactCycle, PetscInt period);
PetscErrorCode ContactCycleLocate(ContactCycle, PetscInt period, char *text, size_t size);
