/* What the elements of the bodies leave of error, see bodyerror.h. */
#include "errors/bodyerror.h"
#include "kernels/elementkernel.h"

/* Stresses of enhanced elements do no work on the modes of the adjoint solution where elements do not turn within
   themselves. More of it than this part of the estimated error leaves a factor of 2 no room. */
#define BODYERROR_MODES_WORK 0.5

/* Components at a point that are recovered. Of the solution: those entries of the stress whose displacement gradients
   can be other than 0, and with mixed elements the pressure and ln det F. Of an adjoint solution: the same entries of
   the displacement gradient, with mixed elements the pressure, and with enhanced elements the entries of the rate of
   the stress */
enum { MOST_ENTRIES = 9, MOST_WIDTH = 2 * MOST_ENTRIES + 1 };

struct _n_BodyError {
  Mesh             mesh;
  Elasticity       elasticity;
  Kinematics       kinematics;
  const PetscReal *u;
  Recovery         recovery;
  int              entries, entry[MOST_ENTRIES]; /* at 3 i + I */
  PetscBool        mixed;
  int              state_width, rate_width;
  PetscReal       *state;      /* of the solution at the points [points][state_width] */
  PetscReal       *defect;     /* recovered less computed at the points of products [points][state_width] */
  PetscReal       *compliance; /* of the volume of each cell, see ElasticityPointStates() */
  PetscReal       *modes;      /* enhanced parts of the displacement gradients [points][9]; NULL: there are none */
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

/* Takes what modes add to displacement gradients of a field v at the quadrature points of a batch of cells. states: of
   the field; modes: of all cells [points][9]. */
static PetscErrorCode BatchModes(BodyError b, PetscInt batch, const PetscReal *v, PointStates *states, PetscReal *modes)
{
  const PetscInt *cell;
  int             n;

  PetscFunctionBeginUser;
  ElasticityBatch(b->elasticity, batch, &n, &cell);
  PetscCall(ElasticityPointModes(b->elasticity, batch, v, states));
  for (int i = 0; i < n; i++)
    PetscCall(PetscArraycpy(&modes[RecoveryPoints(b->recovery, cell[i], NULL) * 9], states[i].H,
                            CountPoints(b, cell[i], POINTS_OF_ELEMENT) * 9));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the solution at points of a batch of cells. state: where each cell's go [points][state_width]; modes: what
   modes add to displacement gradients at the points of all cells, or NULL. */
static PetscErrorCode BatchState(BodyError b, PetscInt batch, CellPoints set, PetscReal *const state[],
                                 PetscReal *modes)
{
  PointStates     states[ELASTICITY_BATCH];
  const PetscInt *cell;
  int             n;

  PetscFunctionBeginUser;
  ElasticityBatch(b->elasticity, batch, &n, &cell);
  PetscCall(ElasticityPointStates(b->elasticity, batch, set, b->u, states));
  for (int i = 0; i < n; i++) {
    PetscReal *to = state[i];

    b->compliance[cell[i]] = states[i].compliance;
    for (int p = 0; p < CountPoints(b, cell[i], set); p++) {
      for (int k = 0; k < b->entries; k++) *to++ = states[i].P[9 * p + b->entry[k]];
      if (!b->mixed) continue;
      *to++ = states[i].pressure[p];
      *to++ = Dilatation(&states[i].H[9 * p], b->kinematics);
    }
  }
  if (modes) PetscCall(BatchModes(b, batch, b->u, states, modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates an adjoint solution at points of a batch of cells. rate: where each cell's go [points][rate_width]; modes:
   as above. */
static PetscErrorCode BatchRate(BodyError b, const PetscReal *y, PetscInt batch, CellPoints set,
                                PetscReal *const rate[], PetscReal *modes)
{
  PointStates     rates[ELASTICITY_BATCH];
  const PetscInt *cell;
  int             n;

  PetscFunctionBeginUser;
  ElasticityBatch(b->elasticity, batch, &n, &cell);
  PetscCall(ElasticityPointRates(b->elasticity, batch, set, b->u, y, (PetscBool)(b->modes != NULL), rates));
  for (int i = 0; i < n; i++) {
    PetscReal *to = rate[i];

    for (int p = 0; p < CountPoints(b, cell[i], set); p++) {
      for (int k = 0; k < b->entries; k++) *to++ = rates[i].H[9 * p + b->entry[k]];
      if (b->mixed) *to++ = rates[i].pressure[p];
      for (int k = 0; k < b->entries && b->modes; k++) *to++ = rates[i].P[9 * p + b->entry[k]];
    }
  }
  if (modes) PetscCall(BatchModes(b, batch, y, rates, modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the entries of displacement gradients that can be other than 0. In the plane that out of it is one of them: of
   bodies of revolution, and of elements whose mean dilatation takes the place of that at a point. */
static void ListEntries(BodyError b)
{
  for (int i = 0; i < b->mesh->dim; i++)
    for (int j = 0; j < b->mesh->dim; j++) b->entry[b->entries++] = 3 * i + j;
  if (b->mesh->dim == 2) b->entry[b->entries++] = 8;
}

/* Finds where the values at the quadrature points of n cells are among those of all cells, width at a point. */
static void FindPoints(BodyError b, int n, const PetscInt *cell, PetscReal *of, PetscInt width, PetscReal *at[])
{
  for (int i = 0; i < n; i++) at[i] = &of[RecoveryPoints(b->recovery, cell[i], NULL) * width];
}

/* Evaluates the solution at the points of all cells. */
static PetscErrorCode FindStates(BodyError b)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < ElasticityBatches(b->elasticity); k++) {
    PetscReal      *state[ELASTICITY_BATCH];
    const PetscInt *cell;
    int             n;

    ElasticityBatch(b->elasticity, k, &n, &cell);
    FindPoints(b, n, cell, b->state, b->state_width, state);
    PetscCall(BatchState(b, k, POINTS_OF_ELEMENT, state, b->modes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates an adjoint solution at the points of all cells. */
static PetscErrorCode FindRates(BodyError b, const PetscReal *y, PointRates *rates)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < ElasticityBatches(b->elasticity); k++) {
    PetscReal      *rate[ELASTICITY_BATCH];
    const PetscInt *cell;
    int             n;

    ElasticityBatch(b->elasticity, k, &n, &cell);
    FindPoints(b, n, cell, rates->value, b->rate_width, rate);
    PetscCall(BatchRate(b, y, k, POINTS_OF_ELEMENT, rate, rates->modes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the computed values at the points of products of n cells are: among those of all cells, where these points are
   those of the elements, else in room for new ones. Returns whether they are there. */
static PetscBool FindComputed(BodyError b, int n, const PetscInt *cell, PetscReal *of, PetscInt width,
                              PetscReal room[][ELEMENT_MAX_POINTS * MOST_WIDTH], PetscReal *computed[])
{
  const PetscBool same = SamePoints(b, cell[0]);

  if (same) FindPoints(b, n, cell, of, width, computed);
  for (int i = 0; i < n && !same; i++) computed[i] = room[i];
  return same;
}

/* What recovered fields of the solution differ by from the computed ones at the points of products of a batch. */
static PetscErrorCode BatchDefects(BodyError b, PetscInt batch, const PetscReal *patches)
{
  PetscReal       more[ELASTICITY_BATCH][ELEMENT_MAX_POINTS * MOST_WIDTH], *computed[ELASTICITY_BATCH];
  const PetscInt *cell;
  int             n;
  PetscBool       same;

  PetscFunctionBeginUser;
  ElasticityBatch(b->elasticity, batch, &n, &cell);
  same = FindComputed(b, n, cell, b->state, b->state_width, more, computed);
  if (!same) PetscCall(BatchState(b, batch, POINTS_OF_PRODUCTS, computed, NULL));
  for (int i = 0; i < n; i++) {
    PetscReal *defect = &b->defect[RecoveryProducts(b->recovery, cell[i], NULL) * b->state_width];

    for (int p = 0; p < CountPoints(b, cell[i], POINTS_OF_PRODUCTS); p++, defect += b->state_width) {
      RecoveryEvaluate(b->recovery, b->state_width, patches, cell[i], p, defect);
      for (int k = 0; k < b->state_width; k++) defect[k] -= computed[i][p * b->state_width + k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Likewise of all cells. */
static PetscErrorCode FindDefects(BodyError b)
{
  PetscReal *patches;

  PetscFunctionBeginUser;
  PetscCall(RecoveryFit(b->recovery, b->state_width, b->state, &patches));
  PetscCall(PetscMalloc1(RecoveryProducts(b->recovery, b->mesh->n_cells, NULL) * b->state_width, &b->defect));
  for (PetscInt k = 0; k < ElasticityBatches(b->elasticity); k++) PetscCall(BatchDefects(b, k, patches));
  PetscCall(PetscFree(patches));
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
  PetscInt  points;
  PetscBool enhanced;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->mesh       = mesh;
  b->elasticity = elasticity;
  b->u          = u;
  b->kinematics = kinematics;
  ListEntries(b);
  PetscCall(ElasticityHas(elasticity, FORMULATION_MIXED, &b->mixed));
  PetscCall(ElasticityHas(elasticity, FORMULATION_ENHANCED, &enhanced));
  b->state_width = b->entries + (b->mixed ? 2 : 0);
  b->rate_width  = b->entries + (b->mixed ? 1 : 0) + (enhanced ? b->entries : 0);
  PetscCall(RecoveryCreate(mesh, elasticity, &b->recovery));
  points = RecoveryPoints(b->recovery, mesh->n_cells, NULL);
  PetscCall(PetscMalloc2(points * b->state_width, &b->state, mesh->n_cells, &b->compliance));
  if (enhanced) PetscCall(PetscMalloc1(points * 9, &b->modes));
  PetscCall(FindStates(b));
  PetscCall(FindDefects(b));
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
  PetscCall(PetscFree((*error)->defect));
  PetscCall(PetscFree(*error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the modes of an enhanced element add at a point: P* : e + E : T*. defect, rate: at the point, the latter
   recovered. */
static PetscReal ModesProduct(BodyError b, const PointRates *rates, PetscInt point, const PetscReal *defect,
                              const PetscReal *rate)
{
  const PetscReal *state = &b->state[point * b->state_width], *stress_rate = &rate[b->rate_width - b->entries];
  PetscReal        product = 0;

  for (int k = 0; k < b->entries; k++)
    product += (state[k] + defect[k]) * rates->modes[9 * point + b->entry[k]] +
               b->modes[9 * point + b->entry[k]] * stress_rate[k];
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
      for (int k = 0; k < b->entries; k++)
        sum += volume[p] * b->state[(first + p) * b->state_width + k] * rates->modes[9 * (first + p) + b->entry[k]];
  }
  return sum;
}

/* The part of a cell. computed: the adjoint solution at its points of products. */
static PetscReal CellError(BodyError b, PetscInt cell, const PetscReal *computed, const PointRates *rates)
{
  const PetscInt   first = RecoveryPoints(b->recovery, cell, NULL);
  const PetscReal *volume, *defect = &b->defect[RecoveryProducts(b->recovery, cell, &volume) * b->state_width];
  const PetscBool  same  = SamePoints(b, cell);
  PetscReal        error = 0;

  for (int p = 0; p < CountPoints(b, cell, POINTS_OF_PRODUCTS); p++, defect += b->state_width) {
    PetscReal rate[MOST_WIDTH], product = 0;

    RecoveryEvaluate(b->recovery, b->rate_width, rates->patches, cell, p, rate);
    if (b->modes && same) product = ModesProduct(b, rates, first + p, defect, rate);
    for (int k = 0; k < b->entries; k++) product += defect[k] * (rate[k] - computed[p * b->rate_width + k]);
    if (b->compliance[cell] > 0)
      product += (rate[b->entries] - computed[p * b->rate_width + b->entries]) *
                 (defect[b->entries + 1] - b->compliance[cell] * defect[b->entries]);
    error -= volume[p] * product;
  }
  return error;
}

/* The parts of the cells of a batch. y: the adjoint solution; cells: of all. */
static PetscErrorCode BatchErrors(BodyError b, PetscInt batch, const PetscReal *y, const PointRates *rates,
                                  PetscReal *cells)
{
  PetscReal       more[ELASTICITY_BATCH][ELEMENT_MAX_POINTS * MOST_WIDTH], *computed[ELASTICITY_BATCH];
  const PetscInt *cell;
  int             n;
  PetscBool       same;

  PetscFunctionBeginUser;
  ElasticityBatch(b->elasticity, batch, &n, &cell);
  same = FindComputed(b, n, cell, rates->value, b->rate_width, more, computed);
  if (!same) PetscCall(BatchRate(b, y, batch, POINTS_OF_PRODUCTS, computed, NULL));
  for (int i = 0; i < n; i++) cells[cell[i]] = CellError(b, cell[i], computed[i], rates);
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
  PetscCall(FindRates(b, y, &rates));
  PetscCall(RecoveryFit(b->recovery, b->rate_width, rates.value, &rates.patches));
  for (PetscInt k = 0; k < ElasticityBatches(b->elasticity); k++) PetscCall(BatchErrors(b, k, y, &rates, cells));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
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
