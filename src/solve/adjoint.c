/* Adjoint solutions, see adjoint.h. */
#include "solve/adjoint.h"
#include "modelimpl.h"

/* Computes direct + (K^T held) + (C_p^T pressed) over the free dofs; the elastic tangent is that of the state. */
static PetscErrorCode RightHandSide(Model model, const Functional *functional, Vec b)
{
  const PetscInt  n       = model->mesh->n_nodes * model->mesh->dim;
  const PetscBool pressed = (PetscBool)(model->contact && (functional->held || functional->pressed));
  PetscReal      *r, *none;
  PetscBool       changed;
  Mat             C;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &r, n, &none));
  if (functional->direct) PetscCall(PetscArraycpy(r, functional->direct, n));
  if (functional->held) PetscCall(ElasticityMultiplyTransposed(model->problem->elasticity, functional->held, r));
  if (pressed) {
    PetscCall(ContactMultiplyBegin(model->contact, functional->held ? functional->held : none, model->t, model->t));
    PetscCall(ContactMultiplyTransposed(model->contact, functional->pairs, functional->pressed));
    PetscCall(ContactTangent(model->contact, model->problem->trial, model->t, &C, &changed));
    PetscCall(ContactMultiplyEnd(model->contact, r));
  }
  PetscCall(MeshLocalToGlobal(model->mesh, r, b));
  PetscCall(VecScale(b, -1));
  PetscCall(PetscFree2(r, none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums x . f over the nodes that this rank owns, and over all ranks; f is complete there. */
static PetscErrorCode Work(Mesh mesh, const PetscReal *x, const PetscReal *f, PetscReal *work)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  *work = 0;
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    for (int d = 0; d < mesh->dim && mesh->node_owner[n] == rank; d++)
      *work += x[n * mesh->dim + d] * f[n * mesh->dim + d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPIU_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dJ/d(ln s), s being a factor on the penalties: the error that they leave (penaltyerror.c). */
static PetscErrorCode PenaltyPart(Model model, const Functional *functional, const PetscReal *y, PenaltySource source,
                                  PetscReal *error)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *f, own = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &f));
  PetscCall(ContactStifferForces(model->contact, source, f));
  PetscCall(Work(model->mesh, y, f, error));
  if (functional->pressed) {
    PetscCall(PetscArrayzero(f, n));
    for (int p = 0; p < ContactPairs(model->contact); p++)
      if (functional->pairs[p]) PetscCall(ContactPairStifferForces(model->contact, p, source, f));
    PetscCall(Work(model->mesh, functional->pressed, f, &own));
  }
  *error += own;
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for y and weighs what penalties and solver leave with it. F: residual of the free dofs. */
static PetscErrorCode Solve(Model model, const Functional *functional, Vec F, Adjoint *adjoint)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  Vec            b, x;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &b));
  PetscCall(VecDuplicate(model->x, &x));
  adjoint->penetration = adjoint->slip = adjoint->residual = 0;
  PetscCall(RightHandSide(model, functional, b));
  PetscCall(LinearSolverTransposed(model->work->solver, model->problem->A, b, x, &adjoint->known));
  if (adjoint->known) {
    PetscCall(PetscArrayzero(adjoint->y, n));
    if (functional->held) PetscCall(PetscArraycpy(adjoint->y, functional->held, n));
    PetscCall(MeshGlobalToLocal(model->mesh, x, adjoint->y));
    PetscCall(VecDot(x, F, &adjoint->residual));
    if (model->contact) PetscCall(PenaltyPart(model, functional, adjoint->y, BY_PENETRATION, &adjoint->penetration));
    if (ContactHasFriction(model->contact))
      PetscCall(PenaltyPart(model, functional, adjoint->y, BY_SLIP, &adjoint->slip));
  }
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelAdjoint - computes adjoint solutions at the solution of a step, and what penalties and solver leave of error.

  Collective

  Input Parameters:
+ model      - after ModelSolve() has found a solution, before ModelAccept()
. n          - number of functionals
- functional - first variations of quantities of the solution

  Input/Output Parameter:
. adjoint - with room for y of each

  Note:
  The state stays as it is. One tangent serves all functionals, with the factor at hand where that is near enough.
@*/
PetscErrorCode ModelAdjoint(Model model, int n, const Functional functional[], Adjoint adjoint[])
{
  PetscBool ok;
  KSP       ksp;
  Vec       F;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(model->x, &F));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  PetscCall(ProblemResidual(model->problem, model->problem->trial, model->t, model->t, &ok));
  PetscCall(ProblemCollectResidual(model->problem, model->x, F));
  PetscCall(ModelLinearise(model, &ksp));
  for (int i = 0; i < n; i++) PetscCall(Solve(model, &functional[i], F, &adjoint[i]));
  PetscCall(VecDestroy(&F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what one pair's master leaves to the errors of all functionals. */
static PetscErrorCode AddShapeErrors(Model model, int p, int n, const Functional functional[], const Adjoint adjoint[],
                                     PetscReal error[])
{
  PetscReal *f;
  PetscBool  known;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(model->mesh->n_nodes * model->mesh->dim, &f));
  PetscCall(ContactPairShapeForces(model->contact, p, model->problem->trial, f, &known));
  for (int i = 0; i < n; i++) {
    PetscReal work = 0, own = 0;

    if (!adjoint[i].known) continue;
    if (known) PetscCall(Work(model->mesh, adjoint[i].y, f, &work));
    if (known && functional[i].pressed && functional[i].pairs[p])
      PetscCall(Work(model->mesh, functional[i].pressed, f, &own));
    error[i] = known ? error[i] + work + own : NAN;
  }
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShapeErrors - computes what masters leave of error that miss their own nodes.

  Collective

  Input Parameters:
+ model      - after ModelAdjoint()
. n          - number of functionals
. functional - of ModelAdjoint()
- adjoint    - likewise; those that are not known are left out

  Output Parameter:
. error - of each functional: true less computed value; NaN where it is not known of a pair
@*/
PetscErrorCode ModelShapeErrors(Model model, int n, const Functional functional[], const Adjoint adjoint[],
                                PetscReal error[])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) error[i] = 0;
  for (int p = 0; p < ContactPairs(model->contact); p++)
    PetscCall(AddShapeErrors(model, p, n, functional, adjoint, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what one pair leaves within faces to the errors of all functionals. y: room for each. */
static PetscErrorCode AddWithinFaces(Model model, int p, int n, const Functional functional[], const Adjoint adjoint[],
                                     PetscReal *const y[], PetscReal error[])
{
  const PetscInt dofs = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *part;
  PetscBool      known;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &part));
  for (int i = 0; i < n; i++) {
    const PetscReal *own = functional[i].pressed && functional[i].pairs[p] ? functional[i].pressed : NULL;

    for (PetscInt k = 0; k < dofs; k++) y[i][k] = adjoint[i].y[k] + (own ? own[k] : 0);
  }
  PetscCall(ContactPairWithinFaces(model->contact, p, model->problem->trial, n, y, part, &known));
  for (int i = 0; i < n; i++) error[i] = known ? error[i] + part[i] : NAN;
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelWithinFaces - computes what contact leaves of error within faces.

  Collective

  Input Parameters:
+ model      - after ModelAdjoint()
. n          - number of functionals
. functional - of ModelAdjoint()
- adjoint    - likewise; those that are not known say nothing

  Output Parameter:
. error - of each functional: true less computed value; NaN where it is not known of a pair
@*/
PetscErrorCode ModelWithinFaces(Model model, int n, const Functional functional[], const Adjoint adjoint[],
                                PetscReal error[])
{
  PetscReal **y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &y));
  for (int i = 0; i < n; i++) {
    error[i] = 0;
    PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &y[i]));
  }
  for (int p = 0; p < ContactPairs(model->contact); p++)
    PetscCall(AddWithinFaces(model, p, n, functional, adjoint, y, error));
  for (int i = 0; i < n; i++) PetscCall(PetscFree(y[i]));
  PetscCall(PetscFree(y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelRespond - computes how the solution of a step follows a change of the residual.

  Collective

  Input Parameters:
+ model  - after ModelAdjoint(), whose tangent serves again
- change - of the residual of the free dofs (force)

  Output Parameters:
+ response - change of the free displacements (length)
- known    - the linear solve succeeded
@*/
PetscErrorCode ModelRespond(Model model, Vec change, Vec response, PetscBool *known)
{
  KSP ksp;
  Vec forces;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(change, &forces));
  PetscCall(VecCopy(change, forces));
  PetscCall(VecScale(forces, -1));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSolve(ksp, forces, response));
  *known = (PetscBool)!LinearCheckLost(model->linear);
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
