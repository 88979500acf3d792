/* Forces and moments on all bodies together, at an equilibrium: loads, supports, springs, tools and mirror images hold
   each other, because internal forces and those of bodies on each other add up to nothing. */
#pragma once
#include "solve/problem.h"

/* What is left over, of the sum of the amounts of the outer forces, or of their moments about the middle of the mesh.
   Axisymmetric: along the axis; moments are NaN. Small strains: with the arms of the reference state. */
typedef struct {
  PetscReal force, moment;
} ForceBalance;

PetscErrorCode ForceBalanceFind(Problem, const PetscReal *u, PetscReal t, ForceBalance *, PetscBool *ok);
