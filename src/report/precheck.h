/* What is looked at when a model stands at t = 0 and nothing has been solved: -check prints it all, a run only refuses
 * what cannot be solved. */
#pragma once
#include <stdio.h>
#include "solve/model.h"

/* After ModelPlace(), before ModelSetUp(). report: print motions, contact pairs and what a solve will cost, on rank 0.
 * Collective. */
PetscErrorCode PrecheckModel(Model, PetscBool report, FILE *);
/* For a run's first lines: what only contact holds, and what not even contact does. Collective. */
PetscErrorCode PrecheckMotions(Model, FILE *);
