#include "contactimpl.h"

/* The gap and its variations against an analytic master, which has no points. */
static PetscBool PointEvaluateAnalytic(const ContactPair *pair, ContactLists lists, PetscInt q)
{
  const int        dim    = lists->dim;
  const PetscReal *centre = pair->mesh->centre;
  SmootherResult  *result = &pair->work->result;
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
  result->factored     = 0;
  result->n            = 0;
  for (int d = 0; d < 3; d++) result->normal[d] = found.normal[d];
  for (int d = 0; d < dim; d++) result->N[d] = found.N[d];
  for (int d = 0; d < dim * dim; d++) result->M[d] = found.M[d];
  return PETSC_TRUE;
}

/* ContactPointEvaluate - gap (and variations over the fit points) of slave point q of the lists; *found is PETSC_FALSE where no master is near. */
PetscErrorCode ContactPointEvaluate(const ContactPair *pair, const Smoother *smoother, ContactLists lists, PetscInt q, int seed, SmootherWant want,
                                    PetscBool *found)
{
  const int      dim   = lists->dim;
  ContactWork   *work  = pair->work;
  const PetscInt first = lists->list_ptr[q], n = lists->list_ptr[q + 1] - first;
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
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt p = lists->list_point[first + i];

    work->multiplier[i] = lists->point_weight[p];
    ListsRelative(lists, q, p, &work->x[i * dim]);
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

static PetscErrorCode WorkReserveMap(ContactWork *work, ContactLists lists, int rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  if (rows > work->map.rows_room || entries > work->map.entries_room) {
    work->map.rows_room    = 2 * rows;
    work->map.entries_room = 2 * (int)entries;
    PetscCall(PetscFree5(work->map.ptr, work->map.node, work->map.S, work->map.sign, work->number));
    PetscCall(PetscMalloc5(work->map.rows_room + 1, &work->map.ptr, work->map.entries_room, &work->map.node, work->map.entries_room, &work->map.S,
                           3 * work->map.entries_room, &work->map.sign, work->map.entries_room, &work->number));
  }
  if (lists->n_nodes > work->slot_room) {
    work->slot_room = 2 * lists->n_nodes;
    PetscCall(PetscFree(work->slot));
    PetscCall(PetscMalloc1(work->slot_room, &work->slot));
    for (PetscInt i = 0; i < work->slot_room; i++) work->slot[i] = -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactWorkDestroy - Not collective. */
PetscErrorCode ContactWorkDestroy(ContactWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(work->x, work->multiplier));
  PetscCall(PetscFree5(work->map.ptr, work->map.node, work->map.S, work->map.sign, work->number));
  PetscCall(PetscFree(work->N));
  PetscCall(PetscFree(work->half));
  PetscCall(PetscFree(work->sum_workspace));
  PetscCall(PetscFree(work->slot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of n images of nodes, side[n], on image `image`. */
static void MapAddRow(const ContactPair *pair, int row, int image, PetscInt n, const PetscInt *nodes, const int *side, const PetscReal *S)
{
  ContactWork     *work = pair->work;
  ContactMap      *map  = &work->map;
  const PetscReal *sign = pair->images[image].sign;
  int              k    = map->ptr[row];

  for (PetscInt a = 0; a < n; a++, k++) {
    int *slot = &work->slot[nodes[a]];

    if (*slot < 0) {
      *slot                       = (int)work->count;
      work->number[work->count++] = nodes[a];
    }
    map->node[k] = *slot;
    map->S[k]    = S[a];
    for (int d = 0; d < 3; d++) map->sign[3 * k + d] = sign[d] * pair->images[side[a]].sign[d];
  }
  map->ptr[row + 1] = k;
}

static void MapBegin(ContactWork *work)
{
  work->count      = 0;
  work->map.ptr[0] = 0;
}

static void MapEnd(ContactWork *work)
{
  for (PetscInt i = 0; i < work->count; i++) work->slot[work->number[i]] = -1;
}

/* A row for fit point p. */
static void MapAddPoint(const ContactPair *pair, ContactLists lists, int row, PetscInt p)
{
  const PetscInt first = lists->point_ptr[p];

  MapAddRow(pair, row, lists->point_image[p], lists->point_ptr[p + 1] - first, &lists->point_node[first], &lists->point_side[first], &lists->point_S[first]);
}

/* The map of the last evaluation. */
static void MapFill(const ContactPair *pair, ContactLists lists, PetscInt q)
{
  ContactWork   *work = pair->work;
  const PetscInt own  = lists->slave_ptr[q];

  MapBegin(work);
  MapAddRow(pair, 0, 0, lists->slave_ptr[q + 1] - own, &lists->slave_node[own], &lists->slave_side[own], &lists->slave_S[own]);
  for (int i = 0; i < work->result.n; i++) MapAddPoint(pair, lists, 1 + i, lists->list_point[lists->list_ptr[q] + work->result.points[i]]);
  MapEnd(work);
}

/* ContactPointToNodes - carries N of the last evaluation from points to contact nodes, each of which occurs once.

   Not collective. q: the slave point that was evaluated. */
PetscErrorCode ContactPointToNodes(const ContactPair *pair, ContactLists lists, PetscInt q)
{
  ContactWork *work    = pair->work;
  PetscInt     entries = lists->slave_ptr[q + 1] - lists->slave_ptr[q];
  FitMap       map;

  PetscFunctionBeginUser;
  for (int i = 0; i < work->result.n; i++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + work->result.points[i]];

    entries += lists->point_ptr[p + 1] - lists->point_ptr[p];
  }
  PetscCall(WorkReserveMap(work, lists, 1 + work->result.n, entries));
  MapFill(pair, lists, q);
  if (work->count > work->room) {
    work->room = 2 * work->count;
    PetscCall(PetscFree(work->N));
    PetscCall(PetscMalloc1(work->room * lists->dim, &work->N));
  }
  map = (FitMap){(int)work->count, work->map.ptr, work->map.node, work->map.S, work->map.sign};
  FitMapFirst(lists->dim, work->result.n, work->result.N, &map, work->N);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondBegin - begins a sum of second variations over the nodes of a block. Not collective.

   nodes: of the block; points: how many slave points are added at most; M[nodes*dim][nodes*dim]: symmetric, to be added to. */
PetscErrorCode ContactSecondBegin(const ContactPair *pair, PetscInt nodes, PetscInt points, PetscReal *M)
{
  ContactWork   *work   = pair->work;
  const int      degree = PetscMax(pair->fit.degree, 1); /* facets need no more than the sum's head */
  const PetscInt room   = FitMapWorkspace(pair->mesh->dim, degree, (int)nodes, (int)points);

  PetscFunctionBeginUser;
  if (room > work->sum_room) {
    work->sum_room = 2 * room;
    PetscCall(PetscFree(work->sum_workspace));
    PetscCall(PetscMalloc1(work->sum_room, &work->sum_workspace));
  }
  FitMapBegin(&work->sum, pair->mesh->dim, degree, (int)nodes, (int)points, work->sum_workspace, M);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds factor S^T M S for the few points of a facet: rows first, then columns. */
static PetscErrorCode AddFacetSecond(ContactWork *work, int dim, PetscReal factor)
{
  const ContactMap     *map  = &work->map;
  const SmootherResult *r    = &work->result;
  const int             rows = 1 + r->n, m = rows * dim, n = work->sum.n_nodes * dim;

  PetscFunctionBeginUser;
  if (n * m > work->half_room) {
    work->half_room = 2 * n * m;
    PetscCall(PetscFree(work->half));
    PetscCall(PetscMalloc1(work->half_room, &work->half));
  }
  PetscCall(PetscArrayzero(work->half, n * m));
  for (int i = 0; i < rows; i++) {
    for (int k = map->ptr[i]; k < map->ptr[i + 1]; k++) {
      for (int d = 0; d < dim; d++) {
        const PetscReal  scale = factor * map->S[k] * map->sign[3 * k + d];
        const PetscReal *from  = &r->M[(i * dim + d) * m];
        PetscReal       *to    = &work->half[(map->node[k] * dim + d) * m];

        for (int j = 0; j < m; j++) to[j] += scale * from[j];
      }
    }
  }
  for (int i = 0; i < rows; i++) {
    for (int k = map->ptr[i]; k < map->ptr[i + 1]; k++) {
      for (int d = 0; d < dim; d++) {
        const PetscReal scale = map->S[k] * map->sign[3 * k + d];

        for (int j = 0; j < n; j++) work->sum.M[j * n + map->node[k] * dim + d] += scale * work->half[j * m + i * dim + d];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondAdd - adds factor times the second variation of the last evaluation, after ContactPointToNodes(). Not collective.

   place: of each contact node in the block, or NULL for the numbers of the point's own nodes; own[n_points]: takes what belongs to the fit points one by one,
   for ContactOwnToNodes(). */
PetscErrorCode ContactSecondAdd(const ContactPair *pair, ContactLists lists, PetscInt q, PetscReal factor, const PetscInt *place, double (*own)[FITMAP_OWN])
{
  ContactWork *work = pair->work;
  ContactMap  *map  = &work->map;
  FitMap       fit;

  PetscFunctionBeginUser;
  for (int k = 0; place && k < map->ptr[1 + work->result.n]; k++) map->node[k] = (int)place[work->number[map->node[k]]];
  fit = (FitMap){work->sum.n_nodes, map->ptr, map->node, map->S, map->sign};
  if (work->result.factored) {
    FitMapAdd(&work->sum, factor, &work->result.factors, &fit);
    for (int i = 0; i < work->result.n; i++) FitMapOwn(factor, &work->result.factors, i, own[lists->list_point[lists->list_ptr[q] + work->result.points[i]]]);
  } else
    PetscCall(AddFacetSecond(work, pair->mesh->dim, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactSecondEnd - the sum is complete. Not collective. */
void ContactSecondEnd(const ContactPair *pair)
{
  FitMapEnd(&pair->work->sum);
}

/* ContactPointsToNodes - the contact nodes of fit points first to end - 1, into the work's number. Not collective. */
PetscErrorCode ContactPointsToNodes(const ContactPair *pair, ContactLists lists, PetscInt first, PetscInt end)
{
  ContactWork *work = pair->work;

  PetscFunctionBeginUser;
  PetscCall(WorkReserveMap(work, lists, (int)(end - first), lists->point_ptr[end] - lists->point_ptr[first]));
  MapBegin(work);
  for (PetscInt p = first; p < end; p++) MapAddPoint(pair, lists, (int)(p - first), p);
  MapEnd(work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactOwnToNodes - adds the fit points' own second variations, summed over slave points, over the nodes of the last ContactPointsToNodes(). Not collective.

   own: of the first of the points; M[count*dim][count*dim]: symmetric, to be added to. */
void ContactOwnToNodes(const ContactPair *pair, PetscInt points, const double (*own)[FITMAP_OWN], PetscReal *M)
{
  const ContactMap *map = &pair->work->map;
  const FitMap      fit = {(int)pair->work->count, map->ptr, map->node, map->S, map->sign};

  FitMapAddOwn(pair->mesh->dim, 0, (int)points, own, &fit, M);
}

/* ContactPointGaps - gaps (lengths) of the slave points of this rank, positions as the lists were last updated.

   Not collective. factor[n_slaves]: points of factor 0 are not asked for; seed[n_slaves]: the facets of last time, rewritten, or NULL;
   gap[n_slaves]: NaN where there is none; normals[3*n_slaves]: out of the master at the feet, or NULL. */
PetscErrorCode ContactPointGaps(const ContactPair *pair, ContactLists lists, const PetscReal *factor, int *seed, PetscReal *gap, PetscReal *normals)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    PetscBool found = PETSC_FALSE;

    if (factor[q] > 0) PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, seed ? seed[q] : -1, SMOOTHER_GAP, &found));
    gap[q] = found ? pair->work->result.gap : NAN;
    if (found && seed) seed[q] = pair->work->result.seed;
    for (int d = 0; normals && d < 3; d++) normals[3 * q + d] = found && d < lists->dim ? pair->work->result.normal[d] : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTermGap - the weighted gap sum W f g / sum W f (length) of a term over its points with a gap; NaN without any.

   Not collective. factor, point_gap[n_slaves]: of ContactPointGaps(). *area: sum W f, or NULL. */
PetscReal ContactTermGap(const ContactPair *pair, const PetscReal *factor, const PetscReal *point_gap, PetscInt c, PetscReal *area)
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
