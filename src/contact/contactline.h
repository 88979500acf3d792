/* Contact along a line of displacements: the gaps of all terms at three places on it, and from these the slope of the
   contact energy at any place.

   The slope is piecewise smooth, with a kink where a term closes. A line search that knows the kinks steps over them.
   ContactLineCreate(), ContactLineSet() at three places, then ContactLineSlope() as often as wanted. */
#pragma once
#include "contact/contact.h"

typedef struct _n_ContactLine *ContactLine;

PetscErrorCode ContactLineCreate(Contact, ContactLine *);
PetscErrorCode ContactLineDestroy(ContactLine *);
PetscErrorCode ContactLineSet(ContactLine, int place, PetscReal lambda, const PetscReal *u, PetscReal t);
void           ContactLineSlope(ContactLine, PetscReal lambda, PetscReal *slope, PetscReal *stiffness);
PetscErrorCode ContactLocateTurn(Contact, const PetscReal *u, const PetscReal *u_ahead, PetscReal t, PetscBool *found,
                                 ContactPlace *place);
