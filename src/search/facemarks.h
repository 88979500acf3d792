/* Marks of the faces of a listed surface that pairs with a slave and a master of their own treat. The pairs are
   numbered from 0. A face has the mark 2 k as slave of pair k, and 2 k + 1 as its master. Where a point that is slave of
   pair k meets a master face of that pair, or the other way round, the pair treats both, and the list leaves them out.
   Parts of joined surfaces that do not meet count as such pairs, which come first.

   FaceMarksAdd() marks the faces of a surface, FaceMarksPoints() takes the marks to slave points, FaceMarksTreated()
   says whether a pair treats a point and a face. FaceMarksShare() compares two surfaces. */
#pragma once
#include "search/slavepoints.h"

/* Pairs with a slave and a master beside lists: two marks for each fit into 64 bits. */
enum { FACE_MARKS_PAIRS = 32 };

PetscErrorCode FaceMarksAdd(ContactSurface, ContactSurface of, int mark);
PetscErrorCode FaceMarksPoints(SlavePoints, ContactSurface of, int mark, FaceMarks *);
PetscErrorCode FaceMarksShare(ContactSurface, ContactSurface, PetscBool *share);
PetscBool      FaceMarksTreated(FaceMarks point, FaceMarks face);
