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

/* Takes what modes add to displacement gradients of a field v at the quadrature points of a cell [points][9]. */
static PetscErrorCode CellModes(BodyError b, const PetscReal *v, PetscInt cell, PetscReal *H, PetscReal *modes)
{
  const PetscInt first = RecoveryPoints(b->recovery, cell, NULL);

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointModes(b->elasticity, cell, v, H));
  PetscCall(PetscArraycpy(&modes[first * 9], H, CountPoints(b, cell, POINTS_OF_ELEMENT) * 9));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the solution at points of a cell: [points][state_width]. modes: of all cells, at the quadrature points;
   NULL: not wanted. */
static PetscErrorCode CellState(BodyError b, PetscInt cell, CellPoints set, PetscReal *states, PetscReal *modes)
{
  PetscReal H[ELEMENT_MAX_POINTS * 9], P[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointStates(b->elasticity, cell, set, b->u, H, P, pressure, &b->compliance[cell]));
  for (int p = 0; p < CountPoints(b, cell, set); p++) {
    PetscReal *state = &states[p * b->state_width];

    for (int k = 0; k < b->entries; k++) *state++ = P[9 * p + b->entry[k]];
    if (!b->mixed) continue;
    *state++ = pressure[p];
    *state   = Dilatation(&H[9 * p], b->kinematics);
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

    for (int k = 0; k < b->entries; k++) *rate++ = H[9 * p + b->entry[k]];
    if (b->mixed) *rate++ = pressure[p];
    for (int k = 0; k < b->entries && b->modes; k++) *rate++ = P[9 * p + b->entry[k]];
  }
  if (modes) PetscCall(CellModes(b, y, cell, H, modes));
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

/* What recovered fields of the solution differ by from the computed ones at the points of products. */
static PetscErrorCode FindDefects(BodyError b)
{
  const Mesh mesh = b->mesh;
  PetscReal *patches, more[ELEMENT_MAX_POINTS * MOST_WIDTH];
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(RecoveryFit(b->recovery, b->state_width, b->state, &patches));
  PetscCall(PetscMalloc1(RecoveryProducts(b->recovery, mesh->n_cells, NULL) * b->state_width, &b->defect));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscReal *computed = &b->state[RecoveryPoints(b->recovery, c, NULL) * b->state_width];

    if (!SamePoints(b, c)) {
      PetscCall(CellState(b, c, POINTS_OF_PRODUCTS, more, NULL));
      computed = more;
    }
    for (int p = 0; p < CountPoints(b, c, POINTS_OF_PRODUCTS); p++) {
      RecoveryEvaluate(b->recovery, b->state_width, patches, c, p, &b->defect[n]);
      for (int k = 0; k < b->state_width; k++) b->defect[n++] -= computed[p * b->state_width + k];
    }
  }
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
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(
      CellState(b, c, POINTS_OF_ELEMENT, &b->state[RecoveryPoints(b->recovery, c, NULL) * b->state_width], b->modes));
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

/* The part of a cell. y: the adjoint solution. */
static PetscErrorCode CellError(BodyError b, PetscInt cell, const PetscReal *y, const PointRates *rates,
                                PetscReal *error)
{
  const PetscInt   first = RecoveryPoints(b->recovery, cell, NULL);
  const PetscReal *volume, *computed = &rates->value[first * b->rate_width];
  const PetscReal *defect = &b->defect[RecoveryProducts(b->recovery, cell, &volume) * b->state_width];
  const PetscBool  same   = SamePoints(b, cell);
  PetscReal        more[ELEMENT_MAX_POINTS * MOST_WIDTH];

  PetscFunctionBeginUser;
  *error = 0;
  if (!same) {
    PetscCall(CellRate(b, y, cell, POINTS_OF_PRODUCTS, more, NULL));
    computed = more;
  }
  for (int p = 0; p < CountPoints(b, cell, POINTS_OF_PRODUCTS); p++, defect += b->state_width) {
    PetscReal rate[MOST_WIDTH], product = 0;

    RecoveryEvaluate(b->recovery, b->rate_width, rates->patches, cell, p, rate);
    if (b->modes && same) product = ModesProduct(b, rates, first + p, defect, rate);
    for (int k = 0; k < b->entries; k++) product += defect[k] * (rate[k] - computed[p * b->rate_width + k]);
    if (b->compliance[cell] > 0)
      product += (rate[b->entries] - computed[p * b->rate_width + b->entries]) *
                 (defect[b->entries + 1] - b->compliance[cell] * defect[b->entries]);
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
