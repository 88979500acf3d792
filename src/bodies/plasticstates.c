/* The plastic states of an elasticity: acceptance, archive, and what reports need of them. */
#include "elasticityimpl.h"

/* Copies the equivalent plastic strains of all points of a batch. A user's routine has none. */
static void BatchStrains(const CellGroup *g, PetscInt batch, double *strains)
{
  const int     points = g->plastic.umat ? 0 : ElementStatePoints(&g->kernel), states = ElementStates(&g->plastic);
  const double *state = &g->state[(size_t)batch * KERNEL_LANES * ElasticityCellStates(g)];

  for (int p = 0; p < points; p++)
    for (int lane = 0; lane < KERNEL_LANES; lane++)
      strains[p * KERNEL_LANES + lane] = state[(p * states + PLASTIC_STRAIN) * KERNEL_LANES + lane];
}

/* The largest growth of these strains since they were copied. */
static PetscReal BatchGrowth(const CellGroup *g, PetscInt batch, const double *before)
{
  const int points = g->plastic.umat ? 0 : ElementStatePoints(&g->kernel);
  double    now[ELEMENT_MAX_POINTS * KERNEL_LANES];
  PetscReal most = 0;

  BatchStrains(g, batch, now);
  for (int k = 0; k < points * KERNEL_LANES; k++) most = PetscMax(most, now[k] - before[k]);
  return most;
}

/* Makes the plastic state of a group's cells at u the accepted one; growth: raised to its largest growth. */
static PetscErrorCode AcceptGroup(Elasticity e, CellGroup *g, const PetscReal *u, PetscReal *growth)
{
  const size_t dofs = (size_t)g->nodes * e->dim;
  double       before[ELEMENT_MAX_POINTS * KERNEL_LANES];

  PetscFunctionBeginUser;
  for (PetscInt batch = 0; batch < g->n_batches && g->state; batch++) {
    const size_t first = (size_t)batch * KERNEL_LANES;

    BatchStrains(g, batch, before);
    ElasticityGather(e, g, batch, u, e->u);
    ElementAcceptState(&g->kernel, &g->X[first * dofs], e->u, &g->constants[first * g->kernel.n_constants],
                       ElasticityMultipliers(e, g, batch));
    *growth = PetscMax(*growth, BatchGrowth(g, batch, before));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityAcceptPlastic - makes the plastic state at given displacements the accepted one, from which all others
start.

  Not collective

  Input Parameters:
+ e - the elasticity
. u - local displacements (length) [n_nodes*dim] of a state that is accepted
- t - its time

  Output Parameter:
. growth - of the equivalent plastic strain of a quadrature point of this rank, the largest

  Note:
  Residual, tangent and energy at u and t stay the same, up to round-off. Nothing happens where no body is plastic.
@*/
PetscErrorCode ElasticityAcceptPlastic(Elasticity e, const PetscReal *u, PetscReal t, PetscReal *growth)
{
  PetscFunctionBeginUser;
  *growth = 0;
  ElasticitySetTime(e, t);
  for (int k = 0; k < e->n_groups; k++) PetscCall(AcceptGroup(e, &e->groups[k], u, growth));
  e->accepted_t = t;
  ElasticitySetTime(e, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityPlasticGrowth - computes the largest growth of the equivalent plastic strain from the accepted state.

  Collective

  Input Parameters:
+ e - the elasticity
. u - local displacements (length) [n_nodes*dim]
- t - load parameter at u

  Output Parameter:
. growth - over all quadrature points of all ranks

  Note:
  The accepted state stays what it is.
@*/
PetscErrorCode ElasticityPlasticGrowth(Elasticity e, const PetscReal *u, PetscReal t, PetscReal *growth)
{
  const PetscReal accepted_t = e->accepted_t;
  PetscReal     **before;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(e->n_groups, &before));
  for (int k = 0; k < e->n_groups; k++) {
    const CellGroup *g = &e->groups[k];
    const size_t     n = (size_t)g->n_batches * KERNEL_LANES * ElasticityCellStates(g);

    if (!g->state) continue;
    PetscCall(PetscMalloc1(n, &before[k]));
    PetscCall(PetscArraycpy(before[k], g->state, n));
  }
  PetscCall(ElasticityAcceptPlastic(e, u, t, growth));
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup   *g = &e->groups[k];
    const size_t n = (size_t)g->n_batches * KERNEL_LANES * ElasticityCellStates(g);

    if (!g->state) continue;
    PetscCall(PetscArraycpy(g->state, before[k], n));
    PetscCall(PetscFree(before[k]));
  }
  e->accepted_t = accepted_t;
  ElasticitySetTime(e, t);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, growth, 1, MPIU_REAL, MPI_MAX, e->mesh->comm));
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the plastic state of a cell out of its group or into it. */
static void CopyState(CellGroup *g, PetscInt slot, PetscBool out, PetscReal *values)
{
  const PetscInt end = slot == g->n_cells - 1 ? g->n_batches * KERNEL_LANES : slot + 1;

  for (PetscInt s = slot; s < (out ? slot + 1 : end); s++) { /* the last batch repeats its last cell */
    PetscReal *state =
      &g->state[(size_t)(s / KERNEL_LANES) * KERNEL_LANES * ElasticityCellStates(g) + s % KERNEL_LANES];

    for (size_t k = 0; k < ElasticityCellStates(g); k++) {
      if (out)
        values[k] = state[k * KERNEL_LANES];
      else
        state[k * KERNEL_LANES] = values[k];
    }
  }
}

/*@
  ElasticityArchivePlastic - saves or loads the plastic state.

  Collective

  Input Parameters:
+ e       - the elasticity
- archive - decides whether the state is saved or loaded

  Note:
  Nothing is saved where no body is plastic.
@*/
PetscErrorCode ElasticityArchivePlastic(Elasticity e, Archive archive)
{
  const Mesh mesh  = e->mesh;
  PetscInt   width = 0;
  PetscReal *values;
  Hdf5Table  cells;

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) width = PetscMax(width, (PetscInt)ElasticityCellStates(&e->groups[k]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &width, 1, MPIU_INT, MPI_MAX, mesh->comm));
  if (!width) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(mesh->n_cells * width, &values));
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_cells_global, mesh->n_cells, mesh->cell_id, &cells));
  for (PetscInt c = 0; c < mesh->n_cells && !ArchiveLoads(archive); c++)
    CopyState(&e->groups[e->cell_group[c]], e->cell_slot[c], PETSC_TRUE, &values[c * width]);
  PetscCall(ArchiveRows(archive, "model/plastic_state", &cells, (int)width, values));
  for (PetscInt c = 0; c < mesh->n_cells && ArchiveLoads(archive); c++)
    CopyState(&e->groups[e->cell_group[c]], e->cell_slot[c], PETSC_FALSE, &values[c * width]);
  PetscCall(Hdf5TableDestroy(&cells));
  PetscCall(PetscFree(values));
  PetscCall(ArchiveReals(archive, "model/plastic_time", 1, &e->accepted_t));
  ElasticitySetTime(e, e->accepted_t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the coordinates of the nodes of a cell. */
static void CellCoordinates(Elasticity e, const CellGroup *g, PetscInt slot, PetscReal X[MAX_DOFS])
{
  const PetscInt *nodes = &e->mesh->cell_nodes[e->mesh->cell_ptr[g->cell[slot]]];

  for (int a = 0; a < ElementGet(g->kernel.type)->nodes; a++)
    for (int i = 0; i < e->dim; i++) X[a * e->dim + i] = e->mesh->coords[nodes[a] * e->dim + i];
}

/* Gives number k of the state of point p of a cell, 0 in elastic cells. */
static PetscReal CellState(const CellGroup *g, PetscInt slot, int p, int k)
{
  const size_t first = (size_t)(slot / KERNEL_LANES) * KERNEL_LANES * ElasticityCellStates(g) + slot % KERNEL_LANES;

  return g->state ? g->state[first + ((size_t)p * ElementStates(&g->plastic) + k) * KERNEL_LANES] : 0;
}

/* Gives the equivalent plastic strain of a point; of a user's routine none is known. */
static PetscReal CellPlasticStrain(const CellGroup *g, PetscInt slot, int p)
{
  return g->plastic.umat ? 0 : CellState(g, slot, p, PLASTIC_STRAIN);
}

/* Gives the plastic work of a point per volume, of a user's routine SPD + SCD. */
static PetscReal CellPlasticWork(const CellGroup *g, PetscInt slot, int p)
{
  PetscReal slope, density;

  if (g->plastic.umat) return CellState(g, slot, p, UMAT_ENERGY + 1) + CellState(g, slot, p, UMAT_ENERGY + 2);
  (void)HardeningStress(g->plastic.hardening, CellState(g, slot, p, PLASTIC_STRAIN), &slope, &density);
  if (ElementStates(&g->plastic) > PLASTIC_WORK) density += CellState(g, slot, p, PLASTIC_WORK);
  return density;
}

/* Gives the plastic strain of a point: the equivalent one, then the tensor. */
static void CellPlasticStrains(const CellGroup *g, PetscInt slot, int p, PetscReal strain[PLASTIC_FIELDS])
{
  PetscReal state[6];

  for (int k = 0; k < PLASTIC_FIELDS; k++) strain[k] = 0;
  if (!g->state || g->plastic.umat) return;
  for (int k = 0; k < 6; k++) state[k] = CellState(g, slot, p, k);
  strain[0] = CellPlasticStrain(g, slot, p);
  PlasticStrainTensor(g->kernel.kinematics == KINEMATICS_FINITE, state, &strain[1]);
}

/* Adds the share of one cell to its nodes. */
static void AddCellStrain(Elasticity e, PetscInt c, PetscReal *strain, PetscReal *weight)
{
  const CellGroup *g       = &e->groups[e->cell_group[c]];
  const Element   *element = ElementGet(g->kernel.type);
  const PetscInt  *nodes   = &e->mesh->cell_nodes[e->mesh->cell_ptr[c]];
  const int        first   = ElementStatePoints(&g->kernel) - element->points;
  PetscReal        X[MAX_DOFS], volumes[ELEMENT_MAX_POINTS], points[ELEMENT_MAX_POINTS][PLASTIC_FIELDS], volume = 0;

  CellCoordinates(e, g, e->cell_slot[c], X);
  ElementPointVolumes(g->kernel.type, e->dim, g->kernel.geometry, X, volumes);
  for (int p = 0; p < element->points; p++) {
    volume += volumes[p];
    CellPlasticStrains(g, e->cell_slot[c], first + p, points[p]);
  }
  for (int a = 0; a < element->nodes; a++) {
    for (int k = 0; k < PLASTIC_FIELDS; k++) {
      PetscReal fit = 0;

      for (int p = 0; p < element->points; p++) fit += element->fit[a][p] * points[p][k];
      strain[nodes[a] * PLASTIC_FIELDS + k] += volume * (k ? fit : PetscMax(fit, 0));
    }
    weight[nodes[a]] += volume;
  }
}

/*@
  ElasticityNodalPlasticStrain - computes this rank's share of the plastic strain at the nodes.

  Not collective

  Input Parameter:
. e - the elasticity

  Output Parameters:
+ strain - volume of the cells around a node times the strain there [n_nodes*PLASTIC_FIELDS]: the equivalent strain,
           then the tensor xx yy zz xy yz xz; axisymmetric: rr zz hoop rz 0 0
- weight - volume of the cells around a node [n_nodes]

  Note:
  As in ElasticityNodalStress(). A fit of the equivalent strain that is negative counts as 0. The tensor is that of
  PlasticStrainTensor().
@*/
PetscErrorCode ElasticityNodalPlasticStrain(Elasticity e, PetscReal *strain, PetscReal *weight)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(strain, e->mesh->n_nodes * PLASTIC_FIELDS));
  PetscCall(PetscArrayzero(weight, e->mesh->n_nodes));
  for (PetscInt c = 0; c < e->mesh->n_cells; c++) AddCellStrain(e, c, strain, weight);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityPlasticPoints - returns the number of quadrature points of this rank that have a plastic state.

  Not collective

  Input Parameter:
. e - the elasticity

  Output Parameter:
. bytes - memory of their states
@*/
PetscInt64 ElasticityPlasticPoints(Elasticity e, PetscInt64 *bytes)
{
  PetscInt64 points = 0;

  *bytes = 0;
  for (int k = 0; k < e->n_groups; k++) {
    const CellGroup *g = &e->groups[k];

    if (!g->kernel.plastic) continue;
    points += (PetscInt64)g->n_cells * ElementStatePoints(&g->kernel);
    *bytes += (PetscInt64)(g->n_cells * ElasticityCellStates(g) * sizeof(PetscReal));
  }
  return points;
}

/*@
  ElasticityPlasticWork - computes the plastic work of this rank's cells in the accepted state.

  Not collective

  Input Parameter:
. e - the elasticity

  Output Parameters:
+ work   - integral of the yield stress over the plastic strain, summed over the points (energy)
- strain - the largest equivalent plastic strain of a point
@*/
PetscErrorCode ElasticityPlasticWork(Elasticity e, PetscReal *work, PetscReal *strain)
{
  PetscFunctionBeginUser;
  *work = *strain = 0;
  for (PetscInt c = 0; c < e->mesh->n_cells; c++) {
    const CellGroup *g    = &e->groups[e->cell_group[c]];
    const PetscInt   slot = e->cell_slot[c];
    PetscReal        X[MAX_DOFS], volume[ELEMENT_MAX_POINTS];

    if (!g->state) continue;
    CellCoordinates(e, g, slot, X);
    ElementStateVolumes(&g->kernel, X, volume);
    for (int p = 0; p < ElementStatePoints(&g->kernel); p++) {
      *work += volume[p] * CellPlasticWork(g, slot, p);
      *strain = PetscMax(*strain, CellPlasticStrain(g, slot, p));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
