/* Divides long faces of a rigid tool, see tooldivision.h. */
#include "private/tooldivision.h"
#include "private/toolsplit.h"

/* Edges may be so many times as long as they should be, and lengths may grow by this part of the way along the surface.
   A fit sees some 2.5 faces to each side: it must not reach from the middle of a wall into its fillet. With 3 in the
   place of 2 the force of a punch with a flat and fillets was 0.9 % off, with 0.1; undivided it was 12 %. With 0.2 in
   the place of 0.1 the wall of a die had bumps of a thirtieth of its fillet, at which a tube could not be certified. */
#define TOOL_LONG   2
#define TOOL_GROWTH 0.1
/* A strip of one face between the ends of a surface is halved so often: four faces carry fits of the fourth degree. */
#define TOOL_STRIP_HALVED 2
/* An edge this much shorter than the longest one of the tool is no edge: corners of a face that are one point. */
#define TOOL_NO_LENGTH 1e-9
/* A tool that has come to so many faces, and to so many times those of its mesh, is not divided on: long needles of
   triangles, as CAD programs make them, would become thousands each. */
#define TOOL_FACES 20000
#define TOOL_TIMES 20

/* Whether some face of the edge belongs to a curved surface. */
static PetscBool Curved(const ToolEdges *edges, PetscInt e)
{
  const ToolEdge *edge = &edges->edge[e];

  return (PetscBool)(edges->curved[edge->face[0]] || (edge->face[1] >= 0 && edges->curved[edge->face[1]]));
}

/* Lengths that an edge should have at its two corners */
typedef PetscReal EndLengths[2];

/* The length that each edge of a curved surface should have: no longer than it is, and growing by TOOL_GROWTH of the
   way from shorter edges, along lines of edges. */
static PetscErrorCode WantedLengths(const MeshRigid *tool, const ToolEdges *edges, EndLengths *wanted)
{
  PetscReal *length, longest = 0;
  PetscInt(*next)[2];
  PetscBool changed = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(edges->n, &length, edges->n, &next));
  for (PetscInt e = 0; e < edges->n; e++) {
    length[e] = ToolEdgeLength(edges->dim, tool, &edges->edge[e]);
    longest   = PetscMax(longest, length[e]);
  }
  for (PetscInt e = 0; e < edges->n; e++) {
    for (int k = 0; k < 2; k++) {
      wanted[e][k] = length[e] > TOOL_NO_LENGTH * longest ? length[e] : PETSC_MAX_REAL;
      next[e][k]   = Curved(edges, e) ? ToolEdgeNext(edges, tool, e, edges->edge[e].corner[k]) : -1;
    }
  }
  while (changed) {
    changed = PETSC_FALSE;
    for (PetscInt i = 0; i < 2 * edges->n; i++) { /* to and fro */
      const PetscInt e = i < edges->n ? i : 2 * edges->n - 1 - i;

      for (int k = 0; k < 2; k++) {
        const PetscInt  f = next[e][k];
        const PetscReal bound =
          PetscMin(wanted[e][1 - k] + TOOL_GROWTH * length[e],
                   f < 0 ? PETSC_MAX_REAL : PetscMin(wanted[f][0], wanted[f][1]) + TOOL_GROWTH * length[f]);

        if (wanted[e][k] <= bound) continue;
        wanted[e][k] = bound;
        changed      = PETSC_TRUE;
      }
    }
  }
  PetscCall(PetscFree2(length, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes the wanted lengths on to the edges after a split. Edges that were none before may have any length. */
static PetscErrorCode PassLengths(const MeshRigid *tool, const ToolEdges *edges, const ToolOrigin *origin,
                                  const EndLengths *before, EndLengths *wanted)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < tool->n_faces; f++) {
    for (int k = 0; k < ElementGet(tool->face_type[f])->edges; k++) {
      const ToolOrigin from = origin[TOOL_FACE_EDGES * f + k];
      const PetscInt   e    = edges->of_face[TOOL_FACE_EDGES * f + k];
      const PetscReal  way  = TOOL_GROWTH * ToolEdgeLength(edges->dim, tool, &edges->edge[e]);
      PetscReal *const w    = wanted[e];

      for (int end = 0; end < 2; end++) w[end] = from.edge < 0 ? PETSC_MAX_REAL : before[from.edge][end];
      if (from.edge < 0 || from.end < 0) continue;
      const int kept = edges->edge[e].corner[1] == from.node;

      w[kept]     = before[from.edge][from.end];
      w[1 - kept] = PetscMin(before[from.edge][0], before[from.edge][1]) + way;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks edges that are much longer than they should be. */
static PetscBool MarkLong(const MeshRigid *tool, const ToolEdges *edges, const EndLengths *wanted, PetscBool *marked)
{
  PetscBool any = PETSC_FALSE;

  for (PetscInt e = 0; e < edges->n; e++) {
    marked[e] =
      (PetscBool)(ToolEdgeLength(edges->dim, tool, &edges->edge[e]) > TOOL_LONG * PetscMin(wanted[e][0], wanted[e][1]));
    any = (PetscBool)(any || marked[e]);
  }
  return any;
}

/* Finds the nodes at the ends of smooth surfaces. */
static void FindEnds(const ToolEdges *edges, PetscBool *end)
{
  for (PetscInt e = 0; e < edges->n; e++)
    for (int k = 0; k < 2 && !edges->edge[e].smooth; k++) end[edges->edge[e].corner[k]] = PETSC_TRUE;
}

/* Whether all corners of a face are ends. */
static PetscBool IsStrip(const MeshRigid *tool, PetscInt f, const PetscBool *end)
{
  for (int k = 0; k < ElementGet(tool->face_type[f])->corners; k++)
    if (!end[tool->face_nodes[tool->face_ptr[f] + k]]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Marks the edges that lead across strips of one face: between two faces all of whose nodes are ends. */
static PetscBool MarkStrips(const MeshRigid *tool, const ToolEdges *edges, const PetscBool *end, PetscBool *marked)
{
  PetscBool any = PETSC_FALSE;

  for (PetscInt e = 0; e < edges->n; e++) {
    const ToolEdge *edge = &edges->edge[e];

    if (!edge->smooth || !Curved(edges, e)) continue;
    marked[e] = (PetscBool)(IsStrip(tool, edge->face[0], end) && IsStrip(tool, edge->face[1], end));
    any       = (PetscBool)(any || marked[e]);
  }
  return any;
}

/* Marks the edges from the middle of a strip that was halved to its ends. */
static PetscBool MarkHalves(const ToolEdges *edges, const PetscBool *row, const PetscBool *end, PetscBool *marked)
{
  PetscBool any = PETSC_FALSE;

  for (PetscInt e = 0; e < edges->n; e++) {
    const PetscInt *corner = edges->edge[e].corner;

    if (!edges->edge[e].smooth || row[corner[0]] == row[corner[1]]) continue;
    marked[e] = end[corner[row[corner[0]] ? 1 : 0]];
    any       = (PetscBool)(any || marked[e]);
  }
  return any;
}

/* A division under way */
typedef struct {
  int         dim;
  MeshRigid  *tool;
  PetscInt   *node_tag, *face_tag; /* the next tags */
  int         halved;              /* so often strips were */
  PetscInt    row_start, row_end;  /* nodes that the last halving of strips made; none: both 0 */
  ToolEdges   edges;
  EndLengths *wanted; /* of the edges; NULL: strips are halved yet */
} Division;

/* Splits at the marked edges, and makes the edges of the new faces and their wanted lengths. */
static PetscErrorCode Split(Division *division, PetscBool *marked)
{
  MeshRigid  *tool   = division->tool;
  EndLengths *before = division->wanted;
  ToolOrigin *origin;

  PetscFunctionBeginUser;
  PetscCall(ToolSplitClose(tool, &division->edges, marked));
  division->row_start = tool->n_nodes;
  PetscCall(ToolSplit(&division->edges, marked, division->node_tag, division->face_tag, tool, &origin));
  division->row_end = tool->n_nodes;
  PetscCall(ToolEdgesDestroy(&division->edges));
  PetscCall(ToolEdgesCreate(division->dim, tool, &division->edges));
  if (before) {
    PetscCall(PetscMalloc1(division->edges.n, &division->wanted));
    PetscCall(PassLengths(tool, &division->edges, origin, before, division->wanted));
    PetscCall(PetscFree(before));
  }
  PetscCall(PetscFree(origin));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the edges that lead across strips of few faces. */
static PetscErrorCode MarkAcross(const Division *division, PetscBool *marked, PetscBool *any)
{
  const MeshRigid *tool = division->tool;
  PetscBool       *end, *row;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(tool->n_nodes, &end, tool->n_nodes, &row));
  for (PetscInt i = division->row_start; i < division->row_end; i++) row[i] = PETSC_TRUE;
  FindEnds(&division->edges, end);
  *any =
    division->halved ? MarkHalves(&division->edges, row, end, marked) : MarkStrips(tool, &division->edges, end, marked);
  PetscCall(PetscFree2(end, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Halves strips, or long edges where wanted lengths are there. Tells whether there were any. */
static PetscErrorCode Halve(Division *division, PetscBool *any)
{
  PetscBool *marked;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(division->edges.n, &marked));
  if (division->wanted)
    *any = MarkLong(division->tool, &division->edges, division->wanted, marked);
  else
    PetscCall(MarkAcross(division, marked, any));
  if (*any) PetscCall(Split(division, marked));
  PetscCall(PetscFree(marked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolDivide - divides long faces of a rigid tool that lie beside short ones in one curved surface.

  Not collective

  Input Parameter:
. dim - dimension of the mesh

  Input/Output Parameters:
+ tool     - the tool; its nodes and the first part of each face keep their tags
. node_tag - tag of the next new node
- face_tag - tag of the next new face

  Note:
  New nodes lie in the middle of edges, so that no point of the facets moves. Flat surfaces and those of even faces stay
  as they are. It is the same on all ranks.
@*/
PetscErrorCode ToolDivide(int dim, MeshRigid *tool, PetscInt *node_tag, PetscInt *face_tag)
{
  const PetscInt most     = PetscMax(TOOL_FACES, TOOL_TIMES * tool->n_faces);
  Division       division = {.dim = dim, .tool = tool, .node_tag = node_tag, .face_tag = face_tag};
  PetscBool      any      = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(ToolEdgesCreate(dim, tool, &division.edges));
  for (; division.halved < TOOL_STRIP_HALVED && any; division.halved++) PetscCall(Halve(&division, &any));
  PetscCall(PetscMalloc1(division.edges.n, &division.wanted));
  PetscCall(WantedLengths(tool, &division.edges, division.wanted));
  for (any = PETSC_TRUE; any && tool->n_faces < most;) PetscCall(Halve(&division, &any));
  PetscCall(PetscFree(division.wanted));
  PetscCall(ToolEdgesDestroy(&division.edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}
