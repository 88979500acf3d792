/* Lists of a pair: contact nodes and their owners, points and slave points as combinations of nodes, and their
   motion. */
#include "searchimpl.h"
#include "ring.h"
#include "pointseen.h"
#include "base/smoothstep.h"

/* Cosine of the angle between the slave's outward normal and the master's inward one: up to 72 degrees a point takes
   part with its whole area, from 87 degrees on (SEARCH_OPPOSED_NOT) not at all. Surfaces that press on each other are
   opposed but for the turns of their faces, of which the largest is that of the corner of a cube that points at the
   master, 55 degrees. The bounds lie as far beyond it as they can: nearer to it, the normals of soft bodies turn by as
   much at an edge, and the part that takes part answers them. */
#define OPPOSED_FULLY 0.30

/* Keys of all contact nodes, each once and in ascending order: nodes of deformable bodies, then nodes of a rigid
   tool or points on its edges. */
typedef struct {
  PetscInt n, n_rigid;
  NodeKey *keys, *tool;
} ContactKeys;

/* The key of a local node. */
static NodeKey ToolKey(Mesh mesh, PetscInt node)
{
  NodeKey key = {mesh->node_id[node], mesh->node_owner[node], mesh->node_owner_local[node], {0, 0, 0}};

  for (int d = 0; d < mesh->dim; d++) key.X[d] = mesh->coords[node * mesh->dim + d];
  return key;
}

/* Marks the nodes of which the slave points of the lists and their levers are made, and returns their number. */
static PetscInt MarkSlaveNodes(ContactSearch s, NeighbourLists lists, char *marks)
{
  const SlavePoints slaves = s->slaves;
  PetscInt          n      = 0;

  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q = lists->near[i];

    for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++) marks[slaves->node[k]] = 1;
    for (PetscInt k = slaves->lever_ptr ? slaves->lever_ptr[q] : 0; slaves->lever_ptr && k < slaves->lever_ptr[q + 1];
         k++)
      marks[slaves->lever_node[k]] = 1;
  }
  for (PetscInt k = 0; lists->n_near && k < slaves->n_nodes; k++) n += marks[k];
  return n;
}

/* Collects the keys of the slave nodes, of the records' nodes and of the nodes of which live offsets are made. */
static PetscErrorCode CollectKeys(ContactSearch s, const SearchField *field, NeighbourLists lists, ContactKeys *all)
{
  const PetscBool rigid     = (PetscBool)(s->master && s->master->rigid);
  const PetscBool ridge     = (PetscBool)(s->slaves && s->slaves->surface->ridge.n);
  const PetscInt  n_records = field->n_records, n_nodes = s->slaves ? s->slaves->n_nodes : 0;
  const FaceMaps  none = {0}, *maps[] = {&field->maps, s->slaves ? &s->slaves->maps : &none};
  PetscInt        n = 0, n_slaves, n_rigid = 0, n_mapped = 0, n_tool = s->tool ? TOOL_NODES : 0;
  char           *marks;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_nodes, &marks));
  n_slaves = MarkSlaveNodes(s, lists, marks);
  for (int m = 0; m < 2; m++) n_mapped += maps[m]->n ? maps[m]->ptr[maps[m]->n] : 0;
  PetscCall(PetscMalloc2(n_slaves + n_mapped + n_tool + FACE_MAX_NODES * n_records, &all->keys,
                         n_slaves + FACE_MAX_NODES * n_records, &all->tool));
  for (PetscInt i = 0; i < n_nodes; i++)
    if (marks[i]) *(ridge ? &all->tool[n_rigid++] : &all->keys[n++]) = s->slaves->nodes[i];
  PetscCall(PetscFree(marks));
  for (PetscInt r = 0; r < n_records; r++) {
    PetscInt *count = rigid ? &n_rigid : &n;

    FaceRecordKeys(&field->records[r], rigid ? &all->tool[n_rigid] : &all->keys[n]);
    *count += ElementGet(field->records[r].facet.type)->nodes;
  }
  for (int m = 0; m < 2; m++)
    for (PetscInt k = 0; maps[m]->n && k < maps[m]->ptr[maps[m]->n]; k++) all->keys[n++] = maps[m]->entry[k].node;
  for (PetscInt k = 0; k < n_tool; k++) all->keys[n++] = ToolKey(s->mesh, s->tool->node + k);
  all->n       = NodeKeysUnique(n, all->keys);
  all->n_rigid = NodeKeysUnique(n_rigid, all->tool);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the star forest from the contact nodes of deformable bodies to their owners, and fetches the dofs over it. */
static PetscErrorCode LinkNodes(Mesh mesh, const ContactKeys *all, NeighbourLists lists)
{
  PetscSFNode    *remote;
  const PetscInt *dofs;
  MPI_Datatype    integers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all->n, &remote));
  for (PetscInt i = 0; i < all->n; i++) remote[i] = (PetscSFNode){all->keys[i].owner, all->keys[i].local};
  PetscCall(PetscSFCreate(mesh->comm, &lists->sf));
  PetscCall(PetscSFSetGraph(lists->sf, mesh->n_nodes, all->n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(lists->sf));
  PetscCallMPI(MPI_Type_contiguous(mesh->dim, MPIU_REAL, &lists->block));
  PetscCallMPI(MPI_Type_commit(&lists->block));
  PetscCallMPI(MPI_Type_contiguous(mesh->dim, MPIU_INT, &integers));
  PetscCallMPI(MPI_Type_commit(&integers));
  PetscCall(MeshGetGlobalDofs(mesh, &dofs));
  PetscCall(PetscSFBcastBegin(lists->sf, integers, dofs, lists->dof, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, integers, dofs, lists->dof, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&integers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsCreateNodes - numbers the contact nodes and makes the star forest to their owners.

  Collective

  Input Parameter:
. s - the search

  Input/Output Parameters:
+ field - its records' facets are rewritten in numbers of contact nodes
- lists - the lists with the choice of slave points; their nodes are set

  Note:
  Contact nodes are the nodes of these points, the nodes of the listed faces, and the nodes of which live offsets
  are made.
@*/
PetscErrorCode NeighbourListsCreateNodes(ContactSearch s, SearchField *field, NeighbourLists lists)
{
  const int       dim   = s->mesh->dim;
  const PetscBool rigid = (PetscBool)(s->master && s->master->rigid);
  ContactKeys     all;

  PetscFunctionBeginUser;
  PetscCall(CollectKeys(s, field, lists, &all));
  lists->n_deformable = all.n;
  lists->n_nodes      = all.n + all.n_rigid;
  lists->tool         = s->tool ? all.n - TOOL_NODES : -1; /* their ids are the largest */
  for (PetscInt r = 0; r < field->n_records; r++) {
    FaceRecord *record = &field->records[r];

    for (int a = 0; a < ElementGet(record->facet.type)->nodes; a++)
      record->facet.nodes[a] = rigid ? (int)all.n + NodeKeysFind(all.n_rigid, all.tool, record->id[a])
                                     : NodeKeysFind(all.n, all.keys, record->id[a]);
  }
  PetscCall(PetscMalloc4(lists->n_nodes, &lists->node_id, lists->n_nodes * dim, &lists->X, lists->n_nodes * dim,
                         &lists->u, lists->n_nodes * dim, &lists->dof));
  for (PetscInt i = 0; i < all.n; i++) {
    lists->node_id[i] = all.keys[i].id;
    for (int d = 0; d < dim; d++) lists->X[i * dim + d] = all.keys[i].X[d];
  }
  for (PetscInt i = 0, k = all.n; i < all.n_rigid; i++, k++) {
    PetscReal X[3];

    lists->node_id[k] = all.tool[i].id;
    SearchRigidPlace(s, all.tool[i].id, X);
    for (int d = 0; d < dim; d++) {
      lists->X[k * dim + d]   = X[d];
      lists->dof[k * dim + d] = -1;
    }
  }
  PetscCall(LinkNodes(s->mesh, &all, lists));
  PetscCall(PetscFree2(all.keys, all.tool));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsBroadcast - fetches values of the contact nodes from those of the mesh's nodes.

  Collective

  Input Parameters:
+ s      - the search
. lists  - the lists
. x      - local values x[mesh n_nodes*dim], read at owned nodes
. t      - load parameter from which the motion of a rigid tool is counted
- t_next - load parameter to which it is counted

  Output Parameter:
. values - values[lists n_nodes*dim]; nodes of a rigid tool get their motion (length) from t to t_next, or 0 where the
           tool has nodes of its own
@*/
PetscErrorCode NeighbourListsBroadcast(ContactSearch s, NeighbourLists lists, const PetscReal *x, PetscReal t,
                                       PetscReal t_next, PetscReal *values)
{
  const int dim = lists->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(lists->sf, lists->block, x, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, lists->block, x, values, MPI_REPLACE));
  PetscCall(PetscArrayzero(&values[lists->n_deformable * dim], (lists->n_nodes - lists->n_deformable) * dim));
  if (s->tool || t == t_next) PetscFunctionReturn(PETSC_SUCCESS); /* linear problems ask for thousands of such moves */
  for (PetscInt i = lists->n_deformable; i < lists->n_nodes; i++) {
    PetscReal from[3], to[3];

    SearchRigidPosition(s, lists->node_id[i], t, from);
    SearchRigidPosition(s, lists->node_id[i], t_next, to);
    for (int d = 0; d < dim; d++) values[i * dim + d] = to[d] - from[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsReduce - adds values of the contact nodes to those of the mesh's nodes; it is the transpose of
  NeighbourListsBroadcast().

  Collective

  Input Parameters:
+ lists  - the lists
- values - values[lists n_nodes*dim]

  Input/Output Parameter:
. y - local values y[mesh n_nodes*dim], complete at owned nodes

  Note:
  Values of nodes of a rigid tool are left out.
@*/
PetscErrorCode NeighbourListsReduce(NeighbourLists lists, const PetscReal *values, PetscReal *y)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFReduceBegin(lists->sf, lists->block, values, y, MPI_SUM));
  PetscCall(PetscSFReduceEnd(lists->sf, lists->block, values, y, MPI_SUM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsUpdateNodes - moves the contact nodes to (u, t), but not the points that are made of them.

  Collective

  Input Parameters:
+ s     - the search
. lists - the lists
. u     - local displacements u[mesh n_nodes*dim] (length), read at owned nodes
- t     - load parameter, for rigid tools
@*/
PetscErrorCode NeighbourListsUpdateNodes(ContactSearch s, NeighbourLists lists, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  if (s->tool) ToolMove(s->mesh, s->tool, &lists->u[lists->tool * lists->dim], t);
  for (PetscInt i = lists->n_deformable; i < lists->n_nodes; i++) {
    PetscReal x[3];

    SearchRigidPosition(s, lists->node_id[i], t, x);
    for (int d = 0; d < lists->dim; d++) lists->u[i * lists->dim + d] = x[d] - lists->X[i * lists->dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = sum S sign x, the linear part of a map. */
static void Map(ContactSearch s, int dim, PetscInt n, const PetscInt *node, const int *side, const PetscReal *S,
                const PetscReal *x, PetscReal *y)
{
  for (int d = 0; d < dim; d++) y[d] = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *sign = s->images[side[k]].sign;

    for (int d = 0; d < dim; d++) y[d] += S[k] * sign[d] * x[node[k] * dim + d];
  }
}

/* The same where every node is on its own side. dim is a constant where this is called. */
static inline void MapOwn(const int dim, PetscInt n, const PetscInt *node, const PetscReal *S, const PetscReal *x,
                          PetscReal *y)
{
  PetscReal sum[3] = {0, 0, 0};

  for (PetscInt k = 0; k < n; k++)
    for (int d = 0; d < dim; d++) sum[d] += S[k] * x[node[k] * dim + d];
  for (int d = 0; d < dim; d++) y[d] = sum[d];
}

/* The linear part of the map of fit point p, with the reflection of its image. Only live offsets take nodes of other
   sides. */
static void PointMap(ContactSearch s, NeighbourLists lists, PetscInt p, const PetscReal *x, PetscReal *y)
{
  const PetscInt   first = lists->point_ptr[p], n = lists->point_ptr[p + 1] - first, *node = &lists->point_node[first];
  const PetscReal *S = &lists->point_S[first], *sign = s->images[lists->point_image[p]].sign;

  if (s->maps)
    Map(s, lists->dim, n, node, &lists->point_side[first], S, x, y);
  else if (lists->dim == 3)
    MapOwn(3, n, node, S, x, y);
  else
    MapOwn(2, n, node, S, x, y);
  for (int d = 0; d < lists->dim; d++) y[d] *= sign[d];
  if (lists->point_cosine) y[0] *= lists->point_cosine[p];
}

/* The linear part of the map of slave point q. */
static void SlaveMap(ContactSearch s, NeighbourLists lists, PetscInt q, const PetscReal *x, PetscReal *y)
{
  const PetscInt   first = lists->slave_ptr[q], n = lists->slave_ptr[q + 1] - first, *node = &lists->slave_node[first];
  const PetscReal *S = &lists->slave_S[first];

  if (s->slaves->maps.ptr)
    Map(s, lists->dim, n, node, &lists->slave_side[first], S, x, y);
  else if (lists->dim == 3)
    MapOwn(3, n, node, S, x, y);
  else
    MapOwn(2, n, node, S, x, y);
}

/* Do the offsets turn with a rigid tool? Tools of axisymmetric scenes do not turn. */
static PetscBool OffsetsTurn(ContactSearch s)
{
  return (PetscBool)(s->fit->integral && !s->fit->revolved && s->master && s->master->rigid);
}

/* Turns the offsets on a rigid tool, which are those of its first position, with the tool. */
static void TurnOffsets(ContactSearch s, NeighbourLists lists, PetscReal t)
{
  const int dim = lists->dim;

  for (PetscInt p = 0; p < lists->n_points; p++) {
    const SurfaceImage *image = &s->images[lists->point_image[p]];
    PetscReal           X[3]  = {0, 0, 0}, x[3], moved[3];

    if (lists->point_ptr[p + 1] == lists->point_ptr[p] + 1) continue; /* a node has no offset */
    for (int d = 0; d < dim; d++) X[d] = image->sign[d] * (lists->point_X[p * dim + d] - image->shift[d]);
    LoadsRigidMotion(s->loads, s->master->body, t, X, x);
    SurfaceReflect(image, dim, x, moved);
    for (int d = 0; d < dim; d++) lists->point_u[p * dim + d] = moved[d] - lists->point_X[p * dim + d];
  }
}

/*@
  NeighbourListsUpdate - moves contact nodes, fit points and slave points to (u, t), while the lists stay as they are.

  Collective

  Input Parameters:
+ s     - the search
. lists - the lists
. u     - local displacements u[mesh n_nodes*dim] (length), read at owned nodes
- t     - load parameter, for rigid tools

  Output Parameter:
. moved - PETSC_TRUE if a contact node of this rank has moved or t is another; may be NULL
@*/
PetscErrorCode NeighbourListsUpdate(ContactSearch s, NeighbourLists lists, const PetscReal *u, PetscReal t,
                                    PetscBool *moved)
{
  const PetscInt  n     = lists->n_nodes * lists->dim;
  const PetscBool turns = OffsetsTurn(s);
  PetscReal      *before;
  PetscBool       same;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &before));
  PetscCall(PetscArraycpy(before, lists->u, n));
  PetscCall(NeighbourListsUpdateNodes(s, lists, u, t));
  PetscCall(PetscArraycmp(before, lists->u, n, &same));
  PetscCall(PetscFree(before));
  /* t is NaN while the lists are being made. */
  lists->made = (PetscBool)(same && !turns && (lists->made || PetscIsNanReal(lists->t)));
  if (moved) *moved = same && lists->t == t ? PETSC_FALSE : PETSC_TRUE;
  if (same && lists->t == t) PetscFunctionReturn(PETSC_SUCCESS);
  lists->t = t;
  for (PetscInt i = 0; i < lists->n_moving && !same; i++)
    PointMap(s, lists, lists->moving[i], lists->u, &lists->point_u[lists->moving[i] * lists->dim]);
  if (turns) TurnOffsets(s, lists, t);
  for (PetscInt i = 0; i < lists->n_near && !same; i++)
    SlaveMap(s, lists, lists->near[i], lists->u, &lists->slave_u[lists->near[i] * lists->dim]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The image that a node really has: planes on which it lies do not move it. Image m is the product of the planes
   whose bits are set in m. *planes is the number of planes on which the node lies. */
static int CanonicalImage(ContactSearch s, const PetscReal *X, int image, int *planes)
{
  *planes = 0;
  for (int bit = 1; bit < s->n_images; bit <<= 1) {
    PetscReal distance = 0;

    for (int d = 0; d < s->mesh->dim; d++)
      distance = PetscMax(distance, PetscAbsReal(s->images[bit].sign[d] * X[d] + s->images[bit].shift[d] - X[d]));
    if (distance > SEARCH_ON_PLANE * s->mesh->size) continue;
    image &= ~bit;
    (*planes)++;
  }
  return image;
}

/* Rings reach as far as fits on a surface whose faces grow to this many times the length of the ring's own. */
#define RING_GRADING 4

/* Allocates the points and their entries. */
static PetscErrorCode NeighbourListsAllocatePoints(NeighbourLists lists, PetscInt room, PetscInt entries,
                                                   PetscBool revolved)
{
  const int dim = lists->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc7(room + 1, &lists->point_ptr, entries, &lists->point_node, entries, &lists->point_S, room * dim,
                         &lists->point_offset, room, &lists->point_weight, room, &lists->point_image, room,
                         &lists->point_key));
  PetscCall(PetscMalloc1(entries, &lists->point_side));
  PetscCall(PetscArrayzero(lists->point_offset, room * dim));
  if (revolved) PetscCall(PetscCalloc2(room, &lists->point_cosine, room, &lists->point_hoop));
  lists->n_points     = 0;
  lists->point_ptr[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a point as a combination of contact nodes; S NULL: all shares are 1. */
static void NeighbourListsAddPoint(NeighbourLists lists, int n, const int *nodes, const double *S, int image,
                                   PetscReal weight, long key)
{
  const PetscInt p = lists->n_points++;
  PetscInt       k = lists->point_ptr[p];

  for (int a = 0; a < n; a++, k++) {
    lists->point_node[k] = nodes[a];
    lists->point_side[k] = 0;
    lists->point_S[k]    = S ? S[a] : 1;
  }
  lists->point_ptr[p + 1] = k;
  lists->point_image[p]   = image;
  lists->point_weight[p]  = weight;
  lists->point_key[p]     = key;
  if (lists->point_cosine) lists->point_cosine[p] = 1;
}

/* Adds the points that are nodes or images of nodes, of which the facets are made. The candidates stay in numbers of
   contact nodes. number[] is the point of each image of a node, or -1. */
static void NeighbourListsAddNodePoints(ContactSearch s, NeighbourLists lists, SearchField *field, PetscInt *number)
{
  for (PetscInt c = 0; c < field->n_candidates; c++) {
    Candidate *candidate = &field->candidates[c];

    for (int a = 0; a < ElementGet(candidate->facet.type)->nodes; a++) {
      const int node = candidate->facet.nodes[a];
      int       planes;
      const int image = CanonicalImage(s, &lists->X[node * lists->dim], candidate->image, &planes);
      PetscInt *p     = &number[image * lists->n_nodes + node];

      if (*p < 0) {
        /* The faces on this side of a plane give a node on it half of its whole weight. */
        *p = lists->n_points;
        NeighbourListsAddPoint(lists, 1, &node, NULL, image, 1 << planes,
                               (2L * lists->node_id[node] + (node >= lists->n_deformable)) * SURFACE_MAX_IMAGES +
                                 image);
      }
    }
  }
}

/* Writes the entries of a face's map for one of its points: number of the node in the lists, image, share. */
static PetscErrorCode TakeMap(NeighbourLists lists, const FaceMaps *maps, PetscInt face, int point, PetscInt *node,
                              int *side, PetscReal *S)
{
  PetscFunctionBeginUser;
  for (PetscInt k = maps->ptr[face]; k < maps->ptr[face + 1]; k++) {
    const FaceMapEntry *entry = &maps->entry[k];

    PetscCall(PetscFindInt(entry->node.id, lists->n_deformable, lists->node_id, node++));
    *side++ = entry->image;
    *S++    = entry->S[point];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the shape functions of the last added point by a map, and its offset by the constant part of that map. */
static PetscErrorCode NeighbourListsMapPoint(ContactSearch s, NeighbourLists lists, const SearchField *field,
                                             const Candidate *candidate, int q)
{
  const PetscInt p = lists->n_points - 1, first = lists->point_ptr[p], r = candidate->record;
  PetscReal     *shift = &lists->point_offset[p * lists->dim];

  PetscFunctionBeginUser;
  PetscCall(
    TakeMap(lists, &field->maps, r, q, &lists->point_node[first], &lists->point_side[first], &lists->point_S[first]));
  lists->point_ptr[p + 1] = first + field->maps.ptr[r + 1] - field->maps.ptr[r];
  FaceMapShift(&field->maps, r, q, lists->dim, s->images, shift);
  for (int d = 0; d < lists->dim; d++) shift[d] *= s->images[candidate->image].sign[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Areas of the quadrature points of a candidate in the reference configuration, and the rings on which they lie in fits
   of revolution; else rings with one point. Returns the number of points on all rings. Images beyond the axis have
   none, because the rings go round it. */
static PetscInt CandidateRings(ContactSearch s, NeighbourLists lists, const SearchField *field,
                               const Candidate *candidate, double *area, Ring *ring)
{
  const Facet *facet = &field->records[candidate->record].facet; /* as its body sees it: the rule's points are the
                                                                    same on every image */
  const FaceRule     *rule  = FaceRuleGet(facet->type, 0);
  const SurfaceImage *image = &s->images[candidate->image];
  const PetscReal     reach = s->fit_reach / s->master->max_extent;
  const int           dim   = lists->dim;
  double              X[FACE_MAX_NODES * 3], length = 0;
  PetscInt            n = 0;

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    for (int d = 0; d < dim; d++) X[a * dim + d] = lists->X[facet->nodes[a] * dim + d];
  FaceRuleAreas(rule, facet->type, dim, GEOMETRY_SOLID, X, area, NULL);
  for (int q = 0; q < rule->n; q++) length += area[q];
  for (int q = 0; q < rule->n; q++) {
    PetscReal radius = image->shift[0];

    ring[q] = (Ring){.n = 1};
    if (s->fit->revolved) {
      for (int a = 0; a < ElementGet(facet->type)->nodes; a++) radius += image->sign[0] * rule->N[q][a] * X[a * dim];
      ring[q] = RingOf(radius, length / ElementGet(facet->type)->order,
                       reach * PetscMin(s->master->max_extent, RING_GRADING * length));
      if (SurfaceImageBeyondAxis(image)) ring[q].n = 0;
    }
    n += ring[q].n;
  }
  return n;
}

/* Turns the last added point to place j of its ring. */
static void NeighbourListsTurnPoint(NeighbourLists lists, const Ring *ring, PetscInt j)
{
  const PetscInt  p     = lists->n_points - 1;
  const PetscReal angle = RingAngle(ring, j);

  lists->point_cosine[p] = PetscCosReal(angle);
  lists->point_hoop[p]   = PetscTanReal(angle); /* times the radius in the meridian plane */
  lists->point_offset[p * lists->dim] *= lists->point_cosine[p];
}

/* Adds the quadrature points of the candidates, weighted by their reference area, with their offsets. */
static PetscErrorCode NeighbourListsAddQuadraturePoints(ContactSearch s, NeighbourLists lists, SearchField *field)
{
  const int dim = lists->dim;
  double    area[FACE_RULE_POINTS];
  Ring      ring[FACE_RULE_POINTS];
  PetscInt  n = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < field->n_candidates; c++) {
    Candidate        *candidate = &field->candidates[c];
    const FaceRecord *record    = &field->records[candidate->record];
    const Facet      *facet     = &record->facet;
    const FaceRule   *rule      = FaceRuleGet(facet->type, 0);

    /* The images of a face come one after the other and have the same areas, but not the same rings. */
    if (s->fit->revolved || c == 0 || candidate->record != candidate[-1].record)
      n = CandidateRings(s, lists, field, candidate, area, ring);
    candidate->first = lists->n_points;
    candidate->count = n;
    for (int q = 0; q < rule->n; q++) {
      const PetscReal share = s->fit->revolved ? RingWeight(&ring[q]) / s->master->mean_size : 1;

      for (PetscInt j = 0; j < ring[q].n; j++) {
        for (int d = 0; d < dim; d++)
          lists->point_offset[lists->n_points * dim + d] =
            s->images[candidate->image].sign[d] * record->offset[q * dim + d];
        NeighbourListsAddPoint(lists, ElementGet(facet->type)->nodes, facet->nodes, rule->N[q], candidate->image,
                               share * area[q] / PetscPowRealInt(s->master->mean_size, dim - 1),
                               (candidate->facet.tag * FACE_RULE_POINTS + q) * RING_KEYS + j);
        if (field->maps.n) PetscCall(NeighbourListsMapPoint(s, lists, field, candidate, q));
        if (s->fit->revolved) NeighbourListsTurnPoint(lists, &ring[q], j);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the reference position of fit point p. */
static void PlacePoint(ContactSearch s, NeighbourLists lists, PetscInt p)
{
  const SurfaceImage *image = &s->images[lists->point_image[p]];
  const int           dim   = lists->dim;

  PointMap(s, lists, p, lists->X, &lists->point_X[p * dim]);
  for (int d = 0; d < dim; d++)
    lists->point_X[p * dim + d] +=
      image->shift[d] * (d == 0 && lists->point_cosine ? lists->point_cosine[p] : 1) + lists->point_offset[p * dim + d];
}

/* Says whether quadrature points of the master have held offsets that change. All ranks say the same, those too that
   have no face of the master and no offsets of their own. */
static PetscBool HasHeld(ContactSearch s)
{
  return (PetscBool)(s->fit->integral && !s->master->rigid);
}

/* Notes where the faces live whose quadrature points have held offsets. Those of a rigid tool never change. */
static PetscErrorCode NoteHeld(ContactSearch s, NeighbourLists lists, const SearchField *field)
{
  PetscFunctionBeginUser;
  if (!HasHeld(s)) PetscFunctionReturn(PETSC_SUCCESS);
  lists->n_held = field->n_candidates;
  PetscCall(PetscMalloc2(lists->n_held + 1, &lists->first_held, lists->n_held, &lists->home_held));
  for (PetscInt c = 0; c < lists->n_held; c++) {
    const FaceRecord *record = &field->records[field->candidates[c].record];

    lists->first_held[c] = field->candidates[c].first;
    lists->home_held[c]  = (PetscSFNode){record->home, record->home_face};
  }
  lists->first_held[lists->n_held] = lists->n_points; /* quadrature points are the last ones */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsCreatePoints - numbers the points that the candidates use and writes their maps.

  Not collective

  Input Parameters:
+ s - the search
- t - load parameter, for rigid tools

  Input/Output Parameters:
+ lists - the lists, whose points are set
- field - its candidates' nodes are rewritten in numbers of points
@*/
PetscErrorCode NeighbourListsCreatePoints(ContactSearch s, PetscReal t, NeighbourLists lists, SearchField *field)
{
  const int dim = lists->dim;
  PetscInt *number, nodes = s->n_images * lists->n_nodes, points = nodes, entries = nodes;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; s->fit->integral && c < field->n_candidates; c++) {
    const ElementType type = field->candidates[c].facet.type;
    const PetscInt    r    = field->candidates[c].record;
    double            area[FACE_RULE_POINTS];
    Ring              ring[FACE_RULE_POINTS];
    const PetscInt    n =
      s->fit->revolved ? CandidateRings(s, lists, field, &field->candidates[c], area, ring) : FaceRuleGet(type, 0)->n;

    points += n;
    entries += n * (field->maps.n ? field->maps.ptr[r + 1] - field->maps.ptr[r] : ElementGet(type)->nodes);
  }
  PetscCall(PetscMalloc1(nodes, &number));
  for (PetscInt k = 0; k < nodes; k++) number[k] = -1;
  PetscCall(NeighbourListsAllocatePoints(lists, points, entries, s->fit->revolved));
  NeighbourListsAddNodePoints(s, lists, field, number);
  if (s->fit->integral) PetscCall(NeighbourListsAddQuadraturePoints(s, lists, field));
  PetscCall(NoteHeld(s, lists, field));
  for (PetscInt c = 0; c < field->n_candidates; c++) {
    Candidate *candidate = &field->candidates[c];

    for (int a = 0; a < ElementGet(candidate->facet.type)->nodes; a++) {
      const PetscInt node = candidate->facet.nodes[a];
      int            planes;

      candidate->facet.nodes[a] =
        (int)number[CanonicalImage(s, &lists->X[node * dim], candidate->image, &planes) * lists->n_nodes + node];
    }
  }
  PetscCall(PetscMalloc2(lists->n_points * dim + POINT_SEEN_PADDING, &lists->point_X,
                         lists->n_points * dim + POINT_SEEN_PADDING, &lists->point_u));
  for (int i = 0; i < POINT_SEEN_PADDING; i++)
    lists->point_X[lists->n_points * dim + i] = lists->point_u[lists->n_points * dim + i] = 0;
  for (PetscInt p = 0; p < lists->n_points; p++) {
    PlacePoint(s, lists, p);
    PointMap(s, lists, p, lists->u, &lists->point_u[p * dim]);
    if (lists->point_hoop) lists->point_hoop[p] *= lists->point_X[p * dim] + lists->point_u[p * dim];
  }
  if (OffsetsTurn(s)) TurnOffsets(s, lists, t);
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsPointGeometry - computes normal, spacing and weight of the points: those of their nodes, reflected with
  them.

  Not collective

  Input Parameters:
+ s     - the search
- field - its records bring the geometry of their nodes

  Input/Output Parameter:
. lists - the lists, whose point weights are set

  Output Parameters:
+ node_geometry - workspace for all contact nodes
- geometry      - one for each point; that of quadrature points is not set
@*/
void NeighbourListsPointGeometry(ContactSearch s, NeighbourLists lists, const SearchField *field,
                                 NodeGeometry *node_geometry, NodeGeometry *geometry)
{
  for (PetscInt r = 0; r < field->n_records; r++) {
    const FaceRecord *record = &field->records[r];

    for (int a = 0; a < ElementGet(record->facet.type)->nodes; a++)
      node_geometry[record->facet.nodes[a]] = record->geometry[a];
  }
  for (PetscInt p = 0; p < lists->n_points; p++) {
    const PetscReal *sign   = s->images[lists->point_image[p]].sign;
    NodeGeometry    *g      = &geometry[p];
    PetscReal        length = 0;
    /* For a quadrature point the nodes of its facet are used. */

    if (lists->point_ptr[p + 1] > lists->point_ptr[p] + 1) continue;
    *g = node_geometry[lists->point_node[p]];
    /* On a plane of symmetry the other half cancels the components that are odd in its axis. */
    for (int bit = 1; bit < s->n_images; bit <<= 1) {
      for (int d = 0; d < 3; d++) {
        PetscReal distance;

        if (d >= lists->dim || s->images[bit].sign[d] > 0) continue;
        distance = PetscAbsReal(-lists->X[lists->point_node[p] * lists->dim + d] + s->images[bit].shift[d] -
                                lists->X[lists->point_node[p] * lists->dim + d]);
        if (distance > SEARCH_ON_PLANE * s->mesh->size) continue;
        g->normal[d]                   = 0;
        g->covariance[3 + d]           = 0; /* xy yz zx: the two products with axis d */
        g->covariance[3 + (d + 2) % 3] = 0;
      }
    }
    for (int d = 0; d < 3; d++) {
      g->normal[d] *= sign[d];
      g->covariance[3 + d] *= sign[d] * sign[(d + 1) % 3];
      length += PetscSqr(g->normal[d]);
    }
    length = PetscSqrtReal(length);
    for (int d = 0; d < 3 && length > 0; d++) g->normal[d] /= length;
    if (g->weight != 1) g->weight *= lists->point_weight[p];
    lists->point_weight[p] = g->weight;
  }
}

/* Makes the slave points as combinations of the nodes of their faces, with fixed offsets. Pointers, shares and sides
   are those of all lists of the search. */
static PetscErrorCode TakeSlaveShapes(NeighbourLists lists, SlavePoints slaves, PetscBool first)
{
  const PetscInt entries = slaves->ptr[slaves->n], ridge = slaves->surface->ridge.n;
  const PetscInt from = ridge ? lists->n_deformable : 0, end = ridge ? lists->n_nodes : lists->n_deformable;
  PetscInt      *number; /* of each node of the points, from `from` on */

  PetscFunctionBeginUser;
  if (first) {
    PetscCall(PetscArraycpy(lists->slave_ptr, slaves->ptr, slaves->n + 1));
    PetscCall(PetscArraycpy(lists->slave_S, slaves->S, entries));
    PetscCall(PetscArrayzero(lists->slave_side, entries));
    PetscCall(PetscArrayzero(lists->slave_node, entries));
  }
  PetscCall(PetscMalloc1(slaves->n_nodes, &number));
  for (PetscInt i = 0; i < slaves->n_nodes; i++) number[i] = -1;
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q = lists->near[i];

    PetscCall(PetscArraycpy(&lists->slave_offset[q * lists->dim], &slaves->offset[q * lists->dim], lists->dim));
    for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++) {
      PetscInt *known = &number[slaves->node[k]];

      if (*known < 0)
        PetscCall(PetscFindInt(slaves->nodes[slaves->node[k]].id, end - from, &lists->node_id[from], known));
      lists->slave_node[k] = from + *known;
    }
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the slave points as combinations of the nodes of their faces' maps. */
static PetscErrorCode TakeSlaveMaps(ContactSearch s, NeighbourLists lists)
{
  SlavePoints slaves = s->slaves;
  PetscInt    end    = 0;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < slaves->n_faces; f++) {
    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++) {
      const int point = (int)(q - slaves->first[f]);

      lists->slave_ptr[q] = end;
      PetscCall(TakeMap(lists, &slaves->maps, f, point, &lists->slave_node[end], &lists->slave_side[end],
                        &lists->slave_S[end]));
      FaceMapShift(&slaves->maps, f, point, lists->dim, s->images, &lists->slave_offset[q * lists->dim]);
      end += slaves->maps.ptr[f + 1] - slaves->maps.ptr[f];
    }
  }
  lists->slave_ptr[slaves->n] = end;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the reference position of slave point q. */
static void PlaceSlave(ContactSearch s, NeighbourLists lists, PetscInt q)
{
  const int dim = lists->dim;

  SlaveMap(s, lists, q, lists->X, &lists->slave_X[q * dim]);
  for (int d = 0; d < dim; d++) lists->slave_X[q * dim + d] += lists->slave_offset[q * dim + d];
}

/*@
  NeighbourListsChoosePoints - chooses the slave points of the lists: those that may have a partner, or all where lists
  keep all faces, because points are followed then that have left their partners.

  Not collective

  Input Parameter:
. s - the search, after SearchPartners() where there is a test

  Input/Output Parameter:
. lists - the lists
@*/
PetscErrorCode NeighbourListsChoosePoints(ContactSearch s, NeighbourLists lists)
{
  const PetscBool *possible = s->keeps_faces ? NULL : s->partners.possible;

  PetscFunctionBeginUser;
  lists->n_slaves = s->slaves->n;
  PetscCall(PetscMalloc1(lists->n_slaves, &lists->near));
  for (PetscInt q = 0; q < lists->n_slaves; q++)
    if (!possible || possible[q]) lists->near[lists->n_near++] = q;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates what lists hold for slave points that are combinations of so many nodes. */
static PetscErrorCode MakeSlaveRoom(NeighbourLists lists, PetscInt entries)
{
  const PetscInt n   = lists->n_slaves;
  const int      dim = lists->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n + 1, &lists->slave_ptr, entries, &lists->slave_node, entries, &lists->slave_side, entries,
                         &lists->slave_S, n * dim, &lists->slave_offset));
  PetscCall(PetscMalloc3(n * dim, &lists->slave_X, n * dim, &lists->slave_u, 3 * n, &lists->slave_normal));
  PetscCall(PetscMalloc6(n + 1, &lists->list_ptr, n + 1, &lists->facet_ptr, n, &lists->kappa, n, &lists->nearest, n,
                         &lists->share, n, &lists->averse));
  PetscCall(
    PetscMalloc5(n, &lists->fit_n, n, &lists->rung, n, &lists->degree, 9 * n, &lists->frame, 4 * n, &lists->metric));
  PetscCall(PetscMalloc6(n, &lists->pivot, n, &lists->amplified, n, &lists->residual, 2 * n, &lists->centre, n,
                         &lists->gap, 3 * n, &lists->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets what a slave point has that has no facet and no fit. */
static void ClearSlave(NeighbourLists lists, PetscInt q)
{
  lists->kappa[q]   = 0;
  lists->nearest[q] = -1;
  lists->share[q]   = 0;
  lists->averse[q]  = PETSC_FALSE;
  lists->fit_n[q] = lists->rung[q] = lists->degree[q] = 0;
  lists->pivot[q] = lists->amplified[q] = lists->residual[q] = lists->gap[q] = 0;
  for (int k = 0; k < 2; k++) lists->centre[2 * q + k] = 0;
  for (int k = 0; k < 3; k++) lists->normal[3 * q + k] = 0;
  for (int k = 0; k < 4; k++) lists->metric[4 * q + k] = 0;
  for (int k = 0; k < 9; k++) lists->frame[9 * q + k] = 0;
}

/* Takes the room of lists that were given back. Only the points that these had are other than clear. */
static PetscErrorCode TakeSpare(NeighbourLists *spare, NeighbourLists lists)
{
  const NeighbourLists old = *spare;

  PetscFunctionBeginUser;
  lists->slave_ptr    = old->slave_ptr;
  lists->slave_node   = old->slave_node;
  lists->slave_side   = old->slave_side;
  lists->slave_S      = old->slave_S;
  lists->slave_offset = old->slave_offset;
  lists->slave_X      = old->slave_X;
  lists->slave_u      = old->slave_u;
  lists->slave_normal = old->slave_normal;
  lists->list_ptr     = old->list_ptr;
  lists->facet_ptr    = old->facet_ptr;
  lists->kappa        = old->kappa;
  lists->nearest      = old->nearest;
  lists->share        = old->share;
  lists->averse       = old->averse;
  lists->fit_n        = old->fit_n;
  lists->rung         = old->rung;
  lists->degree       = old->degree;
  lists->frame        = old->frame;
  lists->metric       = old->metric;
  lists->pivot        = old->pivot;
  lists->amplified    = old->amplified;
  lists->residual     = old->residual;
  lists->centre       = old->centre;
  lists->gap          = old->gap;
  lists->normal       = old->normal;
  for (PetscInt i = 0; i < old->n_near; i++) ClearSlave(lists, old->near[i]);
  PetscCall(PetscFree(old->near));
  PetscCall(PetscFree(*spare));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsCreateSlaves - makes the slave points of the lists and allocates what the lists hold for each of them.

  Not collective

  Input Parameter:
. s - the search

  Input/Output Parameter:
. lists - the lists, whose contact nodes are there
@*/
PetscErrorCode NeighbourListsCreateSlaves(ContactSearch s, NeighbourLists lists)
{
  const PetscBool first   = (PetscBool)!s->spare;
  SlavePoints     slaves  = s->slaves;
  PetscInt        entries = slaves->maps.ptr ? 0 : slaves->ptr[slaves->n];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; slaves->maps.ptr && f < slaves->n_faces; f++)
    entries += (slaves->first[f + 1] - slaves->first[f]) * (slaves->maps.ptr[f + 1] - slaves->maps.ptr[f]);
  if (s->spare)
    PetscCall(TakeSpare(&s->spare, lists));
  else
    PetscCall(MakeSlaveRoom(lists, entries));
  for (PetscInt q = 0; q < slaves->n && first; q++) ClearSlave(lists, q);
  if (slaves->maps.ptr)
    PetscCall(TakeSlaveMaps(s, lists));
  else
    PetscCall(TakeSlaveShapes(lists, slaves, first));
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q = lists->near[i];

    PlaceSlave(s, lists, q);
    SlaveMap(s, lists, q, lists->u, &lists->slave_u[q * lists->dim]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fetches the offsets of the listed faces from where these live, and gives them to fit points. */
static PetscErrorCode TakePointOffsets(ContactSearch s, NeighbourLists lists, PetscBool *changed)
{
  const int    dim = lists->dim;
  PetscSF      faces;
  MPI_Datatype block;
  PetscReal   *arrived;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(lists->n_held * FACE_RULE_POINTS * dim, &arrived));
  PetscCallMPI(MPI_Type_contiguous(FACE_RULE_POINTS * dim, MPIU_REAL, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCall(PetscSFCreate(s->mesh->comm, &faces));
  PetscCall(PetscSFSetGraph(faces, s->master->n_faces, lists->n_held, NULL, PETSC_OWN_POINTER, lists->home_held,
                            PETSC_COPY_VALUES));
  PetscCall(PetscSFBcastBegin(faces, block, s->offset, arrived, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(faces, block, s->offset, arrived, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&faces));
  PetscCallMPI(MPI_Type_free(&block));
  for (PetscInt f = 0; f < lists->n_held; f++) {
    for (PetscInt p = lists->first_held[f]; p < lists->first_held[f + 1]; p++) {
      const int        q      = (int)(lists->point_key[p] / RING_KEYS % FACE_RULE_POINTS);
      const PetscReal *sign   = s->images[lists->point_image[p]].sign;
      PetscReal       *offset = &lists->point_offset[p * dim], before[3];

      PetscCall(PetscArraycpy(before, offset, dim));
      for (int d = 0; d < dim; d++) offset[d] = sign[d] * arrived[(f * FACE_RULE_POINTS + q) * dim + d];
      if (lists->point_cosine) offset[0] *= lists->point_cosine[p];
      for (int d = 0; d < dim; d++) *changed = (PetscBool)(*changed || offset[d] != before[d]);
      PlacePoint(s, lists, p);
    }
  }
  PetscCall(PetscFree(arrived));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsTakeOffsets - gives slave points and fit points the held offsets of now, while the lists stay as they
  are.

  Collective

  Input Parameters:
+ s     - the search; its slave points have their offsets
- lists - the lists

  Output Parameter:
. changed - the same on all ranks: some offset is another one, so that every gap is to be found anew

  Note:
  Frames, supports and listed points do not follow, as they do not follow the nodes either.
@*/
PetscErrorCode NeighbourListsTakeOffsets(ContactSearch s, NeighbourLists lists, PetscBool *changed)
{
  int any;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (HasHeld(s)) PetscCall(TakePointOffsets(s, lists, changed));
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt first = lists->near[i] * lists->dim;

    for (PetscInt k = first; k < first + lists->dim && !s->slaves->maps.ptr; k++) {
      *changed               = (PetscBool)(*changed || lists->slave_offset[k] != s->slaves->offset[k]);
      lists->slave_offset[k] = s->slaves->offset[k];
    }
    PlaceSlave(s, lists, lists->near[i]);
  }
  any = *changed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_LOR, s->mesh->comm));
  *changed = any ? PETSC_TRUE : PETSC_FALSE;
  if (any) lists->made = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsRelative - computes the position of a point relative to a slave point at the last update.

  Not collective

  Input Parameters:
+ lists - the lists
. q     - the slave point
- p     - the point

  Output Parameter:
. x - x[dim] (length)

  Note:
  It is a difference of differences, so that a gap keeps its digits far from the origin.
@*/
void NeighbourListsRelative(NeighbourLists lists, PetscInt q, PetscInt p, PetscReal *x)
{
  const int dim = lists->dim;

  for (int d = 0; d < dim; d++)
    x[d] = (lists->point_X[p * dim + d] - lists->slave_X[q * dim + d]) +
           (lists->point_u[p * dim + d] - lists->slave_u[q * dim + d]);
}

/* Are two fit points made of the same images of nodes? */
static PetscBool PointsAlike(NeighbourLists lists, PetscInt p, PetscInt q)
{
  const PetscInt first = lists->point_ptr[p], other = lists->point_ptr[q], n = lists->point_ptr[p + 1] - first;

  if (lists->point_ptr[q + 1] - other != n || lists->point_image[q] != lists->point_image[p]) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; k++) {
    if (lists->point_node[other + k] != lists->point_node[first + k] ||
        lists->point_side[other + k] != lists->point_side[first + k])
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/*@
  NeighbourListsFindAlike - finds the runs of fit points that are made of the same images of nodes at the same angle.

  Not collective

  Input/Output Parameter:
. lists - the lists, with all their fit points
@*/
PetscErrorCode NeighbourListsFindAlike(NeighbourLists lists)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(lists->n_points, &lists->point_alike));
  for (PetscInt p = 0; p < lists->n_points; p++) {
    const PetscInt  before = p ? lists->point_alike[p - 1] : 0;
    const PetscBool turned = (PetscBool)(lists->point_cosine && lists->point_cosine[p] != lists->point_cosine[before]);

    lists->point_alike[p] = !turned && PointsAlike(lists, before, p) ? before : p;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsFindMoving - finds the fit points that move with the lists: nodes, and of the others those in the
  list of a slave point.

  Not collective

  Input/Output Parameter:
. lists - the lists, with those of all slave points

  Note:
  The others stay where they were when the lists were made. Around elongated faces they are most of the points.
@*/
PetscErrorCode NeighbourListsFindMoving(NeighbourLists lists)
{
  char *listed;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(lists->n_points, &listed));
  for (PetscInt i = 0; i < lists->list_ptr[lists->n_slaves]; i++) listed[lists->list_point[i]] = 1;
  PetscCall(PetscMalloc1(lists->n_points, &lists->moving));
  for (PetscInt p = 0; p < lists->n_points; p++)
    if (listed[p] || lists->point_ptr[p + 1] == lists->point_ptr[p] + 1) lists->moving[lists->n_moving++] = p;
  PetscCall(PetscFree(listed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsAlikeEnd - finds the end of the run of points that are made of the same images of nodes as point p, like
  those of a face. In rings their angles may differ.

  Not collective

  Input Parameters:
+ lists - the lists
- p     - first point of the run

  Note:
  Returns the last point of the run plus 1.
@*/
PetscInt NeighbourListsAlikeEnd(NeighbourLists lists, PetscInt p)
{
  PetscInt end = p + 1;

  while (end < lists->n_points && PointsAlike(lists, p, end)) end++;
  return end;
}

/*@
  NeighbourListsNearestSize - returns the size (length) of the facet that was nearest to slave point q when the lists
  were made.

  Not collective

  Input Parameters:
+ lists - the lists
- q     - the slave point

  Note:
  Returns 0 if the slave point has no facet.
@*/
PetscReal NeighbourListsNearestSize(NeighbourLists lists, PetscInt q)
{
  return lists->nearest[q] < 0 ? 0 : lists->facet_size[lists->facet_ptr[q] + lists->nearest[q]];
}

/* Sum of the fit points of a slave point, relative to it. */
static void SumPoints(NeighbourLists lists, PetscInt q, PetscReal sum[3])
{
  const PetscInt *point = &lists->list_point[lists->list_ptr[q]];
  SpacePoint      seen, total = {0, 0, 0, 0};
  PointOrigin     origin;
  PetscReal       x[2];

  for (int d = 0; d < 3; d++) sum[d] = 0;
  for (PetscInt i = 0; i < lists->fit_n[q] && lists->dim == 2; i++) {
    NeighbourListsRelative(lists, q, point[i], x);
    for (int d = 0; d < 2; d++) sum[d] += x[d];
  }
  if (lists->dim == 2) return;
  PointOriginMake(&lists->slave_X[3 * q], &lists->slave_u[3 * q], &origin);
  for (PetscInt i = 0; i < lists->fit_n[q]; i++) {
    PointSeen(lists, point[i], &origin, (PetscReal *)&seen);
    total += seen;
  }
  for (int d = 0; d < 3; d++) sum[d] = total[d];
}

/*@
  NeighbourListsCentre - computes the mean of the fit points of slave point q in the present position.

  Not collective

  Input Parameters:
+ lists - the lists
- q     - the slave point

  Output Parameter:
. centre - centre[2] in the tangents of its frame, relative to it (length); dim - 1 entries are used
@*/
void NeighbourListsCentre(NeighbourLists lists, PetscInt q, PetscReal centre[2])
{
  const int        dim   = lists->dim;
  const PetscReal *frame = &lists->frame[9 * q];
  PetscReal        sum[3];

  centre[0] = centre[1] = 0;
  SumPoints(lists, q, sum);
  for (int a = 0; a < dim - 1 && lists->fit_n[q]; a++)
    for (int d = 0; d < dim; d++) centre[a] += frame[3 * a + d] * sum[d] / lists->fit_n[q];
}

/*@
  NeighbourListsSlip - computes how far slave point q has slid over its fit points since the lists were made, in
  supports.

  Not collective

  Input Parameters:
+ lists - the lists
- q     - the slave point

  Note:
  Returns 0 without a fit.
@*/
PetscReal NeighbourListsSlip(NeighbourLists lists, PetscInt q)
{
  const PetscReal *metric = &lists->metric[4 * q];
  PetscReal        slip[2], square = 0;

  if (!lists->fit_n[q]) return 0;
  NeighbourListsCentre(lists, q, slip);
  for (int a = 0; a < 2; a++) slip[a] -= lists->centre[2 * q + a];
  for (int a = 0; a < lists->dim - 1; a++)
    for (int b = 0; b < lists->dim - 1; b++) square += slip[a] * metric[2 * a + b] * slip[b];
  return PetscSqrtReal(square);
}

/*@
  NeighbourListsFitReaches - says whether slave point q is still where the fit of its list serves.

  Not collective

  Input Parameters:
+ lists - the lists
- q     - the slave point

  Note:
  Returns PETSC_TRUE without a fit.
@*/
PetscBool NeighbourListsFitReaches(NeighbourLists lists, PetscInt q)
{
  return (PetscBool)(NeighbourListsSlip(lists, q) <= NEIGHBOUR_LISTS_MARGIN);
}

/* Cosine between the reversed normal of a slave, of any length, and a unit normal of the master; 0 without a normal. */
static inline PetscReal OpposedCosine(const PetscReal own[3], const PetscReal normal[3])
{
  const PetscReal length = PetscSqrtReal(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);

  return length > 0 ? -(own[0] * normal[0] + own[1] * normal[1] + own[2] * normal[2]) / length : 0;
}

/*@
  NeighbourListsOpposing - says how well a normal of the slave opposes a normal of the master.

  Not collective

  Input Parameters:
+ own    - normal out of the slave's body, of any length
- normal - unit normal of the master

  Note:
  Returns 1 where they are opposed within OPPOSED_FULLY, and 0 from SEARCH_OPPOSED_NOT on.
@*/
PetscReal NeighbourListsOpposing(const PetscReal own[3], const PetscReal normal[3])
{
  return SmoothStep((OpposedCosine(own, normal) - SEARCH_OPPOSED_NOT) / (OPPOSED_FULLY - SEARCH_OPPOSED_NOT));
}

/*@
  NeighbourListsOpposed - says how well the normal of slave point q opposes a normal of the master.

  Not collective

  Input Parameters:
+ lists  - the lists
. q      - the slave point
- normal - unit normal of the master

  Note:
  It is NeighbourListsOpposing() of the point's normal.
@*/
PetscReal NeighbourListsOpposed(NeighbourLists lists, PetscInt q, const PetscReal normal[3])
{
  return NeighbourListsOpposing(&lists->slave_normal[3 * q], normal);
}

/*@
  NeighbourListsSquare - says whether a normal of the master is nearer to square to the normal of slave point q than to
  either of its directions.

  Not collective

  Input Parameters:
+ lists  - the lists
. q      - the slave point
- normal - unit normal of the master
@*/
PetscBool NeighbourListsSquare(NeighbourLists lists, PetscInt q, const PetscReal normal[3])
{
  return (PetscBool)(PetscAbsReal(OpposedCosine(&lists->slave_normal[3 * q], normal)) < 0.5 * PETSC_SQRT2);
}

/*@
  NeighbourListsAverse - says how far the normal of slave point q is from opposing a normal of the master that it does
  not face.

  Not collective

  Input Parameters:
+ lists  - the lists
. q      - the slave point
- normal - unit normal of the master

  Note:
  Returns 1 where they are square to each other or more, and 0 where NeighbourListsOpposed() begins to be more than 0.
@*/
PetscReal NeighbourListsAverse(NeighbourLists lists, PetscInt q, const PetscReal normal[3])
{
  return 1 - SmoothStep(OpposedCosine(&lists->slave_normal[3 * q], normal) / SEARCH_OPPOSED_NOT);
}

/*@
  NeighbourListsFindFace - finds a face of the master by its tag.

  Not collective

  Input Parameters:
+ lists - the lists of a search after SearchKeepFaces()
- tag   - of the face or of its mirror image

  Note:
  Returns its number among the lists' faces, or -1 if it is too far from the slave points of this rank.
@*/
PetscInt NeighbourListsFindFace(NeighbourLists lists, long tag)
{
  PetscInt low = 0, high = lists->n_faces;

  while (low < high) {
    const PetscInt middle = (low + high) / 2;

    if (lists->face[middle].tag < tag)
      low = middle + 1;
    else
      high = middle;
  }
  return low < lists->n_faces && lists->face[low].tag == tag ? low : -1;
}

/* Frees what does not belong to slave points. */
static PetscErrorCode FreeNodesAndPoints(NeighbourLists l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(l->node_id, l->X, l->u, l->dof));
  PetscCall(PetscSFDestroy(&l->sf));
  PetscCallMPI(MPI_Type_free(&l->block));
  PetscCall(PetscFree7(l->point_ptr, l->point_node, l->point_S, l->point_offset, l->point_weight, l->point_image,
                       l->point_key));
  PetscCall(PetscFree(l->point_side));
  PetscCall(PetscFree(l->point_alike));
  PetscCall(PetscFree(l->moving));
  if (l->point_cosine) PetscCall(PetscFree2(l->point_cosine, l->point_hoop));
  PetscCall(PetscFree2(l->point_X, l->point_u));
  PetscCall(PetscFree2(l->first_held, l->home_held));
  PetscCall(PetscFree(l->bend));
  PetscCall(PetscFree(l->lift));
  PetscCall(PetscFree(l->list_point));
  PetscCall(PetscFree(l->facet));
  PetscCall(PetscFree(l->facet_size));
  PetscCall(PetscFree(l->face));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees what belongs to slave points, and the lists. */
static PetscErrorCode FreeSlaves(NeighbourLists *lists)
{
  NeighbourLists l = *lists;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(l->near));
  PetscCall(PetscFree5(l->slave_ptr, l->slave_node, l->slave_side, l->slave_S, l->slave_offset));
  PetscCall(PetscFree3(l->slave_X, l->slave_u, l->slave_normal));
  PetscCall(PetscFree6(l->list_ptr, l->facet_ptr, l->kappa, l->nearest, l->share, l->averse));
  PetscCall(PetscFree5(l->fit_n, l->rung, l->degree, l->frame, l->metric));
  PetscCall(PetscFree6(l->pivot, l->amplified, l->residual, l->centre, l->gap, l->normal));
  PetscCall(PetscFree(*lists));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsDestroy - frees the lists.

  Collective

  Input/Output Parameter:
. lists - the lists, NULL on return
@*/
PetscErrorCode NeighbourListsDestroy(NeighbourLists *lists)
{
  PetscFunctionBeginUser;
  if (!*lists) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeNodesAndPoints(*lists));
  PetscCall(FreeSlaves(lists));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsGiveBack - frees the lists, but leaves their room for slave points to the search's next ones.

  Collective

  Input Parameter:
. s - the search that has made them

  Input/Output Parameter:
. lists - the lists, NULL on return

  Note:
  Most slave points of large surfaces have no partner. To make that room anew would cost more than to search.
@*/
PetscErrorCode NeighbourListsGiveBack(ContactSearch s, NeighbourLists *lists)
{
  PetscFunctionBeginUser;
  if (!*lists) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeNodesAndPoints(*lists));
  if (s->slaves->maps.ptr || s->spare) /* lists with maps are of other sizes */
    PetscCall(FreeSlaves(lists));
  else
    s->spare = *lists;
  *lists = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourListsFreeSpare - frees the room that lists have left to a search.

  Not collective

  Input Parameter:
. s - the search
@*/
PetscErrorCode NeighbourListsFreeSpare(ContactSearch s)
{
  PetscFunctionBeginUser;
  if (s->spare) PetscCall(FreeSlaves(&s->spare));
  PetscFunctionReturn(PETSC_SUCCESS);
}
