/* The distributed mesh: a DMPlex from gmsh, partitioned by METIS, with every node's reference coordinates, physical
   groups by name, and gmsh's tags as rank-independent keys. Knows no physics.

   How it comes about: gmsh.h makes the file, gmshfile.h reads it on rank 0, rootmesh.h checks it against the scene,
   cellfaces.h finds which cells share faces, roottopology.h, rootgroups.h and rootrigid.h make a DMPlex, groups and
   rigid tools of it, meshdistribution.h shares it out. The headers included here are the rest of what users of a mesh
   need. */
#pragma once
#include "mesh/meshdata.h"
#include "mesh/meshdofs.h"
#include "mesh/meshgroup.h"
#include "mesh/meshquality.h"

/* gmsh: .geo -> .msh (once, into DIR/mesh-HASH.msh); a .msh is returned as it is. file has room for PETSC_MAX_PATH_LEN.
 * Collective. */
PetscErrorCode MeshGenerate(MPI_Comm, Scene, const char *directory, char *file, PetscReal *seconds);
/* Reads, checks and distributes a .msh file. Collective. */
PetscErrorCode MeshCreate(MPI_Comm, Scene, const char *file, Mesh *);
/* Frees a mesh. Collective. */
PetscErrorCode MeshDestroy(Mesh *);
/* values (n_nodes*dim, such as mesh->coords or displacements) of n nodes, one after the other: gathered[n*dim] */
void MeshGatherNodes(Mesh, PetscInt n, const PetscInt nodes[], const PetscReal *values, PetscReal *gathered);
/* Reference coordinates X[nodes*dim] of a local cell's nodes, as the element kernels want them */
void MeshCellCoordinates(Mesh, PetscInt cell, PetscReal *X);
/* Reference coordinates of a local node as the user knows them, for messages: 3 of them, what is round-off is 0 */
void MeshNodePlace(Mesh, PetscInt node, PetscReal X[3]);
