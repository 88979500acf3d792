/* Meshed rigid tools: rank 0 gathers their faces and nodes and sends them to all ranks. */
#include "rootrigid.h"
#include "mesh/meshgroup.h"
#include "base/refusal.h"

/* Returns the sign with which group g contains the block, 0 if it does not contain it. */
static int BlockSign(const GmshBlock *block, int g)
{
  for (int i = 0; i < block->n_physicals; i++)
    if (block->physical[i] == g) return block->sign[i];
  return 0;
}

/* Counts the tool's faces and nodes. local returns the tool's nodes by ascending tag, -1 for other nodes of the file.
   Returns the length of face_nodes. */
static PetscInt RigidCount(const GmshMesh *gmsh, int g, MeshRigid *rigid, PetscInt local[])
{
  PetscInt n_entries = 0;

  for (PetscInt i = 0; i < gmsh->n_nodes; i++) local[i] = -1;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];

    if (!BlockSign(block, g)) continue;
    rigid->n_faces += block->n;
    n_entries += block->n * block->nodes;
    for (PetscInt k = 0; k < block->n * block->nodes; k++) local[block->connectivity[k]] = 0;
  }
  for (PetscInt i = 0; i < gmsh->n_nodes; i++)
    if (!local[i]) local[i] = rigid->n_nodes++;
  return n_entries;
}

static void RigidFaces(const GmshMesh *gmsh, int g, const PetscInt local[], MeshRigid *rigid)
{
  PetscInt f = 0, n = 0;

  rigid->face_ptr[0] = 0;
  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];
    const int        sign  = BlockSign(block, g);

    for (PetscInt item = 0; sign && item < block->n; item++) {
      const PetscInt *nodes = block->connectivity + item * block->nodes;

      rigid->face_type[f] = block->element->type;
      rigid->face_tag[f]  = block->tag[item];
      for (int k = 0; k < block->nodes; k++)
        rigid->face_nodes[n++] = local[nodes[sign < 0 ? RootMeshReversedNode(block->element, k) : k]];
      rigid->face_ptr[++f] = n;
    }
  }
}

static PetscErrorCode RigidGather(const RootMesh *root, int g, Mesh mesh, MeshRigid *rigid)
{
  const GmshMesh *gmsh = &root->gmsh;
  PetscInt       *local, n_entries;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(gmsh->n_nodes, &local));
  n_entries = RigidCount(gmsh, g, rigid, local);
  PetscCall(PetscMalloc2(rigid->n_nodes * mesh->dim, &rigid->coords, rigid->n_nodes, &rigid->node_tag));
  PetscCall(PetscMalloc4(rigid->n_faces, &rigid->face_type, rigid->n_faces + 1, &rigid->face_ptr, n_entries,
                         &rigid->face_nodes, rigid->n_faces, &rigid->face_tag));
  RigidFaces(gmsh, g, local, rigid);
  for (PetscInt i = 0; i < gmsh->n_nodes; i++) {
    if (local[i] < 0) continue;
    rigid->node_tag[local[i]] = gmsh->node_tag[i];
    for (int k = 0; k < mesh->dim; k++)
      rigid->coords[local[i] * mesh->dim + k] = gmsh->coords[3 * i + k] - mesh->centre[k];
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RigidShare(Mesh mesh, MeshRigid *rigid)
{
  PetscMPIInt rank, nodes, faces, entries;
  PetscInt    sizes[3];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (!rank) {
    sizes[0] = rigid->n_nodes;
    sizes[1] = rigid->n_faces;
    sizes[2] = rigid->face_ptr[rigid->n_faces];
  }
  PetscCallMPI(MPI_Bcast(sizes, 3, MPIU_INT, 0, mesh->comm));
  if (rank) {
    rigid->n_nodes = sizes[0];
    rigid->n_faces = sizes[1];
    PetscCall(PetscMalloc2(sizes[0] * mesh->dim, &rigid->coords, sizes[0], &rigid->node_tag));
    PetscCall(PetscMalloc4(sizes[1], &rigid->face_type, sizes[1] + 1, &rigid->face_ptr, sizes[2], &rigid->face_nodes,
                           sizes[1], &rigid->face_tag));
  }
  PetscCall(PetscMPIIntCast(sizes[0] * mesh->dim, &nodes));
  PetscCall(PetscMPIIntCast(sizes[1], &faces));
  PetscCall(PetscMPIIntCast(sizes[2], &entries));
  PetscCallMPI(MPI_Bcast(rigid->coords, nodes, MPIU_REAL, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->node_tag, nodes / mesh->dim, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_type, faces * (PetscMPIInt)sizeof(*rigid->face_type), MPI_BYTE, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_ptr, faces + 1, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_nodes, entries, MPIU_INT, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(rigid->face_tag, faces, MPIU_INT, 0, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootRigidCreate - creates the scene's meshed rigid tools, whole on every rank.

  Collective

  Input Parameters:
+ scene - its rigid bodies
. root  - on rank 0; NULL on other ranks
- mesh  - with groups, centre and dimension; its rigid tools are set

  Note:
  Refuses a tool whose surface group is not in the mesh. A minus sign in front of an entity in the group reverses the
  normals of its faces.
@*/
PetscErrorCode RootRigidCreate(Scene scene, const RootMesh *root, Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &mesh->rigid));
  for (int b = 0; b < scene->n_bodies; b++) {
    const int g = MeshFindGroup(mesh, mesh->dim - 1, scene->bodies[b].name);

    if (!scene->bodies[b].rigid) continue;
    if (g < 0) {
      PetscCall(RefuseInput(mesh->comm, "%s: the mesh has no surface group '%s' for this rigid tool",
                            SceneWhere(scene, scene->bodies[b].path, "surface"), scene->bodies[b].name));
    }
    MeshRigid *rigid = &mesh->rigid[mesh->n_rigid++];

    PetscCall(PetscStrallocpy(scene->bodies[b].name, &rigid->name));
    if (root) PetscCall(RigidGather(root, g, mesh, rigid));
    PetscCall(RigidShare(mesh, rigid));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RootRigidDestroy - frees the rigid tools of a mesh.

  Not collective

  Input Parameter:
. mesh - the mesh
@*/
PetscErrorCode RootRigidDestroy(Mesh mesh)
{
  PetscFunctionBeginUser;
  for (int r = 0; r < mesh->n_rigid; r++) {
    MeshRigid *rigid = &mesh->rigid[r];

    PetscCall(PetscFree(rigid->name));
    PetscCall(PetscFree2(rigid->coords, rigid->node_tag));
    PetscCall(PetscFree4(rigid->face_type, rigid->face_ptr, rigid->face_nodes, rigid->face_tag));
  }
  PetscCall(PetscFree(mesh->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
