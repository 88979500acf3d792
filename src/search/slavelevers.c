/* Levers of slave points: fixed slopes on the nodes around each point, which give tangents of the slave surface there.
   The sum of the slopes of a lever is zero.

   A quadrature point has the derivatives of the shape functions of its face. A node has the mean of the surface
   gradients of the shape functions of all faces around it, in the reference configuration, along two directions normal
   to the mean normal. */
#include "base/vectors.h"
#include "slavelevers.h"

/* Shape functions at one place of a face: their gradients in its plane, the area per reference area and the normal. */
typedef struct {
  PetscReal gradient[FACE_MAX_NODES][3], area, normal[3];
} FaceGradient;

static PetscErrorCode Allocate(SlavePoints points, PetscInt entries)
{
  PetscFunctionBeginUser;
  PetscCall(
    PetscCalloc3(points->n + 1, &points->lever_ptr, entries, &points->lever_node, 2 * entries, &points->lever_slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlaveLeversDestroy(SlavePoints points)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(points->lever_ptr, points->lever_node, points->lever_slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the levers of quadrature points. */
PetscErrorCode SlaveLeversOnFaces(SlavePoints points)
{
  const int dim = points->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(Allocate(points, points->ptr[points->n]));
  PetscCall(PetscArraycpy(points->lever_ptr, points->ptr, points->n + 1));
  PetscCall(PetscArraycpy(points->lever_node, points->node, points->ptr[points->n]));
  for (PetscInt f = 0; f < points->n_faces; f++) {
    const FaceRule *rule = FaceRuleOf(points->faces[f].type, points->finer, points->ends[f]);

    for (PetscInt q = points->first[f]; q < points->first[f + 1]; q++)
      for (PetscInt k = points->ptr[q]; k < points->ptr[q + 1]; k++)
        for (int a = 0; a < dim - 1; a++)
          points->lever_slope[2 * k + a] = rule->dN[q - points->first[f]][k - points->ptr[q]][a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The gradients at node `at` of a face. With the tangents T_a and the normal m = T_1 x T_2 they are
   (N_,1 T_2 x m + N_,2 m x T_1)/m^2. The second tangent of an edge is the third axis. */
static void FindGradient(const FaceRecord *record, const NodeKey *keys, int dim, int at, FaceGradient *g)
{
  const Element *e = ElementGet(record->facet.type);
  double         N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2];
  PetscReal      tangent[2][3] = {{0, 0, 0}, {0, 0, dim == 2}}, m[3], dual[2][3], square;

  ElementShape(e->type, e->node[at], N, dN, NULL);
  for (int k = 0; k < e->nodes; k++)
    for (int a = 0; a < e->dim; a++)
      for (int d = 0; d < dim; d++) tangent[a][d] += dN[k * e->dim + a] * keys[k].X[d];
  Cross(tangent[0], tangent[1], m);
  Cross(tangent[1], m, dual[0]);
  Cross(m, tangent[0], dual[1]);
  square  = Dot(m, m);
  g->area = PetscSqrtReal(square);
  for (int d = 0; d < 3; d++) g->normal[d] = g->area > 0 ? m[d] / g->area : 0;
  for (int k = 0; k < e->nodes; k++) {
    for (int d = 0; d < 3; d++) {
      g->gradient[k][d] = 0;
      for (int a = 0; a < e->dim && square > 0; a++) g->gradient[k][d] += dN[k * e->dim + a] * dual[a][d] / square;
    }
  }
}

/* Two directions normal to the mean normal; zeros where there is none, and the second of an edge. */
static void Directions(int dim, const PetscReal normal[3], PetscReal direction[2][3])
{
  const PetscReal length  = PetscSqrtReal(Dot(normal, normal));
  PetscReal       axis[3] = {0, 0, 0};
  int             least   = 2;

  for (int d = 0; d < 3; d++) direction[0][d] = direction[1][d] = 0;
  if (!(length > 0)) return;
  for (int d = 0; d < dim && dim == 3; d++)
    if (PetscAbsReal(normal[d]) < PetscAbsReal(normal[least])) least = d;
  axis[least] = 1;
  Cross(normal, axis, direction[0]);
  for (int d = 0; d < 3; d++) direction[0][d] /= length;
  if (dim == 3) Cross(normal, direction[0], direction[1]);
  for (int d = 0; d < 3; d++) direction[1][d] /= length;
}

/* Room for the levers of nodes while they are made: as many entries for each point as the faces around it have nodes,
   those that several faces have in common counted for each. */
typedef struct {
  PetscInt  *begin, *end; /* of the entries of each point: its room, and what of it is in use */
  PetscInt  *node;
  PetscReal *gradient; /* 3 of each entry: the sum over the faces */
  PetscReal *normal;   /* 3 of each point: the sum of the faces' normals */
} Rooms;

/* Adds the gradients of a face at its node `at`, which is point q, to the entries of that point, and its normal to the
   sum. */
static void AddGradient(const SlavePoints points, const FaceRecord *record, const NodeKey *keys, int at, PetscInt q,
                        Rooms *rooms)
{
  FaceGradient g;

  FindGradient(record, keys, points->mesh->dim, at, &g);
  for (int d = 0; d < 3; d++) rooms->normal[3 * q + d] += g.area * g.normal[d];
  for (int k = 0; k < ElementGet(record->facet.type)->nodes; k++) {
    const PetscInt node = NodeKeysFind(points->n_nodes, points->nodes, keys[k].id);
    PetscInt       i    = rooms->begin[q];

    while (i < rooms->end[q] && rooms->node[i] != node) i++;
    if (i == rooms->end[q]) rooms->end[q]++;
    rooms->node[i] = node;
    for (int d = 0; d < 3; d++) rooms->gradient[3 * i + d] += g.area * g.gradient[k][d];
  }
}

/* Counts the nodes of the faces around each point into the ends of the levers' rooms. point: of each node, -1: none. */
static void CountRooms(const SlavePoints points, PetscInt n_records, const FaceRecord *records, const PetscInt *point,
                       PetscInt *room)
{
  for (PetscInt f = 0; f < n_records; f++) {
    const int nodes = ElementGet(records[f].facet.type)->nodes;
    NodeKey   keys[FACE_MAX_NODES];

    FaceRecordKeys(&records[f], keys);
    for (int a = 0; a < nodes; a++) {
      const PetscInt q = point[NodeKeysFind(points->n_nodes, points->nodes, keys[a].id)];

      if (q >= 0) room[q + 1] += nodes;
    }
  }
  for (PetscInt q = 0; q < points->n; q++) room[q + 1] += room[q];
}

/* Fills the rooms with the nodes of the faces around each point and the sums of their gradients. */
static void FillRooms(const SlavePoints points, PetscInt n_records, const FaceRecord *records, const PetscInt *point,
                      Rooms *rooms)
{
  for (PetscInt f = 0; f < n_records; f++) {
    NodeKey keys[FACE_MAX_NODES];

    FaceRecordKeys(&records[f], keys);
    for (int a = 0; a < ElementGet(records[f].facet.type)->nodes; a++) {
      const PetscInt q = point[NodeKeysFind(points->n_nodes, points->nodes, keys[a].id)];

      if (q >= 0) AddGradient(points, &records[f], keys, a, q, rooms);
    }
  }
}

/* Makes the levers from the sums of the gradients. */
static PetscErrorCode LeversFromRooms(SlavePoints points, const Rooms *rooms)
{
  const int dim     = points->mesh->dim;
  PetscInt  entries = 0;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < points->n; q++) entries += rooms->end[q] - rooms->begin[q];
  PetscCall(Allocate(points, entries));
  for (PetscInt q = 0; q < points->n; q++) {
    PetscReal direction[2][3];
    PetscInt  to = points->lever_ptr[q];

    Directions(dim, &rooms->normal[3 * q], direction);
    for (PetscInt i = rooms->begin[q]; i < rooms->end[q]; i++, to++) {
      points->lever_node[to] = rooms->node[i];
      for (int a = 0; a < 2; a++) points->lever_slope[2 * to + a] = Dot(direction[a], &rooms->gradient[3 * i]);
    }
    points->lever_ptr[q + 1] = to;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the levers of nodes from all faces around them. */
PetscErrorCode SlaveLeversAroundNodes(SlavePoints points, PetscInt n_records, const FaceRecord *records)
{
  PetscInt *point;
  Rooms     rooms;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points->n_nodes, &point));
  for (PetscInt i = 0; i < points->n_nodes; i++) point[i] = -1;
  for (PetscInt q = 0; q < points->n; q++) point[points->node[points->ptr[q]]] = q;
  PetscCall(PetscCalloc3(points->n + 1, &rooms.begin, points->n, &rooms.end, 3 * points->n, &rooms.normal));
  CountRooms(points, n_records, records, point, rooms.begin);
  PetscCall(PetscCalloc2(rooms.begin[points->n], &rooms.node, 3 * rooms.begin[points->n], &rooms.gradient));
  PetscCall(PetscArraycpy(rooms.end, rooms.begin, points->n));
  FillRooms(points, n_records, records, point, &rooms);
  PetscCall(LeversFromRooms(points, &rooms));
  PetscCall(PetscFree(point));
  PetscCall(PetscFree3(rooms.begin, rooms.end, rooms.normal));
  PetscCall(PetscFree2(rooms.node, rooms.gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}
