/* What -check says of the contact pairs. */
#pragma once
#include <stdio.h>
#include "contact/contact.h"

/* One block for each pair: surfaces, penalty, gaps and overlaps before any load; for smooth masters errors, neighbours,
 * guards and fall-backs. Collective. */
PetscErrorCode ContactReport(Contact, FILE *);
