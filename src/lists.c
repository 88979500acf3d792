#include "searchimpl.h"

typedef struct {
  PetscInt  id, owner, local;
  PetscReal X[3];
} NodeKey;

static int NodeKeyCompare(const void *a, const void *b)
{
  const NodeKey *p = a, *q = b;
  return p->id < q->id ? -1 : p->id > q->id;
}

static PetscInt UniqueNodes(PetscInt n, NodeKey *keys)
{
  PetscInt kept = 0;

  if (n) qsort(keys, n, sizeof(*keys), NodeKeyCompare);
  for (PetscInt i = 0; i < n; i++)
    if (!kept || keys[i].id != keys[kept - 1].id) keys[kept++] = keys[i];
  return kept;
}

static int FindNode(PetscInt n, const NodeKey *keys, PetscInt id)
{
  const NodeKey  wanted = {.id = id};
  const NodeKey *found  = bsearch(&wanted, keys, n, sizeof(*keys), NodeKeyCompare);

  return (int)(found - keys);
}

/* Numbers the contact nodes (slave nodes and nodes of the listed faces), makes the star forest to their owners, and rewrites the records'
   facets in these numbers. */
PetscErrorCode ListsCreateNodes(ContactSearch s, PetscInt n_records, FaceRecord *records, ContactLists lists)
{
  Mesh            mesh  = s->mesh;
  const int       dim   = mesh->dim;
  const PetscBool rigid = (PetscBool)(s->master && s->master->rigid);
  PetscInt        n = 0, n_rigid = 0;
  NodeKey        *keys, *tool;
  PetscSFNode    *remote;
  const PetscInt *dofs;
  MPI_Datatype    integers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->n_slaves + FACE_MAX_NODES * n_records, &keys, FACE_MAX_NODES * n_records, &tool));
  for (PetscInt i = 0; i < s->n_slaves; i++) {
    const PetscInt node = s->slaves[i];

    keys[n] = (NodeKey){.id = mesh->node_id[node], .owner = mesh->node_owner[node], .local = mesh->node_owner_local[node]};
    for (int d = 0; d < dim; d++) keys[n].X[d] = mesh->coords[node * dim + d];
    n++;
  }
  for (PetscInt r = 0; r < n_records; r++) {
    for (int a = 0; a < ElementGet(records[r].facet.type)->nodes; a++) {
      NodeKey *key = rigid ? &tool[n_rigid++] : &keys[n++];

      *key = (NodeKey){.id = records[r].id[a], .owner = records[r].owner[a], .local = records[r].local[a]};
      for (int d = 0; d < 3; d++) key->X[d] = records[r].X[a * 3 + d];
    }
  }
  n                   = UniqueNodes(n, keys);
  n_rigid             = UniqueNodes(n_rigid, tool);
  lists->n_deformable = n;
  lists->n_nodes      = n + n_rigid;
  for (PetscInt r = 0; r < n_records; r++)
    for (int a = 0; a < ElementGet(records[r].facet.type)->nodes; a++)
      records[r].facet.nodes[a] = rigid ? (int)n + FindNode(n_rigid, tool, records[r].id[a]) : FindNode(n, keys, records[r].id[a]);

  PetscCall(PetscMalloc4(lists->n_nodes, &lists->node_id, lists->n_nodes * dim, &lists->X, lists->n_nodes * dim, &lists->u, lists->n_nodes * dim, &lists->dof));
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt i = 0; i < n; i++) {
    lists->node_id[i] = keys[i].id;
    remote[i]         = (PetscSFNode){keys[i].owner, keys[i].local};
    for (int d = 0; d < dim; d++) lists->X[i * dim + d] = keys[i].X[d];
  }
  for (PetscInt i = 0; i < n_rigid; i++) {
    lists->node_id[n + i] = tool[i].id;
    for (int d = 0; d < dim; d++) {
      lists->X[(n + i) * dim + d]   = s->master->rigid->coords[tool[i].id * dim + d];
      lists->dof[(n + i) * dim + d] = -1;
    }
  }
  PetscCall(PetscSFCreate(mesh->comm, &lists->sf));
  PetscCall(PetscSFSetGraph(lists->sf, mesh->n_nodes, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(lists->sf));
  PetscCallMPI(MPI_Type_contiguous(dim, MPIU_REAL, &lists->block));
  PetscCallMPI(MPI_Type_commit(&lists->block));
  PetscCallMPI(MPI_Type_contiguous(dim, MPIU_INT, &integers));
  PetscCallMPI(MPI_Type_commit(&integers));
  PetscCall(MeshGetGlobalDofs(mesh, &dofs));
  PetscCall(PetscSFBcastBegin(lists->sf, integers, dofs, lists->dof, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, integers, dofs, lists->dof, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&integers));
  PetscCall(PetscFree2(keys, tool));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ListsBroadcast - values of the contact nodes from those of the mesh's nodes.

   Collective. x[mesh n_nodes*dim]: local, read at owned nodes; values[lists n_nodes*dim]: nodes of a rigid tool get their motion (length)
   from load parameter t to t_next. */
PetscErrorCode ListsBroadcast(ContactSearch s, ContactLists lists, const PetscReal *x, PetscReal t, PetscReal t_next, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(lists->sf, lists->block, x, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, lists->block, x, values, MPI_REPLACE));
  for (PetscInt i = lists->n_deformable; i < lists->n_nodes; i++) {
    PetscReal from[3], to[3];

    SearchRigidPosition(s, lists->node_id[i], t, from);
    SearchRigidPosition(s, lists->node_id[i], t_next, to);
    for (int d = 0; d < lists->dim; d++) values[i * lists->dim + d] = to[d] - from[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ListsReduce - the transpose of ListsBroadcast(): adds values[lists n_nodes*dim] to y[mesh n_nodes*dim] at the owners of the nodes.

   Collective. Values of nodes of a rigid tool go nowhere. */
PetscErrorCode ListsReduce(ContactLists lists, const PetscReal *values, PetscReal *y)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFReduceBegin(lists->sf, lists->block, values, y, MPI_SUM));
  PetscCall(PetscSFReduceEnd(lists->sf, lists->block, values, y, MPI_SUM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ListsUpdateNodes(ContactSearch s, ContactLists lists, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  for (PetscInt i = lists->n_deformable; i < lists->n_nodes; i++) {
    PetscReal x[3];

    SearchRigidPosition(s, lists->node_id[i], t, x);
    for (int d = 0; d < lists->dim; d++) lists->u[i * lists->dim + d] = x[d] - lists->X[i * lists->dim + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = sign * (sum S x), the linear part of a point's map. */
static void PointMap(const ContactLists lists, PetscInt p, const SurfaceImage *image, const PetscReal *x, PetscReal *y)
{
  for (int d = 0; d < lists->dim; d++) {
    PetscReal sum = 0;

    for (PetscInt k = lists->point_ptr[p]; k < lists->point_ptr[p + 1]; k++) sum += lists->point_S[k] * x[lists->point_node[k] * lists->dim + d];
    y[d] = image->sign[d] * sum;
  }
}

void ListsSlaveMap(const ContactLists lists, PetscInt q, const PetscReal *x, PetscReal *y)
{
  for (int d = 0; d < lists->dim; d++) {
    y[d] = 0;
    for (PetscInt k = lists->slave_ptr[q]; k < lists->slave_ptr[q + 1]; k++) y[d] += lists->slave_S[k] * x[lists->slave_node[k] * lists->dim + d];
  }
}

/* ListsUpdate - moves contact nodes, fit points and slave points to (u, t); what is listed stays.

   Collective. u[mesh n_nodes*dim]: local displacements (length), read at owned nodes. */
PetscErrorCode ListsUpdate(ContactSearch s, ContactLists lists, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  lists->t = t;
  PetscCall(ListsUpdateNodes(s, lists, u, t));
  for (PetscInt p = 0; p < lists->n_points; p++) PointMap(lists, p, &s->images[lists->point_image[p]], lists->u, &lists->point_u[p * lists->dim]);
  for (PetscInt q = 0; q < lists->n_slaves; q++) ListsSlaveMap(lists, q, lists->u, &lists->slave_u[q * lists->dim]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The image that a node really has: planes that it lies on do not move it. Image m is the product of the planes whose bits are set in m.
 *planes: how many planes the node lies on. */
static int CanonicalImage(ContactSearch s, const PetscReal *X, int image, int *planes)
{
  *planes = 0;
  for (int bit = 1; bit < s->n_images; bit <<= 1) {
    PetscReal distance = 0;

    for (int d = 0; d < s->mesh->dim; d++) distance = PetscMax(distance, PetscAbsReal(s->images[bit].sign[d] * X[d] + s->images[bit].shift[d] - X[d]));
    if (distance > SEARCH_ON_PLANE * s->mesh->size) continue;
    image &= ~bit;
    (*planes)++;
  }
  return image;
}

/* Numbers the points that the candidates use, writes their maps (one node each, S = 1, no offset), and rewrites the candidates in them. */
PetscErrorCode ListsCreatePoints(ContactSearch s, ContactLists lists, PetscInt n_candidates, Candidate *candidates)
{
  const int dim = lists->dim;
  PetscInt  n = 0, *number, room = s->n_images * lists->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(room, &number));
  for (PetscInt k = 0; k < room; k++) number[k] = -1;
  PetscCall(PetscMalloc6(room + 1, &lists->point_ptr, room, &lists->point_node, room, &lists->point_S, room * dim, &lists->point_offset, room,
                         &lists->point_weight, room, &lists->point_image));
  for (PetscInt c = 0; c < n_candidates; c++) {
    for (int a = 0; a < ElementGet(candidates[c].facet.type)->nodes; a++) {
      const PetscInt node = candidates[c].facet.nodes[a];
      int            planes;
      const int      image = CanonicalImage(s, &lists->X[node * dim], candidates[c].image, &planes);
      PetscInt      *p     = &number[image * lists->n_nodes + node];

      if (*p < 0) {
        *p                      = n;
        lists->point_ptr[n]     = n;
        lists->point_node[n]    = node;
        lists->point_S[n]       = 1;
        lists->point_weight[n]  = 1 << planes; /* what the faces on this side give to a node on a plane is half of its whole */
        lists->point_image[n++] = image;
      }
      candidates[c].facet.nodes[a] = (int)*p;
    }
  }
  lists->point_ptr[n] = n;
  lists->n_points     = n;
  PetscCall(PetscArrayzero(lists->point_offset, n * dim));
  PetscCall(PetscMalloc2(n * dim, &lists->point_X, n * dim, &lists->point_u));
  for (PetscInt p = 0; p < n; p++) {
    const SurfaceImage *image = &s->images[lists->point_image[p]];

    PointMap(lists, p, image, lists->X, &lists->point_X[p * dim]);
    PointMap(lists, p, image, lists->u, &lists->point_u[p * dim]);
    for (int d = 0; d < dim; d++) lists->point_X[p * dim + d] += image->shift[d] + lists->point_offset[p * dim + d];
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normal, spacing and weight of the points: those of their nodes, reflected with them. */
void ListsPointGeometry(ContactSearch s, ContactLists lists, PetscInt n_records, const FaceRecord *records, NodeGeometry *node_geometry, NodeGeometry *geometry)
{
  for (PetscInt r = 0; r < n_records; r++)
    for (int a = 0; a < ElementGet(records[r].facet.type)->nodes; a++) node_geometry[records[r].facet.nodes[a]] = records[r].geometry[a];
  for (PetscInt p = 0; p < lists->n_points; p++) {
    const PetscReal *sign   = s->images[lists->point_image[p]].sign;
    NodeGeometry    *g      = &geometry[p];
    PetscReal        length = 0;

    *g = node_geometry[lists->point_node[p]];
    for (int bit = 1; bit < s->n_images; bit <<= 1) { /* on a plane the other half cancels what is odd in its axis */
      for (int d = 0; d < 3; d++) {
        PetscReal distance;

        if (d >= lists->dim || s->images[bit].sign[d] > 0) continue;
        distance = PetscAbsReal(-lists->X[lists->point_node[p] * lists->dim + d] + s->images[bit].shift[d] - lists->X[lists->point_node[p] * lists->dim + d]);
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

PetscErrorCode ListsCreateSlaves(ContactSearch s, ContactLists lists)
{
  const int dim = lists->dim;
  PetscInt  n   = s->n_slaves;

  PetscFunctionBeginUser;
  lists->n_slaves = n;
  PetscCall(PetscMalloc4(n + 1, &lists->slave_ptr, n, &lists->slave_node, n, &lists->slave_S, n * dim, &lists->slave_offset));
  PetscCall(PetscMalloc2(n * dim, &lists->slave_X, n * dim, &lists->slave_u));
  PetscCall(PetscMalloc3(n + 1, &lists->list_ptr, n + 1, &lists->facet_ptr, n, &lists->kappa));
  PetscCall(PetscCalloc5(n, &lists->fit_n, n, &lists->rung, n, &lists->degree, 9 * n, &lists->frame, 4 * n, &lists->metric));
  PetscCall(PetscCalloc3(n, &lists->pivot, n, &lists->amplified, n, &lists->residual));
  PetscCall(PetscArrayzero(lists->slave_offset, n * dim));
  for (PetscInt q = 0; q < n; q++) {
    PetscInt at;

    PetscCall(PetscFindInt(s->mesh->node_id[s->slaves[q]], lists->n_deformable, lists->node_id, &at));
    lists->slave_ptr[q]  = q;
    lists->slave_node[q] = at;
    lists->slave_S[q]    = 1;
  }
  lists->slave_ptr[n] = n;
  for (PetscInt q = 0; q < n; q++) ListsSlaveMap(lists, q, lists->X, &lists->slave_X[q * dim]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ListsDestroy - Collective. */
PetscErrorCode ListsDestroy(ContactLists *lists)
{
  ContactLists l = *lists;

  PetscFunctionBeginUser;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(l->node_id, l->X, l->u, l->dof));
  PetscCall(PetscSFDestroy(&l->sf));
  PetscCallMPI(MPI_Type_free(&l->block));
  PetscCall(PetscFree6(l->point_ptr, l->point_node, l->point_S, l->point_offset, l->point_weight, l->point_image));
  PetscCall(PetscFree2(l->point_X, l->point_u));
  PetscCall(PetscFree4(l->slave_ptr, l->slave_node, l->slave_S, l->slave_offset));
  PetscCall(PetscFree2(l->slave_X, l->slave_u));
  PetscCall(PetscFree3(l->list_ptr, l->facet_ptr, l->kappa));
  PetscCall(PetscFree5(l->fit_n, l->rung, l->degree, l->frame, l->metric));
  PetscCall(PetscFree3(l->pivot, l->amplified, l->residual));
  PetscCall(PetscFree(l->list_point));
  PetscCall(PetscFree(l->facet));
  PetscCall(PetscFree(l->facet_size));
  PetscCall(PetscFree(*lists));
  PetscFunctionReturn(PETSC_SUCCESS);
}
