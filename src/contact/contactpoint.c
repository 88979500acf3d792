#include "contactimpl.h"
#include "base/lanes.h"
#include "base/timing.h"

/* The gap and its variations against an analytic master, which has no points. */
static PetscBool PointEvaluateAnalytic(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  const int        dim    = lists->dim;
  const PetscReal *centre = pair->mesh->centre;
  SmootherResult  *result = &pair->work->result;
  AnalyticSurface  master = pair->scene->analytic;
  AnalyticResult   found;
  PetscReal        point[3], x[3];

  MotionPlace(&pair->scene->motion, lists->t, pair->scene->motion.point, point);
  MotionTurn(&pair->scene->motion, lists->t, pair->scene->analytic.axis, master.axis);
  for (int d = 0; d < dim; d++)
    x[d] = (lists->slave_X[q * dim + d] - (point[d] - centre[d])) + lists->slave_u[q * dim + d];
  if (!AnalyticSurfaceEvaluate(&master, dim, x, &found)) return PETSC_FALSE;
  result->gap          = found.gap;
  result->beyond       = 0;
  result->seed         = -1;
  result->facet_served = 0;
  result->factored     = 0;
  result->n            = 0;
  for (int d = 0; d < 3; d++) result->normal[d] = found.normal[d];
  for (int d = 0; d < dim; d++) result->N[d] = found.N[d];
  for (int d = 0; d < dim * dim; d++) result->M[d] = found.M[d];
  return PETSC_TRUE;
}

/* Positions relative to slave point q, as of NeighbourListsRelative(), and weights of the points in its list */
LANES_INLINE void GatherPoints(const int dim, NeighbourLists lists, PetscInt q, PetscReal *x, PetscReal *multiplier)
{
  const PetscInt  *point = &lists->list_point[lists->list_ptr[q]], n = lists->list_ptr[q + 1] - lists->list_ptr[q];
  const PetscReal *X = lists->point_X, *u = lists->point_u, *weight = lists->point_weight;
  PetscReal        X_0[3], u_0[3];

  for (int d = 0; d < dim; d++) {
    X_0[d] = lists->slave_X[q * dim + d];
    u_0[d] = lists->slave_u[q * dim + d];
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt p = point[i];

    multiplier[i] = weight[p];
    for (int d = 0; d < dim; d++) x[i * dim + d] = (X[p * dim + d] - X_0[d]) + (u[p * dim + d] - u_0[d]);
  }
}

/* ContactPointEvaluate - gap (and variations over the fit points) of slave point q of the lists; *found is PETSC_FALSE
 * where no master is near. */
PetscErrorCode ContactPointEvaluate(const ContactPair *pair, const Smoother *smoother, NeighbourLists lists, PetscInt q,
                                    int seed, SmootherWant want, PetscBool *found)
{
  const int      dim  = lists->dim;
  ContactWork   *work = pair->work;
  const PetscInt n    = lists->list_ptr[q + 1] - lists->list_ptr[q];
  SmootherInput  in;

  PetscFunctionBeginUser;
  if (!pair->master) {
    *found = PointEvaluateAnalytic(pair, lists, q);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (n > work->x_room) {
    work->x_room = 2 * n;
    PetscCall(PetscFree2(work->x, work->multiplier));
    PetscCall(PetscMalloc2(work->x_room * dim, &work->x, work->x_room, &work->multiplier));
  }
  if (dim == 3)
    GatherPoints(3, lists, q, work->x, work->multiplier);
  else
    GatherPoints(2, lists, q, work->x, work->multiplier);
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

static PetscErrorCode WorkReserveSlots(ContactWork *work, NeighbourLists lists)
{
  PetscFunctionBeginUser;
  if (lists->n_nodes <= work->slot_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->slot_room = 2 * lists->n_nodes;
  PetscCall(PetscFree(work->slot));
  PetscCall(PetscMalloc1(work->slot_room, &work->slot));
  for (PetscInt i = 0; i < work->slot_room; i++) work->slot[i] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WorkReserveMap(ContactWork *work, NeighbourLists lists, int rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveSlots(work, lists));
  if (rows <= work->map.rows_room && entries <= work->map.entries_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->map.rows_room    = PetscMax(work->map.rows_room, 2 * rows);
  work->map.entries_room = PetscMax(work->map.entries_room, 2 * (int)entries);
  PetscCall(PetscFree5(work->map.ptr, work->map.node, work->map.S, work->map.sign, work->number));
  PetscCall(PetscMalloc5(work->map.rows_room + 1, &work->map.ptr, work->map.entries_room, &work->map.node,
                         work->map.entries_room, &work->map.S, 3 * work->map.entries_room, &work->map.sign,
                         work->map.entries_room, &work->number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactWorkDestroy - Not collective. */
PetscErrorCode ContactWorkDestroy(ContactWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(work->x, work->multiplier));
  PetscCall(PetscFree5(work->map.ptr, work->map.node, work->map.S, work->map.sign, work->number));
  PetscCall(PetscFree(work->N));
  PetscCall(PetscFree(work->sum_workspace));
  PetscCall(PetscFree(work->M));
  PetscCall(PetscFree(work->slot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of n images of nodes, side[n], on image `image`. */
static void MapAddRow(const ContactPair *pair, int row, int image, PetscInt n, const PetscInt *nodes, const int *side,
                      const PetscReal *S)
{
  ContactWork     *work = pair->work;
  ContactMap      *map  = &work->map;
  const PetscReal *sign = pair->images[image].sign;
  int              k    = map->ptr[row];

  for (PetscInt a = 0; a < n; a++, k++) {
    map->node[k] = work->slot[nodes[a]];
    map->S[k]    = S[a];
    for (int d = 0; d < 3; d++) map->sign[3 * k + d] = sign[d] * pair->images[side[a]].sign[d];
  }
  map->ptr[row + 1] = k;
}

/* A row for fit point p. */
static void MapAddPoint(const ContactPair *pair, NeighbourLists lists, int row, PetscInt p)
{
  const PetscInt first = lists->point_ptr[p];

  MapAddRow(pair, row, lists->point_image[p], lists->point_ptr[p + 1] - first, &lists->point_node[first],
            &lists->point_side[first], &lists->point_S[first]);
}

/* The map of the last evaluation, to where the nodes' slots are. */
static void MapFill(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  ContactWork   *work = pair->work;
  const PetscInt own  = lists->slave_ptr[q];

  work->map.ptr[0] = 0;
  MapAddRow(pair, 0, 0, lists->slave_ptr[q + 1] - own, &lists->slave_node[own], &lists->slave_side[own],
            &lists->slave_S[own]);
  for (int i = 0; i < work->result.n; i++)
    MapAddPoint(pair, lists, 1 + i, lists->list_point[lists->list_ptr[q] + work->result.points[i]]);
}

/* How many entries the map of the last evaluation has. */
static PetscInt MapEntries(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  PetscInt entries = lists->slave_ptr[q + 1] - lists->slave_ptr[q];

  for (int i = 0; i < pair->work->result.n; i++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + pair->work->result.points[i]];

    entries += lists->point_ptr[p + 1] - lists->point_ptr[p];
  }
  return entries;
}

/* ContactNodesBegin - begins a list of contact nodes in the work's number, of up to `room` mentions. Not collective. */
PetscErrorCode ContactNodesBegin(const ContactPair *pair, PetscInt room)
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveMap(pair->work, pair->lists, 0, room));
  pair->work->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactNodesAdd - nodes that are not in the list yet get its next places as their slots. Not collective. */
void ContactNodesAdd(const ContactPair *pair, PetscInt n, const PetscInt nodes[])
{
  ContactWork *work = pair->work;

  for (PetscInt a = 0; a < n; a++) {
    int *slot = &work->slot[nodes[a]];

    if (*slot >= 0) continue;
    *slot                       = (int)work->count;
    work->number[work->count++] = nodes[a];
  }
}

/* ContactNodesEnd - the list is complete, slots are given back. Not collective. */
void ContactNodesEnd(const ContactPair *pair)
{
  ContactBlockEnd(pair, pair->work->count, pair->work->number);
}

static void NodesAddPoint(const ContactPair *pair, PetscInt p)
{
  const NeighbourLists lists = pair->lists;

  ContactNodesAdd(pair, lists->point_ptr[p + 1] - lists->point_ptr[p], &lists->point_node[lists->point_ptr[p]]);
}

/* ContactPointToNodes - carries N of the last evaluation from points to contact nodes, each of which occurs once.

   Not collective. q: the slave point that was evaluated. */
PetscErrorCode ContactPointToNodes(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  ContactWork   *work = pair->work;
  FitDerivatives map;

  PetscFunctionBeginUser;
  PetscCall(WorkReserveMap(work, lists, 1 + work->result.n, MapEntries(pair, lists, q)));
  work->count = 0;
  ContactNodesAdd(pair, lists->slave_ptr[q + 1] - lists->slave_ptr[q], &lists->slave_node[lists->slave_ptr[q]]);
  for (int i = 0; i < work->result.n; i++)
    NodesAddPoint(pair, lists->list_point[lists->list_ptr[q] + work->result.points[i]]);
  MapFill(pair, lists, q);
  ContactNodesEnd(pair);
  if (work->count > work->room) {
    work->room = 2 * work->count;
    PetscCall(PetscFree(work->N));
    PetscCall(PetscMalloc1(work->room * lists->dim, &work->N));
  }
  map = (FitDerivatives){(int)work->count, work->map.ptr, work->map.node, work->map.S, work->map.sign};
  FitDerivativesFirst(lists->dim, work->result.n, work->result.N, &map, work->N);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactBlockBegin - the nodes' places in the block at hand become their slots; contact nodes that are not among them
 * take no part in it. Not collective. */
PetscErrorCode ContactBlockBegin(const ContactPair *pair, PetscInt n, const PetscInt nodes[])
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveSlots(pair->work, pair->lists));
  for (PetscInt i = 0; i < n; i++) pair->work->slot[nodes[i]] = (int)i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactBlockEnd - Not collective. */
void ContactBlockEnd(const ContactPair *pair, PetscInt n, const PetscInt nodes[])
{
  for (PetscInt i = 0; i < n; i++) pair->work->slot[nodes[i]] = -1;
}

/* Room for the M of a block. */
static PetscErrorCode WorkReserveBlock(ContactWork *work, PetscInt m)
{
  PetscFunctionBeginUser;
  if (m * m + BLOCK_PADDING <= work->M_room) PetscFunctionReturn(PETSC_SUCCESS);
  work->M_room = 2 * m * m + BLOCK_PADDING;
  PetscCall(PetscFree(work->M));
  PetscCall(PetscMalloc1(work->M_room, &work->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondBegin - begins a sum of second variations over the nodes of a block, after ContactBlockBegin(). Not
   collective.

   nodes: of the block; points: how many slave points are added at most, and as many vectors with
   FitDerivativesAddOuter(). */
PetscErrorCode ContactSecondBegin(const ContactPair *pair, PetscInt nodes, PetscInt points)
{
  ContactWork *work   = pair->work;
  const int    dim    = pair->mesh->dim;
  const int    degree = PetscMax(pair->fit.degree, 1); /* facets need no more than the sum's head */
  const int    depth  = (int)points * (1 + PetscMax(FitDerivativesDepth(dim, degree), dim * (1 + FACE_MAX_NODES)));
  const long   room   = FitDerivativesWorkspace(dim, degree, (int)nodes, depth);

  PetscFunctionBeginUser;
  if (room > work->sum_room) {
    work->sum_room = 2 * (PetscInt)room;
    PetscCall(PetscFree(work->sum_workspace));
    PetscCall(PetscMalloc1(work->sum_room, &work->sum_workspace));
  }
  PetscCall(WorkReserveBlock(work, nodes * dim));
  FitDerivativesBegin(&work->sum, dim, degree, (int)nodes, depth, work->sum_workspace);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondAdd - evaluates slave point q and adds factor times its second variation. Not collective.

   own[n_points]: takes what belongs to the fit points one by one, for ContactOwnToNodes(). */
PetscErrorCode ContactSecondAdd(const ContactPair *pair, PetscInt q, PetscReal factor,
                                double (*own)[FIT_DERIVATIVES_OWN])
{
  ContactWork   *work  = pair->work;
  NeighbourLists lists = pair->lists;
  ContactMap    *map   = &work->map;
  PetscBool      found;
  FitDerivatives fit;

  PetscFunctionBeginUser;
  if (pair->fit.degree) TimingBegin(TIMING_FIT);
  PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, pair->seed[q], SMOOTHER_SECOND_VARIATION, &found));
  if (pair->fit.degree) TimingEnd(TIMING_FIT);
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WorkReserveMap(work, lists, 1 + work->result.n, MapEntries(pair, lists, q)));
  MapFill(pair, lists, q);
  fit = (FitDerivatives){work->sum.n_nodes, map->ptr, map->node, map->S, map->sign};
  if (work->result.factored) {
    FitDerivativesAdd(&work->sum, factor, &work->result.factors, &fit);
    for (int i = 0; i < work->result.n; i++)
      FitDerivativesOwn(factor, &work->result.factors, i,
                        own[lists->list_point[lists->list_ptr[q] + work->result.points[i]]]);
  } else
    FitDerivativesAddDense(&work->sum, factor, work->result.n, work->result.M, &fit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondEnd - the work's M is the sum. Not collective. */
void ContactSecondEnd(const ContactPair *pair)
{
  FitDerivativesEnd(&pair->work->sum, pair->work->M);
}

/* ContactPointsToNodes - the contact nodes of fit points first to end - 1, into the work's number. Not collective. */
PetscErrorCode ContactPointsToNodes(const ContactPair *pair, PetscInt first, PetscInt end)
{
  PetscFunctionBeginUser;
  PetscCall(WorkReserveMap(pair->work, pair->lists, (int)(end - first),
                           pair->lists->point_ptr[end] - pair->lists->point_ptr[first]));
  pair->work->count = 0;
  for (PetscInt p = first; p < end; p++) NodesAddPoint(pair, p);
  ContactNodesEnd(pair);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactOwnToNodes - the second variations that belong to fit points first to end - 1, summed over slave points, into
   the work's M. Not collective.

   nodes: of the block at hand, which are these points'; own: of all fit points. */
PetscErrorCode ContactOwnToNodes(const ContactPair *pair, PetscInt nodes, PetscInt first, PetscInt end,
                                 const double (*own)[FIT_DERIVATIVES_OWN])
{
  const int      dim  = pair->mesh->dim;
  ContactWork   *work = pair->work;
  FitDerivatives map;

  PetscFunctionBeginUser;
  PetscCall(WorkReserveBlock(work, nodes * dim));
  PetscCall(PetscArrayzero(work->M, PetscSqr(nodes * dim)));
  work->map.ptr[0] = 0;
  for (PetscInt p = first; p < end; p++) MapAddPoint(pair, pair->lists, (int)(p - first), p);
  map = (FitDerivatives){(int)nodes, work->map.ptr, work->map.node, work->map.S, work->map.sign};
  FitDerivativesAddOwn(dim, 0, (int)(end - first), &own[first], &map, work->M);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The gap of a slave point, with its first variation where `vary`; where nothing has moved since its fit was made, that
 * tells it. */
static PetscErrorCode PointGap(const ContactPair *pair, NeighbourLists lists, PetscInt q, int seed, PetscBool vary,
                               PetscBool *found)
{
  SmootherResult *result = &pair->work->result;

  PetscFunctionBeginUser;
  if (vary || !lists->made || !lists->fit_n[q])
    PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, seed, vary ? SMOOTHER_FIRST_VARIATION : SMOOTHER_GAP,
                                   found));
  else {
    *found       = PETSC_TRUE;
    result->gap  = lists->gap[q]; /* facet_served, points and factors are those of the point before */
    result->seed = seed;
    for (int d = 0; d < 3; d++) result->normal[d] = lists->normal[3 * q + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPointGaps - gaps (lengths) of the slave points of this rank, positions as the lists were last updated.

   Not collective. factor[n_slaves]: points of factor 0 are not asked for; seed[n_slaves]: the facets of last time,
   rewritten, or NULL; gap[n_slaves]: NaN where there is none; normals[3*n_slaves]: out of the master at the feet, or
   NULL. force[n_slaves]: points with one, of last time, will most likely have one again, and their first variations are
   taken among the pair's, whose lists these are; or NULL. */
PetscErrorCode ContactPointGaps(const ContactPair *pair, NeighbourLists lists, const PetscReal *factor,
                                const PetscReal *force, int *seed, PetscReal *gap, PetscReal *normals)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    const PetscBool vary  = (PetscBool)(force && force[q] != 0 && factor[q] > 0);
    PetscBool       found = PETSC_FALSE;

    if (factor[q] > 0) PetscCall(PointGap(pair, lists, q, seed ? seed[q] : -1, vary, &found));
    if (vary) PetscCall(ContactVariationsKeep(pair, q, found));
    gap[q] = found ? pair->work->result.gap : NAN;
    if (found && seed) seed[q] = pair->work->result.seed;
    for (int d = 0; normals && d < 3; d++)
      normals[3 * q + d] = found && d < lists->dim ? pair->work->result.normal[d] : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTermGap - the weighted gap sum W f g / sum W f (length) of a term over its points with a gap; NaN without any.

   Not collective. factor, point_gap[n_slaves]: of ContactPointGaps(). *area: sum W f, or NULL. */
PetscReal ContactTermGap(const ContactPair *pair, const PetscReal *factor, const PetscReal *point_gap, PetscInt c,
                         PetscReal *area)
{
  PetscReal sum = 0, total = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k];
    const PetscReal weight = pair->term_weight[k] * factor[q];

    if (PetscIsNanReal(point_gap[q]) || weight == 0) continue;
    sum += weight * point_gap[q];
    total += weight;
  }
  if (area) *area = total;
  return total > 0 ? sum / total : NAN;
}
