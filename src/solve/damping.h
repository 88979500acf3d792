/* Springs at the dofs of all bodies, for steps that are damped. Their weight V is a node's part of the volume of the
   bodies, so that they do not depend on the mesh. A solve with shifted tangents takes their stiffness alone, as if they
   were anchored at each iterate. Tools and pressures of nodes have none. */
#pragma once
#include "bodies/dofsprings.h"
#include "scene/scene.h"

PetscErrorCode DampingCreate(Mesh, Scene, Vec like, DofSprings *);
