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

/* Says whether two bodies have the same material but for its plasticity. */
static PetscBool SameMaterial(const Material *a, const Material *b)
{
  PetscBool same = (PetscBool)(a->law == b->law && a->n_constants == b->n_constants);

  for (int k = 0; k < a->n_constants && same; k++) same = (PetscBool)(a->constants[k] == b->constants[k]);
  return same;
}

/* Condenses the pressures of bodies of different materials that share nodes: their pressures jump there, and unknowns
   of the nodes would make them continuous. On rank 0. */
static PetscErrorCode CondenseBonded(Scene scene, const RootMesh *root, int *condensed)
{
  int *first; /* the first body with pressures at each node of gmsh; -1: none */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(root->gmsh.n_nodes, &first));
  for (PetscInt i = 0; i < root->gmsh.n_nodes; i++) first[i] = -1;
  for (PetscInt c = 0; c < root->n_cells; c++) {
    const PetscInt *nodes = RootMeshCellNodes(root, c);
    const int       body  = root->cell_body[c];

    if (!HasPressures(scene, body, root->cell_block[c]->element->type)) continue;
    for (int k = 0; k < root->cell_block[c]->nodes; k++) {
      int *other = &first[nodes[k]];

      if (*other < 0) *other = body;
      if (!SameMaterial(&scene->bodies[*other].material, &scene->bodies[body].material))
        condensed[*other] = condensed[body] = 1;
    }
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Condenses pressures where the linear solver iterates, which is not for tangents of a saddle, and of bonded bodies. */
static PetscErrorCode Condense(Scene scene, const RootMesh *root, Mesh mesh)
{
  int *condensed, all = scene->solver.type == SOLVER_ITERATIVE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_bodies, &condensed));
  if (root && scene->solver.type == SOLVER_AUTO && mesh->dim == 3 && mesh->dim * root->n_nodes > SOLVER_DIRECT_DOFS)
    all = 1;
  if (root) PetscCall(CondenseBonded(scene, root, condensed));
  for (int b = 0; b < scene->n_bodies && all; b++) condensed[b] = 1;
  PetscCallMPI(MPI_Bcast(condensed, scene->n_bodies, MPI_INT, 0, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) scene->bodies[b].condensed = condensed[b];
  PetscCall(PetscFree(condensed));
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
