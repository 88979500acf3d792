/* Soft motions that are held, see ModelHoldMotion(). */
#include "mesh/meshdofs.h"
#include "mesh/pressurenodes.h"
#include "modelimpl.h"

/* What holds motions may be what friction of this coefficient at the surfaces in contact would hold. The least that is
   measured between lubricated solids is about as much; seals have 0.01 to 1. */
#define HELD_FRICTION 1e-3
/* In space a move changes which lumps of the mesh hold the sections and where single cells stand at an edge, and
   Newton's method may find no way from there. Once a load step has failed that moved motions on, they stay unless they
   take as much as dry rubber has at least. */
#define HELD_FRICTION_FIRM 0.1
/* The same holds for the rest of a load step once moves do not pay: Newton's method has taken more than so many steps
   from one to the next solution, or so many moves in a row have not brought the coefficient below this part of what it
   was. The next lumps hold as much then, and moves would go on among them. In later load steps one such move is enough.
 */
enum { HELD_DEAR = 8, HELD_IDLE = 6 };
#define HELD_PAYS 0.5
/* What takes more than that moves on, at first so far that it turns cells by this part of MODEL_FARTHEST. The next move
   may be as much longer if the force keeps its sign, and is as much shorter if it has changed. */
#define HELD_FIRST 0.25
#define HELD_GROW  2.0
/* Moves in a load step until the motion is released */
enum { HELD_MOVES = 40 };

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

/* Adds to the step y a part along the motions that goes down the force that holds them, as far as cells may turn. It is
   Newton's step along them, but for those whose stiffness is below 0: along these it goes the other way. */
static PetscErrorCode MoveOn(Model model, Vec y)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   along, turn;
  Vec         z;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &z));
  PetscCall(VecZeroEntries(z));
  for (int i = 0; i < held->n; i++) {
    PetscCall(VecDotRealPart(held->last, held->w[i], &along));
    PetscCall(VecAXPY(z, along / PetscAbsReal(held->compliance[i]), held->w[i]));
  }
  PetscCall(TurnOf(model, model->x, z, &turn));
  held->turn = PetscMin(turn, held->bound);
  PetscCall(VecAXPY(y, turn > 0 ? held->turn / turn : 0, z));
  PetscCall(PetscInfo(model->snes, "the motion moves on: turns cells by %g of %g\n", (double)held->turn, (double)turn));
  PetscCall(VecDestroy(&z));
  held->moves  = PETSC_FALSE;
  held->moving = PETSC_TRUE;
  held->steps  = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHoldInStep - takes the motions that are held out of a linear step.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the step's start
- y     - the step (length)

  Output Parameter:
. y - without the motions, or with a bounded part of them where they are to move on; unchanged where none is held
@*/
PetscErrorCode ModelHoldInStep(Model model, Vec y)
{
  HeldMotion *held = &model->work->hold;

  PetscFunctionBeginUser;
  if (held->wanted && !held->ready) PetscCall(ModelHeldRefresh(model, y));
  held->ready  = PETSC_FALSE;
  held->moving = PETSC_FALSE;
  if (!held->wanted) PetscFunctionReturn(PETSC_SUCCESS);
  held->steps++;
  PetscCall(ModelHeldTakeOut(model, y));
  if (held->moves) PetscCall(MoveOn(model, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHoldInColumns - takes the motions that are held out of columns of the factor.

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
  if (!model->work->hold.wanted) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetSize(Z, NULL, &m));
  for (PetscInt j = 0; j < m; j++) {
    PetscCall(MatDenseGetColumnVecWrite(Z, j, &z));
    PetscCall(ModelHeldTakeOut(model, z));
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
  return (PetscBool)(model->scene->solver.hold_rolling && !model->work->drag.on && model->problem->bodies &&
                     !ProblemIsPlastic(model->problem) && !ContactHasFriction(model->contact));
}

/*@
  ModelMayDrag - says whether springs against sliding may take the place of held motions: a body in space rolls on its
  own, motions were held in the solve at hand, and contact has forces in the accepted state, of which springs are
  made.

  Not collective

  Input Parameter:
. model - the model
@*/
PetscBool ModelMayDrag(Model model)
{
  const HeldMotion *held = &model->work->hold;

  return (PetscBool)(model->contact && model->mesh->dim == 3 && model->work->drag.any && !model->work->shift.on &&
                     ModelMayRoll(model) && (held->wanted || held->released || held->futile));
}

/* Decides whether the softest motion is held, as it alone spoils the step y: the rest turns no cell too far. Either the
   step does, or its stiffness is below 0 and the rest leads downhill. */
static PetscErrorCode HoldSoftest(Model model, Vec x, Vec F, Vec y, PetscReal turn)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   stiffness, part, rest, downhill;
  PetscBool   spoils;
  Vec         r;

  PetscFunctionBeginUser;
  PetscCall(ModelHeldAdd(model, y, &stiffness, &part));
  PetscCall(VecDuplicate(y, &r));
  PetscCall(VecWAXPY(r, -part, held->b[0], y));
  PetscCall(TurnOf(model, x, r, &rest));
  PetscCall(VecDotRealPart(F, r, &downhill));
  PetscCall(VecDestroy(&r));
  /* pressures of nodes have slopes of their own */
  spoils = (PetscBool)(rest <= MODEL_FARTHEST &&
                       ((stiffness < 0 && (model->mesh->saddle || downhill >= 0)) || turn > MODEL_FARTHEST));
  if (!spoils) held->n = 0;
  held->wanted = held->known = held->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Holds more motions, always the softest of those that are left, until the rest of the step y turns no cell too far. If
   it still does with HELD_MOST of them, they are not what spoils the step, and nothing changes. */
static PetscErrorCode HoldMore(Model model, Vec x, Vec y)
{
  HeldMotion *held  = &model->work->hold;
  const int   first = held->n;
  PetscReal   before, turn, stiffness, part;
  Vec         r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &r));
  PetscCall(VecCopy(y, r));
  PetscCall(ModelHeldTakeOut(model, r));
  PetscCall(TurnOf(model, x, r, &before));
  turn = before;
  for (int i = first; turn > MODEL_FARTHEST && i < HELD_MOST && held->n == i; i++) {
    PetscCall(ModelHeldAdd(model, r, &stiffness, &part));
    PetscCall(VecCopy(y, r));
    PetscCall(ModelHeldTakeOut(model, r));
    PetscCall(TurnOf(model, x, r, &turn));
  }
  PetscCall(VecDestroy(&r));
  if (held->n > first)
    PetscCall(PetscInfo(model->snes, "with %d soft motions held besides %d a step turns cells by %g instead of %g\n",
                        held->n - first, first, (double)turn, (double)before));
  held->futile = (PetscBool)(turn > MODEL_FARTHEST);
  if (held->futile) held->n = first;
  held->wanted = held->known = held->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHoldMotion - decides whether soft motions of bodies that contact alone holds are held from now on.

  Collective

  Input Parameters:
+ model - after a solve with the tangent at the iterate; ModelMayRoll()
. x     - the iterate
. F     - its residual
. y     - Newton's step: it leads to x - y (length)
- near  - an equilibrium is near, so that short steps are right whether they lead uphill or not

  Notes:
  Rubber that can roll along walls without friction has motions that are softer than all others by orders of magnitude:
  one in the plane, and in space as many as sections of the body can roll on their own, in waves along it. What drives
  them is of the order of the errors of the mesh, and so is their stiffness, which changes its sign with each node that
  passes an edge. Newton's steps along them are arbitrary. Where a step goes too far or the tangent is indefinite, and
  it is the softest motion that does it, that is held: the rest is solved for as if the body could not go along it.
  Where in space the rest still goes too far, so are further ones, until it does not. What that takes is a force. It
  stays if next to no friction would hold as much, else the motions move on down that force, see ModelJudgeHeld(). This
  needs a factor.
@*/
PetscErrorCode ModelHoldMotion(Model model, Vec x, Vec F, Vec y, PetscBool near)
{
  HeldMotion *held = &model->work->hold;
  PetscReal   turn, slope;
  PetscBool   direct;

  PetscFunctionBeginUser;
  if (held->released || (held->wanted && model->mesh->dim < 3)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinearSolverDirect(model->work->solver, &direct));
  if (!direct) PetscFunctionReturn(PETSC_SUCCESS);
  if (held->wanted) {
    PetscCall(ModelHeldRefresh(model, y));
    held->ready = PETSC_TRUE;
  } else {
    held->n = 0;
    PetscCall(TurnOf(model, x, y, &turn));
    PetscCall(VecDotRealPart(F, y, &slope));
    if (turn <= MODEL_FARTHEST && (near || slope >= 0)) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(HoldSoftest(model, x, F, y, turn));
    held->ready = PETSC_TRUE;
  }
  if (model->mesh->dim == 3 && !held->futile) PetscCall(HoldMore(model, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelHeldResidual - finds what is left of a residual without the force that holds motions.

  Collective

  Input Parameters:
+ model - the model
. F     - the residual (force)
- norm  - of F

  Output Parameters:
+ norm  - of what is left
- force - that is held; 0 where no motion is
@*/
PetscErrorCode ModelHeldResidual(Model model, Vec F, PetscReal *norm, PetscReal *force)
{
  HeldMotion *held   = &model->work->hold;
  PetscReal   square = 0;

  PetscFunctionBeginUser;
  *force = 0;
  if (!held->known) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < held->known; i++) {
    PetscCall(VecDotRealPart(F, held->b[i], &held->force[i]));
    square += PetscSqr(held->force[i]);
  }
  *force = PetscSqrtReal(square);
  *norm  = PetscSqrtReal(PetscMax(0, PetscSqr(*norm) - square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelReleaseHeld - releases the motions that are held, for the rest of the load step.

  Not collective

  Input Parameter:
. model - the model
@*/
void ModelReleaseHeld(Model model)
{
  HeldMotion *held = &model->work->hold;

  held->wanted = held->known = held->n = 0;
  held->moving                         = PETSC_FALSE;
  held->released                       = PETSC_TRUE;
}

/* Notes whether moves in space pay. */
static void WeighMoves(Model model, HeldMotion *held)
{
  const PetscBool pays = (PetscBool)(held->rested || held->friction <= HELD_PAYS * held->least);

  if (model->mesh->dim < 3 || held->friction <= HELD_FRICTION) return;
  held->idle = pays ? 0 : held->idle + 1;
  if (pays) held->least = held->friction;
  if ((!held->rested && held->steps > HELD_DEAR) || held->idle >= (held->dull ? 1 : HELD_IDLE) ||
      held->times >= HELD_MOVES)
    held->stays = held->dull = PETSC_TRUE;
}

/* Bounds the next move. It may be longer than the last one if the force has not turned since, and is shorter if it
   has. Where the force was small enough in between, its direction says nothing of the last move. */
static PetscErrorCode BoundMove(HeldMotion *held)
{
  PetscReal along = 0;
  Vec       force;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(held->b[0], &force));
  PetscCall(VecZeroEntries(force));
  for (int i = 0; i < held->known; i++) PetscCall(VecAXPY(force, held->force[i], held->b[i]));
  held->bound = 0;
  if (held->times > 1) {
    PetscCall(VecDotRealPart(force, held->last, &along));
    held->bound = along > 0 ? PetscMin(MODEL_FARTHEST, HELD_GROW * held->turn) : held->turn / HELD_GROW;
  }
  if (held->rested) held->bound = PetscMax(held->bound, HELD_FIRST * MODEL_FARTHEST);
  PetscCall(VecDestroy(&held->last));
  held->last = force;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelJudgeHeld - judges the force that holds motions. If that is too much, they move on in the next step, and after
  some moves they are released for the rest of the load step.

  Collective

  Input Parameter:
. model - at a solution with motions held, after ModelHeldResidual()

  Output Parameter:
. holds - they may stay as they are

  Note:
  On softened penalties they stay. These hold a body where the full ones do not, and what is found there is only a first
  iterate.
@*/
PetscErrorCode ModelJudgeHeld(Model model, PetscBool *holds)
{
  HeldMotion *held = &model->work->hold;

  PetscFunctionBeginUser;
  *holds = PETSC_TRUE;
  if (model->work->soft) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelHeldFriction(model, &held->friction));
  WeighMoves(model, held);
  *holds = (PetscBool)(held->friction <= (held->firm || held->stays ? HELD_FRICTION_FIRM : HELD_FRICTION));
  PetscCall(PetscInfo(model->snes, "%d soft motions are held as by a coefficient of friction of %g%s\n", held->known,
                      (double)held->friction, *holds ? "" : ", too much"));
  if (!*holds) {
    held->moves = (PetscBool)(++held->times <= HELD_MOVES);
    PetscCall(BoundMove(held));
  }
  held->rested = *holds;
  if (!*holds && !held->moves) ModelReleaseHeld(model);
  PetscFunctionReturn(PETSC_SUCCESS);
}
