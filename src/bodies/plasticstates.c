/* The plastic states of an elasticity: their archive, and what reports need of them. */
#include "elasticityimpl.h"

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

/* Saves or loads the directions of the last step's flow. */
static PetscErrorCode ArchiveFlow(Elasticity e, Archive archive, const Hdf5Table *cells)
{
  PetscInt   width = 0;
  PetscReal *values;

  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++)
    if (e->groups[k].flow) width = PetscMax(width, ElementStatePoints(&e->groups[k].kernel) * PLASTIC_FLOW);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &width, 1, MPIU_INT, MPI_MAX, e->mesh->comm));
  if (!width) PetscFunctionReturn(PETSC_SUCCESS); /* routines of users alone */
  PetscCall(PetscCalloc1(e->mesh->n_cells * width, &values));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt c = 0; c < e->mesh->n_cells; c++) {
      const CellGroup *g = &e->groups[e->cell_group[c]];
      const PetscInt   n = ElementStatePoints(&g->kernel) * PLASTIC_FLOW;

      if (!g->flow) continue;
      if (pass)
        PetscCall(PetscArraycpy(&g->flow[e->cell_slot[c] * n], &values[c * width], n));
      else
        PetscCall(PetscArraycpy(&values[c * width], &g->flow[e->cell_slot[c] * n], n));
    }
    if (!pass) PetscCall(ArchiveRows(archive, "model/plastic_flow", cells, (int)width, values));
  }
  PetscCall(PetscFree(values));
  PetscCall(ArchiveReals(archive, "model/plastic_flow_dt", 1, &e->flow_dt));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(ArchiveFlow(e, archive, &cells));
  PetscCall(Hdf5TableDestroy(&cells));
  PetscCall(PetscFree(values));
  PetscCall(ArchiveReals(archive, "model/plastic_time", 1, &e->accepted_t));
  ElasticitySetTime(e, e->accepted_t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives number k of the state of point p of a cell, 0 in elastic cells. state: those of the group. */
static PetscReal CellState(const CellGroup *g, const PetscReal *state, PetscInt slot, int p, int k)
{
  const size_t first = (size_t)(slot / KERNEL_LANES) * KERNEL_LANES * ElasticityCellStates(g) + slot % KERNEL_LANES;

  return state ? state[first + ((size_t)p * ElementStates(&g->kernel) + k) * KERNEL_LANES] : 0;
}

/*@
  ElasticityPointStrain - returns the equivalent plastic strain of a point.

  Not collective

  Input Parameters:
+ g     - the group of its cell
. state - states of the group, the accepted ones or a copy of others
. slot  - number of the cell there
- p     - number of the point

  Note:
  Of a user's routine none is known.
@*/
PetscReal ElasticityPointStrain(const CellGroup *g, const PetscReal *state, PetscInt slot, int p)
{
  return g->plastic.umat ? 0 : CellState(g, state, slot, p, PLASTIC_STRAIN);
}

/*@
  ElasticityPointWork - returns the plastic work of a point per volume, of a user's routine SPD + SCD.

  Not collective

  Input Parameters:
+ g     - the group of its cell
. state - states of the group, the accepted ones or a copy of others
. slot  - number of the cell there
- p     - number of the point
@*/
PetscReal ElasticityPointWork(const CellGroup *g, const PetscReal *state, PetscInt slot, int p)
{
  PetscReal slope, density;

  if (g->plastic.umat)
    return CellState(g, state, slot, p, UMAT_ENERGY + 1) + CellState(g, state, slot, p, UMAT_ENERGY + 2);
  (void)HardeningStress(g->plastic.hardening, CellState(g, state, slot, p, PLASTIC_STRAIN), &slope, &density);
  if (PlasticStates(g->plastic.hardening) > PLASTIC_WORK) density += CellState(g, state, slot, p, PLASTIC_WORK);
  return density;
}

/*@
  ElasticityPointTensor - computes the plastic strain tensor of a point, see PlasticStrainTensor().

  Not collective

  Input Parameters:
+ g     - the group of its cell
. state - states of the group, the accepted ones or a copy of others
. slot  - number of the cell there
- p     - number of the point

  Output Parameter:
. strain - xx yy zz xy yz xz; 0 of a user's routine
@*/
void ElasticityPointTensor(const CellGroup *g, const PetscReal *state, PetscInt slot, int p, PetscReal strain[6])
{
  PetscReal six[6];

  for (int k = 0; k < 6; k++) strain[k] = 0;
  if (!state || g->plastic.umat) return;
  for (int k = 0; k < 6; k++) six[k] = CellState(g, state, slot, p, k);
  PlasticStrainTensor(g->kernel.kinematics == KINEMATICS_FINITE, six, strain);
}

/* Gives the plastic strain of a point: the equivalent one, then the tensor. */
static void CellPlasticStrains(const CellGroup *g, PetscInt slot, int p, PetscReal strain[PLASTIC_FIELDS])
{
  strain[0] = ElasticityPointStrain(g, g->state, slot, p);
  ElasticityPointTensor(g, g->state, slot, p, &strain[1]);
}

/* Adds the share of one cell to its nodes. */
static void AddCellStrain(Elasticity e, PetscInt c, PetscReal *strain, PetscReal *weight)
{
  const CellGroup *g       = &e->groups[e->cell_group[c]];
  const Element   *element = ElementGet(g->kernel.type);
  const PetscInt  *nodes   = &e->mesh->cell_nodes[e->mesh->cell_ptr[c]];
  const int        first   = ElementStatePoints(&g->kernel) - element->points;
  PetscReal        X[MAX_DOFS], volumes[ELEMENT_MAX_POINTS], points[ELEMENT_MAX_POINTS][PLASTIC_FIELDS], volume = 0;

  ElasticitySlotCoordinates(e, g, e->cell_slot[c], X);
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
. bytes - memory of their states and of the last step's growth
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
    if (g->flow) *bytes += (PetscInt64)(g->n_cells * ElementStatePoints(&g->kernel) * PLASTIC_FLOW * sizeof(PetscReal));
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
    ElasticitySlotCoordinates(e, g, slot, X);
    ElementStateVolumes(&g->kernel, X, volume);
    for (int p = 0; p < ElementStatePoints(&g->kernel); p++) {
      *work += volume[p] * ElasticityPointWork(g, g->state, slot, p);
      *strain = PetscMax(*strain, ElasticityPointStrain(g, g->state, slot, p));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
