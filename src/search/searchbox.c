/* Positions of faces, and boxes around faces and slave points. */
#include "searchimpl.h"

/*@
  SearchRigidPlace - gives the reference place of a node of the rigid tool.

  Not collective

  Input Parameters:
+ s - the search, whose master is a tool, or whose slave is the edges of one
- n - node of the tool, or point on its edges

  Output Parameter:
. X - position relative to the mesh's centre (length)
@*/
void SearchRigidPlace(ContactSearch s, PetscInt n, PetscReal X[3])
{
  const int dim = s->mesh->dim;

  for (int d = 0; d < 3; d++) {
    if (s->master->rigid)
      X[d] = d < dim ? s->master->rigid->coords[n * dim + d] : 0;
    else
      X[d] = s->slaves->surface->ridge.point[n].X[d];
  }
}

/*@
  SearchRigidPosition - computes the position of a node of the rigid tool at load parameter t.

  Not collective

  Input Parameters:
+ s - the search, as for SearchRigidPlace()
. n - node of the tool, or point on its edges
- t - load parameter

  Output Parameter:
. x - position relative to the mesh's centre (length)
@*/
void SearchRigidPosition(ContactSearch s, PetscInt n, PetscReal t, PetscReal x[3])
{
  const int body = s->master->rigid ? s->master->body : s->slaves->surface->body;
  PetscReal X[3];

  SearchRigidPlace(s, n, X);
  LoadsRigidMotion(s->loads, body, t, X, x);
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

  SearchBoxEmpty(dim, box);
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

  SearchBoxEmpty(dim, box);
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    PetscReal x[FACE_MAX_NODES * 3];

    if (some && !some[f]) continue;
    SearchFacePositions(s, s->master, f, u, t, x);
    for (int a = 0; a < ElementGet(s->master->faces[f].type)->nodes; a++) SearchBoxAdd(box, dim, &x[a * dim]);
  }
}

/*@
  SearchFaceBox - computes the box of a face or of a mirror image of it.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. n     - number of nodes of the face
. x     - x[n*dim], their positions (length)
- image - the image; NULL: the face itself

  Output Parameter:
. box - lower then upper corner
@*/
void SearchFaceBox(int dim, int n, const PetscReal *x, const SurfaceImage *image, PetscReal box[6])
{
  PetscReal y[3];

  SearchBoxEmpty(dim, box);
  for (int a = 0; a < n; a++) {
    if (image) SurfaceReflect(image, dim, &x[a * dim], y);
    SearchBoxAdd(box, dim, image ? y : &x[a * dim]);
  }
}
