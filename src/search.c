#include "searchimpl.h"
#include "tree.h"

/* Reach of the search beyond the asked motion, in face sizes: the nearest facet of a slave point that is no farther than this is listed. */
#define SEARCH_REACH 2.0
/* A list holds every facet within this many face sizes (plus the motion) of the nearest one, so that a solve may slide the point there. */
#define SEARCH_MARGIN 1.5
/* Facets are listed only if they face the slave: cosine between the two outward normals below this. 0: any opposed pair. */
#define SEARCH_OPPOSED 0.0
/* Boxes of curved facets are widened by this fraction of the face size: the bulge of a quadratic face beyond its nodes is at most 1/8 of its chord. */
#define SEARCH_BULGE 0.15

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

static int RecordCompare(const void *a, const void *b)
{
  const FaceRecord *p = a, *q = b;
  return p->facet.tag < q->facet.tag ? -1 : p->facet.tag > q->facet.tag;
}

/* Centre and unit normal of a candidate from the current positions of its nodes. */
void SearchCandidatePlace(int dim, const PetscReal *x, PetscReal size, Candidate *c)
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
    SurfaceReflect(&s->images[c->image], dim, y, &x[a * dim]);
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
      SearchCandidatePlace(dim, x, records[r].size, c);
      for (int d = 0; d < 3; d++) {
        own[d]     = c->lower[d];
        own[3 + d] = c->upper[d];
      }
      if (SearchBoxesMeet(own, box, dim, distance)) (*n)++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

PetscErrorCode ListBufferAddPoint(ListBuffer *buffer, PetscInt first, PetscInt point)
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
      PetscCall(ListBufferAddPoint(buffer, first, facet.nodes[a]));
      facet.nodes[a] = (int)(buffer->position[facet.nodes[a]] - first);
    }
    buffer->size[buffer->n]    = records[c->record].size;
    buffer->facet[buffer->n++] = facet;
  }
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
    if (fit) PetscCall(FittingSlave(fit, &look, q, first, &buffer));
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

/* SearchLists - for every slave point of this rank the facets near it and the points these stand on, from whatever rank.

   Collective. u[mesh n_nodes*dim]: local displacements (length), ghosts included; t: load parameter, for rigid tools; motion: relative
   motion (length) the lists must be good for. Listed is what faces the slave within SEARCH_MARGIN of the nearest facet, if that is within
   SEARCH_REACH; order and content do not depend on the ranks. The caller destroys the lists with ListsDestroy(). */
PetscErrorCode SearchLists(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, ContactLists *out)
{
  Mesh            mesh     = s->mesh;
  const PetscReal distance = s->reach + PetscMax(s->margin, SearchFitReach(s)) + 2 * motion;
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
  SearchSlaveBox(s, u, box);
  if (!s->master) {
    n_records = 0;
    PetscCall(PetscMalloc1(0, &records));
  } else if (s->master->rigid)
    PetscCall(SearchPickRigidFaces(s, geometry, t, box, distance, &n_records, &records));
  else {
    PetscCallMPI(MPI_Allgather(box, 6, MPIU_REAL, boxes, 6, MPIU_REAL, mesh->comm));
    PetscCall(SearchExchangeFaces(s, geometry, u, boxes, distance, &n_records, &records));
  }
  if (n_records) qsort(records, n_records, sizeof(*records), RecordCompare);
  PetscCall(ListsCreateNodes(s, n_records, records, lists));
  PetscCall(ListsUpdateNodes(s, lists, u, t));
  PetscCall(ListsCreateSlaves(s, lists));
  for (PetscInt q = 0; q < lists->n_slaves; q++) ListsSlaveMap(lists, q, lists->u, &lists->slave_u[q * lists->dim]);
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

    if (s->master->rigid) SearchRigidPosition(s, i, t, y);
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
