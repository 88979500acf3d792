/* Facets that face a slave point, where they end, and how far the point takes part, see flank.h. */
#include "flank.h"
#include "ownbody.h"
#include "base/smoothstep.h"
#include "base/vectors.h"

/* A facet is below the plane of its neighbour if its centre is, by this part of the slave's face size. */
#define FLANK_BELOW 1e-6

/* Nodes of a slave's face count as farthest past an edge within this part of its size, and a slave that reaches so far
   past the end of its master ends there: bodies of one length deform by less. */
#define FLANK_FARTHEST 0.1

/* So far past an end, in faces of the slave, another facet is looked for on which the surface goes on. */
#define FLANK_SEAM 0.05

/* A slave point lies on a flank of an edge of its master up to this part of feature_angle between their normals. From
   feature_angle on it does not: the edge stands on the slave. */
#define FLANK_LIES 0.67

/* An edge that two facets share, as seen from one of them. */
typedef struct {
  int       edge;
  PetscInt  nodes[2]; /* points; in 2D the same one twice */
  PetscBool convex;   /* the other facet lies below the plane of this one */
} FlankEdge;

/* Projects a place, relative to the slave point, onto a facet, and returns the distance. */
static PetscReal PlaceFoot(const Nearest *look, const Candidate *c, const PetscReal place[3], Foot *foot)
{
  const int dim = look->lists->dim;
  PetscReal x[FACE_MAX_NODES * 3];
  Facet     facet = c->facet;

  facet.free_edges = 0;
  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    NeighbourListsRelative(look->lists, look->q, facet.nodes[a], &x[a * dim]);
    for (int d = 0; d < dim; d++) x[a * dim + d] -= place[d];
    facet.nodes[a] = a;
  }
  FacetProject(dim, &facet, x, foot);
  return PetscAbsReal(foot->gap);
}

/*@
  FlankFoot - projects the slave point onto a facet without its free edges, and returns the distance (length).

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the facet

  Output Parameter:
. foot - the foot
@*/
PetscReal FlankFoot(const Nearest *look, const Candidate *c, Foot *foot)
{
  const PetscReal here[3] = {0, 0, 0};

  return PlaceFoot(look, c, here, foot);
}

/* Distance of the slave point to a facet. */
static PetscReal CandidateDistance(const Nearest *look, const Candidate *c)
{
  Foot foot;

  return FlankFoot(look, c, &foot);
}

static PetscBool HasNode(const Candidate *c, int corners, PetscInt node)
{
  for (int a = 0; a < corners; a++)
    if (c->facet.nodes[a] == node) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Do two facets have a corner in common? */
static PetscBool SharesCorner(const Candidate *c, const Candidate *o)
{
  for (int a = 0; a < ElementGet(c->facet.type)->corners; a++)
    if (HasNode(o, ElementGet(o->facet.type)->corners, c->facet.nodes[a])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Says whether the boxes of two facets are apart: they share nothing then. */
static PetscBool AreApart(const Nearest *look, const Candidate *c, const Candidate *o)
{
  for (int d = 0; d < look->lists->dim; d++)
    if (c->lower[d] - o->upper[d] > look->tie || o->lower[d] - c->upper[d] > look->tie) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Corners of an edge of a facet; in 2D of an end, twice. */
static void EdgeCorners(const Facet *facet, int edge, PetscInt nodes[2])
{
  const Element *e = ElementGet(facet->type);

  for (int k = 0; k < 2; k++) nodes[k] = facet->nodes[e->dim == 1 ? edge : e->edge_corners[edge][k]];
}

/* Number of edges of a facet, or of its ends in 2D. */
static int EdgeCount(const Facet *facet)
{
  const Element *e = ElementGet(facet->type);

  return e->dim == 1 ? 2 : e->edges;
}

/* Does c share an edge of its with o? */
static PetscBool SharesEdge(const Nearest *look, const Candidate *c, const Candidate *o, int edge, FlankEdge *shared)
{
  const int dim     = look->lists->dim;
  const int corners = ElementGet(o->facet.type)->corners;
  PetscInt  nodes[2];
  PetscReal height = 0;

  EdgeCorners(&c->facet, edge, nodes);
  if (!HasNode(o, corners, nodes[0]) || !HasNode(o, corners, nodes[1])) return PETSC_FALSE;
  for (int d = 0; d < dim; d++)
    height += c->normal[d] *
              (o->centre[d] - look->lists->point_X[nodes[0] * dim + d] - look->lists->point_u[nodes[0] * dim + d]);
  *shared = (FlankEdge){edge, {nodes[0], nodes[1]}, (PetscBool)(height < -FLANK_BELOW * look->size)};
  return PETSC_TRUE;
}

/* Finds the edge of c that it shares with o. */
static PetscBool SharedEdge(const Nearest *look, const Candidate *c, const Candidate *o, FlankEdge *shared)
{
  if (AreApart(look, c, o)) return PETSC_FALSE;
  for (int k = 0; k < EdgeCount(&c->facet); k++)
    if (SharesEdge(look, c, o, k, shared)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Distance of the slave point's foot to an edge; place: the point of the edge, relative to the slave point. */
static PetscReal FootToEdge(const Nearest *look, const FlankEdge *edge, PetscReal place[3])
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
  for (int d = 0; d < dim; d++) {
    place[d] = a[d] + along * (b[d] - a[d]);
    square += PetscSqr(-look->foot.gap * look->foot.normal[d] - place[d]);
  }
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

/* Least cosine between the mean normals of the slave at the nodes of the point's own face, reversed, and a facet's; 1
   where there are none. */
static PetscReal MeanOpposing(const Nearest *look, const PetscReal normal[3])
{
  const SlavePoints slaves = look->slaves;
  PetscReal         least  = 1;

  if (!look->listed || look->one_body || !slaves->face_sf || !slaves->normal) return least;
  for (PetscInt k = slaves->ptr[look->q]; k < slaves->ptr[look->q + 1]; k++) {
    const PetscReal *mean   = &slaves->normal[3 * slaves->node[k]];
    const PetscReal  length = PetscSqrtReal(Dot(mean, mean));

    if (length > 0) least = PetscMin(least, -Dot(mean, normal) / length);
  }
  return least;
}

/*@
  FlankFaces - says whether a candidate's normal opposes that of the slave point.

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate

  Note:
  Where any side of the bodies may meet any other one and the normals hardly oppose each other, the mean normals of the
  slave must, too. Coarse faces of a pin are tilted along it, and face the end of the bore that it stands out of.
@*/
PetscBool FlankFaces(const Nearest *look, const Candidate *c)
{
  const PetscReal opposed = NeighbourListsOpposed(look->lists, look->q, c->normal);

  return (PetscBool)(opposed > 0 && (opposed >= 1 || MeanOpposing(look, c->normal) > SEARCH_OPPOSED_NOT));
}

/*@
  FlankIsOwn - says whether a candidate is the slave point's own face, or the point is a node of it; it is then not its
  master.

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate

  Note:
  A neighbour of a point's face may be its master where the surface is folded between the two, so that they face each
  other. Points of the two faces near their common edge then are nearly in contact, whatever the angle of the fold. The
  sides of a sharp edge face each other through the body and are no partners.
@*/
PetscBool FlankIsOwn(const Nearest *look, const Candidate *c)
{
  const NeighbourLists lists  = look->lists;
  const int            nodes  = ElementGet(c->facet.type)->nodes;
  PetscInt             shared = 0;

  for (int a = 0; a < nodes; a++) {
    const PetscInt p = c->facet.nodes[a];

    if (look->one_body && lists->point_image[p]) continue; /* the mirror image of a body is another body */
    for (PetscInt k = 0; k < look->own; k++)
      shared += lists->point_node[lists->point_ptr[p]] == lists->slave_node[lists->slave_ptr[look->q] + k];
  }
  if (shared == look->own) return PETSC_TRUE;
  return (PetscBool)(shared > 0 && (!FlankFaces(look, c) || OwnBodyIsWedge(look, c)));
}

/* Is a facet behind the slave point, beyond or beside its own body? Only facets that face the point can be taken for
 * partners. */
static PetscBool IsHidden(const Nearest *look, const Candidate *c)
{
  PetscBool hidden;
  Foot      foot;

  if (!look->listed || !FlankFaces(look, c)) return PETSC_FALSE;
  if (OwnBodyTells(look, c, &hidden)) return hidden;
  FlankFoot(look, c, &foot);
  return (PetscBool)(OwnBodyHides(look, c, &foot) || (look->one_body && OwnBodyTurnsFrom(look, c, &foot)));
}

/*@
  FlankSort - drops the facets that share a node with the slave point's own face or that its own body hides, and puts
  those that face the point before the others.

  Not collective

  Input Parameter:
. look - the slave point

  Input/Output Parameters:
+ n     - number of facets
- found - their numbers; those that face the point keep their order, and those that were dropped follow at the end

  Output Parameter:
. dropped - number of those

  Note:
  Returns how many of them face the point.
@*/
int FlankSort(const Nearest *look, int *n, int *found, int *dropped)
{
  int facing = 0, kept = 0;

  for (int i = 0; i < *n; i++) {
    const int c = found[i];

    if (FlankIsOwn(look, &look->candidates[c]) || IsHidden(look, &look->candidates[c])) continue;
    found[i]      = found[kept];
    found[kept++] = c;
  }
  *dropped = *n - kept;
  *n       = kept;
  for (int i = 0; i < kept; i++) {
    const int c = found[i];

    if (!FlankFaces(look, &look->candidates[c])) continue;
    found[i]        = found[facing];
    found[facing++] = c;
  }
  return facing;
}

/* Do two facets form a hollow, each with its centre in front of the plane of the other one, as seen across the nearest
   one along the normal of the slave point? A wall that bends along itself is hollow, too, but leads to no better facet:
   only what lies in the plane of that normal and that of the nearest facet counts. */
static PetscBool FormHollow(const Nearest *look, const Candidate *nearest, const Candidate *c)
{
  const int        dim       = look->lists->dim;
  const PetscReal *own       = look->outward;
  PetscReal        across[3] = {0, 0, 0}, way[3] = {0, 0, 0}, along = 0, part[2] = {0, 0}, length = 0;
  PetscReal        height[2] = {0, 0};

  for (int d = 0; d < dim; d++) along += nearest->normal[d] * own[d];
  for (int d = 0; d < dim; d++) across[d] = nearest->normal[d] - along * own[d];
  for (int d = 0; d < dim; d++) length += PetscSqr(across[d]);
  for (int d = 0; d < dim; d++) {
    way[d] = c->centre[d] - nearest->centre[d];
    part[0] += way[d] * own[d];
    part[1] += way[d] * across[d] / (length > 0 ? length : 1);
  }
  for (int d = 0; d < dim; d++) {
    const PetscReal there = part[0] * own[d] + part[1] * across[d];

    height[0] += nearest->normal[d] * there;
    height[1] -= c->normal[d] * there;
  }
  return (PetscBool)(PetscMin(height[0], height[1]) > FLANK_BELOW * look->size);
}

/*@
  FlankPastEnd - says whether the slave point is past an end of another body's flank: its foot is on an edge of the
  nearest facet, and a facet at that one which is hidden or turned away is nearer.

  Not collective

  Input Parameters:
+ look  - the slave point with its nearest facet and foot
. n     - number of facets, with those that were dropped
- found - their numbers

  Note:
  The flank ends at the facet that is left out. At the next one the foot would be on that edge still, which is no end of
  it, and the gap the distance along the end of the flank.
@*/
PetscBool FlankPastEnd(const Nearest *look, int n, const int *found)
{
  const Candidate *nearest = &look->candidates[look->best];

  if (!look->listed || look->one_body || look->foot.region == FOOT_INTERIOR) return PETSC_FALSE;
  for (int i = 0; i < n; i++) {
    const Candidate *c = &look->candidates[found[i]];

    if (c == nearest || !SharesCorner(nearest, c) || !FlankFaces(look, c)) continue;
    if (CandidateDistance(look, c) < look->distance - look->tie) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/*@
  FlankLeaveCorner - finds a better facet where the nearest one hardly opposes the slave point and forms a hollow with
  another one that does.

  Not collective

  Input Parameters:
+ look   - the slave point with its nearest facet and foot
. facing - number of facets that face the point
- found  - their numbers

  Note:
  In the corner of a groove, points of a wall are next to the floor. Where the floor dents it faces them a little, and
  would take them from the wall and give them back. A facet counts as farther away by the part of a face of the slave
  that it does not oppose.
@*/
void FlankLeaveCorner(Nearest *look, int facing, const int *found)
{
  const Candidate *nearest = &look->candidates[look->best];
  const PetscReal  opposed = NeighbourListsOpposed(look->lists, look->q, nearest->normal);
  PetscReal        least   = look->distance + look->size * (1 - opposed);

  for (int i = 0; i < facing && opposed < 1; i++) {
    const Candidate *c = &look->candidates[found[i]];
    PetscReal        away, distance, rank;
    Foot             foot;

    if (!FormHollow(look, nearest, c)) continue;
    away = look->size * (1 - NeighbourListsOpposed(look->lists, look->q, c->normal));
    if (CandidateBoxDistance(look->lists->dim, c, look->x) + away > least + look->tie) continue;
    distance = FlankFoot(look, c, &foot);
    rank     = distance + away;
    if (rank >= least - look->tie) continue;
    least          = rank;
    look->best     = found[i];
    look->distance = distance;
    look->foot     = foot;
  }
}

/* How far the slave point is behind the plane of a facet at one of its edges; 0 in front of it. */
static PetscReal DepthAtEdge(const Nearest *look, const Candidate *c, const FlankEdge *edge)
{
  PetscReal a[3], depth = 0;

  NeighbourListsRelative(look->lists, look->q, edge->nodes[0], a);
  for (int d = 0; d < look->lists->dim; d++) depth += c->normal[d] * a[d];
  return PetscMax(0, depth);
}

/* How far the slave turns with the master towards a facet that the slave point does not face: 1 where the mean normal
   of the slave at a node of the point's own face opposes that facet. */
static PetscReal SlaveTurns(const Nearest *look, const PetscReal normal[3])
{
  const SlavePoints slaves = look->slaves;
  PetscReal         turns  = 0;

  for (PetscInt k = slaves->ptr[look->q]; slaves->normal && k < slaves->ptr[look->q + 1]; k++)
    turns = PetscMax(turns, NeighbourListsOpposing(&slaves->normal[3 * slaves->node[k]], normal));
  return turns;
}

/* Part of a slave point's area that takes part at an end of facet c, fading over a width (length), half of it on either
   side of the edge. Past the edge, a point that is deeper than NEIGHBOUR_LISTS_DEEP is in front of another side of the
   master, not behind this one. turns: 1 where the slave turns with the master, so that its next face meets the side
   beyond the edge, and nothing of this one's area is left out inside. */
static PetscReal EndShare(const Nearest *look, const Candidate *c, const FlankEdge *edge, PetscReal width,
                          PetscReal turns)
{
  PetscReal       at[3], place;
  const PetscReal inside = FootToEdge(look, edge, at);
  const PetscReal past   = inside > FACET_COINCIDENT * look->size ? -inside : BesideFoot(look);

  if (2 * PetscAbsReal(past) >= width) return past > 0 ? 0 : 1;
  place = past / width + 0.5;
  place += turns * (PetscMax(0, 2 * place - 1) - place);
  return (1 - SmoothStep(place)) *
         (1 - SmoothStep(2 * place) * SmoothStep(DepthAtEdge(look, c, edge) / (NEIGHBOUR_LISTS_DEEP * look->size)));
}

/* The same where the flank ends at a convex edge, beyond which there is a facet that the point does not face. The width
   over which it fades shrinks as the point turns towards that facet, because then the plane beyond the edge lies in
   front of the master. */
static PetscReal ConvexShare(const Nearest *look, const Candidate *c, const Candidate *beyond, const FlankEdge *edge)
{
  const PetscReal mean = MeanOpposing(look, beyond->normal);
  const PetscReal averse =
    PetscMax(NeighbourListsAverse(look->lists, look->q, beyond->normal), 1 - SmoothStep(mean / SEARCH_OPPOSED_NOT));

  return EndShare(look, c, edge, look->size * averse, SlaveTurns(look, beyond->normal));
}

/* The way out of facet c across one of its edges, in its plane, of length 1. */
static void WayOut(const Nearest *look, const Candidate *c, const FlankEdge *edge, PetscReal out[3])
{
  const NeighbourLists lists    = look->lists;
  const int            dim      = lists->dim;
  PetscReal            along[3] = {0, 0, 0}, square = 0, part = 0, height = 0, length = 0;

  for (int d = 0; d < 3; d++) out[d] = 0;
  for (int d = 0; d < dim; d++) {
    const PetscInt  a = edge->nodes[0] * dim + d, b = edge->nodes[1] * dim + d;
    const PetscReal at = lists->point_X[a] + lists->point_u[a];

    out[d]   = at - c->centre[d];
    along[d] = lists->point_X[b] + lists->point_u[b] - at;
    square += PetscSqr(along[d]);
    part += along[d] * out[d];
    height += c->normal[d] * out[d];
  }
  for (int d = 0; d < dim; d++) out[d] -= (square > 0 ? part / square : 0) * along[d] + height * c->normal[d];
  for (int d = 0; d < dim; d++) length += PetscSqr(out[d]);
  for (int d = 0; d < dim && length > 0; d++) out[d] /= PetscSqrtReal(length);
}

/* How far the slave reaches past an edge of the master, the way out of it, around the point's own face: 0 where it ends
   close to that edge or before, 1 where it covers the width of the fading. It goes on at a node, or it ends there
   across that way. */
static PetscReal SlaveOverhangs(const Nearest *look, const FlankEdge *edge, const PetscReal out[3])
{
  const NeighbourLists lists  = look->lists;
  const SlavePoints    slaves = look->slaves;
  const int            dim    = lists->dim;
  const PetscInt       first = slaves->ptr[look->q], end = slaves->ptr[look->q + 1], a = edge->nodes[0] * dim;
  PetscReal            farthest = PETSC_MIN_REAL, goes_on = 0;

  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt k = first; k < end; k++) {
      const PetscInt i    = slaves->node[k];
      PetscReal      past = 0, way = 0, length = 0;

      for (int d = 0; d < dim; d++) {
        past +=
          (slaves->nodes[i].X[d] - lists->point_X[a + d] + slaves->u[i * dim + d] - lists->point_u[a + d]) * out[d];
        way += slaves->end[i * dim + d] * out[d];
        length += PetscSqr(slaves->end[i * dim + d]);
      }
      if (!pass) farthest = PetscMax(farthest, past);
      if (pass && past >= farthest - FLANK_FARTHEST * look->size)
        goes_on = PetscMax(goes_on, 1 - (length > 0 ? SmoothStep(2 * way / PetscSqrtReal(length)) : 0));
    }
  }
  return SmoothStep((farthest / look->size + goes_on - FLANK_FARTHEST) / (0.5 - FLANK_FARTHEST));
}

/* Whether the master goes on past an edge, the way out of it, on another facet that faces the point, as where two
   bodies lie side by side and share no nodes: 1 if it does. */
static PetscReal MasterGoesOn(const Nearest *look, const Candidate *c, const FlankEdge *edge, const PetscReal out[3],
                              int facing, const int *found)
{
  const PetscReal step = FLANK_SEAM * look->size;
  const int       dim  = look->lists->dim;
  PetscReal       place[3], at[3], least = step;
  Foot            foot;

  FootToEdge(look, edge, place);
  for (int d = 0; d < dim; d++) {
    place[d] += step * out[d];
    at[d] = look->x[d] + place[d];
  }
  for (int i = 0; i < facing; i++) {
    const Candidate *other = &look->candidates[found[i]];

    if (other != c && CandidateBoxDistance(dim, other, at) <= step + look->tie)
      least = PetscMin(least, PlaceFoot(look, other, place, &foot));
  }
  return 1 - SmoothStep(2 * least / step);
}

/* Part of a slave point's area that takes part where the master's surface ends at an edge of facet c and the slave
   reaches past it. A slave that ends there too keeps all its area. */
static PetscReal FreeShare(const Nearest *look, const Candidate *c, int facing, const int *found)
{
  const Element *e     = ElementGet(c->facet.type);
  PetscReal      share = 1;

  for (int k = 0; k < (e->dim == 1 ? 2 : e->edges); k++) {
    const FlankEdge edge = {k,
                            {c->facet.nodes[e->dim == 1 ? k : e->edge_corners[k][0]],
                             c->facet.nodes[e->dim == 1 ? k : e->edge_corners[k][1]]},
                            PETSC_TRUE};
    PetscReal       out[3], part;

    if (!(c->facet.free_edges >> k & 1)) continue;
    WayOut(look, c, &edge, out);
    part = 1 - EndShare(look, c, &edge, look->size, SlaveTurns(look, out));
    if (part > 0) part *= SlaveOverhangs(look, &edge, out);
    if (part > 0) part *= 1 - MasterGoesOn(look, c, &edge, out, facing, found);
    share = PetscMin(share, 1 - part);
  }
  return share;
}

/* Part of a slave point's area that takes part where the point is far behind the flank that it faces. A side of the
   master that is square to the point and much nearer says that the point is beside that side, and that it is not this
   flank which it came through. The far side of a thin body says nothing. */
static PetscReal DeepShare(const Nearest *look, int facing, int n, const int *found)
{
  const PetscReal depth = look->foot.gap < 0 ? look->distance : 0;
  PetscReal       side  = depth;

  if (depth <= NEIGHBOUR_LISTS_DEEP * look->size) return 1;
  for (int k = facing; k < n; k++)
    if (NeighbourListsSquare(look->lists, look->q, look->candidates[found[k]].normal))
      side = PetscMin(side, CandidateDistance(look, &look->candidates[found[k]]));
  return 1 - SmoothStep(depth / (NEIGHBOUR_LISTS_DEEP * look->size) - 1) * (1 - SmoothStep(2 * side / depth - 1));
}

/* Cosine of the angle between the slave's reversed normal and a facet's. */
static PetscReal Opposing(const Nearest *look, const Candidate *c)
{
  PetscReal cosine = 0;

  for (int d = 0; d < look->lists->dim; d++) cosine -= look->outward[d] * c->normal[d];
  return cosine;
}

/* Is the slave point's foot within half a face of a sharp convex edge between two facets that both face it? 1 where it
   is; fades up to a whole face. */
static PetscReal NearEdge(const Nearest *look, const Candidate *c, const Candidate *o)
{
  PetscReal place[3];
  FlankEdge edge;

  if (!SharedEdge(look, c, o, &edge) || !edge.convex) return 0;
  return 1 - SmoothStep(2 * FootToEdge(look, &edge, place) / look->size - 1);
}

/* Is the slave point's foot within half a face of a sharp convex edge between any two of the facets that face it? 1
   where it is; fades up to a whole face, so that facets farther away need not be looked at. */
static PetscReal NearRidge(const Nearest *look, int facing, const int *found)
{
  const int       dim   = look->lists->dim;
  const PetscReal sharp = PetscCosReal(look->sharp);
  PetscReal       foot[3], near = 0;

  for (int d = 0; d < dim; d++) foot[d] = look->x[d] - look->foot.gap * look->foot.normal[d];
  for (int i = 0; i < facing; i++) {
    const Candidate *c = &look->candidates[found[i]];

    if (CandidateBoxDistance(dim, c, foot) > look->size) continue;
    for (int k = 0; k < i; k++) {
      const Candidate *o = &look->candidates[found[k]];

      if (Dot(c->normal, o->normal) < sharp) near = PetscMax(near, NearEdge(look, c, o));
    }
  }
  return near;
}

/* How far a side of an edge stands off a surface by the cosine between their normals, opposed: 0 where it lies on it, 1
   where it stands. */
static PetscReal StandsOff(const Nearest *look, PetscReal cosine)
{
  const PetscReal stands = PetscCosReal(look->sharp), lies = PetscCosReal(FLANK_LIES * look->sharp);

  return SmoothStep((lies - cosine) / (lies - stands));
}

/* Part of a slave point's area that takes part beside a sharp edge of the master, where both sides are slaves. A point
   behind the edge whose foot is on a flank that does not lie on the slave would be pressed out along that flank, square
   to the slave, with any force. The edge's own terms hold the slave there. */
static PetscReal RidgeShare(const Nearest *look, int facing, const int *found)
{
  PetscReal off;

  if (!look->two_sided) return 1;
  off = StandsOff(look, Opposing(look, &look->candidates[look->best]));
  if (off == 0) return 1;
  return 1 - off * NearRidge(look, facing, found);
}

/* Part of a point on a sharp edge of a tool that presses: 1 where no side of the edge lies on the master there, and at
   right-angled edges, which press from a depth on. */
static PetscReal EdgeShare(const Nearest *look)
{
  const PetscReal *sides = look->slaves->sides ? &look->slaves->sides[6 * look->q] : NULL;
  PetscReal        share = 1;

  if (!sides || Dot(sides, &sides[3]) >= VECTORS_WEDGE) return 1;
  for (int k = 0; k < 2; k++) share = PetscMin(share, StandsOff(look, -Dot(&sides[3 * k], look->normal)));
  return share;
}

/* Sorts n facets, at which others may end, by their corners. */
static void SortByCorners(const Nearest *look, int n, const int *facets)
{
  FacetsAt *at = look->at;

  at->n = 0;
  at->sorted++;
  for (int k = 0; k < n; k++) {
    const Facet *facet = &look->candidates[facets[k]].facet;

    for (int a = 0; a < ElementGet(facet->type)->corners; a++) {
      const PetscInt p = facet->nodes[a];

      at->entry[at->n] = (FacetAt){facets[k], at->latest[p] == at->sorted ? at->first[p] : -1};
      at->latest[p]    = at->sorted;
      at->first[p]     = at->n++;
    }
  }
}

/* The first facet of those that may share an edge with c: it has the edge's first corner. -1: there is none. */
static PetscInt FirstAt(const Nearest *look, const Candidate *c, int edge)
{
  PetscInt nodes[2];

  EdgeCorners(&c->facet, edge, nodes);
  return look->at->latest[nodes[0]] == look->at->sorted ? look->at->first[nodes[0]] : -1;
}

/* The ends of the flank at the edges of one facet, of those that SortByCorners() has sorted, as FlankShare() says. */
static int FacetEnds(const Nearest *look, const Candidate *c, PetscReal *share)
{
  int ends = 0;

  for (int k = 0; k < EdgeCount(&c->facet); k++) {
    for (PetscInt i = FirstAt(look, c, k); i >= 0; i = look->at->entry[i].next) {
      const Candidate *beyond = &look->candidates[look->at->entry[i].candidate];
      FlankEdge        edge;

      if (!SharesEdge(look, c, beyond, k, &edge)) continue;
      ends |= (edge.convex ? 1 + FLANK_CONVEX : 1) << k;
      if (edge.convex) *share = PetscMin(*share, ConvexShare(look, c, beyond, &edge));
    }
  }
  return ends;
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
. ends - ends[facing]: for each facet that faces the point the edges at which the flank ends, as bits like free_edges;
         FLANK_CONVEX times those of convex edges in addition

  Note:
  Returns 1 where the normals oppose each other, and neither a convex end nor a free edge that the slave overhangs is
  near.
@*/
PetscReal FlankShare(const Nearest *look, int facing, int n, const int *found, int *ends)
{
  PetscReal share = 1;

  SortByCorners(look, n - facing, &found[facing]);
  for (int i = 0; i < facing; i++) {
    share   = PetscMin(share, FreeShare(look, &look->candidates[found[i]], facing, found));
    ends[i] = FacetEnds(look, &look->candidates[found[i]], &share);
  }
  if (n > facing) share *= DeepShare(look, facing, n, found);
  share *= RidgeShare(look, facing, found) * EdgeShare(look);
  return share * NeighbourListsOpposed(look->lists, look->q, look->normal);
}

/*@
  FlankCuts - finds the edges at which facets that face the slave point meet others that FlankSort() has dropped, where
  slave and master have faces of one body.

  Not collective

  Input Parameters:
+ look    - the slave point
. facing  - number of facets that face the point
. found   - their numbers
. n       - number of facets that were dropped
- dropped - their numbers

  Input/Output Parameter:
. ends - ends[facing] of FlankShare(): FLANK_CUT times the bits of these edges is added

  Note:
  In the tip of a fold the surface goes on across such an edge to the point itself. Past it a point is beside the facet,
  however deep it would be behind it. A rubber block with nine holes (tests/scenes/holes_block.yaml) takes 77 iterations
  with these ends and 499 without.
@*/
void FlankCuts(const Nearest *look, int facing, const int *found, int n, const int *dropped, int *ends)
{
  if (!look->one_body || n == 0) return;
  SortByCorners(look, n, dropped);
  for (int i = 0; i < facing; i++) {
    const Candidate *c = &look->candidates[found[i]];

    for (int k = 0; k < EdgeCount(&c->facet); k++) {
      for (PetscInt j = FirstAt(look, c, k); j >= 0; j = look->at->entry[j].next) {
        FlankEdge edge;

        if (SharesEdge(look, c, &look->candidates[look->at->entry[j].candidate], k, &edge)) ends[i] |= FLANK_CUT << k;
      }
    }
  }
}

/*@
  FlankIsBeside - says whether a facet that does not face the slave point is within a face of the slave.

  Not collective

  Input Parameters:
+ look   - the slave point
. facing - number of facets that face the point
. n      - number of facets
- found  - their numbers
@*/
PetscBool FlankIsBeside(const Nearest *look, int facing, int n, const int *found)
{
  for (int k = facing; k < n; k++)
    if (CandidateDistance(look, &look->candidates[found[k]]) <= look->size) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  FlankLies - says whether the slave lies on the nearest facet of the master, with its foot within it.

  Not collective

  Input Parameter:
. look - the slave point with its nearest facet and foot

  Note:
  A point just inside of a bore does, though its own face may be turned enough to face the end of the bore a little.
@*/
PetscBool FlankLies(const Nearest *look)
{
  const PetscReal *normal = look->candidates[look->best].normal;

  return (PetscBool)(look->foot.region == FOOT_INTERIOR && look->foot.beyond == 0 &&
                     StandsOff(look, -Dot(look->outward, normal)) == 0);
}

/* Says whether a fit past an edge between two facets would miss one of them: of a convex edge either one, of a concave
   one a facet that takes the slave point with its whole area, as the other one does. */
static PetscBool EdgeNeedsBoth(const Nearest *look, const FlankEdge *edge, const Candidate *c, const Candidate *o)
{
  return (PetscBool)(edge->convex || (NeighbourListsOpposed(look->lists, look->q, c->normal) >= 1 &&
                                      NeighbourListsOpposed(look->lists, look->q, o->normal) >= 1));
}

/*@
  FlankNearRidge - says whether the slave point's foot is within half a face of a sharp edge whose two facets both face
  the point.

  Not collective

  Input Parameters:
+ look           - the slave point with its nearest facet and foot
. neighbourhoods - know the sharp edges
. facing         - number of facets that face the point
- found          - their numbers

  Note:
  A fit knows one side of such an edge only. The facets know both: past a convex edge the normal turns from one side to
  the other, and a node in a concave edge, as the corner of a block in that of a box, is held by both sides.
@*/
PetscBool FlankNearRidge(const Nearest *look, Neighbourhoods neighbourhoods, int facing, const int *found)
{
  for (int i = 0; i < facing; i++) {
    const Candidate *c = &look->candidates[found[i]];

    if (!NeighbourhoodsIsSharp(neighbourhoods, found[i])) continue;
    for (int k = 0; k < facing; k++) {
      const Candidate *o = &look->candidates[found[k]];
      FlankEdge        edge;
      PetscReal        place[3];

      if (k == i || !NeighbourhoodsIsSharp(neighbourhoods, found[k]) || !SharedEdge(look, c, o, &edge)) continue;
      if (EdgeNeedsBoth(look, &edge, c, o) && NeighbourhoodsMeetSharply(neighbourhoods, found[i], found[k]) &&
          FootToEdge(look, &edge, place) <= 0.5 * look->size)
        return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}
