/* Creation of the distributed mesh from gmsh's file, and coordinates of its nodes. */
#include "mesh/mesh.h"
#include "cellfaces.h"
#include "cellpartition.h"
#include "formulationchoice.h"
#include "gmsh.h"
#include "meshdistribution.h"
#include "meshimport.h"
#include "meshplex.h"
#include "meshtools.h"
#include "pressurenodesimpl.h"
#include "base/refusal.h"
#include "slicegroups.h"
#include "slicelinks.h"
#include "slicemiddles.h"
#include "sliceread.h"
#include "slicerigid.h"
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

/* Reads the file into slices. */
static PetscErrorCode ReadFile(Scene scene, const char *file, SliceMesh *slice, Mesh mesh)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  PetscCall(SliceRead(scene, file, slice, mesh, &complaint));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds faces and nodes of the groups, and checks the mesh. */
static PetscErrorCode FindGroups(Scene scene, const char *file, SliceMesh *slice, Mesh mesh)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  PetscCall(SliceGroupsShare(scene, mesh, slice));
  PetscCall(CellFacesCreate(slice));
  PetscCall(CellFacesCheck(scene, file, slice, &complaint));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscCall(SliceMiddlesCheck(file, slice, &complaint));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscCall(SliceGroupsFind(scene, file, slice, mesh, &complaint));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  SliceGroupsCheckUses(scene, slice, mesh, &complaint);
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Decides which rank gets which of the slice's cells: part, to be freed with PetscFree(). The faces of the cells are
   freed. */
static PetscErrorCode PartitionBodies(Scene scene, SliceMesh *slice, PetscMPIInt **part, Mesh mesh)
{
  PetscBool *contact;
  CellLinks  links;
  CellGraph  graph;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slice->n_cells, part));
  mesh->partition = (Partition){.tool = "none", .imbalance_cells = 1, .imbalance_contact = 1};
  if (slice->size == 1) PetscCall(CellFacesFree(slice));
  if (slice->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SliceGroupsContactCells(scene, slice, mesh, &contact));
  PetscCall(SliceLinksFind(scene, slice, mesh, &links));
  PetscCall(CellGraphCreate(slice, contact, &links, CELL_GRAPH_WHOLE, &graph));
  PetscCall(PetscFree(contact));
  PetscCall(CellPartition(&graph, *part, &mesh->partition));
  PetscCall(CellGraphDestroy(&graph));
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

/* Creates the whole mesh from its file. */
static PetscErrorCode MeshBuild(Scene scene, const char *file, SliceMesh *slice, Mesh mesh)
{
  PetscMPIInt *part;

  PetscFunctionBeginUser;
  PetscCall(ReadFile(scene, file, slice, mesh));
  PetscCall(FindGroups(scene, file, slice, mesh));
  PetscCall(SliceRigidCreate(scene, slice, mesh));
  PetscCall(MeshToolsList(scene, mesh));
  PetscCall(FormulationsChoose(scene, slice, mesh));
  PetscCall(ContactFormulationsChoose(scene, slice, mesh));
  PetscCall(PressureNodesExist(scene, slice, mesh));
  PetscCall(PartitionBodies(scene, slice, &part, mesh));
  PetscCall(MeshDistribute(slice, part, mesh));
  PetscCall(PetscFree(part));
  PetscCall(MeshPlexCreate(mesh));
  PetscCall(MeshToolsMeasureBolts(scene, mesh));
  PetscCall(FreeAllDofs(mesh));
  PetscCall(MeshPlexView(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCreate - creates the distributed mesh from a .msh file.

  Collective

  Input Parameters:
+ comm  - all ranks; rank 0 reads the file and passes it on piece by piece
. scene - bodies, dimension, and the surfaces that are loaded or in contact
- file  - path of a .msh file, format 4.1

  Output Parameter:
. created - to be destroyed with MeshDestroy()

  Options Database Key:
. -mesh_dm_view - views the DMPlex

  Note:
  The DM treats every dof as free until MeshSetConstraints() is called. Refuses damaged files, elements that are not
  available, bodies without cells, cells without a body, mixed orders, a two-dimensional mesh that is not in its plane,
  and loads or contact on surfaces that are rigid or lie between cells. After a refusal there is no mesh, and its memory
  is free.
@*/
PetscErrorCode MeshCreate(MPI_Comm comm, Scene scene, const char *file, Mesh *created)
{
  SliceMesh      slice = {.n_cells = 0};
  Mesh           mesh;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  *created = NULL;
  PetscCall(PetscNew(&mesh));
  mesh->comm = comm;
  mesh->dim  = scene->dim;
  code       = MeshBuild(scene, file, &slice, mesh);
  if (code == REFUSED) { /* a refusal occurs on all ranks, before the mesh is distributed */
    PetscCall(SliceMeshReset(&slice));
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
  PetscCall(SliceRigidDestroy(mesh));
  PetscCall(PetscFree5(mesh->node_id, mesh->node_tag, mesh->node_owner, mesh->node_owner_local, mesh->coords));
  PetscCall(PetscFree(mesh->tools));
  PetscCall(PetscFree(mesh->notes));
  PetscCall(
    PetscFree6(mesh->cell_id, mesh->cell_type, mesh->cell_ptr, mesh->cell_nodes, mesh->cell_body, mesh->cell_tag));
  PetscCall(PetscFree(mesh->global_dofs));
  PetscCall(PetscFree(mesh->work));
  PetscCall(PetscSFDestroy(&mesh->node_sf));
  PetscCall(DMDestroy(&mesh->dm));
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
