/* The stability of an equilibrium: the negative eigenvalues of its tangent. */
#include "linear/negativemode.h"
#include "mesh/meshdofs.h"
#include "modelimpl.h"

/* Turn of cells (radians) by which an unstable motion is judged. Real parts are off by as much, and a motion that gives
   next to nothing over it changes no answer. */
#define STABILITY_TURN 0.1

/* A number in [-1, 1] that looks random, from the place of a node. */
static PetscReal Scatter(const PetscReal X[3], PetscReal size, int d)
{
  const PetscReal turns = 43758.5453 * PetscSinReal((12.9898 * X[0] + 78.233 * X[1] + 37.719 * X[2]) / size + d + 1);

  return 2 * (turns - PetscFloorReal(turns)) - 1;
}

/* Fills a vector of free displacements with numbers that depend on the places of the nodes alone. */
static PetscErrorCode FillScattered(Mesh mesh, Vec start)
{
  PetscReal *values, X[3], size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &values));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    MeshNodePlace(mesh, n, X);
    for (int d = 0; d < 3; d++) size = PetscMax(size, PetscAbsReal(X[d]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPIU_REAL, MPI_MAX, mesh->comm));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    MeshNodePlace(mesh, n, X);
    for (int d = 0; d < mesh->dim; d++) values[n * mesh->dim + d] = Scatter(X, size, d);
  }
  PetscCall(MeshCollectFree(mesh, values, start));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors the tangent at the solution anew: the last factor was that of a shifted one. */
static PetscErrorCode FactorAnew(Model model)
{
  KSP ksp;
  Vec b, y;

  PetscFunctionBeginUser;
  if (LinearSolverIterates(model->work->solver)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(model->x, &b));
  PetscCall(VecDuplicate(model->x, &y));
  PetscCall(FillScattered(model->mesh, b));
  PetscCall(ModelLinearise(model, &ksp));
  PetscCall(KSPSolve(ksp, b, y));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energy that the bodies give away as they turn by STABILITY_TURN along a motion of negative stiffness
   (force/length), over what they store. */
static PetscErrorCode ModeGives(Model model, Vec mode, PetscReal stiffness, PetscReal *share)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *moved, turn, stored, length;
  PetscBool      ok;
  Vec            end;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &moved));
  PetscCall(VecDuplicate(mode, &end));
  PetscCall(VecWAXPY(end, 1, mode, model->x));
  PetscCall(ProblemDisplacements(model->problem, end, model->t, moved));
  PetscCall(ModelLargestTurn(model, model->u, moved, &turn));
  PetscCall(
    ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_ELASTIC | ENERGY_CONTACT, &stored, &ok));
  length = turn > 0 ? STABILITY_TURN / turn : 0;
  *share = !ok ? INFINITY : stored > 0 ? -stiffness * PetscSqr(length) / 2 / stored : 0;
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree(moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the softest unstable motion, by which a tangent that is not symmetric is known to be unstable. */
static PetscErrorCode FindMode(Model model, Factor factor, SolveReport *report)
{
  PetscReal stiffness;
  Vec       mode;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &mode));
  PetscCall(FillScattered(model->mesh, mode));
  PetscCall(NegativeModeFind(factor, mode, &stiffness));
  if (stiffness < 0) {
    report->negatives = PetscMax(1, report->negatives);
    PetscCall(ModeGives(model, mode, stiffness, &report->gives));
  }
  PetscCall(VecDestroy(&mode));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelFindStability - finds out whether the equilibrium that a solve has found is stable.

  Collective

  Input Parameter:
. model - after a solve that converged

  Input/Output Parameter:
. report - of that solve: its `negatives` and `gives` are filled

  Note:
  The last tangent tells, or a new one where that was shifted. It is not known where the solver is iterative, where
  nodes have pressures, where soft motions were held, and where the last solves were made with an older factor. With
  friction the number is 1 where there is a negative eigenvalue.

  Source: S. Krenk, Non-linear modeling and analysis of solids and structures, Cambridge 2009, section 8.1.
@*/
PetscErrorCode ModelFindStability(Model model, SolveReport *report)
{
  const ModelWork *work = model->work;
  Factor           factor;

  PetscFunctionBeginUser;
  report->negatives = -1;
  report->gives     = 0;
  if (work->hold.n || model->mesh->saddle) PetscFunctionReturn(PETSC_SUCCESS);
  if (report->damped) PetscCall(FactorAnew(model));
  PetscCall(LinearSolverOwnFactor(work->solver, &factor));
  if (!factor) PetscFunctionReturn(PETSC_SUCCESS);
  report->negatives = FactorIsSymmetric(factor) ? FactorNegatives(factor) : FactorParity(factor);
  if (report->negatives) report->gives = INFINITY;
  if (report->negatives || !FactorIsSymmetric(factor)) PetscCall(FindMode(model, factor, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}
