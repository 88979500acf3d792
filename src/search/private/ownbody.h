/* The slave point's own body, which separates the point from what lies behind it. Where any side of a body may meet any
   other one, a wall's far side opposes the near side as a partner does, and the point lies behind it by the wall's
   thickness. A facet in front of the point is never hidden. One behind it is a partner that was entered, if it is no
   deeper than what can be told from a wall: then it lies inside the point's own material.

   OwnBodyHides() tells whether a candidate is hidden behind the point's own body. OwnBodyTurnsFrom() tells whether the
   point's face looks away from its foot on a candidate, as the outside of a pipe does from its bore on the other side.
   OwnBodyTells() answers both questions where the hull of the candidate is enough, which spares most feet.
   OwnBodyIsWedge() tells whether a face next to the point's own one is the other side of a sharp edge.
   OwnBodyBehind() tells from which distance on one of the two is sure to hold, so that the tree can leave it out. */
#pragma once
#include "searchimpl.h"

PetscBool OwnBodyHides(const Nearest *, const Candidate *, const Foot *);
PetscBool OwnBodyTells(const Nearest *, const Candidate *, PetscBool *hidden);
PetscReal OwnBodyBehind(const Nearest *);
PetscReal OwnBodyFarthest(PetscBool one_body, PetscReal height, PetscReal size);
PetscBool OwnBodyTurnsFrom(const Nearest *, const Candidate *, const Foot *);
PetscBool OwnBodyIsWedge(const Nearest *, const Candidate *);
