/* Signed distance to a union of facets: foot point, gap, first and second variation.

   Foot. A facet is a polynomial map x(xi) over a reference polygon (line, triangle, square), positions relative to the slave point, so that
   the foot minimises f = |x|^2 / 2. Newton with the full Hessian x_,a.x_,b + x.x_,ab, the metric alone where that is not positive, runs on
   the interior, an edge or a corner: a set of at most two active sides, taken in when a step meets a side and released when Newton's step
   points inward. It starts from every local minimum over a grid of samples, since a curved facet can have several.
   A 2D facet is the 3D one extruded: second tangent e_z, no sides across it; its end points are the edges of the extruded one.

   Region. A foot on the border at which the residual has no tangential part is the limit of interior feet and counts as interior; likewise
   corner and edge. So a node that sits over a node of a flat master has the interior's second variation and not that of a hinge.

   Sign. Interior: the facet's own normal. Edge and corner: the sum of the normals of all facets that have this closest point, weighted by
   their angles there (Baerentzen and Aanaes, "Signed distance computation using the angle weighted pseudonormal", 2005).

   Variations. With r = x_slave - x(xi), D = dr / d(positions) at fixed xi, F = min |r|^2 / 2 = g^2 / 2 over the free parameters xi_a, the
   envelope theorem gives dg = n.D and d2F = D^T D - (T + g S)_a (H^-1)_ab (T + g S)_b^T with T_a = D^T x_,a, S_a the shape functions'
   derivatives times n, H = a - g kappa, a the metric and kappa = n.x_,ab. As d2F = dg dg^T + g d2g and D^T D = D^T (n n^T + x_,a a^ab x_,b^T + W) D,
       d2g = - T_a (a^-1 kappa H^-1)_ab T_b^T - (H^-1)_ab (T_a S_b^T + S_a T_b^T) - g S_a (H^-1)_ab S_b^T + D^T W D / g
   with W the projection on what is neither n nor tangent: 0 in the interior, one direction at an edge, two at a corner. In the interior these
   are the expressions of Laursen and Simo 1993 and of Wriggers, "Computational Contact Mechanics". The last term alone is singular as g -> 0
   at an edge or corner; times g it is bounded but without a limit, as the direction n is, and it is left out within FACET_TOUCHING.

   Extension. Beyond a free edge x(xi) is the same polynomial outside its polygon, so nothing else changes. A foot on the inside of a free edge
   may leave it with its lateral sides released: on a flat facet that is the normal projection. A foot in a corner keeps the sides that are not
   free: the crease between two facets is continued, and both agree on it. The gap is continuous where the edge lies on a flat part of the
   surface or runs square to the creases; past other corners it may jump by the angle of the crease times `beyond`. */
#include <float.h>
#include <math.h>
#include <string.h>
#include "facet.h"

/* SAMPLES per direction: of 2000 QUAD9 with nodes moved at random by up to 10 % of the width 4 hide their nearest point (with 3 samples 12); at
   5 % none does. */
enum { MAX_SIDES = 4, MAX_DOFS = 3 * (1 + FACE_MAX_NODES), SAMPLES = 5 };

/* Reference polygon. Side s runs from corner s to the next; inside: offset + normal.xi >= 0 (1 or 2, `width`, at the far end). */
typedef struct {
  int    sides;
  double low, width, centre[2];
  double offset[MAX_SIDES], normal[MAX_SIDES][2], tangent[MAX_SIDES][2];
} Domain;

static const Domain line = {
  .sides   = 2,
  .low     = -1,
  .width   = 2,
  .offset  = {1,      1      },
  .normal  = {{1, 0}, {-1, 0}},
  .tangent = {{0, 1}, {0, 1} }
};
static const Domain triangle = {
  .sides   = 3,
  .low     = 0,
  .width   = 1,
  .centre  = {1. / 3,    1. / 3 },
  .offset  = { 0,        1,       0},
  .normal  = { {0, 1}, {-1, -1},  {1, 0}},
  .tangent = { {1, 0},  {-1, 1}, {0, -1}}
};
static const Domain square = {
  .sides   = 4,
  .low     = -1,
  .width   = 2,
  .offset  = {1,      1,       1,       1      },
  .normal  = {{0, 1}, {-1, 0}, {0, -1}, {1, 0} },
  .tangent = {{1, 0}, {0, 1},  {-1, 0}, {0, -1}}
};

typedef struct {
  double centre[3], radius;
} Sphere;

/* The facet as a polynomial: x = sum c[i][j] xi^i eta^j */
typedef struct {
  const Domain *domain;
  int           flat; /* affine: one start is enough */
  double        c[3][3][3], size;
} Patch;

typedef struct {
  double x[3], x1[3], x2[3], x11[3], x12[3], x22[3];
} Local;

/* A point of a patch and the sides it is held at */
typedef struct {
  double   xi[2], x[3];
  unsigned active;
  int      converged;
} Point;

/* A facet that may hold the closest point */
typedef struct {
  const Facet *facet;
  int          index, feature;
  FootRegion   region;
  double       size, distance;
  Point        point;
} Candidate;

static double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double Dot2(const double a[2], const double b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

static double Distance(const double a[3], const double b[3])
{
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

  return sqrt(Dot(d, d));
}

/* Nodes of a facet as points in space; returns how many. */
static int Gather(int dim, const Facet *facet, const double *x, double X[FACE_MAX_NODES][3])
{
  const int nodes = ElementGet(facet->type)->nodes;

  for (int a = 0; a < nodes; ++a) {
    X[a][2] = 0;
    for (int k = 0; k < dim; ++k) X[a][k] = x[(size_t)facet->nodes[a] * dim + k];
  }
  return nodes;
}

/* A sphere around the control points of the facet as a Bezier patch, which hold the patch in their convex hull. */
static void BoundingSphere(ElementType type, double (*X)[3], Sphere *sphere)
{
  const Element *element = ElementGet(type);
  double         control[FACE_MAX_NODES][3], radius2 = 0;

  for (int k = 0; k < 3; ++k) {
    double sum = 0, middles = 0;

    for (int a = 0; a < element->corners; ++a) sum += control[a][k] = X[a][k];
    sphere->centre[k] = sum / element->corners;
    for (int a = element->corners; a < element->nodes; ++a) {
      const int e = a - element->corners;

      if (type == ELEMENT_EDGE3)
        control[a][k] = 2 * X[a][k] - 0.5 * (X[0][k] + X[1][k]);
      else if (e < element->corners)
        control[a][k] = 2 * X[a][k] - 0.5 * (X[e][k] + X[(e + 1) % element->corners][k]);
      else
        control[a][k] = 4 * X[a][k] - middles + 0.25 * sum;
      middles += X[a][k];
    }
  }
  for (int a = 0; a < element->nodes; ++a) {
    const double d[3] = {control[a][0] - sphere->centre[0], control[a][1] - sphere->centre[1], control[a][2] - sphere->centre[2]};

    radius2 = fmax(radius2, Dot(d, d));
  }
  sphere->radius = sqrt(radius2);
}

/* Quadratic through the values at -1, 0, 1 */
static void Quadratic(double left, double middle, double right, double c[3])
{
  c[0] = middle;
  c[1] = 0.5 * (right - left);
  c[2] = 0.5 * (left + right) - middle;
}

/* The polynomial of a QUAD9 in one component */
static void PatchQuad9(double (*X)[3], int k, Patch *patch)
{
  static const int grid[3][3] = {
    {0, 7, 3},
    {4, 8, 6},
    {1, 5, 2}
  };
  double row[3][3], column[3];

  for (int i = 0; i < 3; ++i) Quadratic(X[grid[i][0]][k], X[grid[i][1]][k], X[grid[i][2]][k], row[i]);
  for (int j = 0; j < 3; ++j) {
    Quadratic(row[0][j], row[1][j], row[2][j], column);
    for (int i = 0; i < 3; ++i) patch->c[i][j][k] = column[i];
  }
}

static void PatchCreate(ElementType type, double (*X)[3], double size, Patch *patch)
{
  memset(patch->c, 0, sizeof(patch->c));
  patch->size   = size;
  patch->domain = type == ELEMENT_EDGE2 || type == ELEMENT_EDGE3 ? &line : type == ELEMENT_TRI3 || type == ELEMENT_TRI6 ? &triangle : &square;
  patch->flat   = type == ELEMENT_EDGE2 || type == ELEMENT_TRI3;
  for (int k = 0; k < 3; ++k) {
    double(*c)[3][3] = patch->c, quadratic[3];

    switch (type) {
    case ELEMENT_EDGE2:
      c[0][0][k] = 0.5 * (X[0][k] + X[1][k]);
      c[1][0][k] = 0.5 * (X[1][k] - X[0][k]);
      break;
    case ELEMENT_EDGE3:
      Quadratic(X[0][k], X[2][k], X[1][k], quadratic);
      for (int i = 0; i < 3; ++i) c[i][0][k] = quadratic[i];
      break;
    case ELEMENT_TRI3:
      c[0][0][k] = X[0][k];
      c[1][0][k] = X[1][k] - X[0][k];
      c[0][1][k] = X[2][k] - X[0][k];
      break;
    case ELEMENT_TRI6:
      c[0][0][k] = X[0][k];
      c[1][0][k] = 4 * (X[3][k] - X[0][k]) - (X[1][k] - X[0][k]);
      c[0][1][k] = 4 * (X[5][k] - X[0][k]) - (X[2][k] - X[0][k]);
      c[2][0][k] = 2 * (X[0][k] + X[1][k]) - 4 * X[3][k];
      c[0][2][k] = 2 * (X[0][k] + X[2][k]) - 4 * X[5][k];
      c[1][1][k] = 4 * (X[0][k] - X[3][k] + X[4][k] - X[5][k]);
      break;
    case ELEMENT_QUAD9: PatchQuad9(X, k, patch); break;
    default:
      c[0][0][k] = 0.25 * (X[0][k] + X[1][k] + X[2][k] + X[3][k]);
      c[1][0][k] = 0.25 * (-X[0][k] + X[1][k] + X[2][k] - X[3][k]);
      c[0][1][k] = 0.25 * (-X[0][k] - X[1][k] + X[2][k] + X[3][k]);
      c[1][1][k] = 0.25 * (X[0][k] - X[1][k] + X[2][k] - X[3][k]);
    }
  }
  if (patch->domain == &line) patch->c[0][1][2] = 0.5 * size;
}

static void PatchMake(int dim, const Facet *facet, const double *x, Patch *patch)
{
  double X[FACE_MAX_NODES][3];
  Sphere sphere;

  Gather(dim, facet, x, X);
  BoundingSphere(facet->type, X, &sphere);
  PatchCreate(facet->type, X, 2 * sphere.radius, patch);
}

static void PatchEvaluate(const Patch *patch, const double xi[2], Local *l)
{
  const double s = xi[0], t = xi[1];

  for (int k = 0; k < 3; ++k) {
    double r[3], rt[3], rtt[3];

    for (int i = 0; i < 3; ++i) {
      const double c0 = patch->c[i][0][k], c1 = patch->c[i][1][k], c2 = patch->c[i][2][k];

      r[i]   = c0 + t * (c1 + t * c2);
      rt[i]  = c1 + 2 * t * c2;
      rtt[i] = 2 * c2;
    }
    l->x[k]   = r[0] + s * (r[1] + s * r[2]);
    l->x1[k]  = r[1] + 2 * s * r[2];
    l->x11[k] = 2 * r[2];
    l->x2[k]  = rt[0] + s * (rt[1] + s * rt[2]);
    l->x12[k] = rt[1] + 2 * s * rt[2];
    l->x22[k] = rtt[0] + s * (rtt[1] + s * rtt[2]);
  }
}

/* Columns of samples (second index) that a row of the grid has */
static int SampleColumns(const Domain *domain, int i)
{
  return domain->sides == 2 ? 1 : domain->sides == 3 ? SAMPLES - i : SAMPLES;
}

static void SamplePoint(const Domain *domain, int i, int j, double xi[2])
{
  xi[0] = domain->low + domain->width * i / (SAMPLES - 1);
  xi[1] = domain->sides == 2 ? 0 : domain->low + domain->width * j / (SAMPLES - 1);
}

/* Squared distances of a grid of points */
static void Sample(const Patch *patch, double value[SAMPLES][SAMPLES])
{
  for (int i = 0; i < SAMPLES; ++i) {
    double xi[2], row[3][3];

    SamplePoint(patch->domain, i, 0, xi);
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) row[j][k] = patch->c[0][j][k] + xi[0] * (patch->c[1][j][k] + xi[0] * patch->c[2][j][k]);
    for (int j = 0; j < SampleColumns(patch->domain, i); ++j) {
      double x[3];

      SamplePoint(patch->domain, i, j, xi);
      for (int k = 0; k < 3; ++k) x[k] = row[0][k] + xi[1] * (row[1][k] + xi[1] * row[2][k]);
      value[i][j] = Dot(x, x);
    }
  }
}

/* No tangent plane here: a tangent vanishes, or they are parallel. cross: x_,1 times x_,2. */
static int Degenerate(const Local *l, double size, double cross[3])
{
  const double a = Dot(l->x1, l->x1), b = Dot(l->x2, l->x2);

  cross[0] = l->x1[1] * l->x2[2] - l->x1[2] * l->x2[1];
  cross[1] = l->x1[2] * l->x2[0] - l->x1[0] * l->x2[2];
  cross[2] = l->x1[0] * l->x2[1] - l->x1[1] * l->x2[0];
  return fmin(a, b) <= FACET_FLAT * size * size || Dot(cross, cross) <= FACET_FLAT * a * b;
}

/* Unit normal at xi, or at the facet's centre where there is none at xi (a collapsed side); 0 if there is none at all. */
static void PatchNormal(const Patch *patch, const double xi[2], double normal[3])
{
  const double *at[2] = {xi, patch->domain->centre};

  for (int attempt = 0; attempt < 2; ++attempt) {
    Local  l;
    double length;

    PatchEvaluate(patch, at[attempt], &l);
    if (Degenerate(&l, patch->size, normal)) continue;
    length = sqrt(Dot(normal, normal));
    for (int k = 0; k < 3; ++k) normal[k] /= length;
    return;
  }
  for (int k = 0; k < 3; ++k) normal[k] = 0;
}

/* Angle of the facet at a point: of the corner, or half a turn. */
static double PatchAngle(const Patch *patch, const Point *point)
{
  Local  l;
  double t[2][3];
  int    sides = 0;

  if (!(point->active & (point->active - 1))) return M_PI;
  PatchEvaluate(patch, point->xi, &l);
  for (int s = 0; s < patch->domain->sides; ++s) {
    const double *tangent = patch->domain->tangent[s];

    if (point->active & (1u << s))
      for (int k = 0; k < 3; ++k) t[sides & 1][k] = tangent[0] * l.x1[k] + tangent[1] * l.x2[k];
    sides += point->active >> s & 1;
  }
  /* one side runs into the corner, the other out of it */
  return acos(fmax(-1, fmin(1, -Dot(t[0], t[1]) / fmax(sqrt(Dot(t[0], t[0]) * Dot(t[1], t[1])), DBL_MIN))));
}

/* Gradient, metric and Hessian (11, 12, 22) of half the squared distance */
typedef struct {
  double G[2], metric[3], hessian[3];
} Slope;

static void SlopeAt(const Patch *patch, const Local *l, Slope *slope)
{
  double *a = slope->metric, cross[3];

  slope->G[0]       = Dot(l->x, l->x1);
  slope->G[1]       = Dot(l->x, l->x2);
  a[0]              = Dot(l->x1, l->x1);
  a[1]              = Dot(l->x1, l->x2);
  a[2]              = Dot(l->x2, l->x2);
  slope->hessian[0] = a[0] + Dot(l->x, l->x11);
  slope->hessian[1] = a[1] + Dot(l->x, l->x12);
  slope->hessian[2] = a[2] + Dot(l->x, l->x22);
  if (Degenerate(l, patch->size, cross)) {
    a[0] += sqrt(FACET_FLAT) * patch->size * patch->size;
    a[2] += sqrt(FACET_FLAT) * patch->size * patch->size;
  }
}

/* Newton's step along a reference direction t; returns by how much it lowers the quadratic model (0: t does not descend). */
static double StepAlong(const Slope *slope, const double t[2], double d[2])
{
  const double *H = slope->hessian, *a = slope->metric, along = Dot2(slope->G, t), stretch = a[0] * t[0] * t[0] + 2 * a[1] * t[0] * t[1] + a[2] * t[1] * t[1];
  double        curvature = H[0] * t[0] * t[0] + 2 * H[1] * t[0] * t[1] + H[2] * t[1] * t[1];

  if (curvature <= FACET_FOCAL * stretch) curvature = stretch;
  for (int k = 0; k < 2; ++k) d[k] = -along / curvature * t[k];
  return along < 0 ? along * along / curvature : 0;
}

/* Newton's step in the plane, with the metric where the Hessian is not positive */
static void StepFree(const Slope *slope, double d[2])
{
  const double *H = slope->hessian, *a = slope->metric, *G = slope->G;
  double        det = H[0] * H[2] - H[1] * H[1];

  if (H[0] <= FACET_FOCAL * a[0] || det <= FACET_FOCAL * a[0] * a[2]) {
    H   = a;
    det = a[0] * a[2] - a[1] * a[1];
  }
  d[0] = (-H[2] * G[0] + H[1] * G[1]) / det;
  d[1] = (H[1] * G[0] - H[0] * G[1]) / det;
}

/* Descent direction d that respects the active sides, releasing those it leaves; 0 at a stationary corner. */
static int Direction(const Domain *domain, const Slope *slope, unsigned *active, double d[2])
{
  unsigned keep = 0, best = 0;
  double   most = 0;

  StepFree(slope, d);
  for (int s = 0; s < domain->sides; ++s)
    if (*active & (1u << s) && Dot2(domain->normal[s], d) <= 0) keep |= 1u << s;
  if (!keep) {
    *active = 0;
    return 1;
  }
  for (int s = 0; s < domain->sides; ++s) {
    const unsigned other = *active & ~(1u << s);
    double         t[2] = {domain->tangent[s][0], domain->tangent[s][1]}, step[2], gain, sign = 1;

    if (!(*active & (1u << s))) continue;
    if (!other) {
      StepAlong(slope, t, d);
      return 1;
    }
    for (int o = 0; o < domain->sides; ++o)
      if (other & (1u << o)) sign = copysign(1, Dot2(domain->normal[o], t));
    for (int k = 0; k < 2; ++k) t[k] *= sign;
    gain = StepAlong(slope, t, step);
    if (gain > most) {
      most = gain;
      best = 1u << s;
      memcpy(d, step, sizeof(step));
    }
  }
  if (best) *active = best;
  return best != 0;
}

/* Puts the point on side s */
static void Snap(const Domain *domain, const double limit[], int s, double xi[2])
{
  const double *n   = domain->normal[s];
  const double  off = (domain->offset[s] + Dot2(n, xi) - limit[s]) / Dot2(n, n);

  for (int k = 0; k < 2; ++k) xi[k] -= off * n[k];
}

/* The part of the step d up to the first side in its way; *hit: that side or -1. */
static double Reach(const Domain *domain, const double limit[], const Point *point, const double d[2], int *hit)
{
  double reach = 1;

  *hit = -1;
  for (int s = 0; s < domain->sides; ++s) {
    const double speed = Dot2(domain->normal[s], d), room = domain->offset[s] + Dot2(domain->normal[s], point->xi) - limit[s];

    if (point->active & (1u << s) || speed >= 0 || room + reach * speed > 0) continue;
    reach = fmax(0, room / -speed);
    *hit  = s;
  }
  return reach;
}

/* From a point to a local minimum of the distance over the polygon with the given limits of its sides (0, or negative where extended). */
static void Descend(const Patch *patch, const double limit[], Point *point)
{
  const Domain *domain = patch->domain;
  Local         l;

  PatchEvaluate(patch, point->xi, &l);
  point->converged = patch->size <= 0;
  for (int k = 0; k < FACET_ITERATIONS && !point->converged; ++k) {
    const double f = 0.5 * Dot(l.x, l.x), rounding = 8 * DBL_EPSILON * sqrt(2 * f) * (sqrt(2 * f) + patch->size);
    double       d[2], step, decrease;
    int          hit;
    Slope        slope;

    SlopeAt(patch, &l, &slope);
    if (!Direction(domain, &slope, &point->active, d)) {
      point->converged = 1;
      break;
    }
    decrease = -Dot2(slope.G, d);
    step     = Reach(domain, limit, point, d, &hit);
    for (int halvings = 0; halvings < FACET_ITERATIONS; ++halvings) {
      double xi[2] = {point->xi[0] + step * d[0], point->xi[1] + step * d[1]};

      if (hit >= 0) Snap(domain, limit, hit, xi);
      PatchEvaluate(patch, xi, &l);
      if (0.5 * Dot(l.x, l.x) <= f - FACET_DESCENT * step * decrease + rounding) {
        memcpy(point->xi, xi, sizeof(xi));
        break;
      }
      step *= 0.5;
      hit = -1;
    }
    if (hit >= 0)
      point->active |= 1u << hit;
    else if (step == 1)
      point->converged = sqrt(Dot2(d, d)) <= FACET_TIE * (1 + sqrt(2 * f) / patch->size) || decrease <= DBL_EPSILON * f;
  }
  memcpy(point->x, l.x, sizeof(l.x));
}

/* Is sample i, j nearer than its neighbours on the grid? */
static int LocalMinimum(const Domain *domain, double value[SAMPLES][SAMPLES], int i, int j)
{
  for (int p = i > 0 ? i - 1 : 0; p <= i + 1 && p < SAMPLES; ++p) {
    for (int q = j > 0 ? j - 1 : 0; q <= j + 1 && q < SampleColumns(domain, p); ++q) {
      const int earlier = p < i || (p == i && q < j);

      if (domain->sides == 3 && p - i == q - j) continue; /* across a triangle of the grid */
      if (value[p][q] < value[i][j] || (earlier && value[p][q] == value[i][j])) return 0;
    }
  }
  return 1;
}

/* Adds the sides that the point is on */
static void Activate(const Domain *domain, Point *point)
{
  for (int s = 0; s < domain->sides; ++s)
    if (domain->offset[s] + Dot2(domain->normal[s], point->xi) <= FACET_COINCIDENT * domain->width) point->active |= 1u << s;
}

/* Closest point of the unextended patch */
static void PatchClosest(const Patch *patch, Point *best)
{
  static const double inside[MAX_SIDES] = {0};
  const Domain       *domain            = patch->domain;
  double              value[SAMPLES][SAMPLES], least = INFINITY;

  if (patch->flat) {
    memcpy(best->xi, domain->centre, sizeof(best->xi));
    best->active = 0;
    Descend(patch, inside, best);
    Activate(domain, best);
    return;
  }
  Sample(patch, value);
  for (int i = 0; i < SAMPLES; ++i) {
    for (int j = 0; j < SampleColumns(domain, i); ++j) {
      Point  point = {.active = 0};
      double distance2;

      if (!LocalMinimum(domain, value, i, j)) continue;
      SamplePoint(domain, i, j, point.xi);
      Activate(domain, &point);
      Descend(patch, inside, &point);
      distance2 = Dot(point.x, point.x);
      if (distance2 >= least) continue;
      least = distance2;
      *best = point;
    }
  }
  Activate(domain, best);
}

/* Which region a point is in, by its active sides and by what is left of the residual's tangential part. */
static void Classify(const Patch *patch, const Point *point, FootRegion *region, int *feature)
{
  const Domain *domain   = patch->domain;
  const double  distance = sqrt(Dot(point->x, point->x)), tolerance = FACET_TIE * (patch->size + distance);
  const int     apart = distance > FACET_TOUCHING * patch->size, last = domain->sides - 1;
  const int     two_sides = (point->active & (point->active - 1)) != 0;
  Local         l;
  double        cross[3], G[2], tangential2, area2;

  PatchEvaluate(patch, point->xi, &l);
  *region  = FOOT_VERTEX;
  *feature = 0;
  if (two_sides && point->active != (1u | 1u << last))
    *feature = __builtin_ctz(point->active) + 1;
  else if (point->active && !two_sides)
    *feature = __builtin_ctz(point->active);
  if (Degenerate(&l, patch->size, cross)) return;
  G[0]        = Dot(l.x, l.x1);
  G[1]        = Dot(l.x, l.x2);
  area2       = Dot(cross, cross);
  tangential2 = (Dot(l.x2, l.x2) * G[0] * G[0] - 2 * Dot(l.x1, l.x2) * G[0] * G[1] + Dot(l.x1, l.x1) * G[1] * G[1]) / area2;
  if (!point->active ? point->converged || tangential2 <= tolerance * tolerance : apart && tangential2 <= tolerance * tolerance) {
    *region  = FOOT_INTERIOR;
    *feature = -1;
  } else if (point->active && domain != &line) {
    for (int s = 0; s <= last; ++s) {
      const double *t    = domain->tangent[s];
      const double  v[3] = {t[0] * l.x1[0] + t[1] * l.x2[0], t[0] * l.x1[1] + t[1] * l.x2[1], t[0] * l.x1[2] + t[1] * l.x2[2]};

      if (!(point->active & (1u << s)) || (two_sides && !(apart && fabs(Dot2(G, t)) <= tolerance * sqrt(Dot(v, v))))) continue;
      *region  = FOOT_EDGE;
      *feature = s;
      return;
    }
  }
}

/* Is candidate a to be preferred to b? Nearer, then the better defined region, then the smaller tag. */
static int Preferred(const Candidate *a, const Candidate *b)
{
  const double tie = FACET_TIE * (fmax(a->size, b->size) + fmin(a->distance, b->distance));

  if (fabs(a->distance - b->distance) > tie) return a->distance < b->distance;
  if (a->region != b->region) return a->region < b->region;
  return a->facet->tag < b->facet->tag;
}

static void Consider(const Patch *patch, Candidate *candidate)
{
  candidate->size     = patch->size;
  candidate->distance = sqrt(Dot(candidate->point.x, candidate->point.x));
  Classify(patch, &candidate->point, &candidate->region, &candidate->feature);
}

/* Sides of a candidate that its foot is on and that are free */
static unsigned FreeSides(const Candidate *candidate)
{
  return candidate->region == FOOT_INTERIOR ? 0 : candidate->point.active & (unsigned)candidate->facet->free_edges;
}

/* Lets the foot of a candidate leave its facet across its free sides; *ended: it reached the end of the extension. */
static void Extend(int dim, const double *x, Candidate *candidate, int *ended)
{
  const unsigned free_sides = FreeSides(candidate), active = candidate->point.active;
  double         limit[MAX_SIDES] = {0};
  Patch          patch;

  PatchMake(dim, candidate->facet, x, &patch);
  for (int s = 0; s < patch.domain->sides; ++s) {
    const int opposite = patch.domain->sides != 3 && active == 1u << (s + patch.domain->sides / 2) % patch.domain->sides;
    const int lateral  = !(active & (active - 1)) && !opposite;

    if (!(free_sides & (1u << s) || lateral)) continue;
    limit[s] = -FACET_EXTENSION * patch.domain->width;
    candidate->point.active &= ~(1u << s);
  }
  Descend(&patch, limit, &candidate->point);
  Consider(&patch, candidate);
  *ended = 0;
  for (int s = 0; s < patch.domain->sides; ++s)
    if (candidate->region != FOOT_INTERIOR && candidate->point.active & (1u << s) && limit[s] < 0) *ended = 1;
}

/* Gap and normal of a foot. pseudo: direction that tells outside from inside where the foot has no normal of its own. */
static void SetGap(int dim, const double *x, const Candidate *candidate, const double pseudo[3], Foot *foot)
{
  const double *at = candidate->point.x, length = sqrt(Dot(pseudo, pseudo));
  double        own[3], sign;
  Patch         patch;

  foot->facet     = candidate->index;
  foot->region    = candidate->region;
  foot->feature   = candidate->feature;
  foot->converged = candidate->point.converged;
  memcpy(foot->xi, candidate->point.xi, sizeof(foot->xi));
  PatchMake(dim, candidate->facet, x, &patch);
  PatchNormal(&patch, candidate->point.xi, own);
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
  if (Dot(foot->normal, foot->normal) == 0) foot->normal[dim - 1] = 1; /* on a facet without area: any direction */
}

/* Adds the normal of a candidate at its foot, times its angle there or 1 */
static void AddNormal(int dim, const double *x, const Candidate *candidate, int weighted, double pseudo[3])
{
  Patch  patch;
  double normal[3], weight;

  PatchMake(dim, candidate->facet, x, &patch);
  PatchNormal(&patch, candidate->point.xi, normal);
  weight = weighted ? PatchAngle(&patch, &candidate->point) : 1;
  for (int k = 0; k < 3; ++k) pseudo[k] += weight * normal[k];
}

/* The foot from the candidates that hold the closest point */
static void Decide(int dim, const double *x, int n, const Candidate candidates[], Foot *foot)
{
  const Candidate *best = &candidates[0], *edge = NULL;
  double           pseudo[3] = {0}, free_pseudo[3] = {0};
  Candidate        extended = {.size = 0};
  int              ended    = 0;

  for (int i = 1; i < n; ++i)
    if (Preferred(&candidates[i], best)) best = &candidates[i];
  foot->beyond = 0;
  for (int i = 0; best->region != FOOT_INTERIOR && i < n; ++i) {
    const Candidate *c = &candidates[i];

    if (Distance(c->point.x, best->point.x) > FACET_COINCIDENT * best->size) continue;
    AddNormal(dim, x, c, 1, pseudo);
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
    return;
  }
  SetGap(dim, x, &extended, free_pseudo, foot);
  foot->beyond = Distance(extended.point.x, edge->point.x);
  if (ended) {
    foot->beyond = fmax(foot->beyond, extended.size);
    if (foot->gap < 0) {
      foot->gap = -foot->gap;
      for (int k = 0; k < dim; ++k) foot->normal[k] = -foot->normal[k];
    }
  }
}

/* Adds a candidate, drops those that can no longer coincide with the closest point; returns the new count. */
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

/* The facet whose centre is nearest */
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

/* Closest point over a list of facets, its signed distance and normal.
   Not collective, plain C. dim: 2 or 3; n: length of the list; x[node][dim]: positions of the nodes relative to the slave point (a length);
   seed: index into the list to try first (the last foot's facet) or -1; the result does not depend on it.
   Returns 1, or 0 if the list is empty (foot untouched). */
int FacetClosest(int dim, int n, const Facet *facets, const double *x, int seed, Foot *foot)
{
  Candidate candidates[FACET_TIES];
  double    least = INFINITY;
  int       count = 0;

  if (n <= 0) return 0;
  if (seed < 0 || seed >= n) seed = NearestCentre(dim, n, facets, x);
  for (int k = 0; k < n; ++k) {
    const int i = k == 0 ? seed : k <= seed ? k - 1 : k;
    double    X[FACE_MAX_NODES][3];
    Candidate candidate = {.facet = &facets[i], .index = i};
    Sphere    sphere;
    Patch     patch;

    Gather(dim, &facets[i], x, X);
    BoundingSphere(facets[i].type, X, &sphere);
    if (sqrt(Dot(sphere.centre, sphere.centre)) - sphere.radius > least + 2 * FACET_COINCIDENT * sphere.radius) continue;
    PatchCreate(facets[i].type, X, 2 * sphere.radius, &patch);
    PatchClosest(&patch, &candidate.point);
    Consider(&patch, &candidate);
    least = fmin(least, candidate.distance);
    count = Insert(&candidate, least, count, candidates);
  }
  Decide(dim, x, count, candidates, foot);
  return 1;
}

/* Closest point of one facet, without neighbours to tell the side of an edge: there its own normal does.
   Not collective, plain C. Arguments as of FacetClosest(). */
void FacetProject(int dim, const Facet *facet, const double *x, Foot *foot)
{
  FacetClosest(dim, 1, facet, x, 0, foot);
}

/* Largest extent of a facet: the diameter of a sphere that holds it, also between its nodes.
   Not collective, plain C. Arguments as of FacetClosest(); returns a length. */
double FacetSize(int dim, const Facet *facet, const double *x)
{
  double X[FACE_MAX_NODES][3];
  Sphere sphere;

  Gather(dim, facet, x, X);
  BoundingSphere(facet->type, X, &sphere);
  return 2 * sphere.radius;
}

/* First variation of the gap: dg = N.d(positions), in every region (n, -phi_a n).
   Not collective, plain C. x and foot as given to and by FacetClosest(); N[(1+nodes)*dim]: slave point, then the facet's nodes (no unit). */
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

/* Inverse of a symmetric 2x2 matrix over its first m rows; 0 where it is singular. */
static void Invert(int m, double a[2][2], double inverse[2][2])
{
  const double det = m == 2 ? a[0][0] * a[1][1] - a[0][1] * a[1][0] : a[0][0];

  memset(inverse, 0, sizeof(double) * 4);
  if (det == 0) return;
  inverse[0][0] = m == 2 ? a[1][1] / det : 1 / det;
  if (m < 2) return;
  inverse[0][1] = inverse[1][0] = -a[0][1] / det;
  inverse[1][1]                 = a[0][0] / det;
}

/* The facet along its m free parameters at the foot: m = dim - 1 in the interior, 1 on an edge, 0 at a corner */
typedef struct {
  int    m;
  double tangent[2][3], dphi[2][FACE_MAX_NODES];
  double inverse_metric[2][2], inverse_hessian[2][2], curvature[2][2]; /* curvature: a^-1 kappa H^-1 */
} Chart;

static void ChartCreate(int dim, const Facet *facet, const double *x, const Foot *foot, Chart *chart)
{
  const int nodes = ElementGet(facet->type)->nodes, m = foot->region == FOOT_INTERIOR ? (dim == 3 ? 2 : 1) : foot->region == FOOT_EDGE ? 1 : 0;
  double    d[FACE_MAX_NODES * 2],
    direction[2][2] =
      {
        {1, 0},
        {0, 1}
  },
    metric[2][2], kappa[2][2], hessian[2][2], det, scale;
  Patch patch;
  Local l;

  memset(chart, 0, sizeof(*chart));
  chart->m = m;
  if (m == 0) return;
  PatchMake(dim, facet, x, &patch);
  PatchEvaluate(&patch, foot->xi, &l);
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

      metric[p][q]  = Dot(chart->tangent[p], chart->tangent[q]);
      kappa[p][q]   = t[0] * u[0] * Dot(foot->normal, l.x11) + (t[0] * u[1] + t[1] * u[0]) * Dot(foot->normal, l.x12) + t[1] * u[1] * Dot(foot->normal, l.x22);
      hessian[p][q] = metric[p][q] - foot->gap * kappa[p][q];
    }
  }
  det   = m == 2 ? hessian[0][0] * hessian[1][1] - hessian[0][1] * hessian[1][0] : hessian[0][0];
  scale = m == 2 ? metric[0][0] * metric[1][1] : metric[0][0];
  if (fabs(det) <= FACET_FOCAL * scale) memcpy(hessian, metric, sizeof(metric));
  Invert(m, metric, chart->inverse_metric);
  Invert(m, hessian, chart->inverse_hessian);
  for (int p = 0; p < m; ++p)
    for (int q = 0; q < m; ++q)
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) chart->curvature[p][q] += chart->inverse_metric[p][i] * kappa[i][j] * chart->inverse_hessian[j][q];
}

/* W / g: the projection on what is neither normal nor tangent, over the gap; 0 in the interior and within FACET_TOUCHING of the foot */
static void SingularPart(int dim, const Facet *facet, const double *x, const Foot *foot, const Chart *chart, double W[3][3])
{
  const double *n = foot->normal, *t = chart->tangent[0];
  const int     none = chart->m == dim - 1 || fabs(foot->gap) <= FACET_TOUCHING * FacetSize(dim, facet, x);

  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) W[j][k] = none ? 0 : ((j == k) - n[j] * n[k] - t[j] * t[k] * chart->inverse_metric[0][0]) / foot->gap;
}

/* Second variation of the gap, exact for the region of the foot: expression at the head of this file.
   Not collective, plain C. x and foot as given to and by FacetClosest(); M[((1+nodes)*dim)^2], symmetric (1/length). At a centre of curvature,
   where the foot is not unique, the Hessian is replaced by the metric; within FACET_TOUCHING of an edge or corner the term in 1/gap is 0. */
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
