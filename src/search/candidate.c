/* Candidates of a search, and the growing lists into which they are written. */
#include "searchimpl.h"

/* Boxes of curved facets are widened by this fraction of the face size. A quadratic face bulges beyond its nodes by
   at most 1/8 of its chord. */
#define SEARCH_BULGE 0.15

/*@
  CandidateBulge - returns how far a candidate may reach beyond its nodes (length).

  Not collective

  Input Parameters:
+ c    - the candidate, whose facet is set
- size - face size (length)
@*/
PetscReal CandidateBulge(const Candidate *c, PetscReal size)
{
  return ElementGet(c->facet.type)->order == 2 ? SEARCH_BULGE * size : 0;
}

/*@
  CandidatePlace - computes centre, unit normal and bounding box of a candidate from positions of its nodes.

  Not collective

  Input Parameters:
+ dim  - dimension
. x    - positions of the facet's nodes (length), dim components each
- size - face size (length), by which the box of a curved facet is widened

  Input/Output Parameter:
. c - the candidate, whose facet is set
@*/
void CandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *c)
{
  const Element *e     = ElementGet(c->facet.type);
  double         xi[2] = {0, 0}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], t[2][3] = {{0}}, length = 0;

  if (e->corners == 3) xi[0] = xi[1] = 1.0 / 3;
  ElementShape(e->type, xi, N, dN, NULL);
  for (int d = 0; d < 3; d++) {
    c->centre[d] = 0;
    c->lower[d]  = PETSC_MAX_REAL;
    c->upper[d]  = PETSC_MIN_REAL;
  }
  for (int a = 0; a < e->nodes; a++) {
    for (int d = 0; d < dim; d++) {
      c->centre[d] += N[a] * x[a * dim + d];
      c->lower[d] = PetscMin(c->lower[d], x[a * dim + d]);
      c->upper[d] = PetscMax(c->upper[d], x[a * dim + d]);
      for (int k = 0; k < e->dim; k++) t[k][d] += dN[a * e->dim + k] * x[a * dim + d];
    }
  }
  if (dim == 2) {
    c->normal[0] = t[0][1];
    c->normal[1] = -t[0][0];
    c->normal[2] = 0;
  } else {
    for (int d = 0; d < 3; d++)
      c->normal[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
  }
  for (int d = 0; d < 3; d++) length += PetscSqr(c->normal[d]);
  length = PetscSqrtReal(length);
  for (int d = 0; d < 3; d++) {
    if (length > 0) c->normal[d] /= length;
    c->lower[d] -= CandidateBulge(c, size);
    c->upper[d] += CandidateBulge(c, size);
  }
}

/*@
  CandidateHull - computes the hull of a candidate from positions of its nodes.

  Not collective

  Input Parameters:
+ dim - dimension
- x   - positions of the facet's nodes (length), dim components each

  Input/Output Parameter:
. c - the candidate, whose facet is set
@*/
void CandidateHull(int dim, const PetscReal *x, Candidate *c)
{
  Facet facet = c->facet;

  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) facet.nodes[a] = a;
  FacetHullOf(dim, &facet, x, &c->hull);
}

/*@
  CandidateBoxDistance - returns the distance (length) of a place to the bounding box of a candidate. The candidate is
  not nearer than that.

  Not collective

  Input Parameters:
+ dim - dimension
. c   - the candidate, after CandidatePlace()
- x   - the place (length)
@*/
PetscReal CandidateBoxDistance(int dim, const Candidate *c, const PetscReal *x)
{
  PetscReal square = 0;

  for (int d = 0; d < dim; d++) square += PetscSqr(PetscMax(0, PetscMax(c->lower[d] - x[d], x[d] - c->upper[d])));
  return PetscSqrtReal(square);
}

/*@
  CandidatesTree - builds the tree over the boxes of candidates.

  Not collective

  Input Parameters:
+ dim        - dimension
. n          - number of candidates
. candidates - after CandidatePlace()
. facing     - BoxTreeClosest() is to be given sides
- moved      - their ways are known

  Output Parameter:
. tree - free it with BoxTreeDestroy()
@*/
PetscErrorCode CandidatesTree(int dim, PetscInt n, const Candidate *candidates, PetscBool facing, PetscBool moved,
                              BoxTree *tree)
{
  double *lower, *upper, *normal;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * dim, &lower, n * dim, &upper, n * dim, &normal));
  for (PetscInt i = 0; i < n; i++) {
    for (int d = 0; d < dim; d++) {
      lower[i * dim + d]  = candidates[i].lower[d];
      upper[i * dim + d]  = candidates[i].upper[d];
      normal[i * dim + d] = candidates[i].normal[d];
    }
  }
  PetscCheck(!BoxTreeBuildFacing(dim, (int)n, lower, upper, facing ? normal : NULL, tree), PETSC_COMM_SELF,
             PETSC_ERR_MEM, "no memory for the search tree");
  for (PetscInt i = 0; i < n && moved; i++) {
    for (int d = 0; d < dim; d++) {
      lower[i * dim + d] = candidates[i].way_lower[d];
      upper[i * dim + d] = candidates[i].way_upper[d];
    }
  }
  PetscCheck(!moved || !BoxTreeSetWays(*tree, lower, upper), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "no memory for the search tree");
  PetscCall(PetscFree3(lower, upper, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ListBufferAddPoint - adds a point to the list of the present slave point, unless the list already holds it.

  Not collective

  Input Parameters:
+ first - start of the list of the present slave point
- point - the point

  Input/Output Parameter:
. buffer - the growing lists; position[point] is the point's place in all lists afterwards
@*/
PetscErrorCode ListBufferAddPoint(ListBuffer *buffer, PetscInt first, PetscInt point)
{
  PetscFunctionBeginUser;
  if (buffer->position[point] >= first) PetscFunctionReturn(PETSC_SUCCESS);
  if (buffer->n_points == buffer->points_room)
    PetscCall(PetscRealloc((buffer->points_room = 2 * buffer->points_room + 1024) * sizeof(PetscInt), &buffer->point));
  buffer->position[point]           = buffer->n_points;
  buffer->point[buffer->n_points++] = point;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ListBufferAddPoints - adds points to the list of the present slave point as ListBufferAddPoint() does.

  Not collective

  Input Parameters:
+ first  - start of the list of the present slave point
. n      - number of points
- points - the points

  Input/Output Parameter:
. buffer - the growing lists
@*/
PetscErrorCode ListBufferAddPoints(ListBuffer *buffer, PetscInt first, PetscInt n, const PetscInt *points)
{
  PetscInt *position = buffer->position, end = buffer->n_points;

  PetscFunctionBeginUser;
  if (end + n > buffer->points_room)
    PetscCall(PetscRealloc((buffer->points_room = 2 * (end + n)) * sizeof(PetscInt), &buffer->point));
  for (PetscInt i = 0; i < n; i++) {
    if (position[points[i]] >= first) continue;
    position[points[i]]  = end;
    buffer->point[end++] = points[i];
  }
  buffer->n_points = end;
  PetscFunctionReturn(PETSC_SUCCESS);
}
