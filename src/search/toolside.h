/* The side of a meshed rigid tool on which the slave starts. A tool has no volume, so that nothing in its mesh says
   where its inside is, and the curves of a groove often run in different directions.

   ToolSideFind() makes the normals of each connected piece of the tool consistent and turns them to the slave.
   ToolSideFlip() turns all normals of a tool. */
#pragma once
#include "bodies/loads.h"
#include "search/facequadrature.h"
#include "search/surface.h"

PetscErrorCode ToolSideFind(ContactSurface tool, ContactSurface slave, Loads, PetscInt *turned, PetscBool *decided);
void           ToolSideFlip(ContactSurface tool);
