/* First variations of probes, see probevariation.h. */
#include "report/probevariation.h"
#include "bodies/tools.h"
#include "probeimpl.h"

/* Present place of a node. */
static void Place(Probes probes, PetscInt node, PetscReal x[3])
{
  const Mesh mesh = probes->model->mesh;

  for (int d = 0; d < 3; d++)
    x[d] =
      d < mesh->dim ? mesh->coords[node * mesh->dim + d] + mesh->centre[d] + probes->model->u[node * mesh->dim + d] : 0;
}

/* A component of forces, or their moment about an axis, is the sum over the nodes of what is given here of a node times
   its force. That arms change with displacements is left out: it is as small as the strains that do it. */
static void ForceWeight(Probes probes, const Probe *probe, PetscInt node, PetscReal weight[3])
{
  const ProbeKind kind = probe->scene->kind;
  const int       i = (probe->scene->axis + 1) % 3, j = (probe->scene->axis + 2) % 3;
  PetscReal       x[3];

  Place(probes, node, x);
  weight[0] = weight[1] = weight[2] = 0;
  if (kind == PROBE_REACTION || kind == PROBE_CONTACT_FORCE || kind == PROBE_FRICTION_FORCE)
    weight[probe->scene->component] = 1;
  else {
    weight[i] = -(x[j] - probe->scene->point[0][j]);
    weight[j] = x[i] - probe->scene->point[0][i];
  }
}

/* Marks the nodes of a probe's group, ghosts included [n_nodes]; the caller frees it. */
static PetscErrorCode MarkGroup(Mesh mesh, const Probe *probe, PetscReal **mark)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, mark));
  for (PetscInt i = 0; i < probe->group->n_nodes; i++) (*mark)[probe->group->nodes[i]] = 1;
  PetscCall(MeshSumNodes(mesh, 1, *mark));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) (*mark)[n] = (*mark)[n] > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Springs bear what they would bear at a motion of the group, times that of the dof. */
static PetscErrorCode VarySprings(Probes probes, const Probe *probe, Functional *f)
{
  const Problem problem = probes->model->problem;
  const Mesh    mesh    = problem->mesh;
  PetscReal    *mark, *unit;

  PetscFunctionBeginUser;
  PetscCall(MarkGroup(mesh, probe, &mark));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &unit));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &f->direct));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscReal weight[3];

    ForceWeight(probes, probe, n, weight);
    for (int d = 0; d < mesh->dim; d++) unit[n * mesh->dim + d] = mark[n] * weight[d];
  }
  LoadsAddSpringForces(problem->loads, probes->model->t, unit, f->direct);
  PetscCall(PetscFree(unit));
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for what presses. pair: the one that it is of; -1: none yet. */
static PetscErrorCode CreatePressed(Probes probes, int pair, Functional *f)
{
  PetscFunctionBeginUser;
  PetscCall(MeshCreateLocal(probes->model->mesh, probes->model->mesh->dim, &f->pressed));
  PetscCall(PetscCalloc1(ContactPairs(probes->model->contact), &f->pairs));
  if (pair >= 0) f->pairs[pair] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force that moves or holds a tool is, with the other sign, the residual of all pairs whose master it is at the
   nodes of their slaves, which are all of their nodes of bodies. */
static PetscErrorCode VaryToolReaction(Probes probes, const Probe *probe, Functional *f)
{
  const Mesh mesh = probes->model->mesh;

  PetscFunctionBeginUser;
  PetscCall(CreatePressed(probes, -1, f));
  for (int p = 0; p < probes->scene->n_contacts; p++)
    f->pairs[p] = SceneContactHasMaster(&probes->scene->contacts[p], probe->scene->target);
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscReal weight[3];

    ForceWeight(probes, probe, n, weight);
    for (int d = 0; d < mesh->dim; d++) f->pressed[n * mesh->dim + d] = -weight[d];
  }
  for (int k = 0; k < mesh->n_tools; k++)
    for (int d = 0; d < mesh->dim; d++) f->pressed[mesh->tools[k].node * mesh->dim + d] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A reaction is the residual at the prescribed dofs, and what springs bear; that of a tool is neither. */
static PetscErrorCode VaryReaction(Probes probes, const Probe *probe, Functional *f)
{
  const Problem problem = probes->model->problem;
  const Mesh    mesh    = problem->mesh;

  PetscFunctionBeginUser;
  if (ProbeOfTool(probes, probe)) {
    PetscCall(VaryToolReaction(probes, probe, f));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (LoadsSpringForce(problem->loads)) PetscCall(VarySprings(probes, probe, f));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &f->held));
  for (PetscInt i = 0; i < probe->group->n_nodes; i++) {
    const PetscInt node = probe->group->nodes[i];
    PetscReal      weight[3];

    ForceWeight(probes, probe, node, weight);
    for (int d = 0; d < mesh->dim; d++)
      if (LoadsPrescribed(problem->loads, node * mesh->dim + d)) f->held[node * mesh->dim + d] = weight[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The free component of a tool's motion is an unknown, the others have no error. scale: value for each unit of the
   component (length or radian). */
static PetscErrorCode VaryTool(Probes probes, const Probe *probe, int component, PetscReal scale, Functional *f)
{
  const Mesh      mesh = probes->model->mesh;
  const MeshTool *tool = ToolOfPair(mesh, probes->scene, probe->pair);
  PetscMPIInt     rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &f->direct));
  if (tool && tool->motion->free[component] && !rank)
    f->direct[tool->node * mesh->dim + ToolDof(mesh, component)] = component < 3 ? scale : scale / tool->arm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says why a pair's forces cannot be told apart by the nodes that they act on; NULL: they can. */
static PetscErrorCode FindShared(Probes probes, const Probe *probe, const char **why)
{
  ContactPlace place;
  ContactSides sides;
  PetscInt     joined;

  PetscFunctionBeginUser;
  PetscCall(ContactPairJoined(probes->model->contact, probe->pair, &joined, &place));
  ContactPairSides(probes->model->contact, probe->pair, &sides);
  if (joined > 0 || (sides.master && sides.master->group == sides.slave->group))
    *why = "slave and master of the pair share nodes";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force on the master is the residual of the pair at the nodes of the slave. */
static PetscErrorCode VaryContactForce(Probes probes, const Probe *probe, Functional *f, const char **why)
{
  const Mesh mesh = probes->model->mesh;
  PetscReal *mark;

  PetscFunctionBeginUser;
  PetscCall(FindShared(probes, probe, why));
  if (*why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkGroup(mesh, probe, &mark));
  PetscCall(CreatePressed(probes, probe->pair, f));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscReal weight[3];

    ForceWeight(probes, probe, n, weight);
    for (int d = 0; d < mesh->dim && mark[n] > 0; d++) f->pressed[n * mesh->dim + d] = weight[d];
  }
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode VaryDisplacement(Probes probes, const Probe *probe, Functional *f, const char **why)
{
  const Mesh        mesh  = probes->model->mesh;
  const ProbePoint *point = &probe->point[0];

  PetscFunctionBeginUser;
  (void)why;
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &f->direct));
  for (PetscInt a = 0; a < point->n; a++)
    f->direct[point->node[a] * mesh->dim + probe->scene->component] = point->weight[a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A distance changes by the difference of the displacements along the line between the points. */
static PetscErrorCode VaryDistance(Probes probes, const Probe *probe, Functional *f, const char **why)
{
  const Mesh mesh = probes->model->mesh;
  const int  dim  = mesh->dim;
  PetscReal  X[2][3], u[2][3], way[3] = {0, 0, 0}, length = 0;

  PetscFunctionBeginUser;
  (void)why;
  for (int k = 0; k < 2; k++) {
    PetscCall(ProbePointValue(probes, &probe->point[k], mesh->coords, X[k]));
    PetscCall(ProbePointValue(probes, &probe->point[k], probes->model->u, u[k]));
  }
  for (int i = 0; i < dim; i++) way[i] = X[1][i] + u[1][i] - X[0][i] - u[0][i];
  for (int i = 0; i < dim; i++) length += PetscSqr(way[i]);
  length = PetscSqrtReal(length);
  PetscCall(MeshCreateLocal(mesh, mesh->dim, &f->direct));
  for (int k = 0; k < 2; k++)
    for (PetscInt a = 0; a < probe->point[k].n && length > 0; a++)
      for (int i = 0; i < dim; i++)
        f->direct[probe->point[k].node[a] * dim + i] += (k ? 1 : -1) * probe->point[k].weight[a] * way[i] / length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean pressure is the sum of the nodes' normal forces over their present areas, weighted by their reference areas.
   That areas and normals change besides is left out: with friction, whose forces have no part along the normal, by the
   turn of the normal times the friction. */
static PetscErrorCode VaryPressureMean(Probes probes, const Probe *probe, Functional *f, const char **why)
{
  const Mesh   mesh = probes->model->mesh;
  const int    dim  = mesh->dim;
  ContactNodes slaves;
  PetscReal   *share, area;

  PetscFunctionBeginUser;
  PetscCall(FindShared(probes, probe, why));
  if (*why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProbeMeanWeights(probes, probe, &slaves, &share, &area));
  PetscCall(CreatePressed(probes, probe->pair, f));
  for (PetscInt k = 0; k < slaves.n; k++) {
    const PetscReal weight =
      share[k] * (slaves.force[k] > 0 ? slaves.pressure[k] / slaves.force[k] : 1 / slaves.area[k]);

    for (int i = 0; i < dim; i++) f->pressed[slaves.node[k] * dim + i] = -slaves.normal[3 * k + i] * weight / area;
  }
  PetscCall(PetscFree(share));
  PetscCall(MeshSumNodes(mesh, dim, f->pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Friction forces are the residual of the pair at the nodes of its slave in the planes of contact. That these turn and
   move is left out: it is as small as the strains that do it. */
static PetscErrorCode VaryFriction(Probes probes, const Probe *probe, Functional *f, const char **why)
{
  const Mesh   mesh = probes->model->mesh;
  const int    dim  = mesh->dim;
  ContactNodes slaves;

  PetscFunctionBeginUser;
  PetscCall(FindShared(probes, probe, why));
  if (*why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGetNodes(probes->model->contact, probe->pair, probes->model->u, &slaves));
  PetscCall(CreatePressed(probes, probe->pair, f));
  for (PetscInt k = 0; k < slaves.n; k++) {
    const PetscInt   n      = slaves.node[k];
    const PetscReal *normal = &slaves.normal[3 * k];
    PetscReal        weight[3], along = 0;

    ForceWeight(probes, probe, n, weight);
    for (int i = 0; i < dim; i++) along += weight[i] * normal[i];
    for (int i = 0; i < dim; i++) f->pressed[n * dim + i] = weight[i] - along * normal[i];
  }
  PetscCall(MeshSumNodes(mesh, dim, f->pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeVary - gives the first variation of a probe at the model's present solution.

  Collective

  Input Parameters:
+ probes - the probes, after ProbesEvaluate()
- i      - number of the probe

  Output Parameters:
+ functional - free it with ProbeVariationFree()
- why        - why the probe has none; NULL: it has one
@*/
PetscErrorCode ProbeVary(Probes probes, int i, Functional *functional, const char **why)
{
  const Probe    *probe = &probes->probe[i];
  const PetscReal scale = (probe->scene->absolute && probe->plain < 0 ? -1 : 1) * probe->scene->factor;
  const PetscInt  n     = probes->model->mesh->n_nodes * probes->model->mesh->dim;

  PetscFunctionBeginUser;
  *functional = (Functional){.direct = NULL};
  *why        = NULL;
  if (PetscIsInfOrNanReal(probe->plain))
    *why = "it has no value";
  else
    switch (probe->scene->kind) {
    case PROBE_REACTION:
    case PROBE_REACTION_TORQUE: PetscCall(VaryReaction(probes, probe, functional)); break;
    case PROBE_CONTACT_FORCE:
    case PROBE_CONTACT_TORQUE: PetscCall(VaryContactForce(probes, probe, functional, why)); break;
    case PROBE_DISPLACEMENT: PetscCall(VaryDisplacement(probes, probe, functional, why)); break;
    case PROBE_DISTANCE: PetscCall(VaryDistance(probes, probe, functional, why)); break;
    case PROBE_PRESSURE_MEAN: PetscCall(VaryPressureMean(probes, probe, functional, why)); break;
    case PROBE_TOOL_MOTION: PetscCall(VaryTool(probes, probe, probe->scene->component, 1, functional)); break;
    case PROBE_TOOL_ROTATION:
      PetscCall(VaryTool(probes, probe, 3 + probe->scene->component, 180 / PETSC_PI, functional));
      break;
    case PROBE_FRICTION_FORCE:
    case PROBE_FRICTION_TORQUE: PetscCall(VaryFriction(probes, probe, functional, why)); break;
    default: *why = "its kind is no smooth function of the displacements";
    }
  for (PetscInt k = 0; k < n; k++) {
    if (functional->direct) functional->direct[k] *= scale;
    if (functional->held) functional->held[k] *= scale;
    if (functional->pressed) functional->pressed[k] *= scale;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbeVariationFree - frees what ProbeVary() gave.

  Not collective
@*/
PetscErrorCode ProbeVariationFree(Functional *functional)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(functional->direct));
  PetscCall(PetscFree(functional->held));
  PetscCall(PetscFree(functional->pressed));
  PetscCall(PetscFree(functional->pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
