/* Facets that face a slave point, where they end, and how far the point takes part, see flank.h. */
#include "flank.h"
#include "base/smoothstep.h"

/* A facet is below the plane of its neighbour if its centre is, by this part of the slave's face size. */
#define FLANK_BELOW 1e-6

/* An edge that two facets share, as seen from one of them. */
typedef struct {
  int       edge;
  PetscInt  nodes[2]; /* points; in 2D the same one twice */
  PetscBool convex;   /* the other facet lies below the plane of this one */
} FlankEdge;

/* Positions of a facet's nodes relative to the slave point. */
static void RelativePositions(const Nearest *look, const Candidate *c, PetscReal *x)
{
  const int dim = look->lists->dim;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    NeighbourListsRelative(look->lists, look->q, c->facet.nodes[a], &x[a * dim]);
}

static PetscReal CandidateDistance(const Nearest *look, const Candidate *c)
{
  PetscReal x[FACE_MAX_NODES * 3];
  Facet     own = c->facet;
  Foot      foot;

  RelativePositions(look, c, x);
  own.free_edges = 0;
  for (int a = 0; a < ElementGet(own.type)->nodes; a++) own.nodes[a] = a;
  FacetProject(look->lists->dim, &own, x, &foot);
  return PetscAbsReal(foot.gap);
}

static PetscBool HasNode(const Candidate *c, PetscInt node)
{
  for (int a = 0; a < ElementGet(c->facet.type)->corners; a++)
    if (c->facet.nodes[a] == node) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Finds the edge of c that it shares with o. */
static PetscBool SharedEdge(const Nearest *look, const Candidate *c, const Candidate *o, FlankEdge *shared)
{
  const Element *e   = ElementGet(c->facet.type);
  const int      dim = look->lists->dim;

  for (int k = 0; k < (e->dim == 1 ? 2 : e->edges); k++) {
    const PetscInt a = c->facet.nodes[e->dim == 1 ? k : e->edge_corners[k][0]],
                   b = c->facet.nodes[e->dim == 1 ? k : e->edge_corners[k][1]];
    PetscReal height = 0;

    if (!HasNode(o, a) || !HasNode(o, b)) continue;
    for (int d = 0; d < dim; d++)
      height += c->normal[d] * (o->centre[d] - look->lists->point_X[a * dim + d] - look->lists->point_u[a * dim + d]);
    *shared = (FlankEdge){k, {a, b}, (PetscBool)(height < -FLANK_BELOW * look->size)};
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Distance of the slave point's foot to an edge. */
static PetscReal FootToEdge(const Nearest *look, const FlankEdge *edge)
{
  const int dim = look->lists->dim;
  PetscReal a[3], b[3], along = 0, length = 0, square = 0;

  NeighbourListsRelative(look->lists, look->q, edge->nodes[0], a);
  NeighbourListsRelative(look->lists, look->q, edge->nodes[1], b);
  for (int d = 0; d < dim; d++) {
    along += (-look->foot.gap * look->foot.normal[d] - a[d]) * (b[d] - a[d]);
    length += PetscSqr(b[d] - a[d]);
  }
  along = length > 0 ? PetscClipInterval(along / length, 0, 1) : 0;
  for (int d = 0; d < dim; d++)
    square += PetscSqr(-look->foot.gap * look->foot.normal[d] - a[d] - along * (b[d] - a[d]));
  return PetscSqrtReal(square);
}

/* How far the slave point is beside its foot, along the nearest facet. */
static PetscReal BesideFoot(const Nearest *look)
{
  const PetscReal *n     = look->candidates[look->best].normal;
  PetscReal        along = 0, square = 0;

  for (int d = 0; d < look->lists->dim; d++) along += look->foot.normal[d] * n[d];
  for (int d = 0; d < look->lists->dim; d++) square += PetscSqr(look->foot.normal[d] - along * n[d]);
  return PetscAbsReal(look->foot.gap) * PetscSqrtReal(square);
}

/*@
  FlankFaces - says whether a candidate's normal opposes that of the slave point.

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate
@*/
PetscBool FlankFaces(const Nearest *look, const Candidate *c)
{
  return (PetscBool)(NeighbourListsOpposed(look->lists, look->q, c->normal) > 0);
}

/*@
  FlankIsOwn - says whether a candidate shares a node with the slave point's own face; it is then not its master.

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate
@*/
PetscBool FlankIsOwn(const Nearest *look, const Candidate *c)
{
  const NeighbourLists lists = look->lists;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (PetscInt k = 0; k < look->own; k++)
      if (lists->point_node[lists->point_ptr[c->facet.nodes[a]]] == lists->slave_node[lists->slave_ptr[look->q] + k])
        return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  FlankSort - drops the facets that share a node with the slave point's own face, and puts those that face the point
  before the others.

  Not collective

  Input Parameter:
. look - the slave point

  Input/Output Parameters:
+ n     - number of facets
- found - their numbers; those that face the point keep their order

  Note:
  Returns how many of them face the point.
@*/
int FlankSort(const Nearest *look, int *n, int *found)
{
  int facing = 0, kept = 0;

  for (int i = 0; i < *n; i++)
    if (!FlankIsOwn(look, &look->candidates[found[i]])) found[kept++] = found[i];
  *n = kept;
  for (int i = 0; i < kept; i++) {
    const int c = found[i];

    if (!FlankFaces(look, &look->candidates[c])) continue;
    found[i]        = found[facing];
    found[facing++] = c;
  }
  return facing;
}

/* Marks the edges at which facets that face the slave point meet others, and returns the distance of the foot to the
   nearest convex one of them; PETSC_MAX_REAL: there is none. */
static PetscReal MarkEnds(const Nearest *look, int facing, int n, const int *found, int *ends)
{
  PetscReal least = PETSC_MAX_REAL;

  for (int i = 0; i < facing; i++) {
    for (int k = facing; k < n; k++) {
      FlankEdge edge;

      if (!SharedEdge(look, &look->candidates[found[i]], &look->candidates[found[k]], &edge)) continue;
      ends[i] |= 1 << edge.edge;
      if (edge.convex) least = PetscMin(least, FootToEdge(look, &edge));
    }
  }
  return least;
}

/* How well the surface at the foot opposes the slave point. The nearest facet says it. Near its edges a neighbour may
   say more, which fades out with the distance to that neighbour, so that the answer does not jump from facet to
   facet. */
static PetscReal FootOpposed(const Nearest *look, int facing, const int *found)
{
  PetscReal opposed = NeighbourListsOpposed(look->lists, look->q, look->candidates[look->best].normal);

  for (int i = 0; i < facing && opposed < 1; i++) {
    const Candidate *c   = &look->candidates[found[i]];
    const PetscReal  own = NeighbourListsOpposed(look->lists, look->q, c->normal);

    if (own > opposed)
      opposed = PetscMax(opposed, own * (1 - SmoothStep((CandidateDistance(look, c) - look->distance) / look->size)));
  }
  return opposed;
}

/*@
  FlankShare - finds the ends of the flank, and the part of the slave point's area that takes part in contact with it.

  Not collective

  Input Parameters:
+ look   - the slave point with its nearest facet and foot
. facing - number of facets that face the point
. n      - number of facets
- found  - their numbers, as FlankSort() left them

  Output Parameter:
. ends - ends[facing]: for each facet that faces the point the edges at which the flank ends, as bits like free_edges

  Note:
  Returns 1 where the normals oppose each other and no convex end is near.
@*/
PetscReal FlankShare(const Nearest *look, int facing, int n, const int *found, int *ends)
{
  const PetscReal opposed = FootOpposed(look, facing, found);
  PetscReal       inside;

  for (int i = 0; i < facing; i++) ends[i] = 0;
  if (n == facing) return opposed;
  inside = MarkEnds(look, facing, n, found, ends);
  if (inside > 0.5 * look->size) return opposed;
  return opposed *
         (1 - SmoothStep((inside > FACET_COINCIDENT * look->size ? -inside : BesideFoot(look)) / look->size + 0.5));
}

/*@
  FlankNearRidge - says whether the slave point's foot is within half a face of a sharp convex edge whose two facets
both face the point.

  Not collective

  Input Parameters:
+ look           - the slave point with its nearest facet and foot
. neighbourhoods - know the sharp edges
. facing         - number of facets that face the point
- found          - their numbers

  Note:
  A fit knows one side of such an edge only. The facets know both, and the normal turns from one side to the other.
@*/
PetscBool FlankNearRidge(const Nearest *look, Neighbourhoods neighbourhoods, int facing, const int *found)
{
  for (int i = 0; i < facing; i++) {
    if (!NeighbourhoodsIsSharp(neighbourhoods, found[i])) continue;
    for (int k = 0; k < facing; k++) {
      FlankEdge edge;

      if (k == i || !NeighbourhoodsIsSharp(neighbourhoods, found[k])) continue;
      if (!SharedEdge(look, &look->candidates[found[i]], &look->candidates[found[k]], &edge)) continue;
      if (edge.convex && NeighbourhoodsMeetSharply(neighbourhoods, found[i], found[k]) &&
          FootToEdge(look, &edge) <= 0.5 * look->size)
        return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}
