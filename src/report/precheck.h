/* What is looked at when a model is at t = 0 and nothing has been solved: rigid motions, contact pairs, cost.

   PrecheckModel() comes between ModelPlace() and ModelSetUp(). With -check it prints all of this; in a run it only
   refuses what cannot be solved. PrecheckMotions() is for the first lines of a run: what only contact holds, and what
   not even contact holds. */
#pragma once
#include <stdio.h>
#include "solve/model.h"

PetscErrorCode PrecheckModel(Model, PetscBool report, FILE *);
PetscErrorCode PrecheckPlasticity(Model, FILE *);
PetscErrorCode PrecheckMotions(Model, FILE *);
