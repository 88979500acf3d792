/* The faces of a surface near a box: by blocks of faces first (faceblocks.h), then by each face's own box. */
#include "searchimpl.h"

/*@
  SearchStateBegin - has positions kept, each from when it is asked for first: those of a tool's nodes, and the boxes of
  blocks of faces.

  Not collective

  Input Parameter:
. s - the search

  Note:
  SearchStateEnd() forgets them. In between all is asked for at the same displacements and load parameter.
@*/
PetscErrorCode SearchStateBegin(ContactSearch s)
{
  const PetscInt n = s->master && s->master->rigid ? s->master->rigid->n_nodes : 0;

  PetscFunctionBeginUser;
  s->holds         = PETSC_TRUE;
  s->n_blocks_held = 0;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n * s->mesh->dim, &s->rigid_x));
  PetscCall(PetscCalloc1(n, &s->rigid_known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchStateEnd - forgets positions of a state.

  Not collective

  Input Parameter:
. s - the search
@*/
PetscErrorCode SearchStateEnd(ContactSearch s)
{
  PetscFunctionBeginUser;
  s->holds = PETSC_FALSE;
  PetscCall(PetscFree(s->rigid_x));
  PetscCall(PetscFree(s->rigid_known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchBlocks - gives the blocks of a surface's faces, with their boxes at a state.

  Not collective

  Input Parameters:
+ s       - the search
. surface - its master or its slave
- u       - local displacements (length); not read for a rigid tool

  Output Parameter:
. blocks - they belong to the surface; those of a rigid tool are in the tool's own frame
@*/
PetscErrorCode SearchBlocks(ContactSearch s, ContactSurface surface, const PetscReal *u, FaceBlocks *blocks)
{
  const PetscReal *X    = surface->rigid ? surface->rigid->coords : s->mesh->coords;
  PetscBool        held = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!surface->blocks)
    PetscCall(FaceBlocksCreate(s->mesh->dim, surface->n_faces, surface->faces, X, &surface->blocks));
  for (int i = 0; i < s->n_blocks_held && s->holds; i++)
    held = (PetscBool)(held || s->blocks_held[i] == surface->blocks);
  if (!surface->rigid && !held) FaceBlocksPlace(surface->blocks, X, u);
  if (s->holds && !held) s->blocks_held[s->n_blocks_held++] = surface->blocks;
  *blocks = surface->blocks;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The box of what an image takes into a box: reflections are their own inverse but for the shift. */
static void ReflectBox(const SurfaceImage *image, const PetscReal box[6], PetscReal out[6])
{
  for (int d = 0; d < 3; d++) {
    const PetscReal low  = image->sign[d] * (box[d] - image->shift[d]),
                    high = image->sign[d] * (box[3 + d] - image->shift[d]);

    out[d]     = PetscMin(low, high);
    out[3 + d] = PetscMax(low, high);
  }
}

/* The box, in the tool's own frame, of a box in space. A rigid motion takes the unit vectors to an orthogonal matrix,
   whose transpose is the way back. */
static void BoxInTool(ContactSearch s, ContactSurface tool, PetscReal t, PetscReal box[6])
{
  const PetscReal length  = s->mesh->size;
  PetscReal       zero[3] = {0, 0, 0}, origin[3], turn[3][3], out[6];

  LoadsRigidMotion(s->loads, tool->body, t, zero, origin);
  for (int k = 0; k < 3; k++) {
    PetscReal X[3] = {0, 0, 0}, x[3];

    X[k] = length;
    LoadsRigidMotion(s->loads, tool->body, t, X, x);
    for (int d = 0; d < 3; d++) turn[k][d] = (x[d] - origin[d]) / length;
  }
  SearchBoxEmpty(s->mesh->dim, out);
  for (int corner = 0; corner < 8; corner++) {
    PetscReal X[3] = {0, 0, 0};

    for (int k = 0; k < 3; k++)
      for (int d = 0; d < s->mesh->dim; d++) X[k] += turn[k][d] * (box[corner >> d & 1 ? 3 + d : d] - origin[d]);
    SearchBoxAdd(out, s->mesh->dim, X);
  }
  for (int i = 0; i < 6; i++) box[i] = out[i];
}

/* Collects the faces of the blocks of which an image comes within a distance of a box. */
static PetscErrorCode NearBlocks(ContactSearch s, ContactSurface surface, const PetscReal *u, PetscReal t,
                                 const PetscReal box[6], PetscReal distance, PetscInt *n, PetscInt **faces)
{
  const PetscBool master = (PetscBool)(surface == s->master);
  /* The way into the tool's frame has round-off. */
  const PetscReal more = distance + (surface->rigid ? SEARCH_ON_PLANE * s->mesh->size : 0);
  FaceBlocks      blocks;
  PetscBool      *taken;

  PetscFunctionBeginUser;
  PetscCall(SearchBlocks(s, surface, u, &blocks));
  PetscCall(PetscMalloc1(surface->n_faces, faces));
  PetscCall(PetscCalloc1(blocks->n, &taken));
  *n = 0;
  for (int m = 0; m < (master ? s->n_images : 1); m++) {
    PetscReal near[6];

    if (master && s->images[m].left_out) continue;
    for (int d = 0; d < 3; d++) {
      near[d]     = d < s->mesh->dim ? box[d] - more : 0;
      near[3 + d] = d < s->mesh->dim ? box[3 + d] + more : 0;
    }
    if (master) ReflectBox(&s->images[m], near, near);
    if (surface->rigid) BoxInTool(s, surface, t, near);
    *n += FaceBlocksNear(blocks, near, taken, *faces + *n);
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a face, or an image of it where it is a master's, come within a distance of a box? x: positions of its nodes. */
static PetscBool FaceMeets(ContactSearch s, ContactSurface surface, PetscInt f, const PetscReal *x,
                           const PetscReal box[6], PetscReal distance)
{
  const PetscBool master = (PetscBool)(surface == s->master);
  const int       dim    = s->mesh->dim;

  for (int m = 0; m < (master ? s->n_images : 1); m++) {
    PetscReal face[6];

    if (master && s->images[m].left_out) continue;
    SearchFaceBox(dim, ElementGet(surface->faces[f].type)->nodes, x, master ? &s->images[m] : NULL, face);
    if (SearchBoxesMeet(face, box, dim, distance)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/*@
  SearchNearBox - finds this rank's faces of a surface of which an image comes within a distance of a box.

  Not collective

  Input Parameters:
+ s        - the search
. surface  - its master, or its slave, whose images do not count
. u        - local displacements (length)
. t        - load parameter, for rigid tools
. box      - lower then upper corner
- distance - the distance (length)

  Output Parameters:
+ n     - number of faces
- faces - the faces, in the order of blocks, to be freed with PetscFree()

  Note:
  The boxes of faces are compared with the box. A box without any point has no faces.
@*/
PetscErrorCode SearchNearBox(ContactSearch s, ContactSurface surface, const PetscReal *u, PetscReal t,
                             const PetscReal box[6], PetscReal distance, PetscInt *n, PetscInt **faces)
{
  PetscReal x[FACE_MAX_NODES * 3];
  PetscInt  count = 0, *near;

  PetscFunctionBeginUser;
  *n = 0;
  if (box[0] > box[3]) {
    PetscCall(PetscMalloc1(0, faces));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(NearBlocks(s, surface, u, t, box, distance, &count, &near));
  for (PetscInt i = 0; i < count; i++) {
    SearchFacePositions(s, surface, near[i], u, t, x);
    if (FaceMeets(s, surface, near[i], x, box, distance)) near[(*n)++] = near[i];
  }
  *faces = near;
  PetscFunctionReturn(PETSC_SUCCESS);
}
