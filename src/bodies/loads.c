/* Loads, supports and imposed displacements, see loads.h. */
#include <math.h>
#include "enclosedbodies.h"
#include "kernels/elementkernel.h"
#include "bodies/foundation.h"
#include "bodies/loads.h"
#include "bodies/loadvalues.h"
#include "bodies/supportphase.h"
#include "bodies/tools.h"
#include "mesh/pressurenodes.h"
#include "base/refusal.h"

/* Stands in the place of a load's index where the axisymmetric geometry itself holds u_r on the axis. */
enum { LOADS_AXIS = 0x7fffffff };
/* A node is on the axis if it is within this fraction of the model's size from r = 0. A surface is there if its area is
   within this fraction of the square of that size. */
#define LOADS_ON_AXIS 1e-9
/* Two expressions for one dof agree if they differ by no more than this part of the largest value of either. It stands
   for the round-off of expressions that say the same in other words. */
#define LOADS_AGREE 1e-10
/* Expressions with t are evaluated at the ends of this many intervals of the load parameter before the run. Values that
   are not finite are mostly found then. Two rules for one dof are compared there. */
enum { LOADS_SAMPLES = 16 };

/* A dof that a support or an imposed displacement holds: u = value * history. A support has the value 0 and no history.
   An expression with t has no history, and value is that at loads->t. A support of some steps adds the shift from its
   value to where the dof was when it came. An expression of its takes the shift back evenly over its first step. */
typedef struct {
  PetscInt         dof;
  PetscReal        value, shift;
  const History   *history;
  const SceneSpan *during; /* of a support of some steps; else NULL */
  int              load; /* index into scene->loads, or -1 - index into scene->supports, or LOADS_AXIS: for messages */
  PetscBool        varies;  /* an expression with t */
  PetscReal        largest; /* of an expression: its largest value on the surface, of all ranks; else 0 */
} Prescribed;

/* The part of a surface on which its pressure acts; both are NULL where it acts everywhere. */
typedef struct {
  const PetscReal *nodes;  /* FACE_MAX_NODES for each face: factor on the face's force on each of its nodes */
  const PetscReal *points; /* FACE_MAX_POINTS for each face: factor on the pressure */
} LoadShares;

/* A dead load: its nodal forces for factor 1, assembled once; where it varies, those at loads->t */
typedef struct {
  const SceneLoad *load;
  const MeshGroup *group; /* NULL for a body force */
  PetscInt         n, *dof;
  PetscReal       *force, force2; /* force2: sum of squares of the unassembled nodal forces */
  const History   *history;       /* NULL where it varies */
  LoadShares       shares;
  PetscReal        area;  /* of a force: area of the group's faces, of all ranks */
  PetscInt         nodes; /* of a force on a group without area: its nodes, of all ranks */
} DeadLoad;

typedef struct {
  const SceneLoad *load;
  const MeshGroup *group;
  PetscReal       *value;   /* of an expression: FACE_MAX_POINTS for each face; else NULL */
  const History   *history; /* NULL where it varies */
  LoadShares       shares;
} FollowerLoad;

struct _n_Loads {
  Mesh          mesh;
  Scene         scene;
  PetscBool    *constrained; /* n_nodes*dim */
  PetscInt      n_prescribed;
  Prescribed   *prescribed;
  PetscInt      n_dead, n_follower;
  Foundation    foundation; /* NULL: no support has springs */
  SupportPhase  phase;      /* NULL: all supports hold all the time */
  DeadLoad     *dead;
  FollowerLoad *follower;
  PetscLogEvent event_follower; /* where there is a follower load */
  PetscBool     varies;         /* some value is an expression with t; the same on all ranks */
  PetscBool     shared;         /* some pressure acts on a part of its surface */
  PetscReal     t;              /* for which the values of such expressions stand */
  Complaint     complaint;      /* while values are set: the first mistake of this rank */
  PetscInt     *owner;          /* while it is made: by dof, who prescribes it */
  PetscReal    *dense;          /* nodal forces of one load: while it is made, or all the time if some load changes */
};

/* Returns the value of a rule at any t. */
static PetscReal PrescribedAt(Loads loads, const Prescribed *p, PetscReal t)
{
  const int dim = loads->mesh->dim;

  if (!p->varies) return p->value * HistoryFactor(p->history, t);
  return LoadNodeValue(loads->mesh, loads->scene, &loads->scene->loads[p->load], (int)(p->dof % dim), p->dof / dim, t,
                       &loads->complaint);
}

/* Tells whether two rules for one dof say the same at every t, so that having both does no harm. */
static PetscBool PrescribedAgree(Loads loads, const Prescribed *a, const Prescribed *b)
{
  const PetscReal same = LOADS_AGREE * PetscMax(a->largest, b->largest);

  if (a->during && b->during && (a->load >= 0) != (b->load >= 0)) return PETSC_FALSE;
  if (a->during && b->during && a->load >= 0 && a->during->first != b->during->first) return PETSC_FALSE;
  for (int k = 0; k <= LOADS_SAMPLES && (a->varies || b->varies); k++) {
    const PetscReal t = (PetscReal)k / LOADS_SAMPLES;

    if (PetscAbsReal(PrescribedAt(loads, a, t) - PrescribedAt(loads, b, t)) > same) return PETSC_FALSE;
  }
  if (a->varies || b->varies) return PETSC_TRUE;
  if (PetscAbsReal(a->value) <= same && PetscAbsReal(b->value) <= same) return PETSC_TRUE;
  if (PetscAbsReal(a->value - b->value) > same || !a->history || !b->history || a->history->n != b->history->n)
    return PETSC_FALSE;
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
static void LoadsAddDof(Loads loads, const Prescribed *p)
{
  const int dim = loads->mesh->dim;

  if (loads->owner[p->dof] >= 0) {
    const Prescribed *q = &loads->prescribed[loads->owner[p->dof]];

    if (!PrescribedAgree(loads, p, q))
      Complain(&loads->complaint,
               "%s: u%c of node %" PetscInt_FMT
               " is prescribed differently by %s; allowed: one value for each component of a node (part the surfaces, "
               "or drop one of the two)",
               SceneWhere(loads->scene, PrescribedPath(loads->scene, p), NULL), "xyz"[p->dof % dim],
               loads -> mesh -> node_tag[p->dof / dim], PrescribedPath(loads->scene, q));
    return;
  }
  loads->owner[p->dof]                     = loads->n_prescribed;
  loads->constrained[p->dof]               = PETSC_TRUE;
  loads->prescribed[loads->n_prescribed++] = *p;
}

/* Holds one component of the nodes of a support. */
static void LoadsAddSupport(Loads loads, const MeshGroup *group, int component, int support)
{
  const SceneSpan *during = &loads->scene->supports[support].during;

  for (PetscInt i = 0; i < group->n_nodes; i++)
    LoadsAddDof(loads, &(Prescribed){.dof    = group->nodes[i] * loads->mesh->dim + component,
                                     .during = during->some ? during : NULL,
                                     .load   = -1 - support});
}

/* Imposes one component of a displacement on the nodes of its surface. */
static PetscErrorCode LoadsAddDisplacement(Loads loads, const MeshGroup *group, int component, int l)
{
  const SceneLoad *load = &loads->scene->loads[l];
  Prescribed       p    = {.load = l, .varies = SceneLoadVaries(load, component)};

  PetscFunctionBeginUser;
  p.history = p.varies || load->during.some ? NULL : &load->history;
  p.during  = load->during.some ? &load->during : NULL;
  for (PetscInt i = 0; i < group->n_nodes && load->expression[component]; i++) {
    for (int k = 0; k <= (p.varies ? LOADS_SAMPLES : 0); k++) {
      const PetscReal value = LoadNodeValue(loads->mesh, loads->scene, load, component, group->nodes[i],
                                            (PetscReal)k / LOADS_SAMPLES, &loads->complaint);

      p.largest = PetscMax(p.largest, PetscAbsReal(value));
    }
  }
  if (load->expression[component])
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &p.largest, 1, MPIU_REAL, MPI_MAX, loads->mesh->comm));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    p.dof   = group->nodes[i] * loads->mesh->dim + component;
    p.value = LoadNodeValue(loads->mesh, loads->scene, load, component, group->nodes[i], loads->t, &loads->complaint);
    LoadsAddDof(loads, &p);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the rules of a phase and marks the dofs that they hold. */
static PetscErrorCode LoadsListPrescribed(Loads loads, PetscInt phase)
{
  Mesh       mesh  = loads->mesh;
  Scene      scene = loads->scene;
  PetscInt   n     = mesh->n_nodes * mesh->dim;
  MeshGroup *group;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &loads->owner));
  loads->n_prescribed = 0;
  for (PetscInt i = 0; i < n; i++) {
    loads->constrained[i] = PETSC_FALSE;
    loads->owner[i]       = -1;
  }
  for (PetscInt node = 0; node < mesh->n_body_nodes && scene->geometry == GEOMETRY_AXISYMMETRIC; node++)
    if (mesh->coords[node * mesh->dim] + mesh->centre[0] <= LOADS_ON_AXIS * mesh->size)
      LoadsAddDof(loads, &(Prescribed){.dof = node * mesh->dim, .load = LOADS_AXIS});
  for (int s = 0; s < scene->n_supports; s++) {
    const SceneSupport *support = &scene->supports[s];

    if (!SceneHolds(&support->during, phase)) continue;
    PetscCall(MeshGetGroup(mesh, scene, support->path, "surface", support->surface, mesh->dim - 1, &group));
    for (int c = 0; c < mesh->dim; c++)
      if (support->fixed[c]) LoadsAddSupport(loads, group, c, s);
  }
  for (int l = 0; l < scene->n_loads; l++) {
    const SceneLoad *load = &scene->loads[l];

    if (load->kind != LOAD_DISPLACEMENT || !SceneHolds(&load->during, phase)) continue;
    PetscCall(MeshGetGroup(mesh, scene, load->path, "surface", load->region, mesh->dim - 1, &group));
    for (int c = 0; c < mesh->dim; c++)
      if (load->has[c]) PetscCall(LoadsAddDisplacement(loads, group, c, l));
  }
  PetscCall(PetscFree(loads->owner));
  PetscCall(ComplaintRefuse(mesh->comm, &loads->complaint));
  ToolsConstrain(mesh, loads->constrained);
  PetscCall(EnclosedBodiesFind(mesh, scene, loads->constrained));
  PetscCall(PressureNodesConstrain(mesh, scene, loads->constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the shifts of the rules from where dofs were when their supports came. */
static void LoadsSetShifts(Loads loads)
{
  for (PetscInt i = 0; i < loads->n_prescribed && loads->phase; i++) {
    Prescribed *p = &loads->prescribed[i];

    if (!p->during) continue;
    p->shift = SupportPhasePlace(loads->phase, p->dof);
    if (p->load >= 0) p->shift -= PrescribedAt(loads, p, loads->scene->stepping.steps[p->during->first].begin);
  }
}

/* The part of its shift that a rule still has. */
static PetscReal ShiftPart(Loads loads, const Prescribed *p, PetscReal t)
{
  return p->during && p->load >= 0 ? SceneStepLeft(&loads->scene->stepping.steps[p->during->first], t) : 1;
}

/* Lists the rules of the phase that is built, which is the last one here. Those of the others are looked at for
   mistakes: twice, so that each phase has come after each other one. */
static PetscErrorCode LoadsCreatePrescribed(Loads loads, PetscInt phase)
{
  const PetscInt n = loads->mesh->n_nodes * loads->mesh->dim, phases = loads->scene->stepping.n_steps;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &loads->constrained, n, &loads->prescribed));
  PetscCall(SupportPhaseCreate(loads->mesh, loads->scene, phase, &loads->phase));
  for (PetscInt k = 0; k < 2 * phases && loads->phase && !phase; k++) PetscCall(LoadsListPrescribed(loads, k % phases));
  PetscCall(LoadsListPrescribed(loads, phase));
  LoadsSetShifts(loads);
  PetscCall(MeshSetConstraints(loads->mesh, loads->constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies the pressures at the n quadrature points of face f by the share of each. */
static void SharePressures(const LoadShares *shares, PetscInt f, int n, double *pressure)
{
  for (int p = 0; p < n && shares->points; p++) pressure[p] *= shares->points[f * FACE_MAX_POINTS + p];
}

/* Multiplies the forces on the n nodes of face f, and the rows of their tangent, by the share of each node. */
static void ShareForces(const LoadShares *shares, PetscInt f, int dim, int n, double *fe, double *ke)
{
  for (int i = 0; i < n * dim && shares->nodes; i++) {
    const PetscReal share = shares->nodes[f * FACE_MAX_NODES + i / dim];

    fe[i] *= share;
    for (int j = 0; j < n * dim && ke; j++) ke[i * n * dim + j] *= share;
  }
}

/* Adds the nodal forces of one face or cell for factor 1 to the dense work vector. */
static void DeadLoadAdd(Loads loads, PetscInt n, const PetscInt *nodes, const double *fe, DeadLoad *dead)
{
  const int dim = loads->mesh->dim;

  for (PetscInt i = 0; i < n * dim; i++) {
    loads->dense[nodes[i / dim] * dim + i % dim] += fe[i];
    dead->force2 += PetscSqr(fe[i]);
  }
}

static PetscErrorCode DeadLoadSurface(Loads loads, PetscReal t, DeadLoad *dead)
{
  Mesh             mesh = loads->mesh;
  const SceneLoad *load = dead->load;
  PetscInt         nodes[FACE_MAX_NODES];
  double X[FACE_MAX_NODES * 3], zero[FACE_MAX_NODES * 3] = {0}, fe[FACE_MAX_NODES * 3], value[LOAD_MAX_VALUES];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < dead->group->n_faces; f++) {
    const ElementType type   = MeshFaceNodes(mesh, dead->group, f, nodes);
    const Element    *face   = ElementGetFace(type);
    int               stride = LoadPointValues(mesh, loads->scene, load, face, nodes, t, value, &loads->complaint);

    for (int p = 1; p < face->points && dead->shares.points && !stride; p++) value[p] = value[0];
    if (dead->shares.points) stride = 1;
    SharePressures(&dead->shares, f, face->points, value);
    MeshGatherNodes(mesh, face->nodes, nodes, mesh->coords, X);
    PetscCall(PetscArrayzero(fe, face->nodes * mesh->dim));
    FaceLoadKernel(type, mesh->dim, loads->scene->geometry,
                   load->kind == LOAD_PRESSURE ? FACE_DEAD_PRESSURE : FACE_TRACTION, X, zero, value, stride, fe, NULL,
                   NULL);
    ShareForces(&dead->shares, f, mesh->dim, face->nodes, fe, NULL);
    DeadLoadAdd(loads, face->nodes, nodes, fe, dead);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area of the faces of a group, of all ranks. */
static PetscErrorCode GroupArea(Loads loads, const MeshGroup *group, PetscReal *area)
{
  const int       dim    = loads->mesh->dim;
  const PetscReal one[3] = {1, 0, 0};
  PetscInt        nodes[FACE_MAX_NODES];
  double          X[FACE_MAX_NODES * 3], zero[FACE_MAX_NODES * 3] = {0}, fe[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  *area = 0;
  for (PetscInt f = 0; f < group->n_faces; f++) {
    const ElementType type = MeshFaceNodes(loads->mesh, group, f, nodes);
    const Element    *face = ElementGetFace(type);

    MeshGatherNodes(loads->mesh, face->nodes, nodes, loads->mesh->coords, X);
    PetscCall(PetscArrayzero(fe, face->nodes * dim));
    FaceLoadKernel(type, dim, loads->scene->geometry, FACE_TRACTION, X, zero, one, 0, fe, NULL, NULL);
    for (int a = 0; a < face->nodes; a++) *area += PetscAbsReal(fe[a * dim]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, area, 1, MPIU_REAL, MPI_SUM, loads->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds what a force is shared out over: the area of its group, or the number of nodes where it has no faces or these
   lie on the axis. Round-off of r is an area there, and its sign the force's direction. */
static PetscErrorCode DeadLoadMeasure(Loads loads, DeadLoad *dead)
{
  const Mesh  mesh = loads->mesh;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(GroupArea(loads, dead->group, &dead->area));
  if (loads->scene->geometry == GEOMETRY_AXISYMMETRIC && dead->area < LOADS_ON_AXIS * PetscSqr(mesh->size))
    dead->area = 0;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (PetscInt i = 0; i < dead->group->n_nodes; i++) dead->nodes += mesh->node_owner[dead->group->nodes[i]] == rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &dead->nodes, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives each node of a group without area an equal part of a force. Each rank does so for its own nodes. */
static PetscErrorCode DeadLoadNodes(Loads loads, PetscReal t, DeadLoad *dead)
{
  Mesh             mesh = loads->mesh;
  const SceneLoad *load = dead->load;
  const PetscReal  X[3] = {0, 0, 0};
  PetscMPIInt      rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  for (int c = 0; c < mesh->dim; c++) {
    PetscReal value = (load->expression[c] ? SceneLoadValue(load, c, X, t) : load->value[c]) / loads->scene->thickness;

    if (LoadVaries(load) && !SceneLoadVaries(load, c)) value *= HistoryValue(&load->history, t);
    for (PetscInt i = 0; i < dead->group->n_nodes; i++) {
      const PetscInt node = dead->group->nodes[i];

      if (mesh->node_owner[node] != rank) continue;
      loads->dense[node * mesh->dim + c] = value / (PetscReal)dead->nodes;
      dead->force2 += PetscSqr(value / (PetscReal)dead->nodes);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Spreads a force evenly over the faces of its group, or over its nodes where it has no area. */
static PetscErrorCode DeadLoadForce(Loads loads, PetscReal t, DeadLoad *dead)
{
  const PetscInt  n         = loads->mesh->n_nodes * loads->mesh->dim;
  const PetscReal thickness = loads->scene->thickness;

  PetscFunctionBeginUser;
  if (dead->area == 0) {
    PetscCall(DeadLoadNodes(loads, t, dead));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(DeadLoadSurface(loads, t, dead));
  for (PetscInt i = 0; i < n; i++) loads->dense[i] /= dead->area * thickness;
  dead->force2 /= PetscSqr(dead->area * thickness);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeadLoadVolume(Loads loads, PetscReal t, DeadLoad *dead)
{
  Mesh             mesh  = loads->mesh;
  Scene            scene = loads->scene;
  const SceneLoad *load  = dead->load;
  int              body  = MeshFindBody(scene, load->region, PETSC_FALSE);
  double           X[ELEMENT_MAX_NODES * 3], fe[ELEMENT_MAX_NODES * 3], value[LOAD_MAX_VALUES];

  PetscFunctionBeginUser;
  if (body < 0)
    PetscCall(RefuseInput(mesh->comm, "%s: no deformable body named '%s'; allowed: a volume listed in bodies",
                          SceneWhere(scene, load->path, "volume"), load->region));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
    const Element  *cell  = ElementGet(mesh->cell_type[c]);
    int             stride;

    if (mesh->cell_body[c] != body) continue;
    stride = LoadPointValues(mesh, scene, load, cell, nodes, t, value, &loads->complaint);
    MeshCellCoordinates(mesh, c, X);
    PetscCall(PetscArrayzero(fe, cell->nodes * mesh->dim));
    BodyForceKernel(mesh->cell_type[c], mesh->dim, scene->geometry, X, value, stride, fe);
    DeadLoadAdd(loads, cell->nodes, nodes, fe, dead);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeadLoadPack(const PetscReal *dense, PetscInt n, DeadLoad *dead)
{
  PetscInt count = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) count += dense[i] != 0;
  PetscCall(PetscFree2(dead->dof, dead->force));
  PetscCall(PetscMalloc2(count, &dead->dof, count, &dead->force));
  dead->n = 0;
  for (PetscInt i = 0; i < n; i++) {
    if (dense[i] == 0) continue;
    dead->dof[dead->n]     = i;
    dead->force[dead->n++] = dense[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Assembles the nodal forces of a dead load, at t where it varies. */
static PetscErrorCode DeadLoadAssemble(Loads loads, PetscReal t, DeadLoad *dead)
{
  const PetscInt n = loads->mesh->n_nodes * loads->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(loads->dense, n));
  dead->force2 = 0;
  if (dead->load->kind == LOAD_FORCE)
    PetscCall(DeadLoadForce(loads, t, dead));
  else if (dead->group)
    PetscCall(DeadLoadSurface(loads, t, dead));
  else
    PetscCall(DeadLoadVolume(loads, t, dead));
  PetscCall(DeadLoadPack(loads->dense, n, dead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the pressures of a follower load at the quadrature points of its faces, at t where it varies. */
static void FollowerEvaluate(Loads loads, PetscReal t, FollowerLoad *follower)
{
  PetscInt nodes[FACE_MAX_NODES];

  for (PetscInt f = 0; f < follower->group->n_faces; f++) {
    const Element *face = ElementGetFace(MeshFaceNodes(loads->mesh, follower->group, f, nodes));
    double         value[LOAD_MAX_VALUES];

    (void)LoadPointValues(loads->mesh, loads->scene, follower->load, face, nodes, t, value, &loads->complaint);
    for (int p = 0; p < face->points; p++) follower->value[f * FACE_MAX_POINTS + p] = value[p];
  }
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
    const SceneLoad *load    = &scene->loads[l];
    const History   *history = LoadVaries(load) ? NULL : &load->history;

    if (load->kind == LOAD_DISPLACEMENT) continue;
    group = NULL;
    if (load->kind != LOAD_BODY_FORCE)
      PetscCall(MeshGetGroup(mesh, scene, load->path, "surface", load->region, mesh->dim - 1, &group));
    if (LoadFollows(scene, load)) {
      FollowerLoad *follower = &loads->follower[loads->n_follower++];

      *follower = (FollowerLoad){.load = load, .group = group, .history = history};
      if (!LoadHasExpression(load)) continue;
      PetscCall(PetscMalloc1(group->n_faces * FACE_MAX_POINTS, &follower->value));
      FollowerEvaluate(loads, loads->t, follower);
    } else {
      DeadLoad *dead = &loads->dead[loads->n_dead++];

      *dead = (DeadLoad){.load = load, .group = group, .history = history};
      if (load->kind == LOAD_FORCE) PetscCall(DeadLoadMeasure(loads, dead));
      PetscCall(DeadLoadAssemble(loads, loads->t, dead));
    }
  }
  if (!loads->varies && !loads->shared) PetscCall(PetscFree(loads->dense));
  PetscCall(ComplaintRefuse(mesh->comm, &loads->complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the values of all expressions with t to those at a load parameter. */
static PetscErrorCode LoadsMove(Loads loads, PetscReal t)
{
  PetscFunctionBeginUser;
  if (!loads->varies || t == loads->t) PetscFunctionReturn(PETSC_SUCCESS);
  loads->t = t;
  for (PetscInt i = 0; i < loads->n_prescribed; i++)
    if (loads->prescribed[i].varies) loads->prescribed[i].value = PrescribedAt(loads, &loads->prescribed[i], t);
  for (PetscInt l = 0; l < loads->n_dead; l++)
    if (LoadVaries(loads->dead[l].load)) PetscCall(DeadLoadAssemble(loads, t, &loads->dead[l]));
  for (PetscInt l = 0; l < loads->n_follower; l++)
    if (LoadVaries(loads->follower[l].load)) FollowerEvaluate(loads, t, &loads->follower[l]);
  PetscCall(ComplaintRefuse(loads->mesh->comm, &loads->complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsCreate - reads supports, loads and imposed displacements of the scene, refuses contradictions, and sets the
  mesh's sections.

  Collective

  Input Parameters:
+ mesh  - the mesh; borrowed
. scene - the scene; borrowed
- phase - number of the step with a name whose supports hold; 0 at the start, and where all hold all the time

  Output Parameter:
. out - free it with LoadsDestroy()

  Note:
  Supported and imposed dofs become constraints of the mesh's local section. Call it before any matrix or vector is
  made. It refuses two rules for one component of a node that do not agree, and expressions that are not finite.
@*/
PetscErrorCode LoadsCreate(Mesh mesh, Scene scene, PetscInt phase, Loads *out)
{
  Loads loads;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&loads));
  *out         = loads; /* LoadsDestroy() frees what a refusal leaves */
  loads->mesh  = mesh;
  loads->scene = scene;
  for (int l = 0; l < scene->n_loads; l++) loads->varies = (PetscBool)(loads->varies || LoadVaries(&scene->loads[l]));
  loads->shared = SceneHasFluid(scene);
  PetscCall(LoadsCreatePrescribed(loads, phase));
  PetscCall(FoundationCreate(mesh, scene, &loads->foundation));
  PetscCall(LoadsCreateForces(loads));
  for (int k = LOADS_SAMPLES; k >= 0; k--) PetscCall(LoadsMove(loads, (PetscReal)k / LOADS_SAMPLES));
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
  for (PetscInt l = 0; l < (*loads)->n_follower; l++) PetscCall(PetscFree((*loads)->follower[l].value));
  for (PetscInt l = 0; l < (*loads)->n_dead; l++) PetscCall(PetscFree2((*loads)->dead[l].dof, (*loads)->dead[l].force));
  PetscCall(FoundationDestroy(&(*loads)->foundation));
  PetscCall(SupportPhaseDestroy(&(*loads)->phase));
  PetscCall(PetscFree2((*loads)->dead, (*loads)->follower));
  PetscCall(PetscFree2((*loads)->constrained, (*loads)->prescribed));
  PetscCall(PetscFree((*loads)->owner));
  PetscCall(PetscFree((*loads)->dense));
  PetscCall(PetscFree(*loads));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsPrescribe - writes the supported and imposed displacements at a load parameter into the displacements.

  Collective

  Input Parameters:
+ loads - the loads
- t     - load parameter

  Output Parameter:
. u - local displacements (length) [n_nodes*dim], of which only the prescribed ones are written

  Note:
  It refuses an expression with t that is not finite at t, on all ranks. LoadsResidual() and LoadsTangent() do so too.
@*/
PetscErrorCode LoadsPrescribe(Loads loads, PetscReal t, PetscReal *u)
{
  PetscFunctionBeginUser;
  PetscCall(LoadsMove(loads, t));
  ToolsPrescribe(loads->mesh, t, u);
  for (PetscInt i = 0; i < loads->n_prescribed; i++) {
    const Prescribed *p = &loads->prescribed[i];

    u[p->dof] = p->value * HistoryFactor(p->history, t);
    if (p->shift != 0) u[p->dof] += p->shift * ShiftPart(loads, p, t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FollowerFace(Loads loads, const FollowerLoad *load, PetscInt f, PetscReal t, const PetscReal *u,
                                   PetscInt *nodes, int *n, double *fe, double *ke)
{
  Mesh              mesh     = loads->mesh;
  const ElementType type     = MeshFaceNodes(mesh, load->group, f, nodes);
  const PetscReal   factor   = HistoryFactor(load->history, t);
  const PetscReal  *value    = load->value ? &load->value[f * FACE_MAX_POINTS] : load->load->value;
  const PetscBool   constant = (PetscBool)(!load->value && !load->shares.points);
  double            X[FACE_MAX_NODES * 3], v[FACE_MAX_NODES * 3], pressure[FACE_MAX_POINTS];

  PetscFunctionBeginUser;
  for (int p = 0; p < (constant ? 1 : ElementGetFace(type)->points); p++)
    pressure[p] = value[load->value ? p : 0] * factor;
  SharePressures(&load->shares, f, ElementGetFace(type)->points, pressure);
  *n = ElementGet(type)->nodes;
  MeshGatherNodes(mesh, *n, nodes, mesh->coords, X);
  MeshGatherNodes(mesh, *n, nodes, u, v);
  PetscCall(PetscArrayzero(fe, *n * mesh->dim));
  if (ke) PetscCall(PetscArrayzero(ke, PetscSqr(*n * mesh->dim)));
  FaceLoadKernel(type, mesh->dim, loads->scene->geometry, FACE_FOLLOWER_PRESSURE, X, v, pressure, constant ? 0 : 1, fe,
                 ke, NULL);
  ShareForces(&load->shares, f, mesh->dim, *n, fe, ke);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsResidual - subtracts the external forces, those of springs and of supports that left included, from the
  residual.

  Collective

  Input Parameters:
+ loads - the loads
. t     - load parameter
- u     - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ f      - [n_nodes*dim], from which the external forces are subtracted
. energy - the potential of the dead loads and the energy of the springs are added
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
  PetscCall(LoadsMove(loads, t));
  ToolsResidual(loads->mesh, t, u, f, energy, force2);
  for (PetscInt l = 0; l < loads->n_dead; l++) {
    const DeadLoad *dead   = &loads->dead[l];
    const PetscReal factor = HistoryFactor(dead->history, t);

    for (PetscInt i = 0; i < dead->n; i++) {
      if (f) f[dead->dof[i]] -= factor * dead->force[i];
      if (energy) *energy -= factor * dead->force[i] * u[dead->dof[i]];
    }
    if (force2) *force2 += PetscSqr(factor) * dead->force2;
  }
  PetscCall(FoundationResidual(loads->foundation, t, u, f, energy, force2));
  SupportPhaseForces(loads->phase, t, u, f, energy, force2);
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
  LoadsTangent - adds what springs and follower loads contribute to the tangent to the local block CSR of the
  elasticity.

  Collective

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
  PetscCall(FoundationTangent(loads->foundation, t, elasticity));
  PetscCall(ToolsTangent(loads->mesh, t, elasticity));
  if (!loads->n_follower) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LoadsMove(loads, t));
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
  LoadsSetShares - lets a pressure act on a part of its surface.

  Collective

  Input Parameters:
+ loads  - the loads
. load   - number of a pressure in the scene
. nodes  - nodes[n_faces*FACE_MAX_NODES]: factor on the force of each face on each of its nodes, from 0 to 1
- points - points[n_faces*FACE_MAX_POINTS]: factor on the pressure at each quadrature point of the faces

  Note:
  The arrays are borrowed until the next call. The call is repeated when their values change. With factors at nodes the
  forces of neighbouring nodes are apart from each other, with those at points they overlap by the shape functions.
@*/
PetscErrorCode LoadsSetShares(Loads loads, int load, const PetscReal *nodes, const PetscReal *points)
{
  const SceneLoad *scene = &loads->scene->loads[load];

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < loads->n_follower; l++)
    if (loads->follower[l].load == scene) loads->follower[l].shares = (LoadShares){nodes, points};
  for (PetscInt l = 0; l < loads->n_dead; l++) {
    if (loads->dead[l].load != scene) continue;
    loads->dead[l].shares = (LoadShares){nodes, points};
    PetscCall(DeadLoadAssemble(loads, loads->t, &loads->dead[l]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsPressure - returns a pressure that is the same everywhere on its surface.

  Not collective

  Input Parameters:
+ loads - the loads
. load  - number of the pressure in the scene
- t     - load parameter

  Output Parameter:
. pressure - its value at t, history included (force per area)
@*/
PetscErrorCode LoadsPressure(Loads loads, int load, PetscReal t, PetscReal *pressure)
{
  static const PetscReal origin[3] = {0, 0, 0};
  const SceneLoad       *scene     = &loads->scene->loads[load];

  PetscFunctionBeginUser;
  *pressure = SceneLoadValue(scene, 0, origin, t) * (LoadVaries(scene) ? 1 : HistoryFactor(&scene->history, t));
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
  LoadsConstrained - gives for every local dof whether it is supported or imposed.

  Not collective

  Input Parameter:
. loads - they own the array [n_nodes*dim]

  Note:
  A group counts if this rank sees it, which it does for its own nodes.
@*/
const PetscBool *LoadsConstrained(Loads loads)
{
  return loads->constrained;
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
  LoadsHeld - tells whether a local dof is supported, imposed or on a spring.

  Not collective

  Input Parameters:
+ loads     - the loads
- local_dof - number of the dof, local node times dim plus component
@*/
PetscBool LoadsHeld(Loads loads, PetscInt local_dof)
{
  return (PetscBool)(loads->constrained[local_dof] || FoundationHolds(loads->foundation, local_dof));
}

/*@
  LoadsSpringForce - returns the forces of springs at the last residual.

  Not collective

  Input Parameter:
. loads - they own the array [n_nodes*dim], which has this rank's part; without springs the result is NULL
@*/
const PetscReal *LoadsSpringForce(Loads loads)
{
  return FoundationForce(loads->foundation);
}

/*@
  LoadsAddSpringForces - adds the forces of springs at some displacements, of which they are a linear function.

  Not collective

  Input Parameters:
+ loads - the loads
. t     - load parameter
- u     - local displacements (length) [n_nodes*dim], ghosts included

  Input/Output Parameter:
. forces - on the bodies; this rank's part is added [n_nodes*dim]
@*/
void LoadsAddSpringForces(Loads loads, PetscReal t, const PetscReal *u, PetscReal *forces)
{
  FoundationAddForces(loads->foundation, t, u, forces, NULL, NULL);
}

/*@
  LoadsFadingForce - returns the force that supports which have left still exert on a dof, at the last residual.

  Not collective

  Input Parameters:
+ loads     - the loads
- local_dof - number of the dof, local node times dim plus component

  Note:
  It is 0 on ranks that do not own the node.
@*/
PetscReal LoadsFadingForce(Loads loads, PetscInt local_dof)
{
  return SupportPhaseForce(loads->phase, local_dof);
}

/*@
  LoadsPhase - returns the number of the step with a name whose supports hold.

  Not collective, the same on all ranks

  Input Parameter:
. loads - the loads
@*/
PetscInt LoadsPhase(Loads loads)
{
  return SupportPhaseNumber(loads->phase);
}

/*@
  LoadsShowPhase - lets LoadsPrescribed() and LoadsHeld() answer for another phase, without any other effect.

  Collective

  Input Parameters:
+ loads - the loads
- phase - number of a step with a name; LoadsPhase() to return
@*/
PetscErrorCode LoadsShowPhase(Loads loads, PetscInt phase)
{
  PetscFunctionBeginUser;
  PetscCall(LoadsListPrescribed(loads, phase));
  LoadsSetShifts(loads);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsChangePhase - goes to another phase in an accepted state: supports that come hold dofs where these are, and the
  forces of those that leave begin to fade.

  Collective

  Input Parameters:
+ loads - the loads, of a scene whose supports change
. phase - number of the step that begins
. u     - local displacements u[n_nodes*dim] (length)
- force - force[n_nodes*dim] that prescribed dofs need for equilibrium, complete at every node

  Note:
  The unknowns are other ones from here on, so that all that was made of the old ones must be made anew. The state
  goes to the new loads by LoadsArchive().
@*/
PetscErrorCode LoadsChangePhase(Loads loads, PetscInt phase, const PetscReal *u, const PetscReal *force)
{
  const PetscInt n = loads->mesh->n_nodes * loads->mesh->dim, before = LoadsPhase(loads);
  PetscBool     *comes, *leaves;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &comes, n, &leaves));
  for (PetscInt i = 0; i < loads->n_prescribed; i++)
    if (loads->prescribed[i].during) leaves[loads->prescribed[i].dof] = PETSC_TRUE;
  PetscCall(LoadsListPrescribed(loads, phase));
  for (PetscInt i = 0; i < loads->n_prescribed; i++) {
    const Prescribed *p = &loads->prescribed[i];

    leaves[p->dof] = PETSC_FALSE;
    if (p->during) comes[p->dof] = (PetscBool)!SceneHolds(p->during, before);
  }
  PetscCall(SupportPhaseTake(loads->phase, phase, comes, u, leaves, force));
  PetscCall(PetscFree2(comes, leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  LoadsArchive - saves or loads where supports of some steps hold, and what those that left still carry.

  Collective

  Input Parameters:
+ loads   - the loads; when they load, of the phase that was saved
- archive - decides whether it is saved or loaded
@*/
PetscErrorCode LoadsArchive(Loads loads, Archive archive)
{
  PetscFunctionBeginUser;
  PetscCall(SupportPhaseArchive(loads->phase, archive));
  LoadsSetShifts(loads);
  PetscFunctionReturn(PETSC_SUCCESS);
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
  LoadsRigidTurn - gives a direction that is fixed to a rigid body at a load parameter.

  Not collective

  Input Parameters:
+ loads - the loads
. body  - index into the scene's bodies
. t     - load parameter
- V     - the direction at t = 0

  Output Parameter:
. v - the direction at t
@*/
void LoadsRigidTurn(Loads loads, int body, PetscReal t, const PetscReal V[3], PetscReal v[3])
{
  MotionTurn(&loads->scene->bodies[body].motion, t, V, v);
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
