/* Which facets can come near a slave point: how far both may move against each other follows from how they moved
   before. WayBegin() takes in how slave points and contact nodes have moved, WayApproach() bounds how far a facet and a
   slave point approach each other, and WayEnd() frees what these use. */
#pragma once
#include "searchimpl.h"

PetscErrorCode WayBegin(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion);
PetscErrorCode WayEnd(ContactSearch);
PetscReal      WayApproach(const Nearest *look, const Candidate *c);
int            WayNarrow(const Nearest *look, PetscReal reach, int n, int *found);
