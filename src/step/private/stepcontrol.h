/* Controls of the load step: how dt follows from what happened in the last step.

   stepper.c tries the steps and lets them land on the load parameters that the scene asks for. It calls the three
   functions of the control that the scene chooses by name, in the order predict, judge, next. A new control is a file
   that defines a StepControl, and a line in STEP_CONTROLS (choices.h). */
#pragma once
#include "solve/model.h"

/* What a control knows and decides. */
typedef struct {
  PetscReal dt;                              /* of the next step, before it lands anywhere */
  PetscReal initial, dt_min, dt_max, growth; /* of the scene */

  /* The control by iterations */
  PetscReal last_dt;         /* of the step before the last one; 0: none */
  PetscReal last_iterations; /* that it took */
  PetscReal failed_dt;       /* of a step that failed, to which steps are to grow again; 0: none */

  /* The control by contact alone */
  PetscReal wanted;    /* nodes, or part of the slave area, that may change their status in one step */
  PetscBool by_area;   /* wanted is a part of the slave area */
  PetscBool linearly;  /* touches are predicted by one linear solve, not by the solution of the step */
  PetscReal beta;      /* beta_{N_c} of the last choice; NaN: no node approached */
  PetscReal together;  /* nodes (area) that the last choice found to touch at one time; 0: not more than wanted */
  PetscReal shortfall; /* nodes that the last linear predictions promised, over those that touched; 1 at the start */
  PetscReal planned;   /* dt of the last linear prediction; 0: none */
  PetscInt  tied; /* nodes of this step beyond those wanted that touch at one time, so that no step separates them */
} StepSize;

/* A control; functions that are NULL have nothing to do. */
typedef struct {
  /* Before a step that may be as long as `remaining`: may change size->dt; its solves are added to the report. */
  PetscErrorCode (*predict)(Model, PetscReal remaining, StepSize *, SolveReport *);
  /* After a converged step of dt: decides whether it is accepted. A step that is not is repeated with size->dt. */
  PetscErrorCode (*judge)(Model, PetscReal dt, StepSize *, PetscBool *accepted);
  /* After a step of dt that is to be accepted and took `newton` iterations: sets size->dt. clipped: dt was shortened to
     land on a load parameter and says nothing about what the model can take. */
  PetscErrorCode (*next)(Model, PetscReal dt, PetscBool clipped, PetscInt newton, StepSize *);
} StepControl;

#define STEP_CONTROL_DECLARE(kind, word, object) extern const StepControl object;
STEP_CONTROLS(STEP_CONTROL_DECLARE)
#undef STEP_CONTROL_DECLARE
extern const StepControl *const StepControls[]; /* by StepControlKind */
extern const char *const        StepControlNames[];
