/* The controls of the load step without contact, and the table of all controls. */
#include "stepcontrol.h"

/* control: iterations. With fewer Newton iterations than the first number dt grows, with more than the second one it
   shrinks, by the square root of the ratio. In between it stays. Where contact slides, a step of any size takes six to
   ten, because nodes change and lists are made anew; to shorten it would only add steps. */
#define STEP_FEW_ITERATIONS  6.0
#define STEP_MANY_ITERATIONS 12.0
/* control: iterations. An accepted step shrinks dt by at most this factor. */
#define STEP_SHRINK 0.5
/* control: iterations. A step that is shorter than the one before it by at least this factor, and takes as many
   iterations, shows that they do not come from its length: dt returns to what it was. */
#define STEP_SHORTER 0.99
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

/* The next dt after a step of dt and n iterations, where a longer step has failed before: dt grows again to what that
   was. A step may fail at a first touch or where a body jumps, and what lies behind that does not ask for short steps.
   Steps of STEP_FEW_ITERATIONS to STEP_MANY_ITERATIONS would keep the length that the failure left. */
static PetscReal Recover(PetscReal dt, PetscReal n, StepSize *size)
{
  const PetscReal grown = dt * PetscMin(size->growth, PetscSqrtReal(STEP_MANY_ITERATIONS / n));

  if (dt >= size->failed_dt) size->failed_dt = 0;
  return PetscMin(size->failed_dt, grown);
}

/* dt by the Newton iterations of the last step, and whether it was worth while to shorten that. */
static PetscErrorCode StepControlNext_Iterations(Model model, PetscReal dt, PetscBool clipped, PetscInt newton,
                                                 StepSize *size)
{
  const PetscReal n = PetscMax(1, newton), target = PetscMax(STEP_FEW_ITERATIONS, PetscMin(STEP_MANY_ITERATIONS, n)),
                  factor = PetscSqrtReal(target / n);

  PetscFunctionBeginUser;
  (void)model;
  if (clipped) PetscFunctionReturn(PETSC_SUCCESS);
  if (factor < 1 && dt < STEP_SHORTER * size->last_dt && n >= size->last_iterations)
    size->dt = PetscMin(size->growth * dt, size->last_dt);
  else
    size->dt = dt * PetscMax(STEP_SHRINK, PetscMin(size->growth, factor));
  size->dt              = PetscMax(size->dt, Recover(dt, n, size));
  size->last_dt         = dt;
  size->last_iterations = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const StepControl StepControl_Fixed      = {.next = StepControlNext_Fixed};
const StepControl StepControl_Iterations = {.next = StepControlNext_Iterations};

const StepControl *const StepControls[]     = {STEP_CONTROLS(CHOICE_POINTER)};
const char *const        StepControlNames[] = {STEP_CONTROLS(CHOICE_NAME)};
