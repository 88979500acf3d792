/* Points along the sharp convex edges of a rigid tool, see ridgepoints.h. */
#include "search/ridgepoints.h"
#include "search/surfaceends.h"
#include "base/vectors.h"

/* Points along an edge are as close as this part of a face of what they press on. */
#define RIDGE_SPACING 0.5

/* An edge of a face of the tool (an end in 2D) by its corners */
typedef struct {
  PetscInt low, high, face;
  int      edge;
} RidgeEdge;

/* What the edges of a tool are compared with */
typedef struct {
  ContactSurface      tool;
  PetscReal           size;   /* of the faces of the other surface (length) */
  PetscReal           cosine; /* of the angle by which the surface turns at least at an edge that counts */
  Geometry            geometry;
  int                 n_images;
  const SurfaceImage *images;
} RidgeSearch;

static int CompareEdges(const void *a, const void *b)
{
  const RidgeEdge *p = a, *q = b;

  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return p->face != q->face ? (p->face < q->face ? -1 : 1) : p->edge - q->edge;
}

/* Lists the edges of all faces, those with the same corners one after the other. */
static PetscErrorCode ListEdges(ContactSurface tool, PetscInt *n, RidgeEdge **edges)
{
  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(4 * tool->n_faces, edges)); /* a quadrilateral has 4 edges */
  for (PetscInt f = 0; f < tool->n_faces; f++) {
    const Facet   *facet = &tool->faces[f];
    const Element *e     = ElementGet(facet->type);

    for (int k = 0; k < (e->dim == 1 ? 2 : e->edges); k++) {
      const PetscInt a = facet->nodes[e->dim == 1 ? k : e->edge_corners[k][0]];
      const PetscInt b = facet->nodes[e->dim == 1 ? k : e->edge_corners[k][1]];

      (*edges)[(*n)++] = (RidgeEdge){PetscMin(a, b), PetscMax(a, b), f, k};
    }
  }
  if (*n) qsort(*edges, *n, sizeof(RidgeEdge), CompareEdges);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The plane of symmetry that holds an edge; NULL: none. The tip of a cone on the axis is no edge: it bears nothing, and
   elements that follow it are too stiff, by four times where they are as large as the dent. */
static const SurfaceImage *PlaneOf(const RidgeSearch *s, const RidgeEdge *edge)
{
  const Mesh       mesh = s->tool->mesh;
  const PetscReal *X    = s->tool->rigid->coords;

  for (int plane = 1; plane < s->n_images; plane <<= 1)
    if (!SurfaceImageBeyondAxis(&s->images[plane]) &&
        SurfaceOnPlane(mesh, &s->images[plane], &X[edge->low * mesh->dim]) &&
        SurfaceOnPlane(mesh, &s->images[plane], &X[edge->high * mesh->dim]))
      return &s->images[plane];
  return NULL;
}

/* Finds the unit normals of the two sides of a sharp convex edge, of which `count` faces are known; one that lies in a
   plane of symmetry has its other side beyond that. */
static PetscBool FindSides(const RidgeSearch *s, const RidgeEdge *edge, PetscInt count, PetscReal sides[6])
{
  const SurfaceImage *plane = count == 1 ? PlaneOf(s, edge) : NULL;
  PetscReal           out[3];

  if (count > 2 || (count == 1 && !plane)) return PETSC_FALSE;
  if (count == 2) SurfaceEdgeFrame(s->tool, &s->tool->faces[edge[1].face], edge[1].edge, &sides[3], out);
  SurfaceEdgeFrame(s->tool, &s->tool->faces[edge[0].face], edge[0].edge, sides, out);
  for (int d = 0; d < 3 && plane; d++) sides[3 + d] = plane->sign[d] * sides[d];
  return (PetscBool)(Dot(sides, &sides[3]) < s->cosine && Dot(out, &sides[3]) > 0);
}

/* Number of points along an edge of that length. */
static PetscInt PointsAlong(const RidgeSearch *s, PetscReal length)
{
  return s->tool->mesh->dim == 2 ? 1 : PetscMax(1, (PetscInt)PetscCeilReal(length / (RIDGE_SPACING * s->size)));
}

/* Length of an edge; 0 in 2D. */
static PetscReal EdgeLength(const RidgeSearch *s, const RidgeEdge *edge)
{
  const int        dim    = s->tool->mesh->dim;
  const PetscReal *X      = s->tool->rigid->coords;
  PetscReal        square = 0;

  for (int d = 0; d < dim; d++) square += PetscSqr(X[edge->high * dim + d] - X[edge->low * dim + d]);
  return PetscSqrtReal(square);
}

/* Area of a point: a face wide, along its part of the edge; half of that in a plane of symmetry. */
static PetscReal PointArea(const RidgeSearch *s, const RidgeEdge *edge, PetscReal length, const PetscReal *X)
{
  const PetscReal along = s->geometry == GEOMETRY_SOLID          ? length
                          : s->geometry == GEOMETRY_AXISYMMETRIC ? 2 * PETSC_PI * X[0]
                                                                 : 1;

  return (PlaneOf(s, edge) ? 0.5 : 1) * along * s->size;
}

/* Adds the points of an edge. */
static PetscErrorCode AddPoints(const RidgeSearch *s, const RidgeEdge *edge, const PetscReal sides[6],
                                RidgePoints *ridge)
{
  const int        dim    = s->tool->mesh->dim;
  const PetscReal *X      = s->tool->rigid->coords;
  const PetscReal  length = EdgeLength(s, edge);
  const PetscInt   n      = PointsAlong(s, length);

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((ridge->n + n) * sizeof(RidgePoint), &ridge->point));
  for (PetscInt i = 0; i < n; i++) {
    RidgePoint     *point = &ridge->point[ridge->n++];
    const PetscReal part  = ((PetscReal)i + 0.5) / (PetscReal)n;

    *point = (RidgePoint){.tag = s->tool->rigid->node_tag[edge->low]};
    for (int d = 0; d < dim; d++)
      point->X[d] = X[edge->low * dim + d] + part * (X[edge->high * dim + d] - X[edge->low * dim + d]);
    point->area = PointArea(s, edge, length / (PetscReal)n, point->X);
    PetscCall(PetscArraycpy(point->sides, sides, 6));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RidgeSurfaceCreate - makes a surface of the points along the sharp convex edges of a rigid tool.

  Not collective

  Input Parameters:
+ tool     - surface of the tool, with the normals that it has in contact
. other    - surface of deformable bodies that it meets, whose faces say how wide and how close the points are
. geometry - areas of axisymmetric points are over 360 degrees
. n_images - number of mirror images
- images   - of the pair of both

  Output Parameter:
. out - the surface, without faces, the same on all ranks; NULL where the tool has no such edge
@*/
PetscErrorCode RidgeSurfaceCreate(ContactSurface tool, ContactSurface other, Geometry geometry, int n_images,
                                  const SurfaceImage *images, ContactSurface *out)
{
  const PetscReal   cosine = SurfaceFollowsEdges(tool->mesh, geometry) ? PetscCosReal(SURFACE_SQUARE) : VECTORS_WEDGE;
  const RidgeSearch s      = {tool, other->mean_size, cosine, geometry, n_images, images};
  RidgePoints       ridge  = {.n = 0};
  RidgeEdge        *edges;
  PetscInt          n;

  PetscFunctionBeginUser;
  *out = NULL;
  PetscCall(ListEdges(tool, &n, &edges));
  for (PetscInt i = 0, count; i < n; i += count) {
    PetscReal sides[6];

    for (count = 1; i + count < n && edges[i + count].low == edges[i].low && edges[i + count].high == edges[i].high;)
      count++;
    if (FindSides(&s, &edges[i], count, sides)) PetscCall(AddPoints(&s, &edges[i], sides, &ridge));
  }
  PetscCall(PetscFree(edges));
  if (!ridge.n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(out));
  **out = (struct _n_ContactSurface){.mesh       = tool->mesh,
                                     .rigid      = tool->rigid,
                                     .body       = tool->body,
                                     .order      = 1,
                                     .mean_size  = other->mean_size,
                                     .max_size   = other->max_size,
                                     .max_extent = other->max_extent,
                                     .ridge      = ridge};
  PetscFunctionReturn(PETSC_SUCCESS);
}
