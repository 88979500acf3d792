/* Contact along a linear step: the terms that may open or close on it, and how its displacements change their gaps, to
   first order.

   ContactStepCreate() chooses the terms from the state at its start. The active set (activeset.h) finds out which of
   them press at its end, and which of them stick or slip, from ContactStepChange() and the columns that follow from
   ContactStepForces(). ContactStepTravel() tells of the gaps, and how the sides of the terms with friction move along
   each other. */
#pragma once
#include "contact/contact.h"
#include "contact/activeset.h"

typedef struct _n_ContactStep *ContactStep;

PetscErrorCode ContactStepCreate(Contact, const PetscReal *u, const PetscReal *du, PetscReal t, PetscReal t_next,
                                 ContactStep *);
PetscErrorCode ContactStepDestroy(ContactStep *);
PetscErrorCode ContactStepGetTerms(ContactStep, PetscInt *n, const ActiveSetTerm **);
PetscErrorCode ContactStepForesee(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next);
PetscInt       ContactStepParts(ContactStep);
PetscErrorCode ContactStepTravel(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next, PetscReal *travel,
                                 PetscReal *slide);
PetscErrorCode ContactStepChange(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next, PetscReal *change);
PetscErrorCode ContactStepWithin(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next, PetscBool *within);
PetscErrorCode ContactStepForces(ContactStep, PetscInt rows, PetscInt m, const PetscInt *which, Mat *B);
PetscErrorCode ContactStepMeets(ContactStep, const PetscBool *pressed, PetscBool *meets);
PetscErrorCode ContactStepMarkPredicted(ContactStep, const PetscBool *pressed);
