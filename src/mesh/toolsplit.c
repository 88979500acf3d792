/* Splits the faces of a rigid tool, see toolsplit.h.

   A face is split by its marked edges. Corners, middles of edges and the centre are the points from which its parts are
   made. The patterns are: a line in two; a quadrangle in two across, or in four; a triangle in two, three or four. */
#include "private/toolsplit.h"

/* Points of a face: corner k, the middle of edge k, the centre */
enum { MIDDLE = 4, CENTRE = 8, FACE_POINTS = 9, MOST_PARTS = 4 };

/* The parts of a face by their corners, points of the face */
typedef struct {
  int n, corner[MOST_PARTS][4];
} Parts;

/* Marks an edge, and puts its faces on the list of those that are looked at again. */
static void Mark(const ToolEdges *edges, PetscInt e, PetscBool *marked, PetscInt *list, PetscInt *n, PetscBool *listed)
{
  if (marked[e]) return;
  marked[e] = PETSC_TRUE;
  for (int k = 0; k < 2; k++) {
    const PetscInt f = edges->edge[e].face[k];

    if (f < 0 || listed[f]) continue;
    listed[f]    = PETSC_TRUE;
    list[(*n)++] = f;
  }
}

/* Which edge of a face is the longest; of equal ones the first by number, which all faces of an edge agree upon. */
static int LongestEdge(const MeshRigid *tool, const ToolEdges *edges, PetscInt f)
{
  const PetscInt *of      = &edges->of_face[TOOL_FACE_EDGES * f];
  int             longest = 0;
  PetscReal       most    = -1;

  for (int k = 0; k < ElementGet(tool->face_type[f])->edges; k++) {
    const PetscReal length = ToolEdgeLength(edges->dim, tool, &edges->edge[of[k]]);

    if (length < most || (length == most && of[k] > of[longest])) continue;
    longest = k;
    most    = length;
  }
  return longest;
}

/*@
  ToolSplitClose - marks further edges, so that each face has a pattern of marks by which it can be split well.

  Not collective

  Input Parameters:
+ tool  - the tool
- edges - its edges

  Input/Output Parameter:
. marked - marked[edges->n]

  Note:
  A quadrangle is split across two opposite edges or across all, so that it stays a mesh of quadrangles. A triangle is
  split across its longest edge at least, which keeps its angles (Rivara 1984).
@*/
PetscErrorCode ToolSplitClose(const MeshRigid *tool, const ToolEdges *edges, PetscBool *marked)
{
  PetscInt  *list, n = 0;
  PetscBool *listed;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(tool->n_faces, &list, tool->n_faces, &listed));
  for (PetscInt f = 0; f < tool->n_faces; f++) {
    list[n++] = f;
    listed[f] = PETSC_TRUE;
  }
  while (n) {
    const PetscInt f = list[--n], *of = &edges->of_face[TOOL_FACE_EDGES * f];
    const int      count  = ElementGet(tool->face_type[f])->edges;
    PetscBool      any[2] = {PETSC_FALSE, PETSC_FALSE}; /* of the edges with even and with odd numbers */

    listed[f] = PETSC_FALSE;
    for (int k = 0; k < count; k++) any[k % 2] = (PetscBool)(any[k % 2] || marked[of[k]]);
    if (count == 3 && (any[0] || any[1])) Mark(edges, of[LongestEdge(tool, edges, f)], marked, list, &n, listed);
    for (int k = 0; k < count && count == 4; k++)
      if (any[k % 2]) Mark(edges, of[k], marked, list, &n, listed);
  }
  PetscCall(PetscFree2(list, listed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The corners of one part. A triangle and a line have fewer than four. */
static void AddPart(Parts *parts, int a, int b, int c, int d)
{
  int *corner = parts->corner[parts->n++];

  corner[0] = a;
  corner[1] = b;
  corner[2] = c;
  corner[3] = d;
}

/* The parts of a triangle with marks at its edges, one of them the longest. */
static void SplitTriangle(const PetscBool m[], int longest, Parts *parts)
{
  const int k = m[0] + m[1] + m[2] == 1 ? longest : !m[0] ? 0 : !m[1] ? 1 : 2; /* the edge that is alone */
  const int a = k, b = (k + 1) % 3, c = (k + 2) % 3;                           /* its corners, and the other one */

  if (m[0] && m[1] && m[2]) {
    for (int i = 0; i < 3; i++) AddPart(parts, i, MIDDLE + i, MIDDLE + (i + 2) % 3, -1);
    AddPart(parts, MIDDLE, MIDDLE + 1, MIDDLE + 2, -1);
  } else if (m[k]) {
    AddPart(parts, a, MIDDLE + k, c, -1);
    AddPart(parts, MIDDLE + k, b, c, -1);
  } else { /* edges b and c are marked */
    AddPart(parts, MIDDLE + b, c, MIDDLE + c, -1);
    AddPart(parts, a, b, longest == b ? MIDDLE + b : MIDDLE + c, -1);
    if (longest == b)
      AddPart(parts, a, MIDDLE + b, MIDDLE + c, -1);
    else
      AddPart(parts, b, MIDDLE + b, MIDDLE + c, -1);
  }
}

/* The parts of a face with n edges, of which those with m are split. */
static Parts SplitFace(int n, const PetscBool m[], int longest)
{
  Parts parts = {.n = 0};

  if (n == 1) {
    AddPart(&parts, 0, MIDDLE, -1, -1);
    AddPart(&parts, MIDDLE, 1, -1, -1);
  } else if (n == 3) {
    SplitTriangle(m, longest, &parts);
  } else if (m[0] && m[1]) {
    for (int k = 0; k < 4; k++) AddPart(&parts, k, MIDDLE + k, CENTRE, MIDDLE + (k + 3) % 4);
  } else {
    const int k = m[0] ? 0 : 1; /* this edge and the opposite one */

    AddPart(&parts, k, MIDDLE + k, MIDDLE + k + 2, (k + 3) % 4);
    AddPart(&parts, MIDDLE + k, k + 1, (k + 2) % 4, MIDDLE + k + 2);
  }
  return parts;
}

/* The tool that is made */
typedef struct {
  int        dim;
  MeshRigid *tool;
  PetscInt  *node_tag, *face_tag; /* the next tags */
  PetscInt  *middle;              /* of a marked edge: the node in its middle */
  PetscInt (*quarter)[2];         /* of an edge of second order: the middles of its halves, from its first corner */
  ToolOrigin *origin;             /* of the new faces' edges, see ToolSplit() */
} Maker;

/* Adds a node at x. */
static PetscInt AddNode(Maker *maker, const PetscReal *x)
{
  const PetscInt node = maker->tool->n_nodes++;

  for (int d = 0; d < maker->dim; d++) maker->tool->coords[node * maker->dim + d] = x[d];
  maker->tool->node_tag[node] = (*maker->node_tag)++;
  return node;
}

/* Adds a node where shape functions have the values N. */
static PetscInt AddNodeBetween(Maker *maker, int n, const PetscInt nodes[], const double *N)
{
  PetscReal x[3] = {0, 0, 0};

  for (int a = 0; a < n; a++)
    for (int d = 0; d < maker->dim; d++) x[d] += N[a] * maker->tool->coords[nodes[a] * maker->dim + d];
  return AddNode(maker, x);
}

/* Makes the nodes at the middles of marked edges, and for second order those at the middles of their halves. */
static void SplitEdges(Maker *maker, const ToolEdges *edges, const PetscBool *marked)
{
  for (PetscInt e = 0; e < edges->n; e++) {
    const ToolEdge *edge     = &edges->edge[e];
    const PetscInt  nodes[3] = {edge->corner[0], edge->corner[1], edge->middle};

    maker->middle[e] = marked[e] ? edge->middle : -1;
    if (!marked[e]) continue;
    if (edge->middle < 0) maker->middle[e] = AddNodeBetween(maker, 2, nodes, (const double[2]){0.5, 0.5});
    for (int half = 0; half < 2 && edge->middle >= 0; half++) {
      const double xi[3] = {half ? 0.5 : -0.5, 0, 0};
      double       N[FACE_MAX_NODES];

      ElementShape(ELEMENT_EDGE3, xi, N, NULL, NULL);
      maker->quarter[e][half] = AddNodeBetween(maker, 3, nodes, N);
    }
  }
}

/* A face that is split, and the nodes that its parts share */
typedef struct {
  const Element  *face;
  const PetscInt *nodes, *edges;                                       /* of the face */
  PetscInt        point[FACE_POINTS], inner[FACE_POINTS][FACE_POINTS]; /* -1: not made yet */
} SplitWork;

/* Reference coordinates of a point of the face. */
static void PointPlace(const Element *face, int point, double xi[3])
{
  for (int d = 0; d < 3; d++) {
    xi[d] = 0;
    if (point < MIDDLE) xi[d] = face->node[point][d];
    if (point >= MIDDLE && point < CENTRE)
      for (int k = 0; k < 2; k++) xi[d] += face->node[face->edge_corners[point - MIDDLE][k]][d] / 2;
    for (int k = 0; k < face->corners && point == CENTRE; k++) xi[d] += face->node[k][d] / face->corners;
  }
}

/* Adds a node in the face, at the mean place of n of its points. */
static PetscInt AddInner(Maker *maker, const SplitWork *work, int n, const int points[])
{
  double xi[3] = {0, 0, 0}, N[FACE_MAX_NODES];

  for (int i = 0; i < n; i++) {
    double place[3];

    PointPlace(work->face, points[i], place);
    for (int d = 0; d < 3; d++) xi[d] += place[d] / n;
  }
  ElementShape(work->face->type, xi, N, NULL, NULL);
  return AddNodeBetween(maker, work->face->nodes, work->nodes, N);
}

/* The edge of the face on which both points lie, -1 if there is none. */
static int EdgeOf(const Element *face, int p, int q)
{
  for (int k = 0; k < face->edges; k++) {
    const int *corner = face->edge_corners[k];

    if ((p == corner[0] || p == corner[1] || p == MIDDLE + k) && (q == corner[0] || q == corner[1] || q == MIDDLE + k))
      return k;
  }
  return -1;
}

/* What the edge between two points of a face was. */
static ToolOrigin Origin(const ToolEdges *edges, const SplitWork *work, int p, int q)
{
  const int k = EdgeOf(work->face, p, q);

  if (k < 0) return (ToolOrigin){-1, -1, -1};
  if (PetscMax(p, q) < MIDDLE) return (ToolOrigin){work->edges[k], -1, -1};
  const PetscInt node = work->nodes[PetscMin(p, q)];

  return (ToolOrigin){work->edges[k], edges->edge[work->edges[k]].corner[1] == node, node};
}

/* The node in the middle between two points of a face of second order. */
static PetscInt Middle(Maker *maker, const ToolEdges *edges, SplitWork *work, int p, int q)
{
  const int       k         = EdgeOf(work->face, p, q);
  const int       points[2] = {PetscMin(p, q), PetscMax(p, q)};
  PetscInt *const inner     = &work->inner[points[0]][points[1]];

  if (k >= 0 && points[1] < MIDDLE) return work->nodes[work->face->corners + k];
  if (k >= 0) {
    const ToolOrigin half = Origin(edges, work, p, q);

    return maker->quarter[half.edge][half.end];
  }
  if (*inner < 0) *inner = AddInner(maker, work, 2, points);
  return *inner;
}

/* Adds a part of a face to the tool. The first one keeps the tag of the face. */
static void AddFace(Maker *maker, const ToolEdges *edges, SplitWork *work, const int corner[4], PetscInt tag)
{
  MeshRigid      *tool  = maker->tool;
  const PetscInt  f     = tool->n_faces++;
  const Element  *face  = work->face;
  PetscInt *const nodes = &tool->face_nodes[tool->face_ptr[f]];

  tool->face_type[f]    = face->type;
  tool->face_tag[f]     = tag;
  tool->face_ptr[f + 1] = tool->face_ptr[f] + face->nodes;
  for (int k = 0; k < face->corners; k++) nodes[k] = work->point[corner[k]];
  for (int k = 0; k < face->edges; k++) {
    const int p = corner[face->edge_corners[k][0]], q = corner[face->edge_corners[k][1]];

    maker->origin[TOOL_FACE_EDGES * f + k] = Origin(edges, work, p, q);
    if (face->order > 1) nodes[face->corners + k] = Middle(maker, edges, work, p, q);
  }
  if (face->type == ELEMENT_QUAD9) nodes[8] = AddInner(maker, work, 4, corner);
}

/* Adds the parts of face f of the old tool, or the face itself. */
static void AddParts(Maker *maker, const ToolEdges *edges, const MeshRigid *old, PetscInt f, const PetscBool *marked)
{
  const Element *face = ElementGet(old->face_type[f]);
  SplitWork      work = {face, &old->face_nodes[old->face_ptr[f]], &edges->of_face[TOOL_FACE_EDGES * f], {0}, {{0}}};
  PetscBool      m[4] = {PETSC_FALSE}, any = PETSC_FALSE;
  Parts          parts = {1, {{0, 1, 2, 3}}};

  for (int p = 0; p < FACE_POINTS; p++)
    for (int q = 0; q < FACE_POINTS; q++) work.inner[p][q] = -1;
  for (int k = 0; k < face->corners; k++) work.point[k] = work.nodes[k];
  for (int k = 0; k < face->edges; k++) {
    m[k]                   = marked[work.edges[k]];
    any                    = (PetscBool)(any || m[k]);
    work.point[MIDDLE + k] = maker->middle[work.edges[k]];
  }
  if (any) parts = SplitFace(face->edges, m, LongestEdge(old, edges, f));
  if (any && face->edges == 4 && m[0] && m[1])
    work.point[CENTRE] = face->order > 1 ? work.nodes[8] : AddInner(maker, &work, 1, (const int[1]){CENTRE});
  for (int i = 0; i < parts.n; i++)
    AddFace(maker, edges, &work, parts.corner[i], i ? (*maker->face_tag)++ : old->face_tag[f]);
}

/* Bounds of the new tool: nodes and faces, and the entries of all faces. */
static void Bounds(const MeshRigid *old, const ToolEdges *edges, PetscInt *nodes, PetscInt *faces, PetscInt *entries)
{
  *nodes   = old->n_nodes + 2 * edges->n;
  *faces   = MOST_PARTS * old->n_faces;
  *entries = MOST_PARTS * old->face_ptr[old->n_faces];
  for (PetscInt f = 0; f < old->n_faces; f++)
    *nodes += ElementGet(old->face_type[f])->order > 1 ? 2 * MOST_PARTS : ElementGet(old->face_type[f])->edges == 4;
}

/*@
  ToolSplit - splits the faces of a rigid tool at the middles of marked edges.

  Not collective

  Input Parameters:
+ edges  - its edges
- marked - marked[edges->n], after ToolSplitClose()

  Input/Output Parameters:
+ node_tag - tag of the next new node
. face_tag - tag of the next new face
- tool     - the tool; its nodes keep their numbers, new ones follow them

  Output Parameter:
. origin - origin[TOOL_FACE_EDGES*f + k], what edge k of the new face f was, to be freed with PetscFree()

  Note:
  The first part of a face keeps its tag.
@*/
PetscErrorCode ToolSplit(const ToolEdges *edges, const PetscBool *marked, PetscInt *node_tag, PetscInt *face_tag,
                         MeshRigid *tool, ToolOrigin **origin)
{
  MeshRigid old   = *tool;
  Maker     maker = {.dim = edges->dim, .tool = tool, .node_tag = node_tag, .face_tag = face_tag};
  PetscInt  nodes, faces, entries;

  PetscFunctionBeginUser;
  Bounds(&old, edges, &nodes, &faces, &entries);
  PetscCall(PetscMalloc2(nodes * edges->dim, &tool->coords, nodes, &tool->node_tag));
  PetscCall(PetscMalloc4(faces, &tool->face_type, faces + 1, &tool->face_ptr, entries, &tool->face_nodes, faces,
                         &tool->face_tag));
  PetscCall(PetscMalloc2(edges->n, &maker.middle, edges->n, &maker.quarter));
  PetscCall(PetscMalloc1(TOOL_FACE_EDGES * faces, &maker.origin));
  PetscCall(PetscArraycpy(tool->coords, old.coords, old.n_nodes * edges->dim));
  PetscCall(PetscArraycpy(tool->node_tag, old.node_tag, old.n_nodes));
  SplitEdges(&maker, edges, marked);
  tool->n_faces     = 0;
  tool->face_ptr[0] = 0;
  for (PetscInt f = 0; f < old.n_faces; f++) AddParts(&maker, edges, &old, f, marked);
  *origin = maker.origin;
  PetscCall(PetscFree2(maker.middle, maker.quarter));
  PetscCall(PetscFree2(old.coords, old.node_tag));
  PetscCall(PetscFree4(old.face_type, old.face_ptr, old.face_nodes, old.face_tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}
