/* The scalars that a scene asks for, see probe.h. */
#include "probeimpl.h"
#include "contact/contactedge.h"
#include "base/refusal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A node that is n face sizes from an edge counts as within n of it, whatever the rounding of the mesh generator: this
   part of a face size is allowed beyond n. */
static const PetscReal RING_TOLERANCE = 1e-6;
/* Columns of the table of a pair's slave nodes, which is sorted by node_id */
enum {
  SLAVE_ID,
  SLAVE_REFERENCE,
  SLAVE_POSITION = SLAVE_REFERENCE + 3,
  SLAVE_AREA     = SLAVE_POSITION + 3,
  SLAVE_PRESSURE,
  SLAVE_COLUMNS
};

typedef enum { NAMES_NOTHING, NAMES_SURFACE, NAMES_PAIR } ProbeNames;

typedef struct {
  const char *key;   /* that names the kind in the scene */
  ProbeNames  names; /* what the scene gives under that key */
  int         points;
  const char *points_key; /* what the scene gives them under */
  PetscErrorCode (*evaluate)(Probes, Probe *, PetscReal *);
} ProbeType;

/* Tells whether a reference coordinate is the one that `at` asks for. */
static PetscBool ProbeIsAt(Probes probes, const Probe *probe, PetscReal coordinate)
{
  const PetscReal distance = PetscAbsReal(coordinate - probe->scene->at_value);

  return distance <= PROBE_POINT_TOLERANCE * probes->model->mesh->size ? PETSC_TRUE : PETSC_FALSE;
}

/* Refuses a value of `at` that no slave node has, and names the nearest one. Collective. */
static PetscErrorCode ProbesCheckAt(Probes probes, const Probe *probe)
{
  const Mesh      mesh     = probes->model->mesh;
  const int       axis     = probe->scene->at_axis;
  const PetscReal asked    = probe->scene->at_value;
  PetscReal       sides[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}; /* distance to the nearest node below, above */

  PetscFunctionBeginUser;
  if (!probe->scene->has_at) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < probe->group->n_nodes; k++) {
    const PetscReal x = mesh->coords[probe->group->nodes[k] * mesh->dim + axis] + mesh->centre[axis] - asked;

    sides[x > 0.0] = PetscMin(sides[x > 0.0], PetscAbsReal(x));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sides, 2, MPIU_REAL, MPI_MIN, mesh->comm));
  if (PetscMin(sides[0], sides[1]) > PROBE_POINT_TOLERANCE * mesh->size) {
    const PetscReal nearest = asked + (sides[0] < sides[1] ? -sides[0] : sides[1]);

    PetscCall(RefuseInput(mesh->comm,
                          "%s: no node of the slave surface \"%s\" has the reference coordinate %c = %.9g; allowed: a "
                          "node's coordinate, the nearest is %.9g",
                          SceneWhere(probes->scene, probe->scene->path, "at"), probe->group->name, "xyz"[axis],
                          (double)asked, (double)nearest));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the slave nodes that carry area in the present state. Collective. */
static PetscErrorCode ProbesGetSlaves(Probes probes, int pair, const GatherTable **table)
{
  const Model  model = probes->model;
  const Mesh   mesh  = model->mesh;
  ContactNodes slaves;
  PetscReal   *rows;

  PetscFunctionBeginUser;
  *table = &probes->slaves[pair];
  if ((*table)->row) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGetNodes(model->contact, pair, model->u, &slaves));
  PetscCall(PetscCalloc1(slaves.n * SLAVE_COLUMNS, &rows));
  for (PetscInt k = 0; k < slaves.n; k++) {
    PetscReal     *row  = &rows[k * SLAVE_COLUMNS];
    const PetscInt node = slaves.node[k];

    row[SLAVE_ID] = (PetscReal)mesh->node_id[node];
    for (int i = 0; i < mesh->dim; i++) {
      row[SLAVE_REFERENCE + i] = mesh->coords[node * mesh->dim + i] + mesh->centre[i];
      row[SLAVE_POSITION + i]  = row[SLAVE_REFERENCE + i] + model->u[node * mesh->dim + i];
    }
    row[SLAVE_AREA]     = slaves.area[k];
    row[SLAVE_PRESSURE] = slaves.pressure[k];
  }
  PetscCall(GatherTableCreate(mesh->comm, SLAVE_COLUMNS, slaves.n, rows, &probes->slaves[pair]));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether the probe counts a slave node. */
static PetscBool ProbeKeeps(const Probe *probe, const PetscReal *slave)
{
  PetscBool near;

  if (!probe->free_edges) return PETSC_TRUE;
  near = FreeEdgesDistance(probe->free_edges, &slave[SLAVE_REFERENCE]) <=
             (probe->scene->edge_faces + RING_TOLERANCE) * probe->face_size
           ? PETSC_TRUE
           : PETSC_FALSE;
  return (probe->scene->edge_filter == 2) == near ? PETSC_TRUE : PETSC_FALSE;
}

/* Sums the forces that move or hold a tool, or their moments: those of all pairs whose master it is, with the other
   sign. */
static PetscErrorCode ToolReaction(Probes probes, const Probe                                        *probe,
                                   PetscErrorCode (*on_master)(Contact, int, PetscReal[3]), PetscReal sum[3])
{
  PetscReal part[3];

  PetscFunctionBeginUser;
  sum[0] = sum[1] = sum[2] = 0;
  for (int p = 0; p < probes->scene->n_contacts; p++) {
    if (!SceneContactHasMaster(&probes->scene->contacts[p], probe->scene->target)) continue;
    PetscCall(on_master(probes->model->contact, p, part));
    for (int d = 0; d < 3; d++) sum[d] -= part[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateReaction(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal force[3];

  PetscFunctionBeginUser;
  if (ProbeOfTool(probes, probe))
    PetscCall(ToolReaction(probes, probe, ContactMasterForce, force));
  else
    PetscCall(ProblemReaction(probes->model->problem, probe->group, force, NULL));
  *value = force[probe->scene->component];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The moment of forces about the axis of a probe, from that about the origin. */
static PetscReal AboutAxis(const Probe *probe, const PetscReal force[3], const PetscReal moment[3])
{
  const int     i = (probe->scene->axis + 1) % 3, j = (probe->scene->axis + 2) % 3;
  const double *X = probe->scene->point[0];

  return moment[probe->scene->axis] - (X[i] * force[j] - X[j] * force[i]);
}

static PetscErrorCode EvaluateReactionTorque(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal force[3], moment[3];

  PetscFunctionBeginUser;
  if (ProbeOfTool(probes, probe)) {
    PetscCall(ToolReaction(probes, probe, ContactMasterForce, force));
    PetscCall(ToolReaction(probes, probe, ContactMasterMoment, moment));
  } else
    PetscCall(ProblemReaction(probes->model->problem, probe->group, force, moment));
  *value = AboutAxis(probe, force, moment);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateContactForce(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal force[3];

  PetscFunctionBeginUser;
  PetscCall(ContactMasterForce(probes->model->contact, probe->pair, force));
  *value = force[probe->scene->component];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateContactTorque(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal force[3], moment[3];

  PetscFunctionBeginUser;
  PetscCall(ContactMasterForce(probes->model->contact, probe->pair, force));
  PetscCall(ContactMasterMoment(probes->model->contact, probe->pair, moment));
  *value = AboutAxis(probe, force, moment);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion of the tool that is the master of the probe's pair: six components, lengths and radians. */
static void ToolComponents(Probes probes, const Probe *probe, PetscReal q[MOTION_COMPONENTS])
{
  const Scene         scene   = probes->model->scene;
  const SceneContact *contact = &scene->contacts[probe->pair];
  const int           body    = contact->master ? MeshFindBody(scene, contact->master, PETSC_TRUE) : -1;

  MotionComponents(body < 0 ? &contact->motion : &scene->bodies[body].motion, probes->model->t, q);
}

static PetscErrorCode EvaluateToolMotion(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal q[MOTION_COMPONENTS];

  PetscFunctionBeginUser;
  ToolComponents(probes, probe, q);
  *value = q[probe->scene->component];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateToolRotation(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal q[MOTION_COMPONENTS];

  PetscFunctionBeginUser;
  ToolComponents(probes, probe, q);
  *value = q[3 + probe->scene->component] * 180 / PETSC_PI;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateBoltForce(Probes probes, Probe *probe, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(ProblemBoltForce(probes->model->problem, probe->scene->target, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateBoltShortening(Probes probes, Probe *probe, PetscReal *value)
{
  const MeshTool *bolt = ToolOfBolt(probes->model->mesh, probe->scene->target);

  PetscFunctionBeginUser;
  *value = probes->model->u[bolt->node * probes->model->mesh->dim];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateDisplacement(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal u[3];

  PetscFunctionBeginUser;
  PetscCall(ProbePointValue(probes, &probe->point[0], probes->model->u, u));
  *value = u[probe->scene->component];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateDistance(Probes probes, Probe *probe, PetscReal *value)
{
  const Model model = probes->model;
  const int   dim   = model->mesh->dim;
  PetscReal   X[2][3], u[2][3], before = 0.0, now = 0.0;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(ProbePointValue(probes, &probe->point[k], model->mesh->coords, X[k]));
    PetscCall(ProbePointValue(probes, &probe->point[k], model->u, u[k]));
  }
  for (int i = 0; i < dim; i++) {
    const PetscReal reference = X[1][i] - X[0][i];

    before += PetscSqr(reference);
    now += PetscSqr(reference + (u[1][i] - u[0][i]));
  }
  *value = PetscSqrtReal(now) - (probe->scene->change ? PetscSqrtReal(before) : 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateGap(Probes probes, Probe *probe, PetscReal *value)
{
  const Model model = probes->model;

  PetscFunctionBeginUser;
  PetscCall(ContactGapAt(model->contact, probe->pair, model->u, model->t, probe->point[0].id, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds where the slave surface ends along a contact edge's axis, min and max, on the line of nodes that `at` picks.
   Collective. */
static PetscErrorCode ProbesLineEnds(Probes probes, const Probe *probe, PetscReal ends[2])
{
  const Mesh        mesh  = probes->model->mesh;
  const SceneProbe *scene = probe->scene;

  PetscFunctionBeginUser;
  ends[0] = ends[1] = -PETSC_MAX_REAL; /* of -x and x */
  for (PetscInt k = 0; k < probe->group->n_nodes; k++) {
    const PetscInt  node = probe->group->nodes[k] * mesh->dim;
    const PetscReal x =
      mesh->coords[node + scene->axis] + mesh->centre[scene->axis] + probes->model->u[node + scene->axis];

    if (scene->has_at && !ProbeIsAt(probes, probe, mesh->coords[node + scene->at_axis] + mesh->centre[scene->at_axis]))
      continue;
    ends[0] = PetscMax(ends[0], -x);
    ends[1] = PetscMax(ends[1], x);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPIU_REAL, MPI_MAX, mesh->comm));
  ends[0] = -ends[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the end of the contact zone along an axis. Second-order nodes at the end of the line may carry no area
   (corners of triangles, the node on the axis of revolution). They have no pressure of their own, and get that of the
   last node that has one. */
static PetscErrorCode EvaluateContactEdge(Probes probes, Probe *probe, PetscReal *value)
{
  const GatherTable *slaves;
  PetscReal         *line, ends[2]; /* line: position and pressure of the nodes on it, from row 1 on */
  double            *x, *p;
  int                n = 0, first = 1;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  PetscCall(ProbesLineEnds(probes, probe, ends));
  PetscCall(PetscMalloc3((slaves->n + 2) * 2, &line, slaves->n + 2, &x, slaves->n + 2, &p));
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (probe->scene->has_at && !ProbeIsAt(probes, probe, slave[SLAVE_REFERENCE + probe->scene->at_axis])) continue;
    n++;
    line[2 * n]     = slave[SLAVE_POSITION + probe->scene->axis];
    line[2 * n + 1] = slave[SLAVE_PRESSURE];
  }
  qsort(&line[2], (size_t)n, 2 * sizeof(PetscReal), GatherTableCompare);
  if (n && ends[1] > line[2 * n]) {
    line[2 * n + 2] = ends[1];
    line[2 * n + 3] = line[2 * n + 1];
    n++;
  }
  if (n && ends[0] < line[2]) {
    line[0] = ends[0];
    line[1] = line[3];
    first   = 0;
    n++;
  }
  for (int k = 0; k < n; k++) {
    x[k] = line[2 * (first + k)];
    p[k] = line[2 * (first + k) + 1];
  }
  *value = ContactEdge(ContactPairIsSurface(probes->model->contact, probe->pair) ? EDGE_OF_HATS : EDGE_AT_NODES, n, x,
                       p, probe->scene->max_side, &probe->spacing);
  PetscCall(PetscFree3(line, x, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluatePressureMax(Probes probes, Probe *probe, PetscReal *value)
{
  const GatherTable *slaves;
  PetscReal          most = 0.0;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (probe->scene->has_at && !ProbeIsAt(probes, probe, slave[SLAVE_REFERENCE + probe->scene->at_axis])) continue;
    most = PetscMax(most, slave[SLAVE_PRESSURE]);
  }
  *value = most > 0.0 ? most : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProbeMeanWeights(Probes probes, const Probe *probe, ContactNodes *slaves, PetscReal **weight,
                                PetscReal *sum)
{
  const Model model = probes->model;
  const Mesh  mesh  = model->mesh;
  PetscReal  *area  = NULL;

  PetscFunctionBeginUser;
  PetscCall(ContactGetNodes(model->contact, probe->pair, model->u, slaves));
  PetscCall(PetscMalloc1(slaves->n, weight));
  if (probe->scene->within > 0) {
    PetscReal middle[3] = {probe->scene->point[0][0], probe->scene->point[0][1], probe->scene->point[0][2]};

    PetscCall(PetscMalloc1(mesh->n_nodes, &area));
    PetscCall(ContactPatchAreas(model->contact, probe->pair, middle, probe->scene->within, area));
  }
  *sum = 0;
  for (PetscInt k = 0; k < slaves->n; k++) {
    (*weight)[k] = area ? area[slaves->node[k]] : slaves->area[k];
    *sum += (*weight)[k];
  }
  PetscCall(PetscFree(area));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPIU_REAL, MPIU_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* NaN without contact or without a node. */
static PetscErrorCode EvaluatePressureMean(Probes probes, Probe *probe, PetscReal *value)
{
  ContactNodes slaves;
  PetscReal   *weight, area, force = 0;

  PetscFunctionBeginUser;
  PetscCall(ProbeMeanWeights(probes, probe, &slaves, &weight, &area));
  for (PetscInt k = 0; k < slaves.n; k++) force += weight[k] * slaves.pressure[k];
  PetscCall(PetscFree(weight));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &force, 1, MPIU_REAL, MPIU_SUM, probes->model->mesh->comm));
  *value = force > 0 ? force / area : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the area-weighted mean pressure over the slave nodes that the probe counts, and their area. NaN without
   contact or without a node. */
static PetscReal MeanPressure(const Probe *probe, const GatherTable *slaves, PetscReal *area)
{
  PetscReal force = 0;

  *area = 0;
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (!ProbeKeeps(probe, slave)) continue;
    *area += slave[SLAVE_AREA];
    force += slave[SLAVE_AREA] * slave[SLAVE_PRESSURE];
  }
  return force > 0 ? force / *area : NAN;
}

static PetscErrorCode EvaluatePressureDeviation(Probes probes, Probe *probe, PetscReal *value)
{
  const GatherTable *slaves;
  PetscReal          area, mean, most = 0.0, square = 0.0;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  mean = MeanPressure(probe, slaves, &area);
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];
    const PetscReal  off   = slave[SLAVE_PRESSURE] - mean;

    if (!ProbeKeeps(probe, slave)) continue;
    most = PetscMax(most, PetscAbsReal(off));
    square += slave[SLAVE_AREA] * PetscSqr(off);
  }
  *value = 100.0 * (probe->scene->rms ? PetscSqrtReal(square / area) : most) / mean; /* NaN where the mean is */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateContactArea(Probes probes, Probe *probe, PetscReal *value)
{
  const GatherTable *slaves;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  *value = 0.0;
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (slave[SLAVE_PRESSURE] > 0.0) *value += slave[SLAVE_AREA];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A figure of a pair's friction. */
static PetscErrorCode EvaluateFriction(Probes probes, Probe *probe, PetscReal *value)
{
  ContactFriction friction;

  PetscFunctionBeginUser;
  PetscCall(ContactPairFriction(probes->model->contact, probe->pair, &friction));
  switch (probe->scene->kind) {
  case PROBE_FRICTION_FORCE: *value = -friction.force[probe->scene->component]; break;
  case PROBE_SLIPPED_AREA: *value = friction.slipped_area; break;
  default: *value = friction.elastic; /* PROBE_ELASTIC_SLIP */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateFrictionTorque(Probes probes, Probe *probe, PetscReal *value)
{
  ContactFriction friction;
  PetscReal       force[3];

  PetscFunctionBeginUser;
  PetscCall(ContactPairFriction(probes->model->contact, probe->pair, &friction));
  for (int d = 0; d < 3; d++) force[d] = -friction.force[d];
  *value = AboutAxis(probe, force, friction.moment);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateFluidFront(Probes probes, Probe *probe, PetscReal *value)
{
  const Fluids     fluids = probes->model->problem->fluids;
  const PetscReal *u;
  PetscReal        t;

  PetscFunctionBeginUser;
  PetscCall(ModelGetAccepted(probes->model, &u, &t));
  PetscCall(FluidFront(fluids, FluidFind(fluids, probe->scene->target), u, probe->scene->axis,
                       (PetscBool)probe->scene->max_side, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateFluidArea(Probes probes, Probe *probe, PetscReal *value)
{
  const Fluids fluids = probes->model->problem->fluids;
  FluidReport  report;

  PetscFunctionBeginUser;
  FluidGetReport(fluids, FluidFind(fluids, probe->scene->target), &report);
  *value = report.wetted;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateSealPressure(Probes probes, Probe *probe, PetscReal *value)
{
  const Fluids fluids = probes->model->problem->fluids;
  FluidReport  report;

  PetscFunctionBeginUser;
  FluidGetReport(fluids, FluidFind(fluids, probe->scene->target), &report);
  *value = report.barrier;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const ProbeType types[PROBE_KINDS] = {
  [PROBE_REACTION]           = {"reaction", NAMES_SURFACE, 0, NULL, EvaluateReaction},
  [PROBE_CONTACT_FORCE]      = {"contact_force", NAMES_PAIR, 0, NULL, EvaluateContactForce},
  [PROBE_DISPLACEMENT]       = {"displacement", NAMES_NOTHING, 1, "displacement", EvaluateDisplacement},
  [PROBE_DISTANCE]           = {"distance", NAMES_NOTHING, 2, "distance", EvaluateDistance},
  [PROBE_GAP]                = {"gap", NAMES_PAIR, 1, "at", EvaluateGap},
  [PROBE_CONTACT_EDGE]       = {"contact_edge", NAMES_PAIR, 0, NULL, EvaluateContactEdge},
  [PROBE_PRESSURE_MAX]       = {"pressure_max", NAMES_PAIR, 0, NULL, EvaluatePressureMax},
  [PROBE_PRESSURE_MEAN]      = {"pressure_mean", NAMES_PAIR, 0, NULL, EvaluatePressureMean},
  [PROBE_PRESSURE_DEVIATION] = {"pressure_deviation", NAMES_PAIR, 0, NULL, EvaluatePressureDeviation},
  [PROBE_CONTACT_AREA]       = {"contact_area", NAMES_PAIR, 0, NULL, EvaluateContactArea},
  [PROBE_REACTION_TORQUE]    = {"reaction_torque", NAMES_SURFACE, 0, NULL, EvaluateReactionTorque},
  [PROBE_CONTACT_TORQUE]     = {"contact_torque", NAMES_PAIR, 0, NULL, EvaluateContactTorque},
  [PROBE_FRICTION_FORCE]     = {"friction_force", NAMES_PAIR, 0, NULL, EvaluateFriction},
  [PROBE_FRICTION_TORQUE]    = {"friction_torque", NAMES_PAIR, 0, NULL, EvaluateFrictionTorque},
  [PROBE_SLIPPED_AREA]       = {"slipped_area", NAMES_PAIR, 0, NULL, EvaluateFriction},
  [PROBE_ELASTIC_SLIP]       = {"elastic_slip", NAMES_PAIR, 0, NULL, EvaluateFriction},
  [PROBE_TOOL_MOTION]        = {"tool_motion", NAMES_PAIR, 0, NULL, EvaluateToolMotion},
  [PROBE_TOOL_ROTATION]      = {"tool_rotation", NAMES_PAIR, 0, NULL, EvaluateToolRotation},
  [PROBE_BOLT_FORCE]         = {"bolt_force", NAMES_NOTHING, 0, NULL, EvaluateBoltForce},
  [PROBE_BOLT_SHORTENING]    = {"bolt_shortening", NAMES_NOTHING, 0, NULL, EvaluateBoltShortening},
  [PROBE_FLUID_FRONT]        = {"fluid_front", NAMES_SURFACE, 0, NULL, EvaluateFluidFront},
  [PROBE_FLUID_AREA]         = {"fluid_area", NAMES_SURFACE, 0, NULL, EvaluateFluidArea},
  [PROBE_SEAL_PRESSURE]      = {"seal_pressure", NAMES_SURFACE, 0, NULL, EvaluateSealPressure},
};

/* Resolves what a probe's kind refers to. Collective. */
static PetscErrorCode ProbesPrepare(Probes probes, Probe *probe)
{
  const Mesh        mesh  = probes->model->mesh;
  const SceneProbe *scene = probe->scene;
  const ProbeType  *type  = &types[scene->kind];
  MeshGroup        *surface;

  PetscFunctionBeginUser;
  if (type->names == NAMES_SURFACE) {
    PetscCall(MeshGetGroup(mesh, probes->scene, scene->path, type->key, scene->target, mesh->dim, &surface));
    probe->group = surface;
  } else if (type->names == NAMES_PAIR) {
    probe->pair =
      ContactFindPair(probes->model->contact, scene->target); /* the scene has made sure that there is one */
    PetscCall(ContactPairSurface(probes->model->contact, probe->pair, &probe->group, &probe->face_size));
    PetscCall(ProbesCheckAt(probes, probe));
    if (scene->edge_filter)
      PetscCall(
        FreeEdgesCreate(mesh, probes->scene, &probes->scene->contacts[probe->pair], probe->group, &probe->free_edges));
  }
  for (int i = 0; i < type->points; i++)
    PetscCall(ProbePointFind(probes, probe, type->points_key, i, type->names == NAMES_PAIR ? probe->group : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the body of every local node by its cells. Bodies share no nodes. */
static PetscErrorCode ProbesFindNodeBodies(Probes probes)
{
  const Mesh mesh = probes->model->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &probes->node_body));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) probes->node_body[n] = -1;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      probes->node_body[mesh->cell_nodes[k]] = mesh->cell_body[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbesCreate - resolves the scene's probes in a model.

  Collective

  Input Parameters:
+ model - with its mesh and contact
- scene - of the model

  Output Parameter:
. result - free it with ProbesDestroy()

  Note:
  It refuses surfaces, pairs and volumes that do not exist, points outside of the bodies (naming the nearest node),
  and points of several bodies where none is named.
@*/
PetscErrorCode ProbesCreate(Model model, Scene scene, Probes *result)
{
  Probes probes;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&probes));
  *result       = probes; /* ProbesDestroy() frees what a refusal leaves */
  probes->model = model;
  probes->scene = scene;
  PetscCall(PetscCalloc1(scene->n_probes, &probes->probe));
  PetscCall(PetscCalloc1(scene->n_contacts, &probes->slaves));
  PetscCall(ProbesFindNodeBodies(probes));
  for (int i = 0; i < scene->n_probes; i++) {
    probes->probe[i] = (Probe){.scene = &scene->probes[i], .spacing = NAN};
    PetscCall(ProbesPrepare(probes, &probes->probe[i]));
  }
  PetscCall(PetscFree(probes->node_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbesDestroy - frees the probes.

  Not collective

  Input Parameter:
. probes - set to NULL
@*/
PetscErrorCode ProbesDestroy(Probes *probes)
{
  PetscFunctionBeginUser;
  if (!*probes) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < (*probes)->scene->n_probes; i++) PetscCall(FreeEdgesDestroy(&(*probes)->probe[i].free_edges));
  PetscCall(PetscFree((*probes)->probe));
  PetscCall(PetscFree((*probes)->slaves));
  PetscCall(PetscFree((*probes)->node_body));
  PetscCall(PetscFree(*probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbesEvaluate - evaluates all probes in the model's present state.

  Collective

  Input Parameter:
. probes - the probes

  Output Parameter:
. values - of the scene's probes: forces, lengths, pressures or per cent by kind, after `absolute` and `factor`; NaN
           where there is no value, for instance without contact

  Note:
  The values are the same on all ranks and on any number of them.
@*/
PetscErrorCode ProbesEvaluate(Probes probes, PetscReal values[])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < probes->scene->n_probes; i++) {
    const SceneProbe *scene = &probes->scene->probes[i];

    PetscCall(types[scene->kind].evaluate(probes, &probes->probe[i], &values[i]));
    probes->probe[i].plain = values[i];
    if (scene->absolute) values[i] = PetscAbsReal(values[i]);
    values[i] *= scene->factor;
  }
  for (int p = 0; p < probes->scene->n_contacts; p++) PetscCall(GatherTableDestroy(&probes->slaves[p]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProbesGetSpacing - gives the node spacing (length) around the contact edge of a probe at the last evaluation.

  Not collective

  Input Parameters:
+ probes - the probes
- i      - number of the probe

  Output Parameter:
. spacing - NaN for other kinds of probes and without contact
@*/
PetscErrorCode ProbesGetSpacing(Probes probes, int i, PetscReal *spacing)
{
  PetscFunctionBeginUser;
  *spacing = probes->probe[i].spacing;
  PetscFunctionReturn(PETSC_SUCCESS);
}
