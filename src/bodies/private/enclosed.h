/* How bodies whose volume is enclosed (enclosedbodies.h) are solved. ElasticitySetEnclosed() takes them over. In
   ElasticityAugment() EnclosedFixLevels() then makes the mean of their pressure zero, and EnclosedHold() tells whether
   what is left of the error is beyond all free displacements. Such is the change of the volume that a mesh makes of
   displacements that keep it, and a pressure of quad4 and hex8 that alternates from element to element. */
#pragma once
#include "elasticityimpl.h"

PetscErrorCode EnclosedFixLevels(Elasticity, PetscReal *next);
PetscErrorCode EnclosedHold(Elasticity, const PetscReal *u, const PetscReal *next, PetscBool *holds);
