/* Work that is done on the bodies from outside, for the balance of energies: by supports and imposed displacements, by
   loads and springs, by tools, by overlaps that grow over t and by penalties that are raised.

   Around the ProblemResidual() of an accepted state stand OuterWorkBegin() and OuterWorkAdd(). Forces and
   displacements of two accepted states give the work of the step between them, by the trapezoidal rule. What the bodies
   do against the forces that hold soft motions is lost, and is counted in the same way. Springs against sliding give
   way within a step, and what they take is counted there, see ModelDragSolve(). */
#pragma once
#include "solve/problem.h"

typedef struct {
  PetscReal work;     /* done so far */
  PetscReal stored;   /* in penetrations and elastic slip */
  PetscReal given;    /* such energy in the first state: of overlaps that are resolved at once; nothing does its work */
  PetscReal friction; /* energy that friction has taken so far */
  PetscReal held;     /* energy that held motions and springs against sliding have taken so far */
} OuterFigures;

typedef struct _n_OuterWork *OuterWork;

PetscErrorCode OuterWorkCreate(Problem, OuterWork *);
PetscErrorCode OuterWorkDestroy(OuterWork *);
PetscErrorCode OuterWorkBegin(OuterWork, PetscBool holds);
PetscErrorCode OuterWorkAdd(OuterWork, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                            PetscReal taken);
void           OuterWorkHeld(OuterWork, PetscReal *force);
OuterFigures   OuterWorkGet(OuterWork);
PetscErrorCode OuterWorkArchive(OuterWork, Archive, const PetscReal *u);
