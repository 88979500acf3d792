/* Pieces of a tool, and votes of the slave's nodes on their sides, see toolside.h. */
#include "search/toolside.h"
#include "base/boxtree.h"

/* Slave nodes that are nearer to the tool than this part of a slave's face touch it, and the sign of their distance is
   that of an overlap or of round-off. */
#define TOOL_TOUCHES 0.1
/* Votes between -1 and 1 whose mean is nearer to 0 than this decide nothing: the slave is on both sides, or beside the
   tool. */
#define TOOL_DECIDES 0.3

/* An edge of a face (an end in 2D), its nodes in ascending order; sense: whether the face runs along it that way. */
typedef struct {
  int node[2], face, sense;
} ToolEdge;

/* Pieces as trees of faces: parent of each face, and whether its normal is against that of the parent. */
typedef struct {
  int *parent, *against;
} ToolPieces;

/* The nearest face of one piece to a slave node. */
typedef struct {
  ContactSurface   tool;
  const PetscReal *x;     /* of the tool's nodes */
  const int       *faces; /* of the piece */
  const PetscReal *point;
  int              best; /* a face of the tool, -1: none yet */
  Foot             foot;
} ToolNearest;

static int ToolEdgeCompare(const void *a, const void *b)
{
  const ToolEdge *p = a, *q = b;

  if (p->node[0] != q->node[0]) return p->node[0] < q->node[0] ? -1 : 1;
  if (p->node[1] != q->node[1]) return p->node[1] < q->node[1] ? -1 : 1;
  return p->face < q->face ? -1 : p->face > q->face;
}

static int ListEdges(ContactSurface tool, ToolEdge *edges)
{
  int n = 0;

  for (int f = 0; f < (int)tool->n_faces; f++) {
    const Facet   *face = &tool->faces[f];
    const Element *e    = ElementGet(face->type);

    for (int k = 0; k < (e->dim == 1 ? 2 : e->edges); k++) {
      const int a = face->nodes[e->dim == 1 ? k : e->edge_corners[k][0]],
                b = face->nodes[e->dim == 1 ? k : e->edge_corners[k][1]];

      edges[n++] = (ToolEdge){{PetscMin(a, b), PetscMax(a, b)}, f, e->dim == 1 ? k : a < b};
    }
  }
  return n;
}

/* Finds the root of a face's piece, and whether the face's normal is against that of the root. */
static int PieceRoot(ToolPieces *pieces, int face, int *against)
{
  int root = face, turn = 0;

  while (pieces->parent[root] != root) {
    turn ^= pieces->against[root];
    root = pieces->parent[root];
  }
  *against = turn;
  while (pieces->parent[face] != root && face != root) { /* shortens the way for the next search */
    const int next = pieces->parent[face], rest = turn ^ pieces->against[face];

    pieces->parent[face]  = root;
    pieces->against[face] = turn;
    face                  = next;
    turn                  = rest;
  }
  return root;
}

/* Joins the faces of a tool across the edges that exactly two of them share. */
static PetscErrorCode FindPieces(ContactSurface tool, ToolPieces *pieces)
{
  ToolEdge *edges;
  int       n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(tool->n_faces, &pieces->parent, tool->n_faces, &pieces->against));
  PetscCall(PetscMalloc1(tool->n_faces * 4, &edges)); /* a quadrilateral has 4 edges */
  for (int f = 0; f < (int)tool->n_faces; f++) {
    pieces->parent[f]  = f;
    pieces->against[f] = 0;
  }
  n = ListEdges(tool, edges);
  if (n) qsort(edges, n, sizeof(*edges), ToolEdgeCompare);
  for (int i = 0, j; i < n; i = j) {
    int a, b, root_a, root_b;

    for (j = i + 1; j < n && edges[j].node[0] == edges[i].node[0] && edges[j].node[1] == edges[i].node[1]; j++) {}
    if (j != i + 2) continue;
    root_a = PieceRoot(pieces, edges[i].face, &a);
    root_b = PieceRoot(pieces, edges[i + 1].face, &b);
    if (root_a == root_b) continue;
    pieces->parent[PetscMax(root_a, root_b)]  = PetscMin(root_a, root_b);
    pieces->against[PetscMax(root_a, root_b)] = a ^ b ^ (edges[i].sense == edges[i + 1].sense);
  }
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the normal of a face: its nodes follow in the opposite sense. */
static void TurnFace(Facet *face)
{
  const SurfaceImage turn = {.reverses = PETSC_TRUE};

  *face = SurfaceImageFacet(face, &turn);
}

static void VisitFace(void *context, int index, double *bound)
{
  ToolNearest *look  = context;
  const int    dim   = look->tool->mesh->dim;
  Facet        facet = look->tool->faces[look->faces[index]];
  PetscReal    x[FACE_MAX_NODES * 3];
  Foot         foot;

  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    for (int d = 0; d < dim; d++) x[a * dim + d] = look->x[facet.nodes[a] * dim + d] - look->point[d];
    facet.nodes[a] = a;
  }
  FacetProject(dim, &facet, x, &foot);
  if (PetscAbsReal(foot.gap) >= *bound) return;
  *bound     = PetscAbsReal(foot.gap);
  look->best = look->faces[index];
  look->foot = foot;
}

/* Unit normal of a face at the foot on it. */
static void FaceNormal(ContactSurface tool, const PetscReal *x, int f, PetscReal normal[3])
{
  const Facet *face = &tool->faces[f];
  const int    dim = tool->mesh->dim, nodes = ElementGet(face->type)->nodes;
  double       X[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS], at[FACE_RULE_POINTS * 3];
  PetscReal    length = 0;

  for (int a = 0; a < nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = x[face->nodes[a] * dim + d];
  FaceRuleAreas(FaceRuleGet(face->type, 0), face->type, dim, GEOMETRY_SOLID, X, area, at);
  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (int q = 0; q < FaceRuleGet(face->type, 0)->n; q++)
    for (int d = 0; d < dim; d++) normal[d] += at[3 * q + d];
  for (int d = 0; d < 3; d++) length += PetscSqr(normal[d]);
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= PetscSqrtReal(length);
}

/* Vote of a slave node for the normal of the nearest face, from -1 to 1. Where the node's own normal looks at the tool
   there is a gap, and its direction votes. Elsewhere the node overlaps or looks away, and the normals vote. */
static PetscReal NodeVote(const ToolNearest *look, PetscReal touches, const PetscReal own[3])
{
  PetscReal length = PetscSqrtReal(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]), opposed = 0, along = 0,
            looks = 0, normal[3];

  FaceNormal(look->tool, look->x, look->best, normal);
  for (int d = 0; d < look->tool->mesh->dim; d++) {
    opposed -= own[d] * normal[d] / length;
    along += look->foot.normal[d] * normal[d];
    looks -= own[d] * look->foot.normal[d] * look->foot.gap;
  }
  if (PetscAbsReal(look->foot.gap) > touches && looks > 0) return look->foot.gap > 0 ? along : -along;
  return opposed;
}

/* Sums the votes of the slave nodes of all ranks on a piece. The nodes that are about as near as the nearest one count
   most. Those behind them may look away from the tool, as the inner wall of a ring does. */
static PetscErrorCode PieceVotes(ContactSurface tool, ContactSurface slave, const PetscReal *x, int n, const int *faces,
                                 const PetscReal *normals, PetscReal votes[2])
{
  Mesh        mesh = slave->mesh;
  const int   dim  = mesh->dim;
  PetscReal  *lower, *upper, *gap, *vote, nearest = PETSC_MAX_REAL;
  PetscInt    voters = 0;
  PetscMPIInt rank;
  BoxTree     tree;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc2(n * dim, &lower, n * dim, &upper));
  PetscCall(PetscMalloc2(slave->group->n_nodes, &gap, slave->group->n_nodes, &vote));
  for (int i = 0; i < n; i++) {
    const Facet *face = &tool->faces[faces[i]];

    for (int d = 0; d < dim; d++) {
      lower[i * dim + d] = PETSC_MAX_REAL;
      upper[i * dim + d] = PETSC_MIN_REAL;
      for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
        lower[i * dim + d] = PetscMin(lower[i * dim + d], x[face->nodes[a] * dim + d]);
        upper[i * dim + d] = PetscMax(upper[i * dim + d], x[face->nodes[a] * dim + d]);
      }
    }
  }
  PetscCheck(!BoxTreeBuild(dim, n, lower, upper, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the tree");
  for (PetscInt i = 0; i < slave->group->n_nodes; i++) {
    const PetscInt   node  = slave->group->nodes[i];
    const PetscReal *own   = &normals[3 * node];
    double           bound = PETSC_MAX_REAL;
    ToolNearest      look  = {tool, x, faces, &mesh->coords[node * dim], -1, {0}};

    if (mesh->node_owner[node] != rank || (own[0] == 0 && own[1] == 0 && own[2] == 0)) continue;
    BoxTreeClosest(tree, look.point, NULL, &bound, VisitFace, &look);
    gap[voters]    = PetscAbsReal(look.foot.gap);
    vote[voters++] = NodeVote(&look, TOOL_TOUCHES * slave->mean_size, own);
    nearest        = PetscMin(nearest, PetscAbsReal(look.foot.gap));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &nearest, 1, MPIU_REAL, MPIU_MIN, mesh->comm));
  votes[0] = votes[1] = 0;
  for (PetscInt i = 0; i < voters; i++) {
    const PetscReal weight = 1 / PetscSqr(PetscSqr(1 + (gap[i] - nearest) / slave->mean_size));

    votes[0] += weight * vote[i];
    votes[1] += weight;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, votes, 2, MPIU_REAL, MPI_SUM, mesh->comm));
  BoxTreeDestroy(&tree);
  PetscCall(PetscFree2(gap, vote));
  PetscCall(PetscFree2(lower, upper));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Positions of the tool's nodes at the start. */
static PetscErrorCode ToolPositions(ContactSurface tool, Loads loads, PetscReal **x)
{
  const int dim = tool->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(tool->rigid->n_nodes * dim, x));
  for (PetscInt i = 0; i < tool->rigid->n_nodes; i++) {
    PetscReal X[3] = {0, 0, 0}, y[3];

    for (int d = 0; d < dim; d++) X[d] = tool->rigid->coords[i * dim + d];
    LoadsRigidMotion(loads, tool->body, 0, X, y);
    for (int d = 0; d < dim; d++) (*x)[i * dim + d] = y[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolSideFind - turns the normals of a rigid tool to the side on which the slave starts.

  Collective

  Input Parameters:
+ slave - a deformable surface
- loads - gives the position of the tool at the start

  Input/Output Parameter:
. tool - a rigid surface whose free edges are not found yet; the nodes of its faces change their order

  Output Parameters:
+ turned  - number of faces that were turned
- decided - PETSC_FALSE where the slave is on both sides of a piece or beside it; nothing is turned then

  Note:
  Faces that share an edge get normals to the same side. Then the slave's nodes vote on each connected piece, the
  nearest ones with most weight.
@*/
PetscErrorCode ToolSideFind(ContactSurface tool, ContactSurface slave, Loads loads, PetscInt *turned,
                            PetscBool *decided)
{
  Mesh       mesh = slave->mesh;
  PetscReal *x, *area, *normals;
  ToolPieces pieces;
  int       *faces, *turn;

  PetscFunctionBeginUser;
  *turned  = 0;
  *decided = PETSC_TRUE;
  PetscCall(ToolPositions(tool, loads, &x));
  PetscCall(FindPieces(tool, &pieces));
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normals));
  PetscCall(SurfaceNodeNormals(slave, NULL, area, normals));
  PetscCall(PetscMalloc2(tool->n_faces, &faces, tool->n_faces, &turn));
  for (int f = 0; f < (int)tool->n_faces; f++) PieceRoot(&pieces, f, &turn[f]);
  for (int f = 0; f < (int)tool->n_faces; f++)
    if (turn[f]) TurnFace(&tool->faces[f]);
  for (int root = 0; root < (int)tool->n_faces; root++) {
    PetscReal votes[2];
    int       n = 0, against;

    if (pieces.parent[root] != root) continue;
    for (int f = root; f < (int)tool->n_faces; f++)
      if (PieceRoot(&pieces, f, &against) == root) faces[n++] = f;
    PetscCall(PieceVotes(tool, slave, x, n, faces, normals, votes));
    if (!(PetscAbsReal(votes[0]) >= TOOL_DECIDES * votes[1])) *decided = PETSC_FALSE;
    for (int i = 0; i < n && votes[0] < 0; i++) {
      TurnFace(&tool->faces[faces[i]]);
      turn[faces[i]] = !turn[faces[i]];
    }
  }
  for (int f = 0; f < (int)tool->n_faces; f++) {
    if (turn[f] && !*decided) TurnFace(&tool->faces[f]);
    *turned += *decided && turn[f];
  }
  PetscCall(PetscFree2(faces, turn));
  PetscCall(PetscFree2(area, normals));
  PetscCall(PetscFree2(pieces.parent, pieces.against));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolSideFlip - turns all normals of a rigid tool.

  Not collective

  Input/Output Parameter:
. tool - a rigid surface whose free edges are not found yet
@*/
void ToolSideFlip(ContactSurface tool)
{
  for (PetscInt f = 0; f < tool->n_faces; f++) TurnFace(&tool->faces[f]);
}
