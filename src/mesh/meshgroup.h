/* Physical groups, rigid tools and bodies by their names, and the faces of a group. MeshGetGroup() finds the group that
   the user named and refuses a wrong name. MeshFindGroup(), MeshFindRigid() and MeshFindBody() only search.
   MeshFaceNodes() returns the nodes of one face. MeshGroupsMeet() tells whether two groups have a node in common.
   MeshGroupLabel() names the label of a group.
   MeshAddNote() keeps a line for the first lines of a run. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode MeshGetGroup(Mesh, Scene, const char *path, const char *key, const char *name, int dim, MeshGroup **);
int            MeshFindGroup(Mesh, int dim, const char *name);
MeshRigid     *MeshFindRigid(Mesh, const char *name);
int            MeshFindBody(Scene, const char *name, PetscBool rigid);
ElementType    MeshFaceNodes(Mesh, const MeshGroup *, PetscInt f, PetscInt nodes[FACE_MAX_NODES]);
PetscErrorCode MeshGroupsMeet(Mesh, const MeshGroup *, const MeshGroup *, PetscBool *meet);
void           MeshGroupLabel(Mesh, const MeshGroup *, char label[MESH_TEXT]);
PetscErrorCode MeshAddNote(Mesh, const char *text);
