/* Contact along a linear step: the terms that may open or close on it, and how its displacements change their gaps, to
 * first order. */
#pragma once
#include "contact/contact.h"
#include "contact/activeset.h"

typedef struct _n_ContactStep *ContactStep;

/* For a step of the local displacements du from (u, t), tools moving to t_next, with the last residual and tangent
 * there. Collective. */
PetscErrorCode ContactStepCreate(Contact, const PetscReal *u, const PetscReal *du, PetscReal t, PetscReal t_next,
                                 ContactStep *);
PetscErrorCode ContactStepDestroy(ContactStep *);
/* The terms of all ranks, the same on each; they belong to the step. Not collective. */
PetscErrorCode ContactStepGetTerms(ContactStep, PetscInt *n, const ActiveSetTerm **);
/* How local displacements du (prescribed ones included), tools moving from t to t_next, change the gaps (travel[n],
 * length). Collective. */
PetscErrorCode ContactStepTravel(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next, PetscReal *travel);
/* Do these displacements go no further than the terms were chosen for? Collective. */
PetscErrorCode ContactStepWithin(ContactStep, const PetscReal *du, PetscReal t, PetscReal t_next, PetscBool *within);
/* The forces of a pressure of 1 on each of m terms, against the gap's opening, over the free dofs: dense, the caller's.
   rows: the matrix's on this rank. Collective. */
PetscErrorCode ContactStepForces(ContactStep, PetscInt rows, PetscInt m, const PetscInt *which, Mat *B);
/* What presses at the end of a step that predicts (ContactHoldActiveSet()) is what ContactUnpredictedEnergy() leaves
 * out; pressed[n]. Not collective. */
PetscErrorCode ContactStepMarkPredicted(ContactStep, const PetscBool *pressed);
