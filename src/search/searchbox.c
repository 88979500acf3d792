/* Boxes and positions of faces. */
#include "searchimpl.h"

/*@
  SearchBoxEmpty - makes a box without any point.

  Not collective

  Output Parameter:
. box - lower then upper corner
@*/
void SearchBoxEmpty(PetscReal box[6])
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
  }
}

/*@
  SearchBoxAdd - makes a box so large that it holds a point.

  Not collective

  Input Parameters:
+ dim - 2 or 3
- x   - x[dim], the point

  Input/Output Parameter:
. box - lower then upper corner
@*/
void SearchBoxAdd(PetscReal box[6], int dim, const PetscReal *x)
{
  for (int d = 0; d < dim; d++) {
    box[d]     = PetscMin(box[d], x[d]);
    box[3 + d] = PetscMax(box[3 + d], x[d]);
  }
}

/*@
  SearchBoxesMeet - tests whether two boxes are within a distance of each other.

  Not collective

  Input Parameters:
+ a        - box, lower then upper corner
. b        - another box
. dim      - 2 or 3
- distance - the distance (length)
@*/
PetscBool SearchBoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance)
{
  for (int d = 0; d < dim; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}

/*@
  SearchRigidPosition - computes the position of a node of the rigid tool at load parameter t.

  Not collective

  Input Parameters:
+ s - the search
. n - node of the tool
- t - load parameter

  Output Parameter:
. x - position relative to the mesh's centre (length)
@*/
void SearchRigidPosition(ContactSearch s, PetscInt n, PetscReal t, PetscReal x[3])
{
  const int dim  = s->mesh->dim;
  PetscReal X[3] = {0, 0, 0};

  for (int d = 0; d < dim; d++) X[d] = s->master->rigid->coords[n * dim + d];
  LoadsRigidMotion(s->loads, s->master->body, t, X, x);
}

/* The position of a node of the tool, which is kept between SearchStateBegin() and SearchStateEnd(). */
static void ToolPosition(ContactSearch s, PetscInt n, PetscReal t, PetscReal x[3])
{
  const int dim = s->mesh->dim;

  if (s->rigid_x && s->rigid_known[n]) {
    for (int d = 0; d < dim; d++) x[d] = s->rigid_x[n * dim + d];
    return;
  }
  SearchRigidPosition(s, n, t, x);
  if (!s->rigid_x) return;
  for (int d = 0; d < dim; d++) s->rigid_x[n * dim + d] = x[d];
  s->rigid_known[n] = 1;
}

/*@
  SearchFacePositions - computes the positions of the nodes of a face of this rank.

  Not collective

  Input Parameters:
+ s       - the search
. surface - its master or its slave
. f       - number of the face
. u       - local displacements (length); NULL: of a rigid tool
- t       - load parameter, for rigid tools

  Output Parameter:
. x - x[nodes of the face][dim] (length)
@*/
void SearchFacePositions(ContactSearch s, ContactSurface surface, PetscInt f, const PetscReal *u, PetscReal t,
                         PetscReal *x)
{
  const int    dim   = s->mesh->dim;
  const Facet *facet = &surface->faces[f];

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    PetscReal y[3];

    if (surface->rigid) ToolPosition(s, facet->nodes[a], t, y);
    for (int d = 0; d < dim; d++)
      x[a * dim + d] =
        surface->rigid ? y[d] : s->mesh->coords[facet->nodes[a] * dim + d] + u[facet->nodes[a] * dim + d];
  }
}

/*@
  SearchSlaveBox - computes the box of this rank's slave points that may have a partner, after their last move.

  Not collective

  Input Parameter:
. s - the search

  Output Parameter:
. box - lower then upper corner
@*/
void SearchSlaveBox(ContactSearch s, PetscReal box[6])
{
  const int dim = s->mesh->dim;

  SearchBoxEmpty(box);
  for (PetscInt q = 0; q < s->slaves->n; q++) {
    PetscReal x[3];

    if (s->partners.possible && !s->partners.possible[q]) continue;
    SlavePointsPosition(s->slaves, q, x);
    SearchBoxAdd(box, dim, x);
  }
}

/*@
  SearchMasterBox - computes the box of this rank's own faces of the master.

  Not collective

  Input Parameters:
+ s    - the search
. u    - local displacements (length)
. t    - load parameter, for rigid tools
- some - some[faces]: only these faces count; NULL: all do

  Output Parameter:
. box - lower then upper corner

  Note:
  A rigid tool has all its faces on every rank.
@*/
void SearchMasterBox(ContactSearch s, const PetscReal *u, PetscReal t, const PetscBool *some, PetscReal box[6])
{
  const int dim = s->mesh->dim;

  SearchBoxEmpty(box);
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    PetscReal x[FACE_MAX_NODES * 3];

    if (some && !some[f]) continue;
    SearchFacePositions(s, s->master, f, u, t, x);
    for (int a = 0; a < ElementGet(s->master->faces[f].type)->nodes; a++) SearchBoxAdd(box, dim, &x[a * dim]);
  }
}

/*@
  SearchFaceMeets - tests whether a face comes within a distance of a box.

  Not collective

  Input Parameters:
+ dim      - 2 or 3
. n        - number of nodes of the face
. x        - x[n*dim], their positions (length)
. box      - lower then upper corner
- distance - the distance (length)
@*/
PetscBool SearchFaceMeets(int dim, int n, const PetscReal *x, const PetscReal box[6], PetscReal distance)
{
  PetscReal face[6];

  SearchBoxEmpty(face);
  for (int a = 0; a < n; a++) SearchBoxAdd(face, dim, &x[a * dim]);
  return SearchBoxesMeet(face, box, dim, distance);
}

/*@
  SearchSomeImageMeets - tests whether any mirror image of a face comes within a distance of a box.

  Not collective

  Input Parameters:
+ s        - the search
. n        - number of nodes of the face
. x        - x[n*dim], their positions (length)
. box      - lower then upper corner
- distance - the distance (length)
@*/
PetscBool SearchSomeImageMeets(ContactSearch s, int n, const PetscReal *x, const PetscReal box[6], PetscReal distance)
{
  const int dim = s->mesh->dim;

  for (int m = 0; m < s->n_images; m++) {
    PetscReal face[6], y[3];

    if (s->images[m].left_out) continue;
    SearchBoxEmpty(face);
    for (int a = 0; a < n; a++) {
      SurfaceReflect(&s->images[m], dim, &x[a * dim], y);
      SearchBoxAdd(face, dim, y);
    }
    if (SearchBoxesMeet(face, box, dim, distance)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
