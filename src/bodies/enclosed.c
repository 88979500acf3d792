/* The level of pressure of bodies whose volume is enclosed, see enclosed.h. */
#include "enclosed.h"

/* Relative change of the volume that prescribed displacements may make. Displacements that keep the volume change that
   of a coarse mesh with curved faces by so much. */
#define ENCLOSED_CHANGE 1e-3
/* A change of the multipliers moves nothing if its forces on free nodes are below this part of the element forces. They
   move nodes by as small a part of what the load does. */
#define ENCLOSED_FORCE 1e-6

/*@
  ElasticitySetEnclosed - takes over the bodies that EnclosedBodiesFind() has found.

  Not collective

  Input Parameters:
+ e          - the elasticity
. scene      - its bodies
- prescribed - whether a displacement is supported or imposed [n_nodes*dim]; it is kept
@*/
PetscErrorCode ElasticitySetEnclosed(Elasticity e, Scene scene, const PetscBool *prescribed)
{
  PetscFunctionBeginUser;
  if (!e->augments) PetscFunctionReturn(PETSC_SUCCESS);
  e->enclosed = (Enclosed){.n_bodies = scene->n_bodies, .prescribed = prescribed};
  PetscCall(PetscCalloc1(scene->n_bodies, &e->enclosed.body));
  for (int b = 0; b < scene->n_bodies; b++) {
    e->enclosed.body[b] = (PetscBool)scene->bodies[b].enclosed;
    e->enclosed.any     = (PetscBool)(e->enclosed.any || e->enclosed.body[b]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over the cells of an enclosed body: volume; mean of the next multipliers and of their change, times the volume;
   and kappa of one of its cells (stress) */
typedef struct {
  PetscReal volume, next, change, kappa;
} LevelSum;

/* The first coefficient of a uniform pressure 1 is the root of the volume of the cell, the others are 0. */
static void AddCell(Elasticity e, const CellGroup *g, PetscInt slot, PetscReal *next, LevelSum *sum)
{
  const PetscInt   batch = slot / KERNEL_LANES, lane = slot % KERNEL_LANES;
  const PetscReal *m = ElasticityMultipliers(e, g, batch), *own = ElasticityMultipliersOf(g, batch, next);
  const PetscReal  volume = ElasticitySlotVolume(e, g, slot), root = PetscSqrtReal(volume);
  VolumeModuli     moduli;

  ElementVolumeModuli(&g->kernel, &g->constants[(size_t)batch * KERNEL_LANES * g->kernel.n_constants + lane],
                      KERNEL_LANES, &moduli);
  sum->volume += volume;
  sum->next += root * own[lane];
  sum->change += root * (own[lane] - m[lane]);
  sum->kappa = moduli.kappa;
}

static void AddLevel(Elasticity e, PetscInt body, PetscReal level, PetscReal *next)
{
  for (int k = 0; k < e->n_groups; k++) {
    const CellGroup *g = &e->groups[k];

    for (PetscInt slot = 0; slot < g->n_batches * KERNEL_LANES && g->multipliers >= 0; slot++) {
      if (e->mesh->cell_body[g->cell[slot]] != body) continue;
      ElasticityMultipliersOf(g, slot / KERNEL_LANES, next)[slot % KERNEL_LANES] +=
        level * PetscSqrtReal(ElasticitySlotVolume(e, g, slot));
    }
  }
}

/* Makes the mean of the pressure zero that a body has with the next multipliers, at its present dilatation. */
static PetscErrorCode FixLevel(Elasticity e, PetscInt body, PetscReal *next)
{
  LevelSum sum = {0};

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    const CellGroup *g = &e->groups[k];

    for (PetscInt slot = 0; slot < g->n_cells && g->multipliers >= 0; slot++)
      if (e->mesh->cell_body[g->cell[slot]] == body) AddCell(e, g, slot, next, &sum);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 3, MPIU_REAL, MPI_SUM, e->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum.kappa, 1, MPIU_REAL, MPI_MAX, e->mesh->comm));
  AddLevel(e, body, -(sum.change + sum.next) / sum.volume, next);
  e->enclosed.change = PetscMax(e->enclosed.change, PetscAbsReal(sum.change) / (sum.kappa * sum.volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnclosedFixLevels - makes the mean pressure of enclosed bodies zero.

  Collective

  Input Parameters:
+ e    - the elasticity
- next - the next multipliers, which are changed
@*/
PetscErrorCode EnclosedFixLevels(Elasticity e, PetscReal *next)
{
  PetscFunctionBeginUser;
  e->enclosed.change = 0;
  for (PetscInt b = 0; b < e->enclosed.n_bodies && e->enclosed.any; b++)
    if (e->enclosed.body[b]) PetscCall(FixLevel(e, b, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityEnclosedChange - says whether prescribed displacements change the volume of a body that keeps it.

  Not collective, the same on all ranks

  Input Parameter:
. e - the elasticity, after ElasticityAugment()
@*/
PetscBool ElasticityEnclosedChange(Elasticity e)
{
  return (PetscBool)(e->enclosed.change > ENCLOSED_CHANGE);
}

/* Adds internal forces times a factor to f, and the squares of the element forces to force2. */
static PetscErrorCode AddForces(Elasticity e, const PetscReal *u, PetscReal factor, PetscReal *f, PetscReal *force2)
{
  const PetscInt n = e->mesh->n_nodes * e->dim;
  PetscReal     *forces;
  PetscBool      ok;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &forces));
  PetscCall(ElasticityResidual(e, u, forces, NULL, force2, &ok));
  for (PetscInt d = 0; d < n; d++) f[d] += factor * forces[d];
  PetscCall(PetscFree(forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  EnclosedHold - says whether the error that is left in the volumes is beyond all free displacements.

  Collective

  Input Parameters:
+ e    - the elasticity
. u    - local displacements (length) [n_nodes*dim] of a solution with the present multipliers
- next - the next multipliers, after EnclosedFixLevels()

  Output Parameter:
. holds - PETSC_TRUE: there are enclosed bodies, they keep their volume, and the change of the multipliers has no forces
          on free nodes
@*/
PetscErrorCode EnclosedHold(Elasticity e, const PetscReal *u, const PetscReal *next, PetscBool *holds)
{
  const PetscInt n      = e->mesh->n_nodes * e->dim;
  PetscReal      sum[3] = {0, 0, 0}; /* squares: of the change of forces on free nodes, of the element forces twice */
  PetscReal     *f, *present = e->state.multiplier;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  *holds = PETSC_FALSE;
  if (!e->enclosed.any || ElasticityEnclosedChange(e)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(e->mesh->comm, &rank));
  PetscCall(PetscCalloc1(n, &f));
  PetscCall(AddForces(e, u, -1, f, &sum[1]));
  e->state.multiplier = (PetscReal *)next;
  PetscCall(AddForces(e, u, 1, f, &sum[2]));
  e->state.multiplier = present;
  PetscCall(MeshSumNodes(e->mesh, e->dim, f));
  for (PetscInt d = 0; d < n; d++)
    if (!e->enclosed.prescribed[d] && e->mesh->node_owner[d / e->dim] == rank) sum[0] += PetscSqr(f[d]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, e->mesh->comm));
  *holds = (PetscBool)(sum[0] <= PetscSqr(ENCLOSED_FORCE) * PetscMin(sum[1], sum[2]));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}
