#include "blockmatrix.h"
#include "contact.h"
#include "law.h"
#include "nodegeometry.h"
#include "penalty.h"
#include "refusal.h"
#include "search.h"
#include "smoother.h"

/* Slave nodes whose tributary area is below this share of the faces around them carry no force: corners of 6-node triangles and the axis node
   of second-order axisymmetric edges, whose areas are zero on flat faces and small, of either sign, on curved ones. Corners of 9-node faces
   have 1/36, all others more. */
#define CONTACT_SHARE_FLOOR 5e-3
/* A gap from fresh lists agrees with the solve's when it differs by less than this fraction of itself, or of the face size (round-off of a
   closest-point projection). */
#define CONTACT_GAP_AGREES    1e-6
#define CONTACT_GAP_ROUND_OFF 1e-11
/* A fit's frame may turn by 5 degrees before the step is solved again with a new one. */
#define CONTACT_FRAME_COSINE 0.9962
/* An open node whose fresh fit finds it this much of the largest penetration behind the master was open by mistake. */
#define CONTACT_FIT_AGREES 0.1
/* The area factor past a free edge is frozen in a solve; a change above this makes the step solve again. */
#define CONTACT_FACTOR_AGREES 1e-2
/* A surface that turns more than this from its one reference plane cannot be written over it: cos 60 degrees. */
#define CONTACT_GLOBAL_COSINE 0.5
/* Touching start: a gap within this fraction of the face size is no gap, whatever the curvature. */
#define CONTACT_TOUCH 1e-6
/* Nodes below this fraction of the largest nodal force do not count as loaded. */
#define CONTACT_LOADED 1e-3

typedef struct {
  const SceneContact *scene;
  FitSettings         fit;
  ContactSurface      slave, master; /* master NULL: analytic, in scene */
  int                 n_images;
  SurfaceImage        images[SURFACE_MAX_IMAGES];
  const Smoother     *smoother;
  const Law          *law;
  ContactSearch       search;
  PetscInt            n, *node; /* terms: slave nodes of this rank that carry area */
  PetscReal          *area, *size, *turn;
  PetscInt           *term_ptr;    /* slave points of each term */
  PetscReal          *term_weight; /* their weights, sum 1 */
  ContactState        now, accepted;
  ContactLists        lists;
  PetscReal          *factor;                  /* per slave point, frozen with the lists: fades out past a free edge */
  int                *seed;                    /* per slave point: the facet of last time */
  PetscReal          *force, *vector, *normal; /* of the last residual: normal force, its sum over the slave points (n*3), contact normal (n*3) */
  PetscReal           t;                       /* of the last residual */
  PetscReal          *pressure, *trial;        /* trial: gaps of the last projection, of a residual or a tangent */
} Pair;

typedef struct {
  SmootherResult result;
  PetscReal     *x; /* positions relative to the slave point */
  PetscReal     *multiplier, *workspace;
  PetscInt       x_room;
  PetscInt      *node;  /* contact nodes of a term, one after another over its slave points */
  PetscReal     *N, *M; /* over these nodes; M holds one slave point's part at a time */
  int           *from;  /* which row of the variations a contact node takes part in: 0 the slave point, 1 + i fit point i */
  PetscReal     *scale; /* and with what factor, by component */
} Work;

struct _n_Contact {
  Mesh          mesh;
  Scene         scene;
  Loads         loads;
  int           n_pairs;
  Pair         *pairs;
  Work          work;
  BlockMatrix   blocks; /* the last tangent */
  PetscLogEvent event_search, event_project, event_residual, event_tangent;
};

/* ---------- set-up ---------- */

static PetscErrorCode StateCreate(PetscInt n, PetscReal penalty, ContactState *state)
{
  PetscFunctionBeginUser;
  state->n = n;
  PetscCall(PetscCalloc5(n, &state->penalty, n, &state->status, n, &state->gap, n, &state->offset, n, &state->multiplier));
  for (PetscInt c = 0; c < n; c++) {
    state->penalty[c] = penalty;
    state->gap[c]     = NAN;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StateCopy(const ContactState *from, ContactState *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->penalty, from->penalty, from->n));
  PetscCall(PetscArraycpy(to->status, from->status, from->n));
  PetscCall(PetscArraycpy(to->gap, from->gap, from->n));
  PetscCall(PetscArraycpy(to->offset, from->offset, from->n));
  PetscCall(PetscArraycpy(to->multiplier, from->multiplier, from->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StateDestroy(ContactState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(state->penalty, state->status, state->gap, state->offset, state->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The terms: owned slave nodes with area. */
static PetscErrorCode PairCreateTerms(Mesh mesh, Scene scene, Pair *pair)
{
  const MeshGroup *group = pair->slave->group;
  PetscReal       *area, *size, *turn, *share;
  PetscMPIInt      rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc4(mesh->n_nodes, &area, mesh->n_nodes, &size, mesh->n_nodes, &turn, mesh->n_nodes, &share));
  PetscCall(SurfaceNodeAreas(pair->slave, scene->geometry, NULL, area, NULL));
  PetscCall(SurfaceNodeSizes(pair->slave, scene->geometry, size, turn, share));
  PetscCall(PetscMalloc4(group->n_nodes, &pair->node, group->n_nodes, &pair->area, group->n_nodes, &pair->size, group->n_nodes, &pair->turn));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    const PetscInt node = group->nodes[i];

    if (mesh->node_owner[node] != rank || share[node] < CONTACT_SHARE_FLOOR) continue;
    pair->node[pair->n] = node;
    pair->area[pair->n] = area[node];
    pair->size[pair->n] = size[node];
    pair->turn[pair->n] = turn[node];
    pair->n++;
  }
  PetscCall(PetscMalloc2(pair->n + 1, &pair->term_ptr, pair->n, &pair->term_weight));
  for (PetscInt c = 0; c < pair->n; c++) {
    pair->term_ptr[c]    = c;
    pair->term_weight[c] = 1;
  }
  pair->term_ptr[pair->n] = pair->n;
  PetscCall(PetscCalloc5(pair->n, &pair->force, 3 * pair->n, &pair->vector, 3 * pair->n, &pair->normal, pair->n, &pair->pressure, pair->n, &pair->trial));
  PetscCall(PetscFree4(area, size, turn, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Support in spacings and exponent of the weight where the scene leaves them open, by dimension and degree: the smoothest fits whose guards
   hold on jittered meshes (3D: some 38 nodes; 2D: 9). */
static FitSettings PairFitSettings(Scene scene, const SceneContact *contact, const Smoother *smoother)
{
  FitSettings fit = {.degree = smoother->smooth ? contact->degree : 0, .support = contact->support, .exponent = contact->weight};

  if (fit.support == 0) fit.support = scene->dim == 2 && fit.degree == 4 ? 4.5 : 3.5;
  if (fit.exponent == 0) fit.exponent = scene->dim == 3 && fit.degree == 4 ? 3 : 6;
  fit.derivatives   = contact->diffuse_derivatives ? FIT_DIFFUSE : FIT_FULL;
  fit.global_frame  = contact->global_frame ? PETSC_TRUE : PETSC_FALSE;
  fit.feature_angle = contact->feature_angle * PETSC_PI / 180;
  return fit;
}

static PetscErrorCode PairCheckGlobalFrame(Mesh mesh, Scene scene, Loads loads, const Pair *pair)
{
  PetscReal normal[3], cosine, *zero;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &zero));
  PetscCall(SurfaceMeanNormal(pair->master, loads, zero, 0, normal, &cosine));
  PetscCall(PetscFree(zero));
  if (cosine < CONTACT_GLOBAL_COSINE) {
    PetscCall(RefuseInput(
      mesh->comm,
      "%s: the surface '%s' turns by %.0f degrees from its one reference plane; allowed: up to 60 degrees (frame: local has one plane for each slave point)",
      SceneWhere(scene, pair->scene->path, "frame"), pair->scene->master, (double)(PetscAcosReal(PetscMax(-1, cosine)) * 180 / PETSC_PI)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, const SceneContact *contact, Pair *pair)
{
  PetscReal penalty;

  PetscFunctionBeginUser;
  pair->scene    = contact;
  pair->smoother = SmootherFind(contact->smoother == SMOOTHER_DIFFUSE ? "diffuse" : "facet");
  pair->fit      = PairFitSettings(scene, contact, pair->smoother);
  pair->law      = LawFind("penalty");
  if (contact->master && !strcmp(contact->slave, contact->master))
    PetscCall(RefuseInput(mesh->comm,
                          "%s: slave and master are both '%s'; allowed: two different surfaces (a surface in contact with itself is not available yet)",
                          SceneWhere(scene, contact->path, "master"), contact->master));
  if (MeshFindRigid(mesh, contact->slave))
    PetscCall(RefuseInput(mesh->comm, "%s: the slave '%s' is a rigid tool; allowed: a surface of a deformable body (make the tool the master)",
                          SceneWhere(scene, contact->path, "slave"), contact->slave));
  PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, "slave", contact->slave, &pair->slave));
  if (contact->master)
    PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, "master", contact->master, &pair->master));
  else
    pair->fit.degree = 0;
  PetscCall(SurfaceImages(mesh, scene, contact, &pair->n_images, pair->images));
  if (pair->master) PetscCall(SurfaceFindFreeEdges(pair->master, pair->n_images, pair->images));
  if (pair->master && pair->fit.degree && pair->fit.global_frame) PetscCall(PairCheckGlobalFrame(mesh, scene, loads, pair));
  PetscCall(PairCreateTerms(mesh, scene, pair));
  penalty =
    contact->penalty_scale * (contact->penalty_auto ? PenaltyAutomatic(pair->slave->stiffness, pair->master ? pair->master->stiffness : 0) : contact->penalty);
  PetscCall(StateCreate(pair->n, penalty, &pair->now));
  PetscCall(StateCreate(pair->n, penalty, &pair->accepted));
  PetscCall(SearchCreate(mesh, scene, loads, pair->slave, pair->master, pair->n_images, pair->images, &pair->fit, pair->n, pair->node, &pair->search));
  PetscCall(PetscCalloc2(pair->n, &pair->factor, pair->n, &pair->seed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two pairs of the same surfaces would press twice. */
static PetscErrorCode RefuseRepeatedPairs(Mesh mesh, Scene scene)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < scene->n_contacts; p++) {
    for (int q = 0; q < p; q++) {
      const SceneContact *a = &scene->contacts[p], *b = &scene->contacts[q];
      const PetscBool meshed = (PetscBool)(a->master && b->master), same = (PetscBool)(meshed && !strcmp(a->slave, b->slave) && !strcmp(a->master, b->master));
      const PetscBool swapped = (PetscBool)(meshed && !strcmp(a->slave, b->master) && !strcmp(a->master, b->slave));

      if (same || swapped)
        PetscCall(RefuseInput(mesh->comm, "%s: contact '%s' is '%s' once more%s: their forces would add up; allowed: one pair for each two surfaces",
                              SceneWhere(scene, a->path, "slave"), a->name, b->name, swapped ? ", slave and master swapped" : ""));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactCreate - all pairs of the scene, without lists yet.

   Collective. Refuses what the mesh shows to be wrong: missing or empty surfaces, a rigid slave, planes of symmetry that are none. */
PetscErrorCode ContactCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, Contact *out)
{
  Contact contact;
  int     capacity = 0, points = 1; /* most fit points of a smoother, most slave points of a term */

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&contact));
  contact->mesh    = mesh;
  contact->scene   = scene;
  contact->loads   = loads;
  contact->n_pairs = scene->n_contacts;
  PetscCall(PetscLogEventRegister("ContactSearch", SNES_CLASSID, &contact->event_search));
  PetscCall(PetscLogEventRegister("ContactProject", SNES_CLASSID, &contact->event_project));
  PetscCall(PetscLogEventRegister("ContactResidual", SNES_CLASSID, &contact->event_residual));
  PetscCall(PetscLogEventRegister("ContactTangent", SNES_CLASSID, &contact->event_tangent));
  PetscCall(BlockMatrixCreate(mesh->comm, &contact->blocks));
  PetscCall(RefuseRepeatedPairs(mesh, scene));
  PetscCall(PetscCalloc1(contact->n_pairs, &contact->pairs));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(PairCreate(mesh, scene, elasticity, loads, &scene->contacts[p], &contact->pairs[p]));
    capacity = PetscMax(capacity, contact->pairs[p].smoother->capacity);
  }
  PetscCall(PetscMalloc1(FitWorkspace(mesh->dim, 4, FIT_MAX_POINTS), &contact->work.workspace));
  PetscCall(PetscMalloc4(capacity, &contact->work.result.points, 3 * (capacity + 1), &contact->work.result.N, capacity + 1, &contact->work.from,
                         3 * (capacity + 1), &contact->work.scale));
  PetscCall(PetscMalloc4(PetscSqr(3 * (capacity + 1)), &contact->work.result.M, points * (capacity + 1), &contact->work.node, 3 * points * (capacity + 1),
                         &contact->work.N, PetscSqr(3 * (capacity + 1)), &contact->work.M));
  *out = contact;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairDestroy(Pair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(ListsDestroy(&pair->lists));
  PetscCall(SearchDestroy(&pair->search));
  PetscCall(SurfaceDestroy(&pair->slave));
  if (pair->master) PetscCall(SurfaceDestroy(&pair->master));
  PetscCall(StateDestroy(&pair->now));
  PetscCall(StateDestroy(&pair->accepted));
  PetscCall(PetscFree4(pair->node, pair->area, pair->size, pair->turn));
  PetscCall(PetscFree2(pair->term_ptr, pair->term_weight));
  PetscCall(PetscFree5(pair->force, pair->vector, pair->normal, pair->pressure, pair->trial));
  PetscCall(PetscFree2(pair->factor, pair->seed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactDestroy - Collective. */
PetscErrorCode ContactDestroy(Contact *contact)
{
  Contact c = *contact;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < c->n_pairs; p++) PetscCall(PairDestroy(&c->pairs[p]));
  PetscCall(PetscFree(c->pairs));
  PetscCall(PetscFree4(c->work.result.points, c->work.result.N, c->work.from, c->work.scale));
  PetscCall(PetscFree4(c->work.result.M, c->work.node, c->work.N, c->work.M));
  PetscCall(PetscFree2(c->work.x, c->work.multiplier));
  PetscCall(PetscFree(c->work.workspace));
  PetscCall(BlockMatrixDestroy(&c->blocks));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- one slave point ---------- */

/* The same against an analytic master, which has no points. */
static PetscBool PointEvaluateAnalytic(Contact contact, const Pair *pair, ContactLists lists, PetscInt q)
{
  const int        dim    = lists->dim;
  const PetscReal *centre = contact->mesh->centre;
  SmootherResult  *result = &contact->work.result;
  AnalyticMaster   master = pair->scene->analytic;
  AnalyticResult   found;
  PetscReal        point[3], x[3];

  MotionPlace(&pair->scene->motion, lists->t, pair->scene->motion.point, point);
  MotionTurn(&pair->scene->motion, lists->t, pair->scene->analytic.axis, master.axis);
  for (int d = 0; d < dim; d++) x[d] = (lists->slave_X[q * dim + d] - (point[d] - centre[d])) + lists->slave_u[q * dim + d];
  if (!AnalyticEvaluate(&master, dim, x, &found)) return PETSC_FALSE;
  result->gap          = found.gap;
  result->beyond       = 0;
  result->seed         = -1;
  result->facet_served = 0;
  result->n            = 0;
  for (int d = 0; d < 3; d++) result->normal[d] = found.normal[d];
  for (int d = 0; d < dim; d++) result->N[d] = found.N[d];
  for (int d = 0; d < dim * dim; d++) result->M[d] = found.M[d];
  return PETSC_TRUE;
}

/* Gap (and variations over the fit points) of slave point q of the lists; *found is PETSC_FALSE where no master is near. */
static PetscErrorCode PointEvaluate(Contact contact, const Pair *pair, const Smoother *smoother, ContactLists lists, PetscInt q, int seed, SmootherWant want,
                                    PetscBool *found)
{
  const int      dim   = lists->dim;
  Work          *work  = &contact->work;
  const PetscInt first = lists->list_ptr[q], n = lists->list_ptr[q + 1] - first;
  SmootherInput  in;

  PetscFunctionBeginUser;
  if (!pair->master) {
    *found = PointEvaluateAnalytic(contact, pair, lists, q);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (n > work->x_room) {
    work->x_room = 2 * n;
    PetscCall(PetscFree2(work->x, work->multiplier));
    PetscCall(PetscMalloc2(work->x_room * dim, &work->x, work->x_room, &work->multiplier));
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt p = lists->list_point[first + i];

    work->multiplier[i] = lists->point_weight[p];
    for (int d = 0; d < dim; d++)
      work->x[i * dim + d] = (lists->point_X[p * dim + d] - lists->slave_X[q * dim + d]) + (lists->point_u[p * dim + d] - lists->slave_u[q * dim + d]);
  }
  in     = (SmootherInput){.dim         = dim,
                           .n_points    = (int)n,
                           .n_facets    = (int)(lists->facet_ptr[q + 1] - lists->facet_ptr[q]),
                           .x           = work->x,
                           .facets      = &lists->facet[lists->facet_ptr[q]],
                           .seed        = seed,
                           .n_fit       = (int)lists->fit_n[q],
                           .degree      = lists->degree[q],
                           .exponent    = pair->fit.exponent,
                           .multiplier  = work->multiplier,
                           .frame       = &lists->frame[9 * q],
                           .metric      = &lists->metric[4 * q],
                           .derivatives = pair->fit.derivatives,
                           .workspace   = work->workspace};
  *found = in.n_facets && smoother->evaluate(&in, want, &work->result) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Carries the variations of the last evaluation from fit points to contact nodes: N and M over nodes[*n] of the lists, in work. */
static void PointToNodes(Contact contact, const Pair *pair, ContactLists lists, PetscInt q, PetscReal weight, PetscBool second, PetscInt *node, PetscReal *N,
                         int *count)
{
  Work                 *work = &contact->work;
  const SmootherResult *r    = &work->result;
  const int             dim = lists->dim, m = (1 + r->n) * dim;
  int                   n = 0, *from = work->from;
  PetscReal            *scale = work->scale;

  for (PetscInt k = lists->slave_ptr[q]; k < lists->slave_ptr[q + 1]; k++, n++) {
    node[n] = lists->slave_node[k];
    from[n] = 0;
    for (int d = 0; d < dim; d++) scale[3 * n + d] = lists->slave_S[k];
  }
  for (int i = 0; i < r->n; i++) {
    const PetscInt      p     = lists->list_point[lists->list_ptr[q] + r->points[i]];
    const SurfaceImage *image = &pair->images[lists->point_image[p]];

    for (PetscInt k = lists->point_ptr[p]; k < lists->point_ptr[p + 1]; k++, n++) {
      node[n] = lists->point_node[k];
      from[n] = 1 + i;
      for (int d = 0; d < dim; d++) scale[3 * n + d] = image->sign[d] * lists->point_S[k];
    }
  }
  for (int a = 0; a < n; a++)
    for (int d = 0; d < dim; d++) N[a * dim + d] = weight * scale[3 * a + d] * r->N[from[a] * dim + d];
  for (int a = 0; second && a < n; a++) {
    for (int d = 0; d < dim; d++) {
      for (int b = 0; b < n; b++)
        for (int e = 0; e < dim; e++)
          work->M[(a * dim + d) * n * dim + b * dim + e] = scale[3 * a + d] * scale[3 * b + e] * r->M[(from[a] * dim + d) * m + from[b] * dim + e];
    }
  }
  *count = n;
}

/* ---------- lists ---------- */

static PetscReal SmoothStep(PetscReal x)
{
  x = PetscMax(0, PetscMin(1, x));
  return x * x * (3 - 2 * x);
}

/* Area factors of the slave points for these lists: 1 inside, fading to 0 one face size past a free edge. */
static PetscErrorCode PairFactors(Contact contact, const Pair *pair, ContactLists lists, PetscReal *factor)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscBool found;

    factor[q] = 0;
    PetscCall(PointEvaluate(contact, pair, SmootherFind("facet"), lists, q, -1, SMOOTHER_GAP, &found));
    if (found && !pair->master)
      factor[q] = 1;
    else if (found)
      factor[q] = 1 - SmoothStep(contact->work.result.beyond / lists->facet_size[lists->facet_ptr[q] + contact->work.result.seed]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairTakeLists(Pair *pair, ContactLists lists, const PetscReal *factor)
{
  PetscFunctionBeginUser;
  PetscCall(ListsDestroy(&pair->lists));
  pair->lists = lists;
  PetscCall(PetscArraycpy(pair->factor, factor, lists->n_slaves));
  for (PetscInt q = 0; q < lists->n_slaves; q++) pair->seed[q] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGather - new lists, and with them new area factors, for all pairs; the blocks of the last tangent are dropped.

   Collective. u[n_nodes*dim]: local displacements (length), ghosts included; t: load parameter, for rigid tools; motion: relative motion
   (length) that the lists must be good for. The contact state is not touched. */
PetscErrorCode ContactGather(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(BlockMatrixReset(contact->blocks)); /* its blocks speak of the old lists */
  for (int p = 0; p < contact->n_pairs; p++) {
    Pair        *pair = &contact->pairs[p];
    ContactLists lists;
    PetscReal   *factor;

    PetscCall(SearchLists(pair->search, u, t, motion, &lists));
    PetscCall(PetscMalloc1(lists->n_slaves, &factor));
    PetscCall(PairFactors(contact, pair, lists, factor));
    PetscCall(PairTakeLists(pair, lists, factor));
    PetscCall(PetscFree(factor));
  }
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weighted gap of a term: NaN where none of its points has a master near or all lie past its edge. */
static PetscErrorCode TermGap(Contact contact, const Pair *pair, ContactLists lists, const PetscReal *factor, int *seed, PetscInt c, PetscReal *gap)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  *gap = 0;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    PetscBool found;

    if (factor[q] == 0) continue;
    PetscCall(PointEvaluate(contact, pair, pair->smoother, lists, q, seed ? seed[q] : -1, SMOOTHER_GAP, &found));
    if (!found) continue;
    any = PETSC_TRUE;
    *gap += pair->term_weight[q] * contact->work.result.gap;
    if (seed) seed[q] = contact->work.result.seed;
  }
  if (!any) *gap = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left at t of the gap that the surfaces had before any load: all of an ignored overlap, a shrinking part of a ramped one. */
static PetscReal TermOffset(const Pair *pair, PetscInt c, PetscReal t)
{
  return pair->now.offset[c] * (pair->scene->initial_overlap == OVERLAP_RAMP ? 1 - t : 1);
}

/* A fit point's rank-independent key: node, tool or body, mirror image. */
static PetscInt PointKey(ContactLists lists, PetscInt p)
{
  const PetscInt node = lists->point_node[p];

  return (2 * lists->node_id[node] + (node >= lists->n_deformable)) * SURFACE_MAX_IMAGES + lists->point_image[p];
}

/* Is every point that now lies inside the support of the old fit of slave point q in its list, and has the frame stayed? */
static PetscBool FitHolds(ContactLists old, ContactLists fresh, PetscInt q)
{
  const int        dim   = old->dim;
  const PetscReal *frame = &old->frame[9 * q], *turned = &fresh->frame[9 * q], *metric = &old->metric[4 * q];
  PetscReal        cosine = 0;

  for (int d = 0; d < dim; d++) cosine += frame[3 * (dim - 1) + d] * turned[3 * (dim - 1) + d];
  if (cosine < CONTACT_FRAME_COSINE || old->degree[q] != fresh->degree[q]) return PETSC_FALSE;
  for (PetscInt i = fresh->list_ptr[q]; i < fresh->list_ptr[q] + fresh->fit_n[q]; i++) {
    const PetscInt p = fresh->list_point[i], key = PointKey(fresh, p);
    PetscReal      y[2] = {0, 0}, rho2 = 0;
    PetscBool      known = PETSC_FALSE;

    for (int a = 0; a < dim - 1; a++)
      for (int d = 0; d < dim; d++)
        y[a] += frame[3 * a + d] * ((fresh->point_X[p * dim + d] - fresh->slave_X[q * dim + d]) + (fresh->point_u[p * dim + d] - fresh->slave_u[q * dim + d]));
    for (int a = 0; a < dim - 1; a++)
      for (int b = 0; b < dim - 1; b++) rho2 += y[a] * metric[2 * a + b] * y[b];
    if (rho2 >= 1) continue;
    for (PetscInt k = old->list_ptr[q]; !known && k < old->list_ptr[q] + old->fit_n[q]; k++)
      known = PointKey(old, old->list_point[k]) == key ? PETSC_TRUE : PETSC_FALSE;
    if (!known) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Do fresh lists say the same of this term as the solve did? Open is open. On facets a closed gap must agree; on a fit, whose gap changes a
   little with its frame, frame and points must. The area factor must agree on both. depth: the largest penetration of the pair. */
static PetscBool TermAgrees(const Pair *pair, ContactLists fresh, PetscInt c, PetscReal gap, const PetscReal *factor, PetscReal t, PetscReal depth)
{
  const PetscReal offset = TermOffset(pair, c, t), old = pair->now.gap[c];

  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscBool fitted    = (PetscBool)(pair->lists->fit_n[q] && fresh->fit_n[q]);
    const PetscReal tolerance = fitted ? CONTACT_FIT_AGREES * depth : CONTACT_GAP_AGREES * PetscAbsReal(old) + CONTACT_GAP_ROUND_OFF * pair->size[c];

    if (!(old - offset < 0) && !(gap - offset < (fitted ? -tolerance : 0))) continue;
    if (PetscAbsReal(factor[q] - pair->factor[q]) > CONTACT_FACTOR_AGREES) return PETSC_FALSE;
    if (fitted && old - offset < 0) {
      if (PetscIsNanReal(gap) || !FitHolds(pair->lists, fresh, q)) return PETSC_FALSE;
    } else if (!(PetscAbsReal(gap - old) <= tolerance))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Largest penetration of the pair, all ranks, at the last residual. */
static PetscErrorCode PairDepth(Contact contact, const Pair *pair, PetscReal t, PetscReal *depth)
{
  PetscFunctionBeginUser;
  *depth = 0;
  for (PetscInt c = 0; c < pair->n; c++)
    if (!PetscIsNanReal(pair->now.gap[c])) *depth = PetscMax(*depth, TermOffset(pair, c, t) - pair->now.gap[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, depth, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactListsHold - whether lists made afresh at the solution say the same of every term as those it was found with.

   Collective. u, t: of the last ContactResidual() with forces; motion: as of ContactGather(). *hold: the same on all ranks; if it is
   PETSC_FALSE the fresh lists of all pairs have replaced the old, and the problem is to be solved again. */
PetscErrorCode ContactListsHold(Contact contact, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *hold)
{
  ContactLists *lists;
  PetscReal   **factor;
  int           agree = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_search, 0, 0, 0, 0));
  PetscCall(PetscMalloc2(contact->n_pairs, &lists, contact->n_pairs, &factor));
  for (int p = 0; p < contact->n_pairs; p++) {
    Pair     *pair = &contact->pairs[p];
    PetscReal depth;

    PetscCall(PairDepth(contact, pair, t, &depth));
    PetscCall(SearchLists(pair->search, u, t, motion, &lists[p]));
    PetscCall(PetscMalloc1(lists[p]->n_slaves, &factor[p]));
    PetscCall(PairFactors(contact, pair, lists[p], factor[p]));
    for (PetscInt c = 0; c < pair->n; c++) {
      PetscReal gap;

      PetscCall(TermGap(contact, pair, lists[p], factor[p], NULL, c, &gap));
      agree = agree && TermAgrees(pair, lists[p], c, gap, factor[p], t, depth);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &agree, 1, MPI_INT, MPI_LAND, contact->mesh->comm));
  *hold = agree ? PETSC_TRUE : PETSC_FALSE;
  for (int p = 0; p < contact->n_pairs; p++) {
    if (agree)
      PetscCall(ListsDestroy(&lists[p]));
    else
      PetscCall(PairTakeLists(&contact->pairs[p], lists[p], factor[p]));
    PetscCall(PetscFree(factor[p]));
  }
  if (!agree) PetscCall(BlockMatrixReset(contact->blocks));
  PetscCall(PetscFree2(lists, factor));
  PetscCall(PetscLogEventEnd(contact->event_search, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- residual ---------- */

/* Moves the lists' points to (u, t) and projects every slave point: gaps into pair->trial, normals into pair->normal. */
static PetscErrorCode PairProject(Contact contact, Pair *pair, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_project, 0, 0, 0, 0));
  PetscCall(ListsUpdate(pair->search, pair->lists, u, t));
  for (PetscInt c = 0; c < pair->n; c++) {
    PetscCall(TermGap(contact, pair, pair->lists, pair->factor, pair->seed, c, &pair->trial[c]));
    for (int d = 0; d < 3; d++) pair->normal[3 * c + d] = PetscIsNanReal(pair->trial[c]) || d >= contact->mesh->dim ? 0 : contact->work.result.normal[d];
  }
  PetscCall(PetscLogEventEnd(contact->event_project, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void TermLaw(const Pair *pair, PetscInt c, PetscReal gap, PetscReal t, LawValue *value)
{
  const LawState state = {pair->now.penalty[c], TermOffset(pair, c, t), pair->now.multiplier[c]};

  *value = (LawValue){0, 0, 0};
  if (!PetscIsNanReal(gap)) pair->law->evaluate(gap, &state, value);
}

/* Adds the forces of a loaded term to the contact nodes' values and keeps what probes show of it. */
static PetscErrorCode TermForces(Contact contact, Pair *pair, PetscInt c, PetscReal pressure, PetscReal *values, PetscReal *force2)
{
  const int dim  = contact->mesh->dim;
  Work     *work = &contact->work;
  PetscBool found;
  int       n;

  PetscFunctionBeginUser;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscReal force = pressure * pair->area[c] * pair->term_weight[q] * pair->factor[q];

    if (pair->factor[q] == 0) continue;
    PetscCall(PointEvaluate(contact, pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_FIRST_VARIATION, &found));
    if (!found) continue;
    PointToNodes(contact, pair, pair->lists, q, 1, PETSC_FALSE, work->node, work->N, &n);
    for (int i = 0; i < n * dim; i++) {
      values[work->node[i / dim] * dim + i % dim] -= force * work->N[i];
      *force2 += PetscSqr(force * work->N[i]);
    }
    pair->force[c] += force;
    for (int d = 0; d < dim; d++) pair->vector[3 * c + d] += force * work->result.N[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairResidual(Contact contact, Pair *pair, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy, PetscReal *force2)
{
  PetscReal *values, sum = 0;
  LawValue   value;

  PetscFunctionBeginUser;
  PetscCall(PairProject(contact, pair, u, t));
  PetscCall(PetscCalloc1(pair->lists->n_nodes * contact->mesh->dim, &values));
  for (PetscInt c = 0; c < pair->n; c++) {
    TermLaw(pair, c, pair->trial[c], t, &value);
    for (PetscInt q = pair->term_ptr[c]; energy && q < pair->term_ptr[c + 1]; q++)
      *energy += pair->area[c] * pair->term_weight[q] * pair->factor[q] * value.psi;
    if (!f) continue;
    pair->now.gap[c]    = pair->trial[c];
    pair->now.status[c] = value.stiffness > 0 ? CONTACT_CLOSED : CONTACT_OPEN;
    pair->force[c]      = 0;
    PetscCall(PetscArrayzero(&pair->vector[3 * c], 3));
    if (value.pressure != 0) PetscCall(TermForces(contact, pair, c, value.pressure, values, &sum));
  }
  if (f) {
    pair->t = t;
    PetscCall(ListsReduce(pair->lists, values, f));
  }
  if (force2) *force2 += sum;
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactResidual - contact forces, energy and their unassembled norm at (u, t).

   Collective, with the same arguments NULL on all ranks. u[n_nodes*dim]: local displacements (length). f[n_nodes*dim]: contact forces are
   subtracted as external ones are, complete at owned nodes; with f gaps, status and nodal forces become the present state. energy, force2
   (sum of the squared forces of the terms): this rank's, added to. Each of the three may be NULL.

   Source: Chamoret et al. 2004, eq. 12 and 15. */
PetscErrorCode ContactResidual(Contact contact, const PetscReal *u, PetscReal t, PetscReal *f, PetscReal *energy, PetscReal *force2)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_residual, 0, 0, 0, 0));
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(PairResidual(contact, &contact->pairs[p], u, t, f, energy, force2));
  PetscCall(PetscLogEventEnd(contact->event_residual, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- tangent ---------- */

/* Opening up to which a node counts as touching: what round-off and the facets' own sagitta leave between surfaces that touch. */
static PetscReal TouchTolerance(const Pair *pair, PetscInt c)
{
  const PetscReal h = pair->size[c], master = pair->master ? pair->master->mean_size : 0, radius = pair->scene->analytic.radius;
  const PetscReal kappa = pair->lists->kappa[c] + 2 * pair->turn[c] / h + (radius > 0 ? 1 / radius : 0);

  return CONTACT_TOUCH * h + kappa * (PetscSqr(h) + PetscSqr(master)) / 8;
}

/* How many contact nodes slave point q touches once evaluated. */
static int PointNodes(ContactLists lists, PetscInt q, const SmootherResult *r)
{
  PetscInt n = lists->slave_ptr[q + 1] - lists->slave_ptr[q];

  for (int i = 0; i < r->n; i++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + r->points[i]];
    n += lists->point_ptr[p + 1] - lists->point_ptr[p];
  }
  return (int)n;
}

/* The block of one active term: A (psi'' Nbar Nbar^T - p sum_q w_q M_q), over its points' nodes one after another (a node may occur twice). */
static PetscErrorCode TermBlock(Contact contact, const Pair *pair, int p, PetscInt c, PetscReal pressure, PetscReal stiffness)
{
  const int dim  = contact->mesh->dim;
  Work     *work = &contact->work;
  PetscReal area = 0, *value;
  PetscInt  m = 0, first = 0, *entry;
  PetscBool found;

  PetscFunctionBeginUser;
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    if (pair->factor[q] == 0) continue;
    PetscCall(PointEvaluate(contact, pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_GAP, &found));
    if (found) m += PointNodes(pair->lists, q, &work->result) * dim;
  }
  PetscCall(BlockMatrixAdd(contact->blocks, p, m, &entry, &value));
  for (PetscInt q = pair->term_ptr[c]; q < pair->term_ptr[c + 1]; q++) {
    const PetscReal weight = pair->area[c] * pair->term_weight[q] * pair->factor[q];
    int             n;

    if (pair->factor[q] == 0) continue;
    PetscCall(PointEvaluate(contact, pair, pair->smoother, pair->lists, q, pair->seed[q], SMOOTHER_SECOND_VARIATION, &found));
    if (!found) continue;
    PointToNodes(contact, pair, pair->lists, q, pair->term_weight[q], PETSC_TRUE, work->node, &work->N[first], &n);
    for (PetscInt i = 0; i < n * dim; i++) {
      entry[first + i] = work->node[i / dim] * dim + i % dim;
      for (PetscInt j = 0; j < n * dim; j++) value[(first + i) * m + first + j] = -pressure * weight * work->M[i * n * dim + j];
    }
    area += weight;
    first += n * dim;
  }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) value[i * m + j] += area * stiffness * work->N[i] * work->N[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairBlocks(Contact contact, Pair *pair, int p, const PetscReal *u, PetscReal t, PetscBool touching)
{
  PetscFunctionBeginUser;
  PetscCall(PairProject(contact, pair, u, t));
  for (PetscInt c = 0; c < pair->n; c++) {
    const PetscReal gap = pair->trial[c];
    LawValue        value;

    TermLaw(pair, c, gap, t, &value);
    if (touching && gap - TermOffset(pair, c, t) >= 0 && gap - TermOffset(pair, c, t) <= TouchTolerance(pair, c)) value.stiffness = pair->now.penalty[c];
    if (value.stiffness > 0) PetscCall(TermBlock(contact, pair, p, c, value.pressure, value.stiffness));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTangent - the derivative of ContactResidual()'s forces by the free displacements: A (psi'' N N^T - p M) for each closed term, p its pressure.

   Collective. u, t: as of ContactResidual(); touching: open nodes within TouchTolerance() take part with their stiffness too. *C: over the
   global free dofs, the contact's own; *changed: its pattern is new. Source: Chamoret et al. 2004, eq. 14. */
PetscErrorCode ContactTangent(Contact contact, const PetscReal *u, PetscReal t, PetscBool touching, Mat *C, PetscBool *changed)
{
  const PetscInt **dof;
  PetscSection     section;
  PetscInt         size;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(contact->event_tangent, 0, 0, 0, 0));
  PetscCall(BlockMatrixReset(contact->blocks));
  PetscCall(PetscMalloc1(contact->n_pairs, &dof));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(PairBlocks(contact, &contact->pairs[p], p, u, t, touching));
    dof[p] = contact->pairs[p].lists->dof;
  }
  PetscCall(DMGetGlobalSection(contact->mesh->dm, &section));
  PetscCall(PetscSectionGetConstrainedStorageSize(section, &size));
  PetscCall(BlockMatrixAssemble(contact->blocks, size, dof, C, changed));
  PetscCall(PetscFree(dof));
  PetscCall(PetscLogEventEnd(contact->event_tangent, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An analytic master that moves by d is to the slave nodes as if they had moved by -d. */
static void AnalyticTravel(Contact contact, const Pair *pair, PetscReal t, PetscReal t_next, PetscReal *values)
{
  const int dim = contact->mesh->dim;
  PetscReal from[3], to[3];

  MotionPlace(&pair->scene->motion, t, pair->scene->motion.point, from);
  MotionPlace(&pair->scene->motion, t_next, pair->scene->motion.point, to);
  for (PetscInt i = 0; i < pair->lists->n_nodes * dim; i++) values[i] -= to[i % dim] - from[i % dim];
}

/* ContactMultiply - y += C x with the blocks of the last ContactTangent(), prescribed dofs included.

   Collective. x[n_nodes*dim]: local displacements (length), ghosts included, to which the rigid tools' motion from t to t_next is joined;
   y[n_nodes*dim]: local forces, complete at owned nodes. */
PetscErrorCode ContactMultiply(Contact contact, const PetscReal *x, PetscReal t, PetscReal t_next, PetscReal *y)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    Pair          *pair = &contact->pairs[p];
    const PetscInt n    = pair->lists->n_nodes * contact->mesh->dim;
    PetscReal     *in, *out;

    PetscCall(PetscMalloc2(n, &in, n, &out));
    PetscCall(PetscArrayzero(out, n));
    PetscCall(ListsBroadcast(pair->search, pair->lists, x, t, t_next, in));
    if (!pair->master) AnalyticTravel(contact, pair, t, t_next, in);
    PetscCall(BlockMatrixMultiply(contact->blocks, p, in, out));
    PetscCall(ListsReduce(pair->lists, out, y));
    PetscCall(PetscFree2(in, out));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- state ---------- */

/* ContactAccept - the present state becomes the one that ContactRestore() returns to. Not collective. */
PetscErrorCode ContactAccept(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(StateCopy(&contact->pairs[p].now, &contact->pairs[p].accepted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactRestore - takes the state back to the last ContactAccept(); the lists are not part of it: ContactGather(). Not collective. */
PetscErrorCode ContactRestore(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) PetscCall(StateCopy(&contact->pairs[p].accepted, &contact->pairs[p].now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a pair in which no master face looks towards any slave node: a surface turned inside out, or the wrong one. */
static PetscErrorCode PairCheckFacing(Contact contact, const Pair *pair)
{
  Mesh       mesh = contact->mesh;
  PetscReal *area, *normal;
  PetscBool  facing;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normal));
  PetscCall(SurfaceNodeAreas(pair->slave, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, NULL, area, normal));
  PetscCall(SurfaceFaces(pair->master, pair->n, pair->node, normal, &facing));
  PetscCall(PetscFree2(area, normal));
  if (!facing) {
    PetscCall(RefuseInput(mesh->comm,
                          "%s: contact '%s': no face of '%s' faces '%s', their outward normals point the same way; allowed: surfaces that look at each other "
                          "(turn a rigid tool's surface round in gmsh, ReverseMesh, or name the other side)",
                          SceneWhere(contact->scene, pair->scene->path, "master"), pair->scene->name, pair->scene->master, pair->scene->slave));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTakeOverlap - what the scene says of surfaces that overlap before any load: refuses (exit 1) the deepest overlap of each pair that is
   more than the facets' own sagitta explains, or keeps the overlaps as g_0.

   Collective; after ContactResidual() with forces, at the undeformed state. The message names pair, node and depth. */
PetscErrorCode ContactTakeOverlap(Contact contact)
{
  Mesh mesh = contact->mesh;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    Pair     *pair  = &contact->pairs[p];
    PetscReal worst = 0;
    PetscInt  at    = -1;
    struct {
      double gap;
      int    rank;
    } mine = {0, 0}, least;
    char complaint[512];

    if (pair->master) PetscCall(PairCheckFacing(contact, pair));
    for (PetscInt c = 0; c < pair->n; c++) {
      if (pair->scene->initial_overlap == OVERLAP_RAMP || pair->scene->initial_overlap == OVERLAP_IGNORE)
        pair->now.offset[c] = pair->now.gap[c] < 0 ? pair->now.gap[c] : 0;
      if (pair->scene->initial_overlap != OVERLAP_REFUSE) continue;
      if (!(pair->now.gap[c] < -TouchTolerance(pair, c)) || pair->now.gap[c] >= worst) continue;
      worst = pair->now.gap[c];
      at    = c;
    }
    mine.gap = worst;
    PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
    PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
    if (at >= 0) {
      PetscCall(
        PetscSNPrintf(complaint, sizeof(complaint),
                      "%s: contact '%s': slave node %" PetscInt_FMT
                      " lies %g behind the master before any load; allowed: surfaces that touch or are apart, or initial_overlap: resolve, ramp or ignore",
                      SceneWhere(contact->scene, pair->scene->path, "initial_overlap"), pair->scene->name, mesh->node_tag[pair->node[at]], (double)-worst));
    }
    PetscCall(RefuseInputAnywhere(mesh->comm, at >= 0 && least.rank == mine.rank ? complaint : NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSummarise - counts, penetrations (lengths), penalties and total force of all pairs in the present state, the same on all ranks.

   Collective. in and out count against the accepted state: to be called before ContactAccept(). */
PetscErrorCode ContactSummarise(Contact contact, ContactSummary *summary)
{
  PetscInt  count[3] = {0, 0, 0};
  PetscReal most[5] = {0, 0, PETSC_MIN_REAL, PETSC_MIN_REAL, 0}, total[3] = {0, 0, 0},
            least = PETSC_MAX_REAL; /* most: penetration, over h, -penalty_min, penalty_max, nodal force */

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const Pair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++) {
      const PetscReal penetration = pair->now.status[c] == CONTACT_CLOSED ? TermOffset(pair, c, pair->t) - pair->now.gap[c] : 0;

      count[0] += pair->now.status[c] == CONTACT_CLOSED;
      count[1] += pair->now.status[c] == CONTACT_CLOSED && pair->accepted.status[c] == CONTACT_OPEN;
      count[2] += pair->now.status[c] == CONTACT_OPEN && pair->accepted.status[c] == CONTACT_CLOSED;
      most[0] = PetscMax(most[0], penetration);
      most[1] = PetscMax(most[1], penetration / pair->size[c]);
      most[2] = PetscMax(most[2], -pair->now.penalty[c]);
      most[3] = PetscMax(most[3], pair->now.penalty[c]);
      most[4] = PetscMax(most[4], pair->force[c]);
      for (int d = 0; d < 3; d++) total[d] += pair->vector[3 * c + d];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 5, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  for (int p = 0; p < contact->n_pairs; p++) {
    const Pair *pair = &contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++)
      if (pair->now.status[c] == CONTACT_CLOSED && pair->force[c] > CONTACT_LOADED * most[4])
        least = PetscMin(least, TermOffset(pair, c, pair->t) - pair->now.gap[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, contact->mesh->comm));
  *summary = (ContactSummary){.nodes                  = count[0],
                              .in                     = count[1],
                              .out                    = count[2],
                              .max_penetration        = most[0],
                              .max_penetration_over_h = most[1],
                              .min_penetration        = count[0] && least < PETSC_MAX_REAL ? least : 0,
                              .penalty_min            = -most[2],
                              .penalty_max            = most[3],
                              .force                  = PetscSqrtReal(PetscSqr(total[0]) + PetscSqr(total[1]) + PetscSqr(total[2]))};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------- what probes and output ask ---------- */

/* ContactPairs - how many pairs there are; 0 for NULL. Not collective. */
int ContactPairs(Contact contact)
{
  return contact ? contact->n_pairs : 0;
}

/* ContactPairName - the scene's name of a pair. Not collective. */
const char *ContactPairName(Contact contact, int pair)
{
  return contact->pairs[pair].scene->name;
}

/* ContactFindPair - number of the pair of that name, -1: none. Not collective. */
int ContactFindPair(Contact contact, const char *name)
{
  for (int p = 0; p < ContactPairs(contact); p++)
    if (!strcmp(contact->pairs[p].scene->name, name)) return p;
  return -1;
}

/* ContactGetNodes - what this rank's slave nodes of pair p show: areas, gaps, forces, pressures, normals.

   Collective. u[n_nodes*dim]: local displacements (length), for the current tributary areas (finite kinematics; else the reference's). The
   arrays belong to the contact and stand until its next call. */
PetscErrorCode ContactGetNodes(Contact contact, int p, const PetscReal *u, ContactNodes *nodes)
{
  Pair      *pair = &contact->pairs[p];
  PetscReal *area;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->mesh->n_nodes, &area));
  PetscCall(SurfaceNodeAreas(pair->slave, contact->scene->geometry, contact->scene->kinematics == KINEMATICS_FINITE ? u : NULL, area, NULL));
  for (PetscInt c = 0; c < pair->n; c++) pair->pressure[c] = pair->force[c] / area[pair->node[c]];
  PetscCall(PetscFree(area));
  *nodes = (ContactNodes){pair->n, pair->node, pair->area, pair->now.gap, pair->now.penalty, pair->force, pair->pressure, pair->normal};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactMasterForce - total force of pair p on its master in the present state, the same on all ranks; axisymmetric: over 360 degrees.

   Collective. */
PetscErrorCode ContactMasterForce(Contact contact, int p, PetscReal force[3])
{
  const Pair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  force[0] = force[1] = force[2] = 0;
  for (PetscInt c = 0; c < pair->n; c++)
    for (int d = 0; d < 3; d++) force[d] -= pair->vector[3 * c + d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactGapAt - gap (length) of pair p at a slave node, the same on all ranks.

   Collective. u[n_nodes*dim], t: the present state; node_id: the mesh's rank-independent number. The state's own gap where there is one;
   else the signed distance to the whole master without its mirror images (SearchDistance()). NaN: no node of the slave surface. */
PetscErrorCode ContactGapAt(Contact contact, int p, const PetscReal *u, PetscReal t, PetscInt node_id, PetscReal *gap)
{
  Mesh        mesh     = contact->mesh;
  const Pair *pair     = &contact->pairs[p];
  PetscReal   found[5] = {-1, 0, 0, 0, 0}; /* 1: a node of the slave surface, 2: with a finite gap; gap; position */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pair->slave->group->n_nodes; i++) {
    const PetscInt node = pair->slave->group->nodes[i];

    if (mesh->node_id[node] != node_id) continue;
    found[0] = 1;
    for (int d = 0; d < mesh->dim; d++) found[2 + d] = mesh->coords[node * mesh->dim + d] + u[node * mesh->dim + d];
  }
  for (PetscInt c = 0; c < pair->n; c++) {
    if (mesh->node_id[pair->node[c]] != node_id || PetscIsNanReal(pair->now.gap[c])) continue;
    found[0] = 2;
    found[1] = pair->now.gap[c];
  }
  {
    struct {
      double found;
      int    rank;
    } mine = {found[0], 0}, best;

    PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
    PetscCallMPI(MPI_Allreduce(&mine, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh->comm));
    PetscCallMPI(MPI_Bcast(found, 5, MPIU_REAL, best.rank, mesh->comm));
  }
  *gap = found[0] < 0 ? NAN : found[1];
  if (found[0] == 1) PetscCall(SearchDistance(pair->search, u, t, &found[2], gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairPenalty - smallest and largest penalty (force per length and area) of pair p over all ranks. Collective. */
PetscErrorCode ContactPairPenalty(Contact contact, int p, PetscReal *least, PetscReal *most)
{
  const Pair *pair     = &contact->pairs[p];
  PetscReal   range[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    range[0] = PetscMax(range[0], -pair->now.penalty[c]);
    range[1] = PetscMax(range[1], pair->now.penalty[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *least = -range[0];
  *most  = range[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairSurface - the group of the slave surface of pair p (the mesh's) and its mean face size (length). Not collective. */
PetscErrorCode ContactPairSurface(Contact contact, int p, const MeshGroup **slave, PetscReal *mean_face_size)
{
  PetscFunctionBeginUser;
  *slave          = contact->pairs[p].slave->group;
  *mean_face_size = contact->pairs[p].slave->mean_size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairFits - how the fits of a pair stand: counts by rung, neighbours, guards, and the two errors of the surface. Collective. */
PetscErrorCode ContactPairFits(Contact contact, int p, ContactFits *fits)
{
  Pair        *pair             = &contact->pairs[p];
  ContactLists lists            = pair->lists;
  PetscInt     count[RUNGS + 3] = {0};                                                       /* by rung, facets, points, neighbours */
  PetscReal    most[6]          = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL, 0, 0, 0}; /* -fewest, most neighbours, -pivot, Lambda, smoothing, facets */

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscReal gap;
    PetscBool found;

    if (!pair->fit.degree || lists->facet_ptr[q] == lists->facet_ptr[q + 1]) continue;
    count[RUNGS + 1]++;
    count[lists->fit_n[q] ? lists->rung[q] : RUNGS]++;
    if (!lists->fit_n[q]) continue;
    PetscCall(PointEvaluate(contact, pair, pair->smoother, lists, q, -1, SMOOTHER_GAP, &found));
    if (!found || contact->work.result.facet_served) continue;
    gap = contact->work.result.gap;
    count[RUNGS + 2] += contact->work.result.n;
    most[0] = PetscMax(most[0], -(PetscReal)contact->work.result.n);
    most[1] = PetscMax(most[1], (PetscReal)contact->work.result.n);
    most[2] = PetscMax(most[2], -lists->pivot[q]);
    most[3] = PetscMax(most[3], lists->amplified[q]);
    most[4] = PetscMax(most[4], lists->residual[q]);
    PetscCall(PointEvaluate(contact, pair, SmootherFind("facet"), lists, q, -1, SMOOTHER_GAP, &found));
    if (contact->work.result.beyond == 0) most[5] = PetscMax(most[5], PetscAbsReal(contact->work.result.gap - gap));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, RUNGS + 3, MPIU_INT, MPI_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 6, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *fits = (ContactFits){.points          = count[RUNGS + 1],
                        .plain           = count[0],
                        .facets          = count[RUNGS],
                        .amplified       = most[3],
                        .smoothing_error = most[4],
                        .facet_error     = most[5]};
  for (int r = 1; r < RUNGS; r++) *(r <= RUNG_WIDER ? &fits->wider : r <= RUNG_DEGREE_2 ? &fits->degree_2 : &fits->linear) += count[r];
  if (fits->points > fits->facets) {
    fits->neighbours_min  = (PetscInt)-most[0];
    fits->neighbours_max  = (PetscInt)most[1];
    fits->neighbours_mean = (PetscReal)count[RUNGS + 2] / (fits->points - fits->facets);
    fits->pivot           = -most[2];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactComm - the communicator. Not collective. */
MPI_Comm ContactComm(Contact contact)
{
  return contact ? contact->mesh->comm : MPI_COMM_NULL;
}

/* ContactPairText - "plate_bottom on pipe_outer, diffuse, degree 4"; valid until the next call. Not collective. */
const char *ContactPairText(Contact contact, int p)
{
  static const char *const shapes[] = {"plane", "cylinder", "sphere"};
  static char              text[512];
  const Pair              *pair  = &contact->pairs[p];
  const SceneContact      *scene = pair->scene;

  if (!pair->master)
    snprintf(text, sizeof(text), "%s on an analytic %s", scene->slave, shapes[scene->analytic.shape]);
  else if (!pair->fit.degree)
    snprintf(text, sizeof(text), "%s on %s, facets", scene->slave, scene->master);
  else
    snprintf(text, sizeof(text), "%s on %s, diffuse, degree %d, support %g, weight %g", scene->slave, scene->master, pair->fit.degree, pair->fit.support,
             pair->fit.exponent);
  return text;
}

/* ContactPairGaps - smallest and largest gap of the slave nodes near the master (lengths); 0, 0 where none is near. Collective. */
PetscErrorCode ContactPairGaps(Contact contact, int p, PetscReal *least, PetscReal *most)
{
  const Pair *pair     = &contact->pairs[p];
  PetscReal   range[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    if (PetscIsNanReal(pair->now.gap[c])) continue;
    range[0] = PetscMax(range[0], -pair->now.gap[c]);
    range[1] = PetscMax(range[1], pair->now.gap[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  *least = range[1] > PETSC_MIN_REAL ? -range[0] : 0;
  *most  = range[1] > PETSC_MIN_REAL ? range[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
