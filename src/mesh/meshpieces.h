/* Connected pieces of the mesh: cells that hang together by nodes. A body may be several pieces, bodies that share
 * nodes are one. */
#pragma once
#include "mesh/meshdata.h"

/* *n pieces in the order of their lowest node; piece[n_nodes] (room given by the caller): which one each local node
 * belongs to. Collective. */
PetscErrorCode MeshFindPieces(Mesh, PetscInt *n, PetscInt piece[]);
