/* Signed distance to a union of facets: choice of the foot among the facets, gap, first and second variation.

   Sign. In the interior of a facet the facet's own normal decides. At an edge or a corner the sum of the normals of all
   facets that have this closest point decides, weighted by their angles there (Baerentzen and Aanaes, "Signed distance
   computation using the angle weighted pseudonormal", 2005).

   Variations. Let r = x_slave - x(xi), D = dr / d(positions) at fixed xi, and F = min |r|^2 / 2 = g^2 / 2 over the free
   parameters xi_a. The envelope theorem gives
       dg  = n.D
       d2F = D^T D - (T + g S)_a (H^-1)_ab (T + g S)_b^T
   with T_a = D^T x_,a, S_a the derivatives of the shape functions times n, H = a - g kappa, a the metric and kappa =
   n.x_,ab. From d2F = dg dg^T + g d2g and D^T D = D^T (n n^T + x_,a a^ab x_,b^T + W) D follows
       d2g = - T_a (a^-1 kappa H^-1)_ab T_b^T - (H^-1)_ab (T_a S_b^T + S_a T_b^T)
             - g S_a (H^-1)_ab S_b^T + D^T W D / g
   W is the projection on the directions that are neither normal nor tangent: none in the interior, one at an edge, two
   at a corner. In the interior these are the expressions of Laursen and Simo (1993) and of Wriggers, "Computational
   Contact Mechanics". The last term alone is singular for g -> 0 at an edge or corner. Times g it is bounded but has no
   limit, like the direction n. It is therefore left out within FACET_TOUCHING.

   Extension. Beyond a free edge x(xi) is the same polynomial outside its polygon, so that nothing else changes. A
   foot on a free edge, away from its corners, may leave it, and the lateral sides are released. On a flat facet this
   is the normal projection. A foot in a corner keeps the sides that are not free: the crease between two facets is
   continued, and both facets agree on it. The gap is continuous where the edge lies on a flat part of the surface or
   runs square to the creases. Past other corners it may jump by the angle of the crease times `beyond`. */
#include "facetpolynomial.h"
#include <math.h>
#include <string.h>

enum { MAX_DOFS = 3 * (1 + FACE_MAX_NODES) };

/* A facet that may hold the closest point. */
typedef struct {
  const Facet         *facet;
  int                  index, feature;
  FootRegion           region;
  double               size, distance;
  FacetPolynomialPoint point;
} Candidate;

static double FacetDistance(const double a[3], const double b[3])
{
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

  return sqrt(Dot(d, d));
}

/* Is candidate a preferred to b? The nearer one is preferred, then the one with the better defined region, then the
   one with the smaller tag. */
static int Preferred(const Candidate *a, const Candidate *b)
{
  const double tie = FACET_TIE * (fmax(a->size, b->size) + fmin(a->distance, b->distance));

  if (fabs(a->distance - b->distance) > tie) return a->distance < b->distance;
  if (a->region != b->region) return a->region < b->region;
  return a->facet->tag < b->facet->tag;
}

/* Completes a candidate whose closest point is known. */
static void Consider(const FacetPolynomial *patch, Candidate *candidate)
{
  candidate->size     = patch->size;
  candidate->distance = sqrt(Dot(candidate->point.x, candidate->point.x));
  FacetPolynomialClassify(patch, &candidate->point, &candidate->region, &candidate->feature);
}

/* Free sides of a candidate on which its foot lies. */
static unsigned FreeSides(const Candidate *candidate)
{
  return candidate->region == FOOT_INTERIOR ? 0 : candidate->point.active & (unsigned)candidate->facet->free_edges;
}

/* Does the foot of a candidate lie on a side at which the list is cut? */
static int IsCut(const Candidate *candidate)
{
  return candidate->region != FOOT_INTERIOR && candidate->point.active & (unsigned)candidate->facet->cut_edges;
}

/* Takes a foot to be outside, if it is not. */
static void TakeOutside(int dim, Foot *foot)
{
  if (foot->gap >= 0) return;
  foot->gap = -foot->gap;
  for (int k = 0; k < dim; ++k) foot->normal[k] = -foot->normal[k];
}

/* Lets the foot of a candidate leave its facet across its free sides. *ended is set where the foot reached the end
   of the extension. */
static void Extend(int dim, const double *x, Candidate *candidate, int *ended)
{
  const unsigned  free_sides = FreeSides(candidate), active = candidate->point.active;
  double          limit[FACET_POLYNOMIAL_MAX_SIDES] = {0};
  FacetPolynomial patch;

  FacetPolynomialOfFacet(dim, candidate->facet, x, &patch);
  for (int s = 0; s < patch.domain->sides; ++s) {
    const int opposite = patch.domain->sides != 3 && active == 1u
                                                                 << (s + patch.domain->sides / 2) % patch.domain->sides;
    const int lateral = !(active & (active - 1)) && !opposite;

    if (!(free_sides & (1u << s) || lateral)) continue;
    limit[s] = -FACET_EXTENSION * patch.domain->width;
    candidate->point.active &= ~(1u << s);
  }
  FacetPolynomialDescend(&patch, limit, &candidate->point);
  Consider(&patch, candidate);
  *ended = 0;
  for (int s = 0; s < patch.domain->sides; ++s)
    if (candidate->region != FOOT_INTERIOR && candidate->point.active & (1u << s) && limit[s] < 0) *ended = 1;
}

/* Gap and normal of a foot. The direction pseudo distinguishes outside from inside where the foot has no normal of
   its own. */
static void SetGap(int dim, const double *x, const Candidate *candidate, const double pseudo[3], Foot *foot)
{
  const double   *at = candidate->point.x, length = sqrt(Dot(pseudo, pseudo));
  double          own[3], sign;
  FacetPolynomial patch;

  foot->facet     = candidate->index;
  foot->region    = candidate->region;
  foot->feature   = candidate->feature;
  foot->converged = candidate->point.converged;
  memcpy(foot->xi, candidate->point.xi, sizeof(foot->xi));
  FacetPolynomialOfFacet(dim, candidate->facet, x, &patch);
  FacetPolynomialNormal(&patch, candidate->point.xi, own);
  if (candidate->region == FOOT_INTERIOR) {
    foot->gap = -Dot(own, at);
    memcpy(foot->normal, own, sizeof(own));
    return;
  }
  sign      = -Dot(pseudo, at) < 0 ? -1 : 1;
  foot->gap = sign * candidate->distance;
  for (int k = 0; k < 3; ++k) {
    if (candidate->distance > FACET_TOUCHING * candidate->size)
      foot->normal[k] = -at[k] / foot->gap;
    else
      foot->normal[k] = length > 0 ? pseudo[k] / length : own[k];
  }
  if (Dot(foot->normal, foot->normal) == 0) foot->normal[dim - 1] = 1; /* the facet has no area: any direction serves */
}

/* Adds the normal of a candidate at its foot, weighted by its angle there or by 1. */
static void AddNormal(int dim, const double *x, const Candidate *candidate, int weighted, double pseudo[3])
{
  FacetPolynomial patch;
  double          normal[3], weight;

  FacetPolynomialOfFacet(dim, candidate->facet, x, &patch);
  FacetPolynomialNormal(&patch, candidate->point.xi, normal);
  weight = weighted ? FacetPolynomialAngle(&patch, &candidate->point) : 1;
  for (int k = 0; k < 3; ++k) pseudo[k] += weight * normal[k];
}

/* Determines the foot from the candidates that hold the closest point. */
static void Decide(int dim, const double *x, int n, const Candidate candidates[], Foot *foot)
{
  const Candidate *best = &candidates[0], *edge = NULL;
  double           pseudo[3] = {0}, free_pseudo[3] = {0};
  Candidate        extended = {.size = 0};
  int              ended = 0, cut = 0;

  for (int i = 1; i < n; ++i)
    if (Preferred(&candidates[i], best)) best = &candidates[i];
  foot->beyond = 0;
  for (int i = 0; best->region != FOOT_INTERIOR && i < n; ++i) {
    const Candidate *c = &candidates[i];

    if (FacetDistance(c->point.x, best->point.x) > FACET_COINCIDENT * best->size) continue;
    AddNormal(dim, x, c, 1, pseudo);
    cut |= IsCut(c);
    if (FreeSides(c)) {
      Candidate trial = *c;
      int       trial_ended;

      AddNormal(dim, x, c, 0, free_pseudo);
      Extend(dim, x, &trial, &trial_ended);
      if (edge && !Preferred(&trial, &extended)) continue;
      edge     = c;
      extended = trial;
      ended    = trial_ended;
    }
  }
  if (!edge) {
    SetGap(dim, x, best, pseudo, foot);
    if (cut) TakeOutside(dim, foot);
    return;
  }
  SetGap(dim, x, &extended, free_pseudo, foot);
  foot->beyond = FacetDistance(extended.point.x, edge->point.x);
  if (ended) {
    foot->beyond = fmax(foot->beyond, extended.size);
    TakeOutside(dim, foot);
  }
}

/* Adds a candidate and drops those that can no longer coincide with the closest point. Returns the new count. */
static int Insert(const Candidate *candidate, double least, int n, Candidate candidates[])
{
  int kept = 0;

  for (int i = 0; i < n; ++i)
    if (candidates[i].distance <= least + FACET_COINCIDENT * candidates[i].size) candidates[kept++] = candidates[i];
  if (candidate->distance > least + FACET_COINCIDENT * candidate->size) return kept;
  if (kept == FACET_TIES) kept -= candidate->distance <= least;
  if (kept < FACET_TIES) candidates[kept++] = *candidate;
  return kept;
}

/* The facet whose centre is nearest to the slave point. */
static int NearestCentre(int dim, int n, const Facet facets[], const double *x)
{
  double least   = INFINITY;
  int    nearest = 0;

  for (int i = 0; i < n; ++i) {
    const int corners   = ElementGet(facets[i].type)->corners;
    double    centre[3] = {0}, distance2;

    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < dim; ++k) centre[k] += x[(size_t)facets[i].nodes[a] * dim + k];
    distance2 = Dot(centre, centre) / (corners * corners);
    if (distance2 < least) {
      least   = distance2;
      nearest = i;
    }
  }
  return nearest;
}

/*@
  FacetClosest - finds the closest point over a list of facets, with its signed distance and normal.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. n      - number of facets
. facets - the list
. x      - positions of the nodes relative to the slave point, x[node][dim] (length)
- seed   - index of the facet to be tried first (that of the last foot), or -1; the result does not depend on it

  Output Parameter:
. foot - facet, foot point, gap and normal

  Note:
  Returns 1, or 0 if the list is empty; foot is then left as it is. Plain C.
@*/
int FacetClosest(int dim, int n, const Facet *facets, const double *x, int seed, Foot *foot)
{
  Candidate candidates[FACET_TIES];
  double    least = INFINITY;
  int       count = 0;

  if (n <= 0) return 0;
  if (seed < 0 || seed >= n) seed = NearestCentre(dim, n, facets, x);
  for (int k = 0; k < n; ++k) {
    const int             i = k == 0 ? seed : k <= seed ? k - 1 : k;
    double                X[FACE_MAX_NODES][3];
    Candidate             candidate = {.facet = &facets[i], .index = i};
    FacetPolynomialSphere sphere;
    FacetPolynomial       patch;

    FacetPolynomialGather(dim, &facets[i], x, X);
    FacetPolynomialBound(facets[i].type, X, &sphere);
    if (sqrt(Dot(sphere.centre, sphere.centre)) - sphere.radius > least + 2 * FACET_COINCIDENT * sphere.radius)
      continue;
    FacetPolynomialCreate(facets[i].type, X, 2 * sphere.radius, &patch);
    FacetPolynomialClosest(&patch, &candidate.point);
    Consider(&patch, &candidate);
    least = fmin(least, candidate.distance);
    count = Insert(&candidate, least, count, candidates);
  }
  Decide(dim, x, count, candidates, foot);
  return 1;
}

/*@
  FacetProject - finds the closest point of one facet.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet
- x     - positions of the nodes, as in FacetClosest()

  Output Parameter:
. foot - foot point, gap and normal

  Note:
  There are no neighbours that decide the side of an edge. The facet's own normal decides it. Plain C.
@*/
void FacetProject(int dim, const Facet *facet, const double *x, Foot *foot)
{
  FacetClosest(dim, 1, facet, x, 0, foot);
}

/*@
  FacetSize - computes the largest extent of a facet (length): the diameter of a sphere that holds it, also between its
  nodes.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet
- x     - positions of the nodes, as in FacetClosest()

  Note:
  Plain C.
@*/
double FacetSize(int dim, const Facet *facet, const double *x)
{
  double                X[FACE_MAX_NODES][3];
  FacetPolynomialSphere sphere;

  FacetPolynomialGather(dim, facet, x, X);
  FacetPolynomialBound(facet->type, X, &sphere);
  return 2 * sphere.radius;
}

/*@
  FacetFirstVariation - computes the first variation of the gap, dg = N.d(positions).

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet that holds the foot
. x     - positions of the nodes, as in FacetClosest()
- foot  - of FacetClosest()

  Output Parameter:
. N - N[(1+nodes)*dim], without unit: the slave point first, then the facet's nodes in its order

  Note:
  N is (n, -phi_a n) in every region. Plain C.
@*/
void FacetFirstVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *N)
{
  const int nodes = ElementGet(facet->type)->nodes;
  double    phi[FACE_MAX_NODES];

  (void)x;
  ElementShape(facet->type, foot->xi, phi, NULL, NULL);
  for (int k = 0; k < dim; ++k) {
    N[k] = foot->normal[k];
    for (int a = 0; a < nodes; ++a) N[(1 + a) * dim + k] = -phi[a] * foot->normal[k];
  }
}

/* Inverse of the first m rows and columns of a symmetric 2x2 matrix; 0 where it is singular. */
static void FacetInvert2(int m, double a[2][2], double inverse[2][2])
{
  const double det = m == 2 ? a[0][0] * a[1][1] - a[0][1] * a[1][0] : a[0][0];

  memset(inverse, 0, sizeof(double) * 4);
  if (det == 0) return;
  inverse[0][0] = m == 2 ? a[1][1] / det : 1 / det;
  if (m < 2) return;
  inverse[0][1] = inverse[1][0] = -a[0][1] / det;
  inverse[1][1]                 = a[0][0] / det;
}

/* The facet along its m free parameters at the foot: m = dim - 1 in the interior, 1 on an edge, 0 at a corner. */
typedef struct {
  int    m;
  double tangent[2][3], dphi[2][FACE_MAX_NODES];
  double inverse_metric[2][2], inverse_hessian[2][2], curvature[2][2]; /* curvature: a^-1 kappa H^-1 */
} Chart;

/* Tangents, metric, curvature and Hessian of the facet along its free parameters at the foot. */
static void ChartCreate(int dim, const Facet *facet, const double *x, const Foot *foot, Chart *chart)
{
  const int nodes = ElementGet(facet->type)->nodes, m = foot->region == FOOT_INTERIOR ? (dim == 3 ? 2 : 1)
                                                        : foot->region == FOOT_EDGE   ? 1
                                                                                      : 0;
  double    d[FACE_MAX_NODES * 2], direction[2][2]    = {{1, 0}, {0, 1}}, metric[2][2], kappa[2][2], hessian[2][2], det,
                                scale;
  FacetPolynomial      patch;
  FacetPolynomialLocal l;

  memset(chart, 0, sizeof(*chart));
  chart->m = m;
  if (m == 0) return;
  FacetPolynomialOfFacet(dim, facet, x, &patch);
  FacetPolynomialEvaluate(&patch, foot->xi, &l);
  ElementShape(facet->type, foot->xi, NULL, d, NULL);
  if (foot->region == FOOT_EDGE) memcpy(direction[0], patch.domain->tangent[foot->feature], sizeof(direction[0]));
  for (int p = 0; p < m; ++p) {
    const double *t = direction[p];

    for (int k = 0; k < 3; ++k) chart->tangent[p][k] = t[0] * l.x1[k] + t[1] * l.x2[k];
    for (int a = 0; a < nodes; ++a) chart->dphi[p][a] = dim == 2 ? d[a] : t[0] * d[a * 2] + t[1] * d[a * 2 + 1];
  }
  for (int p = 0; p < m; ++p) {
    for (int q = 0; q < m; ++q) {
      const double *t = direction[p], *u = direction[q];

      metric[p][q] = Dot(chart->tangent[p], chart->tangent[q]);
      kappa[p][q]  = t[0] * u[0] * Dot(foot->normal, l.x11) + (t[0] * u[1] + t[1] * u[0]) * Dot(foot->normal, l.x12) +
                    t[1] * u[1] * Dot(foot->normal, l.x22);
      hessian[p][q] = metric[p][q] - foot->gap * kappa[p][q];
    }
  }
  det   = m == 2 ? hessian[0][0] * hessian[1][1] - hessian[0][1] * hessian[1][0] : hessian[0][0];
  scale = m == 2 ? metric[0][0] * metric[1][1] : metric[0][0];
  if (fabs(det) <= FACET_FOCAL * scale) memcpy(hessian, metric, sizeof(metric));
  FacetInvert2(m, metric, chart->inverse_metric);
  FacetInvert2(m, hessian, chart->inverse_hessian);
  for (int p = 0; p < m; ++p)
    for (int q = 0; q < m; ++q)
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j)
          chart->curvature[p][q] += chart->inverse_metric[p][i] * kappa[i][j] * chart->inverse_hessian[j][q];
}

/* W / g: the projection on the directions that are neither normal nor tangent, over the gap. It is 0 in the
   interior, and within FACET_TOUCHING of the foot. */
static void SingularPart(int dim, const Facet *facet, const double *x, const Foot *foot, const Chart *chart,
                         double W[3][3])
{
  const double *n = foot->normal, *t = chart->tangent[0];
  const int     none = chart->m == dim - 1 || fabs(foot->gap) <= FACET_TOUCHING * FacetSize(dim, facet, x);

  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k)
      W[j][k] = none ? 0 : ((j == k) - n[j] * n[k] - t[j] * t[k] * chart->inverse_metric[0][0]) / foot->gap;
}

/*@
  FacetSecondVariation - computes the second variation of the gap, exact for the region of the foot.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet that holds the foot
. x     - positions of the nodes, as in FacetClosest()
- foot  - of FacetClosest()

  Output Parameter:
. M - M[((1+nodes)*dim)^2], symmetric (1/length)

  Note:
  The expression is given at the head of this file. At a centre of curvature, where the foot is not unique, the metric
  replaces the Hessian. Within FACET_TOUCHING of an edge or corner the term in 1/gap is 0. Plain C.
@*/
void FacetSecondVariation(int dim, const Facet *facet, const double *x, const Foot *foot, double *M)
{
  const int size = (1 + ElementGet(facet->type)->nodes) * dim;
  double    c[1 + FACE_MAX_NODES], W[3][3];
  double    T[2][MAX_DOFS], S[2][MAX_DOFS], U[2][MAX_DOFS], V[2][MAX_DOFS];
  Chart     chart;

  ChartCreate(dim, facet, x, foot, &chart);
  SingularPart(dim, facet, x, foot, &chart, W);
  ElementShape(facet->type, foot->xi, c + 1, NULL, NULL);
  c[0] = -1; /* D = -(c_a I) */
  for (int p = 0; p < chart.m; ++p) {
    for (int i = 0; i < size; ++i) {
      const int a = i / dim, k = i % dim;

      T[p][i] = -c[a] * chart.tangent[p][k];
      S[p][i] = a ? chart.dphi[p][a - 1] * foot->normal[k] : 0;
    }
  }
  for (int p = 0; p < chart.m; ++p) {
    for (int i = 0; i < size; ++i) {
      U[p][i] = V[p][i] = 0;
      for (int q = 0; q < chart.m; ++q) {
        U[p][i] += chart.curvature[p][q] * T[q][i] + chart.inverse_hessian[p][q] * S[q][i];
        V[p][i] += chart.inverse_hessian[p][q] * (T[q][i] + foot->gap * S[q][i]);
      }
    }
  }
  for (int i = 0; i < size; ++i) {
    for (int j = i; j < size; ++j) {
      double sum = chart.m < dim - 1 ? c[i / dim] * c[j / dim] * W[i % dim][j % dim] : 0;

      for (int p = 0; p < chart.m; ++p) sum -= T[p][i] * U[p][j] + S[p][i] * V[p][j];
      M[i * size + j] = M[j * size + i] = sum;
    }
  }
}
