/* A line search that seeks the place along Newton's step where nothing more is gained: where the residual does no work
   along the step. */
#include "modelimpl.h"

/* The work along the step must fall to this part of that at its start. Crisfield takes 0.8, which leaves the steps of a
   tube that a mandrel widens to lead to and fro over the place of balance. */
#define SLOPE_ENOUGH 0.3
/* The place is sought by this many residuals at most. Each costs a small part of a linear solve. */
#define SLOPE_TRIALS 10
/* A trial is this part of the bracket away from its ends, or farther. */
#define SLOPE_MARGIN 0.1

/* A part of the step, and the work of the residual there along the step over that at the start. */
typedef struct {
  PetscReal part, work;
  PetscBool inside; /* no element is inverted there, and the contact lists reach */
} Trial;

/* Evaluates the residual at a part of the step, into the vector G of the search. */
static PetscErrorCode Evaluate(Model model, SNESLineSearch search, PetscReal slope, Trial *trial)
{
  SNES      snes;
  PetscBool inverted;
  Vec       x, y, w, G;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESLineSearchGetVecs(search, &x, NULL, &y, &w, &G));
  PetscCall(VecWAXPY(w, -trial->part, y, x));
  PetscCall(SNESComputeFunction(snes, w, G));
  PetscCall(SNESGetFunctionDomainError(snes, &inverted));
  PetscCall(VecDotRealPart(G, y, &trial->work));
  trial->work /= slope;
  trial->inside = (PetscBool)(!inverted && !PetscIsInfOrNanReal(trial->work));
  if (trial->inside && model->contact) PetscCall(ContactListsReach(model->contact, &trial->inside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next trial within a bracket, by the secant. Where an element is inverted at its upper end, the middle. */
static PetscReal Between(const Trial *low, const Trial *high)
{
  const PetscReal secant = low->work / (low->work - high->work);

  return low->part +
         (high->part - low->part) * (high->inside ? PetscMax(SLOPE_MARGIN, PetscMin(1 - SLOPE_MARGIN, secant)) : 0.5);
}

/*@
  ModelSearchSlope - finds the part of a step at which the residual does no more work along the step.

  Collective

  Input Parameters:
+ model  - the model
. search - with the step x - y, and the residual at x
. slope  - work of that residual along the step, above 0
- first  - part of the step that is tried first

  Output Parameter:
. part - of the step: `first` where that is not too long; 0 where no such place is found. The vectors W and G of the
         search are the state and the residual there

  Notes:
  Where bodies yield, points on the way begin to flow or unload, and the stiffness along the step jumps by orders of
  magnitude. So it does where a node that comes into contact is the only one that holds a body. Energy and residual may
  then be lower after the step than before, though most of it lies beyond their least values, and the next steps lead to
  and fro over that place.

  Source: Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, 1991, section 9.2; regula
falsi in the form that is called Illinois: Dowell and Jarratt, BIT 11 (1971) 168-174.
@*/
PetscErrorCode ModelSearchSlope(Model model, SNESLineSearch search, PetscReal slope, PetscReal first, PetscReal *part)
{
  Trial     low = {0, 1, PETSC_TRUE}, high = {first, 0, PETSC_TRUE}, trial;
  PetscBool found;
  int       side = 0;

  PetscFunctionBeginUser;
  *part = 0;
  PetscCall(Evaluate(model, search, slope, &high));
  found = (PetscBool)(high.inside && high.work <= 1 && high.work >= -SLOPE_ENOUGH);
  if (found) *part = first;
  if (found || (high.inside && high.work > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < SLOPE_TRIALS && !found; i++) {
    trial.part = Between(&low, &high);
    PetscCall(Evaluate(model, search, slope, &trial));
    found = (PetscBool)(trial.inside && PetscAbsReal(trial.work) <= SLOPE_ENOUGH);
    if (found) *part = trial.part;
    if (trial.inside && trial.work > 0) {
      low = trial;
      if (side > 0) high.work /= 2;
      side = 1;
    } else {
      high = trial;
      if (side < 0) low.work /= 2;
      side = -1;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
