/* Nodes for the pressures of mixed triangles and tetrahedra, see pressurenodes.h. */
#include "kernels/elementkernel.h"
#include "mesh/meshdofs.h"
#include "formulationchoice.h"
#include "pressurenodesimpl.h"
#include "base/complaint.h"

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

/* Says for each body which is the first with its material, -1 if it has none. */
static void SortMaterials(Scene scene, int *material)
{
  for (int b = 0; b < scene->n_bodies; b++) {
    material[b] = scene->bodies[b].rigid ? -1 : b;
    for (int a = 0; a < b && material[b] == b; a++)
      if (!scene->bodies[a].rigid && SameMaterial(&scene->bodies[a].material, &scene->bodies[b].material))
        material[b] = a;
  }
}

/* Marks the pairs of materials with pressures that share nodes: bonded [n_bodies][n_bodies]. A node lists one material
   more than it has components, at most, since components fail there anyway. On rank 0. */
static PetscErrorCode FindBonds(Scene scene, const RootMesh *root, int dim, const int *material, PetscBool *bonded)
{
  int *known, *count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(root->gmsh.n_nodes * (dim + 1), &known));
  PetscCall(PetscCalloc1(root->gmsh.n_nodes, &count));
  for (PetscInt c = 0; c < root->n_cells; c++) {
    const PetscInt *nodes = RootMeshCellNodes(root, c);
    const int       own   = material[root->cell_body[c]];

    if (!HasPressures(scene, root->cell_body[c], root->cell_block[c]->element->type)) continue;
    for (int k = 0; k < root->cell_block[c]->nodes; k++) {
      int *at = &known[nodes[k] * (dim + 1)], *n = &count[nodes[k]], m = 0;

      while (m < *n && at[m] != own) m++;
      if (m < *n || *n > dim) continue;
      for (m = 0; m < *n; m++)
        bonded[own * scene->n_bodies + at[m]] = bonded[at[m] * scene->n_bodies + own] = PETSC_TRUE;
      at[(*n)++] = own;
    }
  }
  PetscCall(PetscFree(known));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts and marks the components that the materials bonded to one have taken. */
static int CountTaken(int n, int dim, const PetscBool *bonded, const int *component, PetscBool taken[3])
{
  int count = 0;

  for (int d = 0; d < dim; d++) taken[d] = PETSC_FALSE;
  for (int b = 0; b < n; b++)
    if (bonded[b] && component[b] >= 0 && component[b] < dim) taken[component[b]] = PETSC_TRUE;
  for (int d = 0; d < dim; d++) count += taken[d];
  return count;
}

/* Chooses the component of each body, dim where none is left. The material with the fewest left is the next, as in
   Brelaz (Communications of the ACM 22, 1979), which colours every graph of two colours. */
static void ChooseComponents(int n, int dim, const int *material, const PetscBool *bonded, int *component)
{
  PetscBool taken[3];

  for (int b = 0; b < n; b++) component[b] = -1;
  for (int next = 0; next >= 0;) {
    int most = next = -1;

    for (int b = 0; b < n; b++) {
      const int count = CountTaken(n, dim, &bonded[b * n], component, taken);

      if (material[b] != b || component[b] >= 0 || count <= most) continue;
      most = count;
      next = b;
    }
    if (next < 0) break;
    CountTaken(n, dim, &bonded[next * n], component, taken);
    component[next] = 0;
    while (component[next] < dim && taken[component[next]]) component[next]++;
  }
  for (int b = 0; b < n; b++) component[b] = material[b] < 0 ? 0 : component[material[b]];
}

/* Gives bodies of different materials that share nodes different components, and says which bodies these are. On rank
   0. */
static PetscErrorCode SeparateBonded(Scene scene, const RootMesh *root, int dim, int *component, int *shares)
{
  const int  n = scene->n_bodies;
  int       *material;
  PetscBool *bonded;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &material));
  PetscCall(PetscCalloc1(n * n, &bonded));
  SortMaterials(scene, material);
  PetscCall(FindBonds(scene, root, dim, material, bonded));
  ChooseComponents(n, dim, material, bonded, component);
  for (int b = 0; b < n; b++)
    for (int a = 0; a < n && material[b] >= 0; a++) shares[b] |= bonded[material[b] * n + a];
  PetscCall(PetscFree(material));
  PetscCall(PetscFree(bonded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a body that has found no component, and whose elements, of first order, cannot condense their pressures. */
static PetscErrorCode RefuseCrowded(Scene scene, const RootMesh *root, Mesh mesh, const int *component)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; root && c < root->n_cells; c++) {
    const SceneBody *body = &scene->bodies[root->cell_body[c]];

    if (component[root->cell_body[c]] < mesh->dim) continue;
    if (HasPressures(scene, root->cell_body[c], root->cell_block[c]->element->type))
      Complain(&complaint,
               "%s: body '%s' of mixed %s shares nodes with bodies of %d other materials, whose pressures leave none "
               "for it; allowed: mesh.order: 2",
               SceneWhere(scene, body->path, "material"), body->name, root->cell_block[c]->element->name,
               (int)mesh->dim);
  }
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Condenses pressures where the linear solver iterates, which is not for tangents of a saddle. */
static PetscErrorCode CondenseAll(Scene scene, const RootMesh *root, Mesh mesh)
{
  int all = scene->solver.type == SOLVER_ITERATIVE;

  PetscFunctionBeginUser;
  if (root && scene->solver.type == SOLVER_AUTO && mesh->dim == 3 && mesh->dim * root->n_nodes > SOLVER_DIRECT_DOFS)
    all = 1;
  PetscCallMPI(MPI_Bcast(&all, 1, MPI_INT, 0, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) scene->bodies[b].condensed = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the components of the bodies. Elements of second order condense their pressures where bodies of different
   materials share nodes: on the same mesh the force of two bonded blocks is 0.3 % off then, 1.5 % with components. */
static PetscErrorCode SetComponents(Scene scene, const RootMesh *root, Mesh mesh)
{
  const int      n = scene->n_bodies;
  int           *component;
  PetscErrorCode refused;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &component));
  if (root) PetscCall(SeparateBonded(scene, root, (int)mesh->dim, component, component + n));
  PetscCallMPI(MPI_Bcast(component, 2 * n, MPI_INT, 0, mesh->comm));
  for (int b = 0; b < n; b++) {
    scene->bodies[b].component = component[b] < mesh->dim ? component[b] : 0;
    scene->bodies[b].condensed |= component[n + b];
    if (component[b] >= mesh->dim) FormulationsCrowded(&scene->bodies[b]);
  }
  refused = RefuseCrowded(scene, root, mesh, component);
  PetscCall(PetscFree(component));
  PetscCall(refused);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PressureNodesExist - finds out whether a mesh needs nodes for pressures.

  Collective

  Input Parameters:
+ scene - its bodies, of which condensed and component are set
. root  - on rank 0, NULL on other ranks
- mesh  - has_pressures is set
@*/
PetscErrorCode PressureNodesExist(Scene scene, const RootMesh *root, Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(CondenseAll(scene, root, mesh));
  PetscCall(SetComponents(scene, root, mesh));
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
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &has));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (int k = 0; k < ElementGet(mesh->cell_type[c])->corners && CellHasPressureNodes(mesh, scene, c); k++) {
      const PetscInt node = PressureNodeOf(mesh, mesh->cell_nodes[mesh->cell_ptr[c] + k]);

      has[node * mesh->dim + scene->bodies[mesh->cell_body[c]].component] = 1;
    }
  PetscCall(MeshSumNodes(mesh, mesh->dim, has));
  for (PetscInt k = PressureNodeOf(mesh, 0) * mesh->dim; k < PressureNodeOf(mesh, mesh->n_pressure_nodes) * mesh->dim;
       k++) {
    constrained[k] = (PetscBool)(has[k] == 0);
    mesh->saddle   = (PetscBool)(mesh->saddle || has[k] > 0);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mesh->saddle, 1, MPIU_BOOL, MPI_LOR, mesh->comm));
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}
