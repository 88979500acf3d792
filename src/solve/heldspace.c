/* The space of the soft motions that are held: how motions are added to it, and their answers to a new tangent. */
#include "modelimpl.h"

/*@
  ModelHeldDestroy - frees the motions that are held.

  Collective

  Input Parameter:
. held - the motions
@*/
PetscErrorCode ModelHeldDestroy(HeldMotion *held)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < HELD_MOST; i++) {
    PetscCall(VecDestroy(&held->b[i]));
    PetscCall(VecDestroy(&held->w[i]));
  }
  PetscCall(VecDestroy(&held->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the answer of the next motion, which is then held. One that no force moves is not. */
static PetscErrorCode Answer(Model model)
{
  HeldMotion *held = &model->work->hold;
  const int   i    = held->n;

  PetscFunctionBeginUser;
  PetscCall(ModelHeldSolve(model, held->b[i], held->w[i]));
  PetscCall(VecDotRealPart(held->b[i], held->w[i], &held->compliance[i]));
  if (held->compliance[i] != 0) held->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldAdd - finds the softest motion besides those that are held, and holds it too.

  Collective

  Input Parameters:
+ model - after a solve with the present tangent
- start - any vector that has a part of the motion (length)

  Output Parameters:
+ stiffness - of the tangent along it
- part      - of the motion in the vector (length)
@*/
PetscErrorCode ModelHeldAdd(Model model, Vec start, PetscReal *stiffness, PetscReal *part)
{
  HeldMotion *held = &model->work->hold;
  const int   i    = held->n;
  Vec         v;

  PetscFunctionBeginUser;
  if (!held->b[i]) {
    PetscCall(VecDuplicate(start, &held->b[i]));
    PetscCall(VecDuplicate(start, &held->w[i]));
  }
  PetscCall(VecDuplicate(start, &v));
  PetscCall(ModelSoftMotion(model, start, v, stiffness, part));
  PetscCall(ModelDropPressures(model, v, held->b[i]));
  PetscCall(VecDestroy(&v));
  PetscCall(Answer(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldOut - takes the motions that are held out of the answer to forces that has just been found.

  Collective

  Input Parameters:
+ model - after a solve with the present tangent
- y     - its solution (length)

  Output Parameter:
. y - without the motions
@*/
PetscErrorCode ModelHeldOut(Model model, Vec y)
{
  PetscFunctionBeginUser;
  if (!model->work->hold.wanted) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelHeldRefresh(model, y));
  PetscCall(ModelHeldTakeOut(model, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldRefresh - finds the answers of the motions that are to be held to the present tangent, and the motions, where
  they are not known or are to be found anew.

  Collective

  Input Parameters:
+ model - after a solve with that tangent
- y     - the step (length)
@*/
PetscErrorCode ModelHeldRefresh(Model model, Vec y)
{
  HeldMotion *held  = &model->work->hold;
  const int   known = held->known;
  PetscReal   stiffness, part;
  Vec         start;

  PetscFunctionBeginUser;
  held->n = 0;
  PetscCall(VecDuplicate(y, &start));
  for (int i = 0; i < held->wanted && held->n == i; i++) {
    if (i < known && !held->anew) {
      PetscCall(Answer(model));
      continue;
    }
    PetscCall(VecCopy(i > 0 && i < known ? held->b[i] : y, start));
    PetscCall(ModelHeldTakeOut(model, start));
    PetscCall(ModelHeldAdd(model, start, &stiffness, &part));
  }
  PetscCall(VecDestroy(&start));
  held->wanted = held->known = held->n;
  held->anew                 = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
