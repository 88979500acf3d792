/* Work, stored energy and dissipation, see energybalance.h. */
#include "solve/energybalance.h"

/* Part of the energies that overlaps which are resolved at once may bring, up to which the balance is judged. It is
   lost where they are resolved, so that the balance may be off by as much. Facets that touch where they are curved
   bring some 0.1 %. */
#define ENERGY_GIVEN 1e-2

struct _n_EnergyBalance {
  OuterWork     outer;
  Problem       problem;    /* borrowed */
  Mesh          mesh;       /* borrowed */
  Elasticity    elasticity; /* borrowed */
  PetscBool     plastic;    /* a body may yield */
  PetscReal    *f, *f_0; /* local internal forces of the last accepted state and of the one before; NULL: not plastic */
  EnergyFigures figures; /* the same on all ranks */
};

/*@
  EnergyBalanceCreate - prepares the balance of the undeformed state.

  Not collective

  Input Parameter:
. problem - borrowed

  Output Parameter:
. balance - free it with EnergyBalanceDestroy()
@*/
PetscErrorCode EnergyBalanceCreate(Problem problem, EnergyBalance *balance)
{
  const PetscInt n = problem->mesh->n_nodes * problem->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(balance));
  (*balance)->mesh       = problem->mesh;
  (*balance)->elasticity = problem->elasticity;
  (*balance)->problem    = problem;
  (*balance)->plastic    = ProblemIsPlastic(problem);
  PetscCall(OuterWorkCreate(problem, &(*balance)->outer));
  if (!(*balance)->plastic) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n, &(*balance)->f));
  PetscCall(PetscCalloc1(n, &(*balance)->f_0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnergyBalanceDestroy - frees the balance.

  Not collective

  Input Parameter:
. balance - set to NULL; may be NULL already
@*/
PetscErrorCode EnergyBalanceDestroy(EnergyBalance *balance)
{
  PetscFunctionBeginUser;
  if (!*balance) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OuterWorkDestroy(&(*balance)->outer));
  PetscCall(PetscFree((*balance)->f));
  PetscCall(PetscFree((*balance)->f_0));
  PetscCall(PetscFree(*balance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the internal forces at u, and elastic energy and plastic work of this rank together. */
static PetscErrorCode Evaluate(EnergyBalance balance, const PetscReal *u, PetscReal *energy)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  *energy = 0;
  PetscCall(PetscArrayzero(balance->f, balance->mesh->n_nodes * balance->mesh->dim));
  PetscCall(ElasticityResidual(balance->elasticity, u, balance->f, energy, NULL, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnergyBalanceAdd - takes an accepted state.

  Collective

  Input Parameters:
+ balance - the balance
. u_0     - local displacements (length) of the accepted state before
. u       - those of the accepted state, after ElasticityAcceptPlastic()
. t       - its load parameter
- path    - what that gave on this rank
@*/
PetscErrorCode EnergyBalanceAdd(EnergyBalance balance, const PetscReal *u_0, const PetscReal *u, PetscReal t,
                                const PlasticPath *path)
{
  EnergyFigures *figures = &balance->figures;
  PetscReal     *before = balance->f, sum[4] = {0, 0, 0, path->lag}; /* energy, plastic work, work of the step, lag */
  PetscReal      most[2] = {0, path->growth};                        /* strain, growth */
  PetscBool      ok;

  PetscFunctionBeginUser;
  if (!balance->plastic) {
    PetscCall(ProblemEnergy(balance->problem, u, t, ENERGY_ELASTIC, &figures->elastic, &ok));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  balance->f   = balance->f_0;
  balance->f_0 = before;
  PetscCall(Evaluate(balance, u, &sum[0]));
  PetscCall(ElasticityPlasticWork(balance->elasticity, &sum[1], &most[0]));
  for (PetscInt k = 0; k < balance->mesh->n_nodes * balance->mesh->dim; k++)
    sum[2] += (balance->f[k] + balance->f_0[k]) * (u[k] - u_0[k]) / 2;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, balance->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, balance->mesh->comm));
  figures->elastic = sum[0] - sum[1];
  figures->plastic = sum[1];
  figures->work += sum[2];
  figures->lag += sum[3];
  figures->strain = most[0];
  figures->growth = PetscMax(figures->growth, most[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnergyBalanceEnd - compares what has been dissipated with the accepted state before.

  Not collective

  Input Parameter:
. balance - after EnergyBalanceAdd() and OuterWorkAdd() of its outer work
@*/
void EnergyBalanceEnd(EnergyBalance balance)
{
  EnergyFigures  *figures = &balance->figures;
  const PetscReal now     = figures->plastic + OuterWorkGet(balance->outer).friction;

  figures->least      = PetscMin(figures->least, now - figures->dissipated);
  figures->dissipated = now;
}

/*@
  EnergyBalanceOuter - returns the work from outside, which takes the accepted states as the balance does.

  Not collective

  Input Parameter:
. balance - it owns the work
@*/
OuterWork EnergyBalanceOuter(EnergyBalance balance)
{
  return balance->outer;
}

/*@
  EnergyBalanceGet - gives the energies of the last accepted state, the same on all ranks.

  Not collective

  Input Parameter:
. balance - the balance; NULL: all figures are 0
@*/
EnergyFigures EnergyBalanceGet(EnergyBalance balance)
{
  EnergyFigures figures = balance ? balance->figures : (EnergyFigures){0};

  if (balance) figures.outer = OuterWorkGet(balance->outer);
  return figures;
}

/*@
  EnergySum - returns what bodies and contact store and all that has been dissipated.

  Not collective

  Input Parameter:
. figures - of the last accepted state
@*/
PetscReal EnergySum(const EnergyFigures *figures)
{
  return figures->elastic + figures->plastic + figures->damping + figures->outer.stored + figures->outer.friction +
         figures->outer.held;
}

/*@
  EnergyApart - returns the distance of the work from outside from what bodies and contact store and have dissipated.

  Not collective

  Input Parameter:
. figures - of the last accepted state

  Note:
  NaN where overlaps were resolved at once that bring a part of these energies: nothing does the work of them.
@*/
PetscReal EnergyApart(const EnergyFigures *figures)
{
  const OuterFigures *outer = &figures->outer;
  const PetscReal     sum   = EnergySum(figures);

  return outer->given > ENERGY_GIVEN * sum ? NAN : PetscAbsReal(outer->work - sum);
}

/*@
  EnergyBalanceArchive - saves or loads the balance.

  Collective

  Input Parameters:
+ balance - the balance
. archive - decides whether it is saved or loaded
- u       - local displacements (length) of the accepted state; the elasticity has its plastic state
@*/
PetscErrorCode EnergyBalanceArchive(EnergyBalance balance, Archive archive, const PetscReal *u)
{
  EnergyFigures *figures = &balance->figures;
  PetscReal     *value[] = {&figures->elastic, &figures->plastic, &figures->work,       &figures->strain,
                            &figures->growth,  &figures->lag,     &figures->dissipated, &figures->least},
            energy;

  PetscFunctionBeginUser;
  PetscCall(ArchiveRealsAt(archive, "model/energies", PETSC_STATIC_ARRAY_LENGTH(value), value));
  PetscCall(OuterWorkArchive(balance->outer, archive, u));
  if (ArchiveLoads(archive) && balance->plastic) PetscCall(Evaluate(balance, u, &energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
