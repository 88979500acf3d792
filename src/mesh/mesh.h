/* The distributed mesh: a DMPlex that is made from gmsh's file, partitioned by METIS, with the reference coordinates of
   every node, physical groups by name, and gmsh's tags as keys that do not depend on the number of ranks. It knows no
   physics. MeshGenerate() makes the file, MeshCreate() reads, checks and distributes it, MeshDestroy() frees the mesh.

   The steps are these. gmsh.h makes the file. gmshfile.h reads it and shares it out. sliceread.h checks it against the
   scene. cellfaces.h finds the cells that share faces, slicemiddles.h checks middle nodes. slicegroups.h and
   slicerigid.h find groups and rigid tools. partition.h decides which rank gets which cell, and meshdistribution.h
   distributes the mesh. meshplex.h makes the DMPlex of what each rank has then, which numbers the unknowns. The headers
   that are included here are all that users of a mesh need besides. */
#pragma once
#include "mesh/meshdata.h"
#include "mesh/meshdofs.h"
#include "mesh/meshgroup.h"
#include "mesh/meshquality.h"

PetscErrorCode MeshGenerate(MPI_Comm, Scene, const char *directory, PetscBool trust, char *file, PetscReal *seconds);
PetscErrorCode MeshCreate(MPI_Comm, Scene, const char *file, Mesh *);
PetscErrorCode MeshDestroy(Mesh *);
void           MeshGatherNodes(Mesh, PetscInt n, const PetscInt nodes[], const PetscReal *values, PetscReal *gathered);
void           MeshCellCoordinates(Mesh, PetscInt cell, PetscReal *X);
void           MeshNodePlace(Mesh, PetscInt node, PetscReal X[3]);
