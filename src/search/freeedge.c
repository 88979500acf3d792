#include "search/freeedge.h"
#include "base/gathertable.h"

/* A node is on the axis of revolution to within this part of the model's size: the rounding of the mesh generator. */
static const PetscReal AXIS_TOLERANCE = 1e-6;

/* Edges of slave faces, by the node_ids of their ends */
enum { EDGE_LOW, EDGE_HIGH, EDGE_A, EDGE_B = EDGE_A + 3, EDGE_SYMMETRIC = EDGE_B + 3, EDGE_COLUMNS };

struct _n_FreeEdges {
  Mesh                mesh;
  Scene               scene;
  const SceneContact *contact;
  GatherTable         table; /* EDGE_COLUMNS */
};

/* Are all the corners on one of the planes beyond which the pair continues as its mirror image (the axis of revolution
 * is one)? */
static PetscErrorCode OnSymmetry(FreeEdges edges, int n, const PetscInt *nodes, PetscBool *on)
{
  const Mesh          mesh    = edges->mesh;
  const SceneContact *contact = edges->contact;
  MeshGroup          *plane;

  PetscFunctionBeginUser;
  *on = edges->scene->geometry == GEOMETRY_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < n && *on; i++)
    if (PetscAbsReal(mesh->coords[nodes[i] * mesh->dim] + mesh->centre[0]) > AXIS_TOLERANCE * mesh->size)
      *on = PETSC_FALSE;
  for (int s = 0; s < contact->n_symmetry && !*on; s++) {
    PetscCall(MeshGetGroup(mesh, edges->scene, contact->path, "symmetry", contact->symmetry[s], mesh->dim - 1, &plane));
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
static PetscErrorCode FillEdge(FreeEdges edges, PetscInt a, PetscInt b, PetscReal *row)
{
  const Mesh     mesh     = edges->mesh;
  const PetscInt nodes[2] = {a, b};
  PetscBool      symmetric;

  PetscFunctionBeginUser;
  PetscCall(OnSymmetry(edges, 2, nodes, &symmetric));
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
static PetscErrorCode GatherEdges(FreeEdges edges, const MeshGroup *surface)
{
  const Mesh     mesh = edges->mesh;
  const PetscInt room = surface->n_faces * 4; /* a quadrilateral's */
  PetscInt       nodes[FACE_MAX_NODES], n = 0;
  PetscReal     *rows;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(room * EDGE_COLUMNS, &rows));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Element *face = ElementGet(MeshFaceNodes(mesh, surface, f, nodes));

    if (mesh->dim == 2) {
      for (int end = 0; end < 2; end++) PetscCall(FillEdge(edges, nodes[end], nodes[end], &rows[n++ * EDGE_COLUMNS]));
    } else {
      for (int e = 0; e < face->edges; e++) {
        const int *ends = face->edge_corners[e];

        PetscCall(FillEdge(edges, nodes[ends[0]], nodes[ends[1]], &rows[n++ * EDGE_COLUMNS]));
      }
    }
  }
  PetscCall(GatherTableCreate(mesh->comm, EDGE_COLUMNS, n, rows, &edges->table));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  FreeEdgesCreate - Finds the edges that belong to one face of a surface only and are on no plane of symmetry.
  Collective.

  Input: mesh, scene, contact (its planes of symmetry), surface (of the deformable mesh). Output: edges, the same on all
  ranks. Errors: refuses (exit 1) a plane of symmetry that the mesh does not have.
*/
PetscErrorCode FreeEdgesCreate(Mesh mesh, Scene scene, const SceneContact *contact, const MeshGroup *surface,
                               FreeEdges *result)
{
  FreeEdges    edges;
  PetscInt     kept = 0;
  GatherTable *table;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&edges));
  edges->mesh    = mesh;
  edges->scene   = scene;
  edges->contact = contact;
  PetscCall(GatherEdges(edges, surface));
  table = &edges->table;
  for (PetscInt i = 0, next; i < table->n; i = next) {
    const PetscReal *row = &table->row[i * EDGE_COLUMNS];

    for (next = i + 1; next < table->n && !GatherTableCompare(row, &table->row[next * EDGE_COLUMNS]); next++) {}
    if (next > i + 1 || row[EDGE_SYMMETRIC] > 0.0) continue;
    PetscCall(PetscArraymove(&table->row[kept++ * EDGE_COLUMNS], row, EDGE_COLUMNS));
  }
  table->n = kept;
  *result  = edges;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FreeEdgesDestroy - Frees the edges. Not collective. */
PetscErrorCode FreeEdgesDestroy(FreeEdges *edges)
{
  PetscFunctionBeginUser;
  if (!*edges) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GatherTableDestroy(&(*edges)->table));
  PetscCall(PetscFree(*edges));
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

/* FreeEdgesDistance - Distance (length) of a point in reference coordinates to the nearest free edge, PETSC_MAX_REAL if
 * there is none. Not collective. */
PetscReal FreeEdgesDistance(FreeEdges edges, const PetscReal x[3])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt e = 0; e < edges->table.n; e++) {
    const PetscReal *edge = &edges->table.row[e * EDGE_COLUMNS];

    least = PetscMin(least, DistanceToEdge(x, &edge[EDGE_A], &edge[EDGE_B]));
  }
  return least;
}
