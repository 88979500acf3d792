/* Meshed rigid tools: all ranks gather their faces and nodes. */
#include "slicerigid.h"
#include "mesh/meshgroup.h"
#include "base/integerset.h"
#include "base/refusal.h"
#include "tooldivision.h"

/* Returns the sign with which group g contains the block, 0 if it does not contain it. */
static int BlockSign(const GmshBlock *block, int g)
{
  for (int i = 0; i < block->n_physicals; i++)
    if (block->physical[i] == g) return block->sign[i];
  return 0;
}

/* Gathers integers of all ranks, in the order of the ranks. */
static PetscErrorCode GatherIntegers(MPI_Comm comm, PetscInt n, const PetscInt mine[], PetscInt *n_all, PetscInt **all)
{
  PetscMPIInt size, count, *counts, *starts;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscMalloc2(size, &counts, size, &starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  *n_all = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(*n_all, &starts[r]));
    *n_all += counts[r];
  }
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPIU_INT, *all, counts, starts, MPIU_INT, comm));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of a face's record. The places of its nodes among gmsh's follow. */
enum { FACE_BLOCK, FACE_TYPE, FACE_TAG, FACE_HEADER };

/* Writes the records of the tool's faces of this rank. Returns the number of entries. */
static PetscInt LoadFaces(const GmshMesh *gmsh, int g, PetscInt *record)
{
  PetscInt n = 0;

  for (int b = 0; b < gmsh->n_blocks; b++) {
    const GmshBlock *block = &gmsh->blocks[b];
    const int        sign  = BlockSign(block, g);

    for (PetscInt item = 0; sign && item < block->n; item++, n += FACE_HEADER + block->nodes) {
      const PetscInt *nodes = block->connectivity + item * block->nodes;

      if (!record) continue;
      record[n + FACE_BLOCK] = b;
      record[n + FACE_TYPE]  = (PetscInt)block->element->type;
      record[n + FACE_TAG]   = block->tag[item];
      for (int k = 0; k < block->nodes; k++)
        record[n + FACE_HEADER + k] = nodes[sign < 0 ? SliceMeshReversedNode(block->element, k) : k];
    }
  }
  return n;
}

/* Entries of a record */
static PetscInt RecordLength(const PetscInt *record)
{
  return FACE_HEADER + ElementGet((ElementType)record[FACE_TYPE])->nodes;
}

/* Puts the records of all ranks in the order of the file: block by block, in each of them rank by rank. */
static PetscErrorCode SortRecords(int n_blocks, PetscInt n, const PetscInt records[], PetscInt sorted[])
{
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_blocks + 1, &next));
  for (PetscInt i = 0; i < n; i += RecordLength(&records[i]))
    next[records[i + FACE_BLOCK] + 1] += RecordLength(&records[i]);
  for (int b = 0; b < n_blocks; b++) next[b + 1] += next[b];
  for (PetscInt i = 0; i < n; i += RecordLength(&records[i])) {
    PetscInt *at = &next[records[i + FACE_BLOCK]];

    PetscCall(PetscArraycpy(&sorted[*at], &records[i], RecordLength(&records[i])));
    *at += RecordLength(&records[i]);
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers the records of a tool's faces, in the order of the file. */
static PetscErrorCode GatherFaces(const SliceMesh *slice, int g, PetscInt *n, PetscInt **records)
{
  const GmshMesh *gmsh   = &slice->gmsh;
  const PetscInt  n_mine = LoadFaces(gmsh, g, NULL);
  PetscInt       *mine, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_mine, &mine));
  LoadFaces(gmsh, g, mine);
  PetscCall(GatherIntegers(slice->comm, n_mine, mine, n, &all));
  PetscCall(PetscFree(mine));
  PetscCall(PetscMalloc1(*n, records));
  PetscCall(SortRecords(gmsh->n_blocks, *n, all, *records));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the tool's faces of their records. Their nodes are places among gmsh's yet. */
static PetscErrorCode CreateFaces(PetscInt n, const PetscInt records[], MeshRigid *rigid)
{
  PetscInt f = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i += RecordLength(&records[i])) rigid->n_faces++;
  PetscCall(PetscMalloc4(rigid->n_faces, &rigid->face_type, rigid->n_faces + 1, &rigid->face_ptr,
                         n - FACE_HEADER * rigid->n_faces, &rigid->face_nodes, rigid->n_faces, &rigid->face_tag));
  rigid->face_ptr[0] = 0;
  for (PetscInt i = 0; i < n; i += RecordLength(&records[i]), f++) {
    const PetscInt nodes = RecordLength(&records[i]) - FACE_HEADER;

    rigid->face_type[f]    = (ElementType)records[i + FACE_TYPE];
    rigid->face_tag[f]     = records[i + FACE_TAG];
    rigid->face_ptr[f + 1] = rigid->face_ptr[f] + nodes;
    PetscCall(PetscArraycpy(rigid->face_nodes + rigid->face_ptr[f], &records[i + FACE_HEADER], nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the tool's nodes, by ascending tag, and numbers them in the faces. */
static PetscErrorCode CreateNodes(const SliceMesh *slice, Mesh mesh, MeshRigid *rigid)
{
  const GmshMesh       *gmsh  = &slice->gmsh;
  const PetscInt        n     = rigid->face_ptr[rigid->n_faces];
  const PetscInt *const nodes = rigid->face_nodes;
  IntegerSet            places;
  PetscReal            *x;
  PetscSF               sf;
  MPI_Datatype          place;

  PetscFunctionBeginUser;
  PetscCall(IntegerSetCreate(1, &n, &nodes, &places));
  rigid->n_nodes = places.n;
  for (PetscInt k = 0; k < n; k++) rigid->face_nodes[k] = IntegerSetPlace(&places, rigid->face_nodes[k]);
  PetscCall(PetscMalloc2(rigid->n_nodes * mesh->dim, &rigid->coords, rigid->n_nodes, &rigid->node_tag));
  PetscCall(PetscMalloc1(3 * rigid->n_nodes, &x));
  PetscCall(SliceMeshSF(slice, gmsh->node_start, places.n, places.value, &sf));
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &place));
  PetscCallMPI(MPI_Type_commit(&place));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, gmsh->node_tag, rigid->node_tag, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, gmsh->node_tag, rigid->node_tag, MPI_REPLACE));
  PetscCall(PetscSFBcastBegin(sf, place, gmsh->coords, x, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, place, gmsh->coords, x, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&place));
  PetscCall(PetscSFDestroy(&sf));
  for (PetscInt i = 0; i < rigid->n_nodes; i++)
    for (int k = 0; k < mesh->dim; k++) rigid->coords[i * mesh->dim + k] = x[3 * i + k] - mesh->centre[k];
  PetscCall(PetscFree(x));
  PetscCall(IntegerSetDestroy(&places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tags of nodes and faces that the file does not have: the next ones of both. */
static PetscErrorCode NextTags(const SliceMesh *slice, PetscInt tags[2])
{
  const GmshMesh *gmsh    = &slice->gmsh;
  PetscInt        last[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < gmsh->n_nodes; i++) last[0] = PetscMax(last[0], gmsh->node_tag[i]);
  for (int b = 0; b < gmsh->n_blocks; b++)
    for (PetscInt i = 0; i < gmsh->blocks[b].n; i++) last[1] = PetscMax(last[1], gmsh->blocks[b].tag[i]);
  PetscCallMPI(MPI_Allreduce(last, tags, 2, MPIU_INT, MPI_MAX, slice->comm));
  for (int k = 0; k < 2; k++) tags[k]++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceRigidCreate - creates the scene's meshed rigid tools, whole on every rank.

  Collective

  Input Parameters:
+ scene - its rigid bodies
. slice - after SliceRead()
- mesh  - with groups, centre and dimension; its rigid tools are set

  Note:
  Refuses a tool whose surface group is not in the mesh. A minus sign in front of an entity in the group reverses the
  normals of its faces. Long faces beside short ones are divided, see tooldivision.h.
@*/
PetscErrorCode SliceRigidCreate(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscInt n, *records, tags[2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &mesh->rigid));
  for (int b = 0; b < scene->n_bodies; b++) {
    const int g = MeshFindGroup(mesh, mesh->dim - 1, scene->bodies[b].name);

    if (!scene->bodies[b].rigid) continue;
    if (g < 0) {
      PetscCall(RefuseInput(mesh->comm, "%s: the mesh has no surface group '%s' for this rigid tool",
                            SceneWhere(scene, scene->bodies[b].path, "surface"), scene->bodies[b].name));
    }
    if (!mesh->n_rigid) PetscCall(NextTags(slice, tags));
    MeshRigid *rigid = &mesh->rigid[mesh->n_rigid++];

    PetscCall(PetscStrallocpy(scene->bodies[b].name, &rigid->name));
    PetscCall(GatherFaces(slice, g, &n, &records));
    PetscCall(CreateFaces(n, records, rigid));
    PetscCall(PetscFree(records));
    PetscCall(CreateNodes(slice, mesh, rigid));
    rigid->n_given = rigid->n_faces;
    PetscCall(ToolDivide(mesh->dim, rigid, &tags[0], &tags[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceRigidDestroy - frees the rigid tools of a mesh.

  Not collective

  Input Parameter:
. mesh - the mesh
@*/
PetscErrorCode SliceRigidDestroy(Mesh mesh)
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
