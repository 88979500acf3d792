/* Edges of a rigid tool's faces, see tooledges.h. */
#include "private/tooledges.h"
#include "base/vectors.h"

/* A surface whose nodes are off one plane by less than this part of its extent is flat. */
#define TOOL_FLAT 1e-6

/* Makes the edges of all faces, each once. */
static PetscErrorCode ListEdges(const MeshRigid *tool, ToolEdges *edges)
{
  PetscInt *first, *next; /* first edge with this lower corner, next such edge */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(TOOL_FACE_EDGES * tool->n_faces, &edges->edge, TOOL_FACE_EDGES * tool->n_faces,
                         &edges->of_face, tool->n_faces, &edges->curved));
  PetscCall(PetscMalloc2(tool->n_nodes, &first, TOOL_FACE_EDGES * tool->n_faces, &next));
  for (PetscInt i = 0; i < tool->n_nodes; i++) first[i] = -1;
  for (PetscInt f = 0; f < tool->n_faces; f++) {
    const Element  *face  = ElementGet(tool->face_type[f]);
    const PetscInt *nodes = &tool->face_nodes[tool->face_ptr[f]];

    for (int k = 0; k < face->edges; k++) {
      const PetscInt a = nodes[face->edge_corners[k][0]], b = nodes[face->edge_corners[k][1]], low = PetscMin(a, b);
      PetscInt       e = first[low];

      while (e >= 0 && edges->edge[e].corner[0] + edges->edge[e].corner[1] != a + b) e = next[e];
      if (e < 0) {
        e              = edges->n++;
        next[e]        = first[low];
        first[low]     = e;
        edges->edge[e] = (ToolEdge){.corner = {low, PetscMax(a, b)},
                                    .middle = face->order > 1 ? nodes[face->corners + k] : -1,
                                    .face   = {-1, -1}};
      }
      if (edges->edge[e].n_faces < 2) edges->edge[e].face[edges->edge[e].n_faces] = f;
      edges->edge[e].n_faces++;
      edges->of_face[TOOL_FACE_EDGES * f + k] = e;
    }
  }
  PetscCall(PetscFree2(first, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the edges at each node. */
static PetscErrorCode ListAtNodes(const MeshRigid *tool, ToolEdges *edges)
{
  PetscInt *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(tool->n_nodes + 1, &edges->node_ptr, 2 * edges->n, &edges->node_edge));
  PetscCall(PetscCalloc1(tool->n_nodes + 1, &place));
  for (PetscInt e = 0; e < edges->n; e++)
    for (int k = 0; k < 2; k++) place[edges->edge[e].corner[k] + 1]++;
  for (PetscInt i = 0; i < tool->n_nodes; i++) place[i + 1] += place[i];
  PetscCall(PetscArraycpy(edges->node_ptr, place, tool->n_nodes + 1));
  for (PetscInt e = 0; e < edges->n; e++)
    for (int k = 0; k < 2; k++) edges->node_edge[place[edges->edge[e].corner[k]]++] = e;
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node's place in space. */
static void Place(int dim, const MeshRigid *tool, PetscInt node, PetscReal x[3])
{
  for (int d = 0; d < 3; d++) x[d] = d < dim ? tool->coords[node * dim + d] : 0;
}

/* Unit vector from one node to another. */
static void Direction(int dim, const MeshRigid *tool, PetscInt from, PetscInt to, PetscReal d[3])
{
  PetscReal a[3], b[3], length;

  Place(dim, tool, from, a);
  Place(dim, tool, to, b);
  Minus(b, a, d);
  length = PetscSqrtReal(Dot(d, d));
  for (int k = 0; k < 3 && length > 0; k++) d[k] /= length;
}

/* Unit normal of a face by its corners. */
static void Normal(int dim, const MeshRigid *tool, PetscInt f, PetscReal normal[3])
{
  const PetscInt *nodes   = &tool->face_nodes[tool->face_ptr[f]];
  const int       corners = ElementGet(tool->face_type[f])->corners;
  PetscReal       a[3], b[3], length;

  Direction(dim, tool, nodes[0], nodes[corners == 4 ? 2 : 1], a);
  if (dim == 2) {
    normal[0] = a[1];
    normal[1] = -a[0];
    normal[2] = 0;
    return;
  }
  Direction(dim, tool, nodes[corners == 4 ? 1 : 0], nodes[corners == 4 ? 3 : 2], b);
  Cross(a, b, normal);
  length = PetscSqrtReal(Dot(normal, normal));
  for (int k = 0; k < 3 && length > 0; k++) normal[k] /= length;
}

/* Whether two faces that share something meet as one surface. A surface may list them in opposite directions. */
static PetscBool Smooth(int dim, const MeshRigid *tool, PetscInt f, PetscInt g)
{
  PetscReal a[3], b[3];

  Normal(dim, tool, f, a);
  Normal(dim, tool, g, b);
  return (PetscBool)(PetscAbsReal(Dot(a, b)) > TOOL_SMOOTH_COSINE);
}

/* The face that stands for the surface of face f. Shortens the way to it. */
static PetscInt Root(PetscInt *root, PetscInt f)
{
  while (root[f] != f) f = root[f] = root[root[f]];
  return f;
}

/* Finds the smooth edges, and joins the faces that are one surface: across these, in the plane at nodes of two faces.
 */
static PetscErrorCode JoinFaces(const MeshRigid *tool, ToolEdges *edges, PetscInt *root)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < tool->n_faces; f++) root[f] = f;
  for (PetscInt e = 0; e < edges->n && edges->dim == 3; e++) {
    ToolEdge *edge = &edges->edge[e];

    edge->smooth = (PetscBool)(edge->n_faces == 2 && Smooth(edges->dim, tool, edge->face[0], edge->face[1]));
    if (edge->smooth) root[Root(root, edge->face[0])] = Root(root, edge->face[1]);
  }
  for (PetscInt i = 0; i < tool->n_nodes && edges->dim == 2; i++) {
    const PetscInt *at = &edges->node_edge[edges->node_ptr[i]];

    if (edges->node_ptr[i + 1] - edges->node_ptr[i] != 2) continue;
    const PetscInt f = edges->edge[at[0]].face[0], g = edges->edge[at[1]].face[0];

    if (Smooth(edges->dim, tool, f, g)) root[Root(root, f)] = Root(root, g);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the surfaces that are not in a plane: some node is off the plane of the surface's first face. */
static PetscErrorCode FindCurved(const MeshRigid *tool, ToolEdges *edges)
{
  PetscInt  *root;
  PetscReal *off, *extent;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(tool->n_faces, &root));
  PetscCall(PetscCalloc2(tool->n_faces, &off, tool->n_faces, &extent));
  PetscCall(JoinFaces(tool, edges, root));
  for (PetscInt f = 0; f < tool->n_faces; f++) {
    const PetscInt r = Root(root, f);
    PetscReal      normal[3], origin[3], x[3];

    Normal(edges->dim, tool, r, normal);
    Place(edges->dim, tool, tool->face_nodes[tool->face_ptr[r]], origin);
    for (PetscInt k = tool->face_ptr[f]; k < tool->face_ptr[f + 1]; k++) {
      Place(edges->dim, tool, tool->face_nodes[k], x);
      for (int d = 0; d < 3; d++) x[d] -= origin[d];
      off[r]    = PetscMax(off[r], PetscAbsReal(Dot(x, normal)));
      extent[r] = PetscMax(extent[r], PetscSqrtReal(Dot(x, x)));
    }
  }
  for (PetscInt f = 0; f < tool->n_faces; f++)
    edges->curved[f] = (PetscBool)(off[Root(root, f)] > TOOL_FLAT * extent[Root(root, f)]);
  PetscCall(PetscFree2(off, extent));
  PetscCall(PetscFree(root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolEdgesCreate - lists the edges of a rigid tool's faces, and finds where its surface is curved.

  Not collective

  Input Parameters:
+ dim  - dimension of the mesh
- tool - the tool

  Output Parameter:
. edges - to be freed with ToolEdgesDestroy()
@*/
PetscErrorCode ToolEdgesCreate(int dim, const MeshRigid *tool, ToolEdges *edges)
{
  PetscFunctionBeginUser;
  *edges = (ToolEdges){.dim = dim};
  PetscCall(ListEdges(tool, edges));
  PetscCall(ListAtNodes(tool, edges));
  PetscCall(FindCurved(tool, edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolEdgesDestroy - frees the edges of a tool.

  Not collective

  Input/Output Parameter:
. edges - the edges
@*/
PetscErrorCode ToolEdgesDestroy(ToolEdges *edges)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(edges->edge, edges->of_face, edges->curved));
  PetscCall(PetscFree2(edges->node_ptr, edges->node_edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolEdgeOther - returns the corner at the other end of an edge.

  Not collective

  Input Parameters:
+ edge - the edge
- node - one of its corners
@*/
PetscInt ToolEdgeOther(const ToolEdge *edge, PetscInt node)
{
  return edge->corner[0] == node ? edge->corner[1] : edge->corner[0];
}

/*@
  ToolEdgeLength - returns the distance of the corners of an edge (length).

  Not collective

  Input Parameters:
+ dim  - dimension of the mesh
. tool - the tool
- edge - the edge
@*/
PetscReal ToolEdgeLength(int dim, const MeshRigid *tool, const ToolEdge *edge)
{
  PetscReal a[3], b[3];

  Place(dim, tool, edge->corner[0], a);
  Place(dim, tool, edge->corner[1], b);
  return Distance(a, b);
}

/*@
  ToolEdgeNext - finds the edge that goes on from an edge, beyond one of its corners.

  Not collective

  Input Parameters:
+ edges - the edges
. tool  - the tool
. edge  - the edge
- node  - one of its corners

  Note:
  It is the one that turns least. Returns -1 if all turn by more than 60 degrees.
@*/
PetscInt ToolEdgeNext(const ToolEdges *edges, const MeshRigid *tool, PetscInt edge, PetscInt node)
{
  PetscReal best = TOOL_SMOOTH_COSINE, along[3], other[3];
  PetscInt  next = -1;

  Direction(edges->dim, tool, ToolEdgeOther(&edges->edge[edge], node), node, along);
  for (PetscInt k = edges->node_ptr[node]; k < edges->node_ptr[node + 1]; k++) {
    const PetscInt e = edges->node_edge[k];

    if (e == edge) continue;
    Direction(edges->dim, tool, node, ToolEdgeOther(&edges->edge[e], node), other);
    if (Dot(along, other) <= best) continue;
    best = Dot(along, other);
    next = e;
  }
  return next;
}
