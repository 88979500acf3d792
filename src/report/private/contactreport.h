/* What -check says of the contact pairs: one block for each, with surfaces, penalty, gaps and overlaps before any load;
   for smooth masters also errors, neighbours, guards and fall-backs. */
#pragma once
#include <stdio.h>
#include "contact/contact.h"

PetscErrorCode ContactReport(Contact, FILE *);
