/* A viscous restraint of all bodies, for pseudo-time steps of a solve that static steps have failed at.

   In a pseudo-time step from the anchor a to x it has the force scale * V (x - a): springs at the dofs, whose weight V
   is a node's part of the volume of the bodies, so that the restraint does not depend on the mesh. scale is the
   viscosity per volume over the length of the pseudo-time step. The forces are constant over a step of the implicit
   Euler method, so that the work done against them is twice the energy of the springs. */
#pragma once
#include "bodies/dofsprings.h"
#include "scene/scene.h"

PetscErrorCode DampingCreate(Mesh, Scene, Vec like, DofSprings *);
