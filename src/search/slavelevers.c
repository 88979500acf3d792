/* Levers of slave points: fixed slopes on the nodes around each point, which give tangents of the slave surface there.
   The sum of the slopes of a lever is zero.

   A quadrature point has the derivatives of the shape functions of its face. A node has the mean of the surface
   gradients of the shape functions of all faces around it, in the reference configuration, along two directions normal
   to the mean normal. */
#include "slavelevers.h"

/* Shape functions at one place of a face: their gradients in its plane, the area per reference area and the normal. */
typedef struct {
  PetscReal gradient[FACE_MAX_NODES][3], area, normal[3];
} FaceGradient;

static PetscErrorCode Allocate(SlavePoints points, PetscInt entries)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(points->n + 1, &points->lever_ptr, entries, &points->lever_node, 2 * entries,
                         &points->lever_slope));
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
    const FaceRule *rule = FaceRuleGet(points->faces[f].type, points->finer);

    for (PetscInt q = points->first[f]; q < points->first[f + 1]; q++)
      for (PetscInt k = points->ptr[q]; k < points->ptr[q + 1]; k++)
        for (int a = 0; a < dim - 1; a++)
          points->lever_slope[2 * k + a] = rule->dN[q - points->first[f]][k - points->ptr[q]][a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

static PetscReal Dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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

/* Adds the gradients of a face at a node to the nodes of its lever, room of which begins at `first`, and its normal to
   the mean one. *end: end of the entries in use. */
static void AddGradient(SlavePoints points, const FaceRecord *record, const NodeKey *keys, int at, PetscInt first,
                        PetscInt *end, PetscReal *gradient, PetscReal normal[3])
{
  FaceGradient g;

  FindGradient(record, keys, points->mesh->dim, at, &g);
  for (int d = 0; d < 3; d++) normal[d] += g.area * g.normal[d];
  for (int k = 0; k < ElementGet(record->facet.type)->nodes; k++) {
    const PetscInt node = NodeKeysFind(points->n_nodes, points->nodes, keys[k].id);
    PetscInt       i    = first;

    while (i < *end && points->lever_node[i] != node) i++;
    if (i == *end) (*end)++;
    points->lever_node[i] = node;
    for (int d = 0; d < 3; d++) gradient[3 * i + d] += g.area * g.gradient[k][d];
  }
}

/* Makes the levers of nodes from all faces around them. */
PetscErrorCode SlaveLeversAroundNodes(SlavePoints points, PetscInt n_records, const FaceRecord *records)
{
  const int  dim = points->mesh->dim;
  PetscInt  *point, *end;
  PetscReal *normal, *gradient;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points->n_nodes, &point)); /* of each node; -1: none */
  for (PetscInt i = 0; i < points->n_nodes; i++) point[i] = -1;
  for (PetscInt q = 0; q < points->n; q++) point[points->node[points->ptr[q]]] = q;
  PetscCall(PetscCalloc3(points->n, &end, 3 * points->n, &normal, 3 * n_records * FACE_MAX_NODES * FACE_MAX_NODES,
                         &gradient));
  PetscCall(Allocate(points, n_records * FACE_MAX_NODES * FACE_MAX_NODES));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt f = 0; f < n_records; f++) {
      const int nodes = ElementGet(records[f].facet.type)->nodes;
      NodeKey   keys[FACE_MAX_NODES];

      FaceRecordKeys(&records[f], keys);
      for (int a = 0; a < nodes; a++) {
        const PetscInt q = point[NodeKeysFind(points->n_nodes, points->nodes, keys[a].id)];

        if (q < 0) continue;
        if (pass)
          AddGradient(points, &records[f], keys, a, points->lever_ptr[q], &end[q], gradient, &normal[3 * q]);
        else
          points->lever_ptr[q + 1] += nodes;
      }
    }
    for (PetscInt q = 0; q < points->n && !pass; q++) {
      points->lever_ptr[q + 1] += points->lever_ptr[q];
      end[q] = points->lever_ptr[q];
    }
  }
  for (PetscInt q = 0; q < points->n; q++) {
    PetscReal direction[2][3];

    Directions(dim, &normal[3 * q], direction);
    for (PetscInt i = points->lever_ptr[q]; i < end[q]; i++)
      for (int a = 0; a < dim - 1; a++) points->lever_slope[2 * i + a] = Dot(direction[a], &gradient[3 * i]);
    for (PetscInt i = end[q]; i < points->lever_ptr[q + 1]; i++) /* nodes that several faces have in common */
      points->lever_node[i] = points->node[points->ptr[q]];
  }
  PetscCall(PetscFree(point));
  PetscCall(PetscFree3(end, normal, gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}
