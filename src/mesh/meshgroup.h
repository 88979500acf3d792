/* Physical groups, rigid tools and bodies by their names; the faces of a group. */
#pragma once
#include "mesh/meshdata.h"

/* The group of that name and at most that dimension, or refuses: names the key, says which groups there are.
 * Collective. */
PetscErrorCode MeshGetGroup(Mesh, Scene, const char *path, const char *key, const char *name, int dim, MeshGroup **);
/* Index of the group of exactly that dimension, or -1 */
int MeshFindGroup(Mesh, int dim, const char *name);
/* The meshed rigid tool of that name, or NULL */
MeshRigid *MeshFindRigid(Mesh, const char *name);
/* Index into scene->bodies of the deformable body (or of the rigid tool) of that name, or -1 */
int MeshFindBody(Scene, const char *name, PetscBool rigid);
/* Nodes and type of face f of a group, in the face's own node order (outward) */
ElementType MeshFaceNodes(Mesh, const MeshGroup *, PetscInt f, PetscInt nodes[FACE_MAX_NODES]);
/* Name of the DM's label that marks the points of the group's nodes with 1 */
void MeshGroupLabel(Mesh, const MeshGroup *, char label[MESH_TEXT]);
