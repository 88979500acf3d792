/* Work, stored energy and dissipation of plastic bodies, see energybalance.h. */
#include "solve/energybalance.h"

struct _n_EnergyBalance {
  Mesh          mesh;       /* borrowed */
  Elasticity    elasticity; /* borrowed */
  PetscReal    *f, *f_0;    /* local internal forces of the last accepted state and of the one before */
  EnergyFigures figures;    /* the same on all ranks */
};

/*@
  EnergyBalanceCreate - prepares the balance of the undeformed state.

  Not collective

  Input Parameters:
+ mesh       - borrowed
- elasticity - borrowed

  Output Parameter:
. balance - free it with EnergyBalanceDestroy()
@*/
PetscErrorCode EnergyBalanceCreate(Mesh mesh, Elasticity elasticity, EnergyBalance *balance)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(balance));
  (*balance)->mesh       = mesh;
  (*balance)->elasticity = elasticity;
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
- path    - what that gave on this rank
@*/
PetscErrorCode EnergyBalanceAdd(EnergyBalance balance, const PetscReal *u_0, const PetscReal *u,
                                const PlasticPath *path)
{
  EnergyFigures *figures = &balance->figures;
  PetscReal     *before = balance->f, sum[4] = {0, 0, 0, path->lag}; /* energy, plastic work, work of the step, lag */
  PetscReal      most[2] = {0, path->growth};                        /* strain, growth */

  PetscFunctionBeginUser;
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
  EnergyBalanceGet - gives the energies of the last accepted state, the same on all ranks.

  Not collective

  Input Parameter:
. balance - the balance; NULL: all figures are 0
@*/
EnergyFigures EnergyBalanceGet(EnergyBalance balance)
{
  return balance ? balance->figures : (EnergyFigures){0};
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
  PetscReal     *value[] = {&figures->elastic, &figures->plastic, &figures->work,
                            &figures->strain,  &figures->growth,  &figures->lag},
            energy;

  PetscFunctionBeginUser;
  PetscCall(ArchiveRealsAt(archive, "model/energies", PETSC_STATIC_ARRAY_LENGTH(value), value));
  if (ArchiveLoads(archive)) PetscCall(Evaluate(balance, u, &energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
