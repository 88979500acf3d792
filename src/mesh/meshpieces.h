/* Connected pieces of the mesh: cells that are connected by nodes. A body may consist of several pieces; bodies that
   share nodes are one piece. MeshFindPieces() gives the piece of each local node. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshFindPieces(Mesh, PetscInt *n, PetscInt piece[]);
