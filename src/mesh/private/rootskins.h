/* Groups of all outer faces of a body, before distribution. The file of the mesh has no such groups; they are made for
   contact pairs that ask for them by SceneBodySkin(). Faces on the axis of an axisymmetric scene, and on planes on
   which supports hold the normal displacement alone, do not belong to them: the body goes on there.

   RootSkinsCount() counts the groups and RootSkinsShare() makes them, without faces, on all ranks; RootSkinsAdd() adds
   the faces on rank 0. */
#pragma once
#include "rootmesh.h"

int            RootSkinsCount(Scene);
PetscErrorCode RootSkinsShare(Scene, Mesh, int first);
PetscErrorCode RootSkinsAdd(Scene, RootMesh *, Mesh, int first);
