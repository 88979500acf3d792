/* What the elements of the bodies leave of error, see bodyerror.h. */
#include "errors/bodyerror.h"
#include "kernels/elementkernel.h"

/* Components at a point: of the solution the stress, its pressure and ln det F; of an adjoint solution the displacement
   gradient and the pressure */
enum { STATE_PRESSURE = 9, STATE_DILATATION, STATE_WIDTH, RATE_PRESSURE = 9, RATE_WIDTH };

struct _n_BodyError {
  Mesh             mesh;
  Elasticity       elasticity;
  const PetscReal *u;
  Recovery         recovery;
  PetscReal       *state;      /* of the solution at the points [points][STATE_WIDTH] */
  PetscReal       *patches;    /* of its recovered fields */
  PetscReal       *compliance; /* of the volume of each cell, see ElasticityPointStates() */
};

/* ln det(1 + H), with small strains tr H. */
static PetscReal Dilatation(const PetscReal H[9], Kinematics kinematics)
{
  const PetscReal F[3] = {1 + H[0], 1 + H[4], 1 + H[8]};

  if (kinematics == KINEMATICS_SMALL) return H[0] + H[4] + H[8];
  return PetscLogReal(F[0] * (F[1] * F[2] - H[5] * H[7]) - H[1] * (H[3] * F[2] - H[5] * H[6]) +
                      H[2] * (H[3] * H[7] - F[1] * H[6]));
}

/* Evaluates the solution at the points of a cell. */
static PetscErrorCode CellState(BodyError b, Kinematics kinematics, PetscInt cell)
{
  const PetscInt first  = RecoveryPoints(b->recovery, cell, NULL);
  const int      points = ElementGet(b->mesh->cell_type[cell])->points;
  PetscReal      H[ELEMENT_MAX_POINTS * 9], P[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointStates(b->elasticity, cell, b->u, H, P, pressure, &b->compliance[cell]));
  for (int p = 0; p < points; p++) {
    PetscReal *state = &b->state[(first + p) * STATE_WIDTH];

    for (int r = 0; r < 9; r++) state[r] = P[9 * p + r];
    state[STATE_PRESSURE]   = pressure[p];
    state[STATE_DILATATION] = Dilatation(&H[9 * p], kinematics);
  }
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

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->mesh       = mesh;
  b->elasticity = elasticity;
  b->u          = u;
  PetscCall(RecoveryCreate(mesh, elasticity, &b->recovery));
  PetscCall(PetscMalloc2(RecoveryPoints(b->recovery, mesh->n_cells, NULL) * STATE_WIDTH, &b->state, mesh->n_cells,
                         &b->compliance));
  for (PetscInt c = 0; c < mesh->n_cells; c++) PetscCall(CellState(b, kinematics, c));
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
  PetscCall(PetscFree((*error)->patches));
  PetscCall(PetscFree(*error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates an adjoint solution at the points of a cell. */
static PetscErrorCode CellRate(BodyError b, const PetscReal *y, PetscInt cell, PetscReal *rate)
{
  const int points = ElementGet(b->mesh->cell_type[cell])->points;
  PetscReal H[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(ElasticityPointRates(b->elasticity, cell, b->u, y, H, pressure));
  for (int p = 0; p < points; p++) {
    for (int r = 0; r < 9; r++) rate[p * RATE_WIDTH + r] = H[9 * p + r];
    rate[p * RATE_WIDTH + RATE_PRESSURE] = pressure[p];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of a cell. */
static PetscReal CellError(BodyError b, PetscInt cell, const PetscReal *rates, const PetscReal *rate_patches)
{
  const PetscReal *volume, compliance = b->compliance[cell];
  const PetscInt   first = RecoveryPoints(b->recovery, cell, &volume);
  PetscReal        sum   = 0;

  for (int p = 0; p < ElementGet(b->mesh->cell_type[cell])->points; p++) {
    PetscReal state[STATE_WIDTH], rate[RATE_WIDTH], product = 0;

    RecoveryEvaluate(b->recovery, STATE_WIDTH, b->patches, cell, p, state);
    RecoveryEvaluate(b->recovery, RATE_WIDTH, rate_patches, cell, p, rate);
    for (int k = 0; k < STATE_WIDTH; k++) state[k] -= b->state[(first + p) * STATE_WIDTH + k];
    for (int k = 0; k < RATE_WIDTH; k++) rate[k] -= rates[(first + p) * RATE_WIDTH + k];
    for (int r = 0; r < 9; r++) product += state[r] * rate[r];
    if (compliance > 0)
      product += rate[RATE_PRESSURE] * (state[STATE_DILATATION] - compliance * state[STATE_PRESSURE]);
    sum -= volume[p] * product;
  }
  return sum;
}

/*@
  BodyErrorEvaluate - estimates the error of a quantity.

  Collective

  Input Parameters:
+ b - the recovered fields
- y - adjoint solution of the quantity, y[n_nodes*dim], ghosts included

  Output Parameters:
+ cells - share of each local cell
- error - true less computed value, the same on all ranks
@*/
PetscErrorCode BodyErrorEvaluate(BodyError b, const PetscReal *y, PetscReal *cells, PetscReal *error)
{
  PetscReal *rates, *patches;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(RecoveryPoints(b->recovery, b->mesh->n_cells, NULL) * RATE_WIDTH, &rates));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++)
    PetscCall(CellRate(b, y, c, &rates[RecoveryPoints(b->recovery, c, NULL) * RATE_WIDTH]));
  PetscCall(RecoveryFit(b->recovery, RATE_WIDTH, rates, &patches));
  *error = 0;
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
    cells[c] = CellError(b, c, rates, patches);
    *error += cells[c];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, 1, MPIU_REAL, MPIU_SUM, b->mesh->comm));
  PetscCall(PetscFree(patches));
  PetscCall(PetscFree(rates));
  PetscFunctionReturn(PETSC_SUCCESS);
}
