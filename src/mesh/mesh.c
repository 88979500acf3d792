/* Creation of the distributed mesh from gmsh's file, and coordinates of its nodes. */
#include "mesh/mesh.h"
#include "cellfaces.h"
#include "formulationchoice.h"
#include "gmsh.h"
#include "meshdistribution.h"
#include "meshimport.h"
#include "meshtools.h"
#include "pressurenodesimpl.h"
#include "base/refusal.h"
#include "rootgroups.h"
#include "rootlinks.h"
#include "rootmiddles.h"
#include "rootrigid.h"
#include <string.h>

/* Coordinates below this part of the model's size are round-off of the mesh generator. */
#define PLACE_ROUND_OFF 1e-9

/*@
  MeshGenerate - makes the scene's mesh file from a .geo with gmsh or from a mesh of another program, or returns the
  scene's .msh file.

  Collective

  Input Parameters:
+ comm      - all ranks; rank 0 runs gmsh
. scene     - mesh file, order and parameters
. directory - where meshes are kept
- trust     - PETSC_TRUE: the .geo may run programs and write files

  Output Parameters:
+ file    - path of the .msh file [PETSC_MAX_PATH_LEN]
- seconds - wall time of gmsh (s); 0 if gmsh did not run

  Note:
  A mesh is made once for each content and kept as mesh-HASH.msh. Refuses a file that gmsh or the converter refuses.
Refuses a .geo that runs programs or writes files, unless `trust` is set.
@*/
PetscErrorCode MeshGenerate(MPI_Comm comm, Scene scene, const char *directory, PetscBool trust, char *file,
                            PetscReal *seconds)
{
  const char *ending    = strrchr(scene->mesh_file, '.');
  Complaint   complaint = {""};
  PetscBool   foreign   = PETSC_FALSE;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *seconds = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) foreign = MeshImportNeeded(scene);
  PetscCallMPI(MPI_Bcast(&foreign, 1, MPIU_BOOL, 0, comm));
  if (foreign) {
    if (!rank) PetscCall(MeshImport(scene, directory, file, seconds, &complaint));
  } else if (!strcmp(ending, ".msh"))
    PetscCall(PetscStrncpy(file, scene->mesh_file, PETSC_MAX_PATH_LEN));
  else if (!rank)
    PetscCall(GmshGenerate(scene, directory, trust, file, seconds, &complaint));
  PetscCall(ComplaintRefuse(comm, &complaint));
  PetscCallMPI(MPI_Bcast(file, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(seconds, 1, MPIU_REAL, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creation */

/* Sends the bounding box and the order, which rank 0 found, to all ranks. */
static PetscErrorCode ShareFrame(Mesh mesh)
{
  PetscReal frame[4] = {mesh->centre[0], mesh->centre[1], mesh->centre[2], mesh->size};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(frame, 4, MPIU_REAL, 0, mesh->comm));
  PetscCallMPI(MPI_Bcast(&mesh->order, 1, MPI_INT, 0, mesh->comm));
  PetscCall(PetscArraycpy(mesh->centre, frame, 3));
  mesh->size = frame[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the file into root on rank 0; all ranks get the order and the bounding box. */
static PetscErrorCode ReadFile(Scene scene, const char *file, RootMesh *root, Mesh mesh)
{
  Complaint   complaint = {""};
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  if (root) PetscCall(RootMeshRead(scene, file, size, root, mesh, &complaint));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscCall(ShareFrame(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds faces and nodes of the groups, and checks the mesh. */
static PetscErrorCode FindGroups(Scene scene, const char *file, RootMesh *root, Mesh mesh)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  PetscCall(RootGroupsShare(scene, mesh, root));
  if (root) {
    PetscCall(CellFacesCreate(root));
    CellFacesCheck(scene, file, root, &complaint);
    if (!complaint.text[0]) PetscCall(RootMiddlesCheck(file, root, &complaint));
    if (!complaint.text[0]) PetscCall(RootGroupsFind(scene, file, root, mesh, &complaint));
    if (!complaint.text[0]) RootGroupsCheckUses(scene, root, mesh, &complaint);
  }
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscCall(RootGroupsShareCounts(scene, mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Decides on rank 0 which rank gets which cell: part, to be freed with PetscFree(). The faces of the cells are freed.
 */
static PetscErrorCode PartitionBodies(Scene scene, RootMesh *root, PetscMPIInt **part, Mesh mesh)
{
  const PetscInt n       = root ? root->n_cells : 0;
  PetscBool     *contact = NULL;
  PetscInt      *offsets = NULL, *adjacency = NULL;
  CellLinks      links = {0};
  PetscMPIInt    size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  if (root && size > 1) {
    PetscCall(RootGroupsContactCells(scene, root, mesh, &contact));
    PetscCall(RootLinksFind(scene, root, mesh, &links));
    PetscCall(CellFacesNeighbours(root, &offsets, &adjacency));
  }
  if (root) PetscCall(CellFacesFree(root));
  PetscCall(PetscMalloc1(n, part));
  PetscCall(PartitionCells(mesh->comm, n, offsets, adjacency, contact, &links, *part, &mesh->partition));
  PetscCall(PetscFree(offsets));
  PetscCall(PetscFree(adjacency));
  PetscCall(PetscFree(contact));
  PetscCall(PetscFree(links.cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Declares every dof free until the supports are known. */
static PetscErrorCode FreeAllDofs(Mesh mesh)
{
  PetscBool *constrained;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &constrained));
  PetscCall(MeshSetConstraints(mesh, constrained));
  PetscCall(PetscFree(constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the whole mesh from its file. root is NULL on ranks other than 0. */
static PetscErrorCode MeshBuild(Scene scene, const char *file, RootMesh *root, Mesh mesh)
{
  PetscMPIInt *part;

  PetscFunctionBeginUser;
  PetscCall(ReadFile(scene, file, root, mesh));
  PetscCall(FindGroups(scene, file, root, mesh));
  PetscCall(RootRigidCreate(scene, root, mesh));
  PetscCall(MeshToolsList(scene, mesh));
  PetscCall(FormulationsChoose(scene, root, mesh));
  PetscCall(ContactFormulationsChoose(scene, root, mesh));
  PetscCall(PressureNodesExist(scene, root, mesh));
  PetscCall(PartitionBodies(scene, root, &part, mesh));
  PetscCall(MeshDistribute(root, part, mesh));
  PetscCall(PetscFree(part));
  PetscCall(MeshToolsMeasureBolts(scene, mesh));
  PetscCall(FreeAllDofs(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCreate - creates the distributed mesh from a .msh file.

  Collective

  Input Parameters:
+ comm  - all ranks; rank 0 reads the file
. scene - bodies, dimension, and the surfaces that are loaded or in contact
- file  - path of a .msh file, format 4.1

  Output Parameter:
. created - to be destroyed with MeshDestroy()

  Note:
  The local section treats every dof as free until MeshSetConstraints() is called. Refuses damaged files, elements that
  are not available, bodies without cells, cells without a body, mixed orders, a two-dimensional mesh that is not in its
  plane, and loads or contact on surfaces that are rigid or lie between cells. After a refusal there is no mesh, and its
  memory is free.
@*/
PetscErrorCode MeshCreate(MPI_Comm comm, Scene scene, const char *file, Mesh *created)
{
  RootMesh       storage = {.n_cells = 0}, *root;
  Mesh           mesh;
  PetscMPIInt    rank;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  *created = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  root = rank ? NULL : &storage;
  PetscCall(PetscNew(&mesh));
  mesh->comm = comm;
  mesh->dim  = scene->dim;
  code       = MeshBuild(scene, file, root, mesh);
  if (code == REFUSED) { /* a refusal occurs on all ranks, before the mesh is distributed */
    if (root) PetscCall(RootMeshReset(root));
    PetscCall(MeshDestroy(&mesh));
  }
  PetscCall(code);
  *created = mesh;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshDestroy - frees a mesh.

  Collective

  Input Parameter:
. destroyed - may be NULL; set to NULL
@*/
PetscErrorCode MeshDestroy(Mesh *destroyed)
{
  Mesh mesh = *destroyed;

  PetscFunctionBeginUser;
  if (!mesh) PetscFunctionReturn(PETSC_SUCCESS);
  for (int g = 0; g < mesh->n_groups; g++) {
    PetscCall(PetscFree(mesh->groups[g].name));
    PetscCall(PetscFree(mesh->groups[g].nodes));
    PetscCall(PetscFree3(mesh->groups[g].face_cell, mesh->groups[g].face_number, mesh->groups[g].face_tag));
  }
  PetscCall(PetscFree(mesh->groups));
  PetscCall(RootRigidDestroy(mesh));
  PetscCall(PetscFree5(mesh->node_id, mesh->node_tag, mesh->node_owner, mesh->node_owner_local, mesh->coords));
  PetscCall(PetscFree(mesh->tools));
  PetscCall(PetscFree(mesh->notes));
  PetscCall(
    PetscFree6(mesh->cell_id, mesh->cell_type, mesh->cell_ptr, mesh->cell_nodes, mesh->cell_body, mesh->cell_tag));
  PetscCall(PetscFree(mesh->global_dofs));
  PetscCall(PetscFree(mesh->work));
  PetscCall(PetscSFDestroy(&mesh->node_sf));
  PetscCall(PetscFree(*destroyed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates */

/*@
  MeshGatherNodes - gathers a nodal field at some nodes, for an element kernel.

  Not collective

  Input Parameters:
+ mesh   - only its dimension is read
. n      - number of nodes
. nodes  - local nodes
- values - nodal field [n_nodes*dim], such as mesh->coords or displacements

  Output Parameter:
. gathered - values at the nodes, one node after the other [n*dim]
@*/
void MeshGatherNodes(Mesh mesh, PetscInt n, const PetscInt nodes[], const PetscReal *values, PetscReal *gathered)
{
  for (PetscInt a = 0; a < n; a++)
    for (int k = 0; k < mesh->dim; k++) gathered[a * mesh->dim + k] = values[nodes[a] * mesh->dim + k];
}

/*@
  MeshCellCoordinates - gathers the reference coordinates of a cell's nodes, for an element kernel.

  Not collective

  Input Parameters:
+ mesh - the mesh
- cell - local cell

  Output Parameter:
. X - coordinates relative to mesh->centre, in gmsh's node order [nodes*dim]

  Note:
  In an axisymmetric mesh the first coordinate is the radius itself.
@*/
void MeshCellCoordinates(Mesh mesh, PetscInt cell, PetscReal *X)
{
  const PetscInt first = mesh->cell_ptr[cell];

  MeshGatherNodes(mesh, mesh->cell_ptr[cell + 1] - first, &mesh->cell_nodes[first], mesh->coords, X);
}

/*@
  MeshNodePlace - returns the reference coordinates of a node in the user's frame, for messages.

  Not collective

  Input Parameters:
+ mesh - the mesh
- node - local node

  Output Parameter:
. X - three coordinates; values that are round-off become 0
@*/
void MeshNodePlace(Mesh mesh, PetscInt node, PetscReal X[3])
{
  for (int d = 0; d < 3; d++) {
    X[d] = d < mesh->dim ? mesh->coords[node * mesh->dim + d] + mesh->centre[d] : 0;
    if (PetscAbsReal(X[d]) <= PLACE_ROUND_OFF * mesh->size) X[d] = 0;
  }
}
