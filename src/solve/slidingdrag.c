/* Springs against sliding, for bodies whose soft motions are more than can be held one by one, see ModelDragSolve(). */
#include "files/archive.h"
#include "kernels/elementkernel.h"
#include "mesh/meshdofs.h"
#include "modelimpl.h"

/* What the springs hold at a solution may be what friction of this coefficient would hold. Seals that are lubricated
   have as much at least. */
#define DRAG_FRICTION 1e-2
/* In a snap each solution asks for as much as the one before. Once so many in a row have not brought the coefficient
   below this part of what it was, the load step may end with as much as dry rubber has at least, and the next ones go
   on. */
enum { DRAG_IDLE = 4 };
#define DRAG_PAYS          0.5
#define DRAG_FRICTION_FIRM 0.1
/* After so many in a row the step has failed: on a very coarse mesh the springs may ask for more than that for ever. */
enum { DRAG_MOST = 100 };

/* Volume of the bodies of this rank in the reference. */
static PetscReal Volume(const Model model)
{
  const Mesh mesh = model->mesh;
  PetscReal  X[ELEMENT_MAX_NODES * 3], volume = 0;

  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    MeshCellCoordinates(mesh, c, X);
    volume += CellVolume(mesh->cell_type[c], mesh->dim, model->scene->geometry, X);
  }
  return volume;
}

/* Area of a surface on this rank in the reference. */
static PetscReal Area(const Model model, const MeshGroup *group)
{
  const Mesh mesh = model->mesh;
  PetscInt   nodes[FACE_MAX_NODES];
  PetscReal  x[3 * FACE_MAX_NODES], sum = 0;

  for (PetscInt f = 0; f < group->n_faces; f++) {
    const ElementType type                 = MeshFaceNodes(mesh, group, f, nodes);
    const int         n                    = ElementGet(type)->nodes;
    PetscReal         part[FACE_MAX_NODES] = {0};

    MeshGatherNodes(mesh, n, nodes, mesh->coords, x);
    FaceAreaKernel(type, mesh->dim, model->scene->geometry, x, part, NULL);
    for (int a = 0; a < n; a++) sum += part[a];
  }
  return sum;
}

/* Finds the radius of a cord that has the volume of the bodies for the area of the slaves. */
static PetscErrorCode FindLength(Model model, PetscReal *length)
{
  PetscReal sum[2] = {Volume(model), 0}; /* volume, area */

  PetscFunctionBeginUser;
  for (int p = 0; p < ContactPairs(model->contact); p++) {
    const MeshGroup *slave, *other;
    PetscReal        size;
    PetscBool        known = PETSC_FALSE;

    PetscCall(ContactPairSurface(model->contact, p, &slave, &size));
    for (int k = 0; k < p; k++) {
      PetscCall(ContactPairSurface(model->contact, k, &other, &size));
      known = (PetscBool)(known || other == slave);
    }
    if (!known) sum[1] += Area(model, slave);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, model->mesh->comm));
  *length = 2 * sum[0] / sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes springs as stiff as the contact forces that were noted over the length, without force in the accepted state. */
static PetscErrorCode MakeSprings(Model model)
{
  SlidingDrag *drag    = &model->work->drag;
  const Mesh   mesh    = model->mesh;
  DofSprings  *springs = &model->problem->drag;
  PetscReal   *weight;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &weight));
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++) weight[i] = drag->force[i / mesh->dim];
  PetscCall(DofSpringsDestroy(springs));
  PetscCall(DofSpringsCreate(mesh, weight, model->x, springs));
  DofSpringsScale(*springs, 1 / drag->length);
  PetscCall(DofSpringsAnchor(*springs, model->work->accepted_x));
  PetscCall(PetscFree(weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins to count what the springs take in a load step, at the forces that they had in the accepted state. */
static PetscErrorCode BeginWork(Model model)
{
  SlidingDrag *drag = &model->work->drag;
  const Mesh   mesh = model->mesh;
  PetscReal   *pull;

  PetscFunctionBeginUser;
  if (!drag->at) PetscCall(VecDuplicate(model->x, &drag->at));
  if (!drag->pull) PetscCall(VecDuplicate(model->x, &drag->pull));
  drag->taken = 0;
  PetscCall(VecCopy(model->work->accepted_x, drag->at));
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &pull));
  if (model->balance) OuterWorkHeld(EnergyBalanceOuter(model->balance), pull);
  PetscCall(MeshLocalToGlobal(mesh, pull, drag->pull));
  PetscCall(VecScale(drag->pull, -1));
  PetscCall(PetscFree(pull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts what the springs have taken since the last solution, by the trapezoidal rule. There they may have been
   anchored anew: what they held until then drives the body on. */
static PetscErrorCode CountWork(Model model)
{
  SlidingDrag *drag = &model->work->drag;
  PetscScalar  before, now;
  Vec          force;

  PetscFunctionBeginUser;
  PetscCall(VecAYPX(drag->at, -1, model->x)); /* the way */
  PetscCall(VecDot(drag->pull, drag->at, &before));
  PetscCall(DofSpringsForces(model->problem->drag, model->x, &force));
  PetscCall(VecDot(force, drag->at, &now));
  drag->taken += PetscRealPart(before + now) / 2;
  PetscCall(VecCopy(force, drag->pull));
  PetscCall(VecCopy(model->x, drag->at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the coefficient of friction whose work over the way from the anchors is that of the springs. */
static PetscErrorCode FindFriction(Model model, PetscReal *coefficient)
{
  const SlidingDrag *drag   = &model->work->drag;
  const Mesh         mesh   = model->mesh;
  PetscReal          sum[2] = {0, 0}, *way; /* work; that of friction with a coefficient of 1 */
  Vec                stretch;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &way)); /* supports do not slide */
  PetscCall(DofSpringsStretch(model->problem->drag, model->x, &stretch));
  PetscCall(MeshGlobalToLocal(mesh, stretch, way));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < mesh->dim; d++) square += PetscSqr(way[i * mesh->dim + d]);
    sum[0] += drag->force[i] * square / drag->length;
    sum[1] += drag->force[i] * PetscSqrtReal(square);
  }
  PetscCall(PetscFree(way));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, mesh->comm));
  *coefficient = sum[1] > 0 ? sum[0] / sum[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragDestroy - frees the springs' forces.

  Not collective

  Input Parameter:
. drag - the springs
@*/
PetscErrorCode ModelDragDestroy(SlidingDrag *drag)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(drag->force));
  PetscCall(VecDestroy(&drag->at));
  PetscCall(VecDestroy(&drag->pull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragStart - lets springs against sliding take the place of held motions, from the next load step to the end of
  the run.

  Not collective, the same on all ranks

  Input Parameter:
. model - ModelMayDrag()
@*/
PetscErrorCode ModelDragStart(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInfo(model->snes, "springs against sliding take the place of held motions\n"));
  ModelReleaseHeld(model);
  model->work->hold.accepted = 0;
  model->work->hold.futile   = PETSC_FALSE;
  model->work->drag.on       = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragBegin - begins a load step with springs that have no force in the accepted state.

  Collective

  Input Parameter:
. model - its contact is that of the accepted state
@*/
PetscErrorCode ModelDragBegin(Model model)
{
  SlidingDrag *drag = &model->work->drag;

  PetscFunctionBeginUser;
  if (!drag->on) PetscFunctionReturn(PETSC_SUCCESS);
  if (!drag->force) PetscCall(PetscCalloc1(model->mesh->n_nodes, &drag->force));
  if (drag->length == 0) PetscCall(FindLength(model, &drag->length));
  PetscCall(MakeSprings(model));
  PetscCall(BeginWork(model));
  drag->idle     = 0;
  drag->least    = PETSC_INFINITY;
  drag->friction = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes whether there is any contact force from which springs may be made. */
static PetscErrorCode FindAny(Model model)
{
  SlidingDrag *drag = &model->work->drag;

  PetscFunctionBeginUser;
  drag->any = PETSC_FALSE;
  for (PetscInt i = 0; i < model->mesh->n_nodes; i++) drag->any = (PetscBool)(drag->any || drag->force[i] > 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &drag->any, sizeof(PetscBool), MPI_BYTE, MPI_BOR, model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragNote - notes the contact forces of the last residual, from which springs may be made: those of the accepted
  state, or those where held motions found no way, as places that came into contact on the way there slide, too.

  Collective

  Input Parameter:
. model - with fluids on wet places alone, if the state is accepted
@*/
PetscErrorCode ModelDragNote(Model model)
{
  SlidingDrag *drag = &model->work->drag;

  PetscFunctionBeginUser;
  if (!model->contact || model->mesh->dim < 3 || !(drag->on || ModelMayRoll(model))) PetscFunctionReturn(PETSC_SUCCESS);
  if (!drag->force) PetscCall(PetscCalloc1(model->mesh->n_nodes, &drag->force));
  PetscCall(PetscArrayzero(drag->force, model->mesh->n_nodes));
  for (int p = 0; p < ContactPairs(model->contact); p++)
    PetscCall(ContactTermForces(model->contact, p, 0, drag->force));
  PetscCall(FindAny(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragArchive - saves or loads whether there are springs, and the contact forces of the accepted state.

  Collective

  Input Parameters:
+ model   - between two steps
. archive - decides whether they are saved or loaded
- nodes   - rows of the mesh's nodes

  Note:
  Older files do not have them, nor do states in which supports held what only contact holds from then on. Springs then
  wait for the next accepted state.
@*/
PetscErrorCode ModelDragArchive(Model model, Archive archive, const Hdf5Table *nodes)
{
  SlidingDrag *drag  = &model->work->drag;
  PetscInt     on    = drag->on;
  PetscBool    there = PETSC_TRUE;
  PetscMPIInt  rank;

  PetscFunctionBeginUser;
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "model/sliding_drag", &there));
  if (!there) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(model->mesh->comm, &rank));
  PetscCall(ArchiveIntegers(archive, "model/sliding_drag", 1, &on));
  drag->on = (PetscBool)on;
  if (!model->contact || model->mesh->dim < 3 || !(drag->on || ModelMayRoll(model))) PetscFunctionReturn(PETSC_SUCCESS);
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "model/contact_force", &there));
  if (!there) PetscFunctionReturn(PETSC_SUCCESS);
  if (!drag->force) PetscCall(PetscCalloc1(model->mesh->n_nodes, &drag->force));
  if (!ArchiveLoads(archive)) PetscCall(MeshSumNodes(model->mesh, 1, drag->force)); /* rows are alike on all ranks */
  PetscCall(ArchiveRows(archive, "model/contact_force", nodes, 1, drag->force));
  for (PetscInt i = 0; i < model->mesh->n_nodes; i++)
    if (model->mesh->node_owner[i] != rank) drag->force[i] = 0;
  PetscCall(FindAny(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the load step may end with what the springs hold. */
static PetscErrorCode Judge(Model model, PetscBool *holds)
{
  SlidingDrag *drag = &model->work->drag;

  PetscFunctionBeginUser;
  PetscCall(FindFriction(model, &drag->friction));
  *holds = (PetscBool)(drag->friction <= (drag->idle >= DRAG_IDLE ? DRAG_FRICTION_FIRM : DRAG_FRICTION));
  PetscCall(PetscInfo(model->snes, "springs hold as a coefficient of friction of %g would%s\n", (double)drag->friction,
                      *holds ? "" : ", too much"));
  if (drag->friction <= DRAG_PAYS * drag->least) {
    drag->idle  = 0;
    drag->least = drag->friction;
  } else if (!*holds)
    drag->idle++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ModelDragSolve - solves by Newton's method with frozen contact lists, and where there are springs against sliding,
  until they hold no more than next to no friction would.

  Collective

  Input Parameters:
+ model  - its trial state is the first iterate
- report - costs and failures are added to it

  Notes:
  Rubber that rolls in its groove without friction slides along the walls in all motions that cost it next to nothing.
  In space there may be more of these than can be found one by one: sections roll on their own, and each of them in its
  deformed shape. Springs at the nodes in contact, as stiff as the node's contact force over the radius of the cord,
  hold all of them at once, and the tangent is far from indefinite. At a solution they are anchored where it is, if they
  hold more than a small friction would, and the step is solved on. So a body that really rolls goes on, by a bounded
  way each time, and each solve takes two or three iterations.

  On softened penalties the springs stay as they are.

  Source: the proximal point method (Rockafellar 1976).
@*/
PetscErrorCode ModelDragSolve(Model model, SolveReport *report)
{
  PetscBool holds = PETSC_FALSE;

  PetscFunctionBeginUser;
  while (!holds) {
    PetscCall(ModelNewton(model, report));
    if (!model->work->drag.on || report->result != SOLVE_CONVERGED || model->work->left || model->work->soft) break;
    PetscCall(CountWork(model));
    PetscCall(Judge(model, &holds));
    if (!holds && model->work->drag.idle >= DRAG_MOST) {
      report->result = SOLVE_ITERATIONS;
      break;
    }
    if (!holds) PetscCall(DofSpringsAnchor(model->problem->drag, model->x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
