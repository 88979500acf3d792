/* Work from outside, see outerwork.h. */
#include "solve/outerwork.h"
#include "scene/loadhistory.h"

/* What acts from outside in a state. */
typedef struct {
  PetscReal *force; /* [n_nodes*dim] of supports, loads and springs, complete at every node */
  PetscReal *held;  /* [n_nodes*dim] of what holds soft motions, complete at every node */
  PetscReal *hold;  /* [n_pairs*MOTION_COMPONENTS] of tools with prescribed motions, of all ranks */
} Outside;

struct _n_OuterWork {
  Problem      problem; /* borrowed */
  int          n_pairs;
  PetscMPIInt  rank;
  PetscBool    begun; /* there is an accepted state */
  PetscBool    holds; /* soft motions are held in the state at hand, or springs act against sliding */
  PetscReal   *u;     /* [n_nodes*dim] local displacements of that state (length) */
  Outside      now, before;
  OuterFigures figures; /* the same on all ranks */
};

/*@
  OuterWorkCreate - prepares the work on a problem, before its first state.

  Not collective

  Input Parameter:
. problem - borrowed

  Output Parameter:
. work - free it with OuterWorkDestroy()
@*/
PetscErrorCode OuterWorkCreate(Problem problem, OuterWork *work)
{
  const PetscInt n = problem->mesh->n_nodes * problem->mesh->dim;
  OuterWork      w;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  *work      = w;
  w->problem = problem;
  w->n_pairs = problem->contact ? ContactPairs(problem->contact) : 0;
  PetscCallMPI(MPI_Comm_rank(problem->mesh->comm, &w->rank));
  PetscCall(PetscCalloc3(n, &w->now.force, n, &w->now.held, w->n_pairs * MOTION_COMPONENTS, &w->now.hold));
  PetscCall(PetscCalloc1(n, &w->u));
  PetscCall(PetscCalloc3(n, &w->before.force, n, &w->before.held, w->n_pairs * MOTION_COMPONENTS, &w->before.hold));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OuterWorkDestroy - frees the work.

  Not collective

  Input Parameter:
. work - set to NULL; may be NULL already
@*/
PetscErrorCode OuterWorkDestroy(OuterWork *work)
{
  PetscFunctionBeginUser;
  if (!*work) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*work)->now.force, (*work)->now.held, (*work)->now.hold));
  PetscCall(PetscFree((*work)->u));
  PetscCall(PetscFree3((*work)->before.force, (*work)->before.held, (*work)->before.hold));
  PetscCall(PetscFree(*work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OuterWorkBegin - makes the next residual tell what holds the tools.

  Not collective

  Input Parameters:
+ work  - OuterWorkAdd() follows the residual
- holds - soft motions are held in the state, or springs act against sliding
@*/
PetscErrorCode OuterWorkBegin(OuterWork work, PetscBool holds)
{
  const Outside before = work->before;

  PetscFunctionBeginUser;
  work->before = work->now;
  work->now    = before;
  work->holds  = holds;
  PetscCall(PetscArrayzero(work->now.hold, work->n_pairs * MOTION_COMPONENTS));
  if (work->problem->contact) ContactWatchTools(work->problem->contact, work->now.hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether bodies were moved since the last accepted state, without forces, to where the step began. */
static PetscErrorCode WasMoved(const OuterWork work, const PetscReal *u_0, PetscBool *moved)
{
  const Mesh mesh = work->problem->mesh;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++) *moved = (PetscBool)(*moved || u_0[i] != work->u[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moved, sizeof(PetscBool), MPI_BYTE, MPI_BOR, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collects what acts in the state of the last residual, what contact stores, and what it was given since t_0. */
static PetscErrorCode Collect(OuterWork work, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t)
{
  const Problem  problem = work->problem;
  const Mesh     mesh    = problem->mesh;
  const PetscInt n       = mesh->n_nodes * mesh->dim;
  Outside       *now     = &work->now;
  PetscReal     *all, stored = 0, given = 0;
  ContactSummary contact = {.dissipated = NAN};
  PetscBool      moved;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &all));
  PetscCall(PetscArraycpy(all, problem->f, n));
  PetscCall(PetscArrayzero(now->force, n));
  PetscCall(LoadsResidual(problem->loads, t, u, now->force, NULL, NULL));
  PetscCall(MeshSumNodes(mesh, mesh->dim, all));
  PetscCall(MeshSumNodes(mesh, mesh->dim, now->force));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool prescribed = LoadsPrescribed(problem->loads, i);

    now->force[i] = (prescribed ? all[i] : 0) - now->force[i];
    now->held[i]  = work->holds && !prescribed ? all[i] : 0;
  }
  if (problem->contact) {
    for (PetscInt i = 0; i < n; i++) all[i] = u[i] - u_0[i];
    PetscCall(WasMoved(work, u_0, &moved));
    PetscCall(ContactStored(problem->contact, t_0, all, moved, &stored, &given));
    PetscCall(ContactSummarise(problem->contact, &contact));
  }
  PetscCall(PetscFree(all));
  PetscCallMPI(
    MPI_Allreduce(MPI_IN_PLACE, now->hold, work->n_pairs * MOTION_COMPONENTS, MPIU_REAL, MPI_SUM, mesh->comm));
  work->figures.stored = stored;
  work->figures.work += work->begun ? given : 0;
  work->figures.friction = PetscIsNanReal(contact.dissipated) ? 0 : contact.dissipated;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The work of tools with prescribed motions between two load parameters. */
static PetscReal ToolsWork(const OuterWork work, PetscReal t_0, PetscReal t)
{
  PetscReal sum = 0;

  for (int p = 0; p < work->n_pairs; p++) {
    const Motion *motion = ContactPairMotion(work->problem->contact, p);
    PetscReal     from[MOTION_COMPONENTS], to[MOTION_COMPONENTS];

    if (!motion) continue;
    MotionComponents(motion, t_0, from);
    MotionComponents(motion, t, to);
    for (int c = 0; c < MOTION_COMPONENTS; c++)
      sum += (work->before.hold[p * MOTION_COMPONENTS + c] + work->now.hold[p * MOTION_COMPONENTS + c]) / 2 *
             (to[c] - from[c]);
  }
  return sum;
}

/* Takes the first state. Its bodies carry nothing yet, so that forces of supports and tools in it are those of
   overlaps, which the first step resolves: they do no work over its length. */
static PetscErrorCode Start(OuterWork work)
{
  const PetscInt n = work->problem->mesh->n_nodes * work->problem->mesh->dim;

  PetscFunctionBeginUser;
  work->begun         = PETSC_TRUE;
  work->figures.given = work->figures.stored;
  PetscCall(PetscArrayzero(work->now.hold, work->n_pairs * MOTION_COMPONENTS));
  for (PetscInt i = 0; i < n; i++)
    if (LoadsPrescribed(work->problem->loads, i)) work->now.force[i] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OuterWorkAdd - takes an accepted state.

  Collective

  Input Parameters:
+ work  - after OuterWorkBegin() and ProblemResidual() in the state
. u_0   - local displacements u_0[n_nodes*dim] (length) of the accepted state before
. t_0   - its load parameter
. u     - local displacements of the state
. t     - its load parameter
- taken - energy that springs against sliding have taken in the step; NaN: there are none
@*/
PetscErrorCode OuterWorkAdd(OuterWork work, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                            PetscReal taken)
{
  const Mesh mesh   = work->problem->mesh;
  PetscReal  sum[2] = {0, 0}; /* from outside, by what holds */

  PetscFunctionBeginUser;
  if (work->problem->contact) ContactWatchTools(work->problem->contact, NULL);
  PetscCall(Collect(work, u_0, t_0, u, t));
  if (!work->begun) PetscCall(Start(work));
  PetscCall(PetscArraycpy(work->u, u, mesh->n_nodes * mesh->dim));
  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++) {
    if (mesh->node_owner[i / mesh->dim] != work->rank) continue;
    sum[0] += (work->before.force[i] + work->now.force[i]) / 2 * (u[i] - u_0[i]);
    sum[1] += (work->before.held[i] + work->now.held[i]) / 2 * (u[i] - u_0[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, mesh->comm));
  work->figures.work += sum[0] + ToolsWork(work, t_0, t);
  work->figures.held += PetscIsNanReal(taken) ? -sum[1] : taken;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OuterWorkHeld - gives the forces that hold soft motions in the last accepted state.

  Not collective

  Input Parameter:
. work - the work

  Output Parameter:
. force - force[n_nodes*dim] of the nodes that this rank owns, 0 elsewhere
@*/
void OuterWorkHeld(OuterWork work, PetscReal *force)
{
  const Mesh mesh = work->problem->mesh;

  for (PetscInt i = 0; i < mesh->n_nodes * mesh->dim; i++)
    force[i] = mesh->node_owner[i / mesh->dim] == work->rank ? work->now.held[i] : 0;
}

/*@
  OuterWorkGet - gives the figures of the last accepted state, the same on all ranks.

  Not collective

  Input Parameter:
. work - the work; NULL: all figures are 0
@*/
OuterFigures OuterWorkGet(OuterWork work)
{
  return work ? work->figures : (OuterFigures){0};
}

/*@
  OuterWorkArchive - saves or loads the work and the forces of the last accepted state.

  Collective

  Input Parameters:
+ work    - the work
. archive - decides whether it is saved or loaded
- u       - local displacements (length) of the accepted state
@*/
PetscErrorCode OuterWorkArchive(OuterWork work, Archive archive, const PetscReal *u)
{
  const Mesh    mesh    = work->problem->mesh;
  OuterFigures *figures = &work->figures;
  PetscReal    *value[] = {&figures->work, &figures->stored, &figures->given, &figures->friction, &figures->held};
  Hdf5Table     nodes;

  PetscFunctionBeginUser;
  PetscCall(ArchiveBoolean(archive, "model/outer_begun", &work->begun));
  PetscCall(ArchiveRealsAt(archive, "model/outer_work", PETSC_STATIC_ARRAY_LENGTH(value), value));
  PetscCall(ArchiveReals(archive, "model/outer_hold", work->n_pairs * MOTION_COMPONENTS, work->now.hold));
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_global, mesh->n_nodes, mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "model/outer_force", &nodes, mesh->dim, work->now.force));
  PetscCall(ArchiveRows(archive, "model/outer_held", &nodes, mesh->dim, work->now.held));
  PetscCall(Hdf5TableDestroy(&nodes));
  if (ArchiveLoads(archive)) PetscCall(PetscArraycpy(work->u, u, mesh->n_nodes * mesh->dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}
