/* Nodes for the pressures of mixed triangles and tetrahedra, see pressurenodes.h. */
#include "kernels/elementkernel.h"
#include "mesh/meshdofs.h"
#include "formulationchoice.h"
#include "pressurenodesimpl.h"
#include "base/complaint.h"
#include "base/exchange.h"

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

/* A material with pressures at a node */
typedef struct {
  PetscInt id;
  int      material;
} NodeMaterial;

static void PackNodeMaterial(const void *context, PetscInt i, void *packed)
{
  const NodeMaterial *from = &((const NodeMaterial *)context)[i];
  NodeMaterial       *to   = packed;

  to->id       = from->id;
  to->material = from->material;
}

/* Lists the materials with pressures at the nodes of the slice, in the order of its cells, each at most once in a row.
 */
static PetscErrorCode ListMaterials(Scene scene, const SliceMesh *slice, const int *material, PetscInt *n,
                                    NodeMaterial **list)
{
  int *last;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt c = 0; c < slice->n_cells; c++)
    if (HasPressures(scene, slice->cell_body[c], slice->cell_block[c]->element->type))
      *n += slice->cell_block[c]->nodes;
  PetscCall(PetscMalloc1(*n, list));
  PetscCall(PetscMalloc1(slice->n_nodes, &last));
  for (PetscInt i = 0; i < slice->n_nodes; i++) last[i] = -1;
  *n = 0;
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    const PetscInt *nodes = SliceMeshCellNodes(slice, c);
    const int       own   = material[slice->cell_body[c]];

    if (!HasPressures(scene, slice->cell_body[c], slice->cell_block[c]->element->type)) continue;
    for (int k = 0; k < slice->cell_block[c]->nodes; k++) {
      if (last[nodes[k]] == own) continue;
      last[nodes[k]]  = own;
      (*list)[(*n)++] = (NodeMaterial){.id = slice->id[nodes[k]], .material = own};
    }
  }
  PetscCall(PetscFree(last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the pairs of materials with pressures that share nodes of this home. A node lists one material more than it has
   components, at most, since components fail there anyway. */
static PetscErrorCode MarkBonds(const SliceMesh *slice, int n_bodies, int dim, PetscInt n, const NodeMaterial list[],
                                PetscBool *bonded)
{
  int *known, *count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slice->n_homes * (dim + 1), &known));
  PetscCall(PetscCalloc1(slice->n_homes, &count));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt home = list[i].id - slice->home_start[slice->rank];
    const int      own  = list[i].material;
    int           *at = &known[home * (dim + 1)], *n_known = &count[home], m = 0;

    while (m < *n_known && at[m] != own) m++;
    if (m < *n_known || *n_known > dim) continue;
    for (m = 0; m < *n_known; m++) bonded[own * n_bodies + at[m]] = bonded[at[m] * n_bodies + own] = PETSC_TRUE;
    at[(*n_known)++] = own;
  }
  PetscCall(PetscFree(known));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the pairs of materials with pressures that share nodes: bonded [n_bodies][n_bodies], on all ranks. */
static PetscErrorCode FindBonds(Scene scene, const SliceMesh *slice, int dim, const int *material, PetscBool *bonded)
{
  NodeMaterial *mine, *list;
  PetscInt      n;
  PetscMPIInt  *to;

  PetscFunctionBeginUser;
  PetscCall(ListMaterials(scene, slice, material, &n, &mine));
  PetscCall(PetscMalloc1(n, &to));
  for (PetscInt i = 0; i < n; i++) to[i] = SliceMeshRankOf(slice, slice->home_start, mine[i].id);
  PetscCall(ExchangeRecords(slice->comm, sizeof(NodeMaterial), n, to, PackNodeMaterial, mine, &n, (void **)&list));
  PetscCall(MarkBonds(slice, scene->n_bodies, dim, n, list, bonded));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bonded, scene->n_bodies * scene->n_bodies, MPIU_BOOL, MPI_LOR, slice->comm));
  PetscCall(PetscFree(list));
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(to));
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

/* Gives bodies of different materials that share nodes different components, and says which bodies these are. */
static PetscErrorCode SeparateBonded(Scene scene, const SliceMesh *slice, int dim, int *component, int *shares)
{
  const int  n = scene->n_bodies;
  int       *material;
  PetscBool *bonded;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &material));
  PetscCall(PetscCalloc1(n * n, &bonded));
  SortMaterials(scene, material);
  PetscCall(FindBonds(scene, slice, dim, material, bonded));
  ChooseComponents(n, dim, material, bonded, component);
  for (int b = 0; b < n; b++)
    for (int a = 0; a < n && material[b] >= 0; a++) shares[b] |= bonded[material[b] * n + a];
  PetscCall(PetscFree(material));
  PetscCall(PetscFree(bonded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a body that has found no component, and whose elements, of first order, cannot condense their pressures. */
static PetscErrorCode RefuseCrowded(Scene scene, const SliceMesh *slice, Mesh mesh, const int *component)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < slice->n_cells; c++) {
    const SceneBody *body = &scene->bodies[slice->cell_body[c]];

    if (component[slice->cell_body[c]] < mesh->dim) continue;
    if (HasPressures(scene, slice->cell_body[c], slice->cell_block[c]->element->type))
      Complain(&complaint,
               "%s: body '%s' of mixed %s shares nodes with bodies of %d other materials, whose pressures leave none "
               "for it; allowed: mesh.order: 2",
               SceneWhere(scene, body->path, "material"), body->name, slice->cell_block[c]->element->name,
               (int)mesh->dim);
  }
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Condenses pressures where the linear solver iterates, which is not for tangents of a saddle. */
static PetscErrorCode CondenseAll(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  int all = scene->solver.type == SOLVER_ITERATIVE;

  PetscFunctionBeginUser;
  if (scene->solver.type == SOLVER_AUTO && mesh->dim == 3 &&
      mesh->dim * slice->home_start[slice->size] > SOLVER_DIRECT_DOFS)
    all = 1;
  for (int b = 0; b < scene->n_bodies; b++) scene->bodies[b].condensed = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the components of the bodies. Elements of second order condense their pressures where bodies of different
   materials share nodes: on the same mesh the force of two bonded blocks is 0.3 % off then, 1.5 % with components. */
static PetscErrorCode SetComponents(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  const int      n = scene->n_bodies;
  int           *component;
  PetscErrorCode refused;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &component));
  PetscCall(SeparateBonded(scene, slice, (int)mesh->dim, component, component + n));
  for (int b = 0; b < n; b++) {
    scene->bodies[b].component = component[b] < mesh->dim ? component[b] : 0;
    scene->bodies[b].condensed |= component[n + b];
    if (component[b] >= mesh->dim) FormulationsCrowded(&scene->bodies[b]);
  }
  refused = RefuseCrowded(scene, slice, mesh, component);
  PetscCall(PetscFree(component));
  PetscCall(refused);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  PressureNodesExist - finds out whether a mesh needs nodes for pressures.

  Collective

  Input Parameters:
+ scene - its bodies, of which condensed and component are set
. slice - after SliceRead()
- mesh  - has_pressures is set
@*/
PetscErrorCode PressureNodesExist(Scene scene, const SliceMesh *slice, Mesh mesh)
{
  PetscFunctionBeginUser;
  PetscCall(CondenseAll(scene, slice, mesh));
  PetscCall(SetComponents(scene, slice, mesh));
  for (PetscInt c = 0; c < slice->n_cells && !mesh->has_pressures; c++)
    mesh->has_pressures = HasPressures(scene, slice->cell_body[c], slice->cell_block[c]->element->type);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mesh->has_pressures, 1, MPIU_BOOL, MPI_LOR, mesh->comm));
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
