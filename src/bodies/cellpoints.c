/* The points of cells: their places, displacement gradients and stresses, and how these change. */
#include "elasticityimpl.h"

/* Part of a cell's size by which its nodes are moved to both sides for a derivative of its displacement gradients. The
   error of the difference, which is as the square, and that of rounding are then both about 1e-10 of it. */
#define POINT_STEP 1e-5

/*@
  ElasticityHas - says whether any cell has a formulation.

  Collective

  Input Parameters:
+ e           - the elasticity
- formulation - such as that of enhanced elements, whose gradients are not those of displacements

  Output Parameter:
. any - the same on all ranks
@*/
PetscErrorCode ElasticityHas(Elasticity e, Formulation formulation, PetscBool *any)
{
  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (int g = 0; g < e->n_groups; g++) *any = (PetscBool)(*any || e->groups[g].kernel.formulation == formulation);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, e->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A batch of a group */
typedef struct {
  CellGroup *g;
  PetscInt   batch;
} Place;

/* Finds a batch by its number among those of all groups. */
static Place PlaceOf(Elasticity e, PetscInt batch)
{
  CellGroup *g = e->groups;

  for (; batch >= g->n_batches; g++) batch -= g->n_batches;
  return (Place){.g = g, .batch = batch};
}

/*@
  ElasticityBatches - counts the batches of cells whose points are evaluated together.

  Not collective

  Input Parameter:
. e - the elasticity
@*/
PetscInt ElasticityBatches(Elasticity e)
{
  PetscInt n = 0;

  for (int g = 0; g < e->n_groups; g++) n += e->groups[g].n_batches;
  return n;
}

/*@
  ElasticityBatch - gives the cells of a batch, which have one type and law.

  Not collective

  Input Parameters:
+ e     - the elasticity
- batch - less than ElasticityBatches()

  Output Parameters:
+ n    - their number, at most ELASTICITY_BATCH
- cell - local cells [n]; borrowed
@*/
void ElasticityBatch(Elasticity e, PetscInt batch, int *n, const PetscInt **cell)
{
  const Place at = PlaceOf(e, batch);

  *n    = ElasticityBatchCells(at.g, at.batch);
  *cell = &at.g->cell[(size_t)at.batch * KERNEL_LANES];
}

/* The table of the points of a cell. */
static const Element *PointTable(const CellGroup *g, CellPoints set)
{
  return set == POINTS_OF_PRODUCTS ? ElementGetProducts(g->kernel.type) : ElementGet(g->kernel.type);
}

/* How many moves of a cell show all its points, its own points counting as one. */
static int Moves(const CellGroup *g, CellPoints set)
{
  return PointTable(g, set)->points / ElementGet(g->kernel.type)->points;
}

/* Moves the nodes of elements with one point so that this point stands where the element has a point of products, and
   adds to their values what a linear field changes by: at its point the element then shows the state of that place.
   values: [n_nodes][dim][lanes], coordinates or those of a field; n_nodes: a multiple of the corners, as pressures
   follow. */
static void MoveToPoint(const CellGroup *g, CellPoints set, int point, int n_nodes, int dim, int lanes,
                        PetscReal *values)
{
  const Element *own = ElementGet(g->kernel.type), *table = PointTable(g, set);
  const int      stride = dim * lanes;

  if (table == own) return;
  for (int first = 0; first < n_nodes; first += own->nodes) {
    for (int i = 0; i < stride; i++) {
      PetscReal change = 0;

      for (int a = 0; a < own->nodes; a++)
        change += (table->N[point][a] - own->N[0][a]) * values[(first + a) * stride + i];
      for (int a = 0; a < own->nodes; a++) values[(first + a) * stride + i] += change;
    }
  }
}

/*@
  ElasticityPlacePoints - gives the points of a cell.

  Not collective

  Input Parameters:
+ e    - the elasticity
. cell - a local cell
- set  - which points

  Output Parameters:
+ x      - reference coordinates (length) [points][dim]
- volume - reference volumes, axisymmetric: over 360 degrees [points]
@*/
PetscErrorCode ElasticityPlacePoints(Elasticity e, PetscInt cell, CellPoints set, PetscReal *x, PetscReal *volume)
{
  const CellGroup *g     = &e->groups[e->cell_group[cell]];
  const Element   *table = PointTable(g, set);
  const int        moves = Moves(g, set);
  PetscReal        X[MAX_DOFS], at[MAX_DOFS];

  PetscFunctionBeginUser;
  ElasticitySlotCoordinates(e, g, e->cell_slot[cell], X);
  for (int m = 0; m < moves; m++) {
    PetscCall(PetscArraycpy(at, X, table->nodes * e->dim));
    MoveToPoint(g, set, m, table->nodes, e->dim, 1, at);
    ElementPointVolumes(g->kernel.type, e->dim, g->kernel.geometry, at, &volume[m]);
    if (moves > 1) volume[m] /= moves;
  }
  for (int p = 0; p < table->points; p++) {
    for (int i = 0; i < e->dim; i++) {
      x[p * e->dim + i] = 0;
      for (int a = 0; a < table->nodes; a++) x[p * e->dim + i] += table->N[p][a] * X[a * e->dim + i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacement gradients, stresses and pressures of a batch */
typedef struct {
  PetscReal H[ELEMENT_MAX_POINTS * 9 * KERNEL_LANES], P[ELEMENT_MAX_POINTS * 9 * KERNEL_LANES],
    pressure[ELEMENT_MAX_POINTS * KERNEL_LANES];
} BatchStates;

/* ElementBatchNominal() at all points of a set. u: of the batch; stresses: they are wanted. */
static void MovedStates(Elasticity e, Place at, const KernelCase *kernel, CellPoints set, const PetscReal *u,
                        const PetscReal *constants, PetscBool stresses, BatchStates *states)
{
  const CellGroup *g    = at.g;
  const int        dofs = g->nodes * e->dim * KERNEL_LANES, moves = Moves(g, set);
  const PetscReal *X = &g->X[(size_t)at.batch * dofs], *m = ElasticityMultipliers(e, g, at.batch);
  PetscReal        X_at[MAX_DOFS * KERNEL_LANES], u_at[MAX_DOFS * KERNEL_LANES];

  for (int k = 0; k < moves; k++) {
    for (int i = 0; i < dofs && moves > 1; i++) {
      X_at[i] = X[i];
      u_at[i] = u[i];
    }
    MoveToPoint(g, set, k, g->nodes, e->dim, KERNEL_LANES, X_at);
    MoveToPoint(g, set, k, g->nodes, e->dim, KERNEL_LANES, u_at);
    ElementBatchNominal(kernel, moves > 1 ? X_at : X, moves > 1 ? u_at : u, constants, m,
                        &states->H[9 * k * KERNEL_LANES], &states->pressure[k * KERNEL_LANES],
                        stresses ? &states->P[9 * k * KERNEL_LANES] : NULL);
  }
}

static const PetscReal *ConstantsOf(Place at)
{
  return &at.g->constants[(size_t)at.batch * at.g->kernel.n_constants * KERNEL_LANES];
}

/* ElementBatchNominal() without stresses of elements whose displacement gradients are those of their nodes. */
static void NodalStates(Elasticity e, Place at, CellPoints set, const PetscReal *u, BatchStates *states)
{
  const KernelCase nodal = {.type        = at.g->kernel.type,
                            .geometry    = at.g->kernel.geometry,
                            .kinematics  = KINEMATICS_SMALL,
                            .law         = MATERIAL_LINEAR,
                            .formulation = FORMULATION_FULL};
  PetscReal        constants[2 * KERNEL_LANES];

  for (int k = 0; k < 2 * KERNEL_LANES; k++) constants[k] = 1;
  MovedStates(e, at, &nodal, set, u, constants, PETSC_FALSE, states);
}

/* Takes the points of the cells out of a batch, less those of another one; over: divided by this of each cell, 0: they
   are 0. */
static void TakePoints(Place at, CellPoints set, PetscBool stresses, const BatchStates *states, const BatchStates *less,
                       const PetscReal over[KERNEL_LANES], PointStates *cells)
{
  const int points = PointTable(at.g, set)->points;

  for (int lane = 0; lane < ElasticityBatchCells(at.g, at.batch); lane++) {
    const PetscReal factor = over ? (over[lane] > 0 ? 1 / over[lane] : 0) : 1;

    for (int k = 0; k < 9 * points; k++) {
      const int from = k * KERNEL_LANES + lane;

      cells[lane].H[k] = factor * (states->H[from] - (less ? less->H[from] : 0));
      cells[lane].P[k] = stresses ? factor * (states->P[from] - (less ? less->P[from] : 0)) : 0;
    }
    for (int p = 0; p < points; p++) {
      const int from = p * KERNEL_LANES + lane;

      cells[lane].pressure[p] = factor * (states->pressure[from] - (less ? less->pressure[from] : 0));
    }
  }
}

/*@
  ElasticityPointModes - gives the part of displacement gradients, or of their rates, that are not those of nodes: the
  modes of enhanced elements.

  Not collective

  Input Parameters:
+ e     - the elasticity
. batch - of cells, see ElasticityBatch()
- v     - local displacements (length) [n_nodes*dim], or a motion

  Input/Output Parameter:
. cells - H: displacement gradients of ElasticityPointStates() or their rates along v, less those of v itself
          [ELASTICITY_BATCH]
@*/
PetscErrorCode ElasticityPointModes(Elasticity e, PetscInt batch, const PetscReal *v, PointStates *cells)
{
  const Place at = PlaceOf(e, batch);
  const int   n  = 9 * ElementGet(at.g->kernel.type)->points;
  BatchStates nodal;

  PetscFunctionBeginUser;
  ElasticityGather(e, at.g, at.batch, v, e->u);
  NodalStates(e, at, POINTS_OF_ELEMENT, e->u, &nodal);
  for (int lane = 0; lane < ElasticityBatchCells(at.g, at.batch); lane++)
    for (int k = 0; k < n; k++)
      cells[lane].H[k] =
        at.g->kernel.formulation == FORMULATION_ENHANCED ? cells[lane].H[k] - nodal.H[k * KERNEL_LANES + lane] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityPointStates - gives displacement gradients and stresses at points of a batch of cells.

  Not collective

  Input Parameters:
+ e     - the elasticity; its multipliers and its accepted plastic state are those of the step to u
. batch - of cells, see ElasticityBatch()
. set   - which points
- u     - local displacements (length) [n_nodes*dim]

  Output Parameter:
. cells - displacement gradients, as the elements evaluate the law with, stresses and pressures [ELASTICITY_BATCH]
@*/
PetscErrorCode ElasticityPointStates(Elasticity e, PetscInt batch, CellPoints set, const PetscReal *u,
                                     PointStates *cells)
{
  const Place at = PlaceOf(e, batch);
  BatchStates states;

  PetscFunctionBeginUser;
  ElasticityGather(e, at.g, at.batch, u, e->u);
  MovedStates(e, at, &at.g->kernel, set, e->u, ConstantsOf(at), PETSC_TRUE, &states);
  TakePoints(at, set, PETSC_TRUE, &states, NULL, NULL, cells);
  for (int lane = 0; lane < ElasticityBatchCells(at.g, at.batch); lane++) {
    VolumeModuli moduli = {.projected = INFINITY};

    if (at.g->kernel.formulation == FORMULATION_MIXED)
      ElementVolumeModuli(&at.g->kernel, &ConstantsOf(at)[lane], KERNEL_LANES, &moduli);
    cells[lane].compliance = 1 / moduli.projected;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest difference of the entries of a motion between two nodes of a cell of a batch, those from first to before
   nodes. */
static PetscReal LargestDifference(int first, int nodes, int dim, int lane, const PetscReal *v)
{
  PetscReal most = 0;

  for (int a = first + 1; a < nodes; a++)
    for (int i = 0; i < dim; i++)
      most = PetscMax(
        most, PetscAbsReal(v[(a * dim + i) * KERNEL_LANES + lane] - v[(first * dim + i) * KERNEL_LANES + lane]));
  return most;
}

/* The part of a motion by which the nodes of each cell of a batch are moved for derivatives along it, and twice that;
   0: nothing changes along it. */
static void ChooseSteps(Elasticity e, Place at, const PetscReal *v, PetscReal step[KERNEL_LANES],
                        PetscReal twice[KERNEL_LANES])
{
  const CellGroup *g     = at.g;
  const int        nodes = ElementGet(g->kernel.type)->nodes, dim = e->dim;

  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    const PetscInt slot = PetscMin(at.batch * KERNEL_LANES + lane, g->n_cells - 1);
    PetscReal      X[MAX_DOFS], most;

    most = PetscMax(LargestDifference(0, nodes, dim, lane, v), LargestDifference(nodes, g->nodes, dim, lane, v));
    for (int a = 0; a < nodes && g->kernel.geometry == GEOMETRY_AXISYMMETRIC; a++)
      most = PetscMax(most, PetscAbsReal(v[a * dim * KERNEL_LANES + lane]));
    ElasticitySlotCoordinates(e, g, slot, X);
    step[lane]  = most > 0 ? POINT_STEP * CellLength(g->kernel.type, dim, X) / most : 0;
    twice[lane] = 2 * step[lane];
  }
}

/*@
  ElasticityPointRates - gives how displacement gradients, stresses and pressures at points of a batch of cells change
  along a motion.

  Not collective

  Input Parameters:
+ e        - the elasticity, as for ElasticityPointStates()
. batch    - of cells, see ElasticityBatch()
. set      - which points
. u        - local displacements (length) [n_nodes*dim]
. v        - local motion [n_nodes*dim]
- stresses - PETSC_FALSE: those of stresses are not wanted, and are 0

  Output Parameter:
. cells - derivatives along v [ELASTICITY_BATCH]
@*/
PetscErrorCode ElasticityPointRates(Elasticity e, PetscInt batch, CellPoints set, const PetscReal *u,
                                    const PetscReal *v, PetscBool stresses, PointStates *cells)
{
  const Place at   = PlaceOf(e, batch);
  const int   dofs = at.g->nodes * e->dim * KERNEL_LANES;
  PetscReal   step[KERNEL_LANES], twice[KERNEL_LANES], moved[MAX_DOFS * KERNEL_LANES];
  BatchStates states[2];

  PetscFunctionBeginUser;
  ElasticityGather(e, at.g, at.batch, v, e->u_0);
  if (at.g->kernel.formulation == FORMULATION_FULL && !stresses) { /* gradients are linear in displacements */
    NodalStates(e, at, set, e->u_0, states);
    TakePoints(at, set, PETSC_FALSE, states, NULL, NULL, cells);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ElasticityGather(e, at.g, at.batch, u, e->u);
  ChooseSteps(e, at, e->u_0, step, twice);
  for (int side = 0; side < 2; side++) {
    for (int k = 0; k < dofs; k++) moved[k] = e->u[k] + (side ? 1 : -1) * step[k % KERNEL_LANES] * e->u_0[k];
    MovedStates(e, at, &at.g->kernel, set, moved, ConstantsOf(at), stresses, &states[side]);
  }
  TakePoints(at, set, stresses, &states[1], &states[0], twice, cells);
  PetscFunctionReturn(PETSC_SUCCESS);
}
