/* Bodies that keep their volume exactly while supports and loads prescribe their whole surface. Their volume is
   enclosed: no displacement that is free changes it, so that the level of their pressure is free.
   ElasticityFindEnclosed() finds them. In ElasticityAugment() EnclosedFixLevels() then makes the mean of their pressure
   zero, and EnclosedHold() tells whether what is left of the error is beyond all free displacements. Such is the change
   of the volume that a mesh makes of displacements that keep it, and a pressure of quad4 and hex8 that alternates from
   element to element. */
#pragma once
#include "elasticityimpl.h"

PetscErrorCode EnclosedFixLevels(Elasticity, PetscReal *next);
PetscErrorCode EnclosedHold(Elasticity, const PetscReal *u, const PetscReal *next, PetscBool *holds);
