/* Slave points that go over an edge between two facets. There the normal jumps, and so does the residual.
   ContactLocateTurn() finds the node when a solve has failed, for its message. */
#pragma once
#include "contact/contact.h"

PetscErrorCode ContactLocateTurn(Contact, const PetscReal *u, const PetscReal *u_ahead, PetscReal t, PetscBool *found,
                                 ContactPlace *place);
