/* The controls of the load step without contact, and the table of all controls. */
#include "stepcontrol.h"

/* control: iterations. The Newton iterations that a step should take. With fewer dt grows and with more it shrinks, by
   the square root of the ratio. */
#define STEP_TARGET_ITERATIONS 6.0
/* control: iterations. An accepted step shrinks dt by at most this factor. */
#define STEP_SHRINK 0.5
/* control: fixed. After a cut dt grows by this factor in each step until it has the value of the scene again. */
#define STEP_RECOVER 2.0

/* The dt of the scene, to which it returns after a cut. */
static PetscErrorCode StepControlNext_Fixed(Model model, PetscReal dt, PetscBool clipped, PetscInt newton,
                                            StepSize *size)
{
  PetscFunctionBeginUser;
  (void)model;
  (void)newton;
  if (!clipped) size->dt = PetscMin(size->initial, STEP_RECOVER * dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dt by the Newton iterations of the last step. */
static PetscErrorCode StepControlNext_Iterations(Model model, PetscReal dt, PetscBool clipped, PetscInt newton,
                                                 StepSize *size)
{
  const PetscReal factor = PetscSqrtReal(STEP_TARGET_ITERATIONS / PetscMax(1, newton));

  PetscFunctionBeginUser;
  (void)model;
  if (!clipped) size->dt = dt * PetscMax(STEP_SHRINK, PetscMin(size->growth, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const StepControl StepControl_Fixed      = {.next = StepControlNext_Fixed};
const StepControl StepControl_Iterations = {.next = StepControlNext_Iterations};

const StepControl *const StepControls[]     = {STEP_CONTROLS(CHOICE_POINTER)};
const char *const        StepControlNames[] = {STEP_CONTROLS(CHOICE_NAME)};
