/* Nodes for the pressures of mixed triangles and tetrahedra, see pressurenodes.h. */
#include "kernels/elementkernel.h"
#include "mesh/meshdofs.h"
#include "pressurenodesimpl.h"

/* Says whether the nodes of the cells of a type in a body have pressures. */
static PetscBool HasPressures(Scene scene, int body, ElementType type)
{
  const KernelCase kernel = {.type        = type,
                             .law         = scene->bodies[body].material.law,
                             .formulation = scene->bodies[body].formulation,
                             .condensed   = scene->bodies[body].condensed};

  return (PetscBool)(ElementNodes(&kernel) > ElementGet(type)->nodes);
}

/* Condenses pressures where the linear solver iterates, which is not for tangents of a saddle. */
static PetscErrorCode Condense(Scene scene, const RootMesh *root, Mesh mesh)
{
  PetscBool condensed = (PetscBool)(scene->solver.type == SOLVER_ITERATIVE);

  PetscFunctionBeginUser;
  if (root && scene->solver.type == SOLVER_AUTO && mesh->dim == 3 && mesh->dim * root->n_nodes > SOLVER_DIRECT_DOFS)
    condensed = PETSC_TRUE;
  PetscCallMPI(MPI_Bcast(&condensed, 1, MPIU_BOOL, 0, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) scene->bodies[b].condensed = condensed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PressureNodesExist - finds out whether a mesh needs nodes for pressures.

  Collective

  Input Parameters:
+ scene - its bodies, of which condensed is set
. root  - on rank 0, NULL on other ranks
- mesh  - has_pressures is set
@*/
PetscErrorCode PressureNodesExist(Scene scene, const RootMesh *root, Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(Condense(scene, root, mesh));
  for (PetscInt c = 0; root && c < root->n_cells && !mesh->has_pressures; c++)
    mesh->has_pressures = HasPressures(scene, root->cell_body[c], root->cell_block[c]->element->type);
  PetscCallMPI(MPI_Bcast(&mesh->has_pressures, 1, MPIU_BOOL, 0, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PressureNodesPlace - fills the arrays of the pressures' nodes, but for their owners.

  Not collective

  Input Parameter:
. mesh - its nodes, with those of the cells filled in

  Note:
  Their ids follow those of the cells' nodes. They have the tags of these.
@*/
void PressureNodesPlace(Mesh mesh)
{
  for (PetscInt i = 0; i < mesh->n_pressure_nodes; i++) {
    const PetscInt node = PressureNodeOf(mesh, i);

    mesh->node_id[node]  = mesh->n_body_global + mesh->node_id[i];
    mesh->node_tag[node] = mesh->node_tag[i];
    for (int d = 0; d < mesh->dim; d++) mesh->coords[node * mesh->dim + d] = mesh->coords[i * mesh->dim + d];
  }
}

/*@
  CellHasPressureNodes - says whether the nodes of a cell have pressures.

  Not collective

  Input Parameters:
+ mesh  - the mesh
. scene - its bodies
- cell  - a local cell
@*/
PetscBool CellHasPressureNodes(Mesh mesh, Scene scene, PetscInt cell)
{
  return HasPressures(scene, mesh->cell_body[cell], mesh->cell_type[cell]);
}

/*@
  PressureNodesConstrain - marks the dofs of the pressures' nodes that are no unknowns.

  Collective

  Input Parameters:
+ mesh  - the mesh, of which saddle is set
- scene - its bodies

  Output Parameter:
. constrained - of each local dof [n_nodes*dim]; those of the pressures' nodes are written
@*/
PetscErrorCode PressureNodesConstrain(Mesh mesh, Scene scene, PetscBool *constrained)
{
  PetscReal *has;

  PetscFunctionBeginUser;
  if (!mesh->has_pressures) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(mesh->n_nodes, &has));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (int k = 0; k < ElementGet(mesh->cell_type[c])->corners && CellHasPressureNodes(mesh, scene, c); k++)
      has[PressureNodeOf(mesh, mesh->cell_nodes[mesh->cell_ptr[c] + k])] = 1;
  PetscCall(MeshSumNodes(mesh, 1, has));
  for (PetscInt i = 0; i < mesh->n_pressure_nodes; i++) {
    const PetscInt node = PressureNodeOf(mesh, i);

    for (int d = 0; d < mesh->dim; d++) constrained[node * mesh->dim + d] = (PetscBool)(d > 0 || has[node] == 0);
    mesh->saddle = (PetscBool)(mesh->saddle || has[node] > 0);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mesh->saddle, 1, MPIU_BOOL, MPI_LOR, mesh->comm));
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}
