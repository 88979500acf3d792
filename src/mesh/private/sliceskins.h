/* Groups of all outer faces of a body, before distribution. The file of the mesh has no such groups; they are made for
   contact pairs that ask for them by SceneBodySkin(). Faces on the axis of an axisymmetric scene, and on planes on
   which supports hold the normal displacement alone, do not belong to them: the body goes on there.

   SliceSkinsCount() counts the groups and SliceSkinsShare() makes them, without faces, on all ranks; SliceSkinsAdd()
   adds the faces. */
#pragma once
#include "slicemesh.h"

int            SliceSkinsCount(Scene);
PetscErrorCode SliceSkinsShare(Scene, Mesh, int first);
PetscErrorCode SliceSkinsAdd(Scene, SliceMesh *, Mesh, int first);
