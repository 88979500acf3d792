/* Facets that a slave point's own body hides, see ownbody.h. */
#include "ownbody.h"

/* The slave point touches a facet of its own body if it is behind that in the reference configuration by no more than
   this part of a face: round-off of the mesh's coordinates. */
#define OWN_BODY_TOUCHES 1e-6

/* Two faces at a convex edge whose normals have at most this product, 45 degrees apart, do not fold onto each other:
   the body between them would have to turn inside out. A smooth surface of the coarsest meshes turns by less. */
#define OWN_BODY_SHARP 0.71

/* A point past the end of another body's facet is beside it where it is off the facet's plane by no more than this part
   of its distance, 6 degrees. Where flat sides lie flush on each other, round-off or strains of some per cent decide on
   which side of that plane it is. */
#define OWN_BODY_BESIDE 0.1

/* Foot of a place on a facet whose nodes are at X[nodes][dim], all relative to the same origin. */
static void FootAt(int dim, Facet facet, const PetscReal *X, const PetscReal *place, Foot *foot)
{
  PetscReal x[FACE_MAX_NODES * 3];

  facet.free_edges = 0;
  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    for (int d = 0; d < dim; d++) x[a * dim + d] = X[a * dim + d] - place[d];
    facet.nodes[a] = a;
  }
  FacetProject(dim, &facet, x, foot);
}

/* Is a facet of the same body as the slave point? Pieces of the mesh that share no nodes are bodies of their own,
   whatever the scene calls them. Of slave points that are nodes the piece is not known. */
static PetscBool OnOwnPiece(const Nearest *look, const Candidate *c)
{
  const SlavePoints slaves = look->slaves;

  return (PetscBool)(look->one_body &&
                     (!slaves->face_sf || c->piece == slaves->piece[SlavePointFace(slaves, look->q)]));
}

/* How far the slave point is behind a facet in the reference configuration (length); negative in front of it. */
static PetscReal ReferenceDepth(const Nearest *look, const Candidate *c)
{
  const NeighbourLists lists = look->lists;
  const int            dim   = lists->dim;
  PetscReal            X[FACE_MAX_NODES * 3];
  Foot                 foot;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = lists->point_X[c->facet.nodes[a] * dim + d];
  FootAt(dim, c->facet, X, &lists->slave_X[look->q * dim], &foot);
  return -foot.gap;
}

/*@
  OwnBodyIsWedge - says whether a facet that shares a node with the slave point's own face meets it at a sharp convex
  edge of the undeformed body, so that the two are sides of a wedge and never partners.

  Not collective

  Input Parameters:
+ look - the slave point, in surface-to-surface contact
- c    - the candidate

  Note:
  Sides of a knife's edge oppose each other, and a point on the edge touches both. Its depth below the other side is
  none, so that OwnBodyHides() cannot tell.
@*/
PetscBool OwnBodyIsWedge(const Nearest *look, const Candidate *c)
{
  const NeighbourLists lists  = look->lists;
  const SlavePoints    slaves = look->slaves;
  const Facet         *own    = &slaves->faces[SlavePointFace(slaves, look->q)];
  const int            dim = lists->dim, n = ElementGet(own->type)->nodes;
  const PetscReal     *origin = &lists->slave_X[look->q * dim];
  PetscReal            X[FACE_MAX_NODES * 3], centre[3] = {0, 0, 0}, cosine = 0;
  Foot                 foot, own_foot;

  for (int a = 0; a < n; a++) {
    for (int d = 0; d < dim; d++) {
      X[a * dim + d] = slaves->nodes[own->nodes[a]].X[d] - origin[d];
      centre[d] += X[a * dim + d] / n;
    }
  }
  FootAt(dim, *own, X, centre, &own_foot);
  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = lists->point_X[c->facet.nodes[a] * dim + d] - origin[d];
  FootAt(dim, c->facet, X, centre, &foot);
  for (int d = 0; d < dim; d++) cosine += own_foot.normal[d] * foot.normal[d];
  return (PetscBool)(foot.gap < 0 && cosine < OWN_BODY_SHARP);
}

/* How far a foot lies behind the plane of the slave point's own face (length); negative before it. */
static PetscReal BehindOwnFace(const Nearest *look, const Foot *foot)
{
  PetscReal along = 0;

  for (int d = 0; d < look->lists->dim; d++) along += look->outward[d] * foot->normal[d];
  return foot->gap * along;
}

/* How much of the way between a slave point and its foot on a facet leads along the normal of that, or of the smooth
   surface there, whichever is less. A coarse facet of a bore is tilted along it. */
static PetscReal AlongNormal(const Nearest *look, const Candidate *c, const Foot *foot)
{
  PetscReal along = 0, smooth = 0, normal[3];

  for (int d = 0; d < look->lists->dim; d++) along += c->normal[d] * foot->normal[d];
  if (!look->corners || foot->region == FOOT_INTERIOR) return PetscAbsReal(along);
  CornerNormalsAt(look->corners, (PetscInt)(c - look->candidates), foot->xi, normal);
  for (int d = 0; d < look->lists->dim; d++) smooth += normal[d] * foot->normal[d];
  return PetscMin(PetscAbsReal(along), PetscAbsReal(smooth));
}

/* Is a slave point beside a facet of another body, on whose edge it has its foot? */
static PetscBool IsBeside(const Nearest *look, const Candidate *c, const Foot *foot)
{
  return (PetscBool)(AlongNormal(look, c, foot) < OWN_BODY_BESIDE);
}

/* Is a slave point behind the plane of such a facet by so little that it may have entered the body there? Coarse facets
   of a bore stand in it by their sagitta, and past its rim a pin that touches it is behind their planes. */
static PetscBool IsLittleBehind(const Nearest *look, const Candidate *c, const Foot *foot)
{
  return (PetscBool)(AlongNormal(look, c, foot) * -foot->gap <=
                     PetscMin(OWN_BODY_BESIDE * look->size, SEARCH_ENTERED * look->height));
}

/* Is a depth behind a facet more than what can have been entered of it? Where the faces of another body are coarse, its
   smooth surface may lie so much deeper than they do, which counts as far as OwnBodyFarthest() allows. A grommet that
   bends round the edge of a plate, whose faces are a third as long as its own, stops where the chords of its faces
   count as depths. */
static PetscBool IsDeep(const Nearest *look, const Candidate *c, PetscReal depth)
{
  const PetscReal entered = SEARCH_ENTERED * look->height;
  PetscReal       bulge;

  if (depth <= entered || look->one_body || !look->corners) return (PetscBool)(depth > entered);
  bulge = CornerNormalsBulge(look->corners, (PetscInt)(c - look->candidates));
  return (PetscBool)(depth > PetscMin(entered + bulge, OwnBodyBehind(look)));
}

/*@
  OwnBodyHides - says whether a candidate lies behind the slave point, beyond its own body.

  Not collective

  Input Parameters:
+ look - the slave point
. c    - the candidate, whose normal opposes that of the point
- foot - of the point on the candidate, without free edges

  Note:
  Always PETSC_FALSE where the scene names slave and master. The distance to another body's facet that the point is
  beside is no depth, unless it leads through the point's own body, as from the bore of a pipe to the end of a plate
  that lies on the pipe. Without the facets at an edge of that body, the point would be taken for one behind the next
  ones.
@*/
PetscBool OwnBodyHides(const Nearest *look, const Candidate *c, const Foot *foot)
{
  const PetscReal depth = -foot->gap;
  PetscReal       wall;

  if (!look->listed || depth <= 0) return PETSC_FALSE;
  if (IsDeep(look, c, depth))
    return (PetscBool)(look->one_body || depth > look->size ||
                       !(IsBeside(look, c, foot) || IsLittleBehind(look, c, foot)) ||
                       BehindOwnFace(look, foot) > SEARCH_ENTERED * look->height);
  if (!OnOwnPiece(look, c)) return PETSC_FALSE;
  wall = ReferenceDepth(look, c);
  return (PetscBool)(wall > OWN_BODY_TOUCHES * look->size && depth > SEARCH_ENTERED * wall);
}

/* The same as OwnSide() from the nodes of a facet that lies between them: 0 where they are on both sides. */
static int NodesSide(const Nearest *look, const Facet *facet, PetscReal tolerance)
{
  const NeighbourLists lists = look->lists;
  const int            dim   = lists->dim;
  PetscReal            least = PETSC_INFINITY, most = PETSC_NINFINITY;

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    const PetscInt i      = facet->nodes[a] * dim;
    PetscReal      height = 0;

    for (int d = 0; d < dim; d++)
      height += look->outward[d] * (lists->point_X[i + d] + lists->point_u[i + d] - look->x[d]);
    least = PetscMin(least, height);
    most  = PetscMax(most, height);
  }
  return least > tolerance ? 1 : most < -tolerance ? -1 : 0;
}

/* On which side of the slave point's own face a facet lies: 1 before it, -1 behind it, 0 where neither its hull nor,
   where it does not bulge beyond its nodes, these tell. */
static int OwnSide(const Nearest *look, const Candidate *c, PetscReal tolerance)
{
  const FacetHull *hull  = &c->hull;
  PetscReal        along = 0;

  for (int d = 0; d < 3; d++) along += look->outward[d] * (hull->centre[d] - look->x[d]);
  if (PetscAbsReal(along) > hull->radius + tolerance) return along > 0 ? 1 : -1;
  return ElementGet(c->facet.type)->order == 1 ? NodesSide(look, &c->facet, tolerance) : 0;
}

/* Is a facet farther from the slave point than what can have been entered of its body? */
static PetscBool BeyondEntered(const Nearest *look, const FacetHull *hull, PetscReal tolerance)
{
  const PetscReal reach  = hull->radius + OwnBodyBehind(look) + tolerance;
  PetscReal       square = 0;

  for (int d = 0; d < 3; d++) square += PetscSqr(hull->centre[d] - look->x[d]);
  return (PetscBool)(square > PetscSqr(reach));
}

/*@
  OwnBodyTells - says whether the hull of a candidate tells that the slave point's own body hides it, or that it does
  not, so that the foot on it need not be known.

  Not collective

  Input Parameters:
+ look - the slave point
- c    - the candidate, whose normal opposes that of the point

  Output Parameter:
. hidden - what OwnBodyHides() and, where slave and master have faces of one body, OwnBodyTurnsFrom() say

  Note:
  Returns PETSC_FALSE where the hull does not tell.
@*/
PetscBool OwnBodyTells(const Nearest *look, const Candidate *c, PetscBool *hidden)
{
  const PetscReal tolerance = OWN_BODY_TOUCHES * look->size;
  const int side = FacetHullSide(&c->hull, look->x, tolerance), own = look->one_body ? OwnSide(look, c, tolerance) : 1;

  if (own == 0) return PETSC_FALSE;
  *hidden = PETSC_FALSE;
  if (own > 0 && side > 0) return PETSC_TRUE;
  *hidden = PETSC_TRUE;
  if (own < 0 && side > 0) return PETSC_TRUE;
  if (look->one_body && own > 0 && side < 0) return PETSC_TRUE;
  return (PetscBool)((own < 0 || side < 0) && BeyondEntered(look, &c->hull, tolerance));
}

/*@
  OwnBodyBehind - returns the distance (length) beyond which no candidate that lies wholly behind the plane of the slave
  point's face counts: OwnBodyHides() or OwnBodyTurnsFrom() leaves it out, and it is not averse.

  Not collective

  Input Parameter:
. look - the slave point, where any side of the bodies may meet any other one
@*/
PetscReal OwnBodyBehind(const Nearest *look)
{
  return OwnBodyFarthest(look->one_body, look->height, look->size);
}

/*@
  OwnBodyFarthest - returns what OwnBodyBehind() does, for a slave point that is not searched.

  Not collective

  Input Parameters:
+ one_body - slave and master have faces of one body
. height   - of the element below the point's face (length)
- size     - of that face (length)
@*/
PetscReal OwnBodyFarthest(PetscBool one_body, PetscReal height, PetscReal size)
{
  return one_body ? SEARCH_ENTERED * height : PetscMax(SEARCH_ENTERED * height, size);
}

/*@
  OwnBodyTurnsFrom - says whether a foot lies on the wrong side of the slave point's own face: behind it with a gap, or
  in front of it with a penetration.

  Not collective

  Input Parameters:
+ look - the slave point
. c    - a candidate whose normal opposes that of the point
- foot - of the point on it, without free edges

  Notes:
  Always PETSC_FALSE where the scene names slave and master. A point that is past the end of another body's facet, in
  its plane, has its foot at the end. As the two faces are not quite parallel, that is before the point's face or behind
  it, by no more than the angle between them. Within a face of the slave that says nothing, nor does it where the point
  is beside the facet. Farther away a point that is beside has no partner there: if facets of one flank were partners or
  not as round-off says, the foot could be inside the flank, and the gap its distance along it, of either sign.
@*/
PetscBool OwnBodyTurnsFrom(const Nearest *look, const Candidate *c, const Foot *foot)
{
  const PetscReal *own   = &look->lists->slave_normal[3 * look->q];
  PetscReal        along = 0, cosine = 0, square = 0;
  PetscBool        beside;

  if (!look->listed) return PETSC_FALSE;
  for (int d = 0; d < look->lists->dim; d++) {
    along += own[d] * foot->normal[d];
    cosine += own[d] * c->normal[d];
    square += PetscSqr(own[d]);
  }
  if (look->one_body) return (PetscBool)(along >= 0);
  beside = IsBeside(look, c, foot);
  if (PetscAbsReal(foot->gap) > look->size) return (PetscBool)(beside || along >= 0);
  square *= beside ? 1 + PetscSqr(OWN_BODY_BESIDE) : 1;
  return (PetscBool)(along >= PetscSqrtReal(PetscMax(0, square - PetscSqr(cosine))));
}
