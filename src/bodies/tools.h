/* Rigid tools with free motions, and bolts that are tightened: their unknowns in the displacements, and the forces on
   them.

   The unknowns are displacements of the tools' nodes (MeshTool), so that vectors, checkpoints and Newton's method treat
   them like others. ToolsConstrain() marks their components that are not free, ToolsPrescribe() writes these.
   ToolsPlace() and ToolMove() move the tools to given displacements, ToolsAccept() makes these the accepted ones.
   ToolDof() tells where a component stands, ToolGetPlace() where a tool's point is and how it is turned.
   ToolsTurn() tells how far they turn from one state to another. ToolsResidual() subtracts the forces on the tools.
   ToolsTangent() adds what keeps the length of bolts, which have unknowns of the same kind.
   ToolOfPair() finds the tool that is the master of a contact pair, ToolOfBolt() the unknown of a bolt.
 */
#pragma once
#include "bodies/elasticity.h"

void           ToolsConstrain(Mesh, PetscBool *constrained);
void           ToolsPrescribe(Mesh, PetscReal t, PetscReal *u);
void           ToolMove(Mesh, const MeshTool *, const PetscReal *own, PetscReal t);
void           ToolsPlace(Mesh, const PetscReal *u, PetscReal t);
void           ToolsAccept(Mesh, const PetscReal *u, PetscReal t);
void           ToolsResidual(Mesh, PetscReal t, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2);
PetscReal      ToolsTurn(Mesh, const PetscReal *u_0, const PetscReal *u, const MeshTool **);
PetscErrorCode ToolsTangent(Mesh, PetscReal t, Elasticity);
const MeshTool *ToolOfPair(Mesh, Scene, int contact);
const MeshTool *ToolOfBolt(Mesh, const char *body);
int             ToolDof(Mesh, int component);
void            ToolGetPlace(Mesh, const MeshTool *, const PetscReal *own, PetscReal point[3], PetscReal turn[3]);
