#include "probe.h"
#include "refusal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A probe's point is a node's reference coordinate to within this part of the model's size: what hand-written scene files can be expected to meet. */
static const PetscReal POINT_TOLERANCE = 1e-6;
/* A node n face sizes from an edge counts as within n of it, whatever the rounding of the mesh generator, as part of a face size. */
static const PetscReal RING_TOLERANCE = 1e-6;
enum { MESSAGE_SIZE = 2048 };

/* A table that is the same on every rank: rows of reals, ascending by the first two columns */
typedef struct {
  PetscInt   n;
  int        width;
  PetscReal *row;
} Table;

/* Slave nodes of a pair, by node_id */
enum { SLAVE_ID, SLAVE_REFERENCE, SLAVE_POSITION = SLAVE_REFERENCE + 3, SLAVE_AREA = SLAVE_POSITION + 3, SLAVE_PRESSURE, SLAVE_COLUMNS };
/* Edges of slave faces, by the node_ids of their ends */
enum { EDGE_LOW, EDGE_HIGH, EDGE_A, EDGE_B = EDGE_A + 3, EDGE_SYMMETRIC = EDGE_B + 3, EDGE_COLUMNS };

typedef struct {
  const SceneProbe *scene;
  const MeshGroup  *group; /* reaction; slave surface of the pair */
  int               pair;
  PetscInt          id[2];   /* node_id of the points */
  PetscInt          node[2]; /* the local node on its owner, -1 elsewhere */
  Table             free_edges;
  PetscReal         face_size; /* mean, of the slave surface */
  PetscReal         spacing;
} Probe;

struct _n_Probes {
  Model  model;
  Scene  scene;
  int   *node_body; /* index into scene->bodies, during the preparation */
  Probe *probe;
  Table *slaves; /* per pair, of the evaluation under way; row NULL: not asked for yet */
};

typedef struct {
  const char *key; /* that names the kind in the scene */
  PetscErrorCode (*prepare)(Probes, Probe *, const char *key);
  PetscErrorCode (*evaluate)(Probes, Probe *, PetscReal *);
} ProbeType;

/* Compares rows by their first two columns */
static int RowCompare(const void *a, const void *b)
{
  const PetscReal *p = a, *q = b;

  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Joins the ranks' rows; every rank gets the whole table. Collective. */
static PetscErrorCode TableGather(MPI_Comm comm, int width, PetscInt n, const PetscReal *rows, Table *table)
{
  PetscMPIInt size, mine, total = 0, *count, *start;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n * width, &mine));
  PetscCall(PetscMalloc2(size, &count, size, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    start[r] = total;
    total += count[r];
  }
  table->n     = total / width;
  table->width = width;
  PetscCall(PetscMalloc1(total + 1, &table->row)); /* never NULL, an empty table neither */
  PetscCallMPI(MPI_Allgatherv(rows, mine, MPIU_REAL, table->row, count, start, MPIU_REAL, comm));
  qsort(table->row, (size_t)table->n, (size_t)width * sizeof(PetscReal), RowCompare);
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TableDestroy(Table *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(table->row));
  table->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "(1, 2, 3)" of dim coordinates; text belongs to the caller */
static const char *PointText(int dim, const PetscReal *x, char text[128])
{
  if (dim == 3)
    snprintf(text, 128, "(%.9g, %.9g, %.9g)", (double)x[0], (double)x[1], (double)x[2]);
  else
    snprintf(text, 128, "(%.9g, %.9g)", (double)x[0], (double)x[1]);
  return text;
}

/* Values that one rank knows of a node, on all ranks. local: the node on its owner, else -1. Collective. */
static PetscErrorCode ProbesShare(Probes probes, PetscInt local, int n, const PetscReal *mine, PetscReal *shared)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) shared[i] = local < 0 ? 0.0 : mine[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shared, n, MPIU_REAL, MPI_SUM, probes->model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The local node of a node_id where this rank owns it, else -1 */
static PetscErrorCode ProbesLocalNode(Probes probes, PetscInt id, PetscInt *local)
{
  const Mesh  mesh = probes->model->mesh;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  *local = -1;
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    if (mesh->node_id[n] == id && mesh->node_owner[n] == rank) *local = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ProbesFindBody(Probes probes, const Probe *probe, int *body)
{
  const Scene scene               = probes->scene;
  char        names[MESSAGE_SIZE] = "";

  PetscFunctionBeginUser;
  *body = -1;
  if (!probe->scene->body) PetscFunctionReturn(PETSC_SUCCESS);
  for (int b = 0; b < scene->n_bodies; b++) {
    if (scene->bodies[b].rigid) continue;
    if (!strcmp(scene->bodies[b].name, probe->scene->body)) *body = b;
    PetscCall(PetscStrlcat(names, *names ? ", " : "", sizeof(names)));
    PetscCall(PetscStrlcat(names, scene->bodies[b].name, sizeof(names)));
  }
  if (*body < 0)
    PetscCall(RefuseInput(probes->model->mesh->comm, "%s: there is no volume \"%s\" among the bodies; allowed: %s",
                          SceneWhere(scene, probe->scene->path, "body"), probe->scene->body, names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What this rank, then all ranks, know of the nodes around a point */
typedef struct {
  PetscReal distance; /* of the nearest node */
  PetscInt  nearest;  /* its node_id; the smallest where several are as near */
  PetscInt  id;       /* smallest node_id within the tolerance */
} Nearby;

/* Looks through the local nodes (of a group, or all), of one body or any (-1); at[body] counts nodes at the point. */
static void ProbesLookAround(Probes probes, const PetscReal point[3], const MeshGroup *within, int body, Nearby *nearby, PetscInt *at)
{
  const Mesh     mesh = probes->model->mesh;
  const PetscInt n    = within ? within->n_nodes : mesh->n_nodes;

  *nearby = (Nearby){.distance = PETSC_MAX_REAL, .nearest = PETSC_MAX_INT, .id = PETSC_MAX_INT};
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt node   = within ? within->nodes[k] : k;
    PetscReal      square = 0.0, distance;

    if (body >= 0 && probes->node_body[node] != body) continue;
    for (int i = 0; i < mesh->dim; i++) square += PetscSqr(mesh->coords[node * mesh->dim + i] + mesh->centre[i] - point[i]);
    distance = PetscSqrtReal(square);
    if (distance < nearby->distance || (distance == nearby->distance && mesh->node_id[node] < nearby->nearest)) {
      nearby->distance = distance;
      nearby->nearest  = mesh->node_id[node];
    }
    if (distance > POINT_TOLERANCE * mesh->size) continue;
    nearby->id = PetscMin(nearby->id, mesh->node_id[node]);
    if (probes->node_body[node] >= 0) at[probes->node_body[node]] = 1;
  }
}

/* No node at the point: names the nearest one. Does not return. Collective. */
static PetscErrorCode ProbesRefusePoint(Probes probes, const Probe *probe, const char *key, const PetscReal point[3], const Nearby *nearby)
{
  const Mesh mesh    = probes->model->mesh;
  PetscReal  mine[4] = {0}, shared[4];
  PetscInt   local;
  char       asked[128], found[128];

  PetscFunctionBeginUser;
  PetscCall(ProbesLocalNode(probes, nearby->nearest, &local));
  if (local >= 0) {
    for (int i = 0; i < mesh->dim; i++) mine[i] = mesh->coords[local * mesh->dim + i] + mesh->centre[i];
    mine[3] = (PetscReal)mesh->node_tag[local];
  }
  PetscCall(ProbesShare(probes, local, 4, mine, shared));
  PetscCall(RefuseInput(
    mesh->comm, "%s: no node at %s%s; allowed: reference coordinates of a node, to within %g of the model's size; the nearest is node %.0f at %s, %.3g away",
    SceneWhere(probes->scene, probe->scene->path, key), PointText(mesh->dim, point, asked), probe->scene->target ? " on the slave surface" : "",
    (double)POINT_TOLERANCE, (double)shared[3], PointText(mesh->dim, shared, found), (double)nearby->distance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bodies have a node at the point and the scene does not say which is meant. Does not return. Collective. */
static PetscErrorCode ProbesRefuseBodies(Probes probes, const Probe *probe, const char *key, const PetscReal point[3], const PetscInt *at)
{
  char names[MESSAGE_SIZE] = "", asked[128];

  PetscFunctionBeginUser;
  for (int b = 0; b < probes->scene->n_bodies; b++) {
    if (!at[b]) continue;
    PetscCall(PetscStrlcat(names, *names ? ", " : "", sizeof(names)));
    PetscCall(PetscStrlcat(names, probes->scene->bodies[b].name, sizeof(names)));
  }
  PetscCall(RefuseInput(probes->model->mesh->comm, "%s: several bodies have a node at %s; \"body\" must say which; allowed: %s",
                        SceneWhere(probes->scene, probe->scene->path, key), PointText(probes->model->mesh->dim, point, asked), names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node at point number `which` of a probe, of all nodes or of a group's. Refuses a point without node and one where the body is left open. Collective. */
static PetscErrorCode ProbesFindNode(Probes probes, Probe *probe, const char *key, int which, const MeshGroup *within)
{
  const MPI_Comm   comm  = probes->model->mesh->comm;
  const PetscReal *point = probe->scene->point[which];
  PetscInt        *at, bodies = 0;
  PetscReal        least;
  Nearby           nearby;
  int              body;

  PetscFunctionBeginUser;
  PetscCall(ProbesFindBody(probes, probe, &body));
  PetscCall(PetscCalloc1(probes->scene->n_bodies, &at));
  ProbesLookAround(probes, point, within, body, &nearby, at);
  PetscCallMPI(MPI_Allreduce(&nearby.distance, &least, 1, MPIU_REAL, MPI_MIN, comm));
  if (nearby.distance > least) nearby.nearest = PETSC_MAX_INT;
  nearby.distance = least;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &nearby.nearest, 1, MPIU_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &nearby.id, 1, MPIU_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, at, probes->scene->n_bodies, MPIU_INT, MPI_MAX, comm));
  if (nearby.id == PETSC_MAX_INT) PetscCall(ProbesRefusePoint(probes, probe, key, point, &nearby));
  for (int b = 0; b < probes->scene->n_bodies; b++) bodies += at[b];
  if (bodies > 1) PetscCall(ProbesRefuseBodies(probes, probe, key, point, at));
  PetscCall(PetscFree(at));
  probe->id[which] = nearby.id;
  PetscCall(ProbesLocalNode(probes, nearby.id, &probe->node[which]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The contact pair and its slave surface. Refuses an unknown name. Collective. */
static PetscErrorCode ProbesFindPair(Probes probes, Probe *probe, const char *key)
{
  const Scene   scene               = probes->scene;
  const Contact contact             = probes->model->contact;
  char          names[MESSAGE_SIZE] = "";

  PetscFunctionBeginUser;
  probe->pair = contact ? ContactFindPair(contact, probe->scene->target) : -1;
  if (probe->pair < 0) {
    for (int p = 0; p < scene->n_contacts; p++) {
      PetscCall(PetscStrlcat(names, p ? ", " : "", sizeof(names)));
      PetscCall(PetscStrlcat(names, scene->contacts[p].name, sizeof(names)));
    }
    PetscCall(RefuseInput(probes->model->mesh->comm, "%s: there is no contact pair \"%s\"; allowed: %s", SceneWhere(scene, probe->scene->path, key),
                          probe->scene->target, *names ? names : "none, the scene has no contact"));
  }
  PetscCall(ContactPairSurface(contact, probe->pair, &probe->group, &probe->face_size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a reference coordinate the one that `at` asks for? */
static PetscBool ProbeIsAt(Probes probes, const Probe *probe, PetscReal coordinate)
{
  const PetscReal distance = PetscAbsReal(coordinate - probe->scene->at_value);

  return distance <= POINT_TOLERANCE * probes->model->mesh->size ? PETSC_TRUE : PETSC_FALSE;
}

/* Refuses a value of `at` that no slave node has: names the nearest one. Collective. */
static PetscErrorCode ProbesCheckAt(Probes probes, const Probe *probe)
{
  const Mesh mesh     = probes->model->mesh;
  const int  axis     = probe->scene->at_axis;
  PetscReal  sides[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}; /* distance to the nearest node below, above */

  PetscFunctionBeginUser;
  if (!probe->scene->has_at) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < probe->group->n_nodes; k++) {
    const PetscReal x = mesh->coords[probe->group->nodes[k] * mesh->dim + axis] + mesh->centre[axis] - probe->scene->at_value;

    sides[x > 0.0] = PetscMin(sides[x > 0.0], PetscAbsReal(x));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sides, 2, MPIU_REAL, MPI_MIN, mesh->comm));
  if (PetscMin(sides[0], sides[1]) > POINT_TOLERANCE * mesh->size) {
    const PetscReal nearest = probe->scene->at_value + (sides[0] < sides[1] ? -sides[0] : sides[1]);

    PetscCall(RefuseInput(mesh->comm,
                          "%s: no node of the slave surface \"%s\" has the reference coordinate %c = %.9g; allowed: a node's coordinate, the nearest is %.9g",
                          SceneWhere(probes->scene, probe->scene->path, "at"), probe->group->name, "xyz"[axis], probe -> scene -> at_value, (double)nearest));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slave nodes that carry area, of the present state. Collective. */
static PetscErrorCode ProbesGetSlaves(Probes probes, int pair, const Table **table)
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
  PetscCall(TableGather(mesh->comm, SLAVE_COLUMNS, slaves.n, rows, &probes->slaves[pair]));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are all the corners on one of the planes beyond which the pair continues as its mirror image (the axis of revolution is one)? */
static PetscErrorCode ProbesOnSymmetry(Probes probes, const SceneContact *contact, int n, const PetscInt *nodes, PetscBool *on)
{
  const Mesh mesh = probes->model->mesh;
  MeshGroup *plane;

  PetscFunctionBeginUser;
  *on = probes->scene->geometry == GEOMETRY_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < n && *on; i++)
    if (PetscAbsReal(mesh->coords[nodes[i] * mesh->dim] + mesh->centre[0]) > POINT_TOLERANCE * mesh->size) *on = PETSC_FALSE;
  for (int s = 0; s < contact->n_symmetry && !*on; s++) {
    PetscCall(MeshGetGroup(mesh, probes->scene, contact->path, "symmetry", contact->symmetry[s], mesh->dim - 1, &plane));
    *on = PETSC_TRUE;
    for (int i = 0; i < n && *on; i++) {
      PetscInt place;

      PetscCall(PetscFindInt(nodes[i], plane->n_nodes, plane->nodes, &place));
      if (place < 0) *on = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One row of the table of face edges: in 3D an edge by its two ends, in 2D an end of the face (twice the same node) */
static PetscErrorCode ProbesFillEdge(Probes probes, const SceneContact *contact, PetscInt a, PetscInt b, PetscReal *row)
{
  const Mesh     mesh     = probes->model->mesh;
  const PetscInt nodes[2] = {a, b};
  PetscBool      symmetric;

  PetscFunctionBeginUser;
  PetscCall(ProbesOnSymmetry(probes, contact, 2, nodes, &symmetric));
  row[EDGE_LOW]  = (PetscReal)PetscMin(mesh->node_id[a], mesh->node_id[b]);
  row[EDGE_HIGH] = (PetscReal)PetscMax(mesh->node_id[a], mesh->node_id[b]);
  for (int i = 0; i < mesh->dim; i++) {
    row[EDGE_A + i] = mesh->coords[a * mesh->dim + i] + mesh->centre[i];
    row[EDGE_B + i] = mesh->coords[b * mesh->dim + i] + mesh->centre[i];
  }
  row[EDGE_SYMMETRIC] = symmetric ? 1.0 : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All edges of the slave faces, once per face they belong to. Collective. */
static PetscErrorCode ProbesGatherEdges(Probes probes, const Probe *probe, Table *edges)
{
  const Mesh          mesh    = probes->model->mesh;
  const SceneContact *contact = &probes->scene->contacts[probe->pair];
  const PetscInt      room    = probe->group->n_faces * 4; /* a quadrilateral's */
  PetscInt            nodes[FACE_MAX_NODES], n = 0;
  PetscReal          *rows;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(room * EDGE_COLUMNS, &rows));
  for (PetscInt f = 0; f < probe->group->n_faces; f++) {
    const Element *face = ElementGet(MeshFaceNodes(mesh, probe->group, f, nodes));

    if (mesh->dim == 2) {
      for (int end = 0; end < 2; end++) PetscCall(ProbesFillEdge(probes, contact, nodes[end], nodes[end], &rows[n++ * EDGE_COLUMNS]));
    } else {
      for (int e = 0; e < face->edges; e++) {
        const int *ends = face->edge_corners[e];

        PetscCall(ProbesFillEdge(probes, contact, nodes[ends[0]], nodes[ends[1]], &rows[n++ * EDGE_COLUMNS]));
      }
    }
  }
  PetscCall(TableGather(mesh->comm, EDGE_COLUMNS, n, rows, edges));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free edges belong to one face of the surface only and are on no symmetry plane. Collective. */
static PetscErrorCode ProbesFindFreeEdges(Probes probes, Probe *probe)
{
  Table   *edges = &probe->free_edges;
  PetscInt kept  = 0;

  PetscFunctionBeginUser;
  PetscCall(ProbesGatherEdges(probes, probe, edges));
  for (PetscInt i = 0, next; i < edges->n; i = next) {
    const PetscReal *row = &edges->row[i * EDGE_COLUMNS];

    for (next = i + 1; next < edges->n && !RowCompare(row, &edges->row[next * EDGE_COLUMNS]); next++) {}
    if (next > i + 1 || row[EDGE_SYMMETRIC] > 0.0) continue;
    PetscCall(PetscArraymove(&edges->row[kept++ * EDGE_COLUMNS], row, EDGE_COLUMNS));
  }
  edges->n = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal DistanceToEdge(const PetscReal *x, const PetscReal *a, const PetscReal *b)
{
  PetscReal along = 0.0, length = 0.0, square = 0.0;

  for (int i = 0; i < 3; i++) {
    along += (x[i] - a[i]) * (b[i] - a[i]);
    length += PetscSqr(b[i] - a[i]);
  }
  along = length > 0.0 ? PetscClipInterval(along / length, 0.0, 1.0) : 0.0;
  for (int i = 0; i < 3; i++) square += PetscSqr(x[i] - a[i] - along * (b[i] - a[i]));
  return PetscSqrtReal(square);
}

/* Does pressure_deviation keep this slave node? */
static PetscBool ProbeKeeps(const Probe *probe, const PetscReal *slave)
{
  PetscReal least = PETSC_MAX_REAL;
  PetscBool near;

  if (!probe->scene->edge_filter) return PETSC_TRUE;
  for (PetscInt e = 0; e < probe->free_edges.n; e++) {
    const PetscReal *edge = &probe->free_edges.row[e * EDGE_COLUMNS];

    least = PetscMin(least, DistanceToEdge(&slave[SLAVE_REFERENCE], &edge[EDGE_A], &edge[EDGE_B]));
  }
  near = least <= (probe->scene->edge_faces + RING_TOLERANCE) * probe->face_size ? PETSC_TRUE : PETSC_FALSE;
  return (probe->scene->edge_filter == 2) == near ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode PrepareReaction(Probes probes, Probe *probe, const char *key)
{
  MeshGroup *group;

  PetscFunctionBeginUser;
  PetscCall(MeshGetGroup(probes->model->mesh, probes->scene, probe->scene->path, key, probe->scene->target, probes->model->mesh->dim, &group));
  probe->group = group;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateReaction(Probes probes, Probe *probe, PetscReal *value)
{
  PetscReal force[3];

  PetscFunctionBeginUser;
  PetscCall(ModelReaction(probes->model, probe->group, force));
  *value = force[probe->scene->component];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrepareContactForce(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindPair(probes, probe, key));
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

static PetscErrorCode PrepareDisplacement(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindNode(probes, probe, key, 0, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateDisplacement(Probes probes, Probe *probe, PetscReal *value)
{
  const Model model = probes->model;

  PetscFunctionBeginUser;
  PetscCall(ProbesShare(probes, probe->node[0], 1, &model->u[PetscMax(probe->node[0], 0) * model->mesh->dim + probe->scene->component], value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrepareDistance(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) PetscCall(ProbesFindNode(probes, probe, key, i, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateDistance(Probes probes, Probe *probe, PetscReal *value)
{
  const Model model = probes->model;
  const int   dim   = model->mesh->dim;
  PetscReal   X[2][3], u[2][3], before = 0.0, now = 0.0;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    const PetscInt node = PetscMax(probe->node[k], 0);

    PetscCall(ProbesShare(probes, probe->node[k], dim, &model->mesh->coords[node * dim], X[k]));
    PetscCall(ProbesShare(probes, probe->node[k], dim, &model->u[node * dim], u[k]));
  }
  for (int i = 0; i < dim; i++) {
    const PetscReal reference = X[1][i] - X[0][i];

    before += PetscSqr(reference);
    now += PetscSqr(reference + (u[1][i] - u[0][i]));
  }
  *value = PetscSqrtReal(now) - (probe->scene->change ? PetscSqrtReal(before) : 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrepareGap(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindPair(probes, probe, key));
  PetscCall(ProbesFindNode(probes, probe, "at", 0, probe->group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateGap(Probes probes, Probe *probe, PetscReal *value)
{
  const Model model = probes->model;

  PetscFunctionBeginUser;
  PetscCall(ContactGapAt(model->contact, probe->pair, model->u, model->t, probe->id[0], value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrepareContactEdge(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindPair(probes, probe, key));
  if (probes->model->mesh->dim == 3 && !probe->scene->has_at)
    PetscCall(RefuseInput(probes->model->mesh->comm,
                          "%s: a contact edge in 3D needs a line of nodes: \"at\" is missing; allowed: at: {z: 0} or another coordinate",
                          SceneWhere(probes->scene, probe->scene->path, key)));
  PetscCall(ProbesCheckAt(probes, probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluateContactEdge(Probes probes, Probe *probe, PetscReal *value)
{
  const Table *slaves;
  PetscReal   *line; /* position and pressure of the nodes on the line */
  double      *x, *p;
  int          n = 0;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  PetscCall(PetscMalloc3(slaves->n * 2, &line, slaves->n, &x, slaves->n, &p));
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (probe->scene->has_at && !ProbeIsAt(probes, probe, slave[SLAVE_REFERENCE + probe->scene->at_axis])) continue;
    line[2 * n]     = slave[SLAVE_POSITION + probe->scene->axis];
    line[2 * n + 1] = slave[SLAVE_PRESSURE];
    n++;
  }
  qsort(line, (size_t)n, 2 * sizeof(PetscReal), RowCompare);
  for (int k = 0; k < n; k++) {
    x[k] = line[2 * k];
    p[k] = line[2 * k + 1];
  }
  *value = ContactEdge(n, x, p, probe->scene->max_side, &probe->spacing);
  PetscCall(PetscFree3(line, x, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreparePressure(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindPair(probes, probe, key));
  PetscCall(ProbesCheckAt(probes, probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluatePressureMax(Probes probes, Probe *probe, PetscReal *value)
{
  const Table *slaves;
  PetscReal    most = 0.0;

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

/* Area-weighted mean pressure over the slave nodes that the probe keeps, and their area; NaN without contact or without a node */
static PetscReal MeanPressure(const Probe *probe, const Table *slaves, PetscReal *area)
{
  PetscReal force = 0.0;

  *area = 0.0;
  for (PetscInt k = 0; k < slaves->n; k++) {
    const PetscReal *slave = &slaves->row[k * SLAVE_COLUMNS];

    if (!ProbeKeeps(probe, slave)) continue;
    *area += slave[SLAVE_AREA];
    force += slave[SLAVE_AREA] * slave[SLAVE_PRESSURE];
  }
  return force > 0.0 ? force / *area : NAN;
}

static PetscErrorCode EvaluatePressureMean(Probes probes, Probe *probe, PetscReal *value)
{
  const Table *slaves;
  PetscReal    area;

  PetscFunctionBeginUser;
  PetscCall(ProbesGetSlaves(probes, probe->pair, &slaves));
  *value = MeanPressure(probe, slaves, &area);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreparePressureDeviation(Probes probes, Probe *probe, const char *key)
{
  PetscFunctionBeginUser;
  PetscCall(ProbesFindPair(probes, probe, key));
  if (probe->scene->edge_filter) PetscCall(ProbesFindFreeEdges(probes, probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EvaluatePressureDeviation(Probes probes, Probe *probe, PetscReal *value)
{
  const Table *slaves;
  PetscReal    area, mean, most = 0.0, square = 0.0;

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

static const ProbeType types[PROBE_KINDS] = {
  [PROBE_REACTION]           = {"reaction",           PrepareReaction,          EvaluateReaction         },
  [PROBE_CONTACT_FORCE]      = {"contact_force",      PrepareContactForce,      EvaluateContactForce     },
  [PROBE_DISPLACEMENT]       = {"displacement",       PrepareDisplacement,      EvaluateDisplacement     },
  [PROBE_DISTANCE]           = {"distance",           PrepareDistance,          EvaluateDistance         },
  [PROBE_GAP]                = {"gap",                PrepareGap,               EvaluateGap              },
  [PROBE_CONTACT_EDGE]       = {"contact_edge",       PrepareContactEdge,       EvaluateContactEdge      },
  [PROBE_PRESSURE_MAX]       = {"pressure_max",       PreparePressure,          EvaluatePressureMax      },
  [PROBE_PRESSURE_MEAN]      = {"pressure_mean",      PreparePressure,          EvaluatePressureMean     },
  [PROBE_PRESSURE_DEVIATION] = {"pressure_deviation", PreparePressureDeviation, EvaluatePressureDeviation},
};

/*
  ContactEdge - Coordinate at which contact ends along a line of nodes. Plain C, not collective.

  Input: n nodes, x[n] ascending coordinates (length), p[n] nodal pressures (p > 0: loaded), max_side (1: the end at large x, 0: at small x).
  Output: spacing (length) between the last loaded and the next open node: the resolution of the answer.
  Source: Hertz's pressure is p_0 sqrt(1 - (x/a)^2) (Johnson, "Contact Mechanics", ch. 4), so p^2 has a simple zero at the edge.
*/
double ContactEdge(int n, const double *x, const double *p, int max_side, double *spacing)
{
  const int outward = max_side ? 1 : -1, end = max_side ? n - 1 : 0;
  int       last = end, inner, open;
  double    fall;

  *spacing = NAN;
  while (last >= 0 && last < n && !(p[last] > 0.0)) last -= outward;
  if (last < 0 || last >= n) return NAN;
  *spacing = 0.0;
  if (last == end) return x[last];
  open     = last + outward;
  inner    = last - outward;
  *spacing = fabs(x[open] - x[last]);
  if (inner < 0 || inner >= n || !(p[inner] > 0.0)) return 0.5 * (x[last] + x[open]);
  fall = p[inner] * p[inner] - p[last] * p[last];
  if (!(fall > 0.0)) return x[open];
  return x[last] + outward * fmin(*spacing, p[last] * p[last] / fall * fabs(x[last] - x[inner]));
}

/* The body of every local node, by its cells: bodies share no nodes */
static PetscErrorCode ProbesFindNodeBodies(Probes probes)
{
  const Mesh mesh = probes->model->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &probes->node_body));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) probes->node_body[n] = -1;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++) probes->node_body[mesh->cell_nodes[k]] = mesh->cell_body[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ProbesCreate - Resolves the scene's probes in a model. Collective.

  Input: model (with its mesh and contact), scene. Errors: refuses (exit 1) surfaces, pairs and volumes that do not exist, points without a
  node and points where several bodies have one and none is named.
*/
PetscErrorCode ProbesCreate(Model model, Scene scene, Probes *result)
{
  Probes probes;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&probes));
  probes->model = model;
  probes->scene = scene;
  PetscCall(PetscCalloc1(scene->n_probes, &probes->probe));
  PetscCall(PetscCalloc1(scene->n_contacts, &probes->slaves));
  PetscCall(ProbesFindNodeBodies(probes));
  for (int i = 0; i < scene->n_probes; i++) {
    Probe           *probe = &probes->probe[i];
    const ProbeType *type  = &types[scene->probes[i].kind];

    probe->scene   = &scene->probes[i];
    probe->spacing = NAN;
    PetscCall(type->prepare(probes, probe, type->key));
  }
  PetscCall(PetscFree(probes->node_body));
  *result = probes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ProbesDestroy - Frees the probes. Not collective. */
PetscErrorCode ProbesDestroy(Probes *probes)
{
  PetscFunctionBeginUser;
  if (!*probes) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < (*probes)->scene->n_probes; i++) PetscCall(TableDestroy(&(*probes)->probe[i].free_edges));
  PetscCall(PetscFree((*probes)->probe));
  PetscCall(PetscFree((*probes)->slaves));
  PetscCall(PetscFree(*probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  ProbesEvaluate - Values of all probes in the model's present state, the same on all ranks and on any number of them. Collective.

  Output: values[scene->n_probes]: forces, lengths, pressures or per cent by kind, after `absolute` and `factor`; NaN where there is no value.
*/
PetscErrorCode ProbesEvaluate(Probes probes, PetscReal values[])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < probes->scene->n_probes; i++) {
    const SceneProbe *scene = &probes->scene->probes[i];

    PetscCall(types[scene->kind].evaluate(probes, &probes->probe[i], &values[i]));
    if (scene->absolute) values[i] = PetscAbsReal(values[i]);
    values[i] *= scene->factor;
  }
  for (int p = 0; p < probes->scene->n_contacts; p++) PetscCall(TableDestroy(&probes->slaves[p]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ProbesGetSpacing - Node spacing (length) around the contact edge of probe i at the last evaluation, NaN if there is none. Not collective. */
PetscErrorCode ProbesGetSpacing(Probes probes, int i, PetscReal *spacing)
{
  PetscFunctionBeginUser;
  *spacing = probes->probe[i].spacing;
  PetscFunctionReturn(PETSC_SUCCESS);
}
