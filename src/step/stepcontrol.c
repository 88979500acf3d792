#include "stepcontrol.h"

/* iterations: the Newton iterations that a step should take; fewer let dt grow, more let it shrink by the square root
 * of the ratio. */
#define STEP_TARGET_ITERATIONS 6.0
/* iterations: the most an accepted step lets dt shrink. */
#define STEP_SHRINK 0.5
/* fixed: after a cut dt returns to the scene's value by this factor each step. */
#define STEP_RECOVER 2.0

static PetscErrorCode StepControlNext_Fixed(Model model, PetscReal dt, PetscBool clipped, PetscInt newton,
                                            StepSize *size)
{
  PetscFunctionBeginUser;
  (void)model;
  (void)newton;
  if (!clipped) size->dt = PetscMin(size->initial, STEP_RECOVER * dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
