/* Supports that hold in some steps only, see supportphase.h. */
#include "bodies/supportphase.h"
#include "mesh/meshdofs.h"

struct _n_SupportPhase {
  Mesh        mesh;
  Scene       scene;
  PetscMPIInt rank;
  PetscInt    phase;    /* number of the step whose supports hold */
  PetscReal  *place;    /* [n_nodes*dim] where a dof was when its support came (length); else 0 */
  PetscReal  *released; /* [n_nodes*dim] force on a dof of supports that left when the phase began; the same on all
                           ranks */
  PetscReal fade;       /* part of these that acted when SupportPhaseForces() was last called */
};

/*@
  SupportPhaseCreate - prepares the state of supports that come and go.

  Not collective

  Input Parameters:
+ mesh  - borrowed
. scene - borrowed
- phase - number of the step whose supports hold

  Output Parameter:
. out - the state, in which nothing has moved or left; NULL where all supports hold all the time
@*/
PetscErrorCode SupportPhaseCreate(Mesh mesh, Scene scene, PetscInt phase, SupportPhase *out)
{
  const PetscInt n = mesh->n_nodes * mesh->dim;
  SupportPhase   s;

  PetscFunctionBeginUser;
  *out = NULL;
  if (!SceneSupportsChange(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&s));
  s->mesh  = mesh;
  s->scene = scene;
  s->phase = phase;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &s->rank));
  PetscCall(PetscCalloc2(n, &s->place, n, &s->released));
  *out = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SupportPhaseDestroy - frees the state.

  Not collective

  Input Parameter:
. s - set to NULL; may be NULL already
@*/
PetscErrorCode SupportPhaseDestroy(SupportPhase *s)
{
  PetscFunctionBeginUser;
  if (!*s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*s)->place, (*s)->released));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SupportPhaseNumber - returns the number of the step whose supports hold.

  Not collective, the same on all ranks

  Input Parameter:
. s - the state
@*/
PetscInt SupportPhaseNumber(SupportPhase s)
{
  return s ? s->phase : 0;
}

/*@
  SupportPhasePlace - returns where a dof was when its support came (length).

  Not collective

  Input Parameters:
+ s         - the state
- local_dof - number of the dof, local node times dim plus component
@*/
PetscReal SupportPhasePlace(SupportPhase s, PetscInt local_dof)
{
  return s ? s->place[local_dof] : 0;
}

/*@
  SupportPhaseTake - goes to another phase.

  Collective

  Input Parameters:
+ s      - the state
. phase  - number of the step that begins
. comes  - comes[n_nodes*dim]: a support takes hold of this dof
. u      - local displacements u[n_nodes*dim] (length)
. leaves - leaves[n_nodes*dim]: nothing holds this dof any more
- force  - force[n_nodes*dim] that supports exert on a dof, complete at every node

  Note:
  Of comes and leaves a rank's own nodes count.
@*/
PetscErrorCode SupportPhaseTake(SupportPhase s, PetscInt phase, const PetscBool *comes, const PetscReal *u,
                                const PetscBool *leaves, const PetscReal *force)
{
  const int      dim = s->mesh->dim;
  const PetscInt n   = s->mesh->n_nodes * dim;

  PetscFunctionBeginUser;
  s->phase = phase;
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool own = (PetscBool)(s->mesh->node_owner[i / dim] == s->rank);

    if (comes[i]) s->place[i] = u[i];
    s->released[i] = own && leaves[i] ? force[i] : 0;
    if (!own) s->place[i] = 0;
  }
  PetscCall(MeshSumNodes(s->mesh, dim, s->place));
  PetscCall(MeshSumNodes(s->mesh, dim, s->released));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SupportPhaseForces - subtracts the fading forces of supports that left from the residual.

  Not collective

  Input Parameters:
+ s - the state
. t - load parameter
- u - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ f      - [n_nodes*dim], from which the forces are subtracted
. energy - their potential is added
- force2 - their squares are added

  Note:
  f, energy and force2 may be NULL; each is this rank's part.
@*/
void SupportPhaseForces(SupportPhase s, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                        PetscReal *force2)
{
  if (s) s->fade = SceneStepLeft(&s->scene->stepping.steps[s->phase], t);
  if (!s || s->fade == 0) return;
  for (PetscInt i = 0; i < s->mesh->n_nodes * s->mesh->dim; i++) {
    const PetscReal force = s->fade * s->released[i];

    if (s->mesh->node_owner[i / s->mesh->dim] != s->rank) continue;
    if (f) f[i] -= force;
    if (energy) *energy -= force * u[i];
    if (force2) *force2 += PetscSqr(force);
  }
}

/*@
  SupportPhaseForce - returns the fading force of supports that left on a dof, as SupportPhaseForces() had it last.

  Not collective

  Input Parameters:
+ s         - the state
- local_dof - number of the dof, local node times dim plus component

  Note:
  It is 0 on ranks that do not own the node.
@*/
PetscReal SupportPhaseForce(SupportPhase s, PetscInt local_dof)
{
  return s && s->mesh->node_owner[local_dof / s->mesh->dim] == s->rank ? s->fade * s->released[local_dof] : 0;
}

/*@
  SupportPhaseArchive - saves or loads where supports hold and what those that left carry.

  Collective

  Input Parameters:
+ s       - the state; when it loads, of the phase that was saved
- archive - decides whether it is saved or loaded
@*/
PetscErrorCode SupportPhaseArchive(SupportPhase s, Archive archive)
{
  Hdf5Table nodes;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Hdf5TableCreate(s->mesh->comm, s->mesh->n_global, s->mesh->n_nodes, s->mesh->node_id, &nodes));
  PetscCall(ArchiveRows(archive, "supports/place", &nodes, s->mesh->dim, s->place));
  PetscCall(ArchiveRows(archive, "supports/released", &nodes, s->mesh->dim, s->released));
  PetscCall(Hdf5TableDestroy(&nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
