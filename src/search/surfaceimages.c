/* Mirror images of a contact pair: the planes of symmetry that the scene names, or those that its supports show, the
   axis, and their products. */
#include "search/surface.h"
#include "base/refusal.h"

/* The deviation of a plane of symmetry from flatness, and of its normal from an axis, may reach this fraction of the
   model's size. It is the round-off of a CAD kernel. */
#define SURFACE_FLATNESS 1e-6

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

/* Does a support fix this displacement component on the surface? */
static PetscBool SupportHolds(Scene scene, const char *surface, int component)
{
  for (int s = 0; s < scene->n_supports; s++)
    if (!strcmp(scene->supports[s].surface, surface) && scene->supports[s].fixed[component]) return PETSC_TRUE;
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

/*@
  SurfaceImages - makes the mirror images of a pair's master: the identity, each plane of symmetry and all their
  products.

  Collective

  Input Parameters:
+ mesh    - the mesh
. scene   - the scene
- contact - gives the planes of symmetry

  Output Parameters:
+ n_images - number of images
- images   - images[SURFACE_MAX_IMAGES], in coordinates relative to the mesh's centre

  Note:
  In axisymmetric scenes the axis r = 0 is always a plane of symmetry. Refuses surfaces that are not planar and
  normal to an axis, surfaces that no support holds in that direction, and a third plane normal to one axis.
@*/
PetscErrorCode SurfaceImages(Mesh mesh, Scene scene, const SceneContact *contact, int *n_images,
                             SurfaceImage images[SURFACE_MAX_IMAGES])
{
  int taken[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  *n_images = 1;
  images[0] = (SurfaceImage){.sign = {1, 1, 1}};
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) {
    ImagesAddPlane(0, -mesh->centre[0], n_images, images);
    taken[0] = 1;
  }
  for (int s = 0; s < contact->n_symmetry; s++) {
    const char *name = contact->symmetry[s];
    MeshGroup  *group;
    PetscReal   position = 0;
    int         axis;

    PetscCall(MeshGetGroup(mesh, scene, contact->path, "symmetry", name, mesh->dim - 1, &group));
    PetscCall(GroupPlane(mesh, group, &axis, &position));
    if (axis < 0)
      PetscCall(RefuseInput(
        mesh->comm,
        "%s: '%s' is not a plane normal to a coordinate axis; allowed: planar surfaces x, y or z = constant",
        SceneWhere(scene, contact->path, "symmetry"), name));
    if (!SupportHolds(scene, name, axis)) {
      PetscCall(RefuseInput(mesh->comm,
                            "%s: no support holds u%c on '%s', so it is no plane of symmetry; allowed: surfaces whose "
                            "normal displacement a support fixes",
                            SceneWhere(scene, contact->path, "symmetry"), "xyz"[axis], name));
    }
    if (ImagesHavePlane(axis, position, mesh->size, *n_images, images)) continue;
    if (taken[axis] == SURFACE_AXIS_PLANES)
      PetscCall(RefuseInput(
        mesh->comm, "%s: '%s' is a third plane normal to %c; allowed: two planes for each axis (the axis r = 0 is one)",
        SceneWhere(scene, contact->path, "symmetry"), name, "xyz"[axis]));
    taken[axis]++;
    ImagesAddPlane(axis, position, n_images, images);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceOnPlane - says whether a position lies on the plane of an image.

  Not collective

  Input Parameters:
+ mesh  - the mesh, whose size is the scale
. image - an image of one plane
- x     - position x[dim], relative to the mesh's centre (length)
@*/
PetscBool SurfaceOnPlane(Mesh mesh, const SurfaceImage *image, const PetscReal *x)
{
  for (int d = 0; d < mesh->dim; d++)
    if (PetscAbsReal(image->sign[d] * x[d] + image->shift[d] - x[d]) > SURFACE_FLATNESS * mesh->size)
      return PETSC_FALSE;
  return PETSC_TRUE;
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
