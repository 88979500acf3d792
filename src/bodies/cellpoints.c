/* The points of one cell: their places, displacement gradients and stresses, and how these change. */
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

/* Elements of a group whose displacement gradients are those of their nodes. */
static KernelCase NodalCase(const CellGroup *g)
{
  return (KernelCase){.type        = g->kernel.type,
                      .geometry    = g->kernel.geometry,
                      .kinematics  = KINEMATICS_SMALL,
                      .law         = MATERIAL_LINEAR,
                      .formulation = FORMULATION_FULL};
}

/*@
  ElasticityPointModes - gives the part of displacement gradients, or of their rates, that are not those of nodes: the
  modes of an enhanced element.

  Not collective

  Input Parameters:
+ e    - the elasticity
. cell - a local cell
- v    - local displacements (length) [n_nodes*dim], or a motion

  Input/Output Parameter:
. H - displacement gradient of ElasticityPointStates(), or its rate along v, less that of v itself [points][9]
@*/
PetscErrorCode ElasticityPointModes(Elasticity e, PetscInt cell, const PetscReal *v, PetscReal *H)
{
  CellGroup       *g     = &e->groups[e->cell_group[cell]];
  const KernelCase nodal = NodalCase(g);
  const int        n     = ElementGet(g->kernel.type)->points * 9;
  PetscReal        X[MAX_DOFS], cell_v[MAX_DOFS], constants[MATERIAL_MAX_CONSTANTS], m[MIXED_PRESSURES],
    gradient[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  if (g->kernel.formulation != FORMULATION_ENHANCED) {
    PetscCall(PetscArrayzero(H, n));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ElasticityGatherCell(e, g, e->cell_slot[cell], v, X, cell_v, constants, m);
  ElementPointState(&nodal, X, cell_v, (PetscReal[]){1, 1}, NULL, gradient, pressure);
  for (int k = 0; k < n; k++) H[k] -= gradient[k];
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* Moves the nodes of an element with one point so that this point stands where the element has a point of products, and
   adds to their values what a linear field changes by: at its point the element then shows the state of that place.
   values: [n_nodes][dim], coordinates or those of a field; n_nodes: a multiple of the corners, as pressures follow. */
static void MoveToPoint(const CellGroup *g, CellPoints set, int point, int n_nodes, int dim, PetscReal *values)
{
  const Element *own = ElementGet(g->kernel.type), *table = PointTable(g, set);

  if (table == own) return;
  for (int first = 0; first < n_nodes; first += own->nodes) {
    for (int i = 0; i < dim; i++) {
      PetscReal change = 0;

      for (int a = 0; a < own->nodes; a++)
        change += (table->N[point][a] - own->N[0][a]) * values[(first + a) * dim + i];
      for (int a = 0; a < own->nodes; a++) values[(first + a) * dim + i] += change;
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
    MoveToPoint(g, set, m, table->nodes, e->dim, at);
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

/* ElementPointNominal() at all points of a set. P may be NULL. */
static void MovedStates(Elasticity e, const CellGroup *g, const KernelCase *kernel, CellPoints set, const PetscReal *X,
                        const PetscReal *u, const PetscReal *constants, const PetscReal *m, PetscReal *H,
                        PetscReal *pressure, PetscReal *P)
{
  const int moves = Moves(g, set);
  PetscReal X_at[MAX_DOFS], u_at[MAX_DOFS];

  for (int k = 0; k < moves; k++) {
    for (int i = 0; i < g->nodes * e->dim; i++) {
      X_at[i] = X[i];
      u_at[i] = u[i];
    }
    MoveToPoint(g, set, k, g->nodes, e->dim, X_at);
    MoveToPoint(g, set, k, g->nodes, e->dim, u_at);
    ElementPointNominal(kernel, X_at, u_at, constants, m, &H[9 * k], &pressure[k], P ? &P[9 * k] : NULL);
  }
}

/*@
  ElasticityPointStates - gives displacement gradients and stresses at points of a cell.

  Not collective

  Input Parameters:
+ e    - the elasticity; its multipliers and its accepted plastic state are those of the step to u
. cell - a local cell
. set  - which points
- u    - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ H          - displacement gradient at 3 i + I, as the element evaluates the law with [points][9]
. P          - first Piola-Kirchhoff stress, with small strains the stress, at 3 i + I [points][9]
. pressure   - of a mixed element (stress), 0 of others [points]
- compliance - of the volume of a mixed element: one over the modulus (one over stress); 0 of others
@*/
PetscErrorCode ElasticityPointStates(Elasticity e, PetscInt cell, CellPoints set, const PetscReal *u, PetscReal *H,
                                     PetscReal *P, PetscReal *pressure, PetscReal *compliance)
{
  CellGroup *g = &e->groups[e->cell_group[cell]];
  PetscReal  X[MAX_DOFS], cell_u[MAX_DOFS], constants[MATERIAL_MAX_CONSTANTS], m[MIXED_PRESSURES];

  PetscFunctionBeginUser;
  ElasticityGatherCell(e, g, e->cell_slot[cell], u, X, cell_u, constants, m);
  MovedStates(e, g, &g->kernel, set, X, cell_u, constants, m, H, pressure, P);
  *compliance = 0;
  if (g->kernel.formulation == FORMULATION_MIXED) {
    VolumeModuli moduli;

    ElementVolumeModuli(&g->kernel, constants, 1, &moduli);
    *compliance = 1 / moduli.projected;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest difference of the entries of v between two nodes of a cell. */
static PetscReal LargestDifference(int nodes, int dim, const PetscReal *v)
{
  PetscReal most = 0;

  for (int a = 1; a < nodes; a++)
    for (int i = 0; i < dim; i++) most = PetscMax(most, PetscAbsReal(v[a * dim + i] - v[i]));
  return most;
}

/*@
  ElasticityPointRates - gives how displacement gradients, stresses and pressures at points of a cell change along a
  motion.

  Not collective

  Input Parameters:
+ e    - the elasticity, as for ElasticityPointStates()
. cell - a local cell
. set  - which points
. u    - local displacements (length) [n_nodes*dim]
- v    - local motion [n_nodes*dim]

  Output Parameters:
+ H        - derivative of the displacement gradient along v [points][9]
. P        - likewise of the stress [points][9]; or NULL
- pressure - derivative of the pressure of a mixed element, 0 of others [points]
@*/
PetscErrorCode ElasticityPointRates(Elasticity e, PetscInt cell, CellPoints set, const PetscReal *u, const PetscReal *v,
                                    PetscReal *H, PetscReal *P, PetscReal *pressure)
{
  CellGroup *g      = &e->groups[e->cell_group[cell]];
  const int  points = PointTable(g, set)->points, nodes = ElementGet(g->kernel.type)->nodes;
  PetscReal  X[MAX_DOFS], at[MAX_DOFS], cell_u[MAX_DOFS], cell_v[MAX_DOFS], constants[MATERIAL_MAX_CONSTANTS],
    m[MIXED_PRESSURES], most, step;

  PetscFunctionBeginUser;
  ElasticityGatherCell(e, g, e->cell_slot[cell], v, X, cell_v, constants, m);
  ElasticityGatherCell(e, g, e->cell_slot[cell], u, X, cell_u, constants, m);
  if (g->kernel.formulation == FORMULATION_FULL && !P) { /* gradients are linear in displacements */
    const KernelCase nodal = NodalCase(g);

    MovedStates(e, g, &nodal, set, X, cell_v, (PetscReal[]){1, 1}, NULL, H, pressure, NULL);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscArrayzero(H, points * 9));
  if (P) PetscCall(PetscArrayzero(P, points * 9));
  PetscCall(PetscArrayzero(pressure, points));
  most = PetscMax(LargestDifference(nodes, e->dim, cell_v),
                  LargestDifference(g->nodes - nodes, e->dim, &cell_v[nodes * e->dim]));
  if (g->kernel.geometry == GEOMETRY_AXISYMMETRIC)
    for (int a = 0; a < nodes; a++) most = PetscMax(most, PetscAbsReal(cell_v[a * e->dim]));
  if (!(most > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  step = POINT_STEP * CellLength(g->kernel.type, e->dim, X) / most;
  for (int side = -1; side <= 1; side += 2) {
    PetscReal H_at[ELEMENT_MAX_POINTS * 9], P_at[ELEMENT_MAX_POINTS * 9], pressure_at[ELEMENT_MAX_POINTS];

    for (int k = 0; k < g->nodes * e->dim; k++) at[k] = cell_u[k] + side * step * cell_v[k];
    MovedStates(e, g, &g->kernel, set, X, at, constants, m, H_at, pressure_at, P ? P_at : NULL);
    for (int k = 0; k < points * 9; k++) H[k] += side * H_at[k] / (2 * step);
    for (int k = 0; k < points * 9 && P; k++) P[k] += side * P_at[k] / (2 * step);
    for (int p = 0; p < points; p++) pressure[p] += side * pressure_at[p] / (2 * step);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
