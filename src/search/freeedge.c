/* The free edges of a slave surface: one table of all face edges, the same on all ranks, from which the shared ones
   are dropped. */
#include "search/freeedge.h"
#include "base/gathertable.h"

/* A node is on the axis of revolution if its distance from it is within this part of the model's size, which is the
   rounding of the mesh generator. */
static const PetscReal AXIS_TOLERANCE = 1e-6;

/* Columns of the table of face edges: node_ids of the two ends, their coordinates, and whether the edge lies on a
   plane of symmetry. */
enum { EDGE_LOW, EDGE_HIGH, EDGE_A, EDGE_B = EDGE_A + 3, EDGE_SYMMETRIC = EDGE_B + 3, EDGE_COLUMNS };

struct _n_FreeEdges {
  Mesh                mesh;
  Scene               scene;
  const SceneContact *contact;
  GatherTable         table; /* with EDGE_COLUMNS columns */
};

/* Are all the nodes on one of the planes beyond which the pair continues as its mirror image? The axis of revolution
   counts as such a plane. */
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

/* Fills a row of the table of face edges. In 3D it is an edge with its two ends, in 2D an end of the face (twice the
   same node). */
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

/* Gathers all edges of the slave faces, once for each face to which they belong. Collective. */
static PetscErrorCode GatherEdges(FreeEdges edges, const MeshGroup *surface)
{
  const Mesh     mesh = edges->mesh;
  const PetscInt room = surface->n_faces * 4; /* a quadrilateral has 4 edges */
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

/*@
  FreeEdgesCreate - finds the edges that belong to only one face of a surface and lie on no plane of symmetry.

  Collective

  Input Parameters:
+ mesh    - the mesh
. scene   - the scene
. contact - gives the planes of symmetry
- surface - slave surface of the deformable mesh

  Output Parameter:
. result - the edges, the same on all ranks

  Note:
  Refuses a plane of symmetry that the mesh does not have.
@*/
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

/*@
  FreeEdgesDestroy - frees the edges.

  Not collective

  Input/Output Parameter:
. edges - the edges, NULL on return
@*/
PetscErrorCode FreeEdgesDestroy(FreeEdges *edges)
{
  PetscFunctionBeginUser;
  if (!*edges) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GatherTableDestroy(&(*edges)->table));
  PetscCall(PetscFree(*edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance of x to the edge from a to b. */
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

/*@
  FreeEdgesDistance - computes the distance (length) of a point to the nearest free edge.

  Not collective

  Input Parameters:
+ edges - the edges
- x     - the point in reference coordinates; components beyond the mesh's dimension are 0

  Note:
  Returns PETSC_MAX_REAL if the surface has no free edge.
@*/
PetscReal FreeEdgesDistance(FreeEdges edges, const PetscReal x[3])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt e = 0; e < edges->table.n; e++) {
    const PetscReal *edge = &edges->table.row[e * EDGE_COLUMNS];

    least = PetscMin(least, DistanceToEdge(x, &edge[EDGE_A], &edge[EDGE_B]));
  }
  return least;
}
