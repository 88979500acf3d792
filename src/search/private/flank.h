/* The flank of a master that a slave point faces: those of the facets near it whose normals oppose its own. It ends
   where a facet that faces the point meets one that does not. There the facet counts as extended, as past a free edge.
   Past a convex end the contact fades out within a face of the slave, half of it on either side of the edge, so that a
   node over the edge keeps the half of its area that lies on the flank.

   FlankSort() finds the facets of the flank. FlankPastEnd() says whether the point is past a facet that it drops, and
   FlankLeaveCorner() chooses between two of them that form a hollow.
   FlankShare() finds its ends, and how far the point takes part, and FlankCuts() where it ends at facets that are none
   of its. FlankIsBeside() says whether the point is beside what it does not face, and FlankNearRidge() whether it is
   near a sharp edge between two facets that both face it. */
#pragma once
#include "searchimpl.h"

/* Bits of convex ends begin here in what FlankShare() says, and those of FlankCuts() after them; those of all ends are
   below. */
enum { FLANK_CONVEX = 16, FLANK_CUT = 256 };

PetscBool FlankFaces(const Nearest *, const Candidate *);
PetscBool FlankIsOwn(const Nearest *, const Candidate *);
int       FlankSort(const Nearest *, int *n, int *found, int *dropped);
PetscReal FlankShare(const Nearest *, int facing, int n, const int *found, int *ends);
void      FlankCuts(const Nearest *, int facing, const int *found, int n, const int *dropped, int *ends);
PetscBool FlankPastEnd(const Nearest *, int n, const int *found);
void      FlankLeaveCorner(Nearest *, int facing, const int *found);
PetscBool FlankIsBeside(const Nearest *, int facing, int n, const int *found);
PetscBool FlankLies(const Nearest *);
PetscReal FlankFoot(const Nearest *, const Candidate *, Foot *);
PetscBool FlankNearRidge(const Nearest *, Neighbourhoods, int facing, const int *found);
