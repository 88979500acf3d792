/* Softened penalties between the prediction and Newton's method with the full ones. */
#include "modelimpl.h"

/* Penalties are softened where contact that the prediction did not count on stores, before Newton's method starts, more
   than this part of the elastic energy that the step brings. On a pipe between plates Newton's method takes three to
   five iterations below 0.15. Above 0.2 it takes seven to twenty and has most of its failures. A plate on a cylinder is
   better off without softened penalties below 0.15. */
#define RAMP_UNPREDICTED 0.15
/* That bound on the energy is at least this part of the whole elastic energy, because a step may bring none at all. */
#define RAMP_NEGLIGIBLE 0.003
/* Penalties are raised until contact, at the end of the last soft solve, would store this part of the elastic energy.
   With 0.1 a pipe between plates that takes its whole load in one step needs 16 to 20 iterations instead of 9 to 17. */
#define RAMP_RAISED 0.03
/* The penalties of each soft solve are at least this many times those of the one before. At its start contact then
   stores up to ten times the energy. */
#define RAMP_FACTOR 10
/* Penalties are never softer than this part of the automatic penalty, which is the stiffness of the elements below the
   surface. With softer ones bodies would pass through each other. */
#define RAMP_LEAST 0.1

/* Energy at the trial displacements of the contact terms that the prediction found open; of all ranks. */
static PetscErrorCode ModelUnpredictedEnergy(Model model, PetscReal *energy)
{
  PetscFunctionBeginUser;
  *energy = 0;
  PetscCall(ContactUnpredictedEnergy(model->contact, model->problem->trial, model->t, energy));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the stiffest penalties with which contact stores little energy at model->x. They are the full penalties
   divided by a power of RAMP_FACTOR, but at least `least`. With unpredicted, only terms that the prediction found open
   count. least, full and *most are multiples of the automatic penalty. */
static PetscErrorCode ModelChooseSoftness(Model model, PetscBool unpredicted, PetscReal least, PetscReal full,
                                          PetscReal *most)
{
  const Problem problem = model->problem;
  PetscReal     elastic, accepted, allowed, energy;
  PetscBool     ok;

  PetscFunctionBeginUser;
  PetscCall(ProblemSetTrial(problem, model->x, model->t));
  PetscCall(ProblemEnergy(problem, problem->trial, model->t, ENERGY_ELASTIC, &elastic, &ok));
  PetscCall(ProblemEnergy(problem, model->work->accepted_u, model->work->accepted_t, ENERGY_ELASTIC, &accepted, &ok));
  allowed = unpredicted ? PetscMax(RAMP_UNPREDICTED * PetscAbsReal(elastic - accepted), RAMP_NEGLIGIBLE * elastic)
                        : RAMP_RAISED * elastic;
  for (*most = full;; *most = PetscMax(least, *most / RAMP_FACTOR)) {
    PetscCall(ContactSoften(model->contact, *most, model->work->softens));
    if (unpredicted)
      PetscCall(ModelUnpredictedEnergy(model, &energy));
    else
      PetscCall(ProblemEnergy(problem, problem->trial, model->t, ENERGY_CONTACT, &energy, &ok));
    if (energy <= allowed || *most <= least) break;
  }
  PetscCall(ContactSoften(model->contact, PETSC_MAX_REAL, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs Newton's method once with penalties of at most `most` automatic ones. */
static PetscErrorCode ModelSolveSoft(Model model, PetscReal most, SolveReport *report)
{
  ModelWork     *work  = model->work;
  const PetscInt spent = report->newton;

  PetscFunctionBeginUser;
  work->left = PETSC_FALSE;
  work->soft = PETSC_TRUE;
  PetscCall(ContactSoften(model->contact, most, model->work->softens));
  PetscCall(ModelNewton(model, report));
  PetscCall(ContactSoften(model->contact, PETSC_MAX_REAL, PETSC_FALSE));
  work->soft = PETSC_FALSE;
  PetscCall(PetscInfo(model->snes, "penalties softened to %g automatic ones: %" PetscInt_FMT " iterations\n",
                      (double)most, report->newton - spent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelContactOverdone - says whether contact without friction stores so much at the first iterate that solves with
  softened penalties may help, also where the prediction counted on that contact.

  Collective

  Input Parameter:
. model - after the prediction

  Output Parameter:
. overdone - it does

  Note:
  Surfaces that slide far, or bend, end deep in each other although the linear step holds them together. Newton's method
  mostly puts that right in one iteration. Where it does not, elements are nearly inverted on the way. Not so with
  friction: what is softened slips, and such a solve fails, too.
@*/
PetscErrorCode ModelContactOverdone(Model model, PetscBool *overdone)
{
  const Problem problem = model->problem;
  PetscReal     elastic, energy;
  PetscBool     ok, whole;

  PetscFunctionBeginUser;
  *overdone = PETSC_FALSE;
  if (!model->contact || ContactHasFriction(model->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetTrial(problem, model->x, model->t));
  PetscCall(ProblemEnergy(problem, problem->trial, model->t, ENERGY_ELASTIC, &elastic, &ok));
  PetscCall(ProblemEnergy(problem, problem->trial, model->t, ENERGY_CONTACT, &energy, &whole));
  *overdone = (PetscBool)(ok && energy > RAMP_UNPREDICTED * elastic);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelRampPenalty - improves the first iterate by solves with softened penalties, where the prediction met contact that
  it did not count on.

  Collective

  Input Parameters:
+ model  - after the prediction
. all    - penalties are softened for all contact, whether the prediction counted on it or not
- report - costs and failures are added to it

  Output Parameter:
. model - model->x is where the last of these solves ended

  Note:
  With stiff penalties every node that comes into contact puts a kink into the energy, and the line search goes from one
  kink to the next. With soft ones the nodes share the load at once. Each solve starts from the end of the one before,
  has stiffer penalties and is not solved to its end. The solve with the full penalties is the caller's.
@*/
PetscErrorCode ModelRampPenalty(Model model, PetscBool all, SolveReport *report)
{
  PetscReal full, most;
  PetscBool hold;

  PetscFunctionBeginUser;
  if (!model->contact || report->result != SOLVE_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->renewed = 0;
  PetscCall(ContactStiffest(model->contact, &full));
  if (all) model->work->softens = PETSC_TRUE;
  PetscCall(ModelChooseSoftness(model, (PetscBool)!all, RAMP_LEAST, full, &most));
  while (most < full) {
    PetscCall(ModelSolveSoft(model, most, report));
    if (report->result != SOLVE_CONVERGED) break;
    if (model->work->left) {
      model->work->renewed++;
      PetscCall(ProblemRenewLists(model->problem, model->work->accepted_u, model->work->accepted_t, model->t,
                                  PETSC_TRUE, 1, PETSC_FALSE, &hold));
      report->regathered++;
    } else
      PetscCall(ModelChooseSoftness(model, PETSC_FALSE, RAMP_FACTOR * most, full, &most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
