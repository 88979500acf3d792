/* How far slave points and facets may yet move against each other, from how they have moved before. WayBegin() takes in
   the ways of the slave points, WayOf() gives one of them to a tree of candidates, WayApproach() follows from it for
   one candidate, and WayEnd() frees the ways. */
#pragma once
#include "searchimpl.h"

PetscErrorCode WayBegin(ContactSearch, const PetscReal *u, PetscReal t, PetscReal motion);
PetscErrorCode WayEnd(ContactSearch);
BoxTreeWay     WayOf(ContactSearch, PetscInt q);
PetscReal      WayApproach(const Nearest *, const Candidate *);
