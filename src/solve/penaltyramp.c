#include "modelimpl.h"

/* Penalties are softened where contact that the prediction did not count on stores, before Newton's method starts, this
   part of the elastic energy that the step brings. On a pipe between plates Newton's method takes three to five
   iterations below 0.15, seven to twenty, and most of its failures, above 0.2; a plate on a cylinder is better off
   without below 0.15. */
#define RAMP_UNPREDICTED 0.15
/* That energy is not asked to be less than this part of the elastic energy: a step may bring none at all. */
#define RAMP_NEGLIGIBLE 0.003
/* Penalties are raised until contact, where the last ones left it, would store this part of the elastic energy. With
   0.1 a pipe between plates that takes its whole load in one step needs 16 to 20 iterations instead of 9 to 17. */
#define RAMP_RAISED 0.03
/* Each soft solve's penalties are this many times those before, at least: where the next ones begin, contact then
 * stores up to ten times the energy. */
#define RAMP_FACTOR 10
/* No softer than this part of the automatic penalty, which is the stiffness of the elements below the surface: bodies
 * would pass through each other. */
#define RAMP_LEAST 0.1

/* Energy (all ranks) at the trial displacements of the contact that the prediction did not count on. */
static PetscErrorCode ModelUnpredictedEnergy(Model model, PetscReal *energy)
{
  PetscFunctionBeginUser;
  *energy = 0;
  PetscCall(ContactUnpredictedEnergy(model->contact, model->problem->trial, model->t, energy));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stiffest penalties, a power of RAMP_FACTOR below the full ones and not below `least`, whose energy at model->x is
   small. unforeseen: only that of terms which the prediction took for open counts. All in automatic penalties. */
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
    PetscCall(ContactSoften(model->contact, *most));
    if (unpredicted)
      PetscCall(ModelUnpredictedEnergy(model, &energy));
    else
      PetscCall(ProblemEnergy(problem, problem->trial, model->t, ENERGY_CONTACT, &energy, &ok));
    if (energy <= allowed || *most <= least) break;
  }
  PetscCall(ContactSoften(model->contact, PETSC_MAX_REAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ModelSolveSoft(Model model, PetscReal most, SolveReport *report)
{
  ModelWork     *work  = model->work;
  const PetscInt spent = report->newton;

  PetscFunctionBeginUser;
  work->left = PETSC_FALSE;
  work->soft = PETSC_TRUE;
  PetscCall(ContactSoften(model->contact, most));
  PetscCall(ModelNewton(model, report));
  PetscCall(ContactSoften(model->contact, PETSC_MAX_REAL));
  work->soft = PETSC_FALSE;
  PetscCall(PetscInfo(model->snes, "penalties softened to %g automatic ones: %" PetscInt_FMT " iterations\n",
                      (double)most, report->newton - spent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelRampPenalty - from the prediction to where it is known what touches, where the prediction ran into contact that
   it did not count on.

   Collective. With stiff penalties every node that comes into contact puts a kink into the energy, and the line search
   goes from one to the next; with soft ones the nodes share the load at once. Each solve is made with stiffer ones from
   where the last one ended, none to its end; the next one, with the full penalties, is the caller's. model->x is where
   it ended; costs and failures are added to the report. */
PetscErrorCode ModelRampPenalty(Model model, SolveReport *report)
{
  PetscReal full, most;
  PetscBool hold;

  PetscFunctionBeginUser;
  if (!model->contact || report->result != SOLVE_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->renewed = 0;
  PetscCall(ContactStiffest(model->contact, &full));
  PetscCall(ModelChooseSoftness(model, PETSC_TRUE, RAMP_LEAST, full, &most));
  while (most < full) {
    PetscCall(ModelSolveSoft(model, most, report));
    if (report->result != SOLVE_CONVERGED) break;
    if (model->work->left) {
      model->work->renewed++;
      PetscCall(ProblemRenewLists(model->problem, model->work->accepted_u, model->work->accepted_t, model->t,
                                  PETSC_TRUE, PETSC_FALSE, &hold));
      report->regathered++;
    } else
      PetscCall(ModelChooseSoftness(model, PETSC_FALSE, RAMP_FACTOR * most, full, &most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
