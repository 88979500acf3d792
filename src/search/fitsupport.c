/* Fits of a pair's slave points: spacing, support, and the ladder of fall-backs until every guard of the fit holds. */
#include "smooth/fitframe.h"
#include "searchimpl.h"
#include "flank.h"
#include "pointseen.h"
#include "base/smoothstep.h"
#include "base/timing.h"

/* Points are gathered a little beyond the support, up to this rho^2, so that points which enter during a solve are
   in the list. */
#define SEARCH_FIT_MARGIN PetscSqr(1 + NEIGHBOUR_LISTS_MARGIN)
/* On regular meshes points lie exactly on the border of the support. Points that are beyond it by no more than this
   still count as inside, so that round-off decides nothing. */
#define SEARCH_FIT_TIE 1e-6

/* Where any side of the bodies may meet any other one, a fit that closes what the facets leave open, or opens what they
   close, by more than this part of a face of the slave is not taken: it is extrapolated past an edge. Sagittas are much
   smaller. */
#define FIT_STRAYS 0.25

/* A fit that misses points in the inner half of its support by more than this part of their spacing is not taken: it is
   no surface through them. Few long faces that meet at corners make such fits. Of 57 scenes the largest miss is 0.12,
   at the rim of a cone; three faces of a drawing die had 5. */
#define FIT_MISSES 0.25

/* Up to this angle to the frame's normal points count in full where they fade towards another flank: cos 45 degrees. A
   polynomial of degree 4 follows an arc up to there within 1.2 % of its radius, and up to 60 degrees within 5.5 %. */
#define FIT_FLANK_FULL 0.70710678118654752

/* The ladder of fall-backs: wider supports, then lower degrees, until every guard holds. Degree 0 means the degree
   of the scene. A linear fit, the last rung, is a chord across what bends: it is wrong by the sagitta of its whole
   support, where the facets are wrong by that of one face. Past a free edge of the master all its points lie on one
   side, and it is not taken. Past the end of a bore chords closed gaps that are open, by several times the overlap of a
   press fit. Where points lie in a plane the facets tell the same, but for what bends under the contact, and lists went
   to and fro between both past the end of a keyway: a loose key with friction took 209 iterations instead of 104. */
static const struct {
  int    degree;
  double widen;
} Ladder[RUNGS] = {{0, 1}, {0, 1.15}, {0, 1.32}, {0, 1.52}, {0, 1.75}, {2, 1}, {2, 1.32}, {1, 1}};

/*@
  FitDegreeCode - returns the code by which the fit's kernel knows a degree: FIT_REVOLVED is added for fits of
  revolution.

  Not collective

  Input Parameters:
+ fit    - the settings
- degree - 1, 2 or 4
@*/
int FitDegreeCode(const FitSettings *fit, int degree)
{
  return degree + (fit->revolved ? FIT_REVOLVED : 0);
}

/* Unit normal at the centre of a candidate in the reference position. */
static void ReferenceNormal(NeighbourLists lists, const Candidate *c, PetscReal normal[3])
{
  Candidate at_rest = *c;
  PetscReal x[FACE_MAX_NODES * 3];

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < lists->dim; d++) x[a * lists->dim + d] = lists->point_X[c->facet.nodes[a] * lists->dim + d];
  CandidatePlace(lists->dim, x, 0, &at_rest);
  for (int d = 0; d < 3; d++) normal[d] = at_rest.normal[d];
}

/* Computes the spacing at the quadrature points of a candidate from area and, in 3D, second moments of its face. */
static void FaceSpacing(FitSupport *fit, PetscInt candidate)
{
  const Facet    *facet = &fit->view.facets[candidate];
  const FaceRule *rule  = FaceRuleGet(facet->type, 0);
  const PetscInt  count = fit->view.count[candidate];
  const int       dim   = fit->lists->dim;
  NodeGeometry   *first = &fit->geometry[fit->view.first[candidate]], of_face = {.spacing = 0};
  double          x[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS], centre[3] = {0}, total = 0;

  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    for (int d = 0; d < dim; d++) x[a * dim + d] = fit->view.x[facet->nodes[a] * dim + d];
  FaceRuleAreas(rule, facet->type, dim, GEOMETRY_SOLID, x, area, NULL);
  for (int q = 0; q < rule->n; q++) {
    total += area[q];
    for (int d = 0; d < dim && dim == 3; d++)
      centre[d] += area[q] * fit->view.x[(fit->view.first[candidate] + q) * dim + d];
  }
  for (int q = 0; q < rule->n && dim == 3; q++) {
    double r[3] = {0};

    for (int d = 0; d < dim; d++) r[d] = fit->view.x[(fit->view.first[candidate] + q) * dim + d] - centre[d] / total;
    for (int k = 0; k < 3; k++) {
      of_face.covariance[k] += area[q] / total * r[k] * r[k];
      of_face.covariance[3 + k] += area[q] / total * r[k] * r[(k + 1) % 3]; /* xy yz zx */
    }
  }
  of_face.spacing = total / SurfaceNodesPerFace(facet->type);
  if (dim == 3) of_face.spacing = PetscSqrtReal(of_face.spacing);
  for (PetscInt q = 0; q < count; q++) first[q] = of_face;
}

/*@
  FitSupportCreate - prepares the fits of a pair's slave points: a view of the facets, their links and the workspace.

  Not collective

  Input Parameters:
+ s     - the search
. lists - the lists, whose points are there
- field - the candidates

  Output Parameter:
. fit - the prepared fits
@*/
PetscErrorCode FitSupportCreate(ContactSearch s, NeighbourLists lists, const SearchField *field, FitSupport *fit)
{
  const PetscInt   n          = field->n_candidates;
  const Candidate *candidates = field->candidates;
  NodeGeometry    *node_geometry;
  Facet           *facets;
  PetscReal       *x;
  PetscInt        *first = NULL, *count = NULL;

  PetscFunctionBeginUser;
  *fit = (FitSupport){.s = s, .lists = lists};
  PetscCall(PetscMalloc5(3 * n, &fit->normals, 3 * n, &fit->reference, lists->n_points, &fit->geometry, n, &facets,
                         lists->n_points * lists->dim, &x));
  PetscCall(PetscCalloc1(lists->n_nodes, &node_geometry));
  NeighbourListsPointGeometry(s, lists, field, node_geometry, fit->geometry);
  PetscCall(PetscFree(node_geometry));
  if (s->fit->integral) PetscCall(PetscMalloc2(n, &first, n, &count));
  for (PetscInt i = 0; i < n; i++) {
    facets[i] = candidates[i].facet;
    ReferenceNormal(lists, &candidates[i], &fit->reference[3 * i]);
    for (int d = 0; d < 3; d++) fit->normals[3 * i + d] = candidates[i].normal[d];
    if (!first) continue;
    first[i] = candidates[i].first;
    count[i] = candidates[i].count;
  }
  for (PetscInt i = 0; i < lists->n_points * lists->dim; i++) x[i] = lists->point_X[i] + lists->point_u[i];
  fit->view = (SurfaceView){lists->dim,
                            n,
                            lists->n_points,
                            facets,
                            fit->normals,
                            fit->reference,
                            x,
                            fit->geometry,
                            PetscCosReal(s->fit->feature_angle),
                            first,
                            count,
                            lists->point_hoop};
  for (PetscInt i = 0; i < n && first; i++) FaceSpacing(fit, i);
  PetscCall(NeighbourhoodsCreate(&fit->view, &fit->neighbourhoods));
  PetscCall(CornerNormalsCreate(&fit->view, &fit->corners));
  if (lists->dim == 3 && !s->fit->global_frame) PetscCall(FaceRowsCreate(&fit->view, fit->neighbourhoods, &fit->rows));
  PetscCall(PetscMalloc7(FIT_MAX_POINTS, &fit->points, FIT_MAX_POINTS * 3 + POINT_SEEN_PADDING, &fit->x, FIT_MAX_POINTS,
                         &fit->multiplier, FIT_MAX_POINTS, &fit->taper,
                         FitWorkspace(lists->dim, FitDegreeCode(s->fit, s->fit->degree), FIT_MAX_POINTS),
                         &fit->workspace, FIT_MAX_POINTS, &fit->used, FIT_MAX_POINTS, &fit->hoop));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FitSupportDestroy - frees the prepared fits.

  Not collective

  Input/Output Parameter:
. fit - the prepared fits
@*/
PetscErrorCode FitSupportDestroy(FitSupport *fit)
{
  Facet     *facets = (Facet *)fit->view.facets;
  PetscReal *x      = (PetscReal *)fit->view.x;

  PetscFunctionBeginUser;
  PetscCall(FaceRowsDestroy(&fit->rows));
  PetscCall(CornerNormalsDestroy(&fit->corners));
  PetscCall(NeighbourhoodsDestroy(&fit->neighbourhoods));
  if (fit->view.first) PetscCall(PetscFree2(fit->view.first, fit->view.count));
  PetscCall(PetscFree5(fit->normals, fit->reference, fit->geometry, facets, x));
  PetscCall(PetscFree7(fit->points, fit->x, fit->multiplier, fit->taper, fit->workspace, fit->used, fit->hoop));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The support of a fit in space, with the metric over the frame's tangents as a tensor. In 2D the third direction is
   that of the hoop. */
static void SupportInSpace(const FitProblem *problem, NeighbourhoodSupport *support)
{
  const int dim                 = problem->dim;
  const double(*const frame)[3] = problem->frame, (*const metric)[2] = problem->metric, *along = problem->bend.along;
  PetscReal *space = support->metric;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      space[3 * i + j] = 0;
      for (int a = 0; a < dim - 1; a++)
        for (int b = 0; b < dim - 1; b++) space[3 * i + j] += frame[a][i] * metric[a][b] * frame[b][j];
    }
  }
  if (dim == 2) space[8] = metric[0][0];
  support->bent = (PetscBool)(problem->degree > FIT_BENT);
  memcpy(support->h, problem->bend.h, sizeof(support->h));
  for (int d = 0; d < 3; d++) {
    support->along[d]  = along[0] * frame[0][d] + along[1] * frame[1][d];
    support->across[d] = along[0] * frame[1][d] - along[1] * frame[0][d];
  }
}

/* Adds factor times the covariance of a node to a full matrix. */
static void AddCovariance(double factor, const NodeGeometry *g, double covariance[3][3])
{
  for (int d = 0; d < 3; d++) {
    covariance[d][d] += factor * g->covariance[d];
    covariance[d][(d + 1) % 3] += factor * g->covariance[3 + d];
    covariance[(d + 1) % 3][d] += factor * g->covariance[3 + d];
  }
}

/* Spacing of the points at a foot. Its shape comes from the nodes' covariances, interpolated between the nodes by
   the shape functions, so that the support does not jump from facet to facet and keeps the symmetry of a ring around
   a node. Its size is the mean over the facet's nodes, because nodes on a cut see one side only. */
static void FootSpacing(const FitSupport *fit, PetscInt f, const double *xi, double covariance[3][3], double *area)
{
  const Facet *facet = &fit->view.facets[f];
  const int    n = ElementGet(facet->type)->nodes, dim = fit->lists->dim;
  double       share[FACE_MAX_NODES], total            = 0;

  ElementShape(facet->type, xi, share, NULL, NULL);
  /* Second-order shape functions are negative in places. */
  for (int a = 0; a < n; a++) total += share[a] = PetscMax(share[a], 0);
  *area = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) covariance[i][j] = 0;
  for (int a = 0; a < n; a++) {
    const NodeGeometry *g = &fit->geometry[facet->nodes[a]];
    const double        w = share[a] / total;

    *area += (dim == 3 ? PetscSqr(g->spacing) : g->spacing) / n;
    AddCovariance(w, g, covariance);
  }
}

/* Spacing for a fit through quadrature points: the mean over the faces that it sees. The forces that such a fit
   distributes are consistent nodal loads as far as neighbouring slave points share one support. A support that
   changed from face to face with the local spacing would increase the error of the patch test 2 to 10 times. */
static void WindowSpacing(const FitSupport *fit, PetscInt n, double covariance[3][3], double *area)
{
  NodeGeometry total = {.spacing = 0};
  double       sum = 0, faces = 0;

  for (PetscInt i = 0; i < n; i++) {
    const NodeGeometry *g     = &fit->geometry[fit->points[i]];
    const double        share = fit->taper[i] / (fit->lists->dim == 3 ? PetscSqr(g->spacing) : g->spacing);

    sum += fit->taper[i];
    faces += share;
    for (int k = 0; k < 6; k++) total.covariance[k] += share * g->covariance[k];
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) covariance[i][j] = 0;
  AddCovariance(1, &total, covariance);
  *area = sum / faces;
}

/* Share with which a point counts in a fit. Points of another flank do not, and where the support of a coarse bend
   reaches to them, a point that comes in as the surface turns a little would change the fit by a jump: offsets of a
   bore with 20 faces around changed by 6 % of the sagitta with each new point. */
static PetscReal TurnShare(const PetscReal normal[3], const double e3[3])
{
  const PetscReal cosine = normal[0] * e3[0] + normal[1] * e3[1] + normal[2] * e3[2];

  return SmoothStep((cosine - NEIGHBOURHOOD_COSINE) / (FIT_FLANK_FULL - NEIGHBOURHOOD_COSINE));
}

/* Computes positions and weights of n points. Returns how many are inside the support. */
static PetscInt TakePoints(FitSupport *fit, const FitFoot *at, const double e3[3], PetscInt n, const PetscReal *rho2)
{
  const int              dim  = fit->lists->dim;
  const PetscReal *const hoop = fit->lists->point_hoop, *const v = fit->lists->point_weight;
  const PetscInt *const points     = fit->points;
  PetscReal *const restrict weight = fit->multiplier, *const restrict taper = fit->taper;
  PetscInt inside = 0;

  PointsSeen(fit->lists, n, points, at->X, at->u, fit->x);
  for (PetscInt i = 0; i < n; i++) weight[i] = v[points[i]];
  for (PetscInt i = 0; i < n && fit->s->fit->fades; i++) weight[i] *= TurnShare(fit->geometry[points[i]].normal, e3);
  for (PetscInt i = 0; i < n; i++) {
    inside += rho2[i] <= 1 + SEARCH_FIT_TIE;
    taper[i] = weight[i] * PetscMax(SEARCH_FIT_TIE, 1 - rho2[i] / SEARCH_FIT_MARGIN);
  }
  for (PetscInt i = 0; i < n && dim == 2; i++) fit->hoop[i] = hoop ? hoop[points[i]] : 0;
  return inside;
}

/* Lets a fit follow a row of long faces, by its share. The frame turns from the plane of the points to the mean normal
   of the faces, because the points of a row that bends have no plane of their own; the spacing is that along and across
   the row, and the coordinates bend. */
static void FollowRow(const FaceRow *row, const FitFoot *at, FitProblem *problem, double covariance[3][3], double *area)
{
  double normal[3], along[3] = {0}, across[3], length;

  for (int d = 0; d < 3; d++)
    normal[d] = problem->frame[2][d] + (at->upright ? 0 : row->share) * (row->normal[d] - problem->frame[2][d]);
  FitFrameFromNormal(3, normal, problem->frame);
  if (row->bends > 0) problem->degree += FIT_BENT;
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 3; d++) problem->bend.along[k] += problem->frame[k][d] * row->along[d];
  length = hypot(problem->bend.along[0], problem->bend.along[1]);
  for (int k = 0; k < 2; k++) problem->bend.along[k] /= length;
  memcpy(problem->bend.h, row->h, sizeof(problem->bend.h));
  for (int d = 0; d < 3; d++) {
    along[d]  = problem->bend.along[0] * problem->frame[0][d] + problem->bend.along[1] * problem->frame[1][d];
    across[d] = problem->bend.along[0] * problem->frame[1][d] - problem->bend.along[1] * problem->frame[0][d];
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      covariance[i][j] +=
        row->share * (row->length2 * along[i] * along[j] + row->width2 * across[i] * across[j] - covariance[i][j]);
  *area += row->share * (row->area - *area);
}

/* Does a fit miss the points through which it is made, by more than FIT_MISSES of their spacing? area: of a point, in
   2D its length. */
static PetscBool FitMisses(const FitProblem *problem, const FitResult *result, PetscReal area)
{
  return (PetscBool)(result->missed > FIT_MISSES * (problem->dim == 3 ? PetscSqrtReal(area) : area));
}

/* Tries one rung of the ladder at a foot and writes points, frame and metric into fit and problem. *holds is true if
   every guard holds. Quadrature points come in clusters, so that their number tells nothing; the pivot is the guard
   for them. */
static PetscErrorCode FitRung(FitSupport *fit, const FitFoot *at, int rung, FitProblem *problem, FitResult *result,
                              PetscBool *holds)
{
  const FitSettings *settings = fit->s->fit;
  const int          dim = fit->lists->dim, lower = Ladder[rung].degree,
            degree            = FitDegreeCode(settings, lower ? PetscMin(lower, settings->degree) : settings->degree);
  const int            wanted = settings->integral ? FitTerms(dim, degree) : FitPointsWanted(dim, degree);
  double               covariance[3][3], area;
  const PetscReal     *rho2, support = settings->support * Ladder[rung].widen;
  const PetscBool      upright = (PetscBool)(settings->global_frame || at->upright);
  NeighbourhoodSupport space;
  FaceRow              row = {.share = 0};
  PetscInt             n, found, inside;
  int                  passes;

  PetscFunctionBeginUser;
  *holds = PETSC_FALSE;
  if (at->past && degree % FIT_REVOLVED == 1) PetscFunctionReturn(PETSC_SUCCESS);
  *result  = (FitResult){.points = fit->used};
  *problem = (FitProblem){.dim        = dim,
                          .degree     = degree,
                          .exponent   = settings->exponent,
                          .x          = fit->x,
                          .multiplier = fit->multiplier,
                          .hoop       = fit->hoop};
  FootSpacing(fit, at->facet, at->xi, covariance, &area);
  FitFrameFromNormal(dim, settings->global_frame ? fit->plane : at->outward, problem->frame);
  if (fit->rows) PetscCall(FaceRowsFollow(fit->rows, at->facet, at->foot, problem->frame[2], support, &row));
  /* The first pass sees the points along the facet's normal, the second one along the normal of their own plane and
     with the spacing around them. One is enough where neither is asked for, or where a row of long faces knows both. */
  passes = row.share == 1 || (upright && !settings->integral) ? 1 : 2;
  for (int pass = 1; pass <= passes; pass++) {
    if (pass == passes && row.share > 0) FollowRow(&row, at, problem, covariance, &area);
    FitMetricFromCovariance(dim, problem->frame, covariance, area, support, problem->metric);
    SupportInSpace(problem, &space);
    PetscCall(NeighbourhoodGather(fit->neighbourhoods, at->facet, at->foot, problem->frame[dim - 1], &space,
                                  SEARCH_FIT_MARGIN, FIT_MAX_POINTS, fit->points, &rho2, &n, &found));
    inside     = TakePoints(fit, at, problem->frame[dim - 1], n, rho2);
    problem->n = (int)n;
    if (inside < wanted) PetscFunctionReturn(PETSC_SUCCESS);
    if (pass == passes) break;
    if (settings->integral) WindowSpacing(fit, n, covariance, &area);
    if (!upright && !FitFrame(dim, problem->n, fit->x, fit->taper, at->outward, problem->frame) && row.share == 0)
      PetscFunctionReturn(PETSC_SUCCESS);
  }
  *holds =
    DiffuseFitEvaluate(problem, FIT_GAP, fit->workspace, result) && (result->guards & ~FIT_FEW_POINTS) == FIT_HOLDS
      ? PETSC_TRUE
      : PETSC_FALSE;
  if (*holds && FitMisses(problem, result, area)) *holds = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FitSupportClimb - goes down the ladder of fall-backs until a fit holds.

  Not collective

  Input Parameters:
+ fit   - the prepared fits
. at    - where the fit is made
- first - rung to begin with

  Output Parameters:
+ problem - the fit, with arrays that belong to fit
. result  - its surface and guards, likewise
- rung    - the rung on which the fit holds; RUNG_FACET if none does

  Note:
  None is made on a facet at the tip of a fold. It would know one side of it only and go on past the tip, where the
  sides are nearer to each other than fits are to their facets.
@*/
PetscErrorCode FitSupportClimb(FitSupport *fit, const FitFoot *at, int first, FitProblem *problem, FitResult *result,
                               int *rung)
{
  PetscBool holds = PETSC_FALSE;

  PetscFunctionBeginUser;
  *rung = RUNG_FACET;
  if (NeighbourhoodsIsFolded(fit->neighbourhoods, at->facet)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int r = first; r < RUNGS && !holds; r++) {
    PetscCall(FitRung(fit, at, r, problem, result, &holds));
    if (holds) *rung = r;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a fit say of contact what the facets deny by far? */
static PetscBool FitStrays(const Nearest *look, const FitResult *result)
{
  return (PetscBool)((result->gap < 0) != (look->foot.gap < 0) &&
                     PetscAbsReal(result->gap - look->foot.gap) > FIT_STRAYS * look->size);
}

/* Is the slave point past an end of the master: its foot on the facets lies on an edge of the nearest one at which the
   flank ends, and the way to it leads along that facet? */
static PetscBool FootPast(const Nearest *look, int ends)
{
  const Foot      *foot   = &look->foot;
  const Candidate *best   = &look->candidates[look->best];
  const PetscBool  edge   = (PetscBool)(look->lists->dim == 2 || foot->region == FOOT_EDGE);
  PetscReal        cosine = 0;

  if (foot->beyond > 0) return PETSC_TRUE;
  if (foot->region == FOOT_INTERIOR || !(edge ? ends >> foot->feature & 1 : ends)) return PETSC_FALSE;
  for (int d = 0; d < look->lists->dim; d++) cosine += foot->normal[d] * best->normal[d];
  return (PetscBool)(PetscAbsReal(foot->gap) * PetscSqrtReal(PetscMax(0, 1 - cosine * cosine)) >
                     SEARCH_FIT_TIE * look->size);
}

/* Has a fit keep its frame, where it is to, unless the nearest facet belongs to another flank than that. */
static void KeepFrame(const FitSupport *fit, PetscInt q, FitFoot *at)
{
  const PetscReal *kept   = fit->s->kept ? &fit->s->kept[3 * q] : NULL;
  PetscReal        cosine = 0;

  for (int d = 0; d < fit->lists->dim && kept; d++) cosine += kept[d] * at->outward[d];
  if (cosine <= NEIGHBOURHOOD_COSINE) return;
  at->upright = PETSC_TRUE;
  for (int d = 0; d < fit->lists->dim; d++) at->outward[d] = kept[d];
}

/*@
  FitSupportLift - lifts the facets to the smooth surface where they serve a slave point past an end of a flank or
  beside a sharp edge.

  Not collective

  Input Parameters:
+ fit  - the prepared fits
. look - the slave point's nearest facet and foot
- q    - the slave point

  Note:
  It is the height of the smooth surface over the facet at the point of it that is nearest to the slave point. Fits at a
  slave point past the end are extrapolated to it, and their guards may refuse all of them. The facets would then serve
  there and fits beside it, and contact would begin at a sagitta too soon or too late: a coarse pin with a clearance
  below the sagitta of its hole was held by the few points that stand out of the hole.
@*/
PetscErrorCode FitSupportLift(FitSupport *fit, const Nearest *look, PetscInt q)
{
  NeighbourLists   lists = fit->lists;
  const Candidate *best  = &look->candidates[look->best];
  FitFoot          at    = {.facet = look->best, .past = PETSC_TRUE};
  Foot             foot;
  FitProblem       problem;
  FitResult        result;
  int              rung;

  PetscFunctionBeginUser;
  FlankFoot(look, best, &foot);
  for (int k = 0; k < 2; k++) at.xi[k] = foot.xi[k];
  for (int d = 0; d < 3; d++) at.outward[d] = best->normal[d];
  for (int d = 0; d < lists->dim; d++) at.X[d] = at.foot[d] = look->x[d] - foot.gap * foot.normal[d];
  PetscCall(FitSupportClimb(fit, &at, RUNG_PLAIN, &problem, &result, &rung));
  if (rung == RUNG_FACET || PetscAbsReal(result.gap) > FIT_STRAYS * look->size) PetscFunctionReturn(PETSC_SUCCESS);
  if (!lists->lift) PetscCall(PetscCalloc1(lists->n_slaves, &lists->lift));
  lists->lift[q] = -result.gap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FitSupportSlave - fits the surface for one slave point and writes a fit that holds into its list.

  Not collective

  Input Parameters:
+ fit   - the prepared fits
. look  - the slave point's nearest facet and foot
. q     - the slave point
. ends  - convex edges of that facet at which the flank ends, besides its free ones, as bits like free_edges
- first - start of its list of points

  Input/Output Parameter:
. buffer - the growing lists

  Note:
  Without a fit the rung of the slave point is RUNG_FACET, and its list is left as it is.
@*/
PetscErrorCode FitSupportSlave(FitSupport *fit, const Nearest *look, PetscInt q, int ends, PetscInt first,
                               ListBuffer *buffer)
{
  NeighbourLists lists = fit->lists;
  FitFoot        at    = {.facet = look->best, .xi = {look->foot.xi[0], look->foot.xi[1]}};
  FitProblem     problem;
  FitResult      result;

  PetscFunctionBeginUser;
  /* The foot's own normal may lie along the surface where the foot is on an edge. */
  for (int d = 0; d < 3; d++) at.outward[d] = look->candidates[look->best].normal[d];
  for (int d = 0; d < lists->dim; d++) {
    at.X[d]    = lists->slave_X[q * lists->dim + d];
    at.u[d]    = lists->slave_u[q * lists->dim + d];
    at.foot[d] = look->x[d] - look->foot.gap * look->foot.normal[d];
  }
  at.past = FootPast(look, ends | look->candidates[look->best].facet.free_edges);
  KeepFrame(fit, q, &at);
  TimingBegin(TIMING_FIT); /* these two readings of the clock cost 0.1 % of a ladder */
  PetscCall(FitSupportClimb(fit, &at, fit->s->first_rung ? fit->s->first_rung[q] : RUNG_PLAIN, &problem, &result,
                            &lists->rung[q]));
  if (look->listed && lists->rung[q] != RUNG_FACET && FitStrays(look, &result)) lists->rung[q] = RUNG_FACET;
  if (lists->rung[q] == RUNG_FACET && at.past) PetscCall(FitSupportLift(fit, look, q));
  TimingEnd(TIMING_FIT);
  if (lists->rung[q] == RUNG_FACET) PetscFunctionReturn(PETSC_SUCCESS);
  lists->fit_n[q]     = problem.n;
  lists->degree[q]    = problem.degree;
  lists->pivot[q]     = result.pivot;
  lists->amplified[q] = result.amplified;
  lists->gap[q]       = result.gap;
  for (int d = 0; d < 3; d++) lists->normal[3 * q + d] = result.normal[d];
  lists->residual[q] = result.missed;
  for (int i = 0; i < 9; i++) lists->frame[9 * q + i] = problem.frame[i / 3][i % 3];
  for (int i = 0; i < 4; i++) lists->metric[4 * q + i] = problem.metric[i / 2][i % 2];
  if (problem.degree > FIT_BENT) {
    if (!lists->bend) PetscCall(PetscCalloc1(lists->n_slaves, &lists->bend));
    lists->bend[q] = problem.bend;
  }
  PetscCall(ListBufferAddPoints(buffer, first, problem.n, fit->points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchFitReach - returns how far from a slave point the points of its fit may lie (length).

  Not collective

  Input Parameter:
. s - the search

  Note:
  It is the widest support with its margin, along the longest face where faces are elongated. It is 0 where there are no
  fits.
@*/
PetscReal SearchFitReach(ContactSearch s)
{
  return s->fit->fitted ? PetscSqrtReal(SEARCH_FIT_MARGIN) * Ladder[RUNG_WIDER].widen * s->fit->support *
                            s->master->max_extent / s->master->order
                        : 0;
}
