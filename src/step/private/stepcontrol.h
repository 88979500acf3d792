/* How large the next load step is: the step controls, chosen by name. For stepper.c, which tries the steps and lets
   them land.

   A new control is a file that defines a StepControl and a line in choices.h. */
#pragma once
#include "solve/model.h"

/* What a control knows and decides */
typedef struct {
  PetscReal initial, dt_min, dt_max, growth; /* of the scene */
  PetscReal wanted;                          /* contact: nodes, or part of the slave area, that may touch in one step */
  PetscBool by_area,
    linearly;     /* contact: what is counted; predicted by one linear solve, not by the step's own solution */
  PetscReal dt;   /* of the next step, before it lands anywhere */
  PetscReal beta; /* contact: beta_{N_c} of the last choice, NaN: no node approached */
  PetscReal
    together; /* contact: nodes (area) that the last choice found to touch at one time, 0: no more than wanted */
  PetscReal
    shortfall; /* contact: how many times more nodes the last linear forecasts promised than came; 1 to begin with */
  PetscReal planned; /* contact: dt of the last linear forecast, 0: none */
  PetscInt
    tied; /* contact: nodes of this step that come together, more than wanted, as no step separates them; 0: none */
} StepSize;

typedef struct {
  /* before a step that may be as long as `rest`: may change dt; its solves are added to the report. NULL: nothing to be
   * done */
  PetscErrorCode (*predict)(Model, PetscReal remaining, StepSize *, SolveReport *);
  /* after a converged step of dt: is it to be accepted? If not it is taken back and tried with the new size->dt. NULL:
   * always */
  PetscErrorCode (*judge)(Model, PetscReal dt, StepSize *, PetscBool *accepted);
  /* after a step of dt that took `newton` iterations, before it is accepted: the next dt, from size->dt. clipped: dt
     was shortened to land on a load parameter and says nothing of what the model can take */
  PetscErrorCode (*next)(Model, PetscReal dt, PetscBool clipped, PetscInt newton, StepSize *);
} StepControl;

#define STEP_CONTROL_DECLARE(kind, word, object) extern const StepControl object;
STEP_CONTROLS(STEP_CONTROL_DECLARE)
#undef STEP_CONTROL_DECLARE
extern const StepControl *const StepControls[]; /* by StepControlKind */
extern const char *const        StepControlNames[];
