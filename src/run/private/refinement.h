/* The loop over meshes of a run that is to reach an accuracy: solve, estimate, make the next mesh, until the error of a
   probe is small enough or a limit is met.

   RunScene() has solved the first mesh when RefinementRun() is called. Each mesh is a run of its own, with its results
   in DIR/mesh-1, DIR/mesh-2 and so on; DIR/accuracy.csv has a row for each. The error that counts is the sum of the
   magnitudes of all parts (errors/quantityerror.h). The mesh's parts, those of bodies and contact surfaces, get what
   the other parts leave of it.

   No estimate is trusted alone. The change of the answer from one mesh to the next, at the fall of the error that the
   shares of the cells show, implies what is left (meshplan.h); the error that counts is no smaller than that. Where
   surfaces are in contact, a mesh that is too coarse to tell is no witness, and the next one has to confirm. A first
   mesh whose estimate is below the wish is confirmed by a second one, whose elements all are smaller. A probe that has
   no estimate, such as a peak, is judged by the change alone (MeshPlanImplied()); elements become smaller where the
   strain energy has its error. */
#pragma once
#include "run.h"

PetscErrorCode RefinementRun(Run *, const RunInput *, BurnishStatus *);
