/* A soft motion that is held, see ModelHoldMotion(). */
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* What holds a motion may be what friction of this coefficient at the surfaces in contact would hold. The least that is
   measured between lubricated solids is about as much; seals have 0.01 to 1. */
#define HELD_FRICTION 1e-3
/* What takes more than that moves on, at first so far that it turns cells by this part of MODEL_FARTHEST. The next move
   may be as much longer if the force keeps its sign, and is as much shorter if it has changed. */
#define HELD_FIRST 0.25
#define HELD_GROW  2.0
/* Moves in a load step until the motion is released */
enum { HELD_MOVES = 40 };

/* Takes out of free displacements what they have along the motion, by a force on it. The result is what the tangent
   gives for the body whose motion is held. */
static PetscErrorCode TakeOut(const HeldMotion *held, Vec z)
{
  PetscReal along;

  PetscFunctionBeginUser;
  PetscCall(VecDotRealPart(held->b, z, &along));
  PetscCall(VecAXPY(z, -along / held->compliance, held->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the soft motion of the present tangent and keeps it, with the direction that it had. start: any vector that has
   a part of it. part: of the motion in that */
static PetscErrorCode KeepMotion(Model model, Vec start, PetscReal *stiffness, PetscReal *part)
{
  HeldMotion *held  = &model->work->hold;
  PetscReal   along = 1;
  Vec         v;

  PetscFunctionBeginUser;
  if (!held->b) {
    PetscCall(VecDuplicate(start, &held->b));
    PetscCall(VecDuplicate(start, &held->w));
  }
  PetscCall(VecDuplicate(start, &v));
  PetscCall(ModelSoftMotion(model, start, v, stiffness, part));
  if (held->known) PetscCall(VecDotRealPart(v, held->b, &along));
  if (along < 0) PetscCall(VecScale(v, -1));
  if (along < 0) *part = -*part;
  PetscCall(ModelDropPressures(model, v, held->b));
  PetscCall(VecDestroy(&v));
  held->known = PETSC_TRUE;
  held->anew  = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far a step y from the iterate x turns a cell. */
static PetscErrorCode TurnOf(Model model, Vec x, Vec y, PetscReal *turn)
{
  const PetscInt n = model->mesh->n_nodes * model->mesh->dim;
  PetscReal     *u, *v;
  Vec            w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &u, n, &v));
  PetscCall(VecDuplicate(x, &w));
  PetscCall(VecWAXPY(w, -1, y, x));
  PetscCall(ProblemDisplacements(model->problem, x, model->t, u));
  PetscCall(ProblemDisplacements(model->problem, w, model->t, v));
  PetscCall(ModelLargestTurn(model, u, v, turn));
  PetscCall(VecDestroy(&w));
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the step y a part along the motion that goes down the force that holds it, as far as cells may turn. */
static PetscErrorCode MoveOn(Model model, Vec y)
{
  HeldMotion     *held  = &model->work->hold;
  const PetscReal along = (held->compliance > 0 ? 1 : -1) * held->force;
  PetscReal       turn;
  Vec             z;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &z));
  PetscCall(VecCopy(held->w, z));
  PetscCall(VecScale(z, along));
  PetscCall(TurnOf(model, model->x, z, &turn));
  held->turn = PetscMin(turn, held->bound);
  PetscCall(VecAXPY(y, turn > 0 ? held->turn / turn : 0, z));
  PetscCall(PetscInfo(model->snes, "the motion moves on: turns cells by %g of %g\n", (double)held->turn, (double)turn));
  PetscCall(VecDestroy(&z));
  held->moves  = PETSC_FALSE;
  held->moving = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHoldInStep - takes the motion that is held out of a linear step.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the step's start
- y     - the step (length)

  Output Parameter:
. y - without the motion, or with a bounded part of it where it is to move on; unchanged where none is held
@*/
PetscErrorCode ModelHoldInStep(Model model, Vec y)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   stiffness, part;
  KSP         ksp;

  PetscFunctionBeginUser;
  if (!held->on) PetscFunctionReturn(PETSC_SUCCESS);
  if (!held->known || held->anew) PetscCall(KeepMotion(model, y, &stiffness, &part));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSolve(ksp, held->b, held->w));
  PetscCall(VecDotRealPart(held->b, held->w, &held->compliance));
  if (held->compliance == 0) held->on = PETSC_FALSE;
  if (held->on) PetscCall(TakeOut(held, y));
  held->moving = PETSC_FALSE;
  if (held->on && held->moves) PetscCall(MoveOn(model, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHoldInColumns - takes the motion that is held out of columns of the factor.

  Collective

  Input Parameters:
+ model - after ModelHoldInStep() with the same tangent
- Z     - dense columns of free displacements
@*/
PetscErrorCode ModelHoldInColumns(Model model, Mat Z)
{
  PetscInt m;
  Vec      z;

  PetscFunctionBeginUser;
  if (!model->work->hold.on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(Z, NULL, &m));
  for (PetscInt j = 0; j < m; j++) {
    PetscCall(MatDenseGetColumnVecWrite(Z, j, &z));
    PetscCall(TakeOut(&model->work->hold, z));
    PetscCall(MatDenseRestoreColumnVecWrite(Z, j, &z));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelMayRoll - says whether there are bodies that may roll next to freely: contact alone holds them, without friction,
  and they give back what deforms them; no where the scene says that no roll is held.

  Not collective

  Input Parameter:
. model - the model
@*/
PetscBool ModelMayRoll(Model model)
{
  return (PetscBool)(model->scene->solver.hold_rolling && model->problem->bodies && !ProblemIsPlastic(model->problem) &&
                     !ContactHasFriction(model->contact));
}

/*@
  ModelHoldMotion - decides whether the soft motion of bodies that contact alone holds is held from now on.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the iterate; ModelMayRoll()
. x     - the iterate
. F     - its residual
. y     - Newton's step: it leads to x - y (length)
- near  - an equilibrium is near, so that short steps are right whether they lead uphill or not

  Notes:
  Rubber that can roll along walls without friction has one motion that is softer than all others by orders of
  magnitude. What drives it is of the order of the errors of the mesh, and so is its stiffness, which changes its sign
  with each node that passes an edge. Newton's steps along it are arbitrary. Where a step goes too far or the tangent is
  indefinite, and it is this motion that does it, the motion is held: the rest is solved for as if the body could not
  go along it. What that takes is a force. It stays if next to no friction would hold as much, else the motion moves on
  down that force, see ModelJudgeHeld(). This needs a factor.
@*/
PetscErrorCode ModelHoldMotion(Model model, Vec x, Vec F, Vec y, PetscBool near)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   turn, rest = 0, slope, downhill, stiffness, part;
  PetscBool   direct;
  Vec         r;

  PetscFunctionBeginUser;
  if (held->on || held->released) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearSolverDirect(model->work->solver, &direct));
  if (!direct) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TurnOf(model, x, y, &turn));
  PetscCall(VecDotRealPart(F, y, &slope));
  if (turn <= MODEL_FARTHEST && (near || slope >= 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeepMotion(model, y, &stiffness, &part));
  PetscCall(VecDuplicate(y, &r));
  PetscCall(VecWAXPY(r, -part, held->b, y));
  PetscCall(TurnOf(model, x, r, &rest));
  PetscCall(VecDotRealPart(F, r, &downhill));
  PetscCall(VecDestroy(&r));
  /* pressures of nodes have slopes of their own */
  held->on = (PetscBool)(rest <= MODEL_FARTHEST &&
                         ((stiffness < 0 && (model->mesh->saddle || downhill >= 0)) || turn > MODEL_FARTHEST));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldResidual - finds what is left of a residual without the force that holds a motion.

  Collective

  Input Parameters:
+ model - the model
. F     - the residual (force)
- norm  - of F

  Output Parameters:
+ norm  - of what is left
- force - that is held, with the sign of the motion; 0 where no motion is
@*/
PetscErrorCode ModelHeldResidual(Model model, Vec F, PetscReal *norm, PetscReal *force)
{
  const HeldMotion *held = &model->work->hold;

  PetscFunctionBeginUser;
  *force = 0;
  if (!held->on || !held->known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDotRealPart(F, held->b, force));
  *norm = PetscSqrtReal(PetscMax(0, PetscSqr(*norm) - PetscSqr(*force)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force along the motion that friction with a coefficient of 1 would hold. */
static PetscErrorCode Friction(Model model, PetscReal *sum)
{
  const Mesh mesh = model->mesh;
  PetscReal *force, *b;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes, &force, mesh->n_nodes * mesh->dim, &b));
  PetscCall(MeshGlobalToLocal(mesh, model->work->hold.b, b));
  for (int p = 0; p < ContactPairs(model->contact); p++) PetscCall(ContactTermForces(model->contact, p, 0, force));
  *sum = 0;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < mesh->dim; d++) square += PetscSqr(b[i * mesh->dim + d]);
    *sum += force[i] * PetscSqrtReal(square);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPIU_REAL, MPI_SUM, mesh->comm));
  PetscCall(PetscFree2(force, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelJudgeHeld - judges the force that holds a motion. If that is too much, the motion moves on in the next step, and
  after some moves it is released for the rest of the load step.

  Collective

  Input Parameters:
+ model - at a solution with the motion held, after its residual
- force - that holds it, with its sign

  Output Parameter:
. holds - it may stay as it is

  Note:
  On softened penalties it stays. They hold a body where the full ones do not, and what is found there is only a first
  iterate.
@*/
PetscErrorCode ModelJudgeHeld(Model model, PetscReal force, PetscBool *holds)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   sum;

  PetscFunctionBeginUser;
  *holds = PETSC_TRUE;
  if (model->work->soft) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Friction(model, &sum));
  held->friction = sum > 0 ? PetscAbsReal(force) / sum : PETSC_INFINITY;
  *holds         = (PetscBool)(held->friction <= HELD_FRICTION);
  PetscCall(PetscInfo(model->snes, "a soft motion is held as by a coefficient of friction of %g%s\n",
                      (double)held->friction, *holds ? "" : ", too much"));
  if (*holds) PetscFunctionReturn(PETSC_SUCCESS);
  held->moves = (PetscBool)(++held->times <= HELD_MOVES);
  if (held->times == 1)
    held->bound = HELD_FIRST * MODEL_FARTHEST;
  else if (force * held->force > 0)
    held->bound = PetscMin(MODEL_FARTHEST, HELD_GROW * held->turn);
  else
    held->bound = held->turn / HELD_GROW;
  held->force = force;
  if (held->moves) PetscFunctionReturn(PETSC_SUCCESS);
  held->on       = PETSC_FALSE;
  held->released = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
