/* The DMPlex of the mesh, see meshplex.h. */
#include "meshplex.h"
#include "mesh/meshgroup.h"

/* Topology */

/* Gives each cell its nodes. */
static PetscErrorCode SetCones(Mesh mesh)
{
  PetscInt cone[ELEMENT_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(DMPlexSetConeSize(mesh->dm, c, mesh->cell_ptr[c + 1] - mesh->cell_ptr[c]));
  PetscCall(DMSetUp(mesh->dm));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c];

    for (PetscInt k = first; k < mesh->cell_ptr[c + 1]; k++) cone[k - first] = mesh->n_cells + mesh->cell_nodes[k];
    PetscCall(DMPlexSetCone(mesh->dm, c, cone));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Labels n points that follow each other. */
static PetscErrorCode LabelRange(DMLabel label, PetscInt value, PetscInt first, PetscInt n)
{
  IS points;

  PetscFunctionBeginUser;
  PetscCall(ISCreateStride(PETSC_COMM_SELF, n, first, 1, &points));
  PetscCall(DMLabelSetStratumIS(label, value, points));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says that nodes are points. Cells have no type, since those of PETSc have corners alone, in an order of their own. */
static PetscErrorCode LabelTypes(Mesh mesh)
{
  DMLabel label;

  PetscFunctionBeginUser;
  PetscCall(DMCreateLabel(mesh->dm, "celltype"));
  PetscCall(DMPlexGetCellTypeLabel(mesh->dm, &label));
  PetscCall(LabelRange(label, DM_POLYTOPE_UNKNOWN, 0, mesh->n_cells));
  PetscCall(LabelRange(label, DM_POLYTOPE_POINT, mesh->n_cells, mesh->n_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Labels the nodes of surfaces, curves and points. */
static PetscErrorCode LabelGroups(Mesh mesh)
{
  char      name[MESH_TEXT];
  PetscInt *points;
  DMLabel   label;
  IS        nodes;

  PetscFunctionBeginUser;
  for (int g = 0; g < mesh->n_groups; g++) {
    const MeshGroup *group = &mesh->groups[g];

    if (group->dim == mesh->dim) continue;
    MeshGroupLabel(mesh, group, name);
    PetscCall(DMCreateLabel(mesh->dm, name));
    PetscCall(DMGetLabel(mesh->dm, name, &label));
    PetscCall(PetscMalloc1(group->n_nodes, &points));
    for (PetscInt i = 0; i < group->n_nodes; i++) points[i] = mesh->n_cells + group->nodes[i];
    PetscCall(ISCreateGeneral(PETSC_COMM_SELF, group->n_nodes, points, PETSC_OWN_POINTER, &nodes));
    PetscCall(DMLabelSetStratumIS(label, 1, nodes));
    PetscCall(ISDestroy(&nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Owners */

/* Creates the SF from copies of nodes to their owners' nodes. On each rank, node n is point first[rank] + n. */
static PetscErrorCode CreateSF(Mesh mesh, const PetscInt first[], PetscSF *sf)
{
  const PetscInt n_ghosts = mesh->n_nodes - mesh->n_owned;
  PetscInt       n        = 0, *leaf;
  PetscSFNode   *remote;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(n_ghosts, &leaf));
  PetscCall(PetscMalloc1(n_ghosts, &remote));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    const PetscInt owner = mesh->node_owner[i];

    if (owner == rank) continue;
    leaf[n]     = first[rank] + i;
    remote[n++] = (PetscSFNode){.rank = owner, .index = first[owner] + mesh->node_owner_local[i]};
  }
  PetscCall(PetscSFCreate(mesh->comm, sf));
  PetscCall(
    PetscSFSetGraph(*sf, first[rank] + mesh->n_nodes, n_ghosts, leaf, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(*sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells the DM the owners of its points, and makes the SF between nodes. Nobody else has a cell. */
static PetscErrorCode SetOwners(Mesh mesh)
{
  PetscInt   *first;
  PetscSF     points;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscCalloc1(size, &first));
  PetscCall(CreateSF(mesh, first, &mesh->node_sf));
  PetscCallMPI(MPI_Allgather(&mesh->n_cells, 1, MPIU_INT, first, 1, MPIU_INT, mesh->comm));
  PetscCall(CreateSF(mesh, first, &points));
  PetscCall(DMSetPointSF(mesh->dm, points));
  PetscCall(PetscSFDestroy(&points));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshPlexCreate - creates the DMPlex of the mesh and the SF of its nodes.

  Collective

  Input Parameter:
. mesh - cells, nodes with their owners, and groups are read; dm and node_sf are set
@*/
PetscErrorCode MeshPlexCreate(Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(DMPlexCreate(mesh->comm, &mesh->dm));
  PetscCall(DMSetDimension(mesh->dm, mesh->dim));
  PetscCall(DMSetCoordinateDim(mesh->dm, mesh->dim));
  PetscCall(DMPlexSetChart(mesh->dm, 0, mesh->n_cells + mesh->n_nodes));
  PetscCall(SetCones(mesh));
  PetscCall(DMPlexSymmetrize(mesh->dm));
  PetscCall(DMPlexStratify(mesh->dm));
  PetscCall(LabelTypes(mesh));
  PetscCall(LabelGroups(mesh));
  PetscCall(SetOwners(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Dofs */

/* Makes a new DM of the same points. Vectors that are there keep the old one, whose dofs they have. */
static PetscErrorCode RenewDM(Mesh mesh)
{
  DM old = mesh->dm;

  PetscFunctionBeginUser;
  PetscCall(DMClone(old, &mesh->dm));
  PetscCall(PetscObjectSetName((PetscObject)mesh->dm, "mesh"));
  PetscCall(DMSetOptionsPrefix(mesh->dm, "mesh_"));
  PetscCall(DMDestroy(&old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the prescribed components of a node, ascending, and returns their number. */
static PetscInt ListConstrained(Mesh mesh, const PetscBool constrained[], PetscInt node, PetscInt components[3])
{
  PetscInt n = 0;

  for (int d = 0; d < mesh->dim; d++)
    if (constrained[node * mesh->dim + d]) components[n++] = d;
  return n;
}

/* Gives the DM the dofs of the nodes and says which are prescribed. Cells have none, but are in the section, because
   PETSc 3.18 checks constraints as if each section began with point 0. */
static PetscErrorCode SetSection(Mesh mesh, const PetscBool constrained[])
{
  const PetscInt first = mesh->n_cells;
  PetscInt       components[3];
  PetscSection   section;

  PetscFunctionBeginUser;
  PetscCall(PetscSectionCreate(mesh->comm, &section));
  PetscCall(PetscSectionSetChart(section, 0, first + mesh->n_nodes));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    const PetscInt n = ListConstrained(mesh, constrained, i, components);

    PetscCall(PetscSectionSetDof(section, first + i, mesh->dim));
    if (n) PetscCall(PetscSectionSetConstraintDof(section, first + i, n));
  }
  PetscCall(PetscSectionSetUp(section));
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (ListConstrained(mesh, constrained, i, components))
      PetscCall(PetscSectionSetConstraintIndices(section, first + i, components));
  PetscCall(DMSetLocalSection(mesh->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshPlexNumberDofs - makes a DM with the dofs and numbers the free ones globally.

  Collective

  Input Parameters:
+ mesh        - after MeshPlexCreate(); dm, n_free and global_dofs are set
- constrained - for each local dof [n_nodes*dim], the same on all ranks that have the node

  Note:
  Those of rank 0 come first, and on each rank they have the order of its nodes.
@*/
PetscErrorCode MeshPlexNumberDofs(Mesh mesh, const PetscBool constrained[])
{
  PetscSection global;

  PetscFunctionBeginUser;
  PetscCall(RenewDM(mesh));
  PetscCall(SetSection(mesh, constrained));
  PetscCall(DMGetGlobalSection(mesh->dm, &global));
  PetscCall(PetscSectionGetConstrainedStorageSize(global, &mesh->n_free));
  PetscCall(PetscFree(mesh->global_dofs));
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->global_dofs));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    PetscInt next;

    PetscCall(PetscSectionGetOffset(global, mesh->n_cells + i, &next));
    if (next < 0) next = -(next + 1); /* of a ghost node */
    for (PetscInt k = i * mesh->dim; k < (i + 1) * mesh->dim; k++) mesh->global_dofs[k] = constrained[k] ? -1 : next++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshPlexView - shows the DMPlex if the user asks for it.

  Collective

  Input Parameter:
. mesh - after MeshPlexNumberDofs()

  Options Database Key:
. -mesh_dm_view - views the DMPlex
@*/
PetscErrorCode MeshPlexView(Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(DMViewFromOptions(mesh->dm, NULL, "-dm_view"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
