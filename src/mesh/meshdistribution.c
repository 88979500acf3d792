/* Distribution of the mesh: rank 0 packs nodes and cells into sections over the Plex, the sections follow the points to
   their ranks, and each rank unpacks its arrays. */
#include "meshdistribution.h"
#include "meshtools.h"
#include "pressurenodesimpl.h"
#include "mesh/meshgroup.h"

/* Entries of a cell's record: id, tag, type, body and number of nodes, then the ids of the nodes, then FACE_ENTRIES
   numbers (group, number, tag) for each face in a group. */
enum { CELL_ID, CELL_TAG, CELL_TYPE, CELL_BODY, CELL_NODES, CELL_HEADER, FACE_ENTRIES = 3 };

/* Data that travel with the points: sections over the Plex' chart, and their values. */
typedef struct {
  PetscSection ids, places, cells; /* ids and places are on points with a node, cells on cells */
  PetscInt    *id;                 /* for each node: id and tag */
  PetscReal   *place;              /* for each node: coordinates relative to the centre */
  PetscInt    *cell;               /* records of the cells */
} Cargo;

/* Packing */

static PetscErrorCode SectionCreate(DM dm, PetscSection *section)
{
  PetscInt start, end;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &start, &end));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), section));
  PetscCall(PetscSectionSetChart(*section, start, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the sections and allocates their values. Ranks without root have none. */
static PetscErrorCode CargoAllocate(DM dm, int dim, const RootMesh *root, Cargo *cargo)
{
  PetscInt n_ids, n_places, n_cells;

  PetscFunctionBeginUser;
  PetscCall(SectionCreate(dm, &cargo->ids));
  PetscCall(SectionCreate(dm, &cargo->places));
  PetscCall(SectionCreate(dm, &cargo->cells));
  for (PetscInt i = 0; root && i < root->n_nodes; i++) {
    PetscCall(PetscSectionSetDof(cargo->ids, root->point[i], 2));
    PetscCall(PetscSectionSetDof(cargo->places, root->point[i], dim));
  }
  for (PetscInt c = 0; root && c < root->n_cells; c++)
    PetscCall(PetscSectionSetDof(cargo->cells, c,
                                 CELL_HEADER + root->cell_block[c]->nodes +
                                   FACE_ENTRIES * (root->face_ptr[c + 1] - root->face_ptr[c])));
  PetscCall(PetscSectionSetUp(cargo->ids));
  PetscCall(PetscSectionSetUp(cargo->places));
  PetscCall(PetscSectionSetUp(cargo->cells));
  PetscCall(PetscSectionGetStorageSize(cargo->ids, &n_ids));
  PetscCall(PetscSectionGetStorageSize(cargo->places, &n_places));
  PetscCall(PetscSectionGetStorageSize(cargo->cells, &n_cells));
  PetscCall(PetscMalloc1(n_ids, &cargo->id));
  PetscCall(PetscMalloc1(n_places, &cargo->place));
  PetscCall(PetscMalloc1(n_cells, &cargo->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void LoadCell(const RootMesh *root, PetscInt c, PetscInt *record)
{
  const GmshBlock *block = root->cell_block[c];
  PetscInt         n     = CELL_HEADER;

  record[CELL_ID]    = c;
  record[CELL_TAG]   = block->tag[root->cell_item[c]];
  record[CELL_TYPE]  = (PetscInt)block->element->type;
  record[CELL_BODY]  = root->cell_body[c];
  record[CELL_NODES] = block->nodes;
  for (int k = 0; k < block->nodes; k++) record[n++] = root->id[RootMeshCellNodes(root, c)[k]];
  for (PetscInt f = root->face_ptr[c]; f < root->face_ptr[c + 1]; f++) {
    record[n++] = root->faces[f].group;
    record[n++] = root->faces[f].number;
    record[n++] = root->faces[f].tag;
  }
}

static PetscErrorCode CargoLoad(Mesh mesh, const RootMesh *root, Cargo *cargo)
{
  PetscInt offset;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < root->n_nodes; i++) {
    PetscCall(PetscSectionGetOffset(cargo->ids, root->point[i], &offset));
    cargo->id[offset]     = i;
    cargo->id[offset + 1] = root->gmsh.node_tag[root->node[i]];
    PetscCall(PetscSectionGetOffset(cargo->places, root->point[i], &offset));
    for (int k = 0; k < mesh->dim; k++)
      cargo->place[offset + k] = root->gmsh.coords[3 * root->node[i] + k] - mesh->centre[k];
  }
  for (PetscInt c = 0; c < root->n_cells; c++) {
    PetscCall(PetscSectionGetOffset(cargo->cells, c, &offset));
    LoadCell(root, c, cargo->cell + offset);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves one section's values along the migration of points. */
static PetscErrorCode MoveData(DM dm, PetscSF migration, MPI_Datatype type, PetscSection *section, void **values)
{
  PetscSection moved;
  void        *arrived;

  PetscFunctionBeginUser;
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), &moved));
  PetscCall(DMPlexDistributeData(dm, migration, *section, type, *values, moved, &arrived));
  PetscCall(PetscSectionDestroy(section));
  PetscCall(PetscFree(*values));
  *section = moved;
  *values  = arrived;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives cells to ranks; *dm is replaced and the cargo follows. On one rank nothing moves. */
static PetscErrorCode Distribute(DM *dm, Cargo *cargo)
{
  PetscSF migration;
  DM      distributed;

  PetscFunctionBeginUser;
  PetscCall(DMPlexDistribute(*dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(MoveData(distributed, migration, MPIU_INT, &cargo->ids, (void **)&cargo->id));
    PetscCall(MoveData(distributed, migration, MPIU_REAL, &cargo->places, (void **)&cargo->place));
    PetscCall(MoveData(distributed, migration, MPIU_INT, &cargo->cells, (void **)&cargo->cell));
    PetscCall(PetscSFDestroy(&migration));
    PetscCall(DMDestroy(dm));
    *dm = distributed;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CargoFree(Cargo *cargo)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSectionDestroy(&cargo->ids));
  PetscCall(PetscSectionDestroy(&cargo->places));
  PetscCall(PetscSectionDestroy(&cargo->cells));
  PetscCall(PetscFree(cargo->id));
  PetscCall(PetscFree(cargo->place));
  PetscCall(PetscFree(cargo->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unpacking */

/* Returns the range of a point's values; a point outside the section's chart has none. */
static PetscErrorCode SectionRange(PetscSection section, PetscInt point, PetscInt *n, PetscInt *offset)
{
  PetscInt start, end;

  PetscFunctionBeginUser;
  *n = *offset = 0;
  PetscCall(PetscSectionGetChart(section, &start, &end));
  if (point < start || point >= end) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSectionGetDof(section, point, n));
  PetscCall(PetscSectionGetOffset(section, point, offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the local nodes in the order of their points and fills their arrays. point_node returns the node of each
   point, -1 if it has none. */
static PetscErrorCode CreateNodes(Mesh mesh, const Cargo *cargo, PetscInt **point_node)
{
  PetscInt start, end, n, offset;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(mesh->dm, &start, &end));
  PetscCall(PetscMalloc1(end, point_node));
  for (PetscInt p = 0; p < end; p++) {
    PetscCall(SectionRange(cargo->ids, p, &n, &offset));
    (*point_node)[p] = n ? mesh->n_nodes++ : -1;
  }
  mesh->n_body_nodes     = mesh->n_nodes;
  mesh->n_pressure_nodes = mesh->has_pressures ? mesh->n_body_nodes : 0;
  mesh->n_nodes += mesh->n_pressure_nodes + TOOL_NODES * mesh->n_tools;
  PetscCall(PetscMalloc5(mesh->n_nodes, &mesh->node_id, mesh->n_nodes, &mesh->node_tag, mesh->n_nodes,
                         &mesh->node_owner, mesh->n_nodes, &mesh->node_owner_local, mesh->n_nodes * mesh->dim,
                         &mesh->coords));
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->work));
  for (PetscInt p = 0; p < end; p++) {
    const PetscInt node = (*point_node)[p];

    if (node < 0) continue;
    PetscCall(SectionRange(cargo->ids, p, &n, &offset));
    mesh->node_id[node]  = cargo->id[offset];
    mesh->node_tag[node] = cargo->id[offset + 1];
    PetscCall(SectionRange(cargo->places, p, &n, &offset));
    for (int k = 0; k < mesh->dim; k++) mesh->coords[node * mesh->dim + k] = cargo->place[offset + k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the number that each point's node has on the rank that owns the point; -1 if the point has no node. */
static PetscErrorCode OwnersNumbers(PetscSF point_sf, PetscInt n_points, const PetscInt point_node[],
                                    PetscInt owner_node[])
{
  PetscInt n_roots;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(owner_node, point_node, n_points));
  PetscCall(PetscSFGetGraph(point_sf, &n_roots, NULL, NULL, NULL));
  if (n_roots < 0) PetscFunctionReturn(PETSC_SUCCESS); /* no graph, because there is one rank */
  PetscCall(PetscSFBcastBegin(point_sf, MPIU_INT, point_node, owner_node, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(point_sf, MPIU_INT, point_node, owner_node, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes a node the copy of node `number` of another rank: its owner, and its entry in the SF. */
static void SetGhost(Mesh mesh, PetscInt node, PetscInt owner, PetscInt number, PetscInt *leaf, PetscSFNode *remote,
                     PetscInt *n_ghosts)
{
  mesh->node_owner[node]       = owner;
  mesh->node_owner_local[node] = number;
  *leaf                        = node;
  *remote                      = (PetscSFNode){.rank = owner, .index = number};
  (*n_ghosts)++;
}

/* Derives owners of nodes from owners of points, and creates the SF between the copies of a node. */
static PetscErrorCode CreateOwners(Mesh mesh, const PetscInt point_node[])
{
  PetscSF            point_sf;
  const PetscInt     n_tool_nodes = TOOL_NODES * mesh->n_tools, copies = mesh->has_pressures ? 2 : 1;
  PetscInt           end, n_leaves, n_ghosts = 0, *n_body_nodes, *owner_node, *leaf;
  const PetscInt    *leaves;
  const PetscSFNode *remotes;
  PetscSFNode       *remote;
  PetscMPIInt        rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc1(size, &n_body_nodes));
  PetscCallMPI(MPI_Allgather(&mesh->n_body_nodes, 1, MPIU_INT, n_body_nodes, 1, MPIU_INT, mesh->comm));
  PetscCall(DMPlexGetChart(mesh->dm, NULL, &end));
  PetscCall(DMGetPointSF(mesh->dm, &point_sf));
  PetscCall(PetscMalloc1(end, &owner_node));
  PetscCall(OwnersNumbers(point_sf, end, point_node, owner_node));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    mesh->node_owner[i]       = rank;
    mesh->node_owner_local[i] = i;
  }
  PetscCall(PetscSFGetGraph(point_sf, NULL, &n_leaves, &leaves, &remotes));
  n_leaves = PetscMax(n_leaves, 0);
  PetscCall(PetscMalloc1(copies * n_leaves + n_tool_nodes, &leaf));
  PetscCall(PetscMalloc1(copies * n_leaves + n_tool_nodes, &remote));
  for (PetscInt l = 0; l < n_leaves; l++) {
    const PetscInt point = leaves ? leaves[l] : l, node = point_node[point];

    for (PetscInt k = 0; k < copies && node >= 0; k++)
      SetGhost(mesh, node + k * mesh->n_body_nodes, remotes[l].rank,
               owner_node[point] + k * n_body_nodes[remotes[l].rank], &leaf[n_ghosts], &remote[n_ghosts], &n_ghosts);
  }
  mesh->n_body_owned = mesh->n_body_nodes - n_ghosts / copies;
  for (PetscInt k = 0; k < n_tool_nodes && rank; k++)
    SetGhost(mesh, copies * mesh->n_body_nodes + k, 0, copies * n_body_nodes[0] + k, &leaf[n_ghosts], &remote[n_ghosts],
             &n_ghosts);
  mesh->n_owned = mesh->n_nodes - n_ghosts;
  PetscCall(PetscFree(n_body_nodes));
  PetscCall(PetscSFCreate(mesh->comm, &mesh->node_sf));
  PetscCall(
    PetscSFSetGraph(mesh->node_sf, mesh->n_nodes, n_ghosts, leaf, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(mesh->node_sf));
  PetscCall(PetscFree(owner_node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns a cell's record, the faces that follow it, and their number. */
static PetscErrorCode CellRecord(const Cargo *cargo, PetscInt c, const PetscInt **record, const PetscInt **faces,
                                 PetscInt *n_faces)
{
  PetscInt n, offset;

  PetscFunctionBeginUser;
  *record = *faces = NULL;
  *n_faces         = 0;
  PetscCall(SectionRange(cargo->cells, c, &n, &offset));
  *record  = cargo->cell + offset;
  *faces   = *record + CELL_HEADER + (*record)[CELL_NODES];
  *n_faces = (n - CELL_HEADER - (*record)[CELL_NODES]) / FACE_ENTRIES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates the cells, and the faces of groups that are in the cells' records. */
static PetscErrorCode AllocateCells(Mesh mesh, const Cargo *cargo)
{
  PetscInt        n_entries = 0, n, *n_faces;
  const PetscInt *record, *faces;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, NULL, &mesh->n_cells));
  PetscCall(PetscCalloc1(mesh->n_groups, &n_faces));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscCall(CellRecord(cargo, c, &record, &faces, &n));
    n_entries += record[CELL_NODES];
    for (PetscInt f = 0; f < n; f++) n_faces[faces[FACE_ENTRIES * f]]++;
  }
  for (int g = 0; g < mesh->n_groups; g++) {
    MeshGroup *group = &mesh->groups[g];

    PetscCall(
      PetscMalloc3(n_faces[g], &group->face_cell, n_faces[g], &group->face_number, n_faces[g], &group->face_tag));
  }
  PetscCall(PetscMalloc6(mesh->n_cells, &mesh->cell_id, mesh->n_cells, &mesh->cell_type, mesh->n_cells + 1,
                         &mesh->cell_ptr, n_entries, &mesh->cell_nodes, mesh->n_cells, &mesh->cell_body, mesh->n_cells,
                         &mesh->cell_tag));
  PetscCall(PetscFree(n_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the local nodes of cell c by their ids. ids: of all local nodes, ascending; nodes: their local numbers. */
static PetscErrorCode CreateCellNodes(Mesh mesh, PetscInt c, const PetscInt *record, const PetscInt ids[],
                                      const PetscInt nodes[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < record[CELL_NODES]; k++) {
    PetscInt place;

    PetscCall(PetscFindInt(record[CELL_HEADER + k], mesh->n_nodes, ids, &place));
    PetscCheck(place >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "Node %" PetscInt_FMT " of cell %" PetscInt_FMT " did not come with it", record[CELL_HEADER + k],
               record[CELL_ID]);
    mesh->cell_nodes[mesh->cell_ptr[c] + k] = nodes[place];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills the local cells and the groups' faces. */
static PetscErrorCode CreateCells(Mesh mesh, const Cargo *cargo)
{
  PetscInt        n_faces, *ids, *nodes;
  const PetscInt *record, *faces;

  PetscFunctionBeginUser;
  PetscCall(AllocateCells(mesh, cargo));
  PetscCall(PetscMalloc2(mesh->n_nodes, &ids, mesh->n_nodes, &nodes));
  PetscCall(PetscArraycpy(ids, mesh->node_id, mesh->n_nodes));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) nodes[i] = i;
  PetscCall(PetscSortIntWithArray(mesh->n_nodes, ids, nodes));
  mesh->cell_ptr[0] = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscCall(CellRecord(cargo, c, &record, &faces, &n_faces));
    mesh->cell_id[c]      = record[CELL_ID];
    mesh->cell_tag[c]     = record[CELL_TAG];
    mesh->cell_type[c]    = (ElementType)record[CELL_TYPE];
    mesh->cell_body[c]    = (int)record[CELL_BODY];
    mesh->cell_ptr[c + 1] = mesh->cell_ptr[c] + record[CELL_NODES];
    PetscCall(CreateCellNodes(mesh, c, record, ids, nodes));
    for (PetscInt f = 0; f < n_faces; f++, faces += FACE_ENTRIES) {
      MeshGroup *group = &mesh->groups[faces[0]];

      group->face_cell[group->n_faces]   = c;
      group->face_number[group->n_faces] = (int)faces[1];
      group->face_tag[group->n_faces++]  = faces[2];
    }
  }
  PetscCall(PetscFree2(ids, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets a group's nodes from its label, which includes nodes that only another rank's face touches. */
static PetscErrorCode CreateGroupNodes(Mesh mesh, MeshGroup *group, const PetscInt point_node[])
{
  char            name[MESH_TEXT];
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  MeshGroupLabel(mesh, group, name);
  PetscCall(DMGetStratumIS(mesh->dm, name, 1, &points));
  if (!points) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  PetscCall(PetscMalloc1(n, &group->nodes));
  for (PetscInt i = 0; i < n; i++)
    if (point_node[point[i]] >= 0) group->nodes[group->n_nodes++] = point_node[point[i]];
  PetscCall(PetscSortInt(group->n_nodes, group->nodes));
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshDistribute - moves nodes, cells and faces of groups to the ranks of their points.

  Collective

  Input Parameters:
+ root - on rank 0, with points and faces; reset as soon as it is packed. NULL on other ranks
- mesh - dm with its partitioner and the groups' labels, centre, and groups are read

  Note:
  The DM is replaced by the distributed one. All arrays of nodes and cells, and the groups' nodes and faces, are set.
  Cells do not overlap. A node belongs to the rank to which the DM's point SF gives its point.
@*/
PetscErrorCode MeshDistribute(RootMesh *root, Mesh mesh)
{
  Cargo     cargo;
  PetscInt *point_node;

  PetscFunctionBeginUser;
  PetscCall(CargoAllocate(mesh->dm, mesh->dim, root, &cargo));
  if (root) {
    PetscCall(CargoLoad(mesh, root, &cargo));
    PetscCall(RootMeshReset(root));
  }
  PetscCall(Distribute(&mesh->dm, &cargo));
  PetscCall(CreateNodes(mesh, &cargo, &point_node));
  PetscCall(MeshToolsPlaceNodes(mesh));
  PressureNodesPlace(mesh);
  PetscCall(CreateOwners(mesh, point_node));
  PetscCall(CreateCells(mesh, &cargo));
  for (int g = 0; g < mesh->n_groups; g++) PetscCall(CreateGroupNodes(mesh, &mesh->groups[g], point_node));
  PetscCall(PetscFree(point_node));
  PetscCall(CargoFree(&cargo));
  PetscCallMPI(MPI_Allreduce(&mesh->n_owned, &mesh->n_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(&mesh->n_cells, &mesh->n_cells_global, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
