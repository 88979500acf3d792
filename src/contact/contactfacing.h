/* How far surfaces that lie opposite each other turn in a step. Lists are made at its start. They hold the faces that
   oppose a point there, and the part of the point's area that takes part. Where a fold closes, its faces turn towards
   each other, and lists of a long step lack those that meet. */
#pragma once
#include "contact/contact.h"

PetscErrorCode ContactFacingTurn(Contact, const PetscReal *u_0, const PetscReal *u, PetscReal *turn);
