/* A spring at each free dof: force scale * weight (x - anchor), with its energy and tangent.

   The owner gives the weights once and chooses the scale, 1 at first; with 0 there are no springs. They have no force
   at the anchor, which DofSpringsAnchor() moves to a state; at first it is at displacements of 0. Functions that say so
   accept NULL for no springs. */
#pragma once
#include "mesh/mesh.h"

typedef struct _n_DofSprings *DofSprings;

PetscErrorCode DofSpringsCreate(Mesh, const PetscReal *weight, Vec like, DofSprings *);
PetscErrorCode DofSpringsDestroy(DofSprings *);
PetscErrorCode DofSpringsAnchor(DofSprings, Vec x);
PetscErrorCode DofSpringsReturn(DofSprings, Vec x);
void           DofSpringsScale(DofSprings, PetscReal scale);
PetscBool      DofSpringsChanged(DofSprings);
PetscErrorCode DofSpringsMean(DofSprings, Vec diagonal, PetscReal *scale);
PetscErrorCode DofSpringsMoving(DofSprings, PetscReal motion, PetscReal *energy);
PetscErrorCode DofSpringsStretch(DofSprings, Vec x, Vec *stretch);
PetscErrorCode DofSpringsForces(DofSprings, Vec x, Vec *force);
PetscErrorCode DofSpringsResidual(DofSprings, Vec x, Vec F);
PetscErrorCode DofSpringsLoad(DofSprings, Vec x, PetscReal *force, PetscReal *energy);
PetscErrorCode DofSpringsEnergy(DofSprings, Vec x, PetscReal *energy);
void           DofSpringsShift(DofSprings, PetscReal shift);
PetscErrorCode DofSpringsShiftWork(DofSprings, Vec x, PetscReal *work);
PetscErrorCode DofSpringsStiffen(DofSprings, PetscReal scale, Mat A);
PetscErrorCode DofSpringsTangent(DofSprings, Mat A);
