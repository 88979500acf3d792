/* What the elements of the bodies leave of error, see bodyerror.h. */
#include "errors/bodyerror.h"
#include "kernels/elementkernel.h"

/* Stresses of enhanced elements do no work on the modes of the adjoint solution where elements do not turn within
   themselves. More of it than this part of the estimated error leaves a factor of 2 no room. */
#define BODYERROR_MODES_WORK 0.5

/* Components at a point: of the solution the stress, its pressure and ln det F; of an adjoint solution the displacement
   gradient, the pressure and, with enhanced elements, the rate of the stress */
enum { STATE_PRESSURE = 9, STATE_DILATATION, STATE_WIDTH };
enum { RATE_PRESSURE = 9, RATE_STRESS, RATE_MOST = RATE_STRESS + 9 };

struct _n_BodyError {
  Mesh             mesh;
  Elasticity       elasticity;
  Kinematics       kinematics;
  const PetscReal *u;
  Recovery         recovery;
  PetscReal       *state;      /* of the solution at the points [points][STATE_WIDTH] */
  PetscReal       *patches;    /* of its recovered fields */
  PetscReal       *compliance; /* of the volume of each cell, see ElasticityPointStates() */
  PetscReal       *modes;      /* enhanced parts of the displacement gradients [points][9]; NULL: there are none */
  int              rate_width; /* components of an adjoint solution */
};

/* An adjoint solution at the points */
typedef struct {
  PetscReal *value;   /* [points][rate_width] */
  PetscReal *patches; /* of its recovered fields */
  PetscReal *modes;   /* enhanced parts of its gradients [points][9]; NULL: there are none */
} PointRates;

/* ln det(1 + H), with small strains tr H. */
static PetscReal Dilatation(const PetscReal H[9], Kinematics kinematics)
{
  const PetscReal F[3] = {1 + H[0], 1 + H[4], 1 + H[8]};

  if (kinematics == KINEMATICS_SMALL) return H[0] + H[4] + H[8];
  return PetscLogReal(F[0] * (F[1] * F[2] - H[5] * H[7]) - H[1] * (H[3] * F[2] - H[5] * H[6]) +
                      H[2] * (H[3] * H[7] - F[1] * H[6]));
}

/* Are the points of products of a cell those of its element? */
static PetscBool SamePoints(BodyError b, PetscInt cell)
{
  const ElementType type = b->mesh->cell_type[cell];

  return (PetscBool)(ElementGet(type) == ElementGetProducts(type));
}

static int CountPoints(BodyError b, PetscInt cell, CellPoints set)
{
  const ElementType type = b->mesh->cell_type[cell];

  return set == POINTS_OF_PRODUCTS ? ElementGetProducts(type)->points : ElementGet(type)->points;
}

/* Takes what modes add to displacement gradients of a field v at the quadrature points of a cell [points][9]. */
static PetscErrorCode CellModes(BodyError b, const PetscReal *v, PetscInt cell, PetscReal *H, PetscReal *modes)
{
  const PetscInt first = RecoveryPoints(b->recovery, cell, NULL);

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointModes(b->elasticity, cell, v, H));
  PetscCall(PetscArraycpy(&modes[first * 9], H, CountPoints(b, cell, POINTS_OF_ELEMENT) * 9));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the solution at points of a cell: [points][STATE_WIDTH]. modes: of all cells, at the quadrature points;
   NULL: not wanted. */
static PetscErrorCode CellState(BodyError b, PetscInt cell, CellPoints set, PetscReal *states, PetscReal *modes)
{
  PetscReal H[ELEMENT_MAX_POINTS * 9], P[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointStates(b->elasticity, cell, set, b->u, H, P, pressure, &b->compliance[cell]));
  for (int p = 0; p < CountPoints(b, cell, set); p++) {
    PetscReal *state = &states[p * STATE_WIDTH];

    for (int r = 0; r < 9; r++) state[r] = P[9 * p + r];
    state[STATE_PRESSURE]   = pressure[p];
    state[STATE_DILATATION] = Dilatation(&H[9 * p], b->kinematics);
  }
  if (modes) PetscCall(CellModes(b, b->u, cell, H, modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates an adjoint solution at points of a cell: [points][rate_width]. modes: as above. */
static PetscErrorCode CellRate(BodyError b, const PetscReal *y, PetscInt cell, CellPoints set, PetscReal *rates,
                               PetscReal *modes)
{
  PetscReal H[ELEMENT_MAX_POINTS * 9], P[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointRates(b->elasticity, cell, set, b->u, y, H, b->modes ? P : NULL, pressure));
  for (int p = 0; p < CountPoints(b, cell, set); p++) {
    PetscReal *rate = &rates[p * b->rate_width];

    for (int r = 0; r < 9; r++) rate[r] = H[9 * p + r];
    rate[RATE_PRESSURE] = pressure[p];
    for (int r = 0; r < 9 && b->modes; r++) rate[RATE_STRESS + r] = P[9 * p + r];
  }
  if (modes) PetscCall(CellModes(b, y, cell, H, modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BodyErrorCreate - recovers the fields of a solution.

  Collective

  Input Parameters:
+ mesh       - the mesh
. elasticity - of the mesh, in the state of the solution
. kinematics - of the scene
- u          - local displacements u[n_nodes*dim] (length), ghosts included; borrowed

  Output Parameter:
. error - free it with BodyErrorDestroy()
@*/
PetscErrorCode BodyErrorCreate(Mesh mesh, Elasticity elasticity, Kinematics kinematics, const PetscReal *u,
                               BodyError *error)
{
  BodyError b;
  PetscBool enhanced;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->mesh       = mesh;
  b->elasticity = elasticity;
  b->u          = u;
  b->kinematics = kinematics;
  PetscCall(RecoveryCreate(mesh, elasticity, &b->recovery));
  PetscCall(PetscMalloc2(RecoveryPoints(b->recovery, mesh->n_cells, NULL) * STATE_WIDTH, &b->state, mesh->n_cells,
                         &b->compliance));
  PetscCall(ElasticityEnhanced(elasticity, &enhanced));
  if (enhanced) PetscCall(PetscMalloc1(RecoveryPoints(b->recovery, mesh->n_cells, NULL) * 9, &b->modes));
  b->rate_width = enhanced ? RATE_MOST : RATE_STRESS;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(
      CellState(b, c, POINTS_OF_ELEMENT, &b->state[RecoveryPoints(b->recovery, c, NULL) * STATE_WIDTH], b->modes));
  PetscCall(RecoveryFit(b->recovery, STATE_WIDTH, b->state, &b->patches));
  *error = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BodyErrorDestroy - frees the recovered fields.

  Not collective

  Input Parameter:
. error - set to NULL
@*/
PetscErrorCode BodyErrorDestroy(BodyError *error)
{
  PetscFunctionBeginUser;
  if (!*error) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RecoveryDestroy(&(*error)->recovery));
  PetscCall(PetscFree2((*error)->state, (*error)->compliance));
  PetscCall(PetscFree((*error)->modes));
  PetscCall(PetscFree((*error)->patches));
  PetscCall(PetscFree(*error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the modes of an enhanced element add at a point: P* : e + E : T*. state, rate: recovered. */
static PetscReal ModesProduct(BodyError b, const PointRates *rates, PetscInt point, const PetscReal *state,
                              const PetscReal *rate)
{
  PetscReal product = 0;

  for (int r = 0; r < 9; r++)
    product += state[r] * rates->modes[9 * point + r] + b->modes[9 * point + r] * rate[RATE_STRESS + r];
  return product;
}

/* Work of the stresses on the modes of the adjoint solution in local cells; the linear theory has none. */
static PetscReal ModesWork(BodyError b, const PointRates *rates)
{
  PetscReal sum = 0;

  for (PetscInt c = 0; c < b->mesh->n_cells && b->modes; c++) {
    const PetscReal *volume;
    const PetscInt   first = RecoveryPoints(b->recovery, c, &volume);

    for (int p = 0; p < ElementGet(b->mesh->cell_type[c])->points; p++)
      for (int r = 0; r < 9; r++)
        sum += volume[p] * b->state[(first + p) * STATE_WIDTH + r] * rates->modes[9 * (first + p) + r];
  }
  return sum;
}

/* The part of a cell. y: the adjoint solution. */
static PetscErrorCode CellError(BodyError b, PetscInt cell, const PetscReal *y, const PointRates *rates,
                                PetscReal *error)
{
  const PetscInt   first = RecoveryPoints(b->recovery, cell, NULL);
  const PetscReal *volume, *computed_state = &b->state[first * STATE_WIDTH],
                           *computed_rate = &rates->value[first * b->rate_width];
  PetscReal more_states[ELEMENT_MAX_POINTS * STATE_WIDTH], more_rates[ELEMENT_MAX_POINTS * RATE_MOST];

  PetscFunctionBeginUser;
  *error = 0;
  if (!SamePoints(b, cell)) {
    PetscCall(CellState(b, cell, POINTS_OF_PRODUCTS, more_states, NULL));
    PetscCall(CellRate(b, y, cell, POINTS_OF_PRODUCTS, more_rates, NULL));
    computed_state = more_states;
    computed_rate  = more_rates;
  }
  for (int p = 0; p < RecoveryProducts(b->recovery, cell, &volume); p++) {
    PetscReal state[STATE_WIDTH], rate[RATE_MOST], product = 0;

    RecoveryEvaluate(b->recovery, STATE_WIDTH, b->patches, cell, p, state);
    RecoveryEvaluate(b->recovery, b->rate_width, rates->patches, cell, p, rate);
    if (b->modes && SamePoints(b, cell)) product = ModesProduct(b, rates, first + p, state, rate);
    for (int k = 0; k < STATE_WIDTH; k++) state[k] -= computed_state[p * STATE_WIDTH + k];
    for (int k = 0; k < RATE_STRESS; k++) rate[k] -= computed_rate[p * b->rate_width + k];
    for (int r = 0; r < 9; r++) product += state[r] * rate[r];
    if (b->compliance[cell] > 0)
      product += rate[RATE_PRESSURE] * (state[STATE_DILATATION] - b->compliance[cell] * state[STATE_PRESSURE]);
    *error -= volume[p] * product;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BodyErrorEvaluate - estimates the error of a quantity.

  Collective

  Input Parameters:
+ b - the recovered fields
- y - adjoint solution of the quantity, y[n_nodes*dim], ghosts included

  Output Parameters:
+ cells - share of each local cell
- sums  - of all cells, the same on all ranks
@*/
PetscErrorCode BodyErrorEvaluate(BodyError b, const PetscReal *y, PetscReal *cells, BodyErrorSums *sums)
{
  const PetscInt points = RecoveryPoints(b->recovery, b->mesh->n_cells, NULL);
  PointRates     rates  = {.modes = NULL};
  PetscReal      sum[3] = {0, 0, 0}; /* the error, its spread, the work on the modes */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points * b->rate_width, &rates.value));
  if (b->modes) PetscCall(PetscMalloc1(points * 9, &rates.modes));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++)
    PetscCall(CellRate(b, y, c, POINTS_OF_ELEMENT, &rates.value[RecoveryPoints(b->recovery, c, NULL) * b->rate_width],
                       rates.modes));
  PetscCall(RecoveryFit(b->recovery, b->rate_width, rates.value, &rates.patches));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
    PetscCall(CellError(b, c, y, &rates, &cells[c]));
    sum[0] += cells[c];
    sum[1] += PetscAbsReal(cells[c]);
  }
  sum[2] = ModesWork(b, &rates);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, b->mesh->comm));
  sums->error  = sum[0];
  sums->spread = sum[1];
  sums->holds  = (PetscBool)(PetscAbsReal(sum[2]) <= BODYERROR_MODES_WORK * PetscAbsReal(sum[0]));
  PetscCall(PetscFree(rates.patches));
  PetscCall(PetscFree(rates.modes));
  PetscCall(PetscFree(rates.value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
