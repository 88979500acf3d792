/* Projection of the origin onto one facet.

   Foot. A facet is a polynomial map x(xi) over a reference polygon (line, triangle, square). Positions are relative to
   the slave point, so that the foot minimises f = |x|^2 / 2. Newton's method uses the full Hessian x_,a.x_,b + x.x_,ab,
   and the metric alone where the Hessian is not positive. It runs in the interior, on an edge or at a corner, which is
   a set of at most two active sides. A side becomes active when a step meets it, and it is released when Newton's step
   points inward. The method starts from every local minimum over a grid of samples, because a curved facet can have
   several minima.

   Region. A foot on the border at which the residual has no tangential part is the limit of interior feet and counts
   as interior. The same holds for corners and edges. So a node that lies over a node of a flat master has the
   interior's second variation and not that of a hinge. */
#include "facetpolynomial.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Samples in each direction. Of 2000 QUAD9 with nodes moved at random by up to 10 % of the width, 4 hide their
   nearest point with 5 samples and 12 with 3 samples. At 5 % none hides it. */
enum { SAMPLES = 5 };

static const FacetPolynomialDomain line =
  {.sides = 2, .low = -1, .width = 2, .offset = {1, 1}, .normal = {{1, 0}, {-1, 0}}, .tangent = {{0, 1}, {0, 1}}};
static const FacetPolynomialDomain triangle = {.sides   = 3,
                                               .low     = 0,
                                               .width   = 1,
                                               .centre  = {1. / 3, 1. / 3},
                                               .offset  = {0, 1, 0},
                                               .normal  = {{0, 1}, {-1, -1}, {1, 0}},
                                               .tangent = {{1, 0}, {-1, 1}, {0, -1}}};
static const FacetPolynomialDomain square   = {.sides   = 4,
                                               .low     = -1,
                                               .width   = 2,
                                               .offset  = {1, 1, 1, 1},
                                               .normal  = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}},
                                               .tangent = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

static double Dot2(const double a[2], const double b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

/*@
  FacetPolynomialGather - collects the nodes of a facet as points in space.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet
- x     - positions of the list's nodes, x[node][dim] (length)

  Output Parameter:
. X - positions of the facet's nodes, with room for FACE_MAX_NODES; third components are 0 in 2D

  Note:
  Returns the number of nodes. Plain C.
@*/
int FacetPolynomialGather(int dim, const Facet *facet, const double *x, double X[FACE_MAX_NODES][3])
{
  const int nodes = ElementGet(facet->type)->nodes;

  for (int a = 0; a < nodes; ++a) {
    X[a][2] = 0;
    for (int k = 0; k < dim; ++k) X[a][k] = x[(size_t)facet->nodes[a] * dim + k];
  }
  return nodes;
}

/*@
  FacetPolynomialControl - computes the control points of a facet as a Bezier patch.

  Not collective

  Input Parameters:
+ type - of the facet
- X    - positions of its nodes (length)

  Output Parameter:
. control - one for each node

  Note:
  Their convex hull holds the patch. Plain C.
@*/
void FacetPolynomialControl(ElementType type, double (*X)[3], double (*control)[3])
{
  const Element *element = ElementGet(type);

  for (int k = 0; k < 3; ++k) {
    double sum = 0, middles = 0;

    for (int a = 0; a < element->corners; ++a) sum += control[a][k] = X[a][k];
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
}

/*@
  FacetPolynomialBound - computes a sphere that holds a facet, also between its nodes.

  Not collective

  Input Parameters:
+ type - of the facet
- X    - positions of its nodes (length)

  Output Parameter:
. sphere - centre and radius

  Note:
  The sphere holds the control points. Plain C.
@*/
void FacetPolynomialBound(ElementType type, double (*X)[3], FacetPolynomialSphere *sphere)
{
  const Element *element = ElementGet(type);
  double         control[FACE_MAX_NODES][3], radius2 = 0;

  FacetPolynomialControl(type, X, control);
  for (int k = 0; k < 3; ++k) {
    double sum = 0;

    for (int a = 0; a < element->corners; ++a) sum += X[a][k];
    sphere->centre[k] = sum / element->corners;
  }
  for (int a = 0; a < element->nodes; ++a) {
    const double d[3] = {control[a][0] - sphere->centre[0], control[a][1] - sphere->centre[1],
                         control[a][2] - sphere->centre[2]};

    radius2 = fmax(radius2, Dot(d, d));
  }
  sphere->radius = sqrt(radius2);
}

/* Coefficients of the quadratic through the values at -1, 0 and 1. */
static void Quadratic(double left, double middle, double right, double c[3])
{
  c[0] = middle;
  c[1] = 0.5 * (right - left);
  c[2] = 0.5 * (left + right) - middle;
}

/* The polynomial of a QUAD9 in one component. */
static void PatchQuad9(double (*X)[3], int k, FacetPolynomial *patch)
{
  static const int grid[3][3] = {{0, 7, 3}, {4, 8, 6}, {1, 5, 2}};
  double           row[3][3], column[3];

  for (int i = 0; i < 3; ++i) Quadratic(X[grid[i][0]][k], X[grid[i][1]][k], X[grid[i][2]][k], row[i]);
  for (int j = 0; j < 3; ++j) {
    Quadratic(row[0][j], row[1][j], row[2][j], column);
    for (int i = 0; i < 3; ++i) patch->c[i][j][k] = column[i];
  }
}

/*@
  FacetPolynomialCreate - makes the polynomial through the nodes of a facet.

  Not collective

  Input Parameters:
+ type - of the facet
. X    - positions of its nodes (length)
- size - extent of the facet (length), twice the radius of FacetPolynomialBound(); it scales the guards and the extruded
         direction of a 2D facet

  Output Parameter:
. patch - the polynomial

  Note:
  Plain C.
@*/
void FacetPolynomialCreate(ElementType type, double (*X)[3], double size, FacetPolynomial *patch)
{
  memset(patch->c, 0, sizeof(patch->c));
  patch->size   = size;
  patch->domain = type == ELEMENT_EDGE2 || type == ELEMENT_EDGE3 ? &line
                  : type == ELEMENT_TRI3 || type == ELEMENT_TRI6 ? &triangle
                                                                 : &square;
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

/*@
  FacetPolynomialOfFacet - makes the polynomial of a facet of a list.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. facet - the facet
- x     - positions of the list's nodes, x[node][dim] (length)

  Output Parameter:
. patch - the polynomial

  Note:
  Plain C.
@*/
void FacetPolynomialOfFacet(int dim, const Facet *facet, const double *x, FacetPolynomial *patch)
{
  double                X[FACE_MAX_NODES][3];
  FacetPolynomialSphere sphere;

  FacetPolynomialGather(dim, facet, x, X);
  FacetPolynomialBound(facet->type, X, &sphere);
  FacetPolynomialCreate(facet->type, X, 2 * sphere.radius, patch);
}

/*@
  FacetPolynomialEvaluate - computes position, tangents and second derivatives at a point.

  Not collective

  Input Parameters:
+ patch - the polynomial
- xi    - reference coordinates

  Output Parameter:
. l - position and derivatives

  Note:
  Plain C.
@*/
void FacetPolynomialEvaluate(const FacetPolynomial *patch, const double xi[2], FacetPolynomialLocal *l)
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

/* Number of columns of samples (second index) in row i of the grid. */
static int SampleColumns(const FacetPolynomialDomain *domain, int i)
{
  return domain->sides == 2 ? 1 : domain->sides == 3 ? SAMPLES - i : SAMPLES;
}

static void SamplePoint(const FacetPolynomialDomain *domain, int i, int j, double xi[2])
{
  xi[0] = domain->low + domain->width * i / (SAMPLES - 1);
  xi[1] = domain->sides == 2 ? 0 : domain->low + domain->width * j / (SAMPLES - 1);
}

/* Squared distances of the points of the grid. */
static void Sample(const FacetPolynomial *patch, double value[SAMPLES][SAMPLES])
{
  for (int i = 0; i < SAMPLES; ++i) {
    double xi[2], row[3][3];

    SamplePoint(patch->domain, i, 0, xi);
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        row[j][k] = patch->c[0][j][k] + xi[0] * (patch->c[1][j][k] + xi[0] * patch->c[2][j][k]);
    for (int j = 0; j < SampleColumns(patch->domain, i); ++j) {
      double x[3];

      SamplePoint(patch->domain, i, j, xi);
      for (int k = 0; k < 3; ++k) x[k] = row[0][k] + xi[1] * (row[1][k] + xi[1] * row[2][k]);
      value[i][j] = Dot(x, x);
    }
  }
}

/* Is there no tangent plane here? A tangent vanishes, or both are parallel. cross is x_,1 times x_,2. */
static int Degenerate(const FacetPolynomialLocal *l, double size, double cross[3])
{
  const double a = Dot(l->x1, l->x1), b = Dot(l->x2, l->x2);

  cross[0] = l->x1[1] * l->x2[2] - l->x1[2] * l->x2[1];
  cross[1] = l->x1[2] * l->x2[0] - l->x1[0] * l->x2[2];
  cross[2] = l->x1[0] * l->x2[1] - l->x1[1] * l->x2[0];
  return fmin(a, b) <= FACET_FLAT * size * size || Dot(cross, cross) <= FACET_FLAT * a * b;
}

/*@
  FacetPolynomialNormal - computes the unit normal at a point.

  Not collective

  Input Parameters:
+ patch - the polynomial
- xi    - reference coordinates

  Output Parameter:
. normal - unit normal at xi

  Note:
  Where there is no normal at xi (a collapsed side), the normal is that of the facet's centre. It is 0 if there is none
  at all. Plain C.
@*/
void FacetPolynomialNormal(const FacetPolynomial *patch, const double xi[2], double normal[3])
{
  const double *at[2] = {xi, patch->domain->centre};

  for (int attempt = 0; attempt < 2; ++attempt) {
    FacetPolynomialLocal l;
    double               length;

    FacetPolynomialEvaluate(patch, at[attempt], &l);
    if (Degenerate(&l, patch->size, normal)) continue;
    length = sqrt(Dot(normal, normal));
    for (int k = 0; k < 3; ++k) normal[k] /= length;
    return;
  }
  for (int k = 0; k < 3; ++k) normal[k] = 0;
}

/*@
  FacetPolynomialAngle - computes the angle of the facet at a point (radians): the angle of the corner, or pi elsewhere.

  Not collective

  Input Parameters:
+ patch - the polynomial
- point - the point with its active sides

  Note:
  Plain C.
@*/
double FacetPolynomialAngle(const FacetPolynomial *patch, const FacetPolynomialPoint *point)
{
  FacetPolynomialLocal l;
  double               t[2][3];
  int                  sides = 0;

  if (!(point->active & (point->active - 1))) return M_PI;
  FacetPolynomialEvaluate(patch, point->xi, &l);
  for (int s = 0; s < patch->domain->sides; ++s) {
    const double *tangent = patch->domain->tangent[s];

    if (point->active & (1u << s))
      for (int k = 0; k < 3; ++k) t[sides & 1][k] = tangent[0] * l.x1[k] + tangent[1] * l.x2[k];
    sides += point->active >> s & 1;
  }
  /* one side runs into the corner, the other one out of it */
  return acos(fmax(-1, fmin(1, -Dot(t[0], t[1]) / fmax(sqrt(Dot(t[0], t[0]) * Dot(t[1], t[1])), DBL_MIN))));
}

/* Gradient, metric and Hessian (11, 12, 22) of half the squared distance. */
typedef struct {
  double G[2], metric[3], hessian[3];
} Slope;

static void SlopeAt(const FacetPolynomial *patch, const FacetPolynomialLocal *l, Slope *slope)
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

/* Newton's step along a reference direction t. Returns by how much it lowers the quadratic model; 0 if t is no
   direction of descent. */
static double StepAlong(const Slope *slope, const double t[2], double d[2])
{
  const double *H = slope->hessian, *a = slope->metric, along = Dot2(slope->G, t),
               stretch = a[0] * t[0] * t[0] + 2 * a[1] * t[0] * t[1] + a[2] * t[1] * t[1];
  double curvature     = H[0] * t[0] * t[0] + 2 * H[1] * t[0] * t[1] + H[2] * t[1] * t[1];

  if (curvature <= FACET_FOCAL * stretch) curvature = stretch;
  for (int k = 0; k < 2; ++k) d[k] = -along / curvature * t[k];
  return along < 0 ? along * along / curvature : 0;
}

/* Newton's step in the plane, with the metric where the Hessian is not positive. */
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

/* Finds a direction of descent d that respects the active sides, and releases the sides that it leaves. Returns 0 at
   a stationary corner. */
static int Direction(const FacetPolynomialDomain *domain, const Slope *slope, unsigned *active, double d[2])
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

/* Puts the point exactly on side s. */
static void Snap(const FacetPolynomialDomain *domain, const double limit[], int s, double xi[2])
{
  const double *n   = domain->normal[s];
  const double  off = (domain->offset[s] + Dot2(n, xi) - limit[s]) / Dot2(n, n);

  for (int k = 0; k < 2; ++k) xi[k] -= off * n[k];
}

/* The fraction of the step d up to the first side in its way. *hit is that side, or -1. */
static double Reach(const FacetPolynomialDomain *domain, const double limit[], const FacetPolynomialPoint *point,
                    const double d[2], int *hit)
{
  double reach = 1;

  *hit = -1;
  for (int s = 0; s < domain->sides; ++s) {
    const double speed = Dot2(domain->normal[s], d),
                 room  = domain->offset[s] + Dot2(domain->normal[s], point->xi) - limit[s];

    if (point->active & (1u << s) || speed >= 0 || room + reach * speed > 0) continue;
    reach = fmax(0, room / -speed);
    *hit  = s;
  }
  return reach;
}

/*@
  FacetPolynomialDescend - goes from a point to a local minimum of the distance over the polygon.

  Not collective

  Input Parameters:
+ patch - the polynomial
- limit - limits of the sides: 0, or negative where the facet is extended

  Input/Output Parameter:
. point - on entry the start; on return the minimum, with the sides at which it is held

  Note:
  Plain C.
@*/
void FacetPolynomialDescend(const FacetPolynomial *patch, const double limit[], FacetPolynomialPoint *point)
{
  const FacetPolynomialDomain *domain = patch->domain;
  FacetPolynomialLocal         l;

  FacetPolynomialEvaluate(patch, point->xi, &l);
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
      FacetPolynomialEvaluate(patch, xi, &l);
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

/* Is sample (i, j) nearer than its neighbours on the grid? */
static int LocalMinimum(const FacetPolynomialDomain *domain, double value[SAMPLES][SAMPLES], int i, int j)
{
  for (int p = i > 0 ? i - 1 : 0; p <= i + 1 && p < SAMPLES; ++p) {
    for (int q = j > 0 ? j - 1 : 0; q <= j + 1 && q < SampleColumns(domain, p); ++q) {
      const int earlier = p < i || (p == i && q < j);

      if (domain->sides == 3 && p - i == q - j) continue; /* these lie across a triangle of the grid */
      if (value[p][q] < value[i][j] || (earlier && value[p][q] == value[i][j])) return 0;
    }
  }
  return 1;
}

/* Adds the sides on which the point lies. */
static void Activate(const FacetPolynomialDomain *domain, FacetPolynomialPoint *point)
{
  for (int s = 0; s < domain->sides; ++s)
    if (domain->offset[s] + Dot2(domain->normal[s], point->xi) <= FACET_COINCIDENT * domain->width)
      point->active |= 1u << s;
}

/*@
  FacetPolynomialClosest - finds the closest point of the polygon without extension.

  Not collective

  Input Parameter:
. patch - the polynomial

  Output Parameter:
. best - the best result of the descents from all local minima of the samples

  Note:
  Plain C.
@*/
void FacetPolynomialClosest(const FacetPolynomial *patch, FacetPolynomialPoint *best)
{
  static const double          inside[FACET_POLYNOMIAL_MAX_SIDES] = {0};
  const FacetPolynomialDomain *domain                             = patch->domain;
  double                       value[SAMPLES][SAMPLES], least = INFINITY;

  if (patch->flat) {
    memcpy(best->xi, domain->centre, sizeof(best->xi));
    best->active = 0;
    FacetPolynomialDescend(patch, inside, best);
    Activate(domain, best);
    return;
  }
  Sample(patch, value);
  for (int i = 0; i < SAMPLES; ++i) {
    for (int j = 0; j < SampleColumns(domain, i); ++j) {
      FacetPolynomialPoint point = {.active = 0};
      double               distance2;

      if (!LocalMinimum(domain, value, i, j)) continue;
      SamplePoint(domain, i, j, point.xi);
      Activate(domain, &point);
      FacetPolynomialDescend(patch, inside, &point);
      distance2 = Dot(point.x, point.x);
      if (distance2 >= least) continue;
      least = distance2;
      *best = point;
    }
  }
  Activate(domain, best);
}

/*@
  FacetPolynomialClassify - determines in which region a point lies.

  Not collective

  Input Parameters:
+ patch - the polynomial
- point - the point with its active sides

  Output Parameters:
+ region  - interior, edge or vertex
- feature - number of the edge or corner; -1 in the interior

  Note:
  The region follows from the active sides and from the remaining tangential part of the residual. Plain C.
@*/
void FacetPolynomialClassify(const FacetPolynomial *patch, const FacetPolynomialPoint *point, FootRegion *region,
                             int *feature)
{
  const FacetPolynomialDomain *domain = patch->domain;
  const double         distance = sqrt(Dot(point->x, point->x)), tolerance = FACET_TIE * (patch->size + distance);
  const int            apart = distance > FACET_TOUCHING * patch->size, last = domain->sides - 1;
  const int            two_sides = (point->active & (point->active - 1)) != 0;
  FacetPolynomialLocal l;
  double               cross[3], G[2], tangential2, area2;

  FacetPolynomialEvaluate(patch, point->xi, &l);
  *region  = FOOT_VERTEX;
  *feature = 0;
  if (two_sides && point->active != (1u | 1u << last))
    *feature = __builtin_ctz(point->active) + 1;
  else if (point->active && !two_sides)
    *feature = __builtin_ctz(point->active);
  if (Degenerate(&l, patch->size, cross)) return;
  G[0]  = Dot(l.x, l.x1);
  G[1]  = Dot(l.x, l.x2);
  area2 = Dot(cross, cross);
  tangential2 =
    (Dot(l.x2, l.x2) * G[0] * G[0] - 2 * Dot(l.x1, l.x2) * G[0] * G[1] + Dot(l.x1, l.x1) * G[1] * G[1]) / area2;
  if (!point->active ? point->converged || tangential2 <= tolerance * tolerance
                     : apart && tangential2 <= tolerance * tolerance) {
    *region  = FOOT_INTERIOR;
    *feature = -1;
  } else if (point->active && domain != &line) {
    for (int s = 0; s <= last; ++s) {
      const double *t    = domain->tangent[s];
      const double  v[3] = {t[0] * l.x1[0] + t[1] * l.x2[0], t[0] * l.x1[1] + t[1] * l.x2[1],
                            t[0] * l.x1[2] + t[1] * l.x2[2]};

      if (!(point->active & (1u << s)) || (two_sides && !(apart && fabs(Dot2(G, t)) <= tolerance * sqrt(Dot(v, v)))))
        continue;
      *region  = FOOT_EDGE;
      *feature = s;
      return;
    }
  }
}
