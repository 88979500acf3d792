/* A solve in pseudo-time steps with a viscous restraint, for load steps that Newton's method fails at. */
#include "modelimpl.h"

/* The first pseudo-time step has a restraint of this part of the mean stiffness of the elements at most. That is stiff
   against any motion of many elements together, which is what becomes unstable, and soft against that of one element.
 */
#define DAMPED_FIRST 1e-2
/* Nor does that restraint take more than this part of what the bodies store, if they go on moving as fast for the load
   as before: thin walls are far softer than their elements, and would be crushed against a restraint that is stiff for
   these. It is the part above which the run warns of damping. */
#define DAMPED_SHARE 1e-2
/* A pseudo-time step that takes few iterations is followed by one that is longer by this factor, a failed one is
   repeated shorter by it. */
#define DAMPED_FACTOR 10
/* The factor falls to its root with each failure, so that lengths come to what the jump allows, but not below this. */
#define DAMPED_LEAST_FACTOR 1.5
/* This many iterations are few. One or two more than Newton's method takes at any load step. */
#define DAMPED_FEW 8
/* The restraint is taken away when its forces have fallen to this part of the largest ones: the bodies have come
   near a rest. Where they have not, the static solve fails, and is tried again after another such fall. */
#define DAMPED_REST 0.1
/* A load step takes at most this many pseudo-time steps, and so many of them may fail. A jump takes 10 to 30, half of
   them for the search of a length that is right for it. */
#define DAMPED_MAX_STEPS    60
#define DAMPED_MAX_FAILURES 30

/* Where a solve in pseudo-time steps stands. */
typedef struct {
  PetscReal mean, scale; /* of the restraint, see damping.h: the elements' mean, the present one */
  PetscReal factor;      /* by which the next pseudo-time step is longer */
  PetscReal force;       /* its force at the end of the last pseudo-time step */
  PetscReal most;        /* the largest one so far */
  PetscReal enough;      /* below this one a static solve is tried */
  PetscInt  steps, failures;
} Relaxation;

/* Sets the restraint. The energy changes with it. */
static void Restrain(Model model, PetscReal scale)
{
  DofSpringsScale(model->problem->damping, scale);
  model->work->energy = 0;
}

/*@
  ModelAnchor - makes the iterate the state to which a damped solve returns after a failure, and from which its
  restraint slows the bodies down.

  Collective

  Input Parameter:
. model - model->x; the restraint is made by ModelSolveDamped()
@*/
PetscErrorCode ModelAnchor(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(DofSpringsAnchor(model->problem->damping, model->x));
  PetscCall(ElasticityKeep(model->problem->elasticity, VOLUMES_OF_ANCHOR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the contact lists at the anchor. Those of a failed solve may have been made far from it. */
static PetscErrorCode GoBackLists(Model model)
{
  const Problem problem = model->problem;
  PetscBool     hold;

  PetscFunctionBeginUser;
  PetscCall(
    ProblemRenewLists(problem, model->work->accepted_u, model->work->accepted_t, model->t, PETSC_TRUE, 1, &hold));
  ContactForgetLost(model->contact); /* by the gaps of the failed solve points seem lost that are not */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns to the anchor after a failure. */
static PetscErrorCode GoBack(Model model, SolveReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(ElasticityReturn(model->problem->elasticity, VOLUMES_OF_ANCHOR));
  model->work->cycling     = PETSC_FALSE;
  model->work->cycles      = 0;
  model->problem->inverted = -1;
  report->detail[0]        = '\0';
  report->result           = SOLVE_CONVERGED;
  PetscCall(DofSpringsReturn(model->problem->damping, model->x));
  PetscCall(ProblemSetTrial(model->problem, model->x, model->t));
  if (model->contact) PetscCall(GoBackLists(model));
  PetscCall(ModelStepFromSolved(model, model->problem->trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the restraint of the first pseudo-time step. No node is expected to move farther than the one that moved the
   farthest in the last load step, for the same load. */
static PetscErrorCode ChooseFirst(Model model, Relaxation *r)
{
  const Problem   problem = model->problem;
  const PetscReal motion  = model->work->rate * (model->t - model->work->accepted_t);
  PetscReal       stored, moving;
  PetscBool       ok;

  PetscFunctionBeginUser;
  PetscCall(DofSpringsMean(problem->damping, problem->diagonal, &r->mean));
  r->scale = DAMPED_FIRST * r->mean;
  PetscCall(ProblemEnergy(problem, model->work->accepted_u, model->work->accepted_t, ENERGY_ELASTIC, &stored, &ok));
  PetscCall(DofSpringsMoving(problem->damping, motion, &moving));
  if (ok && stored > 0 && moving > 0) r->scale = PetscMin(r->scale, DAMPED_SHARE * stored / moving);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes a pseudo-time step. The first one starts with the load step, and again after a failure. */
static PetscErrorCode Step(Model model, ModelStage start, ModelStage solve, Relaxation *r, SolveReport *report)
{
  const PetscInt newton = report->newton, turned = report->turned;
  PetscReal      force, energy;

  PetscFunctionBeginUser;
  Restrain(model, r->scale);
  if (start && !r->steps) PetscCall((*start)(model, report));
  if (report->result == SOLVE_CONVERGED) PetscCall((*solve)(model, report));
  if (report->result != SOLVE_CONVERGED) {
    r->failures++;
    r->scale *= r->factor;
    if (r->steps) r->factor = PetscMax(DAMPED_LEAST_FACTOR, PetscSqrtReal(r->factor));
    PetscCall(PetscInfo(model->snes, "pseudo-time step failed: %s\n", SolveResults[report->result]));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(DofSpringsLoad(model->problem->damping, model->x, &force, &energy));
  PetscCall(ModelAnchor(model));
  PetscCall(PetscInfo(model->snes, "pseudo-time step %" PetscInt_FMT ": restraint %g, force %g, work %g\n", r->steps,
                      (double)(r->scale / r->mean), (double)(force / ProblemForceScale(model->problem)),
                      (double)(2 * energy)));
  report->damped++;
  report->damping += 2 * energy;
  r->steps++;
  r->force = force;
  if (force > r->most) {
    r->most   = force;
    r->enough = DAMPED_REST * force;
  }
  if (report->newton - newton <= DAMPED_FEW && report->turned == turned) r->scale /= r->factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tries to solve without the restraint where its forces have fallen enough. *rests: that was a solution. */
static PetscErrorCode TryStatic(Model model, ModelStage solve, Relaxation *r, SolveReport *report, PetscBool *rests)
{
  const PetscReal nothing = model->scene->solver.tolerance * ProblemForceScale(model->problem);

  PetscFunctionBeginUser;
  *rests = PETSC_FALSE;
  if (r->force > PetscMax(r->enough, nothing)) PetscFunctionReturn(PETSC_SUCCESS);
  Restrain(model, 0);
  PetscCall((*solve)(model, report));
  *rests = (PetscBool)(report->result == SOLVE_CONVERGED);
  if (*rests) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(model->snes, "no rest yet: %s\n", SolveResults[report->result]));
  PetscCall(GoBack(model, report));
  r->enough = DAMPED_REST * r->force;
  r->failures++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolveDamped - finds a static equilibrium by following the bodies in pseudo-time, slowed down by a viscous
  restraint.

  Collective

  Input Parameters:
+ model  - without `start`, ModelAnchor() has kept where the bodies start from
. start  - begins the load step, calls ModelAnchor() and sets the first iterate; NULL: the bodies start from the anchor
. solve  - finds the equilibrium of the present problem from the first iterate
- report - costs and failures are added to it, and the work done against the restraint

  Notes:
  The restraint is taken away at the end: what converges is an equilibrium without it.

  Each pseudo-time step minimises the energy with that of the restraint, so that the energy falls from step to step,
  along the way on which viscous bodies without inertia would move. Steps get longer as long as they take few
  iterations.

  Source: proximal point method (Rockafellar, SIAM J. Control Optim. 14, 1976); pseudo-transient continuation (Kelley
  and Keyes, SIAM J. Numer. Anal. 35, 1998).
@*/
PetscErrorCode ModelSolveDamped(Model model, ModelStage start, ModelStage solve, SolveReport *report)
{
  const Problem problem = model->problem;
  Relaxation    r       = {.factor = DAMPED_FACTOR};
  PetscBool     rests   = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!problem->damping) PetscCall(DampingCreate(model->mesh, model->scene, model->x, &problem->damping));
  PetscCall(ChooseFirst(model, &r));
  while (!rests && r.steps < DAMPED_MAX_STEPS && r.failures < DAMPED_MAX_FAILURES) {
    if (report->result != SOLVE_CONVERGED) PetscCall(GoBack(model, report));
    PetscCall(Step(model, start, solve, &r, report));
    if (report->result == SOLVE_CONVERGED) PetscCall(TryStatic(model, solve, &r, report, &rests));
  }
  Restrain(model, 0);
  if (!rests && report->result == SOLVE_CONVERGED) report->result = SOLVE_RESTLESS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelSolveShifted - finds a static equilibrium by Newton's method with a shifted tangent.

  Collective

  Input Parameters:
+ model  - without `start`, ModelAnchor() has kept where the bodies start from
. start  - begins the load step and sets the first iterate; NULL: the bodies start from the anchor
. solve  - finds the equilibrium of the present problem from the first iterate
- report - costs and failures are added to it, and the energy that was taken away
@*/
PetscErrorCode ModelSolveShifted(Model model, ModelStage start, ModelStage solve, SolveReport *report)
{
  const Problem problem = model->problem;
  Relaxation    r       = {.factor = DAMPED_FACTOR};

  PetscFunctionBeginUser;
  if (!problem->damping) PetscCall(DampingCreate(model->mesh, model->scene, model->x, &problem->damping));
  PetscCall(ChooseFirst(model, &r));
  PetscCall(ModelShiftBegin(model, r.scale, r.mean));
  if (start) PetscCall((*start)(model, report));
  if (report->result == SOLVE_CONVERGED) PetscCall((*solve)(model, report));
  PetscCall(PetscInfo(model->snes, "solve with shifted tangents: %s\n", SolveResults[report->result]));
  report->damped++;
  PetscFunctionReturn(PETSC_SUCCESS);
}
