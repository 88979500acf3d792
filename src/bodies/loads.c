/* Loads, supports and imposed displacements, see loads.h. */
#include <math.h>
#include "kernels/elementkernel.h"
#include "bodies/loads.h"
#include "base/refusal.h"

/* Stands in the place of a load's index where the axisymmetric geometry itself holds u_r on the axis. */
enum { LOADS_AXIS = 0x7fffffff };
/* A node is on the axis if it is within this fraction of the model's size from r = 0. */
#define LOADS_ON_AXIS 1e-9

/* A dof that a support or an imposed displacement holds: u = value * history. A support has the value 0 and no history.
 */
typedef struct {
  PetscInt       dof;
  PetscReal      value;
  const History *history;
  int            load; /* index into scene->loads, or -1 - index into scene->supports, or LOADS_AXIS: for messages */
} Prescribed;

/* A dead load: its nodal forces for factor 1, assembled once */
typedef struct {
  PetscInt       n, *dof;
  PetscReal     *force, force2; /* force2: sum of squares of the unassembled nodal forces */
  const History *history;
} DeadLoad;

typedef struct {
  const MeshGroup *group;
  PetscReal        pressure;
  const History   *history;
} FollowerLoad;

struct _n_Loads {
  Mesh          mesh;
  Scene         scene;
  PetscBool    *constrained; /* n_nodes*dim */
  PetscInt      n_prescribed;
  Prescribed   *prescribed;
  PetscInt      n_dead, n_follower;
  DeadLoad     *dead;
  FollowerLoad *follower;
  PetscLogEvent event_follower; /* where there is a follower load */
  PetscInt     *owner;          /* while it is made: by dof, who prescribes it */
  PetscReal    *dense;          /* while it is made: nodal forces of one load */
};

static PetscReal HistoryFactor(const History *history, PetscReal t)
{
  return history ? HistoryValue(history, t) : 0;
}

/* Tells whether two rules for one dof say the same at every t, so that having both does no harm. */
static PetscBool PrescribedAgree(const Prescribed *a, const Prescribed *b)
{
  if (a->value == 0 && b->value == 0) return PETSC_TRUE;
  if (a->value != b->value || !a->history || !b->history || a->history->n != b->history->n) return PETSC_FALSE;
  for (int i = 0; i < a->history->n; i++)
    if (a->history->t[i] != b->history->t[i] || a->history->v[i] != b->history->v[i]) return PETSC_FALSE;
  return PETSC_TRUE;
}

static const char *PrescribedPath(Scene scene, const Prescribed *p)
{
  if (p->load == LOADS_AXIS) return "the axisymmetric geometry (u_x = 0 on x = 0)";
  return p->load >= 0 ? scene->loads[p->load].path : scene->supports[-1 - p->load].path;
}

/* Adds the rule for one dof. A second rule for the dof must say the same, else the complaint names both. */
static PetscErrorCode LoadsAddDof(Loads loads, PetscInt dof, PetscReal value, const History *history, int load,
                                  PetscInt *owner, char *complaint, size_t size)
{
  const Mesh       mesh = loads->mesh;
  const int        dim  = mesh->dim;
  const Prescribed p    = {dof, value, history, load};

  PetscFunctionBeginUser;
  if (owner[dof] >= 0) {
    const Prescribed *q = &loads->prescribed[owner[dof]];

    if (!PrescribedAgree(&p, q) && !complaint[0]) {
      PetscCall(PetscSNPrintf(complaint, size,
                              "%s: u%c of node %" PetscInt_FMT
                              " is prescribed differently by %s; allowed: one value for each component of a node (part "
                              "the surfaces, or drop one of the two)",
                              SceneWhere(loads->scene, PrescribedPath(loads->scene, &p), NULL), "xyz"[dof % dim],
                              mesh -> node_tag[dof / dim], PrescribedPath(loads->scene, q)));
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  owner[dof]                               = loads->n_prescribed;
  loads->constrained[dof]                  = PETSC_TRUE;
  loads->prescribed[loads->n_prescribed++] = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadsAddPrescribed(Loads loads, const MeshGroup *group, int component, PetscReal value,
                                         const History *history, int load, PetscInt *owner, char *complaint,
                                         size_t size)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < group->n_nodes; i++)
    PetscCall(
      LoadsAddDof(loads, group->nodes[i] * loads->mesh->dim + component, value, history, load, owner, complaint, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadsCreatePrescribed(Loads loads)
{
  Mesh       mesh  = loads->mesh;
  Scene      scene = loads->scene;
  PetscInt   n     = mesh->n_nodes * mesh->dim;
  MeshGroup *group;
  char       complaint[512] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &loads->constrained, n, &loads->prescribed));
  PetscCall(PetscMalloc1(n, &loads->owner));
  for (PetscInt i = 0; i < n; i++) {
    loads->constrained[i] = PETSC_FALSE;
    loads->owner[i]       = -1;
  }
  for (PetscInt node = 0; node < mesh->n_nodes && scene->geometry == GEOMETRY_AXISYMMETRIC; node++)
    if (mesh->coords[node * mesh->dim] + mesh->centre[0] <= LOADS_ON_AXIS * mesh->size)
      PetscCall(LoadsAddDof(loads, node * mesh->dim, 0, NULL, LOADS_AXIS, loads->owner, complaint, sizeof(complaint)));
  for (int s = 0; s < scene->n_supports; s++) {
    const SceneSupport *support = &scene->supports[s];

    PetscCall(MeshGetGroup(mesh, scene, support->path, "surface", support->surface, mesh->dim - 1, &group));
    for (int c = 0; c < mesh->dim; c++)
      if (support->fixed[c])
        PetscCall(LoadsAddPrescribed(loads, group, c, 0, NULL, -1 - s, loads->owner, complaint, sizeof(complaint)));
  }
  for (int l = 0; l < scene->n_loads; l++) {
    const SceneLoad *load = &scene->loads[l];

    if (load->kind != LOAD_DISPLACEMENT) continue;
    PetscCall(MeshGetGroup(mesh, scene, load->path, "surface", load->region, mesh->dim - 1, &group));
    for (int c = 0; c < mesh->dim; c++)
      if (load->has[c])
        PetscCall(LoadsAddPrescribed(loads, group, c, load->value[c], &load->history, l, loads->owner, complaint,
                                     sizeof(complaint)));
  }
  PetscCall(PetscFree(loads->owner));
  PetscCall(RefuseInputAnywhere(mesh->comm, complaint[0] ? complaint : NULL));
  PetscCall(MeshSetConstraints(mesh, loads->constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the nodal forces of one face or cell for factor 1 to the dense work vector. */
static void DeadLoadAdd(Mesh mesh, PetscInt n, const PetscInt *nodes, const double *fe, PetscReal *dense,
                        PetscReal *force2)
{
  for (PetscInt a = 0; a < n; a++) {
    for (int d = 0; d < mesh->dim; d++) {
      dense[nodes[a] * mesh->dim + d] += fe[a * mesh->dim + d];
      *force2 += PetscSqr(fe[a * mesh->dim + d]);
    }
  }
}

static PetscErrorCode DeadLoadSurface(Loads loads, const SceneLoad *load, const MeshGroup *group, PetscReal *dense,
                                      PetscReal *force2)
{
  Mesh     mesh = loads->mesh;
  PetscInt nodes[FACE_MAX_NODES];
  double   X[FACE_MAX_NODES * 3], zero[FACE_MAX_NODES * 3] = {0}, fe[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < group->n_faces; f++) {
    const ElementType type = MeshFaceNodes(mesh, group, f, nodes);
    const int         n    = ElementGet(type)->nodes;

    MeshGatherNodes(mesh, n, nodes, mesh->coords, X);
    PetscCall(PetscArrayzero(fe, n * mesh->dim));
    FaceLoadKernel(type, mesh->dim, loads->scene->geometry,
                   load->kind == LOAD_TRACTION ? FACE_TRACTION : FACE_DEAD_PRESSURE, X, zero, load->value, fe, NULL,
                   NULL);
    DeadLoadAdd(mesh, n, nodes, fe, dense, force2);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeadLoadVolume(Loads loads, const SceneLoad *load, PetscReal *dense, PetscReal *force2)
{
  Mesh   mesh  = loads->mesh;
  Scene  scene = loads->scene;
  int    body  = MeshFindBody(scene, load->region, PETSC_FALSE);
  double X[ELEMENT_MAX_NODES * 3], fe[ELEMENT_MAX_NODES * 3];

  PetscFunctionBeginUser;
  if (body < 0)
    PetscCall(RefuseInput(mesh->comm, "%s: no deformable body named '%s'; allowed: a volume listed in bodies",
                          SceneWhere(scene, load->path, "volume"), load->region));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
    const int       n     = ElementGet(mesh->cell_type[c])->nodes;

    if (mesh->cell_body[c] != body) continue;
    MeshCellCoordinates(mesh, c, X);
    PetscCall(PetscArrayzero(fe, n * mesh->dim));
    BodyForceKernel(mesh->cell_type[c], mesh->dim, scene->geometry, X, load->value, fe);
    DeadLoadAdd(mesh, n, nodes, fe, dense, force2);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeadLoadPack(const PetscReal *dense, PetscInt n, DeadLoad *dead)
{
  PetscInt count = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) count += dense[i] != 0;
  PetscCall(PetscMalloc2(count, &dead->dof, count, &dead->force));
  for (PetscInt i = 0; i < n; i++) {
    if (dense[i] == 0) continue;
    dead->dof[dead->n]     = i;
    dead->force[dead->n++] = dense[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool LoadFollows(Scene scene, const SceneLoad *load)
{
  return (PetscBool)(load->kind == LOAD_PRESSURE && load->follower && scene->kinematics == KINEMATICS_FINITE);
}

static PetscErrorCode LoadsCreateForces(Loads loads)
{
  Mesh       mesh  = loads->mesh;
  Scene      scene = loads->scene;
  PetscInt   n = mesh->n_nodes * mesh->dim, followers = 0;
  MeshGroup *group;

  PetscFunctionBeginUser;
  for (int l = 0; l < scene->n_loads; l++) followers += LoadFollows(scene, &scene->loads[l]);
  if (followers) PetscCall(PetscLogEventRegister("LoadsFollower", SNES_CLASSID, &loads->event_follower));
  PetscCall(PetscCalloc2(scene->n_loads, &loads->dead, followers, &loads->follower));
  PetscCall(PetscMalloc1(n, &loads->dense));
  for (int l = 0; l < scene->n_loads; l++) {
    const SceneLoad *load = &scene->loads[l];
    DeadLoad        *dead = &loads->dead[loads->n_dead];

    if (load->kind == LOAD_DISPLACEMENT) continue;
    if (load->kind != LOAD_BODY_FORCE)
      PetscCall(MeshGetGroup(mesh, scene, load->path, "surface", load->region, mesh->dim - 1, &group));
    if (LoadFollows(scene, load)) {
      loads->follower[loads->n_follower++] = (FollowerLoad){group, load->value[0], &load->history};
      continue;
    }
    PetscCall(PetscArrayzero(loads->dense, n));
    if (load->kind == LOAD_BODY_FORCE)
      PetscCall(DeadLoadVolume(loads, load, loads->dense, &dead->force2));
    else
      PetscCall(DeadLoadSurface(loads, load, group, loads->dense, &dead->force2));
    PetscCall(DeadLoadPack(loads->dense, n, dead));
    dead->history = &load->history;
    loads->n_dead++;
  }
  PetscCall(PetscFree(loads->dense));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsCreate - reads supports, loads and imposed displacements of the scene, refuses contradictions, and sets the
  mesh's sections.

  Collective

  Input Parameters:
+ mesh  - the mesh; borrowed
- scene - the scene; borrowed

  Output Parameter:
. out - free it with LoadsDestroy()

  Note:
  Supported and imposed dofs become constraints of the mesh's local section. Call it before any matrix or vector is
  made. It refuses two rules for one component of a node that do not agree.
@*/
PetscErrorCode LoadsCreate(Mesh mesh, Scene scene, Loads *out)
{
  Loads loads;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&loads));
  *out         = loads; /* LoadsDestroy() frees what a refusal leaves */
  loads->mesh  = mesh;
  loads->scene = scene;
  PetscCall(LoadsCreatePrescribed(loads));
  PetscCall(LoadsCreateForces(loads));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsDestroy - frees the loads.

  Collective

  Input Parameter:
. loads - set to NULL
@*/
PetscErrorCode LoadsDestroy(Loads *loads)
{
  PetscFunctionBeginUser;
  if (!*loads) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 0; l < (*loads)->n_dead; l++) PetscCall(PetscFree2((*loads)->dead[l].dof, (*loads)->dead[l].force));
  PetscCall(PetscFree2((*loads)->dead, (*loads)->follower));
  PetscCall(PetscFree2((*loads)->constrained, (*loads)->prescribed));
  PetscCall(PetscFree((*loads)->owner));
  PetscCall(PetscFree((*loads)->dense));
  PetscCall(PetscFree(*loads));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsPrescribe - writes the supported and imposed displacements at a load parameter into the displacements.

  Not collective

  Input Parameters:
+ loads - the loads
- t     - load parameter

  Output Parameter:
. u - local displacements (length) [n_nodes*dim], of which only the prescribed ones are written
@*/
PetscErrorCode LoadsPrescribe(Loads loads, PetscReal t, PetscReal *u)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < loads->n_prescribed; i++)
    u[loads->prescribed[i].dof] = loads->prescribed[i].value * HistoryFactor(loads->prescribed[i].history, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FollowerFace(Loads loads, const FollowerLoad *load, PetscInt f, PetscReal t, const PetscReal *u,
                                   PetscInt *nodes, int *n, double *fe, double *ke)
{
  Mesh              mesh = loads->mesh;
  const ElementType type = MeshFaceNodes(mesh, load->group, f, nodes);
  double X[FACE_MAX_NODES * 3], v[FACE_MAX_NODES * 3], pressure = load->pressure * HistoryValue(load->history, t);

  PetscFunctionBeginUser;
  *n = ElementGet(type)->nodes;
  MeshGatherNodes(mesh, *n, nodes, mesh->coords, X);
  MeshGatherNodes(mesh, *n, nodes, u, v);
  PetscCall(PetscArrayzero(fe, *n * mesh->dim));
  if (ke) PetscCall(PetscArrayzero(ke, PetscSqr(*n * mesh->dim)));
  FaceLoadKernel(type, mesh->dim, loads->scene->geometry, FACE_FOLLOWER_PRESSURE, X, v, &pressure, fe, ke, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsResidual - subtracts the external forces from the residual.

  Not collective

  Input Parameters:
+ loads - the loads
. t     - load parameter
- u     - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ f      - [n_nodes*dim], from which the external forces are subtracted
. energy - the potential of the dead loads is added
- force2 - the squares of the unassembled forces are added

  Note:
  f, energy and force2 may be NULL; each is this rank's part.
@*/
PetscErrorCode LoadsResidual(Loads loads, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy,
                             PetscReal *force2)
{
  const int dim = loads->mesh->dim;
  PetscInt  nodes[FACE_MAX_NODES];
  double    fe[FACE_MAX_NODES * 3];
  int       n;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < loads->n_dead; l++) {
    const DeadLoad *dead   = &loads->dead[l];
    const PetscReal factor = HistoryValue(dead->history, t);

    for (PetscInt i = 0; i < dead->n; i++) {
      if (f) f[dead->dof[i]] -= factor * dead->force[i];
      if (energy) *energy -= factor * dead->force[i] * u[dead->dof[i]];
    }
    if (force2) *force2 += PetscSqr(factor) * dead->force2;
  }
  if (!loads->n_follower || !(f || force2)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(loads->event_follower, 0, 0, 0, 0));
  for (PetscInt l = 0; l < loads->n_follower; l++) {
    for (PetscInt face = 0; face < loads->follower[l].group->n_faces; face++) {
      PetscCall(FollowerFace(loads, &loads->follower[l], face, t, u, nodes, &n, fe, NULL));
      for (int i = 0; i < n * dim; i++) {
        if (f) f[nodes[i / dim] * dim + i % dim] -= fe[i];
        if (force2) *force2 += PetscSqr(fe[i]);
      }
    }
  }
  PetscCall(PetscLogEventEnd(loads->event_follower, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsTangent - adds the follower loads' part of the tangent to the local block CSR of the elasticity.

  Not collective

  Input Parameters:
+ loads      - the loads
. t          - load parameter
. u          - local displacements (length) [n_nodes*dim]
- elasticity - after ElasticityTangent()
@*/
PetscErrorCode LoadsTangent(Loads loads, PetscReal t, const PetscReal *u, Elasticity elasticity)
{
  PetscInt nodes[FACE_MAX_NODES];
  double   fe[FACE_MAX_NODES * 3], ke[FACE_MAX_NODES * 3 * FACE_MAX_NODES * 3];
  int      n;

  PetscFunctionBeginUser;
  if (!loads->n_follower) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(loads->event_follower, 0, 0, 0, 0));
  for (PetscInt l = 0; l < loads->n_follower; l++) {
    for (PetscInt face = 0; face < loads->follower[l].group->n_faces; face++) {
      PetscCall(FollowerFace(loads, &loads->follower[l], face, t, u, nodes, &n, fe, ke));
      PetscCall(ElasticityAddBlock(elasticity, n, nodes, ke));
    }
  }
  PetscCall(PetscLogEventEnd(loads->event_follower, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsConservative - tells whether the loads have a potential.

  Not collective

  Input Parameter:
. loads - the loads

  Note:
  It returns the same on all ranks. Follower pressures have no potential in general.
@*/
PetscBool LoadsConservative(Loads loads)
{
  return loads->n_follower ? PETSC_FALSE : PETSC_TRUE;
}

/*@
  LoadsPrescribed - tells whether a local dof is supported or imposed.

  Not collective

  Input Parameters:
+ loads     - the loads
- local_dof - number of the dof, local node times dim plus component

  Note:
  A group counts if this rank sees it.
@*/
PetscBool LoadsPrescribed(Loads loads, PetscInt local_dof)
{
  return loads->constrained[local_dof];
}

/*@
  LoadsRigidMotion - gives the place of a point of a rigid body at a load parameter.

  Not collective

  Input Parameters:
+ loads - the loads
. body  - index into the scene's bodies
. t     - load parameter
- X     - the point at t = 0, relative to the mesh's centre, 3 components (the third is 0 in 2D)

  Output Parameter:
. x - its place at t, in the same coordinates

  Note:
  The motion is a translation of the body's point and a rotation about it by the vector (rx, ry, rz). Each component is
  a value times its history.
@*/
void LoadsRigidMotion(Loads loads, int body, PetscReal t, const PetscReal X[3], PetscReal x[3])
{
  const PetscReal *centre = loads->mesh->centre;
  double           absolute[3], moved[3];

  for (int d = 0; d < 3; d++) absolute[d] = X[d] + centre[d];
  MotionPlace(&loads->scene->bodies[body].motion, t, absolute, moved);
  for (int d = 0; d < 3; d++) x[d] = X[d] + (moved[d] - absolute[d]);
}

/*@
  LoadsRigidTravel - returns the largest distance between the positions of a rigid body's nodes at two load parameters.

  Not collective

  Input Parameters:
+ loads - the loads
. body  - index into the scene's bodies
. t0    - load parameter
- t1    - load parameter

  Note:
  For the search distance. It is the same on all ranks.
@*/
PetscReal LoadsRigidTravel(Loads loads, int body, PetscReal t0, PetscReal t1)
{
  const MeshRigid *rigid = MeshFindRigid(loads->mesh, loads->scene->bodies[body].name);
  PetscReal        most  = 0;

  for (PetscInt n = 0; n < rigid->n_nodes; n++) {
    PetscReal X[3] = {0, 0, 0}, a[3], b[3];

    for (int d = 0; d < loads->mesh->dim; d++) X[d] = rigid->coords[n * loads->mesh->dim + d];
    LoadsRigidMotion(loads, body, t0, X, a);
    LoadsRigidMotion(loads, body, t1, X, b);
    most = PetscMax(most, PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2])));
  }
  return most;
}
