/* Mirror images of a contact pair: the planes of symmetry that the scene names, or those that its supports show, the
   axis, and their products. */
#include "search/surface.h"
#include "base/refusal.h"
#include "kernels/elementkernel.h"

/* A surface continues smoothly beyond a plane if it turns there, between its last face and the image of that, by no
   more than this many times what its faces turn next to the plane, and by this angle (radians): the rounding of chords.
 */
#define SURFACE_SMOOTHNESS  2
#define SURFACE_SMOOTH_TURN 0.02

/* Finds the axis to which a planar group is normal, and its position. The axis is -1 if there is none. */
static PetscErrorCode GroupPlane(Mesh mesh, const MeshGroup *group, int *axis, PetscReal *position)
{
  PetscReal range[6]; /* -min and max of each component, over all ranks */

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) range[k] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    for (int d = 0; d < mesh->dim; d++) {
      const PetscReal x = mesh->coords[group->nodes[i] * mesh->dim + d];

      range[2 * d]     = PetscMax(range[2 * d], -x);
      range[2 * d + 1] = PetscMax(range[2 * d + 1], x);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 6, MPIU_REAL, MPI_MAX, mesh->comm));
  *axis = -1;
  for (int d = 0; d < mesh->dim; d++) {
    if (range[2 * d] + range[2 * d + 1] > SURFACE_FLATNESS * mesh->size) continue;
    *axis     = d;
    *position = 0.5 * (range[2 * d + 1] - range[2 * d]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the planes normal to an axis on which all of a group lies: one, or two where each of its faces is on either.
 *n: how many, 0 if there are none. */
static PetscErrorCode GroupPlanes(Mesh mesh, const MeshGroup *group, int axis, int *n, PetscReal position[2])
{
  const PetscReal flat     = SURFACE_FLATNESS * mesh->size;
  PetscReal       range[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL}; /* -min and max, over all ranks */
  int             between  = !group->attached;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    const PetscReal x = mesh->coords[group->nodes[i] * mesh->dim + axis];

    range[0] = PetscMax(range[0], -x);
    range[1] = PetscMax(range[1], x);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, mesh->comm));
  for (PetscInt f = 0; f < group->n_faces; f++) {
    PetscInt       nodes[FACE_MAX_NODES];
    const Element *e = ElementGet(MeshFaceNodes(mesh, group, f, nodes));

    for (int a = 0; a < e->nodes; a++) {
      const PetscReal x = mesh->coords[nodes[a] * mesh->dim + axis], first = mesh->coords[nodes[0] * mesh->dim + axis];

      between = between || PetscAbsReal(x - first) > flat || PetscMin(x + range[0], range[1] - x) > flat;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &between, 1, MPI_INT, MPI_LOR, mesh->comm));
  *n          = range[0] + range[1] <= flat ? 1 : between ? 0 : 2;
  position[0] = *n == 1 ? 0.5 * (range[1] - range[0]) : -range[0];
  position[1] = range[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a support fix this displacement component on the surface, all the time? */
static PetscBool SupportHolds(Scene scene, const char *surface, int component)
{
  for (int s = 0; s < scene->n_supports; s++)
    if (!strcmp(scene->supports[s].surface, surface) && scene->supports[s].fixed[component] &&
        !scene->supports[s].during.some)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Do the images contain this plane already? Two surfaces may lie on one plane, and the axis r = 0 is always there. */
static PetscBool ImagesHavePlane(int axis, PetscReal position, PetscReal size, int n, const SurfaceImage *images)
{
  for (int bit = 1; bit < n; bit <<= 1)
    if (images[bit].sign[axis] < 0 && PetscAbsReal(images[bit].shift[axis] - 2 * position) <= SURFACE_FLATNESS * size)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Doubles the set of images by one more plane. */
static void ImagesAddPlane(int axis, PetscReal position, int *n, SurfaceImage *images)
{
  for (int i = 0; i < *n; i++) {
    SurfaceImage image = images[i];

    image.left_out    = (PetscBool)(image.left_out || image.sign[axis] < 0);
    image.sign[axis]  = -1;
    image.shift[axis] = 2 * position;
    image.reverses    = (PetscBool)!image.reverses;
    images[*n + i]    = image;
  }
  *n *= 2;
}

/* Does a surface of an axisymmetric pair have a node on the axis? */
static PetscErrorCode PairMeetsAxis(Mesh mesh, Scene scene, ContactSurface slave, ContactSurface master,
                                    PetscBool *meets)
{
  const ContactSurface side[] = {slave, master};
  int                  found  = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2 && scene->geometry == GEOMETRY_AXISYMMETRIC; i++) {
    for (PetscInt f = 0; side[i] && f < side[i]->n_faces; f++) {
      const Facet     *face   = &side[i]->faces[f];
      const PetscReal *coords = side[i]->rigid ? side[i]->rigid->coords : mesh->coords;

      for (int a = 0; a < ElementGet(face->type)->corners; a++)
        found = found || coords[face->nodes[a] * mesh->dim] + mesh->centre[0] <= SURFACE_FLATNESS * mesh->size;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_LOR, mesh->comm));
  *meets = found ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceImages - makes the mirror images of a pair's master: the identity, each plane of symmetry and all their
  products.

  Collective

  Input Parameters:
+ mesh    - the mesh
. scene   - the scene
. contact - gives the planes of symmetry
. slave   - the slave surface
- master  - the master surface, or NULL

  Output Parameters:
+ n_images - number of images
- images   - images[SURFACE_MAX_IMAGES], in coordinates relative to the mesh's centre

  Note:
  In axisymmetric scenes the axis r = 0 is the first plane of symmetry of surfaces that meet it. Refuses surfaces that
are not planar and normal to an axis, surfaces that no support holds in that direction, and a third plane normal to one
axis.
@*/
PetscErrorCode SurfaceImages(Mesh mesh, Scene scene, const SceneContact *contact, ContactSurface slave,
                             ContactSurface master, int *n_images, SurfaceImage images[SURFACE_MAX_IMAGES])
{
  int       taken[3] = {0, 0, 0};
  PetscBool axis;

  PetscFunctionBeginUser;
  *n_images = 1;
  images[0] = (SurfaceImage){.sign = {1, 1, 1}};
  PetscCall(PairMeetsAxis(mesh, scene, slave, master, &axis));
  if (axis) {
    ImagesAddPlane(0, -mesh->centre[0], n_images, images);
    taken[0] = 1;
  }
  for (int s = 0; s < contact->n_symmetry; s++) {
    const char *name = contact->symmetry[s];
    MeshGroup  *group;
    PetscReal   position = 0;
    int         normal;

    PetscCall(MeshGetGroup(mesh, scene, contact->path, "symmetry", name, mesh->dim - 1, &group));
    PetscCall(GroupPlane(mesh, group, &normal, &position));
    if (normal < 0)
      PetscCall(RefuseInput(
        mesh->comm,
        "%s: '%s' is not a plane normal to a coordinate axis; allowed: planar surfaces x, y or z = constant",
        SceneWhere(scene, contact->path, "symmetry"), name));
    if (!SupportHolds(scene, name, normal)) {
      PetscCall(RefuseInput(mesh->comm,
                            "%s: no support holds u%c on '%s', so it is no plane of symmetry; allowed: surfaces whose "
                            "normal displacement a support fixes",
                            SceneWhere(scene, contact->path, "symmetry"), "xyz"[normal], name));
    }
    if (ImagesHavePlane(normal, position, mesh->size, *n_images, images)) continue;
    if (taken[normal] == SURFACE_AXIS_PLANES)
      PetscCall(RefuseInput(
        mesh->comm, "%s: '%s' is a third plane normal to %c; allowed: two planes for each axis (the axis r = 0 is one)",
        SceneWhere(scene, contact->path, "symmetry"), name, "xyz"[normal]));
    taken[normal]++;
    ImagesAddPlane(normal, position, n_images, images);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is this the only component of the displacement that supports fix on the surface? */
static PetscBool SupportSlides(Scene scene, const char *surface, int component)
{
  PetscBool slides = SupportHolds(scene, surface, component);

  for (int d = 0; d < scene->dim; d++)
    slides = (PetscBool)(slides && (d == component || !SupportHolds(scene, surface, d)));
  return slides;
}

/* Does a rigid tool move across planes normal to an axis, or turn? */
static PetscBool ToolCrosses(const Motion *motion, int axis)
{
  for (int k = 0; k < motion->n; k++)
    if (motion->components[k].component == axis || motion->components[k].component >= 3) return PETSC_TRUE;
  for (int k = 0; k < MOTION_COMPONENTS; k++)
    if (motion->free[k] && (k == axis || k >= 3)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What a surface does at a plane; of all ranks. */
typedef struct {
  PetscReal below, above; /* how far its nodes are on either side (length) */
  int       ends;         /* it has an edge there */
  int       leaves;       /* such an edge is free to leave the plane */
  int       turns;        /* its image turns away from such an edge */
} PlaneEnd;

/* Angle between a face and its image. */
static PetscReal ImageTurn(ContactSurface surface, const Facet *face, const PetscReal *coords, int axis)
{
  const int dim                  = surface->mesh->dim;
  double    area[FACE_MAX_NODES] = {0}, normal[FACE_MAX_NODES * 3] = {0}, X[FACE_MAX_NODES * 3];
  PetscReal sum[3] = {0, 0, 0};

  for (int a = 0; a < ElementGet(face->type)->nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = coords[face->nodes[a] * dim + d];
  FaceAreaKernel(face->type, dim, dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, normal);
  for (int a = 0; a < ElementGet(face->type)->nodes; a++)
    for (int d = 0; d < dim; d++) sum[d] += normal[a * dim + d];
  return 2 * PetscAsinReal(PetscMin(1, PetscAbsReal(sum[axis]) /
                                         PetscSqrtReal(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2])));
}

/* Finds what a surface does at a plane. held[] and turn[] are of the mesh's nodes; a tool has none. */
static PetscErrorCode SurfaceAtPlane(ContactSurface surface, int axis, PetscReal position, const PetscBool *held,
                                     const PetscReal *turn, PlaneEnd *end)
{
  const PetscReal *coords  = surface->rigid ? surface->rigid->coords : surface->mesh->coords;
  const PetscReal  flat    = SURFACE_FLATNESS * surface->mesh->size;
  PetscReal        most[5] = {0, 0, 0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];
    PetscReal    bend = 0;
    int          on   = 0;
    PetscBool    free = PETSC_FALSE;

    for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
      const PetscReal x = coords[face->nodes[a] * surface->mesh->dim + axis] - position;

      most[0] = PetscMax(most[0], -x);
      most[1] = PetscMax(most[1], x);
      if (surface->group) bend = PetscMax(bend, turn[face->nodes[a]]);
      if (a >= ElementGet(face->type)->corners || PetscAbsReal(x) > flat) continue;
      on++;
      free = (PetscBool)(free || (surface->group && !held[face->nodes[a]]));
    }
    if (on < surface->mesh->dim - 1) continue;
    most[2] = 1;
    if (free) most[3] = 1;
    /* Nodes' turn is half of that between their faces. A tool's own turn is not known. */
    if (surface->group && ImageTurn(surface, face, coords, axis) > SURFACE_SMOOTH_TURN + 2 * SURFACE_SMOOTHNESS * bend)
      most[4] = 1;
  }
  if (surface->group) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 5, MPIU_REAL, MPI_MAX, surface->mesh->comm));
  *end = (PlaneEnd){most[0], most[1], most[2] > 0, most[3] > 0, most[4] > 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of which supports fix a component all the time. */
static PetscErrorCode HeldNodes(Mesh mesh, Scene scene, int component, PetscBool *held)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(held, mesh->n_nodes));
  for (int s = 0; s < scene->n_supports; s++) {
    for (int dim = 0; dim < mesh->dim && scene->supports[s].fixed[component] && !scene->supports[s].during.some;
         dim++) {
      const int g = MeshFindGroup(mesh, dim, scene->supports[s].surface);

      for (PetscInt i = 0; g >= 0 && i < mesh->groups[g].n_nodes; i++) held[mesh->groups[g].nodes[i]] = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do slave and master continue beyond a plane as their images? Where asked, they have to do so smoothly. */
static PetscErrorCode PairContinues(Mesh mesh, Scene scene, ContactSurface slave, ContactSurface master, int axis,
                                    PetscReal position, PetscBool smoothly, PetscBool *continues)
{
  ContactSurface  side[] = {slave, master};
  const PetscReal flat   = SURFACE_FLATNESS * mesh->size;
  PetscReal      *size, *turn, *share;
  PetscBool      *held;
  PlaneEnd        whole = {0, 0, 0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(mesh->n_nodes, &size, mesh->n_nodes, &turn, mesh->n_nodes, &share, mesh->n_nodes, &held));
  PetscCall(HeldNodes(mesh, scene, axis, held));
  for (int i = 0; i < 2; i++) {
    PlaneEnd end;

    if (!side[i]) continue;
    if (side[i]->group) PetscCall(SurfaceNodeSizes(side[i], scene->geometry, 0, NULL, size, turn, share));
    PetscCall(SurfaceAtPlane(side[i], axis, position, held, turn, &end));
    if (side[i]->rigid) end.leaves = ToolCrosses(&scene->bodies[side[i]->body].motion, axis);
    whole.below  = PetscMax(whole.below, end.below);
    whole.above  = PetscMax(whole.above, end.above);
    whole.ends   = whole.ends || end.ends;
    whole.leaves = whole.leaves || end.leaves || (smoothly && end.turns);
  }
  *continues = (PetscBool)(whole.ends && !whole.leaves && PetscMin(whole.below, whole.above) <= flat);
  PetscCall(PetscFree4(size, turn, share, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a plane that a support shows, if slave and master continue beyond it, and unless there are two already. */
static PetscErrorCode AddPlaneOfSupport(Mesh mesh, Scene scene, ContactSurface slave, ContactSurface master, int axis,
                                        PetscReal position, PetscBool smoothly, int *n_images,
                                        SurfaceImage images[SURFACE_MAX_IMAGES])
{
  PetscBool continues = PETSC_FALSE;
  int       taken     = 0;

  PetscFunctionBeginUser;
  for (int bit = 1; bit < *n_images; bit <<= 1) taken += images[bit].sign[axis] < 0;
  if (taken == SURFACE_AXIS_PLANES || ImagesHavePlane(axis, position, mesh->size, *n_images, images))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PairContinues(mesh, scene, slave, master, axis, position, smoothly, &continues));
  if (continues) ImagesAddPlane(axis, position, n_images, images);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceImagesFromSupports - adds the planes of symmetry that the supports show.

  Collective

  Input Parameters:
+ mesh   - the mesh
. scene  - the scene
. slave  - the slave surface
- master - the master surface, or NULL

  Input/Output Parameters:
+ n_images - number of mirror images
- images   - of SurfaceImages()

  Note:
  Such a plane is one on which a support fixes the normal displacement and nothing else, at which slave or master end
  square to it, and beyond which neither of them reaches. Both ends of a strip may be one surface of a support. A fit
that ended there would hand the slave's forces wrongly to the master's nodes. A wall r = constant of an axisymmetric
scene is such a plane too.
@*/
PetscErrorCode SurfaceImagesFromSupports(Mesh mesh, Scene scene, ContactSurface slave, ContactSurface master,
                                         PetscBool smoothly, int *n_images, SurfaceImage images[SURFACE_MAX_IMAGES])
{
  PetscFunctionBeginUser;
  for (int s = 0; s < scene->n_supports; s++) {
    const char *name = scene->supports[s].surface;
    const int   g    = MeshFindGroup(mesh, mesh->dim - 1, name);
    PetscReal   position[2];
    int         axis = 0, n;

    while (axis < mesh->dim && !SupportSlides(scene, name, axis)) axis++;
    if (g < 0 || axis == mesh->dim) continue;
    PetscCall(GroupPlanes(mesh, &mesh->groups[g], axis, &n, position));
    for (int k = 0; k < n; k++)
      PetscCall(AddPlaneOfSupport(mesh, scene, slave, master, axis, position[k], smoothly, n_images, images));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceImageBeyondAxis - tells whether an image of an axisymmetric scene lies beyond the axis, at negative radii.

  Not collective

  Input Parameter:
. image - the image
@*/
PetscBool SurfaceImageBeyondAxis(const SurfaceImage *image)
{
  return (PetscBool)(image->sign[0] < 0 && image->shift[0] == 0);
}

/*@
  SurfaceReflect - computes the mirror image of a position.

  Not collective

  Input Parameters:
+ image - the image
. dim   - 2 or 3
- x     - position x[dim] (length)

  Output Parameter:
. y - its mirror image y[dim]; may be the same array as x
@*/
void SurfaceReflect(const SurfaceImage *image, int dim, const PetscReal *x, PetscReal *y)
{
  for (int d = 0; d < dim; d++) y[d] = image->sign[d] * x[d] + image->shift[d];
}
