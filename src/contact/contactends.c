/* Ends and sharp edges of slaves: where they count, and finding them. */
#include "contactimpl.h"
#include "search/surfaceends.h"

/*@
  ContactSidesServe - says whether the sides of sharp edges have terms of their own.

  Not collective

  Input Parameter:
. pair - the pair

  Note:
  In node to surface contact a node is one point. A master that is softer than the slave bends around the slave's edges:
both sides of an edge then see the same part of it, and one mean over both holds the edge less stiffly. A rigid or a
stiffer master keeps its own shape, with its own corners.
@*/
PetscBool ContactSidesServe(const ContactPair *pair)
{
  if (!pair->formulation.surface) return PETSC_FALSE;
  return (PetscBool)(!pair->master || pair->master->rigid || pair->master->stiffness >= pair->slave->stiffness);
}

/*@
  ContactEndsFind - finds the ends of a pair's slave, so that its offsets heed them.

  Collective

  Input Parameters:
+ pair  - the pair, before its slave points are made
- scene - the scene

  Note:
  They serve where sides of sharp edges have terms. On planes of symmetry faces go on, whether the pair has images
beyond them or not.
@*/
PetscErrorCode ContactEndsFind(ContactPair *pair, Scene scene)
{
  SurfaceImage images[SURFACE_MAX_IMAGES];
  int          n_images = pair->n_images;

  PetscFunctionBeginUser;
  if (!ContactSidesServe(pair)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(images, pair->images, SURFACE_MAX_IMAGES));
  if (pair->scene->find_symmetry)
    PetscCall(SurfaceImagesFromSupports(pair->mesh, scene, pair->slave, pair->master, &n_images, images));
  PetscCall(SurfaceFindEnds(pair->slave, pair->fit.feature_angle, n_images, images));
  PetscFunctionReturn(PETSC_SUCCESS);
}
