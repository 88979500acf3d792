/* The nodes of a surface and their neighbours on all ranks, see surfacegraph.h. */
#include "search/surfacegraph.h"
#include "base/gathertable.h"
#include "base/vectors.h"

/* Columns of the table of edges between neighbouring nodes, a before b, and of the table of nodes */
enum { EDGE_A, EDGE_B, EDGE_INNER, EDGE_COLUMNS };
enum { NODE_ID, NODE_TWIN, NODE_X, NODE_COLUMNS = NODE_X + 3 };
/* The most pairs of neighbours on one face: second-order edges in two halves, and a node in the middle */
enum { FACE_PAIRS = 12 };

/* Lists the neighbouring nodes of a face: corners, or the halves of second-order edges, and a node inside with the
   middles of all edges. inner: the pair lies inside the face. Returns their number. */
static int FacePairs(const Element *face, int pair[FACE_PAIRS][2], PetscBool inner[FACE_PAIRS])
{
  const int centre = face->corners + face->edges;
  int       n      = 0;

  for (int e = 0; e < face->edges; e++) {
    const int *corner = face->edge_corners[e], middle = face->corners + e;
    const int steps[3][2] = {{corner[0], face->order == 1 ? corner[1] : middle}, {middle, corner[1]}, {middle, centre}};

    for (int k = 0; k < (face->order == 1 ? 1 : centre < face->nodes ? 3 : 2); k++) {
      pair[n][0] = steps[k][0];
      pair[n][1] = steps[k][1];
      inner[n++] = (PetscBool)(k == 2);
    }
  }
  return n;
}

/* Puts the pairs of this rank's faces into a table of all ranks. */
static PetscErrorCode GatherEdges(SurfaceGraph s, GatherTable *table)
{
  const MeshGroup *group = s->group;
  PetscReal       *rows;
  PetscInt         n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(group->n_faces * FACE_PAIRS * EDGE_COLUMNS, &rows));
  for (PetscInt f = 0; f < group->n_faces; f++) {
    PetscInt       nodes[FACE_MAX_NODES];
    const Element *face = ElementGet(MeshFaceNodes(s->mesh, group, f, nodes));
    int            pair[FACE_PAIRS][2];
    PetscBool      inner[FACE_PAIRS];
    const int      pairs = FacePairs(face, pair, inner);

    for (int k = 0; k < pairs; k++, n++) {
      const PetscInt a = s->mesh->node_id[nodes[pair[k][0]]], b = s->mesh->node_id[nodes[pair[k][1]]];

      rows[n * EDGE_COLUMNS + EDGE_A]     = (PetscReal)PetscMin(a, b);
      rows[n * EDGE_COLUMNS + EDGE_B]     = (PetscReal)PetscMax(a, b);
      rows[n * EDGE_COLUMNS + EDGE_INNER] = inner[k];
    }
  }
  PetscCall(GatherTableCreate(s->mesh->comm, EDGE_COLUMNS, n, rows, table));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts this rank's own nodes into a table of all ranks. */
static PetscErrorCode GatherNodes(SurfaceGraph s, GatherTable *table)
{
  const Mesh  mesh = s->mesh;
  PetscReal  *rows;
  PetscInt    n = 0;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc1(s->group->n_nodes * NODE_COLUMNS, &rows));
  for (PetscInt i = 0; i < s->group->n_nodes; i++) {
    const PetscInt node = s->group->nodes[i];

    if (mesh->node_owner[node] != rank) continue;
    rows[n * NODE_COLUMNS + NODE_ID] = (PetscReal)mesh->node_id[node];
    MeshNodePlace(mesh, node, &rows[n * NODE_COLUMNS + NODE_X]);
    n++;
  }
  PetscCall(GatherTableCreate(mesh->comm, NODE_COLUMNS, n, rows, table));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the place of a node_id in the graph, -1 where it is none of the surface. */
static int FindId(SurfaceGraph s, PetscInt id)
{
  int low = 0, high = s->graph.n;

  while (low < high) {
    const int middle = (low + high) / 2;

    if (s->id[middle] < id)
      low = middle + 1;
    else
      high = middle;
  }
  return low < s->graph.n && s->id[low] == id ? low : -1;
}

static PetscErrorCode TakeNodes(SurfaceGraph s, const GatherTable *table)
{
  const Mesh  mesh = s->mesh;
  PetscMPIInt rank;
  int         n;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMPIIntCast(table->n, &n));
  s->graph.n = n;
  PetscCall(PetscCalloc6(n, &s->id, n, &s->local, n, &s->own, 3 * n, &s->X, n, &s->rim, n + 1, &s->ptr));
  for (int i = 0; i < n; i++) {
    const PetscReal *row = &table->row[i * NODE_COLUMNS];

    s->id[i]    = (PetscInt)row[NODE_ID];
    s->local[i] = -1;
    for (int d = 0; d < mesh->dim; d++) s->X[3 * i + d] = row[NODE_X + d];
  }
  for (PetscInt k = 0; k < s->group->n_nodes; k++) {
    const PetscInt node = s->group->nodes[k];
    const int      i    = FindId(s, mesh->node_id[node]);

    s->local[i] = node;
    s->own[i]   = (PetscBool)(mesh->node_owner[node] == rank);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes lists of neighbours of the sorted edges, and finds where the surface ends: at a node with one neighbour on a
   line, at an edge of one face on a surface. */
static PetscErrorCode TakeEdges(SurfaceGraph s, const GatherTable *table)
{
  int *fill, *end;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * table->n, &end, s->graph.n, &fill));
  for (PetscInt k = 0, next; k < table->n; k = next) {
    const PetscReal *row = &table->row[k * EDGE_COLUMNS];
    const int        a = FindId(s, (PetscInt)row[EDGE_A]), b = FindId(s, (PetscInt)row[EDGE_B]);

    for (next = k + 1; next < table->n && !GatherTableCompare(row, &table->row[next * EDGE_COLUMNS]);) next++;
    for (PetscInt j = k; j < next; j++) {
      end[2 * j]     = j == k ? a : -1;
      end[2 * j + 1] = b;
    }
    if (s->mesh->dim == 3 && next == k + 1 && row[EDGE_INNER] == 0) s->rim[a] = s->rim[b] = 1;
    s->ptr[a + 1]++;
    s->ptr[b + 1]++;
  }
  for (int i = 0; i < s->graph.n; i++) {
    if (s->mesh->dim == 2) s->rim[i] = s->ptr[i + 1] == 1;
    s->ptr[i + 1] += s->ptr[i];
    fill[i] = s->ptr[i];
  }
  PetscCall(PetscMalloc1(s->ptr[s->graph.n], &s->adj));
  for (PetscInt k = 0; k < table->n; k++) {
    if (end[2 * k] < 0) continue;
    s->adj[fill[end[2 * k]]++]     = end[2 * k + 1];
    s->adj[fill[end[2 * k + 1]]++] = end[2 * k];
  }
  s->graph.ptr = s->ptr;
  s->graph.adj = s->adj;
  PetscCall(PetscFree2(end, fill));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceGraphCreate - gathers the nodes of a surface and their neighbours on all ranks.

  Collective

  Input Parameters:
+ mesh  - the mesh; borrowed
- group - of dimension mesh->dim - 1 on the bodies; borrowed

  Output Parameter:
. out - free it with SurfaceGraphDestroy()
@*/
PetscErrorCode SurfaceGraphCreate(Mesh mesh, const MeshGroup *group, SurfaceGraph *out)
{
  SurfaceGraph s;
  GatherTable  table;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out     = s;
  s->mesh  = mesh;
  s->group = group;
  PetscCall(GatherNodes(s, &table));
  PetscCall(TakeNodes(s, &table));
  PetscCall(GatherTableDestroy(&table));
  PetscCall(GatherEdges(s, &table));
  PetscCall(TakeEdges(s, &table));
  PetscCall(GatherTableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceGraphDestroy - frees a graph.

  Not collective

  Input Parameter:
. graph - set to NULL
@*/
PetscErrorCode SurfaceGraphDestroy(SurfaceGraph *graph)
{
  SurfaceGraph s = *graph;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree6(s->id, s->local, s->own, s->X, s->rim, s->ptr));
  PetscCall(PetscFree(s->adj));
  PetscCall(PetscFree(*graph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceGraphGather - gives every rank the values of all nodes of the surface.

  Collective

  Input Parameters:
+ s     - the graph
- local - local[n_nodes] by local node; those of the owners count

  Output Parameter:
. values - values[n] in the order of the graph
@*/
PetscErrorCode SurfaceGraphGather(SurfaceGraph s, const PetscReal *local, PetscReal *values)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < s->graph.n; i++) values[i] = s->own[i] ? local[s->local[i]] : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, s->graph.n, MPIU_REAL, MPI_SUM, s->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceGraphScatter - writes flags of the surface's nodes as 1 and 0 to the local nodes.

  Not collective

  Input Parameters:
+ s    - the graph
- flag - flag[n] in the order of the graph

  Output Parameter:
. local - local[n_nodes] by local node; nodes off the surface stay as they are
@*/
void SurfaceGraphScatter(SurfaceGraph s, const char *flag, PetscReal *local)
{
  for (int i = 0; i < s->graph.n; i++)
    if (s->local[i] >= 0) local[s->local[i]] = flag[i];
}

/*@
  SurfaceGraphGroup - finds the nodes that the surface has in common with a group.

  Collective

  Input Parameters:
+ s     - the graph
- group - a surface, a curve or points of the bodies

  Output Parameters:
+ flag - flag[n]: 1 or 0
- n    - number of these nodes
@*/
PetscErrorCode SurfaceGraphGroup(SurfaceGraph s, const MeshGroup *group, char *flag, PetscInt *n)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(flag, s->graph.n));
  for (PetscInt k = 0; k < group->n_nodes; k++) {
    const int i = FindId(s, s->mesh->node_id[group->nodes[k]]);

    if (i >= 0) flag[i] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, flag, s->graph.n, MPI_SIGNED_CHAR, MPI_MAX, s->mesh->comm));
  *n = 0;
  for (int i = 0; i < s->graph.n; i++) *n += flag[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceGraphNearest - finds the node of the surface that is nearest to a point in the reference configuration.

  Not collective

  Input Parameters:
+ s - the graph
- X - the point, in the coordinates of the mesh file

  Output Parameters:
+ distance - of the node (length)
- reach    - distance of the node's farthest neighbour (length): a point of the surface is no farther away
@*/
PetscInt SurfaceGraphNearest(SurfaceGraph s, const PetscReal X[3], PetscReal *distance, PetscReal *reach)
{
  PetscInt nearest = -1;

  *distance = PETSC_MAX_REAL;
  *reach    = 0;
  for (int i = 0; i < s->graph.n; i++) {
    const PetscReal here = Distance(&s->X[3 * i], X);

    if (here >= *distance) continue;
    *distance = here;
    nearest   = i;
  }
  for (int k = s->graph.ptr[nearest]; k < s->graph.ptr[nearest + 1]; k++)
    *reach = PetscMax(*reach, Distance(&s->X[3 * s->graph.adj[k]], &s->X[3 * nearest]));
  return nearest;
}
