/* Contact along a line of displacements: gaps of all terms at three places on it, and from these the slope of the
   contact energy anywhere between. The slope is piecewise smooth, with a kink where a term closes; a line search that
   knows the kinks steps over them. */
#pragma once
#include "contact/contact.h"

typedef struct _n_ContactLine *ContactLine;

PetscErrorCode ContactLineCreate(Contact, ContactLine *);
PetscErrorCode ContactLineDestroy(ContactLine *);
/* Gaps at place 0, 1 or 2 of the line: displacements u, `lambda` on the line, load parameter t. Collective. */
PetscErrorCode ContactLineSet(ContactLine, int place, PetscReal lambda, const PetscReal *u, PetscReal t);
/* Derivative of this rank's contact energy with lambda, and the second one; stiffness may be NULL. Not collective. */
void ContactLineSlope(ContactLine, PetscReal lambda, PetscReal *slope, PetscReal *stiffness);
/* From u to u_ahead, a trifle farther, is there a slave point in contact of facets whose normal turns at once? place:
 * its slave node. Collective. */
PetscErrorCode ContactLocateTurn(Contact, const PetscReal *u, const PetscReal *u_ahead, PetscReal t, PetscBool *found,
                                 ContactPlace *place);
