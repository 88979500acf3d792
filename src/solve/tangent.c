/* The tangent of a model and its linear solver. */
#include "base/timing.h"
#include "modelimpl.h"

/* Updates the factor of an earlier tangent for the contact terms that have come and gone since. */
static PetscErrorCode ModelUpdateFactor(Model model, PetscInt terms)
{
  PetscInt   rows;
  PetscReal *s;
  Mat        N;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(model->x, &rows));
  PetscCall(PetscMalloc1(terms, &s));
  PetscCall(ContactChangeVectors(model->contact, rows, terms, s, &N));
  PetscCall(ReusedFactorUpdate(LinearSolverKept(model->work->solver), N, s));
  PetscCall(MatDestroy(&N));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out whether contact couples so many unknowns that factors of bodies and contact have much more fill than those
   of bodies alone. In two dimensions contact is on lines, and it does not. Where PETSc is to test the tangent or to
   make its own, the matrix must hold all of it, and the answer is no. */
static PetscErrorCode ModelCouples(Model model, PetscBool *couples)
{
  static const char *const options[] = {"-snes_test_jacobian", "-snes_fd", "-snes_fd_color", "-snes_mf",
                                        "-snes_mf_operator"};

  PetscFunctionBeginUser;
  *couples = (PetscBool)(model->contact && model->mesh->dim == 3 && ContactHasFits(model->contact));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(options) && *couples; i++) {
    PetscBool given;

    PetscCall(PetscOptionsHasName(NULL, NULL, options[i], &given));
    if (given) *couples = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the first tangent: lets the linear solver order its unknowns, and keeps contact apart from the bodies if the
   solver asks for that. A problem with a single solve is done sooner with any order. */
static PetscErrorCode ModelOrder(Model model)
{
  PetscBool couples = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (model->work->ordered || ProblemIsLinear(model->problem)) PetscFunctionReturn(PETSC_SUCCESS);
  model->work->ordered = PETSC_TRUE;
  PetscCall(ModelCouples(model, &couples));
  PetscCall(LinearSolverOrder(model->work->solver, model->problem->P, couples));
  if (!LinearSolverBorders(model->work->solver)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetForm(model->problem, TANGENT_BORDERED));
  PetscCall(SNESSetJacobian(model->snes, model->problem->A, model->problem->P, NULL, NULL)); /* NULL: as it is */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the linear solver the contact terms that the matrix P does not hold. */
static PetscErrorCode ModelBorder(Model model)
{
  Border border;

  PetscFunctionBeginUser;
  if (model->problem->form == TANGENT_JOINED) PetscFunctionReturn(PETSC_SUCCESS);
  TimingBegin(TIMING_ASSEMBLY_CONTACT);
  PetscCall(ContactGetBorder(model->contact, &border));
  PetscCall(LinearSolverSetBorder(model->work->solver, &border));
  TimingEnd(TIMING_ASSEMBLY_CONTACT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelTangent - computes the tangent at (u, t) and prepares the linear solver for it.

  Collective

  Input Parameters:
+ model     - the model
. u         - local displacements u[n_nodes*dim] (length)
. reference - the state from which the elements extrapolate stresses; NULL: the tangent is the derivative of the
  residual
- t         - load parameter

  Note:
  The first call lets the linear solver order its unknowns. Where the factor of an earlier tangent still serves, SNES is
  told to keep the preconditioner, and the factor is updated for the contact terms that came and went.
@*/
PetscErrorCode ModelTangent(Model model, const PetscReal *u, const StressReference *reference, PetscReal t)
{
  TangentChange change;
  PetscBool     older;

  PetscFunctionBeginUser;
  model->work->tangents++;
  PetscCall(VecDestroy(&model->work->tangent_x));
  PetscCall(ModelOrder(model));
  PetscCall(LinearSolverRelease(model->work->solver));
  PetscCall(ProblemTangent(model->problem, u, reference, t, &change));
  PetscCall(ModelBorder(model));
  PetscCall(LinearSolverNext(model->work->solver, u, change.C, change.pattern, change.terms, &older));
  PetscCall(SNESSetLagPreconditioner(model->snes, older ? -1 : 1)); /* SNES tells the KSP so after each tangent */
  if (older && change.terms > 0) PetscCall(ModelUpdateFactor(model, change.terms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelReleaseTangent - frees what the linear solver does not need of the last tangent, where memory counts.

  Not collective

  Input Parameter:
. model - before the linear solve

  Note:
  With the iterative solver this is the elements' own form of the tangent, a ninth of all memory. Beside factors it is
  little.
@*/
PetscErrorCode ModelReleaseTangent(Model model)
{
  PetscFunctionBeginUser;
  if (LinearSolverIterates(model->work->solver)) PetscCall(ElasticityReleaseTangent(model->problem->elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelTangentOdd - says whether the tangent that was factored last has an odd number of negative eigenvalues.

  Not collective, the same on all ranks

  Input Parameter:
. model - the model

  Output Parameter:
. odd - it has, which no stable state has; false where it is not known

  Note:
  With friction the tangent is not symmetric, and nothing else is known of its eigenvalues. Where nodes have pressures,
  it has negative ones of its own, and MUMPS's sign of the determinant does not follow their number.
@*/
PetscErrorCode ModelTangentOdd(Model model, PetscBool *odd)
{
  PetscInt parity;

  PetscFunctionBeginUser;
  PetscCall(LinearSolverParity(model->work->solver, &parity));
  *odd = (PetscBool)(parity == 1 && !model->mesh->saddle);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the linear solver have the tangent at the trial state, which is the derivative of the residual? A problem with a
   single solve has one tangent. */
static PetscErrorCode HasTangent(Model model, PetscBool *has)
{
  const ModelWork *work = model->work;

  PetscFunctionBeginUser;
  *has = PETSC_FALSE;
  if (LinearSolverIterates(work->solver)) PetscFunctionReturn(PETSC_SUCCESS);
  if (ProblemIsLinear(model->problem))
    *has = (PetscBool)(work->tangents > 0);
  else if (work->tangent_x && work->tangent_t == model->t)
    PetscCall(VecEqual(work->tangent_x, model->x, has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelLinearise - computes the tangent at the trial state for linear solves with it.

  Collective

  Input Parameter:
. model - after ProblemSetTrial() and ProblemResidual() at model->x, its solution

  Output Parameter:
. ksp - solves with the tangent, which is the derivative of the residual

  Note:
  Nothing is computed where the last tangent was that of this state.
@*/
PetscErrorCode ModelLinearise(Model model, KSP *ksp)
{
  ModelWork *work = model->work;
  PetscBool  has;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(model->snes, ksp));
  if (model->contact) ContactForgetForeseen(model->contact);
  PetscCall(HasTangent(model, &has));
  if (!has) {
    if (LinearSolverIterates(work->solver))
      PetscCall(LinearSolverSetEnough(work->solver, 0)); /* the preconditioner of the step's solves serves */
    else
      PetscCall(LinearSolverRenew(work->solver));
    PetscCall(LinearSolverSetStart(work->solver, 0));
    PetscCall(ModelTangent(model, model->problem->trial, NULL, model->t));
    PetscCall(VecDuplicate(model->x, &work->tangent_x));
    PetscCall(VecCopy(model->x, work->tangent_x));
    work->tangent_t = model->t;
  }
  PetscCall(KSPSetOperators(*ksp, model->problem->A, model->problem->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
