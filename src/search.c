#include "fitframe.h"
#include "neighbourhood.h"
#include "search.h"
#include "tree.h"

/* Reach of the search beyond the asked motion, in face sizes: the nearest facet of a slave point that is no farther than this is listed. */
#define SEARCH_REACH 2.0
/* A list holds every facet within this many face sizes (plus the motion) of the nearest one, so that a solve may slide the point there. */
#define SEARCH_MARGIN 1.5
/* Facets are listed only if they face the slave: cosine between the two outward normals below this. 0: any opposed pair. */
#define SEARCH_OPPOSED 0.0
/* Boxes of curved facets are widened by this fraction of the face size: the bulge of a quadratic face beyond its nodes is at most 1/8 of its chord. */
#define SEARCH_BULGE 0.15

/* Points are gathered a little beyond the support (rho^2 up to this), so that those which enter while a solve lasts are in the list. */
#define SEARCH_FIT_MARGIN 1.7
/* On regular meshes points lie exactly on the border of the support; this much beyond still counts as inside, and round-off decides nothing. */
#define SEARCH_FIT_TIE 1e-6
/* A node this close to a plane of symmetry, as a fraction of the model's size, is on it and has no image. */
#define SEARCH_ON_PLANE 1e-9

/* The ladder: wider supports, then lower degrees, until every guard holds. Degree 0: the scene's. */
static const struct {
  int    degree;
  double widen;
} Ladder[RUNGS] = {
  {0, 1   },
  {0, 1.15},
  {0, 1.32},
  {0, 1.52},
  {0, 1.75},
  {2, 1   },
  {2, 1.32},
  {1, 1   }
};

struct _n_ContactSearch {
  Mesh                mesh;
  Scene               scene;
  Loads               loads;
  ContactSurface      slave, master;
  int                 n_images;
  const SurfaceImage *images;
  const FitSettings  *fit;
  PetscInt            n_slaves;
  const PetscInt     *slaves;
  PetscReal           reach, margin; /* lengths, without the motion */
};

/* A master face on its way to a rank that may need it. Plain bytes: ranks of one run have one architecture. */
typedef struct {
  Facet        facet; /* nodes: numbers in id[] order on arrival, later contact nodes */
  PetscReal    size;
  PetscInt     id[FACE_MAX_NODES], owner[FACE_MAX_NODES], local[FACE_MAX_NODES];
  PetscReal    X[FACE_MAX_NODES * 3];
  NodeGeometry geometry[FACE_MAX_NODES]; /* fits only */
} FaceRecord;

/* A face or a mirror image of it, in the current position. */
typedef struct {
  PetscInt  record;
  int       image;
  Facet     facet; /* nodes: contact nodes until the points are numbered, then points */
  PetscReal centre[3], normal[3], lower[3], upper[3];
} Candidate;

typedef struct {
  PetscInt  id, owner, local;
  PetscReal X[3];
} NodeKey;

/* SearchCreate - what stands still for the run: surfaces, images, slave points. Collective. */
PetscErrorCode SearchCreate(Mesh mesh, Scene scene, Loads loads, ContactSurface slave, ContactSurface master, int n_images, const SurfaceImage *images,
                            const FitSettings *fit, PetscInt n, const PetscInt *slaves, ContactSearch *out)
{
  ContactSearch   s;
  const PetscReal size = master ? PetscMax(slave->max_size, master->max_size) : slave->max_size;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->mesh     = mesh;
  s->scene    = scene;
  s->loads    = loads;
  s->slave    = slave;
  s->master   = master;
  s->n_images = n_images;
  s->images   = images;
  s->fit      = fit;
  s->n_slaves = n;
  s->slaves   = slaves;
  s->reach    = SEARCH_REACH * size;
  s->margin   = SEARCH_MARGIN * size;
  *out        = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SearchDestroy - Collective. */
PetscErrorCode SearchDestroy(ContactSearch *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Reflect(const SurfaceImage *image, int dim, const PetscReal *x, PetscReal *y)
{
  for (int d = 0; d < dim; d++) y[d] = image->sign[d] * x[d] + image->shift[d];
}

static void BoxEmpty(PetscReal box[6])
{
  for (int d = 0; d < 3; d++) {
    box[d]     = PETSC_MAX_REAL;
    box[3 + d] = PETSC_MIN_REAL;
  }
}

static void BoxAdd(PetscReal box[6], int dim, const PetscReal *x)
{
  for (int d = 0; d < dim; d++) {
    box[d]     = PetscMin(box[d], x[d]);
    box[3 + d] = PetscMax(box[3 + d], x[d]);
  }
}

static PetscBool BoxesMeet(const PetscReal *a, const PetscReal *b, int dim, PetscReal distance)
{
  for (int d = 0; d < dim; d++)
    if (a[d] > b[3 + d] + distance || b[d] > a[3 + d] + distance) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Box of the slave points of this rank at displacement u. */
static void SlaveBox(ContactSearch s, const PetscReal *u, PetscReal box[6])
{
  const int dim = s->mesh->dim;

  BoxEmpty(box);
  for (PetscInt i = 0; i < s->n_slaves; i++) {
    PetscReal x[3];

    for (int d = 0; d < dim; d++) x[d] = s->mesh->coords[s->slaves[i] * dim + d] + u[s->slaves[i] * dim + d];
    BoxAdd(box, dim, x);
  }
}

static PetscBool SomeImageMeets(ContactSearch s, int n, const PetscReal *x, const PetscReal box[6], PetscReal distance)
{
  const int dim = s->mesh->dim;

  for (int m = 0; m < s->n_images; m++) {
    PetscReal face[6], y[3];

    BoxEmpty(face);
    for (int a = 0; a < n; a++) {
      Reflect(&s->images[m], dim, &x[a * dim], y);
      BoxAdd(face, dim, y);
    }
    if (BoxesMeet(face, box, dim, distance)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void RecordFromMesh(ContactSearch s, const NodeGeometry *geometry, PetscInt f, FaceRecord *record)
{
  Mesh         mesh  = s->mesh;
  const Facet *facet = &s->master->faces[f];

  *record = (FaceRecord){.facet = *facet, .size = s->master->face_size[f]};
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    const PetscInt node = facet->nodes[a];

    record->id[a]    = mesh->node_id[node];
    record->owner[a] = mesh->node_owner[node];
    record->local[a] = mesh->node_owner_local[node];
    if (geometry) record->geometry[a] = geometry[node];
    for (int d = 0; d < mesh->dim; d++) record->X[a * 3 + d] = mesh->coords[node * mesh->dim + d];
  }
}

/* Sends this rank's faces of a deformable master to every rank whose slaves they may reach; returns what arrived (itself included). */
static PetscErrorCode ExchangeFaces(ContactSearch s, const NodeGeometry *geometry, const PetscReal *u, const PetscReal *boxes, PetscReal distance,
                                    PetscInt *n_records, FaceRecord **records)
{
  Mesh        mesh = s->mesh;
  const int   dim  = mesh->dim;
  PetscMPIInt size, *send_bytes, *send_start, *receive_bytes, *receive_start;
  PetscInt    total = 0, *count, room;
  FaceRecord *send;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc5(size, &send_bytes, size, &send_start, size, &receive_bytes, size, &receive_start, size, &count));
  PetscCall(PetscArrayzero(count, size));
  room = PetscMax(1, s->master->n_faces);
  PetscCall(PetscMalloc1(room, &send));
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(total * (PetscInt)sizeof(FaceRecord), &send_start[r]));
    for (PetscInt f = 0; f < s->master->n_faces; f++) {
      const Facet *facet = &s->master->faces[f];
      const int    n     = ElementGet(facet->type)->nodes;
      PetscReal    x[FACE_MAX_NODES * 3];

      for (int a = 0; a < n; a++)
        for (int d = 0; d < dim; d++) x[a * dim + d] = mesh->coords[facet->nodes[a] * dim + d] + u[facet->nodes[a] * dim + d];
      if (!SomeImageMeets(s, n, x, &boxes[6 * r], distance)) continue;
      if (total == room) PetscCall(PetscRealloc((room *= 2) * sizeof(FaceRecord), &send));
      RecordFromMesh(s, geometry, f, &send[total++]);
      count[r]++;
    }
    PetscCall(PetscMPIIntCast(count[r] * (PetscInt)sizeof(FaceRecord), &send_bytes[r]));
  }
  PetscCallMPI(MPI_Alltoall(send_bytes, 1, MPI_INT, receive_bytes, 1, MPI_INT, mesh->comm));
  total = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(total, &receive_start[r]));
    total += receive_bytes[r];
  }
  *n_records = total / (PetscInt)sizeof(FaceRecord);
  PetscCall(PetscMalloc1(*n_records, records));
  PetscCallMPI(MPI_Alltoallv(send, send_bytes, send_start, MPI_BYTE, *records, receive_bytes, receive_start, MPI_BYTE, mesh->comm));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree5(send_bytes, send_start, receive_bytes, receive_start, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where node n of the rigid tool is at t, relative to the mesh's centre. */
static void RigidPosition(ContactSearch s, PetscInt n, PetscReal t, PetscReal x[3])
{
  const int dim  = s->mesh->dim;
  PetscReal X[3] = {0, 0, 0};

  for (int d = 0; d < dim; d++) X[d] = s->master->rigid->coords[n * dim + d];
  LoadsRigidMotion(s->loads, s->master->body, t, X, x);
}

/* The faces of a rigid tool that come near this rank's slaves; every rank has them all. */
static PetscErrorCode PickRigidFaces(ContactSearch s, const NodeGeometry *geometry, PetscReal t, const PetscReal box[6], PetscReal distance,
                                     PetscInt *n_records, FaceRecord **records)
{
  const int dim = s->mesh->dim;

  PetscFunctionBeginUser;
  *n_records = 0;
  PetscCall(PetscMalloc1(s->master->n_faces, records));
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    const Facet *facet = &s->master->faces[f];
    const int    n     = ElementGet(facet->type)->nodes;
    PetscReal    x[FACE_MAX_NODES * 3];

    for (int a = 0; a < n; a++) {
      PetscReal y[3];

      RigidPosition(s, facet->nodes[a], t, y);
      for (int d = 0; d < dim; d++) x[a * dim + d] = y[d];
    }
    if (!SomeImageMeets(s, n, x, box, distance)) continue;
    (*records)[*n_records] = (FaceRecord){.facet = *facet, .size = s->master->face_size[f]};
    for (int a = 0; a < n; a++) {
      (*records)[*n_records].id[a] = facet->nodes[a];
      if (geometry) (*records)[*n_records].geometry[a] = geometry[facet->nodes[a]];
    }
    (*n_records)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int RecordCompare(const void *a, const void *b)
{
  const FaceRecord *p = a, *q = b;
  return p->facet.tag < q->facet.tag ? -1 : p->facet.tag > q->facet.tag;
}

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
static PetscErrorCode ListsCreateNodes(ContactSearch s, PetscInt n_records, FaceRecord *records, ContactLists lists)
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

    RigidPosition(s, lists->node_id[i], t, from);
    RigidPosition(s, lists->node_id[i], t_next, to);
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

static PetscErrorCode UpdateNodes(ContactSearch s, ContactLists lists, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(lists->sf, lists->block, u, lists->u, MPI_REPLACE));
  for (PetscInt i = lists->n_deformable; i < lists->n_nodes; i++) {
    PetscReal x[3];

    RigidPosition(s, lists->node_id[i], t, x);
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

static void SlaveMap(const ContactLists lists, PetscInt q, const PetscReal *x, PetscReal *y)
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
  PetscCall(UpdateNodes(s, lists, u, t));
  for (PetscInt p = 0; p < lists->n_points; p++) PointMap(lists, p, &s->images[lists->point_image[p]], lists->u, &lists->point_u[p * lists->dim]);
  for (PetscInt q = 0; q < lists->n_slaves; q++) SlaveMap(lists, q, lists->u, &lists->slave_u[q * lists->dim]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Centre and unit normal of a candidate from the current positions of its nodes. */
static void CandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *c)
{
  const Element *e     = ElementGet(c->facet.type);
  double         xi[2] = {0, 0}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], t[2][3] = {{0}}, length = 0;

  if (e->corners == 3) xi[0] = xi[1] = 1.0 / 3;
  ElementShape(e->type, xi, N, dN, NULL);
  for (int d = 0; d < 3; d++) {
    c->centre[d] = 0;
    c->lower[d]  = PETSC_MAX_REAL;
    c->upper[d]  = PETSC_MIN_REAL;
  }
  for (int a = 0; a < e->nodes; a++) {
    for (int d = 0; d < dim; d++) {
      c->centre[d] += N[a] * x[a * dim + d];
      c->lower[d] = PetscMin(c->lower[d], x[a * dim + d]);
      c->upper[d] = PetscMax(c->upper[d], x[a * dim + d]);
      for (int k = 0; k < e->dim; k++) t[k][d] += dN[a * e->dim + k] * x[a * dim + d];
    }
  }
  if (dim == 2) {
    c->normal[0] = t[0][1];
    c->normal[1] = -t[0][0];
    c->normal[2] = 0;
  } else {
    for (int d = 0; d < 3; d++) c->normal[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
  }
  for (int d = 0; d < 3; d++) length += PetscSqr(c->normal[d]);
  length = PetscSqrtReal(length);
  for (int d = 0; d < 3; d++) {
    if (length > 0) c->normal[d] /= length;
    c->lower[d] -= e->order == 2 ? SEARCH_BULGE * size : 0;
    c->upper[d] += e->order == 2 ? SEARCH_BULGE * size : 0;
  }
}

/* Positions of a candidate's nodes while they are contact nodes still. */
static void ImagePositions(ContactSearch s, ContactLists lists, const Candidate *c, PetscReal *x)
{
  const int dim = lists->dim;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++) {
    PetscReal y[3];

    for (int d = 0; d < dim; d++) y[d] = lists->X[c->facet.nodes[a] * dim + d] + lists->u[c->facet.nodes[a] * dim + d];
    Reflect(&s->images[c->image], dim, y, &x[a * dim]);
  }
}

/* Positions of a candidate's nodes once they are points. */
static void CandidatePositions(ContactLists lists, const Candidate *c, PetscReal *x)
{
  const int dim = lists->dim;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < dim; d++) x[a * dim + d] = lists->point_X[c->facet.nodes[a] * dim + d] + lists->point_u[c->facet.nodes[a] * dim + d];
}

/* All faces and mirror images near this rank's slaves, in an order that does not depend on the ranks. */
static PetscErrorCode MakeCandidates(ContactSearch s, ContactLists lists, PetscInt n_records, const FaceRecord *records, const PetscReal box[6],
                                     PetscReal distance, PetscInt *n, Candidate **candidates)
{
  const int dim = lists->dim;
  PetscReal x[FACE_MAX_NODES * 3];

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(n_records * s->n_images, candidates));
  for (PetscInt r = 0; r < n_records; r++) {
    for (int m = 0; m < s->n_images; m++) {
      Candidate *c = &(*candidates)[*n];
      PetscReal  own[6];

      *c           = (Candidate){.record = r, .image = m, .facet = SurfaceImageFacet(&records[r].facet, &s->images[m])};
      c->facet.tag = records[r].facet.tag * SURFACE_MAX_IMAGES + m;
      ImagePositions(s, lists, c, x);
      CandidatePlace(dim, x, records[r].size, c);
      for (int d = 0; d < 3; d++) {
        own[d]     = c->lower[d];
        own[3 + d] = c->upper[d];
      }
      if (BoxesMeet(own, box, dim, distance)) (*n)++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One slave point looking for its nearest facet. */
typedef struct {
  ContactLists     lists;
  const Candidate *candidates;
  PetscReal        x[3], normal[3];
  PetscInt         node; /* contact node of the slave point: it is not its own master */
  PetscInt         best;
  Foot             foot; /* on the best */
} Nearest;

static PetscBool CandidateFaces(const Nearest *look, const Candidate *c)
{
  PetscReal cosine = 0;

  for (int d = 0; d < look->lists->dim; d++) cosine += look->normal[d] * c->normal[d];
  if (cosine >= SEARCH_OPPOSED) return PETSC_FALSE;
  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    if (look->lists->point_node[c->facet.nodes[a]] == look->node) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void NearestVisit(void *context, int index, double *bound)
{
  Nearest         *look = context;
  const int        dim  = look->lists->dim;
  const Candidate *c    = &look->candidates[index];
  Facet            own  = c->facet; /* without free edges: the distance to the facet itself, not to its extension */
  PetscReal        x[FACE_MAX_NODES * 3], distance;
  Foot             foot;

  if (!CandidateFaces(look, c)) return;
  CandidatePositions(look->lists, c, x);
  own.free_edges = 0;
  for (int a = 0; a < ElementGet(own.type)->nodes; a++) {
    own.nodes[a] = a;
    for (int d = 0; d < dim; d++) x[a * dim + d] -= look->x[d];
  }
  FacetProject(dim, &own, x, &foot);
  distance = PetscAbsReal(foot.gap);
  if (distance > *bound || (distance == *bound && look->best >= 0 && c->facet.tag > look->candidates[look->best].facet.tag)) return;
  *bound     = distance;
  look->best = index;
  look->foot = foot;
}

/* Curvature of the master around its nearest facet: turn of the normals of the facets that touch it over the distance of their centres. */
static PetscReal ListCurvature(const Nearest *look, PetscInt n, const int *found)
{
  const Candidate *c     = &look->candidates[look->best];
  PetscReal        kappa = 0;

  for (PetscInt i = 0; i < n; i++) {
    const Candidate *o      = &look->candidates[found[i]];
    PetscReal        cosine = 0, distance = 0;
    PetscBool        touch = PETSC_FALSE;

    for (int a = 0; a < ElementGet(c->facet.type)->corners; a++)
      for (int b = 0; b < ElementGet(o->facet.type)->corners; b++) touch = (PetscBool)(touch || c->facet.nodes[a] == o->facet.nodes[b]);
    for (int d = 0; d < 3; d++) {
      cosine += c->normal[d] * o->normal[d];
      distance += PetscSqr(c->centre[d] - o->centre[d]);
    }
    if (touch && distance > 0) kappa = PetscMax(kappa, PetscAcosReal(PetscMax(-1, PetscMin(1, cosine))) / PetscSqrtReal(distance));
  }
  return kappa;
}

/* Lists of all slave points, growing. */
typedef struct {
  PetscInt   n, room;
  Facet     *facet;
  PetscReal *size;
  PetscInt   n_points, points_room, *point;
  PetscInt  *position; /* of every point in the present slave point's list; older entries are below its start */
} ListBuffer;

static PetscErrorCode ListAddPoint(ListBuffer *buffer, PetscInt first, PetscInt point)
{
  PetscFunctionBeginUser;
  if (buffer->position[point] >= first) PetscFunctionReturn(PETSC_SUCCESS);
  if (buffer->n_points == buffer->points_room)
    PetscCall(PetscRealloc((buffer->points_room = 2 * buffer->points_room + 1024) * sizeof(PetscInt), &buffer->point));
  buffer->position[point]           = buffer->n_points;
  buffer->point[buffer->n_points++] = point;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends the found candidates to the slave point's list, which starts at first; facets' nodes become positions in it. */
static PetscErrorCode ListAddFacets(const Nearest *look, PetscInt n, const int *found, const FaceRecord *records, PetscInt first, ListBuffer *buffer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const Candidate *c     = &look->candidates[found[i]];
    Facet            facet = c->facet;

    if (buffer->n == buffer->room) {
      buffer->room = 2 * buffer->room + 64;
      PetscCall(PetscRealloc(buffer->room * sizeof(Facet), &buffer->facet));
      PetscCall(PetscRealloc(buffer->room * sizeof(PetscReal), &buffer->size));
    }
    for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
      PetscCall(ListAddPoint(buffer, first, facet.nodes[a]));
      facet.nodes[a] = (int)(buffer->position[facet.nodes[a]] - first);
    }
    buffer->size[buffer->n]    = records[c->record].size;
    buffer->facet[buffer->n++] = facet;
  }
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
static PetscErrorCode ListsCreatePoints(ContactSearch s, ContactLists lists, PetscInt n_candidates, Candidate *candidates)
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
static void PointGeometry(ContactSearch s, ContactLists lists, PetscInt n_records, const FaceRecord *records, NodeGeometry *node_geometry,
                          NodeGeometry *geometry)
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

static PetscErrorCode ListsCreateSlaves(ContactSearch s, ContactLists lists)
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
  for (PetscInt q = 0; q < n; q++) SlaveMap(lists, q, lists->X, &lists->slave_X[q * dim]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fits of a pair's slave points in the making. */
typedef struct {
  ContactSearch  s;
  ContactLists   lists;
  SurfaceView    view;
  Neighbourhoods neighbourhoods;
  PetscReal     *normals, *reference;
  NodeGeometry  *geometry;
  PetscInt      *points;                             /* of the slave point at hand, FIT_MAX_POINTS */
  double        *x, *multiplier, *taper, *workspace; /* taper: weights of the frame, which fall to nothing where the list ends */
  int           *used;
  PetscReal      plane[3]; /* normal of the one reference plane of a global frame */
} Fitting;

/* Unit normal at the centre of a candidate in the reference position. */
static void ReferenceNormal(ContactLists lists, const Candidate *c, PetscReal normal[3])
{
  Candidate at_rest = *c;
  PetscReal x[FACE_MAX_NODES * 3];

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < lists->dim; d++) x[a * lists->dim + d] = lists->point_X[c->facet.nodes[a] * lists->dim + d];
  CandidatePlace(lists->dim, x, 0, &at_rest);
  for (int d = 0; d < 3; d++) normal[d] = at_rest.normal[d];
}

static PetscErrorCode FittingCreate(ContactSearch s, ContactLists lists, PetscInt n_records, const FaceRecord *records, PetscInt n, const Candidate *candidates,
                                    Fitting *fit)
{
  NodeGeometry *node_geometry;
  Facet        *facets;
  PetscReal    *x;

  PetscFunctionBeginUser;
  *fit = (Fitting){.s = s, .lists = lists};
  PetscCall(PetscMalloc5(3 * n, &fit->normals, 3 * n, &fit->reference, lists->n_points, &fit->geometry, n, &facets, lists->n_points * lists->dim, &x));
  PetscCall(PetscCalloc1(lists->n_nodes, &node_geometry));
  PointGeometry(s, lists, n_records, records, node_geometry, fit->geometry);
  PetscCall(PetscFree(node_geometry));
  for (PetscInt i = 0; i < n; i++) {
    facets[i] = candidates[i].facet;
    ReferenceNormal(lists, &candidates[i], &fit->reference[3 * i]);
    for (int d = 0; d < 3; d++) fit->normals[3 * i + d] = candidates[i].normal[d];
  }
  for (PetscInt i = 0; i < lists->n_points * lists->dim; i++) x[i] = lists->point_X[i] + lists->point_u[i];
  fit->view = (SurfaceView){lists->dim, n, lists->n_points, facets, fit->normals, fit->reference, x, fit->geometry, PetscCosReal(s->fit->feature_angle)};
  PetscCall(NeighbourhoodsCreate(&fit->view, &fit->neighbourhoods));
  PetscCall(PetscMalloc6(FIT_MAX_POINTS, &fit->points, FIT_MAX_POINTS * 3, &fit->x, FIT_MAX_POINTS, &fit->multiplier, FIT_MAX_POINTS, &fit->taper,
                         FitWorkspace(lists->dim, s->fit->degree, FIT_MAX_POINTS), &fit->workspace, FIT_MAX_POINTS, &fit->used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FittingDestroy(Fitting *fit)
{
  Facet     *facets = (Facet *)fit->view.facets;
  PetscReal *x      = (PetscReal *)fit->view.x;

  PetscFunctionBeginUser;
  PetscCall(NeighbourhoodsDestroy(&fit->neighbourhoods));
  PetscCall(PetscFree5(fit->normals, fit->reference, fit->geometry, facets, x));
  PetscCall(PetscFree6(fit->points, fit->x, fit->multiplier, fit->taper, fit->workspace, fit->used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The metric over a frame's tangents as a tensor in space: inverse squared lengths. */
static void MetricInSpace(int dim, double (*frame)[3], double metric[2][2], PetscReal space[9])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      space[3 * i + j] = 0;
      for (int a = 0; a < dim - 1; a++)
        for (int b = 0; b < dim - 1; b++) space[3 * i + j] += frame[a][i] * metric[a][b] * frame[b][j];
    }
  }
}

/* Spacing of the points at a foot. Shape: the nodes' covariances, between the nodes by the shape functions, so that the support does not jump
   from facet to facet and keeps the symmetry of a ring around a node. Size: the mean over the facet's nodes, as those on a cut see one side only. */
static void FootSpacing(const Fitting *fit, PetscInt f, const double *xi, double covariance[3][3], double *area)
{
  const Facet *facet = &fit->view.facets[f];
  const int    n = ElementGet(facet->type)->nodes, dim = fit->lists->dim;
  double       share[FACE_MAX_NODES], total            = 0;

  ElementShape(facet->type, xi, share, NULL, NULL);
  for (int a = 0; a < n; a++) total += share[a] = PetscMax(share[a], 0); /* second-order ones are negative in places */
  *area = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) covariance[i][j] = 0;
  for (int a = 0; a < n; a++) {
    const NodeGeometry *g = &fit->geometry[facet->nodes[a]];
    const double        w = share[a] / total;

    *area += (dim == 3 ? PetscSqr(g->spacing) : g->spacing) / n;
    for (int d = 0; d < 3; d++) {
      covariance[d][d] += w * g->covariance[d];
      covariance[d][(d + 1) % 3] += w * g->covariance[3 + d];
      covariance[(d + 1) % 3][d] += w * g->covariance[3 + d];
    }
  }
}

static PetscReal PointRho2(const Fitting *fit, PetscInt p, const PetscReal foot[3], const PetscReal space[9])
{
  const int dim  = fit->lists->dim;
  PetscReal rho2 = 0;

  for (int i = 0; i < dim; i++)
    for (int j = 0; j < dim; j++) rho2 += (fit->view.x[p * dim + i] - foot[i]) * space[3 * i + j] * (fit->view.x[p * dim + j] - foot[j]);
  return rho2;
}

/* Tries one rung for the slave point that look found a facet for: points, frame, metric into fit and problem; true when every guard holds. */
static PetscErrorCode FitRung(Fitting *fit, const Nearest *look, int rung, FitProblem *problem, FitResult *result, PetscBool *holds)
{
  const FitSettings *settings = fit->s->fit;
  const PetscReal   *outward  = look->candidates[look->best].normal; /* the foot's own may lie along the surface when the foot is on an edge */
  const int          dim = fit->lists->dim, degree = Ladder[rung].degree ? PetscMin(Ladder[rung].degree, settings->degree) : settings->degree;
  double             covariance[3][3], area;
  PetscReal          foot[3] = {0, 0, 0}, space[9];
  PetscInt           n, found, inside;

  PetscFunctionBeginUser;
  *holds   = PETSC_FALSE;
  *result  = (FitResult){.points = fit->used};
  *problem = (FitProblem){.dim = dim, .degree = degree, .exponent = settings->exponent, .x = fit->x, .multiplier = fit->multiplier};
  for (int d = 0; d < dim; d++) foot[d] = look->x[d] - look->foot.gap * look->foot.normal[d];
  FootSpacing(fit, look->best, look->foot.xi, covariance, &area);
  FitFrameFromNormal(dim, settings->global_frame ? fit->plane : outward, problem->frame);
  for (int pass = 0; pass < 2; pass++) { /* first seen along the facet's normal, then along the points' own */
    FitMetricFromCovariance(dim, problem->frame, covariance, area, settings->support * Ladder[rung].widen, problem->metric);
    MetricInSpace(dim, problem->frame, problem->metric, space);
    PetscCall(
      NeighbourhoodGather(fit->neighbourhoods, look->best, foot, problem->frame[dim - 1], space, SEARCH_FIT_MARGIN, FIT_MAX_POINTS, fit->points, &n, &found));
    inside = 0;
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal rho2 = PointRho2(fit, fit->points[i], foot, space);

      inside += rho2 <= 1 + SEARCH_FIT_TIE;
      fit->multiplier[i] = fit->lists->point_weight[fit->points[i]];
      fit->taper[i]      = fit->multiplier[i] * PetscMax(SEARCH_FIT_TIE, 1 - rho2 / SEARCH_FIT_MARGIN);
      for (int d = 0; d < dim; d++) fit->x[i * dim + d] = fit->view.x[fit->points[i] * dim + d] - look->x[d];
    }
    problem->n = (int)n;
    if (inside < FitPointsWanted(dim, degree)) PetscFunctionReturn(PETSC_SUCCESS);
    if (settings->global_frame) break;
    if (pass == 0 && !FitFrame(dim, problem->n, fit->x, fit->taper, outward, problem->frame)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  *holds = FitEvaluate(problem, FIT_GAP, fit->workspace, result) && (result->guards & ~FIT_FEW_POINTS) == FIT_HOLDS ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the points in the inner half of the support lie from the fit: what the smoothing itself costs. */
static PetscReal FitResidual(const FitProblem *problem, const FitResult *result)
{
  const int dim  = problem->dim;
  PetscReal most = 0;

  for (int i = 0; i < problem->n; i++) {
    double y[2] = {0, 0}, z = 0, rho2 = 0;

    for (int d = 0; d < dim; d++) {
      for (int a = 0; a < dim - 1; a++) y[a] += problem->frame[a][d] * problem->x[i * dim + d];
      z += problem->frame[dim - 1][d] * problem->x[i * dim + d];
    }
    for (int a = 0; a < dim - 1; a++)
      for (int b = 0; b < dim - 1; b++) rho2 += y[a] * problem->metric[a][b] * y[b];
    if (rho2 <= 0.25) most = PetscMax(most, PetscAbsReal(z - FitSurfaceHeight(&result->surface, y, NULL)));
  }
  return most;
}

/* Climbs down the ladder for one slave point and writes what holds into its list, which starts at first. */
static PetscErrorCode FitSlave(Fitting *fit, const Nearest *look, PetscInt q, PetscInt first, ListBuffer *buffer)
{
  ContactLists lists = fit->lists;
  FitProblem   problem;
  FitResult    result;
  PetscBool    holds = PETSC_FALSE;
  int          rung  = 0;

  PetscFunctionBeginUser;
  for (; rung < RUNGS && !holds; rung++) PetscCall(FitRung(fit, look, rung, &problem, &result, &holds));
  lists->rung[q] = holds ? rung - 1 : RUNG_FACET;
  if (!holds) PetscFunctionReturn(PETSC_SUCCESS);
  lists->fit_n[q]     = problem.n;
  lists->degree[q]    = problem.degree;
  lists->pivot[q]     = result.pivot;
  lists->amplified[q] = result.amplified;
  lists->residual[q]  = FitResidual(&problem, &result);
  for (int i = 0; i < 9; i++) lists->frame[9 * q + i] = problem.frame[i / 3][i % 3];
  for (int i = 0; i < 4; i++) lists->metric[4 * q + i] = problem.metric[i / 2][i % 2];
  for (PetscInt i = 0; i < problem.n; i++) PetscCall(ListAddPoint(buffer, first, fit->points[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drops found candidates that do not face the slave point. */
static int KeepFacing(const Nearest *look, int n, int *found)
{
  int kept = 0;

  for (int i = 0; i < n; i++)
    if (CandidateFaces(look, &look->candidates[found[i]])) found[kept++] = found[i];
  return kept;
}

/* Looks for the nearest facet of every slave point, lists it with what surrounds it, and fits the surface there. */
static PetscErrorCode ListsFill(ContactSearch s, ContactLists lists, const PetscReal *normals, PetscInt n_candidates, const Candidate *candidates,
                                const FaceRecord *records, Fitting *fit, PetscReal motion)
{
  const int  dim = lists->dim;
  Tree       tree;
  double    *lower, *upper;
  int       *found, count;
  ListBuffer buffer = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n_candidates * dim, &lower, n_candidates * dim, &upper, n_candidates, &found, lists->n_points, &buffer.position));
  for (PetscInt i = 0; i < n_candidates; i++) {
    for (int d = 0; d < dim; d++) {
      lower[i * dim + d] = candidates[i].lower[d];
      upper[i * dim + d] = candidates[i].upper[d];
    }
  }
  for (PetscInt p = 0; p < lists->n_points; p++) buffer.position[p] = -1;
  PetscCheck(!TreeBuild(dim, (int)n_candidates, lower, upper, &tree), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the search tree");
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    const PetscInt first = buffer.n_points;
    Nearest        look  = {.lists = lists, .candidates = candidates, .node = lists->slave_node[q], .best = -1};
    double         bound = s->reach + motion;

    for (int d = 0; d < dim; d++) look.x[d] = lists->slave_X[q * dim + d] + lists->slave_u[q * dim + d];
    for (int d = 0; d < 3; d++) look.normal[d] = normals[3 * s->slaves[q] + d];
    lists->list_ptr[q]  = first;
    lists->facet_ptr[q] = buffer.n;
    lists->kappa[q]     = 0;
    TreeClosest(tree, look.x, &bound, NearestVisit, &look);
    if (look.best < 0) continue;
    count           = TreeNear(tree, look.x, bound + s->margin + motion, (int)n_candidates, found);
    count           = KeepFacing(&look, count, found);
    lists->kappa[q] = ListCurvature(&look, count, found);
    if (fit) PetscCall(FitSlave(fit, &look, q, first, &buffer));
    PetscCall(ListAddFacets(&look, count, found, records, first, &buffer));
  }
  lists->list_ptr[lists->n_slaves]  = buffer.n_points;
  lists->facet_ptr[lists->n_slaves] = buffer.n;
  lists->list_point                 = buffer.point;
  lists->facet                      = buffer.facet;
  lists->facet_size                 = buffer.size;
  TreeDestroy(&tree);
  PetscCall(PetscFree4(lower, upper, found, buffer.position));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far from a slave point the points of its fit may lie: the widest support with its margin, in spacings of the coarsest faces. */
static PetscReal FitReach(ContactSearch s)
{
  return s->fit->degree ? PetscSqrtReal(SEARCH_FIT_MARGIN) * Ladder[RUNG_WIDER].widen * s->fit->support * s->master->max_size : 0;
}

/* SearchLists - for every slave point of this rank the facets near it and the points these stand on, from whatever rank.

   Collective. u[mesh n_nodes*dim]: local displacements (length), ghosts included; t: load parameter, for rigid tools; motion: relative
   motion (length) the lists must be good for. Listed is what faces the slave within SEARCH_MARGIN of the nearest facet, if that is within
   SEARCH_REACH; order and content do not depend on the ranks. The caller destroys the lists with ListsDestroy(). */
PetscErrorCode SearchLists(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, ContactLists *out)
{
  Mesh            mesh     = s->mesh;
  const PetscReal distance = s->reach + PetscMax(s->margin, FitReach(s)) + 2 * motion;
  PetscMPIInt     size;
  PetscReal      *boxes, box[6], *area, *normals;
  PetscInt        n_records, n_candidates;
  NodeGeometry   *geometry = NULL;
  FaceRecord     *records;
  Candidate      *candidates;
  ContactLists    lists;
  Fitting         fit;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&lists));
  lists->dim = mesh->dim;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMalloc3(6 * size, &boxes, mesh->n_nodes, &area, 3 * mesh->n_nodes, &normals));
  if (s->fit->degree) {
    PetscCall(PetscMalloc1(s->master->rigid ? s->master->rigid->n_nodes : mesh->n_nodes, &geometry));
    PetscCall(SurfaceNodeGeometry(s->master, s->loads, u, t, geometry));
  }
  SlaveBox(s, u, box);
  if (!s->master) {
    n_records = 0;
    PetscCall(PetscMalloc1(0, &records));
  } else if (s->master->rigid)
    PetscCall(PickRigidFaces(s, geometry, t, box, distance, &n_records, &records));
  else {
    PetscCallMPI(MPI_Allgather(box, 6, MPIU_REAL, boxes, 6, MPIU_REAL, mesh->comm));
    PetscCall(ExchangeFaces(s, geometry, u, boxes, distance, &n_records, &records));
  }
  if (n_records) qsort(records, n_records, sizeof(*records), RecordCompare);
  PetscCall(ListsCreateNodes(s, n_records, records, lists));
  PetscCall(UpdateNodes(s, lists, u, t));
  PetscCall(ListsCreateSlaves(s, lists));
  for (PetscInt q = 0; q < lists->n_slaves; q++) SlaveMap(lists, q, lists->u, &lists->slave_u[q * lists->dim]);
  PetscCall(SurfaceNodeAreas(s->slave, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, u, area, normals));
  PetscCall(MakeCandidates(s, lists, n_records, records, box, distance, &n_candidates, &candidates));
  PetscCall(ListsCreatePoints(s, lists, n_candidates, candidates));
  if (s->fit->degree) PetscCall(FittingCreate(s, lists, n_records, records, n_candidates, candidates, &fit));
  if (s->fit->global_frame) PetscCall(SurfaceMeanNormal(s->master, s->loads, u, t, fit.plane, NULL));
  PetscCall(ListsFill(s, lists, normals, n_candidates, candidates, records, s->fit->degree ? &fit : NULL, motion));
  if (s->fit->degree) PetscCall(FittingDestroy(&fit));
  PetscCall(ListsUpdate(s, lists, u, t));
  PetscCall(PetscFree(geometry));
  PetscCall(PetscFree(candidates));
  PetscCall(PetscFree(records));
  PetscCall(PetscFree3(boxes, area, normals));
  *out = lists;
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

/* SearchDistance - signed distance (length) of a point to the whole master, the same on all ranks; mirror images are left out.

   Collective. u[mesh n_nodes*dim]: local displacements (length), ghosts included; x: the point's position relative to the mesh's centre. */
PetscErrorCode SearchDistance(ContactSearch s, const PetscReal *u, PetscReal t, const PetscReal x[3], PetscReal *gap)
{
  Mesh      mesh = s->mesh;
  const int dim  = mesh->dim;
  PetscInt  n    = s->master->rigid ? s->master->rigid->n_nodes : mesh->n_nodes;
  double   *relative;
  Foot      foot;
  struct {
    double distance;
    int    rank;
  } mine = {PETSC_MAX_REAL, 0}, least;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
  PetscCall(PetscMalloc1(n * dim, &relative));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal y[3] = {0, 0, 0};

    if (s->master->rigid) RigidPosition(s, i, t, y);
    for (int d = 0; d < dim; d++) relative[i * dim + d] = (s->master->rigid ? y[d] : mesh->coords[i * dim + d] + u[i * dim + d]) - x[d];
  }
  if (FacetClosest(dim, (int)s->master->n_faces, s->master->faces, relative, -1, &foot)) {
    mine.distance = PetscSqrtReal(PetscSqr(foot.gap) + PetscSqr(foot.beyond));
    *gap          = foot.gap;
  }
  PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
  PetscCallMPI(MPI_Bcast(gap, 1, MPIU_REAL, least.rank, mesh->comm));
  PetscCall(PetscFree(relative));
  PetscFunctionReturn(PETSC_SUCCESS);
}
