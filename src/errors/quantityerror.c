/* The error of quantities of a solution, see quantityerror.h. */
#include "errors/quantityerror.h"
#include "errors/bodyerror.h"
#include <math.h>

/* Recovered fields are known to a factor of two: what they give of error may be off by this part of it. */
#define QUANTITYERROR_DOUBT 0.5

const char *const ErrorCauses[] = {
  [ERROR_BODIES] = "bodies",           [ERROR_GEOMETRY] = "contact surfaces", [ERROR_FACES] = "contact within faces",
  [ERROR_PENETRATION] = "penetration", [ERROR_SLIP] = "elastic slip",         [ERROR_STEPS] = "load steps",
  [ERROR_SOLVER] = "solver"};

/*@
  ModelDependsOnPath - says whether the answer depends on the way to it.

  Not collective

  Input Parameter:
. model - the model
@*/
PetscBool ModelDependsOnPath(Model model)
{
  return (PetscBool)(ProblemIsPlastic(model->problem) || ContactHasFriction(model->contact) ||
                     SceneSupportsChange(model->scene));
}

/* Adds up the known parts. */
static void Total(QuantityError *error)
{
  const ErrorCause of_gaps[] = {ERROR_GEOMETRY, ERROR_FACES};
  PetscReal        gaps      = 0;

  error->sum = error->magnitude = 0;
  for (int k = 0; k < 2; k++)
    if (!isnan((double)error->part[of_gaps[k]])) gaps += error->part[of_gaps[k]];
  error->uncertain = QUANTITYERROR_DOUBT * (error->spread + PetscAbsReal(gaps)) + error->end;
  for (int c = 0; c < ERROR_CAUSES; c++) {
    if (isnan((double)error->part[c])) continue;
    error->sum += error->part[c];
    error->magnitude += PetscAbsReal(error->part[c]);
  }
}

/*@
  QuantityErrorSetSteps - gives an estimate what the load steps leave of error.

  Not collective

  Input Parameters:
+ error - the estimate
- steps - true less computed value
@*/
void QuantityErrorSetSteps(QuantityError *error, PetscReal steps)
{
  error->part[ERROR_STEPS] = steps;
  Total(error);
}

/*@
  QuantityErrorCancels - says whether the parts of an estimate cancel, so that the sign of the sum is not known.

  Not collective

  Input Parameter:
. error - the estimate

  Note:
  The error may then be as large as error->uncertain.
@*/
PetscBool QuantityErrorCancels(const QuantityError *error)
{
  return (PetscBool)(error->uncertain > PetscAbsReal(error->sum));
}

/* Sums up the magnitudes of the cells' shares, each times what it is off by. */
static PetscErrorCode SumOff(Mesh mesh, const PetscReal *cells, const PetscReal off[], PetscReal *sum)
{
  PetscFunctionBeginUser;
  *sum = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) *sum += off[c] * PetscAbsReal(cells[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPIU_REAL, MPIU_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joins the parts of one quantity. shape: that of the masters; faces: that of contact within faces; off: as of
   QuantityErrorsEstimate(). */
static PetscErrorCode Join(Model model, BodyError bodies, const Adjoint *adjoint, PetscReal shape, PetscReal faces,
                           const PetscReal off[], QuantityError *error)
{
  BodyErrorSums sums;

  PetscFunctionBeginUser;
  error->why = adjoint->known ? NULL : "the transposed tangent cannot be solved with";
  error->sum = error->magnitude = error->uncertain = 0;
  error->spread = error->end = 0;
  error->shared              = PETSC_FALSE;
  error->cells               = NULL;
  for (int c = 0; c < ERROR_CAUSES; c++) error->part[c] = NAN;
  if (error->why) PetscFunctionReturn(PETSC_SUCCESS);
  error->shared = PETSC_TRUE;
  PetscCall(PetscMalloc1(model->mesh->n_cells, &error->cells));
  PetscCall(BodyErrorEvaluate(bodies, adjoint->y, error->cells, &sums));
  PetscCall(SumOff(model->mesh, error->cells, off, &error->end));
  error->part[ERROR_BODIES] = sums.error;
  error->spread             = sums.spread;
  if (!sums.holds) error->why = "enhanced elements (bodies.*.formulation) turn too much within themselves";
  error->part[ERROR_GEOMETRY]    = shape;
  error->part[ERROR_FACES]       = faces;
  error->part[ERROR_PENETRATION] = adjoint->penetration;
  error->part[ERROR_SLIP]        = adjoint->slip;
  error->part[ERROR_STEPS]       = ModelDependsOnPath(model) ? NAN : 0;
  error->part[ERROR_SOLVER]      = adjoint->residual;
  Total(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  QuantityErrorsEstimate - estimates the errors of quantities at the solution of a step.

  Collective

  Input Parameters:
+ model      - after ModelSolve() has found a solution, before ModelAccept()
. n          - number of quantities
. functional - their first variations
- off        - of each local cell: by how much of itself its share may be off, as a zone of contact ends elsewhere

  Output Parameter:
. error - of each; free them with QuantityErrorReset()

  Note:
  The state stays as it is. One tangent serves all quantities, see ModelAdjoint().
@*/
PetscErrorCode QuantityErrorsEstimate(Model model, int n, const Functional functional[], const PetscReal off[],
                                      QuantityError error[])
{
  const PetscInt dofs = model->mesh->n_nodes * model->mesh->dim;
  BodyError      bodies;
  Adjoint       *adjoint;
  PetscReal     *shape, *faces;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n, &adjoint, n, &shape, n, &faces));
  for (int i = 0; i < n; i++) PetscCall(PetscCalloc1(dofs, &adjoint[i].y));
  PetscCall(ModelAdjoint(model, n, functional, adjoint));
  PetscCall(ModelShapeErrors(model, n, functional, adjoint, shape));
  PetscCall(ModelWithinFaces(model, n, functional, adjoint, faces));
  PetscCall(
    BodyErrorCreate(model->mesh, model->problem->elasticity, model->scene->kinematics, model->problem->trial, &bodies));
  for (int i = 0; i < n; i++) PetscCall(Join(model, bodies, &adjoint[i], shape[i], faces[i], off, &error[i]));
  PetscCall(BodyErrorDestroy(&bodies));
  for (int i = 0; i < n; i++) PetscCall(PetscFree(adjoint[i].y));
  PetscCall(PetscFree3(adjoint, shape, faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest error that penetration leaves in forces and displacements of a pair, over either. */
static PetscReal WorstPenetration(Model model)
{
  PetscReal worst = 0;

  for (int p = 0; p < ContactPairs(model->contact); p++) {
    const PenaltyError error = ModelPenaltyError(model, p);
    const PetscReal    most  = PetscMax(error.force, error.displacement);

    if (most > worst) worst = most;
  }
  return worst;
}

/*@
  QuantityErrorShares - finds where elements leave error, for a quantity that has no first variation.

  Collective

  Input Parameter:
. model - after ModelSolve() has found a solution, before ModelAccept()

  Output Parameter:
. error - its cells and spread are those of the strain energy, what penetration leaves is that of the worst pair, over
the quantity and without a sign; all other parts are unknown. Free it with QuantityErrorReset()

  Note:
  QuantityErrorScale() gives it the quantity's value, which may be known only once the solution is accepted.
@*/
PetscErrorCode QuantityErrorShares(Model model, QuantityError *error)
{
  BodyError     bodies;
  BodyErrorSums sums;

  PetscFunctionBeginUser;
  for (int c = 0; c < ERROR_CAUSES; c++) error->part[c] = NAN;
  error->shared = PETSC_TRUE;
  PetscCall(PetscMalloc1(model->mesh->n_cells, &error->cells));
  PetscCall(
    BodyErrorCreate(model->mesh, model->problem->elasticity, model->scene->kinematics, model->problem->trial, &bodies));
  PetscCall(BodyErrorEvaluate(bodies, model->problem->trial, error->cells, &sums));
  PetscCall(BodyErrorDestroy(&bodies));
  error->spread                  = sums.spread;
  error->part[ERROR_PENETRATION] = error->magnitude = WorstPenetration(model);
  error->sum                                        = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  QuantityErrorScale - gives the parts of QuantityErrorShares() the unit of the quantity.

  Not collective

  Input Parameter:
. value - of the quantity

  Input/Output Parameter:
. error - of QuantityErrorShares()
@*/
void QuantityErrorScale(PetscReal value, QuantityError *error)
{
  error->part[ERROR_PENETRATION] *= PetscAbsReal(value);
  error->magnitude *= PetscAbsReal(value);
}

/*@
  QuantityErrorReset - frees what an estimate holds.

  Not collective

  Input Parameter:
. error - its values stay
@*/
PetscErrorCode QuantityErrorReset(QuantityError *error)
{
  PetscFunctionBeginUser;
  error->shared = PETSC_FALSE;
  PetscCall(PetscFree(error->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
