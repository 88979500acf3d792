/* Linear solves of bodies whose soft motions are held. */
#include "modelimpl.h"

/*@
  ModelHeldTakeOut - takes out of free displacements what they have along the motions that are held, by forces on them.

  Collective

  Input Parameters:
+ model - its motions have their answers to the present tangent
- z     - displacements that a force causes with that tangent (length)

  Output Parameter:
. z - what it causes where the motions are held

  Note:
  Each answer w is that of a body whose motions before are held. So the motions are taken out one after the other, and
  what is done for one does not bring back those before. That is the factorisation L D L^T of their compliances.
@*/
PetscErrorCode ModelHeldTakeOut(Model model, Vec z)
{
  const HeldMotion *held = &model->work->hold;
  PetscReal         along;

  PetscFunctionBeginUser;
  for (int i = 0; i < held->n; i++) {
    PetscCall(VecDotRealPart(held->b[i], z, &along));
    PetscCall(VecAXPY(z, -along / held->compliance[i], held->w[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldSolve - solves with the present tangent, where the motions are held that have their answers to it.

  Collective

  Input Parameters:
+ model - after a solve with that tangent
- b     - forces

  Output Parameter:
. z - free displacements (length)
@*/
PetscErrorCode ModelHeldSolve(Model model, Vec b, Vec z)
{
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSolve(ksp, b, z));
  PetscCall(ModelHeldTakeOut(model, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}
