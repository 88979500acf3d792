/* Bodies that hang together by single nodes or edges, without a common face: the mesh joins them, but they turn about
   what they share. Mostly a mesher has merged points in which two bodies only touch.

   HingesWarn() finds and names them. */
#pragma once
#include "mesh/mesh.h"
#include "scene/scene.h"

PetscErrorCode HingesWarn(Mesh, Scene, FILE *);
