/* Facets that a slave point's own body hides, see ownbody.h. */
#include "ownbody.h"

/* The slave point touches a facet of its own body if it is behind that in the reference configuration by no more than
   this part of a face: round-off of the mesh's coordinates. */
#define OWN_BODY_TOUCHES 1e-6

/* How far the slave point is behind a facet in the reference configuration (length); negative in front of it. */
static PetscReal ReferenceDepth(const Nearest *look, const Candidate *c)
{
  const NeighbourLists lists = look->lists;
  const int            dim   = lists->dim;
  PetscReal            x[FACE_MAX_NODES * 3];
  Facet                facet = c->facet;
  Foot                 foot;

  facet.free_edges = 0;
  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    for (int d = 0; d < dim; d++)
      x[a * dim + d] = lists->point_X[facet.nodes[a] * dim + d] - lists->slave_X[look->q * dim + d];
    facet.nodes[a] = a;
  }
  FacetProject(dim, &facet, x, &foot);
  return -foot.gap;
}

/*@
  OwnBodyHides - says whether a candidate lies behind the slave point, beyond its own body.

  Not collective

  Input Parameters:
+ look - the slave point
. c    - the candidate, whose normal opposes that of the point
- foot - of the point on the candidate, without free edges

  Note:
  Always PETSC_FALSE where the scene names slave and master.
@*/
PetscBool OwnBodyHides(const Nearest *look, const Candidate *c, const Foot *foot)
{
  const PetscReal depth = -foot->gap;
  PetscReal       wall;

  if (!look->listed || depth <= 0) return PETSC_FALSE;
  if (depth > SEARCH_ENTERED * look->height) return PETSC_TRUE;
  if (!look->one_body) return PETSC_FALSE;
  wall = ReferenceDepth(look, c);
  return (PetscBool)(wall > OWN_BODY_TOUCHES * look->size && depth > SEARCH_ENTERED * wall);
}

/* On which side of the slave point's own face a facet lies: 1 before it, -1 behind it, 0 where its hull does not
   tell. */
static int OwnSide(const Nearest *look, const FacetHull *hull, PetscReal tolerance)
{
  PetscReal along = 0;

  for (int d = 0; d < 3; d++) along += look->outward[d] * (hull->centre[d] - look->x[d]);
  return along > hull->radius + tolerance ? 1 : along < -hull->radius - tolerance ? -1 : 0;
}

/* Is a facet farther from the slave point than what can have been entered of its body? */
static PetscBool BeyondEntered(const Nearest *look, const FacetHull *hull, PetscReal tolerance)
{
  const PetscReal reach  = hull->radius + SEARCH_ENTERED * look->height + tolerance;
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
  const int       side      = FacetHullSide(&c->hull, look->x, tolerance),
            own             = look->one_body ? OwnSide(look, &c->hull, tolerance) : 1;

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
  const PetscReal entered = SEARCH_ENTERED * look->height;

  return look->one_body ? entered : PetscMax(entered, look->size);
}

/*@
  OwnBodyTurnsFrom - says whether a foot lies on the wrong side of the slave point's own face: behind it with a gap, or
in front of it with a penetration.

  Not collective

  Input Parameters:
+ look - the slave point
- foot - of the point on a candidate, without free edges

  Note:
  Always PETSC_FALSE where the scene names slave and master.
@*/
PetscBool OwnBodyTurnsFrom(const Nearest *look, const Foot *foot)
{
  const PetscReal *own   = &look->lists->slave_normal[3 * look->q];
  PetscReal        along = 0;

  if (!look->listed) return PETSC_FALSE;
  for (int d = 0; d < look->lists->dim; d++) along += own[d] * foot->normal[d];
  return (PetscBool)(along >= 0);
}
