/* Points of probes: the node there, or the cell that they lie in. */
#include "probeimpl.h"
#include "base/refusal.h"
#include "mesh/meshlocate.h"

enum { MESSAGE_SIZE = 2048 /* characters of a list of bodies in a refusal */ };

/* Writes dim coordinates as "(1, 2, 3)". The text belongs to the caller. */
static const char *PointText(int dim, const PetscReal *x, char text[128])
{
  if (dim == 3)
    snprintf(text, 128, "(%.9g, %.9g, %.9g)", (double)x[0], (double)x[1], (double)x[2]);
  else
    snprintf(text, 128, "(%.9g, %.9g)", (double)x[0], (double)x[1]);
  return text;
}

/* Gives all ranks the values that one rank knows of a node. local is the node on its owner, and -1 elsewhere.
   Collective. */
static PetscErrorCode ProbesShare(Probes probes, PetscInt local, int n, const PetscReal *mine, PetscReal *shared)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) shared[i] = local < 0 ? 0.0 : mine[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shared, n, MPIU_REAL, MPI_SUM, probes->model->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the local node of a node_id on the rank that owns it, -1 elsewhere. */
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

/* Returns the index of the body that a probe names, -1 if it names none. The scene has made sure that there is such a
   body. */
static int ProbesFindBody(Probes probes, const Probe *probe)
{
  for (int b = 0; probe->scene->body && b < probes->scene->n_bodies; b++)
    if (!probes->scene->bodies[b].rigid && !strcmp(probes->scene->bodies[b].name, probe->scene->body)) return b;
  return -1;
}

/* What this rank, and then all ranks, know of the nodes around a point */
typedef struct {
  PetscReal distance; /* of the nearest node */
  PetscInt  nearest;  /* its node_id; the smallest where several are as near */
  PetscInt  id;       /* smallest node_id within the tolerance */
} Nearby;

/* Looks through the local nodes (of a group, or all), of one body or any (-1), for those near a point. at[body] tells
   which bodies have a node at the point. */
static void ProbesLookAround(Probes probes, const PetscReal point[3], const MeshGroup *within, int body, Nearby *nearby,
                             PetscInt *at)
{
  const Mesh     mesh = probes->model->mesh;
  const PetscInt n    = within ? within->n_nodes : mesh->n_body_nodes;

  *nearby = (Nearby){.distance = PETSC_MAX_REAL, .nearest = PETSC_MAX_INT, .id = PETSC_MAX_INT};
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt node   = within ? within->nodes[k] : k;
    PetscReal      square = 0.0, distance;

    if (body >= 0 && probes->node_body[node] != body) continue;
    for (int i = 0; i < mesh->dim; i++)
      square += PetscSqr(mesh->coords[node * mesh->dim + i] + mesh->centre[i] - point[i]);
    distance = PetscSqrtReal(square);
    if (distance < nearby->distance || (distance == nearby->distance && mesh->node_id[node] < nearby->nearest)) {
      nearby->distance = distance;
      nearby->nearest  = mesh->node_id[node];
    }
    if (distance > PROBE_POINT_TOLERANCE * mesh->size) continue;
    nearby->id = PetscMin(nearby->id, mesh->node_id[node]);
    if (probes->node_body[node] >= 0) at[probes->node_body[node]] = 1;
  }
}

/* Refuses a point without a node or outside of all bodies and names the nearest node. Returns REFUSED. Collective. */
static PetscErrorCode ProbesRefusePoint(Probes probes, const Probe *probe, const char *key, const PetscReal point[3],
                                        const Nearby *nearby)
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
  if (probe->scene->target)
    PetscCall(RefuseInput(mesh->comm,
                          "%s: no node at %s on the slave surface; allowed: reference coordinates of a node, to within "
                          "%g of the model's size; the nearest is node %.0f at %s, %.3g away",
                          SceneWhere(probes->scene, probe->scene->path, key), PointText(mesh->dim, point, asked),
                          (double)PROBE_POINT_TOLERANCE, (double)shared[3], PointText(mesh->dim, shared, found),
                          (double)nearby->distance));
  else
    PetscCall(RefuseInput(mesh->comm,
                          "%s: no body at %s; allowed: reference coordinates of a point of a body; the nearest node is "
                          "%.0f at %s, %.3g away",
                          SceneWhere(probes->scene, probe->scene->path, key), PointText(mesh->dim, point, asked),
                          (double)shared[3], PointText(mesh->dim, shared, found), (double)nearby->distance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a point of two bodies if the scene does not say which is meant. Returns REFUSED.
   Collective. */
static PetscErrorCode ProbesRefuseBodies(Probes probes, const Probe *probe, const char *key, const PetscReal point[3],
                                         const PetscInt *at)
{
  char names[MESSAGE_SIZE] = "", asked[128];

  PetscFunctionBeginUser;
  for (int b = 0; b < probes->scene->n_bodies; b++) {
    if (!at[b]) continue;
    PetscCall(PetscStrlcat(names, *names ? ", " : "", sizeof(names)));
    PetscCall(PetscStrlcat(names, probes->scene->bodies[b].name, sizeof(names)));
  }
  PetscCall(RefuseInput(probes->model->mesh->comm, "%s: several bodies are at %s; \"body\" must say which; allowed: %s",
                        SceneWhere(probes->scene, probe->scene->path, key),
                        PointText(probes->model->mesh->dim, point, asked), names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node at a point, the smallest distance of any, and whose nodes are there, for all ranks. */
static PetscErrorCode ProbesLookEverywhere(Probes probes, const Probe *probe, const PetscReal point[3],
                                           const MeshGroup *within, Nearby *nearby, PetscInt *at)
{
  const MPI_Comm comm = probes->model->mesh->comm;
  PetscReal      least;

  PetscFunctionBeginUser;
  ProbesLookAround(probes, point, within, ProbesFindBody(probes, probe), nearby, at);
  PetscCallMPI(MPI_Allreduce(&nearby->distance, &least, 1, MPIU_REAL, MPI_MIN, comm));
  if (nearby->distance > least) nearby->nearest = PETSC_MAX_INT;
  nearby->distance = least;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &nearby->nearest, 1, MPIU_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &nearby->id, 1, MPIU_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, at, probes->scene->n_bodies, MPIU_INT, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Looks for a point in the cells of one body or any (-1). at[body]: the point is in it or, where it is in none, beside
   it by no more than a chord leaves out. place: the cell in the last of these bodies. Collective. */
static PetscErrorCode ProbesLookInside(Probes probes, const PetscReal point[3], int body, PetscInt *at,
                                       CellPlace *place)
{
  const Mesh mesh  = probes->model->mesh;
  PetscReal  least = PETSC_INFINITY, x[3];
  CellPlace  found;

  PetscFunctionBeginUser;
  place->cell = -1;
  for (int i = 0; i < mesh->dim; i++) x[i] = point[i] - mesh->centre[i];
  for (int b = 0; b < probes->scene->n_bodies; b++) {
    PetscReal outside;

    if (probes->scene->bodies[b].rigid || (body >= 0 && b != body)) continue;
    PetscCall(MeshLocatePoint(mesh, b, x, &found, &outside));
    if (outside >= PETSC_INFINITY || (outside > 0 && least == 0)) continue;
    if (outside == 0 && least > 0) PetscCall(PetscArrayzero(at, probes->scene->n_bodies));
    least  = PetscMin(least, outside);
    *place = found;
    at[b]  = 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The point is the node with this node_id. */
static PetscErrorCode ProbePointAtNode(Probes probes, PetscInt id, ProbePoint *point)
{
  PetscFunctionBeginUser;
  *point = (ProbePoint){.id = id, .weight = {1}};
  PetscCall(ProbesLocalNode(probes, id, &point->node[0]));
  point->n = point->node[0] >= 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The point lies in a cell. */
static void ProbePointInCell(Probes probes, const CellPlace *place, ProbePoint *point)
{
  const Mesh mesh = probes->model->mesh;

  *point = (ProbePoint){.id = -1};
  if (place->cell < 0) return;
  point->n = ElementGet(mesh->cell_type[place->cell])->nodes;
  for (PetscInt a = 0; a < point->n; a++) {
    point->node[a]   = mesh->cell_nodes[mesh->cell_ptr[place->cell] + a];
    point->weight[a] = place->N[a];
  }
}

PetscErrorCode ProbePointFind(Probes probes, Probe *probe, const char *key, int which, const MeshGroup *within)
{
  const PetscReal *point = probe->scene->point[which];
  PetscInt        *at, bodies = 0;
  PetscErrorCode   code = PETSC_SUCCESS;
  PetscBool        node;
  CellPlace        place = {.cell = -1};
  Nearby           nearby;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(probes->scene->n_bodies, &at));
  PetscCall(ProbesLookEverywhere(probes, probe, point, within, &nearby, at));
  node = (PetscBool)(nearby.id != PETSC_MAX_INT);
  if (!node && !within) PetscCall(ProbesLookInside(probes, point, ProbesFindBody(probes, probe), at, &place));
  for (int b = 0; b < probes->scene->n_bodies; b++) bodies += at[b];
  if (!node && !bodies)
    code = ProbesRefusePoint(probes, probe, key, point, &nearby);
  else if (bodies > 1)
    code = ProbesRefuseBodies(probes, probe, key, point, at);
  PetscCall(PetscFree(at));
  PetscCall(code);
  if (node)
    PetscCall(ProbePointAtNode(probes, nearby.id, &probe->point[which]));
  else
    ProbePointInCell(probes, &place, &probe->point[which]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProbePointValue(Probes probes, const ProbePoint *point, const PetscReal *field, PetscReal value[3])
{
  const Mesh mesh = probes->model->mesh;

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) value[i] = 0;
  for (PetscInt a = 0; a < point->n; a++)
    for (int i = 0; i < mesh->dim; i++) value[i] += point->weight[a] * field[point->node[a] * mesh->dim + i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value, 3, MPIU_REAL, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
