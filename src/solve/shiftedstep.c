/* Newton's steps with a shifted tangent, where bodies buckle or snap: (K + s V) y = R. */
#include "base/timing.h"
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* A shift that does not serve is raised by this factor, */
#define SHIFT_RAISE 4
/* and after each step that was taken whole it is divided by this one: close to a stable equilibrium the steps are soon
   Newton's own. */
#define SHIFT_LOWER 10
/* Bounds of the shift, in mean stiffnesses of the elements. The least one makes no difference to any body that is held.
   The largest one is as stiff as the elements themselves; a step that does not serve then has another cause. */
#define SHIFT_LEAST 1e-8
#define SHIFT_MOST  1
/* A search that leaves less than this of a step shows that the shift is too small. */
#define SHIFT_SHORT 0.25
/* A step may turn cells by this much. The way down is bent, and steps as long as MODEL_FARTHEST leave it: of a rubber
   block with nine holes none of them finds the end of its first jump. */
#define SHIFT_FARTHEST 0.2
/* Contact lists are made for this multiple of the step that would lead out of the present ones. */
#define SHIFT_AHEAD 2
/* With friction they are made for this multiple of the way from the accepted state, if that is more: two bodies may
   have moved against each other, and what sticks is anchored where they were. */
#define SHIFT_BEHIND 2
/* Iterations of a shifted solve, in those that solver.max_iterations allows others. On the way down from an equilibrium
   that is lost there are many, and none that fails. */
#define SHIFT_LONGER 10

/* Counts the unknown pressures of nodes. A stable equilibrium has a negative eigenvalue for each. Collective. */
static PetscErrorCode CountPressures(Model model, PetscInt *pressures)
{
  const Mesh     mesh = model->mesh;
  const PetscInt n    = mesh->n_nodes * mesh->dim;
  PetscReal     *is, sum;
  Vec            free;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &is));
  PetscCall(VecDuplicate(model->x, &free));
  for (PetscInt i = 0; i < n; i++) is[i] = IsPressureNode(mesh, i / mesh->dim);
  PetscCall(MeshCollectFree(mesh, is, free));
  PetscCall(VecSum(free, &sum));
  *pressures = (PetscInt)(sum + 0.5);
  PetscCall(VecDestroy(&free));
  PetscCall(PetscFree(is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftBegin - lets the tangents of the following solves be shifted.

  Collective

  Input Parameters:
+ model - its problem has its damping
. first - the first shift (force per length and volume)
- mean  - the shift that is as stiff as the elements are in the mean
@*/
PetscErrorCode ModelShiftBegin(Model model, PetscReal first, PetscReal mean)
{
  ShiftedStep *shift = &model->work->shift;

  PetscFunctionBeginUser;
  shift->on    = PETSC_TRUE;
  shift->mean  = mean;
  shift->scale = PetscMax(first, SHIFT_LEAST * mean);
  shift->works = 0;
  shift->start = INFINITY;
  PetscCall(CountPressures(model, &shift->pressures));
  PetscCall(DofSpringsAnchor(model->problem->damping, model->x));
  DofSpringsShift(model->problem->damping, shift->scale);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Potential energy at free displacements; infinite where loads or friction leave none. */
static PetscErrorCode Potential(Model model, Vec x, PetscReal *energy)
{
  PetscBool ok;

  PetscFunctionBeginUser;
  *energy = INFINITY;
  if (!LoadsConservative(model->problem->loads) || ContactHasFriction(model->contact))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetTrial(model->problem, x, model->t));
  PetscCall(ProblemEnergy(model->problem, model->problem->trial, model->t, ENERGY_POTENTIAL, energy, &ok));
  if (!ok) *energy = INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftEnd - lets the tangents be those of the problem again.

  Collective

  Input Parameter:
. model - its trial displacements are those of the last iterate

  Output Parameter:
. taken - energy that the steps have taken away

  Note:
  That is what the potential has fallen by at the load of the step, or the work against springs that are anchored at
  each iterate, whichever is less. The first counts what the linear step of the start has put into stiff parts, the
  second what iterates on the way have. With friction, and with loads that have no energy, there is no potential, and
  the work is told.
@*/
PetscErrorCode ModelShiftEnd(Model model, PetscReal *taken)
{
  ShiftedStep *shift = &model->work->shift;
  PetscReal    end, fall;

  PetscFunctionBeginUser;
  *taken = 0;
  if (!shift->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Potential(model, model->x, &end));
  fall   = isfinite(shift->start) && isfinite(end) ? shift->start - end : INFINITY;
  *taken = PetscMax(0, PetscMin(shift->works, fall));
  PetscCall(PetscInfo(model->snes, "shifted steps: works %g, fall %g\n", (double)shift->works, (double)fall));
  shift->on = PETSC_FALSE;
  DofSpringsShift(model->problem->damping, 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftIterations - returns how many iterations a solve may take.

  Not collective, the same on all ranks

  Input Parameters:
+ model - the model
- usual - as many as a solve without shift may take
@*/
PetscInt ModelShiftIterations(Model model, PetscInt usual)
{
  return model->work->shift.on ? SHIFT_LONGER * usual : usual;
}

/*@
  ModelShiftNext - chooses the shift of the next tangent by what became of the last step, before that tangent is made.

  Collective

  Input Parameters:
+ model     - the model
. x         - the iterate
. iteration - its number in this solve; 0: no step of this solve has led to it
- lambda    - part of the last step that was taken
@*/
PetscErrorCode ModelShiftNext(Model model, Vec x, PetscInt iteration, PetscReal lambda)
{
  ShiftedStep     *shift  = &model->work->shift;
  const DofSprings spring = model->problem->damping;
  PetscReal        work;

  PetscFunctionBeginUser;
  if (!shift->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DofSpringsShiftWork(spring, x, &work));
  shift->works += work;
  if (PetscIsInfReal(shift->start)) PetscCall(Potential(model, x, &shift->start));
  PetscCall(DofSpringsAnchor(spring, x));
  if (iteration > 0 && lambda >= 1) shift->scale /= SHIFT_LOWER;
  if (iteration > 0 && lambda < SHIFT_SHORT) shift->scale *= SHIFT_RAISE;
  shift->cut   = (PetscBool)(iteration > 0 && lambda < SHIFT_SHORT);
  shift->scale = PetscMin(SHIFT_MOST * shift->mean, PetscMax(SHIFT_LEAST * shift->mean, shift->scale));
  DofSpringsShift(spring, shift->scale);
  PetscCall(LinearSolverRenew(model->work->solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftLists - notes that contact lists have been made at a state.

  Collective

  Input Parameters:
+ model - the model
. x     - free displacements (length) of that state
- reach - motion (length) from there that the lists are good for
@*/
PetscErrorCode ModelShiftLists(Model model, Vec x, PetscReal reach)
{
  ShiftedStep *shift = &model->work->shift;

  PetscFunctionBeginUser;
  if (!shift->on || !model->contact) PetscFunctionReturn(PETSC_SUCCESS);
  if (!shift->lists) PetscCall(VecDuplicate(x, &shift->lists));
  PetscCall(VecCopy(x, shift->lists));
  shift->reach  = reach;
  shift->wanted = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftRenew - makes the contact lists that the next step needs, at the trial displacements.

  Collective

  Input Parameter:
. model - ModelShiftStep() has found that a step leads out of the present lists
@*/
PetscErrorCode ModelShiftRenew(Model model)
{
  const ModelWork *work  = model->work;
  PetscReal        reach = PetscMax(model->problem->expected, work->shift.wanted), motion = 0;

  PetscFunctionBeginUser;
  if (ContactHasFriction(model->contact))
    PetscCall(
      ProblemMotion(model->problem, work->accepted_u, work->accepted_t, model->problem->trial, model->t, &motion));
  reach = PetscMax(reach, SHIFT_BEHIND * motion);
  TimingBegin(TIMING_SEARCH);
  PetscCall(ContactListsRenew(model->contact, model->problem->trial, model->t, reach));
  TimingEnd(TIMING_SEARCH);
  PetscCall(ModelShiftLists(model, model->x, reach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the tangent has no negative eigenvalue but those of pressures, as far as that is known. */
static PetscErrorCode Stable(Model model, PetscBool *stable)
{
  PetscInt  negatives;
  PetscBool odd;

  PetscFunctionBeginUser;
  PetscCall(LinearSolverNegatives(model->work->solver, &negatives));
  PetscCall(ModelTangentOdd(model, &odd));
  *stable = (PetscBool)(negatives < 0 ? !odd : negatives <= model->work->shift.pressures);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the step from u to the free displacements x - y serves: the tangent has no negative eigenvalue, the step
   leads downhill for the forces b, and it turns no cell far. */
static PetscErrorCode Serves(Model model, const PetscReal *u, Vec x, Vec b, Vec y, PetscBool *serves)
{
  PetscReal *v, slope, turn;
  PetscBool  stable = PETSC_FALSE;
  Vec        end;

  PetscFunctionBeginUser;
  PetscCall(Stable(model, &stable));
  PetscCall(VecDotRealPart(b, y, &slope));
  *serves = (PetscBool)(stable && slope > 0);
  if (!*serves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(model->mesh->n_nodes * model->mesh->dim, &v));
  PetscCall(VecDuplicate(x, &end));
  PetscCall(VecWAXPY(end, -1, y, x));
  PetscCall(ProblemDisplacements(model->problem, end, model->t, v));
  PetscCall(ModelLargestTurn(model, u, v, &turn));
  *serves = (PetscBool)(turn <= SHIFT_FARTHEST);
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out whether the step from x to x - y leads out of the contact lists, or the one before was cut since lists were
   made elsewhere. Then it is not made: new lists are. */
static PetscErrorCode Reach(Model model, Vec x, Vec y)
{
  const Problem   problem = model->problem;
  const PetscReal t       = model->t;
  ShiftedStep    *shift   = &model->work->shift;
  const PetscInt  n       = model->mesh->n_nodes * model->mesh->dim;
  PetscReal      *from, *to, moved, motion, step;
  Vec             end;

  PetscFunctionBeginUser;
  if (!model->contact || !shift->lists || model->work->renewed >= ModelShiftIterations(model, MODEL_MAX_REGATHER))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n, &from, n, &to));
  PetscCall(VecDuplicate(x, &end));
  PetscCall(VecWAXPY(end, -1, y, x));
  PetscCall(ProblemDisplacements(problem, shift->lists, t, from));
  PetscCall(ProblemDisplacements(problem, end, t, to));
  PetscCall(ProblemMotion(problem, from, t, problem->trial, t, &moved));
  PetscCall(ProblemMotion(problem, from, t, to, t, &motion));
  PetscCall(ProblemMotion(problem, problem->trial, t, to, t, &step));
  if (motion > shift->reach || (shift->cut && moved > 0)) {
    shift->wanted = SHIFT_AHEAD * step;
    PetscCall(VecSet(y, 0));
  }
  PetscCall(VecDestroy(&end));
  PetscCall(PetscFree2(from, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftSolve - raises the shift until a linear step serves, and makes the step anew.

  Collective

  Input Parameters:
+ model - its linear solver has the tangent that y was found with
. u     - local displacements u[n_nodes*dim] (length) where the step begins
. x     - the free ones of the iterate (length)
- b     - forces of the step

  Input/Output Parameter:
. y - the step: free displacements go to x - y (length)
@*/
PetscErrorCode ModelShiftSolve(Model model, const PetscReal *u, Vec x, Vec b, Vec y)
{
  ShiftedStep  *shift   = &model->work->shift;
  const Problem problem = model->problem;
  PetscBool     serves;
  KSP           ksp;

  PetscFunctionBeginUser;
  if (!shift->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetKSP(model->snes, &ksp));
  while (PETSC_TRUE) {
    const PetscReal before = shift->scale;

    PetscCall(Serves(model, u, x, b, y, &serves));
    if (serves || before >= SHIFT_MOST * shift->mean) break;
    shift->scale = PetscMin(SHIFT_MOST * shift->mean, SHIFT_RAISE * before);
    PetscCall(DofSpringsStiffen(problem->damping, shift->scale - before, problem->P));
    DofSpringsShift(problem->damping, shift->scale);
    PetscCall(LinearSolverRenew(model->work->solver));
    PetscCall(KSPSetOperators(ksp, problem->A, problem->P));
    PetscCall(KSPSolve(ksp, b, y));
  }
  PetscCall(PetscInfo(model->snes, "shift %g of the mean stiffness\n", (double)(shift->scale / shift->mean)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelShiftStep - makes Newton's step with a shift with which it serves, or none where it leads out of the contact
  lists.

  Collective

  Input Parameters:
+ model - its trial displacements are those of the iterate, and its linear solver has the tangent there
. x     - the iterate
- F     - its residual

  Input/Output Parameter:
. y - the step: free displacements go from x to x - y (length)
@*/
PetscErrorCode ModelShiftStep(Model model, Vec x, Vec F, Vec y)
{
  PetscFunctionBeginUser;
  if (!model->work->shift.on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelShiftSolve(model, model->problem->trial, x, F, y));
  PetscCall(Reach(model, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
