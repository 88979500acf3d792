#include "modelimpl.h"

/* Contact that the prediction did not see coming stores this part of the elastic energy before Newton's method starts: from there on penalties are softened.
   On a pipe between plates Newton's method takes three to five iterations below 0.02, seven to twenty, and most of its failures, above 0.1. */
#define SOFT_ENERGY 0.03
/* Each soft solve's penalties are this many times those before, at least: where the next ones begin, contact then stores up to ten times the energy. */
#define SOFT_FACTOR 10
/* No softer than this part of the automatic penalty, which is the stiffness of the elements below the surface: bodies would pass through each other. */
#define SOFT_LEAST 0.1

/* The stiffest penalties, a power of SOFT_FACTOR below the full ones and not below `least`, whose energy at model->x is within SOFT_ENERGY. unforeseen: only
   terms that the prediction took for open count. All in automatic penalties. */
static PetscErrorCode ModelChooseSoftness(Model model, PetscBool unforeseen, PetscReal least, PetscReal full, PetscReal *most)
{
  PetscReal elastic = 0;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(ModelTrial(model, model->x));
  PetscCall(ElasticityResidual(model->elasticity, model->work->trial, NULL, &elastic, NULL, &ok));
  for (*most = full;; *most = PetscMax(least, *most / SOFT_FACTOR)) {
    PetscReal sum[2] = {elastic, 0};

    PetscCall(ContactSoften(model->contact, *most));
    if (unforeseen)
      PetscCall(ContactUnforeseen(model->contact, model->work->trial, model->t, &sum[1]));
    else
      PetscCall(ContactResidual(model->contact, model->work->trial, model->t, NULL, &sum[1], NULL));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, model->mesh->comm));
    if (sum[1] <= SOFT_ENERGY * sum[0] || *most <= least) break;
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
  PetscCall(PetscInfo(model->snes, "penalties softened to %g automatic ones: %" PetscInt_FMT " iterations\n", (double)most, report->newton - spent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ModelSoftStart - from the prediction to where it is known what touches, where the prediction ran into contact that it did not count on.

   Collective. With stiff penalties every node that comes into contact puts a kink into the energy, and the line search goes from one to the next; with soft
   ones the nodes share the load at once. Each solve is made with stiffer ones from where the last one ended, none to its end; the next one, with the full
   penalties, is the caller's. model->x is where it ended; costs and failures are added to the report. */
PetscErrorCode ModelSoftStart(Model model, SolveReport *report)
{
  PetscReal full, most;
  PetscBool hold;

  PetscFunctionBeginUser;
  if (!model->contact || report->result != SOLVE_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->renewed = 0;
  PetscCall(ContactStiffest(model->contact, &full));
  PetscCall(ModelChooseSoftness(model, PETSC_TRUE, SOFT_LEAST, full, &most));
  while (most < full) {
    PetscCall(ModelSolveSoft(model, most, report));
    if (report->result != SOLVE_CONVERGED) break;
    if (model->work->left) {
      PetscCall(ModelRenewLists(model, PETSC_FALSE, &hold));
      report->regathered++;
    } else
      PetscCall(ModelChooseSoftness(model, PETSC_FALSE, SOFT_FACTOR * most, full, &most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
