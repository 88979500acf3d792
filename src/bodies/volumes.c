/* The multipliers of mixed elements: bodies that keep their volume exactly, or so nearly that elements treat a part of
   the modulus of the volume only (ElementVolumeModuli()). The augmented Lagrangian of Hestenes and Powell: with
   multipliers m, the pressure of a solution is m + kappa theta. It should be modulus * theta. The next multipliers are
   (1 - kappa / modulus) (m + kappa theta), and a solution at which they do not change is right.

   Newton's method changes them along with the displacements, so that one solve is enough as a rule: after each
   iteration the pressures become those of its linear problem, the unknowns of the mixed method. */
#include "elasticityimpl.h"
#include "enclosed.h"

/* Error that may be left in the strain of the volume, relative to the strains of the bodies, both in the norm of the
   energy. It is far below the errors of meshes. */
#define VOLUME_TOLERANCE 1e-6
/* Square of a strain that is negligible, for bodies without stress. It is far above the round-off of displacements and
   far below any strain of interest. */
#define VOLUME_STRAIN2 1e-20

/*@
  ElasticityAugments - says whether a body has multipliers.

  Not collective, the same on all ranks

  Input Parameter:
. e - the elasticity
@*/
PetscBool ElasticityAugments(Elasticity e)
{
  return e->augments;
}

/* Computes the next multipliers of a batch at u. */
static void NextMultipliers(Elasticity e, CellGroup *g, PetscInt batch, const PetscReal *u, PetscReal *next)
{
  const size_t     first = (size_t)batch * KERNEL_LANES;
  const PetscReal *m = ElasticityMultipliers(e, g, batch), *constants = &g->constants[first * g->kernel.n_constants];

  ElasticityGather(e, g, batch, u, e->u);
  ElementDilatation(&g->kernel, &g->X[first * (size_t)(g->nodes * e->dim)], e->u, constants, m, next);
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    VolumeModuli moduli;

    ElementVolumeModuli(&g->kernel, constants + lane, KERNEL_LANES, &moduli);
    for (int k = lane; k < ElementPressures(&g->kernel) * KERNEL_LANES; k += KERNEL_LANES)
      next[k] = (1 - moduli.kappa / moduli.projected) * (m[k] + moduli.kappa * next[k]);
  }
}

/* Sums the energy of the error in the volume over the cells of a batch, and the energy of a negligible strain. */
static void AddVolumeError(Elasticity e, const CellGroup *g, PetscInt batch, const PetscReal *next, PetscReal sum[2])
{
  const PetscReal *m = ElasticityMultipliers(e, g, batch);

  for (int lane = 0; lane < ElasticityBatchCells(g, batch); lane++) {
    const PetscReal *constants = &g->constants[(size_t)batch * KERNEL_LANES * g->kernel.n_constants + lane];
    VolumeModuli     moduli;

    ElementVolumeModuli(&g->kernel, constants, KERNEL_LANES, &moduli);
    for (int k = lane; k < ElementPressures(&g->kernel) * KERNEL_LANES; k += KERNEL_LANES)
      sum[0] += moduli.mu * PetscSqr((next[k] - m[k]) / moduli.kappa);
    sum[1] += moduli.mu * VOLUME_STRAIN2 * ElasticitySlotVolume(e, g, batch * KERNEL_LANES + lane);
  }
}

/* Computes the next multipliers of all batches at u. */
static PetscErrorCode AllNextMultipliers(Elasticity e, const PetscReal *u, PetscReal *next)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    for (PetscInt batch = 0; batch < g->n_batches && g->multipliers >= 0; batch++)
      NextMultipliers(e, g, batch, u, ElasticityMultipliersOf(g, batch, next));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Compares the error that is left in the volumes with the strains. */
static PetscErrorCode VolumesHold(Elasticity e, const PetscReal *u, const PetscReal *next, PetscBool *holds)
{
  PetscReal sum[3] = {0, 0, 0}; /* energies: of the error, of a negligible strain, of all cells */
  PetscBool ok;

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    for (PetscInt batch = 0; batch < g->n_batches && g->multipliers >= 0; batch++)
      AddVolumeError(e, g, batch, ElasticityMultipliersOf(g, batch, (PetscReal *)next), sum);
  }
  PetscCall(ElasticityResidual(e, u, NULL, &sum[2], NULL, &ok));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, e->mesh->comm));
  *holds = (PetscBool)(sum[0] <= PetscSqr(VOLUME_TOLERANCE) * sum[2] + sum[1]);
  PetscCall(PetscInfo(NULL, "error of the volume strains %g of the strains\n",
                      (double)PetscSqrtReal(sum[2] > 0 ? sum[0] / sum[2] : 0)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityAugment - finds out whether the volumes of the bodies are right, and changes the multipliers if not.

  Collective

  Input Parameters:
+ e - the elasticity
- u - local displacements (length) [n_nodes*dim] of a solution with the present multipliers

  Output Parameter:
. holds - PETSC_FALSE: the multipliers were changed, and the step is to be solved on

  Note:
  Where a body is enclosed (enclosed.h), a change of the multipliers that moves nothing counts as none.
@*/
PetscErrorCode ElasticityAugment(Elasticity e, const PetscReal *u, PetscBool *holds)
{
  PetscReal *next;

  PetscFunctionBeginUser;
  *holds = PETSC_TRUE;
  if (!e->augments) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(e->state.n, &next));
  PetscCall(AllNextMultipliers(e, u, next));
  PetscCall(EnclosedFixLevels(e, next));
  PetscCall(VolumesHold(e, u, next, holds));
  if (!*holds) {
    PetscCall(EnclosedHold(e, u, next, holds));
    PetscCall(PetscArraycpy(e->state.multiplier, next, e->state.n));
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityFollow - sets the multipliers so that the pressures are those of the linear step that led to an iterate.

  Not collective

  Input Parameters:
+ e         - the elasticity
. u         - local displacements (length) [n_nodes*dim] of an iterate of Newton's method
. reference - the iterate before, u as above, from which a linear step with the present multipliers led to u
- part      - the part of that step that was taken, up to u

  Note:
  Residual and energy at u are others afterwards. The tangent takes a reference with held = 1 then. Pressures are
  unknowns of the linear step: of their change over all of it they get the part that displacements got. Over a tiny part
  they stay, however wrong the volumes are where the step begins.
@*/
PetscErrorCode ElasticityFollow(Elasticity e, const PetscReal *u, const StressReference *reference, PetscReal part)
{
  const StressReference gathered = {e->u_0, reference->rate, 0}, start = {e->u_0, 0, 0};
  PetscReal             next[MIXED_PRESSURES * KERNEL_LANES], there[MIXED_PRESSURES * KERNEL_LANES];

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    for (PetscInt batch = 0; batch < g->n_batches && g->multipliers >= 0; batch++) {
      const size_t first = (size_t)batch * KERNEL_LANES;
      PetscReal   *m     = ElasticityMultipliers(e, g, batch);

      ElasticityGather(e, g, batch, u, e->u);
      ElasticityGather(e, g, batch, reference->u, e->u_0);
      ElementFollow(&g->kernel, &g->X[first * (size_t)(g->nodes * e->dim)], e->u, &gathered,
                    &g->constants[first * g->kernel.n_constants], m, next);
      if (part < 1)
        ElementFollow(&g->kernel, &g->X[first * (size_t)(g->nodes * e->dim)], e->u, &start,
                      &g->constants[first * g->kernel.n_constants], m, there);
      for (int k = 0; k < ElementPressures(&g->kernel) * KERNEL_LANES; k++)
        m[k] = part < 1 ? next[k] - (1 - part) * (there[k] - m[k]) : next[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityYield - makes the energy one whose minimum can be searched along a step, until ElasticityYieldSet() ends
  that.

  Not collective

  Input Parameters:
+ e    - the elasticity
. u    - local displacements (length) [n_nodes*dim] at the start of a linear step
- next - those at its end

  Note:
  A linear step that keeps the volume changes it by the square of its length, which moduli of the volume make into more
  energy than the step gains. The energy is that of a soft volume about the pressures of the step's linear problem. It
  has its minimum where the other has it, once the pressures are right. Its slope at the start is not the residual's,
  since its pressures are not those of the start: it may rise from there on. Residuals remain.
@*/
PetscErrorCode ElasticityYield(Elasticity e, const PetscReal *u, const PetscReal *next)
{
  const StressReference gathered = {e->u_0, 1, 0};

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    for (PetscInt batch = 0; batch < g->n_batches && g->yielding >= 0; batch++) {
      const size_t first = (size_t)batch * KERNEL_LANES;

      ElasticityGather(e, g, batch, next, e->u);
      ElasticityGather(e, g, batch, u, e->u_0);
      ElementYield(&g->kernel, &g->X[first * (size_t)(g->nodes * e->dim)], e->u, &gathered,
                   &g->constants[first * g->kernel.n_constants], ElasticityMultipliers(e, g, batch),
                   ElasticityYieldingOf(e, g, batch));
    }
  }
  e->yields = e->may_yield;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityYields - says whether energies are those that ElasticityYield() made.

  Not collective

  Input Parameter:
. e - the elasticity
@*/
PetscBool ElasticityYields(Elasticity e)
{
  return e->yields;
}

/*@
  ElasticityYieldSet - goes between the energies that ElasticityYield() made and the true ones.

  Not collective

  Input Parameters:
+ e      - the elasticity
- yields - energies are those that ElasticityYield() made last
@*/
void ElasticityYieldSet(Elasticity e, PetscBool yields)
{
  e->yields = yields;
}

/*@
  ElasticityYieldForces - says whether forces are to be those of the energies that ElasticityYield() made, too.

  Not collective

  Input Parameters:
+ e     - the elasticity
- yield - they are, as long as ElasticityYields()

  Note:
  For the work that is done where loads have no energy.
@*/
void ElasticityYieldForces(Elasticity e, PetscBool yield)
{
  e->forces = yield;
}

/*@
  ElasticityAccept - makes the present multipliers those of the accepted state.

  Not collective

  Input Parameter:
. e - the elasticity
@*/
PetscErrorCode ElasticityAccept(Elasticity e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(e->accepted.multiplier, e->state.multiplier, e->state.n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityRestore - returns to the multipliers of the accepted state.

  Not collective

  Input Parameter:
. e - the elasticity
@*/
PetscErrorCode ElasticityRestore(Elasticity e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(e->state.multiplier, e->accepted.multiplier, e->state.n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityKeep - remembers the present multipliers for ElasticityReturn().

  Not collective

  Input Parameters:
+ e     - the elasticity
- state - which of the states on the way this is
@*/
PetscErrorCode ElasticityKeep(Elasticity e, VolumesKept state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(e->kept[state].multiplier, e->state.multiplier, e->state.n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityReturn - returns to the multipliers that ElasticityKeep() has remembered.

  Not collective

  Input Parameters:
+ e     - the elasticity
- state - which of the states on the way
@*/
PetscErrorCode ElasticityReturn(Elasticity e, VolumesKept state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(e->state.multiplier, e->kept[state].multiplier, e->state.n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies multipliers between the batches and rows of MIXED_PRESSURES by cell. The lanes that repeat the last cell of a
   group repeat its multipliers. */
static void CopyByCell(Elasticity e, PetscBool loads, PetscReal *rows)
{
  for (int k = 0; k < e->n_groups; k++) {
    const CellGroup *g         = &e->groups[k];
    const int        pressures = ElementPressures(&g->kernel);

    for (PetscInt slot = 0; slot < g->n_batches * KERNEL_LANES && g->multipliers >= 0; slot++) {
      PetscReal *const m   = ElasticityMultipliers(e, g, slot / KERNEL_LANES) + slot % KERNEL_LANES;
      PetscReal *const row = &rows[g->cell[slot] * MIXED_PRESSURES];

      for (int p = 0; p < pressures; p++) {
        if (loads)
          m[p * KERNEL_LANES] = row[p];
        else
          row[p] = m[p * KERNEL_LANES];
      }
    }
  }
}

/*@
  ElasticityArchive - saves or loads the multipliers of the accepted state, by cell.

  Collective

  Input Parameters:
+ e       - the elasticity
- archive - decides whether they are saved or loaded

  Note:
  After loading, the present multipliers are those of the accepted state.
@*/
PetscErrorCode ElasticityArchive(Elasticity e, Archive archive)
{
  const Mesh mesh = e->mesh;
  PetscReal *rows;
  Hdf5Table  cells;

  PetscFunctionBeginUser;
  if (!e->augments) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ElasticityRestore(e));
  PetscCall(PetscCalloc1(mesh->n_cells * MIXED_PRESSURES, &rows));
  CopyByCell(e, PETSC_FALSE, rows);
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_cells_global, mesh->n_cells, mesh->cell_id, &cells));
  PetscCall(ArchiveRows(archive, "elasticity/multiplier", &cells, MIXED_PRESSURES, rows));
  PetscCall(Hdf5TableDestroy(&cells));
  if (ArchiveLoads(archive)) CopyByCell(e, PETSC_TRUE, rows);
  PetscCall(ElasticityAccept(e));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
