/* Depths of master nodes in the slave: the slave's facets are searched around each node, with the means of the search
   for masters. */
#include "search/nodedepth.h"
#include "searchimpl.h"
#include "base/gathertable.h"
#include "base/vectors.h"

/* A node stands in a face if it is not deeper than this many sizes of the face. The search for masters reaches as far.
   What is deeper may be on the other side of a thin body. */
#define DEPTH_BOUND 2.0
/* Depths below this part of a face size are round-off of coordinates and projections. */
#define DEPTH_ROUND_OFF 1e-9
/* A foot counts as on a face up to this part of the face's size past a free edge: the ends of two surfaces that are as
   wide as each other lie over each other up to their motion by round-off and small strains. */
#define DEPTH_ON_FACE 1e-3

struct _n_NodeDepths {
  Mesh           mesh;
  ContactSurface slave, master;
  Loads          loads;
  ContactSearch  search;   /* of the slave's facets */
  FitSettings    facets;   /* no fits */
  PetscInt       n, *node; /* master nodes that this rank measures: local nodes of the mesh, or of the rigid tool */
};

/* Master nodes for this rank: of a body its own, without those that the slave has too; of a rigid tool, which is on
   all ranks, an equal part. */
static PetscErrorCode ChooseNodes(NodeDepths depths)
{
  const Mesh       mesh  = depths->mesh;
  const MeshGroup *group = depths->master->group, *slave = depths->slave->group;
  PetscMPIInt      rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  if (!group) {
    const PetscInt n = depths->master->rigid->n_nodes, first = n / size * rank + PetscMin(rank, n % size);

    depths->n = n / size + (rank < n % size);
    PetscCall(PetscMalloc1(depths->n, &depths->node));
    for (PetscInt i = 0; i < depths->n; i++) depths->node[i] = first + i;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(group->n_nodes, &depths->node));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    PetscInt place;

    PetscCall(PetscFindInt(group->nodes[i], slave->n_nodes, slave->nodes, &place));
    if (mesh->node_owner[group->nodes[i]] == rank && place < 0) depths->node[depths->n++] = group->nodes[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeDepthsCreate - prepares the measurement of depths.

  Collective

  Input Parameters:
+ mesh     - the mesh
. scene    - the scene
. loads    - gives the position of rigid tools
. slave    - the slave surface, of a deformable body; its free edges are marked
. master   - the master surface, meshed
. n_images - number of mirror images of the slave
- images   - of SurfaceImages() for the pair

  Output Parameter:
. out - free it with NodeDepthsDestroy()

  Note:
  All arguments are borrowed.
@*/
PetscErrorCode NodeDepthsCreate(Mesh mesh, Scene scene, Loads loads, ContactSurface slave, ContactSurface master,
                                int n_images, const SurfaceImage *images, NodeDepths *out)
{
  NodeDepths depths;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&depths));
  depths->mesh   = mesh;
  depths->loads  = loads;
  depths->slave  = slave;
  depths->master = master;
  PetscCall(ChooseNodes(depths));
  PetscCall(SurfaceFindFreeEdges(slave, n_images, images));
  PetscCall(
    SearchCreate(mesh, scene, loads, slave, 0, n_images, images, &depths->facets, NULL, NULL, NULL, &depths->search));
  *out = depths;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeDepthsDestroy - frees the measurement.

  Collective

  Input/Output Parameter:
. depths - NULL on return; may be NULL before
@*/
PetscErrorCode NodeDepthsDestroy(NodeDepths *depths)
{
  PetscFunctionBeginUser;
  if (!*depths) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SearchDestroy(&(*depths)->search));
  PetscCall(PetscFree((*depths)->node));
  PetscCall(PetscFree(*depths));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Grows a box around all its mirror images. */
static void BoxWithImages(ContactSearch s, PetscReal box[6])
{
  const int dim = s->mesh->dim;
  PetscReal all[6];

  for (int k = 0; k < 6; k++) all[k] = box[k];
  for (int m = 1; m < s->n_images; m++) {
    PetscReal corner[2][3];

    if (s->images[m].left_out) continue;
    for (int k = 0; k < 2; k++) SurfaceReflect(&s->images[m], dim, &box[3 * k], corner[k]);
    for (int d = 0; d < dim; d++) {
      all[d]     = PetscMin(all[d], PetscMin(corner[0][d], corner[1][d]));
      all[3 + d] = PetscMax(all[3 + d], PetscMax(corner[0][d], corner[1][d]));
    }
  }
  for (int k = 0; k < 6; k++) box[k] = all[k];
}

/* Box of the whole slave with its mirror images, over all ranks. */
static PetscErrorCode SlaveBox(NodeDepths depths, const PetscReal *u, PetscReal t, PetscReal box[6])
{
  PetscFunctionBeginUser;
  SearchMasterBox(depths->search, u, t, NULL, box);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, 3, MPIU_REAL, MPI_MIN, depths->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &box[3], 3, MPIU_REAL, MPI_MAX, depths->mesh->comm));
  BoxWithImages(depths->search, box);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A master node near the slave, in the present position */
typedef struct {
  PetscInt  node;
  PetscReal x[3], normal[3];
} DepthNode;

/* Position of a master node, relative to the mesh's centre. */
static void NodePosition(NodeDepths depths, const PetscReal *u, PetscReal t, PetscInt node, PetscReal x[3])
{
  const Mesh mesh = depths->mesh;
  const int  dim  = mesh->dim;

  x[0] = x[1] = x[2] = 0;
  if (depths->master->rigid) {
    PetscReal X[3] = {0, 0, 0};

    for (int d = 0; d < dim; d++) X[d] = depths->master->rigid->coords[node * dim + d];
    LoadsRigidMotion(depths->loads, depths->master->body, t, X, x);
  } else {
    for (int d = 0; d < dim; d++) x[d] = mesh->coords[node * dim + d] + u[node * dim + d];
  }
}

/* Lists this rank's master nodes within reach of the slave's box, and their own box. */
static PetscErrorCode NearNodes(NodeDepths depths, const PetscReal *u, PetscReal t, PetscInt *n, DepthNode *nodes,
                                PetscReal box[6])
{
  const Mesh    mesh = depths->mesh;
  const int     dim  = mesh->dim;
  PetscReal     slave[6];
  NodeGeometry *geometry;

  PetscFunctionBeginUser;
  PetscCall(SlaveBox(depths, u, t, slave));
  PetscCall(PetscMalloc1(depths->master->rigid ? depths->master->rigid->n_nodes : mesh->n_nodes, &geometry));
  PetscCall(SurfaceNodeGeometry(depths->master, depths->search->scene->geometry, depths->loads, u, t, NULL, geometry));
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
  }
  *n = 0;
  for (PetscInt i = 0; i < depths->n; i++) {
    DepthNode *node = &nodes[*n];
    PetscReal  own[6];

    node->node = depths->node[i];
    NodePosition(depths, u, t, node->node, node->x);
    for (int d = 0; d < 3; d++) own[d] = own[3 + d] = node->x[d];
    if (!SearchBoxesMeet(own, slave, dim, depths->search->reach)) continue;
    for (int d = 0; d < 3; d++) {
      node->normal[d] = geometry[node->node].normal[d];
      box[d]          = PetscMin(box[d], node->x[d]);
      box[3 + d]      = PetscMax(box[3 + d], node->x[d]);
    }
    (*n)++;
  }
  PetscCall(PetscFree(geometry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Search for the facets nearest to one node */
typedef struct {
  NeighbourLists     lists;
  const SearchField *field;
  const PetscReal   *x;
  PetscReal          least; /* distance of the nearest facet so far */
} DepthSearch;

/* A candidate as a facet of its own nodes, with their positions relative to the node. */
static Facet RelativeFacet(const DepthSearch *look, int index, int first, PetscReal *x)
{
  const NeighbourLists lists = look->lists;
  const int            dim   = lists->dim;
  Facet                facet = look->field->candidates[index].facet;

  for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
    const int point = facet.nodes[a];

    for (int d = 0; d < dim; d++)
      x[(first + a) * dim + d] = lists->point_X[point * dim + d] + lists->point_u[point * dim + d] - look->x[d];
    facet.nodes[a] = first + a;
  }
  return facet;
}

static void VisitFacet(void *context, int index, double *bound)
{
  DepthSearch *look = context;
  PetscReal    x[FACE_MAX_NODES * 3];
  Facet        facet = RelativeFacet(look, index, 0, x);
  Foot         foot;

  facet.free_edges = 0;
  FacetProject(look->lists->dim, &facet, x, &foot);
  look->least = PetscMin(look->least, PetscAbsReal(foot.gap));
  *bound      = PetscMin(*bound, look->least);
}

/* Room for the facets that share the nearest point */
typedef struct {
  int       *found;
  Facet     *facets;
  PetscReal *x;
} DepthRoom;

/* Depth of a node in the slave's nearest face, or 0. *size: of that face.

   The nearest face counts whichever way it looks: where that is not against the node's normal, the node is behind
   another side of a thin body. */
static PetscReal NodeDepthIn(DepthSearch *look, BoxTree tree, const DepthNode *node, const PetscReal *allowed,
                             PetscReal reach, const DepthRoom *room, PetscReal *size)
{
  const SearchField *field  = look->field;
  double             bound  = reach;
  PetscReal          cosine = 0, depth;
  const Candidate   *nearest;
  Foot               foot;
  int                n;

  look->x     = node->x;
  look->least = PETSC_MAX_REAL;
  BoxTreeClosest(tree, node->x, NULL, &bound, VisitFacet, look);
  if (look->least > reach) return 0;
  n = BoxTreeNear(tree, node->x, look->least + FACET_COINCIDENT * reach, (int)field->n_candidates, room->found);
  for (int i = 0; i < n; i++) room->facets[i] = RelativeFacet(look, room->found[i], i * FACE_MAX_NODES, room->x);
  if (!FacetClosest(look->lists->dim, n, room->facets, room->x, -1, &foot)) return 0;
  nearest = &field->candidates[room->found[foot.facet]];
  *size   = field->records[nearest->record].size;
  for (int d = 0; d < look->lists->dim; d++) cosine += foot.normal[d] * node->normal[d];
  if (cosine >= 0 || foot.beyond > DEPTH_ON_FACE * *size || -foot.gap > DEPTH_BOUND * *size) return 0;
  depth = -foot.gap - allowed[nearest->record];
  return depth > DEPTH_ROUND_OFF * *size ? depth : 0;
}

/* Fetches what is allowed on the faces that arrived. */
static PetscErrorCode FetchAllowed(NodeDepths depths, const SearchField *field, const PetscReal *allowed,
                                   PetscReal *fetched)
{
  PetscSF faces;

  PetscFunctionBeginUser;
  PetscCall(SearchFieldWay(depths->search, field, &faces));
  PetscCall(PetscSFBcastBegin(faces, MPIU_REAL, allowed, fetched, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(faces, MPIU_REAL, allowed, fetched, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures the nodes of this rank: their depths, 0 where a node does not stand in the slave, and the largest ones. */
static PetscErrorCode MeasureNodes(NodeDepths depths, NeighbourLists lists, const SearchField *field, PetscInt n,
                                   const DepthNode *nodes, const PetscReal *allowed, PetscReal *depth, NodeDepth *mine)
{
  DepthSearch look = {.lists = lists, .field = field};
  DepthRoom   room;
  BoxTree     tree;

  PetscFunctionBeginUser;
  PetscCall(CandidatesTree(lists->dim, field->n_candidates, field->candidates, PETSC_FALSE, PETSC_FALSE, &tree));
  PetscCall(PetscMalloc3(field->n_candidates, &room.found, field->n_candidates, &room.facets,
                         field->n_candidates * FACE_MAX_NODES * lists->dim, &room.x));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal size;

    depth[i] = NodeDepthIn(&look, tree, &nodes[i], allowed, depths->search->reach, &room, &size);
    if (depth[i] <= 0) continue;
    mine->nodes++;
    mine->over_h = PetscMax(mine->over_h, depth[i] / size);
    mine->depth  = PetscMax(mine->depth, depth[i]);
  }
  PetscCall(PetscFree3(room.found, room.facets, room.x));
  BoxTreeDestroy(&tree);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unit normal of a face of the master in the reference configuration, if the node of a tag is one of its own. */
static PetscBool NormalAtTag(NodeDepths depths, PetscInt f, PetscInt tag, PetscReal normal[3])
{
  const Facet     *face  = &depths->master->faces[f];
  const MeshRigid *rigid = depths->master->rigid;
  const PetscInt  *tags  = rigid ? rigid->node_tag : depths->mesh->node_tag;
  const PetscReal *X     = rigid ? rigid->coords : depths->mesh->coords;
  const int        dim   = depths->mesh->dim;
  PetscReal        x[FACE_MAX_NODES * 3];
  PetscBool        has    = PETSC_FALSE;
  Candidate        middle = {.facet = *face};

  for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
    has = (PetscBool)(has || tags[face->nodes[a]] == tag);
    for (int d = 0; d < dim; d++) x[a * dim + d] = X[face->nodes[a] * dim + d];
  }
  if (!has) return PETSC_FALSE;
  CandidatePlace(dim, x, 0, &middle);
  for (int d = 0; d < 3; d++) normal[d] = d < dim ? middle.normal[d] : 0;
  return PETSC_TRUE;
}

/* Says whether two faces of the master around a node are those of a wedge. */
static PetscErrorCode FindWedge(NodeDepths depths, PetscInt tag, PetscBool *wedge)
{
  const ContactSurface master = depths->master;
  PetscMPIInt          rank;
  PetscInt             n = 0;
  PetscReal           *own;
  GatherTable          normals;

  PetscFunctionBeginUser;
  *wedge = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(depths->mesh->comm, &rank));
  PetscCall(PetscMalloc1(3 * master->n_faces, &own));
  for (PetscInt f = 0; f < master->n_faces && !(master->rigid && rank); f++)
    n += NormalAtTag(depths, f, tag, &own[3 * n]); /* a tool has all its faces on every rank */
  PetscCall(GatherTableCreate(depths->mesh->comm, 3, n, own, &normals));
  for (PetscInt i = 0; i < normals.n; i++)
    for (PetscInt k = 0; k < i; k++)
      *wedge = (PetscBool)(*wedge || Dot(&normals.row[3 * i], &normals.row[3 * k]) < VECTORS_WEDGE);
  PetscCall(GatherTableDestroy(&normals));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Completes the figures over all ranks. Of nodes whose depths differ by round-off it names the one of lowest tag. */
static PetscErrorCode Deepest(NodeDepths depths, PetscInt n, const DepthNode *nodes, const PetscReal *depth,
                              NodeDepth *deepest)
{
  const Mesh       mesh    = depths->mesh;
  const MeshRigid *rigid   = depths->master->rigid;
  PetscReal        most[2] = {deepest->depth, deepest->over_h};
  PetscReal        X[3]    = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL};
  PetscInt         tag = PETSC_MAX_INT, at = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &deepest->nodes, 1, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, mesh->comm));
  deepest->depth  = most[0];
  deepest->over_h = most[1];
  if (!deepest->nodes) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt own = rigid ? rigid->node_tag[nodes[i].node] : mesh->node_tag[nodes[i].node];

    if (!(depth[i] >= most[0] - DEPTH_ROUND_OFF * depths->slave->mean_size) || own >= tag) continue;
    tag = own;
    at  = nodes[i].node;
  }
  PetscCallMPI(MPI_Allreduce(&tag, &deepest->tag, 1, MPIU_INT, MPI_MIN, mesh->comm));
  if (tag == deepest->tag && at >= 0) {
    X[0] = X[1] = X[2] = 0;
    if (!rigid) MeshNodePlace(mesh, at, X);
    for (int d = 0; rigid && d < mesh->dim; d++) X[d] = rigid->coords[at * mesh->dim + d] + mesh->centre[d];
  }
  PetscCallMPI(MPI_Allreduce(X, deepest->X, 3, MPIU_REAL, MPIU_MAX, mesh->comm));
  PetscCall(FindWedge(depths, deepest->tag, &deepest->wedge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NodeDepthsMeasure - finds the master node that stands deepest in the slave.

  Collective

  Input Parameters:
+ depths  - the measurement
. u       - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t       - load parameter, for rigid tools
- allowed - allowed[faces of the slave on this rank]: depth in each face that does not count (length); negative: nodes
            in front of the face count from there on

  Output Parameter:
. depth - the same on all ranks and on any number of them

  Note:
  A node counts where its foot on the slave's facets lies within the surface, so that a tool may be wider than the
  slave, and where slave and master look at each other. Depths are bounded by two face sizes: what is deeper may be on
  the other side of a thin body.
@*/
PetscErrorCode NodeDepthsMeasure(NodeDepths depths, const PetscReal *u, PetscReal t, const PetscReal *allowed,
                                 NodeDepth *depth)
{
  NeighbourLists lists;
  SearchField    field;
  DepthNode     *nodes;
  PetscReal      box[6], *fetched, *own;
  PetscInt       n;

  PetscFunctionBeginUser;
  *depth = (NodeDepth){.tag = -1};
  ToolsPlace(depths->mesh, u, t);
  PetscCall(PetscMalloc2(depths->n, &nodes, depths->n, &own));
  PetscCall(NearNodes(depths, u, t, &n, nodes, box));
  PetscCall(PetscNew(&lists));
  lists->t = NAN; /* not updated yet */
  PetscCall(
    SearchFieldCreate(depths->search, u, t, box, depths->search->reach, depths->search->fit->fitted, lists, &field));
  PetscCall(PetscMalloc1(field.n_records, &fetched));
  PetscCall(FetchAllowed(depths, &field, allowed, fetched));
  PetscCall(MeasureNodes(depths, lists, &field, n, nodes, fetched, own, depth));
  PetscCall(PetscFree(fetched));
  PetscCall(SearchFieldDestroy(&field));
  PetscCall(NeighbourListsDestroy(&lists));
  PetscCall(Deepest(depths, n, nodes, own, depth));
  PetscCall(PetscFree2(nodes, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes out of the mean normal of a node what its mirror images cancel. */
static void MirrorNormal(ContactSearch s, PetscInt node, PetscReal normal[3])
{
  const int        dim = s->mesh->dim;
  const PetscReal *x   = &s->mesh->coords[node * dim];

  for (int plane = 1; plane < s->n_images; plane <<= 1)
    for (int d = 0; d < dim; d++)
      if (s->images[plane].sign[d] < 0 &&
          PetscAbsReal(2 * x[d] - s->images[plane].shift[d]) <= 2 * SEARCH_ON_PLANE * s->mesh->size)
        normal[d] = 0;
}

/* Height over the middle of a face (length) of the smooth surface that has the normals of its nodes, half the mean of
   n_a.(X_a - X_m). Normals that turn from the face's by more than half the feature angle belong to an edge. */
static PetscReal FaceHeight(NodeDepths depths, const Facet *face, const PetscReal *normals, PetscReal cosine)
{
  const Mesh mesh = depths->mesh;
  const int  dim = mesh->dim, nodes        = ElementGet(face->type)->nodes;
  PetscReal  x[FACE_MAX_NODES * 3], height = 0;
  Candidate  middle = {.facet = *face};

  for (int a = 0; a < nodes; a++)
    for (int d = 0; d < dim; d++) x[a * dim + d] = mesh->coords[face->nodes[a] * dim + d];
  CandidatePlace(dim, x, 0, &middle);
  for (int a = 0; a < nodes; a++) {
    PetscReal n[3] = {0, 0, 0}, along = 0, length = 0, turned = 0;

    for (int d = 0; d < 3; d++) n[d] = normals[3 * face->nodes[a] + d];
    MirrorNormal(depths->search, face->nodes[a], n);
    for (int d = 0; d < dim; d++) {
      length += PetscSqr(n[d]);
      turned += n[d] * middle.normal[d];
      along += n[d] * (x[a * dim + d] - middle.centre[d]);
    }
    length = PetscSqrtReal(length);
    if (length > 0 && turned >= cosine * length) height += along / (2 * length * nodes);
  }
  return height;
}

/*@
  NodeDepthsSagitta - computes how far first-order facets of the slave lie inside the concave surface that they stand
  for, in the reference configuration. On such faces a master node stands in the slave by that much where the surfaces
  touch.

  Collective

  Input Parameters:
+ depths        - the measurement
- feature_angle - edges of the slave that are sharper are no part of a curved surface (radians)

  Output Parameter:
. sagitta - sagitta[faces of the slave on this rank] (length), not negative; 0 on flat and convex faces and for order 2
@*/
PetscErrorCode NodeDepthsSagitta(NodeDepths depths, PetscReal feature_angle, PetscReal *sagitta)
{
  const Mesh      mesh   = depths->mesh;
  const PetscReal cosine = PetscCosReal(feature_angle / 2);
  PetscReal      *area, *normal;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sagitta, depths->slave->n_faces));
  if (mesh->order > 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normal));
  PetscCall(SurfaceNodeNormals(depths->slave, NULL, area, normal));
  for (PetscInt f = 0; f < depths->slave->n_faces; f++)
    sagitta[f] = PetscMax(0, -FaceHeight(depths, &depths->slave->faces[f], normal, cosine));
  PetscCall(PetscFree2(area, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
