/* Why the line search shortened a step: the part of the energy that would have risen most over the whole step. */
#include "modelimpl.h"

const char *const CutCauses[CUT_CAUSES] = {[CUT_INVERTED] = "inverted elements",
                                           [CUT_VOLUME]   = "volume",
                                           [CUT_SHAPE]    = "shape",
                                           [CUT_CONTACT]  = "contact",
                                           [CUT_LOADS]    = "loads",
                                           [CUT_RESIDUAL] = "residual",
                                           [CUT_CYCLE]    = "repeated contact"};

/* Adds `sign` times the energies at x to those of volume, shape, contact and loads. *ok: no element is inverted; else
   nothing is added. */
static PetscErrorCode AddEnergies(Model model, Vec x, PetscReal sign, PetscReal energy[CUT_CAUSES], PetscBool *ok)
{
  static const int part[CUT_CAUSES] = {[CUT_VOLUME]  = ENERGY_VOLUME,
                                       [CUT_SHAPE]   = ENERGY_ELASTIC,
                                       [CUT_CONTACT] = ENERGY_CONTACT,
                                       [CUT_LOADS]   = ENERGY_LOADS};
  PetscReal        now[CUT_CAUSES];
  PetscBool        whole;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_ELASTIC, &now[CUT_SHAPE], ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  for (int cause = 0; cause < CUT_CAUSES; cause++) {
    if (!part[cause] || cause == CUT_SHAPE) continue;
    PetscCall(ProblemEnergy(model->problem, model->problem->trial, model->t, part[cause], &now[cause], &whole));
    energy[cause] += sign * now[cause];
  }
  energy[CUT_SHAPE] += sign * (now[CUT_SHAPE] - now[CUT_VOLUME]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The cause for which energies were higher at `end` than at x. */
static PetscErrorCode CauseOfRise(Model model, Vec x, Vec end, CutCause *cause)
{
  PetscReal rise[CUT_CAUSES] = {0};
  PetscBool ok;

  PetscFunctionBeginUser;
  *cause = CUT_INVERTED;
  PetscCall(AddEnergies(model, end, 1, rise, &ok));
  if (!ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AddEnergies(model, x, -1, rise, &ok));
  *cause = CUT_VOLUME;
  for (int c = CUT_VOLUME; c < CUT_CAUSES; c++) {
    if (rise[c] > rise[*cause]) *cause = (CutCause)c;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelCountCut - counts the step to the iterate x by its cause, if the line search shortened it.

  Collective

  Input Parameters:
+ model - the model, whose work->step is the whole step
- x     - free displacements (length) where the line search ended it

  Note:
  It must be called before the objective of the next step is chosen. The contact is that of x afterwards.
@*/
PetscErrorCode ModelCountCut(Model model, Vec x)
{
  ModelWork     *work  = model->work;
  CutCause       cause = CUT_RESIDUAL;
  SNESLineSearch search;
  PetscReal      lambda, damping;
  Vec            start, end;
  PetscBool      ok;

  PetscFunctionBeginUser;
  PetscCall(SNESGetLineSearch(model->snes, &search));
  PetscCall(SNESLineSearchGetLambda(search, &lambda));
  PetscCall(SNESLineSearchGetDamping(search, &damping));
  if (!(lambda < 1)) PetscFunctionReturn(PETSC_SUCCESS);
  if (lambda == damping)
    cause = CUT_CYCLE;
  else if (work->objective == OBJECTIVE_ENERGY && ProblemConservative(model->problem)) {
    PetscCall(VecDuplicate(x, &start));
    PetscCall(VecDuplicate(x, &end));
    PetscCall(VecWAXPY(start, lambda, work->step, x));
    PetscCall(VecWAXPY(end, -damping, work->step, start));
    PetscCall(CauseOfRise(model, start, end, &cause));
    PetscCall(VecDestroy(&start));
    PetscCall(VecDestroy(&end));
    PetscCall(ProblemSetTrial(model->problem, x, model->t));
    PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  }
  work->cuts[cause]++;
  PetscFunctionReturn(PETSC_SUCCESS);
}
