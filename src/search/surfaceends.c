/* Ends of a surface and its sharp edges, see surfaceends.h. */
#include "search/surfaceends.h"
#include "base/gathertable.h"

/* Columns of a table of edges: the ids of the two corners (in 2D twice the same), the rank and the face that the edge
   belongs to there, the number of the edge in the face, and the face's normal there */
enum { EDGE_LOW, EDGE_HIGH, EDGE_RANK, EDGE_FACE, EDGE_NUMBER, EDGE_NORMAL, EDGE_COLUMNS = EDGE_NORMAL + 3 };

typedef struct {
  ContactSurface      surface;
  PetscReal           cosine; /* of the angle by which the surface turns at a sharp edge */
  int                 n_images;
  const SurfaceImage *images;
  PetscMPIInt         rank;
} EndSearch;

/* Corners of an edge of a face, by their number in it; in 2D twice the end. */
static void EdgeCorners(const Element *e, int edge, int corner[2])
{
  for (int k = 0; k < 2; k++) corner[k] = e->dim == 1 ? edge : e->edge_corners[edge][k];
}

/*@
  SurfaceEdgeFrame - finds the unit normal of a face in the middle of an edge, and the way out across it.

  Not collective

  Input Parameters:
+ surface - the surface
. facet   - one of its faces
- edge    - number of the edge in the face, in 2D of the end

  Output Parameters:
+ normal - in the reference configuration
- out    - square to the normal, of any length
@*/
void SurfaceEdgeFrame(ContactSurface surface, const Facet *facet, int edge, PetscReal normal[3], PetscReal out[3])
{
  const Element   *e     = ElementGet(facet->type);
  const PetscReal *X     = surface->rigid ? surface->rigid->coords : surface->mesh->coords;
  const int        dim   = surface->mesh->dim;
  PetscReal        area  = 0;
  double           xi[2] = {0, 0}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], t[2][3] = {{0}}, across[2] = {0, 0};
  int              corner[2];

  EdgeCorners(e, edge, corner);
  for (int k = 0; k < e->dim; k++) xi[k] = (e->node[corner[0]][k] + e->node[corner[1]][k]) / 2;
  for (int k = 0; k < e->dim; k++) {
    double centre = 0;

    for (int a = 0; a < e->corners; a++) centre += e->node[a][k] / e->corners;
    across[k] = xi[k] - centre;
  }
  ElementShape(facet->type, xi, N, dN, NULL);
  for (int a = 0; a < e->nodes; a++)
    for (int k = 0; k < e->dim; k++)
      for (int d = 0; d < dim; d++) t[k][d] += dN[a * e->dim + k] * X[facet->nodes[a] * dim + d];
  for (int d = 0; d < 3; d++) out[d] = across[0] * t[0][d] + across[1] * t[1][d];
  if (dim == 2) t[1][2] = 1;
  for (int d = 0; d < 3; d++) normal[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
  for (int d = 0; d < 3; d++) area += PetscSqr(normal[d]);
  for (int d = 0; d < 3 && area > 0; d++) normal[d] /= PetscSqrtReal(area);
}

/* Fills a row of the table. */
static void FillRow(const EndSearch *s, PetscInt f, int edge, PetscReal *row)
{
  const Facet *facet = &s->surface->faces[f];
  PetscReal    out[3];
  PetscInt     a, b;
  int          corner[2];

  EdgeCorners(ElementGet(facet->type), edge, corner);
  a                = s->surface->mesh->node_id[facet->nodes[corner[0]]];
  b                = s->surface->mesh->node_id[facet->nodes[corner[1]]];
  row[EDGE_LOW]    = (PetscReal)PetscMin(a, b);
  row[EDGE_HIGH]   = (PetscReal)PetscMax(a, b);
  row[EDGE_RANK]   = s->rank;
  row[EDGE_FACE]   = (PetscReal)f;
  row[EDGE_NUMBER] = edge;
  SurfaceEdgeFrame(s->surface, facet, edge, &row[EDGE_NORMAL], out);
}

/* Does the surface turn away at an edge of a face, to a neighbour with this normal? */
static PetscBool TurnsAway(const EndSearch *s, PetscInt f, int edge, const PetscReal neighbour[3])
{
  PetscReal normal[3], out[3], along = 0, away = 0;

  SurfaceEdgeFrame(s->surface, &s->surface->faces[f], edge, normal, out);
  for (int d = 0; d < 3; d++) {
    along += normal[d] * neighbour[d];
    away += out[d] * neighbour[d];
  }
  return (PetscBool)(along < s->cosine && away > 0);
}

/* Image of a plane of symmetry that holds an edge, or NULL. */
static const SurfaceImage *PlaneOfEdge(const EndSearch *s, PetscInt f, int edge)
{
  const Mesh   mesh  = s->surface->mesh;
  const Facet *facet = &s->surface->faces[f];
  int          corner[2];

  EdgeCorners(ElementGet(facet->type), edge, corner);
  for (int plane = 1; plane < s->n_images; plane <<= 1)
    if (SurfaceOnPlane(mesh, &s->images[plane], &mesh->coords[facet->nodes[corner[0]] * mesh->dim]) &&
        SurfaceOnPlane(mesh, &s->images[plane], &mesh->coords[facet->nodes[corner[1]] * mesh->dim]))
      return &s->images[plane];
  return NULL;
}

/* Is an edge an end that only one face of all ranks has? Beyond a plane of symmetry its image continues the face. */
static PetscBool SingleIsEnd(const EndSearch *s, const PetscReal *row)
{
  const PetscInt      f     = (PetscInt)row[EDGE_FACE];
  const SurfaceImage *plane = PlaneOfEdge(s, f, (int)row[EDGE_NUMBER]);
  PetscReal           mirrored[3];

  if (!plane) return PETSC_TRUE;
  for (int d = 0; d < 3; d++) mirrored[d] = plane->sign[d] * row[EDGE_NORMAL + d];
  return TurnsAway(s, f, (int)row[EDGE_NUMBER], mirrored);
}

/* Marks the ends among the rows from `first` to `end` - 1, which are of one edge. Rows of other ranks only say how the
   surface goes on there. */
static void MarkEdge(const EndSearch *s, const PetscReal *first, const PetscReal *end)
{
  for (const PetscReal *row = first; row < end; row += EDGE_COLUMNS) {
    const PetscInt   f     = (PetscInt)row[EDGE_FACE];
    const int        edge  = (int)row[EDGE_NUMBER];
    const PetscReal *other = row == first ? first + EDGE_COLUMNS : first;
    PetscBool        at_end;

    if ((PetscMPIInt)row[EDGE_RANK] != s->rank) continue;
    at_end = other < end ? TurnsAway(s, f, edge, &other[EDGE_NORMAL]) : SingleIsEnd(s, row);
    if (at_end) s->surface->face_ends[f] |= 1 << edge;
  }
}

/* End of the rows that are of one edge. */
static const PetscReal *SameEdge(const PetscReal *first, const PetscReal *end)
{
  const PetscReal *row = first;

  while (row < end && !GatherTableCompare(first, row)) row += EDGE_COLUMNS;
  return row;
}

/* Marks edges that faces of this rank share, and keeps the rows of those that have one face here. */
static PetscInt MarkWithin(const EndSearch *s, PetscInt n, PetscReal *rows)
{
  const PetscReal *end  = rows + n * EDGE_COLUMNS;
  PetscInt         kept = 0;

  qsort(rows, (size_t)n, EDGE_COLUMNS * sizeof(PetscReal), GatherTableCompare);
  for (const PetscReal *row = rows, *next; row < end; row = next) {
    next = SameEdge(row, end);
    if (next > row + EDGE_COLUMNS)
      MarkEdge(s, row, next);
    else
      memmove(&rows[kept++ * EDGE_COLUMNS], row, EDGE_COLUMNS * sizeof(PetscReal));
  }
  return kept;
}

/*@
  SurfaceFindEnds - marks the edges (in 2D the ends) of faces at which a surface ends or turns away by more than an
  angle.

  Collective

  Input Parameters:
+ surface  - a surface of a deformable body
. angle    - the angle
. n_images - number of mirror images
- images   - of the pair; a face goes on beyond their planes as its image

  Output Parameter:
. surface - its face_ends are set; they are the same on any ranks

  Note:
  Faces turn away from each other where they enclose the body. In a corner that the body encloses there is no end: what
  comes near meets the faces first.
@*/
PetscErrorCode SurfaceFindEnds(ContactSurface surface, PetscReal angle, int n_images, const SurfaceImage *images)
{
  EndSearch   s = {surface, PetscCosReal(angle), n_images, images, 0};
  PetscReal  *rows;
  PetscInt    n = 0;
  GatherTable table;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(surface->mesh->comm, &s.rank));
  PetscCall(PetscCalloc1(surface->n_faces, &surface->face_ends));
  PetscCall(PetscMalloc1(surface->n_faces * 4 * EDGE_COLUMNS, &rows)); /* a quadrilateral has 4 edges */
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Element *e = ElementGet(surface->faces[f].type);

    for (int edge = 0; edge < (e->dim == 1 ? 2 : e->edges); edge++) FillRow(&s, f, edge, &rows[n++ * EDGE_COLUMNS]);
  }
  n = MarkWithin(&s, n, rows);
  PetscCall(GatherTableCreate(surface->mesh->comm, EDGE_COLUMNS, n, rows, &table));
  PetscCall(PetscFree(rows));
  for (const PetscReal *row = table.row, *end = table.row + table.n * EDGE_COLUMNS, *next; row < end; row = next) {
    next = SameEdge(row, end);
    MarkEdge(&s, row, next);
  }
  PetscCall(GatherTableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceFollowsEdges - says whether faces of a mesh bend around a right-angled edge that dents them, between their
  nodes.

  Not collective

  Input Parameters:
+ mesh     - the mesh
- geometry - of the scene

  Note:
  Those of second order do in plane strain and plane stress. A rubber pad under a rigid stamp (10 mm wide, 2 mm deep,
  faces of 0.5 mm) is too stiff by 2 % if its edges press, and by 7 % without; of first order by 5 % and 3 %. In space
  coarse faces of second order hold a key in a pad 9 % harder if the sides of its edges have terms of their own. An
  axisymmetric punch of steel (radius 5.2) on such a pad is off by 2 % with and without, and with them stops or ends in
  an unstable equilibrium.
@*/
PetscBool SurfaceFollowsEdges(Mesh mesh, Geometry geometry)
{
  return (PetscBool)(mesh->dim == 2 && mesh->order > 1 && geometry != GEOMETRY_AXISYMMETRIC);
}

/*@
  SurfaceEdgeLengths - sums up at nodes the lengths of the edges at which a surface turns away by more than an angle, in
  plane strain and plane stress, where an edge has the length 1.

  Collective

  Input Parameters:
+ surface  - a surface of a deformable body, with its free edges
. angle    - the angle
. n_images - number of mirror images
- images   - of the pair

  Output Parameters:
+ length - length[nodes of the mesh], the same on all ranks that have the node; of edges in planes of symmetry half
- n      - number of ends of faces that count, on all ranks

  Note:
  Edges at which the surface ends do not count.
@*/
PetscErrorCode SurfaceEdgeLengths(ContactSurface surface, PetscReal angle, int n_images, const SurfaceImage *images,
                                  PetscReal *length, PetscInt *n)
{
  const Mesh mesh = surface->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(length, mesh->n_nodes));
  PetscCall(SurfaceFindEnds(surface, angle, n_images, images));
  *n = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    for (int k = 0; k < 2; k++) {
      const PetscInt node = surface->faces[f].nodes[k];

      if (!((surface->face_ends[f] & ~surface->faces[f].free_edges) >> k & 1)) continue;
      length[node] += 0.5;
      (*n)++;
    }
  }
  PetscCall(PetscFree(surface->face_ends));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCall(MeshSumNodes(mesh, 1, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceRule - returns the quadrature rule of a face of a surface.

  Not collective

  Input Parameters:
+ surface - the surface
. face    - the face
- finer   - how fine the rule is, see FaceRuleGet()
@*/
const FaceRule *SurfaceRule(ContactSurface surface, PetscInt face, int finer)
{
  const ElementType type = surface->faces[face].type;

  return FaceRuleOf(type, finer, surface->face_ends ? surface->face_ends[face] : 0);
}
