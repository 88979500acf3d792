/* Distribution of the mesh: cells and faces of groups are sent to their ranks. Each rank then lists the nodes of its
   cells, and gets what is known of them, and who owns them, from their homes. */
#include "meshdistribution.h"
#include "meshtools.h"
#include "pressurenodesimpl.h"
#include "base/exchange.h"
#include "base/integerset.h"

/* Entries of a cell's record. The ids of its nodes follow. */
enum { CELL_ID, CELL_TAG, CELL_TYPE, CELL_BODY, CELL_HEADER };

/* What comes to a rank */
typedef struct {
  PetscInt n_cells, width, *cells; /* records of the cells, by ascending id, with room for the most nodes of any cell */
  PetscInt n_faces;
  SliceFace *faces; /* of groups, by ascending cell */
} Cargo;

/* Cells and faces */

static void PackCell(const void *context, PetscInt c, void *packed)
{
  const SliceMesh *slice  = context;
  const GmshBlock *block  = slice->cell_block[c];
  PetscInt        *record = packed;

  record[CELL_ID]   = slice->cell_start[slice->rank] + c;
  record[CELL_TAG]  = slice->cell_tag[c];
  record[CELL_TYPE] = (PetscInt)block->element->type;
  record[CELL_BODY] = slice->cell_body[c];
  for (int k = 0; k < block->nodes; k++) record[CELL_HEADER + k] = slice->id[SliceMeshCellNodes(slice, c)[k]];
}

static PetscErrorCode SendCells(Mesh mesh, const SliceMesh *slice, const PetscMPIInt part[], Cargo *cargo)
{
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  cargo->width = CELL_HEADER + slice->width;
  PetscCall(ExchangeRecords(mesh->comm, (size_t)cargo->width * sizeof(PetscInt), slice->n_cells, part, PackCell, slice,
                            &cargo->n_cells, (void **)&cargo->cells));
  PetscCall(PetscMalloc1(slice->n_faces, &to));
  for (PetscInt f = 0; f < slice->n_faces; f++) to[f] = part[slice->faces[f].cell - slice->cell_start[slice->rank]];
  PetscCall(ExchangeRecords(mesh->comm, sizeof(SliceFace), slice->n_faces, to, SliceMeshPackFace, slice->faces,
                            &cargo->n_faces, (void **)&cargo->faces));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills the arrays of cells. Their nodes are ids yet. */
static PetscErrorCode CreateCells(Mesh mesh, const Cargo *cargo)
{
  PetscInt n_entries = 0;

  PetscFunctionBeginUser;
  mesh->n_cells = cargo->n_cells;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    n_entries += ElementGet((ElementType)cargo->cells[c * cargo->width + CELL_TYPE])->nodes;
  PetscCall(PetscMalloc6(mesh->n_cells, &mesh->cell_id, mesh->n_cells, &mesh->cell_type, mesh->n_cells + 1,
                         &mesh->cell_ptr, n_entries, &mesh->cell_nodes, mesh->n_cells, &mesh->cell_body, mesh->n_cells,
                         &mesh->cell_tag));
  mesh->cell_ptr[0] = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt   *record = &cargo->cells[c * cargo->width];
    const ElementType type   = (ElementType)record[CELL_TYPE];

    mesh->cell_id[c]      = record[CELL_ID];
    mesh->cell_tag[c]     = record[CELL_TAG];
    mesh->cell_type[c]    = type;
    mesh->cell_body[c]    = (int)record[CELL_BODY];
    mesh->cell_ptr[c + 1] = mesh->cell_ptr[c] + ElementGet(type)->nodes;
    PetscCall(PetscArraycpy(&mesh->cell_nodes[mesh->cell_ptr[c]], &record[CELL_HEADER], ElementGet(type)->nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the groups their faces. Those of a cell are behind those of the cells before it. */
static PetscErrorCode CreateFaces(Mesh mesh, const Cargo *cargo)
{
  PetscInt *n_faces, c = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_groups, &n_faces));
  for (PetscInt f = 0; f < cargo->n_faces; f++) n_faces[cargo->faces[f].group]++;
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    PetscCall(
      PetscMalloc3(n_faces[g], &group->face_cell, n_faces[g], &group->face_number, n_faces[g], &group->face_tag));
  }
  for (PetscInt f = 0; f < cargo->n_faces; f++) {
    const SliceFace *face  = &cargo->faces[f];
    MeshGroup       *group = &mesh->groups[face->group];

    while (mesh->cell_id[c] < face->cell) c++;
    group->face_cell[group->n_faces]   = c;
    group->face_number[group->n_faces] = face->number;
    group->face_tag[group->n_faces++]  = face->tag;
  }
  PetscCall(PetscFree(n_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes */

/* Lists the ids of the cells' nodes, ascending, and replaces them in the cells by their places in the list. */
static PetscErrorCode ListNodes(Mesh mesh, IntegerSet *ids)
{
  const PetscInt        n     = mesh->cell_ptr[mesh->n_cells];
  const PetscInt *const nodes = mesh->cell_nodes;

  PetscFunctionBeginUser;
  PetscCall(IntegerSetCreate(1, &n, &nodes, ids));
  for (PetscInt k = 0; k < n; k++) mesh->cell_nodes[k] = IntegerSetPlace(ids, mesh->cell_nodes[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the tags and coordinates of this rank's nodes. */
static PetscErrorCode FetchNodes(Mesh mesh, const SliceMesh *slice, PetscSF homes)
{
  const PetscInt n = slice->n_homes;
  PetscInt      *tags;
  PetscReal     *places;
  MPI_Datatype   place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &tags, n * mesh->dim, &places));
  for (PetscInt i = 0; i < n; i++) {
    tags[i] = slice->gmsh.node_tag[slice->home[i]];
    for (int k = 0; k < mesh->dim; k++)
      places[i * mesh->dim + k] = slice->gmsh.coords[3 * slice->home[i] + k] - mesh->centre[k];
  }
  PetscCallMPI(MPI_Type_contiguous(mesh->dim, MPIU_REAL, &place));
  PetscCallMPI(MPI_Type_commit(&place));
  PetscCall(PetscSFBcastBegin(homes, MPIU_INT, tags, mesh->node_tag, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(homes, MPIU_INT, tags, mesh->node_tag, MPI_REPLACE));
  PetscCall(PetscSFBcastBegin(homes, place, places, mesh->coords, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(homes, place, places, mesh->coords, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&place));
  PetscCall(PetscFree2(tags, places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the groups their nodes, from the marks. */
static PetscErrorCode FetchGroupNodes(Mesh mesh, const SliceMesh *slice, PetscSF homes)
{
  int *marks;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_body_nodes, &marks));
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];
    const int  bit = 1 << g % SLICE_MARKS, *sent = slice->marks + g / SLICE_MARKS * slice->n_homes;

    if (g % SLICE_MARKS == 0) {
      PetscCall(PetscSFBcastBegin(homes, MPI_INT, sent, marks, MPI_REPLACE));
      PetscCall(PetscSFBcastEnd(homes, MPI_INT, sent, marks, MPI_REPLACE));
    }
    for (PetscInt i = 0; i < mesh->n_body_nodes; i++) group->n_nodes += (marks[i] & bit) != 0;
    PetscCall(PetscMalloc1(group->n_nodes, &group->nodes));
    group->n_nodes = 0;
    for (PetscInt i = 0; i < mesh->n_body_nodes; i++)
      if (marks[i] & bit) group->nodes[group->n_nodes++] = i;
  }
  PetscCall(PetscFree(marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fetches the largest value that any copy of a node has. */
static PetscErrorCode FetchLargest(PetscSF homes, PetscInt n_homes, const PetscInt values[], PetscInt largest[])
{
  PetscInt *at_home;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_homes, &at_home));
  for (PetscInt i = 0; i < n_homes; i++) at_home[i] = -1;
  PetscCall(PetscSFReduceBegin(homes, MPIU_INT, values, at_home, MPI_MAX));
  PetscCall(PetscSFReduceEnd(homes, MPIU_INT, values, at_home, MPI_MAX));
  PetscCall(PetscSFBcastBegin(homes, MPIU_INT, at_home, largest, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(homes, MPIU_INT, at_home, largest, MPI_REPLACE));
  PetscCall(PetscFree(at_home));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the owners of the cells' nodes, the highest rank that has them, and their numbers there. */
static PetscErrorCode FindOwners(Mesh mesh, const SliceMesh *slice, PetscSF homes)
{
  const PetscInt n = mesh->n_body_nodes, n_homes = slice->n_homes;
  PetscInt      *mine;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(n, &mine));
  for (PetscInt i = 0; i < n; i++) mine[i] = rank;
  PetscCall(FetchLargest(homes, n_homes, mine, mesh->node_owner));
  mesh->n_body_owned = 0;
  for (PetscInt i = 0; i < n; i++) {
    mine[i] = mesh->node_owner[i] == rank ? i : -1;
    mesh->n_body_owned += mine[i] >= 0;
  }
  PetscCall(FetchLargest(homes, n_homes, mine, mesh->node_owner_local));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Derives the owners of the nodes of pressures from those of the cells' nodes. Tools belong to the first rank. */
static PetscErrorCode FindOtherOwners(Mesh mesh)
{
  const PetscInt first_tool = mesh->n_body_nodes + mesh->n_pressure_nodes;
  PetscInt      *n_body_nodes;
  PetscMPIInt    size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc1(size, &n_body_nodes));
  PetscCallMPI(MPI_Allgather(&mesh->n_body_nodes, 1, MPIU_INT, n_body_nodes, 1, MPIU_INT, mesh->comm));
  for (PetscInt i = 0; i < mesh->n_pressure_nodes; i++) {
    mesh->node_owner[PressureNodeOf(mesh, i)]       = mesh->node_owner[i];
    mesh->node_owner_local[PressureNodeOf(mesh, i)] = n_body_nodes[mesh->node_owner[i]] + mesh->node_owner_local[i];
  }
  for (PetscInt i = first_tool; i < mesh->n_nodes; i++) {
    mesh->node_owner[i]       = 0;
    mesh->node_owner_local[i] = (mesh->has_pressures ? 2 : 1) * n_body_nodes[0] + i - first_tool;
  }
  PetscCall(PetscFree(n_body_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the nodes that belong to this rank. */
static PetscErrorCode CountOwned(Mesh mesh)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  mesh->n_owned = 0;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) mesh->n_owned += mesh->node_owner[i] == rank;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates the arrays of nodes for n nodes of cells and those that follow them. */
static PetscErrorCode AllocateNodes(Mesh mesh, PetscInt n)
{
  PetscFunctionBeginUser;
  mesh->n_body_nodes     = n;
  mesh->n_pressure_nodes = mesh->has_pressures ? n : 0;
  mesh->n_nodes          = n + mesh->n_pressure_nodes + TOOL_NODES * mesh->n_tools;
  PetscCall(PetscMalloc5(mesh->n_nodes, &mesh->node_id, mesh->n_nodes, &mesh->node_tag, mesh->n_nodes,
                         &mesh->node_owner, mesh->n_nodes, &mesh->node_owner_local, mesh->n_nodes * mesh->dim,
                         &mesh->coords));
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes all nodes. The slice is emptied as soon as it has said what it knows of them. */
static PetscErrorCode CreateNodes(SliceMesh *slice, Mesh mesh)
{
  IntegerSet ids;
  PetscSF    homes;

  PetscFunctionBeginUser;
  PetscCall(ListNodes(mesh, &ids));
  PetscCall(AllocateNodes(mesh, ids.n));
  PetscCall(PetscArraycpy(mesh->node_id, ids.value, ids.n));
  PetscCall(IntegerSetDestroy(&ids));
  PetscCall(SliceMeshSF(slice, slice->home_start, mesh->n_body_nodes, mesh->node_id, &homes));
  PetscCall(FetchNodes(mesh, slice, homes));
  PetscCall(FetchGroupNodes(mesh, slice, homes));
  PetscCall(FindOwners(mesh, slice, homes));
  PetscCall(PetscSFDestroy(&homes));
  PetscCall(SliceMeshReset(slice));
  PetscCall(MeshToolsPlaceNodes(mesh));
  PressureNodesPlace(mesh);
  PetscCall(FindOtherOwners(mesh));
  PetscCall(CountOwned(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshDistribute - moves cells, nodes and faces of groups to their ranks.

  Collective

  Input Parameters:
+ slice - with faces and marks; emptied
. part  - rank of each of its cells
- mesh  - centre, groups, tools and whether there are pressures are read

  Note:
  All arrays of nodes and cells, and the groups' nodes and faces, are set. Cells do not overlap. A node belongs to the
  highest rank that has a cell with it.
@*/
PetscErrorCode MeshDistribute(SliceMesh *slice, const PetscMPIInt part[], Mesh mesh)
{
  Cargo cargo;

  PetscFunctionBeginUser;
  PetscCall(SendCells(mesh, slice, part, &cargo));
  PetscCall(SliceMeshFreeCells(slice));
  PetscCall(CreateCells(mesh, &cargo));
  PetscCall(PetscFree(cargo.cells));
  PetscCall(CreateFaces(mesh, &cargo));
  PetscCall(PetscFree(cargo.faces));
  PetscCall(CreateNodes(slice, mesh));
  PetscCallMPI(MPI_Allreduce(&mesh->n_owned, &mesh->n_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(&mesh->n_cells, &mesh->n_cells_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
