/* Bodies that keep their volume exactly while supports and loads prescribe their whole surface. Their volume is
   enclosed: no displacement that is free changes it, so that the level of their pressure is free. EnclosedBodiesFind()
   marks them in the scene, before it is known which dofs are free. enclosed.h tells how they are solved. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode EnclosedBodiesFind(Mesh, Scene, const PetscBool *prescribed);
