/* One slave point: its gap and variations over fit points, and how these are carried to the contact nodes that the
   points are made of. */
#include "contactimpl.h"
#include "search/pointseen.h"
#include "base/timing.h"

/* Gap and variations against an analytic master, which has no points. */
static PetscBool PointEvaluateAnalytic(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  const int        dim    = lists->dim;
  const PetscReal *centre = pair->mesh->centre;
  SmootherResult  *result = &pair->work->result;
  AnalyticSurface  master = pair->scene->analytic;
  AnalyticResult   found;
  PetscReal        point[3], X[3];

  MotionPlace(&pair->scene->motion, lists->t, pair->scene->motion.point, point);
  MotionTurn(&pair->scene->motion, lists->t, pair->scene->analytic.axis, master.axis);
  for (int d = 0; d < dim; d++) X[d] = lists->slave_X[q * dim + d] - (point[d] - centre[d]);
  if (!AnalyticSurfaceEvaluate(&master, dim, X, &lists->slave_u[q * dim], &found)) return PETSC_FALSE;
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

/* Weights of the points in the list of slave point q, distances along the hoop, and positions relative to it, as of
   NeighbourListsRelative(). */
static void GatherPoints(NeighbourLists lists, PetscInt q, PetscReal *x, PetscReal *multiplier, PetscReal *hoop)
{
  const PetscInt *point = &lists->list_point[lists->list_ptr[q]], n = lists->list_ptr[q + 1] - lists->list_ptr[q];

  for (PetscInt i = 0; i < n; i++) multiplier[i] = lists->point_weight[point[i]];
  for (PetscInt i = 0; i < n && lists->dim == 2 && lists->point_hoop; i++) hoop[i] = lists->point_hoop[point[i]];
  PointsSeen(lists, n, point, &lists->slave_X[q * lists->dim], &lists->slave_u[q * lists->dim], x);
}

/*@
  ContactPointEvaluate - evaluates gap and, if wanted, a variation over the fit points of one slave point, into the
  work's result.

  Not collective

  Input Parameters:
+ pair     - the pair
. smoother - the pair's own, or its facets
. lists    - lists with the present positions
. q        - the slave point
. seed     - facet of the previous evaluation, or -1
- want     - the variation that is wanted

  Output Parameter:
. found - PETSC_FALSE where no master is near
@*/
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
    PetscCall(PetscFree3(work->x, work->multiplier, work->hoop));
    PetscCall(PetscMalloc3(work->x_room * dim + POINT_SEEN_PADDING, &work->x, work->x_room, &work->multiplier,
                           work->x_room, &work->hoop));
  }
  GatherPoints(lists, q, work->x, work->multiplier, work->hoop);
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
                           .hoop        = work->hoop,
                           .frame       = &lists->frame[9 * q],
                           .metric      = &lists->metric[4 * q],
                           .bend        = lists->bend ? &lists->bend[q] : NULL,
                           .lift        = lists->lift ? lists->lift[q] : 0,
                           .derivatives = pair->fit.derivatives,
                           .workspace   = work->workspace};
  *found = in.n_facets && smoother->evaluate(&in, want, &work->result) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a row of n nodes to the map; node a lies on image side[a], and all of them on `image`, with their radius
   multiplied by the cosine of an angle. */
static void MapAddRow(const ContactPair *pair, int row, int image, PetscReal cosine, PetscInt n, const PetscInt *nodes,
                      const int *side, const PetscReal *S)
{
  ContactWork     *work = pair->work;
  ContactMap      *map  = &work->map;
  const PetscReal *sign = pair->images[image].sign;
  int              k    = map->ptr[row];

  for (PetscInt a = 0; a < n; a++, k++) {
    map->node[k] = work->slot[nodes[a]];
    map->S[k]    = S[a];
    for (int d = 0; d < 3; d++) map->sign[3 * k + d] = sign[d] * pair->images[side[a]].sign[d];
    map->sign[3 * k] *= cosine;
  }
  map->run[row]     = row;
  map->ptr[row + 1] = k;
}

/* Adds a row with the nodes and signs of the row before. */
static void MapRepeatRow(ContactMap *map, int row, const PetscReal *S)
{
  const int k = map->ptr[row], n = k - map->ptr[row - 1];

  for (int a = 0; a < n; a++) map->S[k + a] = S[a];
  map->run[row]     = map->run[row - 1];
  map->ptr[row + 1] = k + n;
}

/* Adds the row of fit point p; the row before is that of fit point `before`, or of none (-1). */
static void MapAddPoint(const ContactPair *pair, NeighbourLists lists, int row, PetscInt p, PetscInt before)
{
  const PetscInt first = lists->point_ptr[p];

  if (before >= 0 && lists->point_alike[p] == lists->point_alike[before])
    MapRepeatRow(&pair->work->map, row, &lists->point_S[first]);
  else
    MapAddRow(pair, row, lists->point_image[p], lists->point_cosine ? lists->point_cosine[p] : 1,
              lists->point_ptr[p + 1] - first, &lists->point_node[first], &lists->point_side[first],
              &lists->point_S[first]);
}

/* Fills the map of the last evaluation with the nodes' slots. */
static void MapFill(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  ContactWork    *work = pair->work;
  const PetscInt *list = &lists->list_point[lists->list_ptr[q]], own = lists->slave_ptr[q];

  work->map.ptr[0] = 0;
  MapAddRow(pair, 0, 0, 1, lists->slave_ptr[q + 1] - own, &lists->slave_node[own], &lists->slave_side[own],
            &lists->slave_S[own]);
  for (int i = 0; i < work->result.n; i++)
    MapAddPoint(pair, lists, 1 + i, list[work->result.points[i]], i ? list[work->result.points[i - 1]] : -1);
}

/* Number of entries that the map of the last evaluation has. */
static PetscInt MapEntries(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  PetscInt entries = lists->slave_ptr[q + 1] - lists->slave_ptr[q];

  for (int i = 0; i < pair->work->result.n; i++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + pair->work->result.points[i]];

    entries += lists->point_ptr[p + 1] - lists->point_ptr[p];
  }
  return entries;
}

/* Adds the nodes of fit point p to the list of nodes; those of fit point `before` (-1: none) are there. */
static void NodesAddPoint(const ContactPair *pair, NeighbourLists lists, PetscInt p, PetscInt before)
{
  if (before >= 0 && lists->point_alike[p] == lists->point_alike[before]) return;
  ContactWorkNodesAdd(pair->work, lists->point_ptr[p + 1] - lists->point_ptr[p],
                      &lists->point_node[lists->point_ptr[p]]);
}

/*@
  ContactPointToNodes - carries the first variation of the last evaluation from points to contact nodes, into the
  work's number and N.

  Not collective

  Input Parameters:
+ pair  - the pair
. lists - lists that the point was evaluated with
- q     - the slave point that was evaluated

  Note:
  Each node occurs once.
@*/
PetscErrorCode ContactPointToNodes(const ContactPair *pair, NeighbourLists lists, PetscInt q)
{
  const PetscInt *list = &lists->list_point[lists->list_ptr[q]];
  ContactWork    *work = pair->work;
  FitDerivatives  map;

  PetscFunctionBeginUser;
  PetscCall(ContactWorkReserveMap(work, lists->n_nodes, 1 + work->result.n, MapEntries(pair, lists, q)));
  work->count = 0;
  ContactWorkNodesAdd(pair->work, lists->slave_ptr[q + 1] - lists->slave_ptr[q],
                      &lists->slave_node[lists->slave_ptr[q]]);
  for (int i = 0; i < work->result.n; i++)
    NodesAddPoint(pair, lists, list[work->result.points[i]], i ? list[work->result.points[i - 1]] : -1);
  MapFill(pair, lists, q);
  ContactWorkNodesEnd(pair->work);
  if (work->count > work->room) {
    work->room = 2 * work->count;
    PetscCall(PetscFree(work->N));
    PetscCall(PetscMalloc1(work->room * lists->dim, &work->N));
  }
  map = ContactWorkMap(work, work->count);
  FitDerivativesFirst(lists->dim, work->result.n, work->result.N, &map, work->N);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSecondBegin - begins a sum of second variations over the nodes of a block.

  Not collective

  Input Parameters:
+ pair   - the pair, after ContactWorkBlockBegin()
. nodes  - nodes of the block
- points - slave points that are added at most; as many vectors may be added with FitDerivativesAddOuter()
@*/
PetscErrorCode ContactSecondBegin(const ContactPair *pair, PetscInt nodes, PetscInt points)
{
  ContactWork *work = pair->work;
  const int    dim  = pair->mesh->dim;
  const int    degree =
    pair->fit.fitted ? FitDegreeCode(&pair->fit, pair->fit.degree) : 1; /* facets need no more than the sum's head */
  const int  dense = PetscMax(pair->smoother->dense_capacity, pair->facets->dense_capacity);
  const int  depth = (int)points * (1 + PetscMax(FitDerivativesDepth(dim, degree), dim * (1 + dense)));
  const long room  = FitDerivativesWorkspace(dim, degree, (int)nodes, depth);

  PetscFunctionBeginUser;
  if (room > work->sum_room) {
    work->sum_room = 2 * (PetscInt)room;
    PetscCall(PetscFree(work->sum_workspace));
    PetscCall(PetscMalloc1(work->sum_room, &work->sum_workspace));
  }
  PetscCall(ContactWorkReserveBlock(work, nodes * dim));
  FitDerivativesBegin(&work->sum, dim, degree, (int)nodes, depth, work->sum_workspace);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSecondAdd - evaluates a slave point and adds factor times its second variation to the sum.

  Not collective

  Input Parameters:
+ pair   - the pair, after ContactSecondBegin()
. q      - the slave point
- factor - for example minus the point's force

  Input/Output Parameter:
. own - own[n_points] of all fit points: the parts that belong to fit points one by one are added here, for
        ContactOwnToNodes(); not used where the master is not fitted

  Output Parameter:
. found - PETSC_FALSE where no master is near
@*/
PetscErrorCode ContactSecondAdd(const ContactPair *pair, PetscInt q, PetscReal factor,
                                double (*own)[FIT_DERIVATIVES_OWN], PetscBool *found)
{
  ContactWork   *work  = pair->work;
  NeighbourLists lists = pair->lists;
  FitDerivatives fit;

  PetscFunctionBeginUser;
  if (pair->fit.fitted) TimingBegin(TIMING_FIT);
  PetscCall(ContactPointEvaluate(pair, pair->smoother, lists, q, pair->seed[q], SMOOTHER_SECOND_VARIATION, found));
  if (pair->fit.fitted) TimingEnd(TIMING_FIT);
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactWorkReserveMap(work, lists->n_nodes, 1 + work->result.n, MapEntries(pair, lists, q)));
  MapFill(pair, lists, q);
  fit = ContactWorkMap(work, work->sum.n_nodes);
  if (work->result.factored) {
    FitDerivativesAdd(&work->sum, factor, &work->result.factors, &fit);
    for (int i = 0; i < work->result.n; i++)
      FitDerivativesOwn(factor, &work->result.factors, i,
                        own[lists->list_point[lists->list_ptr[q] + work->result.points[i]]]);
  } else
    FitDerivativesAddDense(&work->sum, factor, work->result.n, work->result.M, &fit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactSecondEnd - writes the sum into the work's M.

  Not collective

  Input Parameter:
. pair - the pair, after ContactSecondBegin()
@*/
void ContactSecondEnd(const ContactPair *pair)
{
  FitDerivativesEnd(&pair->work->sum, pair->work->M);
}

/*@
  ContactPointsToNodes - lists the contact nodes of fit points first to end - 1, into the work's number.

  Not collective

  Input Parameters:
+ pair  - the pair
. first - first fit point
- end   - one past the last
@*/
PetscErrorCode ContactPointsToNodes(const ContactPair *pair, PetscInt first, PetscInt end)
{
  PetscFunctionBeginUser;
  PetscCall(ContactWorkReserveMap(pair->work, pair->lists->n_nodes, (int)(end - first),
                                  pair->lists->point_ptr[end] - pair->lists->point_ptr[first]));
  pair->work->count = 0;
  for (PetscInt p = first; p < end; p++) NodesAddPoint(pair, pair->lists, p, p > first ? p - 1 : -1);
  ContactWorkNodesEnd(pair->work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactOwnToNodes - sums the second variations that belong to fit points first to end - 1 over a block, into the
  work's M.

  Not collective

  Input Parameters:
+ pair  - the pair, after ContactWorkBlockBegin() with the nodes of these points
. nodes - nodes of the block
. first - first fit point
. end   - one past the last
- own   - of all fit points, summed over slave points by ContactSecondAdd()
@*/
PetscErrorCode ContactOwnToNodes(const ContactPair *pair, PetscInt nodes, PetscInt first, PetscInt end,
                                 const double (*own)[FIT_DERIVATIVES_OWN])
{
  const int      dim  = pair->mesh->dim;
  ContactWork   *work = pair->work;
  FitDerivatives map;

  PetscFunctionBeginUser;
  PetscCall(ContactWorkReserveBlock(work, nodes * dim));
  PetscCall(PetscArrayzero(work->M, PetscSqr(nodes * dim)));
  work->map.ptr[0] = 0;
  for (PetscInt p = first; p < end; p++) MapAddPoint(pair, pair->lists, (int)(p - first), p, p > first ? p - 1 : -1);
  map = ContactWorkMap(work, nodes);
  FitDerivativesAddOwn(dim, 0, (int)(end - first), &own[first], &map, work->M);
  PetscFunctionReturn(PETSC_SUCCESS);
}
