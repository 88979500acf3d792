/* Assembly of the elastic problem from batched element kernels. */
#include "elasticityimpl.h"
#include "mesh/pressurenodes.h"

static PetscLogEvent event_residual, event_tangent, event_insert;

static PetscErrorCode RegisterEvents(void)
{
  static PetscClassId classid = 0;

  PetscFunctionBeginUser;
  if (classid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("Elasticity", &classid));
  PetscCall(PetscLogEventRegister("ElasticResidual", classid, &event_residual));
  PetscCall(PetscLogEventRegister("ElasticTangent", classid, &event_tangent));
  PetscCall(PetscLogEventRegister("ElasticInsert", classid, &event_insert));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the material of a body as the kernels need it. */
static Material BodyMaterial(Scene scene, PetscInt body)
{
  const Material *material = &scene->bodies[body].material;

  return scene->kinematics == KINEMATICS_SMALL && !MaterialGetLaw(material->law)->plastic ? MaterialLinearise(material)
                                                                                          : *material;
}

/* Gives the kernel of a body's cells. A formulation that the user has not named gives way where it does not exist. */
static KernelCase BodyKernel(Scene scene, PetscInt body, ElementType type)
{
  const Material material = BodyMaterial(scene, body);
  KernelCase     kernel   = {.type        = type,
                             .geometry    = scene->geometry,
                             .kinematics  = scene->kinematics,
                             .law         = material.law,
                             .formulation = scene->bodies[body].formulation,
                             .n_constants = material.n_constants,
                             .condensed   = scene->bodies[body].condensed,
                             .component   = scene->bodies[body].component,
                             .thin        = scene->plane_stress};

  if (scene->bodies[body].chosen && !ElementKernelExists(&kernel)) kernel.formulation = FORMULATION_FULL;
  return kernel;
}

/* Compares two kernels of one scene, whose geometry and kinematics are the same. */
static PetscBool SameKernel(const KernelCase *a, const KernelCase *b)
{
  return a->type == b->type && a->law == b->law && a->formulation == b->formulation &&
             a->n_constants == b->n_constants && a->condensed == b->condensed && a->component == b->component &&
             (a->plastic ? a->plastic->hardening : NULL) == (b->plastic ? b->plastic->hardening : NULL)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Sorts the cells into groups, in the order in which new kinds appear: sets cell_group and cell_slot. */
static PetscErrorCode GroupCells(Elasticity e, Scene scene)
{
  const Mesh mesh = e->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(ELEMENT_TYPES * (size_t)scene->n_bodies, &e->groups));
  PetscCall(PetscMalloc3(mesh->n_cells, &e->cell_group, mesh->n_cells, &e->cell_slot, mesh->n_cells, &e->cell_modulus));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Material    *material = &scene->bodies[mesh->cell_body[c]].material;
    const PlasticBatch plastic  = {.hardening = &material->hardening, .umat = material->umat};
    KernelCase         kernel   = BodyKernel(scene, mesh->cell_body[c], mesh->cell_type[c]);
    int                g        = 0;

    if (MaterialGetLaw(kernel.law)->plastic) kernel.plastic = &plastic;
    while (g < e->n_groups && !SameKernel(&e->groups[g].kernel, &kernel)) g++;
    if (g == e->n_groups) {
      CellGroup *group = &e->groups[e->n_groups++];

      *group = (CellGroup){.kernel = kernel, .nodes = ElementNodes(&kernel), .plastic = plastic};
      if (kernel.plastic) group->kernel.plastic = &group->plastic;
      for (int i = 0; i < e->dim; i++) group->plastic.origin[i] = mesh->centre[i];
      if (plastic.umat) group->plastic.fault = group->fault;
    }
    e->cell_group[c]   = g;
    e->cell_slot[c]    = e->groups[g].n_cells++;
    e->cell_modulus[c] = scene->bodies[mesh->cell_body[c]].material.E;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityCellStates - counts the numbers of the plastic state of one cell; 0 where its law has none.

  Not collective

  Input Parameter:
. g - the group of the cell
@*/
size_t ElasticityCellStates(const CellGroup *g)
{
  return g->kernel.plastic ? (size_t)(ElementStatePoints(&g->kernel) * ElementStates(&g->kernel)) : 0;
}

static PetscErrorCode AllocateGroup(CellGroup *g, int dim)
{
  size_t lanes;

  PetscFunctionBeginUser;
  g->n_batches = (g->n_cells + KERNEL_LANES - 1) / KERNEL_LANES;
  lanes        = (size_t)g->n_batches * KERNEL_LANES;
  PetscCall(PetscCalloc3(lanes, &g->cell, lanes * g->nodes, &g->node,
                         lanes * g->nodes * g->nodes + PREFETCH_PAIRS * KERNEL_LANES, &g->block));
  PetscCall(PetscMalloc2(lanes * g->nodes * dim, &g->X, lanes * g->kernel.n_constants, &g->constants));
  if (g->kernel.plastic) PetscCall(PetscCalloc1(lanes * ElasticityCellStates(g), &g->state));
  if (g->kernel.plastic && !g->plastic.umat)
    PetscCall(PetscCalloc1(g->n_cells * ElementStatePoints(&g->kernel) * PLASTIC_FLOW, &g->flow));
  if (g->plastic.umat) PetscCall(PetscMalloc1(lanes, &g->length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the nodes of a cell, with those of its pressures. */
static void GetNodes(Elasticity e, const CellGroup *g, PetscInt c, PetscInt nodes[ELEMENT_MAX_NODES])
{
  const Mesh mesh  = e->mesh;
  const int  count = ElementGet(g->kernel.type)->nodes;

  for (int a = 0; a < count; a++) {
    nodes[a] = mesh->cell_nodes[mesh->cell_ptr[c] + a];
    if (count + a < g->nodes) nodes[count + a] = PressureNodeOf(mesh, nodes[a]);
  }
}

/* Lists the nodes to which a cell is coupled: its own, and that of the bolt of which it is part. Returns how many. */
static int CoupledNodes(Elasticity e, PetscInt c, PetscInt nodes[ELEMENT_MAX_NODES + 1])
{
  const CellGroup *g    = &e->groups[e->cell_group[c]];
  const PetscInt   bolt = g->bolt ? g->bolt[e->cell_slot[c]] : -1;

  GetNodes(e, g, c, nodes);
  if (bolt >= 0) nodes[g->nodes] = bolt;
  return g->nodes + (bolt >= 0);
}

/* The bolt that is body number `body` of the scene, or NULL. */
static const MeshTool *FindBolt(Mesh mesh, int body)
{
  for (int k = 0; k < mesh->n_tools; k++)
    if (mesh->tools[k].bolt && mesh->tools[k].body == body) return &mesh->tools[k];
  return NULL;
}

/* Notes what the shortening of a bolt does to its cells: the displacement along the axis grows from one end to the
   other by the shortening, so that the strain grows by shortening over length. The work of the cells' stresses on it is
   the mean of the tension times the shortening. */
static PetscErrorCode SetBolts(Elasticity e, CellGroup *g)
{
  const Mesh   mesh  = e->mesh;
  const size_t lanes = (size_t)g->n_batches * KERNEL_LANES;
  PetscBool    any   = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (size_t s = 0; s < lanes; s++) any = (PetscBool)(any || FindBolt(mesh, mesh->cell_body[g->cell[s]]));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(lanes * g->nodes * e->dim, &g->pull, lanes, &g->bolt));
  for (size_t s = 0; s < lanes; s++) {
    const MeshTool *bolt  = FindBolt(mesh, mesh->cell_body[g->cell[s]]);
    const size_t    batch = s / KERNEL_LANES, lane = s % KERNEL_LANES;

    g->bolt[s] = bolt ? bolt->node : -1;
    for (int a = 0; bolt && a < ElementGet(g->kernel.type)->nodes; a++) {
      const size_t first = (batch * g->nodes + a) * e->dim;
      PetscReal    along = 0;

      for (int i = 0; i < e->dim; i++) along += bolt->bolt->axis[i] * g->X[(first + i) * KERNEL_LANES + lane];
      for (int i = 0; i < e->dim; i++)
        g->pull[(first + i) * KERNEL_LANES + lane] = bolt->bolt->axis[i] * along / bolt->length;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills a slot of a group with a cell. The last cell also fills the rest of its batch. */
static void SetCell(Elasticity e, Scene scene, CellGroup *g, PetscInt slot, PetscInt c)
{
  const Mesh     mesh     = e->mesh;
  const Material material = BodyMaterial(scene, mesh->cell_body[c]);
  const PetscInt end      = slot == g->n_cells - 1 ? g->n_batches * KERNEL_LANES : slot + 1;
  PetscInt       nodes[ELEMENT_MAX_NODES];
  PetscReal      X[MAX_DOFS];

  GetNodes(e, g, c, nodes);
  for (int a = 0; a < g->nodes && g->length; a++)
    for (int i = 0; i < e->dim; i++) X[a * e->dim + i] = mesh->coords[nodes[a] * e->dim + i];
  for (PetscInt s = slot; s < end; s++) {
    const size_t batch = s / KERNEL_LANES, lane = s % KERNEL_LANES;

    g->cell[s] = c;
    if (g->length) g->length[s] = CellLength(g->kernel.type, e->dim, X);
    for (int k = 0; k < material.n_constants; k++)
      g->constants[(batch * material.n_constants + k) * KERNEL_LANES + lane] = material.constants[k];
    for (int a = 0; a < g->nodes; a++) {
      g->node[(batch * g->nodes + a) * KERNEL_LANES + lane] = nodes[a];
      for (int i = 0; i < e->dim; i++)
        g->X[((batch * g->nodes + a) * e->dim + i) * KERNEL_LANES + lane] = mesh->coords[nodes[a] * e->dim + i];
    }
  }
}

/* Lists the cells around every node as a CSR. */
static PetscErrorCode NodeCells(Elasticity e, PetscInt **ptr, PetscInt **cells)
{
  const Mesh mesh = e->mesh;
  PetscInt   nodes[ELEMENT_MAX_NODES + 1], *p, *list;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes + 2, &p));
  PetscCall(PetscMalloc1(
    (mesh->has_pressures ? 2 : 1) * (mesh->n_cells ? mesh->cell_ptr[mesh->n_cells] : 0) + mesh->n_cells, &list));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const int n = CoupledNodes(e, c, nodes);

    for (int k = 0; k < n; k++) p[nodes[k] + 2]++;
  }
  for (PetscInt n = 0; n < mesh->n_nodes; n++) p[n + 2] += p[n + 1];
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const int n = CoupledNodes(e, c, nodes);

    for (int k = 0; k < n; k++) list[p[nodes[k] + 1]++] = c;
  }
  *ptr   = p;
  *cells = list;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the nodes that share a cell with a node, ascending. mark[] holds the last node for which each one was counted.
 */
static PetscErrorCode NodeNeighbours(Elasticity e, PetscInt node, const PetscInt *ptr, const PetscInt *cells,
                                     PetscInt *mark, PetscInt *neighbours, PetscInt *count)
{
  const Mesh mesh = e->mesh;

  PetscFunctionBeginUser;
  *count = 0;
  for (int k = 0; k < mesh->n_tools && node >= mesh->n_body_nodes; k++) /* of a tool, which may have no cells */
    for (PetscInt n = mesh->tools[k].node; n < mesh->tools[k].node + TOOL_NODES; n++)
      if (node >= mesh->tools[k].node && node < mesh->tools[k].node + TOOL_NODES) {
        mark[n]                = node;
        neighbours[(*count)++] = n;
      }
  for (PetscInt k = ptr[node]; k < ptr[node + 1]; k++) {
    PetscInt  nodes[ELEMENT_MAX_NODES + 1];
    const int n_coupled = CoupledNodes(e, cells[k], nodes);

    for (int m = 0; m < n_coupled; m++) {
      const PetscInt n = nodes[m];

      if (mark[n] == node) continue;
      mark[n]                = node;
      neighbours[(*count)++] = n;
    }
  }
  PetscCall(PetscSortInt(*count, neighbours));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the scatter map for all pairs (node, b) of the cells around a node. place[n] is where column n is in its row. */
static void SetBlocks(Elasticity e, PetscInt node, const PetscInt *ptr, const PetscInt *cells, const PetscInt *place)
{
  for (PetscInt k = ptr[node]; k < ptr[node + 1]; k++) {
    const PetscInt c    = cells[k];
    CellGroup     *g    = &e->groups[e->cell_group[c]];
    const PetscInt slot = e->cell_slot[c], end = slot == g->n_cells - 1 ? g->n_batches * KERNEL_LANES : slot + 1;
    PetscInt       nodes[ELEMENT_MAX_NODES];

    GetNodes(e, g, c, nodes);
    for (int a = 0; a < g->nodes; a++) {
      if (nodes[a] != node) continue;
      for (PetscInt s = slot; s < end; s++) {
        for (int b = 0; b < g->nodes; b++)
          g->block[(((size_t)(s / KERNEL_LANES) * g->nodes + a) * g->nodes + b) * KERNEL_LANES + s % KERNEL_LANES] =
            place[nodes[b]];
      }
    }
  }
}

/* Makes the pattern of the block CSR and the scatter maps into it. */
static PetscErrorCode CreateBlocks(Elasticity e)
{
  const Mesh mesh = e->mesh;
  PetscInt  *ptr = NULL, *cells = NULL, *mark, *neighbours, count = 0;
  PetscCount total = 0;

  PetscFunctionBeginUser;
  PetscCall(NodeCells(e, &ptr, &cells));
  PetscCall(PetscMalloc2(mesh->n_nodes, &mark, mesh->n_nodes, &neighbours));
  PetscCall(PetscMalloc1(mesh->n_nodes + 1, &e->row));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) mark[n] = -1;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscCall(PetscIntCast(total, &e->row[n]));
    PetscCall(NodeNeighbours(e, n, ptr, cells, mark, neighbours, &count));
    total += count;
  }
  PetscCall(PetscIntCast(total, &e->row[mesh->n_nodes]));
  PetscCall(PetscMalloc1(total, &e->column));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) mark[n] = -1;
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    PetscCall(NodeNeighbours(e, n, ptr, cells, mark, &e->column[e->row[n]], &count));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscInt *place = mark;

    for (PetscInt k = e->row[n]; k < e->row[n + 1]; k++) place[e->column[k]] = k;
    SetBlocks(e, n, ptr, cells, place);
  }
  PetscCall(PetscFree2(mark, neighbours));
  PetscCall(PetscFree(ptr));
  PetscCall(PetscFree(cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBuffers(Elasticity e)
{
  PetscReal *aligned;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc((size_t)(MAX_DOFS + 3) * MAX_DOFS * KERNEL_LANES * sizeof(PetscReal) + BYTES_OF_CACHE_LINE,
                        &e->buffer));
  aligned =
    (PetscReal *)(((PETSC_UINTPTR_T)e->buffer + BYTES_OF_CACHE_LINE - 1) / BYTES_OF_CACHE_LINE * BYTES_OF_CACHE_LINE);
  e->u   = aligned;
  e->u_0 = e->u + MAX_DOFS * KERNEL_LANES;
  e->f   = e->u_0 + MAX_DOFS * KERNEL_LANES;
  e->K   = e->f + MAX_DOFS * KERNEL_LANES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether elements treat only a part of the modulus of the volume. Of elements those with a constant pressure
   project the largest part. */
static PetscBool VolumeIsStiff(Scene scene, PetscInt body)
{
  const Material   material = BodyMaterial(scene, body);
  const KernelCase kernel   = BodyKernel(scene, body, ELEMENT_QUAD4);
  VolumeModuli     moduli;

  ElementVolumeModuli(&kernel, material.constants, 1, &moduli);
  return (PetscBool)(moduli.kappa < moduli.projected);
}

/* Counts the multipliers, and makes room for those of the present, the accepted and the kept states. A mixed group has
   some if the volume of one of its cells is too stiff. */
static PetscErrorCode ElasticityCreateVolumes(Elasticity e, Scene scene)
{
  PetscInt   n = 0, n_yielding = 0;
  PetscBool *stiff;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(scene->n_bodies, &stiff));
  for (int b = 0; b < scene->n_bodies; b++) {
    stiff[b]    = (PetscBool)(!scene->bodies[b].rigid && scene->bodies[b].formulation == FORMULATION_MIXED &&
                           VolumeIsStiff(scene, b));
    e->augments = (PetscBool)(e->augments || stiff[b]);
  }
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g    = &e->groups[k];
    PetscBool  some = PETSC_FALSE;

    for (PetscInt c = 0; c < g->n_cells && ElementPressures(&g->kernel); c++)
      some = (PetscBool)(some || stiff[e->mesh->cell_body[g->cell[c]]]);
    g->yielding    = ElementPressures(&g->kernel) ? n_yielding : -1;
    g->multipliers = some ? n : -1;
    n_yielding += g->n_batches * ElementPressures(&g->kernel) * KERNEL_LANES;
    if (some) n += g->n_batches * ElementPressures(&g->kernel) * KERNEL_LANES;
  }
  PetscCall(PetscFree(stiff));
  e->state.n = e->accepted.n = n;
  PetscCall(PetscCalloc2(n, &e->state.multiplier, n, &e->accepted.multiplier));
  for (int k = 0; k < VOLUMES_KEPT; k++) {
    e->kept[k].n = n;
    PetscCall(PetscCalloc1(n, &e->kept[k].multiplier));
  }
  PetscCall(PetscMalloc1(n_yielding, &e->yielding));
  e->may_yield = (PetscBool)(n_yielding > 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &e->may_yield, 1, MPIU_BOOL, MPI_LOR, e->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the kernels the length that makes pressures of nodes unknowns like displacements: the mean size of the cells.
   All these unknowns then have forces and stiffnesses of one magnitude. */
static PetscErrorCode SetLength(Elasticity e)
{
  const Mesh mesh   = e->mesh;
  PetscReal  volume = 0;

  PetscFunctionBeginUser;
  if (!mesh->has_pressures) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *nodes = &mesh->cell_nodes[mesh->cell_ptr[c]];
    PetscReal       X[MAX_DOFS];

    for (int k = 0; k < ElementGet(mesh->cell_type[c])->nodes * e->dim; k++)
      X[k] = mesh->coords[nodes[k / e->dim] * e->dim + k % e->dim];
    volume += CellVolume(mesh->cell_type[c], e->dim, e->dim == 2 ? GEOMETRY_PLANE_STRAIN : GEOMETRY_SOLID, X);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPIU_REAL, MPI_SUM, mesh->comm));
  for (int g = 0; g < e->n_groups; g++)
    e->groups[g].kernel.length = PetscPowReal(volume / (PetscReal)mesh->n_cells_global, 1. / e->dim);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityCreate - prepares the assembly of all local cells: batches, pattern of the local tangent, scatter maps.

  Not collective

  Input Parameters:
+ mesh  - the mesh; it must outlive the elasticity
- scene - geometry, kinematics and the bodies' materials

  Output Parameter:
. elasticity - free it with ElasticityDestroy()
@*/
PetscErrorCode ElasticityCreate(Mesh mesh, Scene scene, Elasticity *elasticity)
{
  Elasticity e;

  PetscFunctionBeginUser;
  PetscCall(RegisterEvents());
  PetscCall(PetscNew(&e));
  e->mesh      = mesh;
  e->dim       = mesh->dim;
  e->symmetric = PETSC_TRUE;
  PetscCall(GroupCells(e, scene));
  PetscCall(SetLength(e));
  for (int g = 0; g < e->n_groups; g++) PetscCall(AllocateGroup(&e->groups[g], e->dim));
  for (PetscInt c = 0; c < mesh->n_cells; c++) SetCell(e, scene, &e->groups[e->cell_group[c]], e->cell_slot[c], c);
  for (int g = 0; g < e->n_groups; g++) PetscCall(SetBolts(e, &e->groups[g]));
  PetscCall(CreateBlocks(e));
  PetscCall(CreateBuffers(e));
  PetscCall(ElasticityCreateVolumes(e, scene));
  *elasticity = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityDestroy - frees the object and its matrix.

  Collective

  Input Parameter:
. elasticity - set to NULL

  Note:
  Not collective if ElasticityMatrix() was never called.
@*/
PetscErrorCode ElasticityDestroy(Elasticity *elasticity)
{
  Elasticity e = *elasticity;

  PetscFunctionBeginUser;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  for (int g = 0; g < e->n_groups; g++) {
    PetscCall(PetscFree3(e->groups[g].cell, e->groups[g].node, e->groups[g].block));
    PetscCall(PetscFree2(e->groups[g].X, e->groups[g].constants));
    PetscCall(PetscFree2(e->groups[g].pull, e->groups[g].bolt));
    PetscCall(PetscFree(e->groups[g].state));
    PetscCall(PetscFree(e->groups[g].flow));
    PetscCall(PetscFree(e->groups[g].length));
  }
  PetscCall(PetscFree(e->groups));
  PetscCall(PetscFree3(e->cell_group, e->cell_slot, e->cell_modulus));
  PetscCall(ElasticityReleaseTangent(e));
  PetscCall(PetscFree(e->row));
  PetscCall(PetscFree(e->column));
  PetscCall(PetscFree(e->buffer));
  PetscCall(PetscFree2(e->state.multiplier, e->accepted.multiplier));
  for (int k = 0; k < VOLUMES_KEPT; k++) PetscCall(PetscFree(e->kept[k].multiplier));
  PetscCall(PetscFree(e->yielding));
  PetscCall(PetscFree(e->enclosed.body));
  PetscCall(NodeMatrixDestroy(&e->matrix));
  PetscCall(PetscFree(*elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the plastic state of a batch, or of one of its cells, the one that the kernel sees. */
static void SelectState(Elasticity e, CellGroup *g, PetscInt batch, int lane)
{
  if (!g->state) return;
  for (int k = 0; k < KERNEL_LANES && g->plastic.umat; k++) {
    g->plastic.number[k] = (int)e->mesh->cell_tag[g->cell[(size_t)batch * KERNEL_LANES + k]];
    g->plastic.length[k] = g->length[(size_t)batch * KERNEL_LANES + k];
  }
  g->plastic.state = g->state + (size_t)batch * KERNEL_LANES * ElasticityCellStates(g);
  g->plastic.lane  = lane;
}

/*@
  ElasticitySetTime - tells the time of the displacements that are evaluated next.

  Not collective

  Input Parameters:
+ e - the elasticity
- t - the time, that is the load parameter; laws with an overstress and routines of users need it
@*/
void ElasticitySetTime(Elasticity e, PetscReal t)
{
  for (int k = 0; k < e->n_groups; k++) {
    e->groups[k].plastic.t  = t;
    e->groups[k].plastic.dt = t - e->accepted_t;
  }
}

/*@
  ElasticityGather - copies the displacements of the nodes of a batch, in the order of ElementKernel(), and selects its
plastic state.

  Not collective

  Input Parameters:
+ e     - the elasticity
. g     - a group
. batch - of that group
- u     - local displacements (length) [n_nodes*dim]

  Output Parameter:
. gathered - [nodes][dim][lanes]
@*/
void ElasticityGather(Elasticity e, CellGroup *g, PetscInt batch, const PetscReal *u, PetscReal *gathered)
{
  const PetscInt *node = &g->node[(size_t)batch * g->nodes * KERNEL_LANES];

  for (int a = 0; a < g->nodes; a++) {
    for (int i = 0; i < e->dim; i++) {
      for (int lane = 0; lane < KERNEL_LANES; lane++)
        gathered[(a * e->dim + i) * KERNEL_LANES + lane] = u[node[a * KERNEL_LANES + lane] * e->dim + i];
    }
  }
  for (int k = 0; g->pull && k < g->nodes * e->dim; k++) {
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
      const PetscInt bolt = g->bolt[(size_t)batch * KERNEL_LANES + lane];

      if (bolt >= 0)
        gathered[k * KERNEL_LANES + lane] +=
          u[bolt * e->dim] * g->pull[((size_t)batch * g->nodes * e->dim + k) * KERNEL_LANES + lane];
    }
  }
  SelectState(e, g, batch, 0);
}

/*@
  ElasticityMultipliersOf - gives the place of a batch with multipliers in an array of all multipliers.

  Not collective

  Input Parameters:
+ g           - a group with multipliers
. batch       - of that group
- multipliers - as in VolumeState
@*/
PetscReal *ElasticityMultipliersOf(const CellGroup *g, PetscInt batch, PetscReal *multipliers)
{
  return &multipliers[g->multipliers + batch * ElementPressures(&g->kernel) * KERNEL_LANES];
}

/* The multipliers of a batch while energies are compared. */
PetscReal *ElasticityYieldingOf(Elasticity e, const CellGroup *g, PetscInt batch)
{
  return &e->yielding[g->yielding + batch * ElementPressures(&g->kernel) * KERNEL_LANES];
}

/*@
  ElasticityMultipliers - gives the present multipliers of a batch of mixed elements, or NULL where they have none.

  Not collective

  Input Parameters:
+ e     - the elasticity
. g     - a group
- batch - of that group
@*/
PetscReal *ElasticityMultipliers(Elasticity e, const CellGroup *g, PetscInt batch)
{
  return g->multipliers < 0 ? NULL : ElasticityMultipliersOf(g, batch, e->state.multiplier);
}

/*@
  ElasticityBatchCells - counts the cells of a batch that are not repetitions.

  Not collective

  Input Parameters:
+ g     - a group
- batch - of that group
@*/
int ElasticityBatchCells(const CellGroup *g, PetscInt batch)
{
  return (int)PetscMin(KERNEL_LANES, g->n_cells - batch * KERNEL_LANES);
}

static void ScatterForce(Elasticity e, const CellGroup *g, PetscInt batch, PetscReal *f, PetscReal *force2)
{
  const PetscInt *node  = &g->node[(size_t)batch * g->nodes * KERNEL_LANES];
  const int       count = ElasticityBatchCells(g, batch);
  PetscReal       sum   = 0;

  for (int a = 0; a < g->nodes; a++) {
    for (int i = 0; i < e->dim; i++) {
      for (int lane = 0; lane < count; lane++) {
        const PetscReal force = e->f[(a * e->dim + i) * KERNEL_LANES + lane];

        if (f) f[node[a * KERNEL_LANES + lane] * e->dim + i] += force;
        sum += force * force;
      }
    }
  }
  if (force2) *force2 += sum;
  for (int lane = 0; g->pull && f && lane < count; lane++) {
    const PetscInt bolt = g->bolt[(size_t)batch * KERNEL_LANES + lane];

    for (int k = 0; k < g->nodes * e->dim && bolt >= 0; k++)
      f[bolt * e->dim] +=
        g->pull[((size_t)batch * g->nodes * e->dim + k) * KERNEL_LANES + lane] * e->f[k * KERNEL_LANES + lane];
  }
}

/*@
  ElasticityResidual - computes internal forces and strain energy of this rank's cells.

  Not collective

  Input Parameters:
+ e - the elasticity
- u - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ f      - internal forces [n_nodes*dim], added to; not summed over ranks
. energy - strain energy of this rank's cells, added to
. force2 - sum of the squares of the element forces before assembly, added to
- ok     - PETSC_FALSE where some det F is not positive, or not a number; f is filled all the same

  Note:
  f, energy and force2 may be NULL. ElasticityInvertedCell() then tells which cell it was.
@*/
PetscErrorCode ElasticityResidual(Elasticity e, const PetscReal *u, PetscReal *f, PetscReal *energy, PetscReal *force2,
                                  PetscBool *ok)
{
  const PetscBool forces = (PetscBool)(f || force2);
  PetscReal       W[KERNEL_LANES], J[KERNEL_LANES];

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(event_residual, 0, 0, 0, 0));
  *ok         = PETSC_TRUE;
  e->inverted = -1;
  e->fault    = 0;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup      *g      = &e->groups[k];
    const size_t    dofs   = (size_t)g->nodes * e->dim;
    const PetscBool yields = (PetscBool)(e->yields && (!forces || e->forces) && g->yielding >= 0);
    KernelCase      kernel = g->kernel;

    kernel.yields = yields;
    for (PetscInt batch = 0; batch < g->n_batches; batch++) {
      const size_t first = (size_t)batch * KERNEL_LANES;

      ElasticityGather(e, g, batch, u, e->u);
      ElementKernel(&kernel, &g->X[first * dofs], e->u, NULL, &g->constants[first * g->kernel.n_constants],
                    yields ? ElasticityYieldingOf(e, g, batch) : ElasticityMultipliers(e, g, batch), energy ? W : NULL,
                    forces ? e->f : NULL, NULL, J);
      if (forces) ScatterForce(e, g, batch, f, force2);
      for (int lane = 0; lane < ElasticityBatchCells(g, batch); lane++) {
        if (energy) *energy += W[lane];
        if (J[lane] > 0) continue;
        *ok         = PETSC_FALSE;
        e->inverted = g->cell[first + lane];
        e->fault    = g->plastic.fault ? g->fault[lane] : 0;
      }
    }
  }
  PetscCall(PetscLogEventEnd(event_residual, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds K of a batch to the block CSR, pair of nodes by pair of nodes: the lanes of a pair are read once, and each
   block is contiguous. dim and count are constants where this is inlined. */
static inline __attribute__((always_inline)) void ScatterTangent(Elasticity e, const CellGroup *g, PetscInt batch,
                                                                 const int dim, const int count)
{
  const int       n     = g->nodes;
  const PetscInt *block = &g->block[(size_t)batch * n * n * KERNEL_LANES];

  for (int a = 0; a < n; a++) {
    for (int b = 0; b < n; b++, block += KERNEL_LANES) {
      const PetscReal *K = &e->K[((size_t)a * dim * n + b) * dim * KERNEL_LANES];

      for (int lane = 0; lane < count; lane++) { /* a block of 3 x 3 doubles is on two cache lines */
        const PetscReal *ahead = &e->value[(size_t)block[PREFETCH_PAIRS * KERNEL_LANES + lane] * dim * dim];

        __builtin_prefetch(ahead, 1);
        __builtin_prefetch(ahead + dim * dim - 1, 1);
      }
      for (int lane = 0; lane < count; lane++) {
        PetscReal *value = &e->value[(size_t)block[lane] * dim * dim];

        for (int i = 0; i < dim; i++) {
          for (int j = 0; j < dim; j++) value[i * dim + j] += K[(i * n * dim + j) * KERNEL_LANES + lane];
        }
      }
    }
  }
}

/* Adds the couplings of the cells of bolts in a batch with the shortening of their bolts. */
static PetscErrorCode AddBolts(Elasticity e, const CellGroup *g, PetscInt batch)
{
  const int dim = e->dim, dofs = g->nodes * dim, width = dofs + dim;
  PetscReal ke[(MAX_DOFS + 3) * (MAX_DOFS + 3)];
  PetscInt  nodes[ELEMENT_MAX_NODES + 1];

  PetscFunctionBeginUser;
  for (int lane = 0; lane < ElasticityBatchCells(g, batch); lane++) {
    const size_t     slot = (size_t)batch * KERNEL_LANES + lane;
    const PetscReal *pull = &g->pull[(size_t)batch * dofs * KERNEL_LANES + lane];

    if (g->bolt[slot] < 0) continue;
    (void)CoupledNodes(e, g->cell[slot], nodes);
    PetscCall(PetscArrayzero(ke, width * width));
    for (int i = 0; i < dofs; i++) {
      for (int j = 0; j < dofs; j++) {
        const PetscReal k = e->K[((size_t)i * dofs + j) * KERNEL_LANES + lane];

        ke[i * width + dofs] += k * pull[j * KERNEL_LANES];
        ke[dofs * width + j] += pull[i * KERNEL_LANES] * k;
        ke[dofs * width + dofs] += pull[i * KERNEL_LANES] * k * pull[j * KERNEL_LANES];
      }
    }
    PetscCall(ElasticityAddBlock(e, g->nodes + 1, nodes, ke));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityTangent - assembles the tangent of this rank's cells into the local block CSR, which is zeroed first.

  Not collective

  Input Parameters:
+ e         - the elasticity
. u         - local displacements (length) [n_nodes*dim]
- reference - the state from which stresses are extrapolated, u as above; NULL: the tangent has the stresses of u
@*/
PetscErrorCode ElasticityTangent(Elasticity e, const PetscReal *u, const StressReference *reference)
{
  const StressReference gathered = {e->u_0, reference ? reference->rate : 0, reference ? reference->held : 0};
  const size_t          entries  = (size_t)e->row[e->mesh->n_nodes] * e->dim * e->dim;
  PetscReal             J[KERNEL_LANES];

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(event_tangent, 0, 0, 0, 0));
  if (!e->value) PetscCall(PetscMalloc1(entries, &e->value));
  PetscCall(PetscArrayzero(e->value, entries));
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup      *g            = &e->groups[k];
    const size_t    dofs         = (size_t)g->nodes * e->dim;
    const PetscBool extrapolates = (PetscBool)(reference && ElementExtrapolates(&g->kernel));

    for (PetscInt batch = 0; batch < g->n_batches; batch++) {
      const size_t first = (size_t)batch * KERNEL_LANES;
      const int    count = ElasticityBatchCells(g, batch);

      ElasticityGather(e, g, batch, u, e->u);
      if (extrapolates) ElasticityGather(e, g, batch, reference->u, e->u_0);
      ElementKernel(&g->kernel, &g->X[first * dofs], e->u, extrapolates ? &gathered : NULL,
                    &g->constants[first * g->kernel.n_constants], ElasticityMultipliers(e, g, batch), NULL, NULL, e->K,
                    J);
      if (count < KERNEL_LANES)
        ScatterTangent(e, g, batch, e->dim, count);
      else if (e->dim == 3)
        ScatterTangent(e, g, batch, 3, KERNEL_LANES);
      else
        ScatterTangent(e, g, batch, 2, KERNEL_LANES);
      if (g->pull) PetscCall(AddBolts(e, g, batch));
    }
  }
  PetscCall(PetscLogEventEnd(event_tangent, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityReleaseTangent - frees the local block CSR until the next ElasticityTangent().

  Not collective

  Input Parameter:
. e - the elasticity, after ElasticityMatrix()

  Note:
  The parallel matrix stays. ElasticityAddBlock() and the products with the local block CSR need the next tangent.
@*/
PetscErrorCode ElasticityReleaseTangent(Elasticity e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(e->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses work with a local block CSR that was released. A rank without nodes has none. */
static PetscErrorCode CheckTangent(Elasticity e)
{
  PetscFunctionBeginUser;
  PetscCheck(e->value || !e->row[e->mesh->n_nodes], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "there is no tangent");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityExtrapolates - says whether a StressReference changes the tangent of any cell.

  Collective

  Input Parameter:
. e - the elasticity

  Output Parameters:
+ any    - the same on all ranks, which then take part in changing multipliers together
- rubber - some of them are of bodies that do not yield, and the pressure of the volume is what changes
@*/
PetscErrorCode ElasticityExtrapolates(Elasticity e, PetscBool *any, PetscBool *rubber)
{
  PetscFunctionBeginUser;
  *any = *rubber = PETSC_FALSE;
  for (int g = 0; g < e->n_groups; g++) {
    const KernelCase *kernel = &e->groups[g].kernel;
    const ElasticLaw *law    = MaterialGetLaw(kernel->law);

    if (!ElementExtrapolates(kernel)) continue;
    *any    = PETSC_TRUE;
    *rubber = (PetscBool)(*rubber || (law->separable && !law->plastic));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, e->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rubber, 1, MPIU_BOOL, MPI_LOR, e->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityAddBlock - adds a dense block of dofs to the local block CSR.

  Not collective

  Input Parameters:
+ e     - the elasticity
. n     - number of nodes
. nodes - local nodes, all of one local cell or of the bolt of which it is part
- k     - [n*dim][n*dim], row-major, dofs node by node

  Note:
  For follower loads on the faces of local cells. If the block is not symmetric, ElasticitySetSymmetric() must have
  been told so.
@*/
PetscErrorCode ElasticityAddBlock(Elasticity e, PetscInt n, const PetscInt nodes[], const PetscReal k[])
{
  const int dim = e->dim;

  PetscFunctionBeginUser;
  PetscCall(CheckTangent(e));
  for (PetscInt a = 0; a < n; a++) {
    const PetscInt row = e->row[nodes[a]];

    for (PetscInt b = 0; b < n; b++) {
      PetscInt   place;
      PetscReal *value;

      PetscCall(PetscFindInt(nodes[b], e->row[nodes[a] + 1] - row, &e->column[row], &place));
      PetscCheck(place >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "nodes %" PetscInt_FMT " and %" PetscInt_FMT " share no local cell", nodes[a], nodes[b]);
      value = &e->value[(size_t)(row + place) * dim * dim];
      for (int i = 0; i < dim; i++) {
        for (int j = 0; j < dim; j++) value[i * dim + j] += k[(a * dim + i) * n * dim + b * dim + j];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityMultiplyLocal - multiplies by the local block CSR, supported and imposed dofs included: y += K x.

  Not collective

  Input Parameters:
+ e - the elasticity
- x - local vector [n_nodes*dim]

  Output Parameter:
. y - local vector [n_nodes*dim], added to; not summed over ranks
@*/
PetscErrorCode ElasticityMultiplyLocal(Elasticity e, const PetscReal *x, PetscReal *y)
{
  const int dim = e->dim;

  PetscFunctionBeginUser;
  PetscCall(CheckTangent(e));
  for (PetscInt n = 0; n < e->mesh->n_nodes; n++) {
    for (PetscInt k = e->row[n]; k < e->row[n + 1]; k++) {
      const PetscReal *value = &e->value[(size_t)k * dim * dim], *xk = &x[e->column[k] * dim];

      for (int i = 0; i < dim; i++) {
        for (int j = 0; j < dim; j++) y[n * dim + i] += value[i * dim + j] * xk[j];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityMultiplyTransposed - multiplies by the transposed local block CSR, supported and imposed dofs included:
  y += K^T x.

  Not collective

  Input Parameters:
+ e - the elasticity
- x - local vector [n_nodes*dim], ghosts included

  Output Parameter:
. y - local vector [n_nodes*dim], added to; not summed over ranks
@*/
PetscErrorCode ElasticityMultiplyTransposed(Elasticity e, const PetscReal *x, PetscReal *y)
{
  const int dim = e->dim;

  PetscFunctionBeginUser;
  PetscCall(CheckTangent(e));
  for (PetscInt n = 0; n < e->mesh->n_nodes; n++) {
    for (PetscInt k = e->row[n]; k < e->row[n + 1]; k++) {
      const PetscReal *value = &e->value[(size_t)k * dim * dim];
      PetscReal       *yk    = &y[e->column[k] * dim];

      for (int i = 0; i < dim; i++) {
        for (int j = 0; j < dim; j++) yk[j] += value[i * dim + j] * x[n * dim + i];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticitySetSymmetric - sets whether the tangent is symmetric, with the blocks that others add.

  Logically collective

  Input Parameters:
+ e         - the elasticity
- symmetric - PETSC_TRUE is the default

  Note:
  Call it before the first ElasticityMatrix().
@*/
PetscErrorCode ElasticitySetSymmetric(Elasticity e, PetscBool symmetric)
{
  PetscFunctionBeginUser;
  PetscCheck(!e->matrix, e->mesh->comm, PETSC_ERR_ARG_WRONGSTATE, "the matrix exists already");
  e->symmetric = symmetric;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the free dofs that this rank owns. */
static PetscErrorCode CountOwnedDofs(Mesh mesh, const PetscInt *dofs, PetscInt *count)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  *count = 0;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    for (int i = 0; i < mesh->dim && mesh->node_owner[n] == rank; i++) *count += dofs[n * mesh->dim + i] >= 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joins the pattern with that of another matrix (NULL: none). */
static PetscErrorCode JoinPattern(Elasticity e, Mat other)
{
  PetscFunctionBeginUser;
  PetscCall(NodeMatrixJoin(e->matrix, other));
  if (e->symmetric) {
    PetscCall(MatSetOption(NodeMatrixGet(e->matrix), MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(MatSetOption(NodeMatrixGet(e->matrix), MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ElasticityCreateMatrix(Elasticity e)
{
  NodePairs pairs = {e->dim, e->mesh->n_nodes, NULL, e->row, e->column};
  PetscInt  owned;

  PetscFunctionBeginUser;
  PetscCall(MeshGetGlobalDofs(e->mesh, &pairs.dof));
  PetscCall(CountOwnedDofs(e->mesh, pairs.dof, &owned));
  PetscCall(NodeMatrixCreate(e->mesh->comm, owned, &pairs, &e->matrix));
  PetscCall(JoinPattern(e, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityMatrix - gives the tangent over the global free dofs, from the local block CSRs of all ranks.

  Collective

  Input Parameters:
+ e - the elasticity
- C - the last matrix of ElasticityMatrixJoin(), which is added; NULL: nothing is

  Output Parameters:
+ diagonal - of the tangent without C, over the global free dofs; NULL: not wanted
- matrix   - a parallel AIJ matrix, always the same one; it belongs to the elasticity

  Note:
  The first call creates the matrix.
@*/
PetscErrorCode ElasticityMatrix(Elasticity e, Mat C, Vec diagonal, Mat *matrix)
{
  PetscFunctionBeginUser;
  if (!e->matrix) PetscCall(ElasticityCreateMatrix(e));
  PetscCall(PetscLogEventBegin(event_insert, 0, 0, 0, 0));
  PetscCall(NodeMatrixSet(e->matrix, e->value, C, diagonal));
  PetscCall(PetscLogEventEnd(event_insert, 0, 0, 0, 0));
  *matrix = NodeMatrixGet(e->matrix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityMatrixJoin - makes room in the matrix for what another one adds to it.

  Collective

  Input Parameters:
+ e - the elasticity, after the first ElasticityMatrix()
- C - an AIJ matrix over the global free dofs, in which all dofs of a node are coupled to the same ones

  Note:
  The values of the matrix are undefined until the next ElasticityMatrix().
@*/
PetscErrorCode ElasticityMatrixJoin(Elasticity e, Mat C)
{
  PetscFunctionBeginUser;
  PetscCall(JoinPattern(e, C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticitySlotCoordinates - takes the reference coordinates of one cell out of its batch.

  Not collective

  Input Parameters:
+ e    - the elasticity
. g    - the group of the cell
- slot - its number there

  Output Parameter:
. X - (length) [nodes][dim]
@*/
void ElasticitySlotCoordinates(Elasticity e, const CellGroup *g, PetscInt slot, PetscReal *X)
{
  const size_t dofs = (size_t)g->nodes * e->dim;

  for (size_t k = 0; k < dofs; k++)
    X[k] = g->X[((slot / KERNEL_LANES) * dofs + k) * KERNEL_LANES + slot % KERNEL_LANES];
}

/*@
  ElasticitySlotVolume - computes the reference volume of one cell.

  Not collective

  Input Parameters:
+ e    - the elasticity
. g    - the group of the cell
- slot - its number there
@*/
PetscReal ElasticitySlotVolume(Elasticity e, const CellGroup *g, PetscInt slot)
{
  PetscReal X[MAX_DOFS];

  ElasticitySlotCoordinates(e, g, slot, X);
  return CellVolume(g->kernel.type, e->dim, g->kernel.geometry, X);
}

/*@
  ElasticityGatherCell - takes one cell out of its batch and selects its plastic state.

  Not collective

  Input Parameters:
+ e    - the elasticity
. g    - the group of the cell
. slot - its number there
- u    - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ X         - reference coordinates of its nodes (length) [nodes][dim]
. cell_u    - their displacements (length) [nodes][dim]
. constants - of its law
- m         - its multipliers
@*/
void ElasticityGatherCell(Elasticity e, CellGroup *g, PetscInt slot, const PetscReal *u, PetscReal X[MAX_DOFS],
                          PetscReal cell_u[MAX_DOFS], PetscReal constants[MATERIAL_MAX_CONSTANTS],
                          PetscReal m[MIXED_PRESSURES])
{
  const size_t     batch = slot / KERNEL_LANES, lane = slot % KERNEL_LANES;
  const PetscReal *multipliers = ElasticityMultipliers(e, g, (PetscInt)batch);
  PetscInt         nodes[ELEMENT_MAX_NODES];

  GetNodes(e, g, g->cell[slot], nodes);
  for (int k = 0; k < ElementPressures(&g->kernel); k++) m[k] = multipliers ? multipliers[k * KERNEL_LANES + lane] : 0;
  for (int a = 0; a < g->nodes; a++) {
    for (int i = 0; i < e->dim; i++) {
      X[a * e->dim + i]      = g->X[((batch * g->nodes + a) * e->dim + i) * KERNEL_LANES + lane];
      cell_u[a * e->dim + i] = u[nodes[a] * e->dim + i];
      if (g->pull && g->bolt[slot] >= 0)
        cell_u[a * e->dim + i] +=
          u[g->bolt[slot] * e->dim] * g->pull[((batch * g->nodes + a) * e->dim + i) * KERNEL_LANES + lane];
    }
  }
  for (int k = 0; k < g->kernel.n_constants; k++)
    constants[k] = g->constants[(batch * g->kernel.n_constants + k) * KERNEL_LANES + lane];
  SelectState(e, g, (PetscInt)batch, (int)lane);
}

/*@
  ElasticityVolumeEnergy - computes the part of the strain energy that belongs to the volume alone, of this rank's
cells.

  Not collective

  Input Parameters:
+ e - the elasticity
- u - local displacements (length) [n_nodes*dim], with no inverted cell

  Output Parameter:
. energy - added to

  Note:
  It treats one cell at a time, for diagnosis.
@*/
PetscErrorCode ElasticityVolumeEnergy(Elasticity e, const PetscReal *u, PetscReal *energy)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < e->n_groups; k++) {
    CellGroup *g = &e->groups[k];

    for (PetscInt slot = 0; slot < g->n_cells; slot++) {
      PetscReal X[MAX_DOFS], cell_u[MAX_DOFS], constants[MATERIAL_MAX_CONSTANTS], m[MIXED_PRESSURES];

      ElasticityGatherCell(e, g, slot, u, X, cell_u, constants, m);
      *energy += ElementVolumeEnergy(&g->kernel, X, cell_u, constants, m);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the share of one cell to its nodes. */
static void AddCellStress(Elasticity e, CellGroup *g, PetscInt slot, const PetscReal *u, PetscReal *stress,
                          PetscReal *weight)
{
  const Element  *element = ElementGet(g->kernel.type);
  const PetscInt *nodes   = &e->mesh->cell_nodes[e->mesh->cell_ptr[g->cell[slot]]];
  PetscReal       X[MAX_DOFS], cell_u[MAX_DOFS], point_stress[ELEMENT_MAX_POINTS * 6], point_volume[ELEMENT_MAX_POINTS],
    constants[MATERIAL_MAX_CONSTANTS], m[MIXED_PRESSURES], volume = 0;

  ElasticityGatherCell(e, g, slot, u, X, cell_u, constants, m);
  ElementPointStress(&g->kernel, X, cell_u, constants, m, point_stress, point_volume);
  for (int p = 0; p < element->points; p++) volume += point_volume[p];
  for (int a = 0; a < element->nodes; a++) {
    weight[nodes[a]] += volume;
    for (int p = 0; p < element->points; p++) {
      for (int c = 0; c < 6; c++) stress[nodes[a] * 6 + c] += volume * element->fit[a][p] * point_stress[p * 6 + c];
    }
  }
}

/*@
  ElasticityNodalStress - computes this rank's share of the Cauchy stress at the nodes.

  Not collective

  Input Parameters:
+ e - the elasticity
- u - local displacements (length) [n_nodes*dim]

  Output Parameters:
+ stress - volume of the cells around a node times their stress there [n_nodes*6]: xx yy zz xy yz xz; axisymmetric: rr
           zz hoop rz 0 0
- weight - volume of the cells around a node [n_nodes]

  Note:
  The caller sums both over the ranks and divides. Inside a cell the stress is the least-squares fit of the corner
  shape functions (with one point: a constant) to the stress at the quadrature points, so that second-order cells
  reproduce linear stress fields at every node, on boundaries too. The cells around a node are averaged by their
  volume; they all are of one body, because bodies share no nodes.
@*/
PetscErrorCode ElasticityNodalStress(Elasticity e, const PetscReal *u, PetscReal *stress, PetscReal *weight)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(stress, e->mesh->n_nodes * 6));
  PetscCall(PetscArrayzero(weight, e->mesh->n_nodes));
  for (int g = 0; g < e->n_groups; g++) {
    for (PetscInt slot = 0; slot < e->groups[g].n_cells; slot++)
      AddCellStress(e, &e->groups[g], slot, u, stress, weight);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ElasticityCellModulus - returns Young's modulus (stress) of a local cell, from which the automatic penalty is
  computed.

  Not collective

  Input Parameters:
+ e    - the elasticity
- cell - a local cell
@*/
PetscReal ElasticityCellModulus(Elasticity e, PetscInt cell)
{
  return e->cell_modulus[cell];
}

/*@
  ElasticityInvertedCell - returns a local cell that the last ElasticityResidual() found with det F <= 0, or in which a
  routine of the user failed, or -1.

  Not collective

  Input Parameter:
. e - the elasticity

  Output Parameter:
. fault - of that routine, for UmatTell()
@*/
PetscInt ElasticityInvertedCell(Elasticity e, int *fault)
{
  *fault = e->fault;
  return e->inverted;
}
