/* The gap to facets is the signed distance. It is continuous across edges and vertices and has exact first and
   second variations in every region. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "smooth/facet.h"

enum { MAX_DOFS = 3 * (1 + FACE_MAX_NODES), MAX_NODES = 128, MAX_FACETS = 32 };

static const ElementType types[] = {ELEMENT_EDGE2, ELEMENT_EDGE3, ELEMENT_TRI3,
                                    ELEMENT_TRI6,  ELEMENT_QUAD4, ELEMENT_QUAD9};

static double Random(double low, double high)
{
  static uint64_t state = 88172645463325252u;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

static int Dim(ElementType type)
{
  return ElementGet(type)->dim + 1;
}

/* A facet about one unit wide, relative to `slave`. Its nodes are moved by up to `bend`. */
static void RandomFacet(ElementType type, double bend, Facet *facet, double *x)
{
  const Element *element = ElementGet(type);

  memset(facet, 0, sizeof(*facet));
  facet->type = type;
  for (int a = 0; a < element->nodes; ++a) {
    facet->nodes[a] = a;
    for (int k = 0; k < Dim(type); ++k)
      x[a * Dim(type) + k] = (k < element->dim ? element->node[a][k] : 0) + Random(-bend, bend);
  }
}

static void Move(int dim, int nodes, const double *x, const double *slave, double *relative)
{
  for (int i = 0; i < nodes * dim; ++i) relative[i] = x[i] - slave[i % dim];
}

/* A rotation by a random angle about a random axis (3D), or about z (2D). */
static void RandomRotation(int dim, double R[3][3])
{
  double       axis[3] = {Random(-1, 1), Random(-1, 1), Random(-1, 1)}, length;
  const double angle = Random(-3, 3), c = cos(angle), s = sin(angle);

  if (dim == 2) axis[0] = axis[1] = 0;
  length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (int i = 0; i < 3; ++i) axis[i] /= length;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j];
    R[i][(i + 2) % 3] += s * axis[(i + 1) % 3];
    R[i][(i + 1) % 3] -= s * axis[(i + 2) % 3];
  }
}

static double Norm(int n, const double *a)
{
  double sum = 0;

  for (int i = 0; i < n; ++i) sum += a[i] * a[i];
  return sqrt(sum);
}

static double MaxDifference(int n, const double *a, const double *b)
{
  double most = 0;

  for (int i = 0; i < n; ++i) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Position of a point of a facet. */
static void At(int dim, const Facet *facet, const double *x, const double *xi, double *at)
{
  double phi[FACE_MAX_NODES];

  ElementShape(facet->type, xi, phi, NULL, NULL);
  for (int k = 0; k < dim; ++k) {
    at[k] = 0;
    for (int a = 0; a < ElementGet(facet->type)->nodes; ++a) at[k] += phi[a] * x[facet->nodes[a] * dim + k];
  }
}

/* Moves one of the dofs (slave point first) and evaluates gap and N. Returns 0 if the foot has changed its region. */
static int Probe(int dim, const Facet *facet, const double *x, const Foot *foot, int dof, double by, double *gap,
                 double *N)
{
  const int nodes = ElementGet(facet->type)->nodes;
  double    moved[MAX_DOFS];
  Foot      there;

  memcpy(moved, x, sizeof(double) * nodes * dim);
  if (dof < dim)
    for (int a = 0; a < nodes; ++a) moved[a * dim + dof] -= by;
  else
    moved[dof - dim] += by;
  FacetProject(dim, facet, moved, &there);
  *gap = there.gap;
  FacetFirstVariation(dim, facet, moved, &there, N);
  return there.region == foot->region && there.feature == foot->feature &&
         fabs(there.xi[0] - foot->xi[0]) + fabs(there.xi[1] - foot->xi[1]) < 0.1;
}

/* Fourth-order central differences: N from the gap, and M from N. Returns 0 where a region ends nearby. */
static int Differences(int dim, const Facet *facet, const double *x, const Foot *foot, double *N, double *M)
{
  const double step = 2e-4, at[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  const int    size = (1 + ElementGet(facet->type)->nodes) * dim;

  for (int i = 0; i < size; ++i) {
    N[i] = 0;
    memset(M + i * size, 0, sizeof(double) * size);
    for (int k = 0; k < 4; ++k) {
      double gap, there[MAX_DOFS];

      if (!Probe(dim, facet, x, foot, i, at[k] * step, &gap, there)) return 0;
      N[i] += weight[k] * gap / step;
      for (int j = 0; j < size; ++j) M[i * size + j] += weight[k] * there[j] / step;
    }
  }
  return 1;
}

static void VariationsOf(ElementType type, int free_edges)
{
  const int dim = Dim(type), nodes = ElementGet(type)->nodes, size = (1 + nodes) * dim;
  int       tested[3][2] = {{0}}, outside = 0;
  double    worst_N = 0, worst_M = 0;

  for (int trial = 0; trial < 600; ++trial) {
    double X[MAX_DOFS], x[MAX_DOFS], slave[3], N[MAX_DOFS], M[MAX_DOFS * MAX_DOFS], N_differences[MAX_DOFS],
      M_differences[MAX_DOFS * MAX_DOFS], scale;
    Facet facet;
    Foot  foot;

    RandomFacet(type, 0.15, &facet, X);
    facet.free_edges = free_edges;
    for (int k = 0; k < dim; ++k) slave[k] = k == dim - 1 ? Random(-0.8, 0.8) : Random(-1.6, 1.6);
    Move(dim, nodes, X, slave, x);
    FacetProject(dim, &facet, x, &foot);
    if (fabs(foot.gap) < 0.05 || (tested[foot.region][foot.gap < 0] >= 12 && !foot.beyond) || !foot.converged) continue;
    if (!Differences(dim, &facet, x, &foot, N_differences, M_differences)) continue;
    FacetFirstVariation(dim, &facet, x, &foot, N);
    FacetSecondVariation(dim, &facet, x, &foot, M);
    scale = Norm(size * size, M);
    if (scale > 30) continue; /* near a centre of curvature the differences are no reference */
    worst_N = fmax(worst_N, MaxDifference(size, N, N_differences) / Norm(size, N));
    worst_M = fmax(worst_M, MaxDifference(size * size, M, M_differences) / fmax(scale, 1));
    for (int i = 0; i < size; ++i) {
      double sum = 0;

      for (int j = 0; j < size; ++j) {
        assert_true(M[i * size + j] == M[j * size + i]);
        if (j % dim == i % dim) sum += M[i * size + j];
      }
      assert_true(fabs(sum) <= 1e-12 * fmax(scale, 1));
    }
    for (int k = 0; k < dim; ++k) {
      double sum = 0;

      for (int a = 0; a <= nodes; ++a) sum += N[a * dim + k];
      assert_true(fabs(sum) <= 1e-13);
    }
    outside += foot.beyond > 0;
    ++tested[foot.region][foot.gap < 0];
  }
  print_message("%-5s free %d: N %.1e M %.1e, interior %d+%d edge %d+%d vertex %d+%d beyond %d\n",
                ElementGet(type)->name, free_edges, worst_N, worst_M, tested[0][0], tested[0][1], tested[1][0],
                tested[1][1], tested[2][0], tested[2][1], outside);
  assert_true(worst_N <= 1e-8);
  assert_true(worst_M <= 1e-7);
  for (int sign = 0; sign < 2; ++sign) {
    assert_true(tested[FOOT_INTERIOR][sign] >= 5);
    assert_true(free_edges || dim == 2 || tested[FOOT_EDGE][sign] >= 5);
    assert_true(free_edges || tested[FOOT_VERTEX][sign] >= 5);
  }
  assert_true(!free_edges || outside >= 5);
}

static void TestVariations(void **state)
{
  (void)state;
  for (size_t t = 0; t < sizeof(types) / sizeof(types[0]); ++t) {
    VariationsOf(types[t], 0);
    VariationsOf(types[t], 1);
  }
}

static void TestRigidMotion(void **state)
{
  (void)state;
  for (int trial = 0; trial < 300; ++trial) {
    const ElementType type = types[trial % 6];
    const int         dim = Dim(type), nodes = ElementGet(type)->nodes, size = (1 + nodes) * dim;
    double x[MAX_DOFS], turned[MAX_DOFS] = {0}, slave[3], N[MAX_DOFS], expected[MAX_DOFS] = {0}, there[MAX_DOFS],
                        R[3][3];
    Facet facet;
    Foot  foot, foot_turned;

    RandomFacet(type, 0.15, &facet, x);
    for (int k = 0; k < dim; ++k) slave[k] = Random(-1.5, 1.5);
    Move(dim, nodes, x, slave, x);
    RandomRotation(dim, R);
    for (int i = 0; i < nodes * dim; ++i)
      for (int k = 0; k < dim; ++k) turned[i] += R[i % dim][k] * x[i - i % dim + k];
    FacetProject(dim, &facet, x, &foot);
    FacetProject(dim, &facet, turned, &foot_turned);
    FacetFirstVariation(dim, &facet, x, &foot, N);
    FacetFirstVariation(dim, &facet, turned, &foot_turned, there);
    for (int i = 0; i < size; ++i)
      for (int k = 0; k < dim; ++k) expected[i] += R[i % dim][k] * N[i - i % dim + k];
    assert_true(fabs(foot.gap - foot_turned.gap) <= 1e-12);
    assert_true(MaxDifference(size, expected, there) <= 1e-8);
    /* There is no moment: N does not change under rotations about the slave point. */
    for (int k = 0; k < dim; ++k) {
      const int p = (k + 1) % dim, q = (k + 2) % dim;
      double    moment = 0;

      for (int i = 0; i < nodes && (dim == 3 || k == 0); ++i)
        moment += dim == 3 ? x[i * dim + p] * N[(1 + i) * dim + q] - x[i * dim + q] * N[(1 + i) * dim + p]
                           : x[i * 2] * N[(1 + i) * 2 + 1] - x[i * 2 + 1] * N[(1 + i) * 2];
      assert_true(fabs(moment) <= 1e-10);
    }
  }
}

/* Smallest distance over a grid of samples of a facet. */
static double Sampled(int dim, const Facet *facet, const double *x, int n)
{
  const int simplex = facet->type == ELEMENT_TRI3 || facet->type == ELEMENT_TRI6;
  double    least   = INFINITY;

  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= (dim == 2 ? 0 : simplex ? n - i : n); ++j) {
      const double s = (double)i / n, t = (double)j / n, xi[2] = {simplex ? s : 2 * s - 1, simplex ? t : 2 * t - 1};
      double       at[3];

      At(dim, facet, x, xi, at);
      least = fmin(least, Norm(dim, at));
    }
  }
  return least;
}

static void TestDistance(void **state)
{
  static const double bends[] = {0.1, 0.2, 0.3};

  (void)state;
  for (int b = 0; b < 3; ++b) {
    int missed = 0, unconverged = 0, trials = 0;

    for (int trial = 0; trial < 1200; ++trial) {
      const ElementType type = types[trial % 6];
      const int         dim = Dim(type), nodes = ElementGet(type)->nodes,
                simplex = type == ELEMENT_TRI3 || type == ELEMENT_TRI6;
      double x[MAX_DOFS], slave[3], at[3], sampled;
      Facet  facet;
      Foot   foot;

      RandomFacet(type, simplex ? 0.5 * bends[b] : bends[b], &facet, x);
      for (int k = 0; k < dim; ++k) slave[k] = Random(-1.5, 1.5);
      Move(dim, nodes, x, slave, x);
      FacetProject(dim, &facet, x, &foot);
      sampled = Sampled(dim, &facet, x, 24);
      At(dim, &facet, x, foot.xi, at);
      assert_true(foot.xi[0] >= (simplex ? 0 : -1) - 1e-15 && foot.xi[1] >= (simplex ? 0 : -1) - 1e-15 &&
                  (simplex ? foot.xi[0] + foot.xi[1] : fmax(foot.xi[0], foot.xi[1])) <= 1 + 1e-15);
      for (int k = 0; k < dim; ++k) assert_true(fabs(at[k] + foot.gap * foot.normal[k]) <= 1e-9 || !foot.converged);
      assert_true(fabs(Norm(3, foot.normal) - 1) <= 1e-14);
      missed += Norm(dim, at) > sampled + 1e-12;
      unconverged += !foot.converged;
      ++trials;
    }
    print_message("nodes moved by up to %g of half the width: %d of %d feet are not the nearest, %d did not converge\n",
                  bends[b], missed, trials, unconverged);
    assert_true(missed <= (b ? 3 : 0)); /* they are hidden between the samples of wrinkled facets */
    assert_true(unconverged <= (b == 2));
  }
}

/* A surface of several facets. */
typedef struct {
  int    dim, nodes, facets;
  double x[3 * MAX_NODES];
  Facet  facet[MAX_FACETS];
} Surface;

static void AddFacet(Surface *surface, ElementType type, int free_edges, const int nodes[])
{
  Facet *facet = &surface->facet[surface->facets];

  *facet = (Facet){.type = type, .free_edges = free_edges, .tag = surface->facets++};
  memcpy(facet->nodes, nodes, sizeof(int) * ElementGet(type)->nodes);
}

static void Closest(const Surface *surface, const double *slave, Foot *foot)
{
  double x[3 * MAX_NODES];

  Move(surface->dim, surface->nodes, surface->x, slave, x);
  assert_int_equal(FacetClosest(surface->dim, surface->facets, surface->facet, x, -1, foot), 1);
}

/* Largest jump of the gap on the way from p to q. Wherever facet or region changes, the place is found by bisection.
   A signed distance can change no faster than the point moves. */
static double LargestJump(const Surface *surface, const double *p, const double *q, int steps, int *changes)
{
  const int dim  = surface->dim;
  double    most = 0, length = 0;
  Foot      before, after;

  for (int k = 0; k < dim; ++k) length = hypot(length, q[k] - p[k]);
  Closest(surface, p, &before);
  *changes = 0;
  for (int i = 1; i <= steps; ++i) {
    double low = (double)(i - 1) / steps, high = (double)i / steps, slave[3];
    Foot   last;

    for (int k = 0; k < dim; ++k) slave[k] = p[k] + high * (q[k] - p[k]);
    Closest(surface, slave, &after);
    last = after;
    if (after.facet != before.facet || after.region != before.region) {
      ++*changes;
      while (high - low > 2 * DBL_EPSILON) {
        const double middle = 0.5 * (low + high);
        Foot         foot;

        for (int k = 0; k < dim; ++k) slave[k] = p[k] + middle * (q[k] - p[k]);
        Closest(surface, slave, &foot);
        if (foot.facet == before.facet && foot.region == before.region) {
          low    = middle;
          before = foot;
        } else {
          high  = middle;
          after = foot;
        }
      }
    }
    most   = fmax(most, fabs(after.gap - before.gap) - (high - low) * length);
    before = last;
  }
  return most;
}

/* Two facets that meet along x = 0 at an angle. With turn > 0 they are convex (a roof). The outward direction is up. */
static void Roof(ElementType type, double turn, Surface *surface)
{
  const double c = cos(turn / 2), s = sin(turn / 2);

  memset(surface, 0, sizeof(*surface));
  if (type == ELEMENT_EDGE2 || type == ELEMENT_EDGE3) {
    const double x[5][2] = {{-c, -s},
                            {0, 0},
                            {c, -s},
                            {-c / 2, -s / 2 + (type == ELEMENT_EDGE3) * 0.02},
                            {c / 2, -s / 2 + (type == ELEMENT_EDGE3) * 0.02}};
    const int    left[] = {1, 0, 3}, right[] = {2, 1, 4};

    surface->dim   = 2;
    surface->nodes = 5;
    memcpy(surface->x, x, sizeof(x));
    AddFacet(surface, type, 0, left);
    AddFacet(surface, type, 0, right);
    return;
  }
  surface->dim = 3;
  for (int side = 0; side < 2; ++side) {
    const Element *element = ElementGet(type);
    int            nodes[FACE_MAX_NODES];
    const int      simplex = type == ELEMENT_TRI3 || type == ELEMENT_TRI6;

    for (int a = 0; a < element->nodes; ++a) {
      double along  = simplex ? element->node[a][1] : (element->node[a][0] + 1) / 2,
             across = simplex ? element->node[a][0] : (element->node[a][1] + 1) / 2;
      const double bulge =
        element->order == 2 ? 0.05 * across * (1 - across) * (1 + along) + 0.1 * along * (1 - along) : 0;

      /* The right facet has its own order (edge x = 0 along y). The left one is its image by half a turn about z. */
      nodes[a] = surface->nodes;
      if (side == 0)
        memcpy(&surface->x[3 * surface->nodes++], (double[3]){across * c, along, -across * s + bulge},
               3 * sizeof(double));
      else
        memcpy(&surface->x[3 * surface->nodes++],
               (double[3]){-across * c, 1 - along,
                           -across * s + (element->order == 2
                                            ? 0.05 * across * (1 - across) * (2 - along) + 0.1 * along * (1 - along)
                                            : 0)},
               3 * sizeof(double));
    }
    if (!simplex) {
      /* Square facets run along y first. They are turned over so that the outward direction is up. */
      static const int flipped[] = {1, 0, 3, 2, 4, 7, 6, 5, 8};
      int              copy[FACE_MAX_NODES];

      memcpy(copy, nodes, sizeof(copy));
      for (int a = 0; a < element->nodes; ++a) nodes[a] = copy[flipped[a]];
    }
    AddFacet(surface, type, 0, nodes);
  }
}

static void TestEdges(void **state)
{
  static const double turns[] = {0.5, 0.02, -0.5, 1.5, -1.5};

  (void)state;
  for (int t = 0; t < 6; ++t) {
    for (int k = 0; k < 5; ++k) {
      Surface surface;

      Roof(types[t], turns[k], &surface);
      for (int level = -2; level <= 2; ++level) {
        const double height = level * 0.04, p2[2] = {-0.3, height}, q2[2] = {0.35, height + 0.01},
                     p3[3] = {-0.3, 0.3, height}, q3[3] = {0.35, 0.45, height + 0.01};
        int  changes;
        Foot foot;

        assert_true(LargestJump(&surface, surface.dim == 2 ? p2 : p3, surface.dim == 2 ? q2 : q3, 200, &changes) <=
                    1e-9);
        assert_true(changes >= 1);
        /* A point above the ridge is outside. A point below it is inside, and contact is never lost. */
        if (level) {
          Closest(&surface, surface.dim == 2 ? (double[3]){0, level * 0.2} : (double[3]){0, 0.4, level * 0.2}, &foot);
          assert_true(foot.gap * level > 0);
          if (turns[k] > 0.1 && level > 0) assert_int_equal(foot.region, surface.dim == 2 ? FOOT_VERTEX : FOOT_EDGE);
          if (turns[k] < -0.1 && level < 0) assert_int_equal(foot.region, surface.dim == 2 ? FOOT_VERTEX : FOOT_EDGE);
        }
      }
    }
  }
}

/* Five triangles around a vertex at the origin. z[] are the heights of the rim. */
static void Fan(const double z[5], Surface *surface)
{
  memset(surface, 0, sizeof(*surface));
  surface->dim   = 3;
  surface->nodes = 6;
  for (int i = 0; i < 5; ++i) {
    const int nodes[] = {0, 1 + i, 1 + (i + 1) % 5};

    memcpy(&surface->x[3 * (1 + i)], (double[3]){cos(2 * M_PI * i / 5), sin(2 * M_PI * i / 5), z[i]},
           3 * sizeof(double));
    AddFacet(surface, ELEMENT_TRI3, 0, nodes);
  }
}

static void TestFan(void **state)
{
  static const double rims[4][5] = {{-0.6, -0.6, -0.6, -0.6, -0.6},
                                    {0.6, 0.6, 0.6, 0.6, 0.6},
                                    {-0.5, 0.4, -0.3, 0.5, -0.1},
                                    {0, 0, 0, 0, 0}};

  (void)state;
  for (int r = 0; r < 4; ++r) {
    Surface surface;

    Fan(rims[r], &surface);
    for (int trial = 0; trial < 40; ++trial) {
      const double height = Random(-0.25, 0.25), angle = Random(0, 6.28),
                   p[3] = {0.4 * cos(angle), 0.4 * sin(angle), height},
                   q[3] = {-p[0] + Random(-0.1, 0.1), -p[1], height};
      int changes;

      assert_true(LargestJump(&surface, p, q, 100, &changes) <= 1e-9);
      assert_true(changes >= 1);
    }
    for (int trial = 0; trial < 400; ++trial) {
      const double slave[3] = {Random(-0.2, 0.2), Random(-0.2, 0.2), Random(-0.2, 0.2)},
                   turn =
                     atan2(slave[1], slave[0]) < 0 ? atan2(slave[1], slave[0]) + 2 * M_PI : atan2(slave[1], slave[0]);
      const int     i = (int)(turn / (2 * M_PI / 5)) % 5, j = (i + 1) % 5;
      const double *a = &surface.x[3 * (1 + i)], *b = &surface.x[3 * (1 + j)], det = a[0] * b[1] - a[1] * b[0];
      /* The surface is a graph, so that its height over the slave point tells the side. */
      const double height =
        (a[2] * (slave[0] * b[1] - slave[1] * b[0]) + b[2] * (a[0] * slave[1] - a[1] * slave[0])) / det;
      Foot foot;

      Closest(&surface, slave, &foot);
      assert_true(foot.gap * (slave[2] - height) >= 0);
    }
  }
}

/* Where the list is cut at an edge of its last facet, a slave point past that edge is outside, however deep it is.
   Above and below the facet nothing changes. */
static void TestCutEdges(void **state)
{
  static const ElementType types[] = {ELEMENT_EDGE2, ELEMENT_TRI3, ELEMENT_QUAD4};

  (void)state;
  for (int t = 0; t < 3; ++t) {
    Surface surface;
    Facet  *facet;

    Roof(types[t], 0.5, &surface);
    facet          = surface.facet;
    surface.facets = 1; /* the facet on the side of x > 0 in 3D, on that of x < 0 in 2D; both end at x = 0 */
    for (int cut = 0; cut < 2; ++cut) {
      Foot past, over;

      facet->cut_edges = cut ? (1 << (surface.dim == 2 ? 2 : ElementGet(types[t])->corners)) - 1 : 0;
      Closest(&surface, surface.dim == 2 ? (double[3]){0.1, -0.2} : (double[3]){-0.1, 0.4, -0.2}, &past);
      Closest(&surface, surface.dim == 2 ? (double[3]){-0.5, -0.2} : (double[3]){0.5, 0.4, -0.2}, &over);
      assert_true(past.region != FOOT_INTERIOR && over.region == FOOT_INTERIOR);
      assert_true(cut ? past.gap > 0.2 : past.gap < -0.2);
      assert_true(past.gap * past.normal[surface.dim - 1] < 0); /* slave - foot = gap * normal points down */
      assert_true(over.gap < 0);
    }
  }
}

/* At an edge or vertex that holds the slave point, the normal is the mean of the normals of its facets. */
static void TestTouching(void **state)
{
  Surface surface;
  Foot    foot;
  double  N[12], M[144], x[18];

  (void)state;
  Fan((double[5]){-0.6, -0.6, -0.6, -0.6, -0.6}, &surface);
  Closest(&surface, (double[3]){0, 0, 0}, &foot);
  assert_int_equal(foot.region, FOOT_VERTEX);
  assert_true(fabs(foot.gap) <= 1e-15 && fabs(foot.normal[2] - 1) <= 1e-14);
  Move(3, 6, surface.x, (double[3]){0, 0, 0}, x);
  FacetFirstVariation(3, &surface.facet[foot.facet], x, &foot, N);
  FacetSecondVariation(3, &surface.facet[foot.facet], x, &foot, M);
  assert_true(fabs(N[2] - 1) <= 1e-14);
  for (int i = 0; i < 144; ++i) assert_true(isfinite(M[i]));
  Roof(ELEMENT_QUAD4, 0.5, &surface);
  Closest(&surface, (double[3]){0, 0.5, 0}, &foot);
  assert_int_equal(foot.region, FOOT_EDGE);
  assert_true(fabs(foot.gap) <= 1e-15 && fabs(foot.normal[2] - 1) <= 1e-12);
  /* At the corner of a cube one face is cut in two. The cut does not turn the normal. */
  memset(&surface, 0, sizeof(surface));
  surface.dim   = 3;
  surface.nodes = 8;
  memcpy(surface.x,
         (double[8][3]){{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {-1, -1, 0}, {0, -1, -1}, {-1, 0, -1}},
         21 * sizeof(double));
  AddFacet(&surface, ELEMENT_TRI3, 0, (int[]){0, 1, 4});
  AddFacet(&surface, ELEMENT_TRI3, 0, (int[]){0, 4, 2});
  AddFacet(&surface, ELEMENT_QUAD4, 0, (int[]){0, 2, 5, 3});
  AddFacet(&surface, ELEMENT_QUAD4, 0, (int[]){0, 3, 6, 1});
  Closest(&surface, (double[3]){0, 0, 0}, &foot);
  assert_int_equal(foot.region, FOOT_VERTEX);
  assert_true(MaxDifference(3, foot.normal, (double[3]){1 / sqrt(3), 1 / sqrt(3), 1 / sqrt(3)}) <= 1e-14);
  /* Over a node of a flat master the slave point does not stick: the second variation is that of the interior. */
  Fan((double[5]){0, 0, 0, 0, 0}, &surface);
  for (int sign = -1; sign <= 1; sign += 2) {
    Closest(&surface, (double[3]){0, 0, sign * 1e-6}, &foot);
    assert_int_equal(foot.region, FOOT_INTERIOR);
    assert_int_equal(foot.facet, 0);
    assert_true(fabs(foot.gap - sign * 1e-6) <= 1e-18);
  }
}

/* Nodes and square facets of a grid of nx by ny faces on a cylinder of the given curvature about the y axis (0:
   flat). All borders are free. */
static void Grid(int nx, int ny, double curvature, Surface *surface)
{
  memset(surface, 0, sizeof(*surface));
  surface->dim = 3;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double s = i - 0.5 * nx;

      memcpy(&surface->x[3 * surface->nodes++],
             (double[3]){curvature ? sin(s * curvature) / curvature : s, j,
                         curvature ? (cos(s * curvature) - 1) / curvature : 0},
             3 * sizeof(double));
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i;

      AddFacet(surface, ELEMENT_QUAD4, (j == 0) | (i == nx - 1) << 1 | (j == ny - 1) << 2 | (i == 0) << 3,
               (int[]){a, a + 1, a + nx + 2, a + nx + 1});
    }
  }
}

static void TestFreeEdges(void **state)
{
  Surface surface;
  Foot    foot;
  int     changes;

  (void)state;
  /* On a flat plate the gap is the height, however far the foot is past edges and corners. */
  Grid(2, 2, 0, &surface);
  for (int trial = 0; trial < 500; ++trial) {
    const double slave[3] = {Random(-1.8, 1.8), Random(-0.8, 2.8), Random(-0.5, 0.5)};
    const double beyond   = hypot(fmax(0, fabs(slave[0]) - 1), fmax(0, fabs(slave[1] - 1) - 1));

    Closest(&surface, slave, &foot);
    assert_true(fabs(foot.gap - slave[2]) <= 1e-12);
    assert_true(fabs(foot.beyond - beyond) <= 1e-12);
    assert_true(fabs(foot.normal[2] - 1) <= 1e-14);
  }
  Closest(&surface, (double[3]){2.5, 1.3, -0.1}, &foot);
  assert_true(foot.gap > 0 && foot.beyond >= 1);
  /* Triangles, one of which touches the border only with a corner, and an obtuse corner on the border. */
  memset(&surface, 0, sizeof(surface));
  surface.dim   = 3;
  surface.nodes = 5;
  memcpy(surface.x, (double[5][3]){{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {-0.8, 1, 0}, {0.3, 0.3, 0}}, 15 * sizeof(double));
  AddFacet(&surface, ELEMENT_TRI3, 5, (int[]){1, 0, 3});
  AddFacet(&surface, ELEMENT_TRI3, 2, (int[]){0, 4, 3});
  AddFacet(&surface, ELEMENT_TRI3, 3, (int[]){0, 2, 4});
  for (int trial = 0; trial < 300; ++trial) {
    const double slave[3] = {Random(-0.9, 0.9), Random(-0.2, 0.2), Random(-0.1, 0.1)};

    Closest(&surface, slave, &foot);
    assert_true(fabs(foot.gap - slave[2]) <= 1e-12);
    assert_true(slave[1] > 0 || fabs(foot.beyond + slave[1]) <= 1e-12);
  }
  /* The end of a faceted pipe, from outside and from inside the material, along the end and across it. */
  for (int sign = -1; sign <= 1; sign += 2) {
    Grid(6, 3, sign * 0.3, &surface);
    for (int trial = 0; trial < 30; ++trial) {
      const double height = Random(-0.15, 0.15), past = Random(-0.3, 0), p[3] = {-1.2, past, height},
                   q[3] = {1.2, past, height}, r[3] = {p[0], -0.3, height}, s[3] = {p[0] + 0.2, 0.4, height};

      assert_true(LargestJump(&surface, p, q, 120, &changes) <= 1e-9);
      assert_true(changes >= 1);
      assert_true(LargestJump(&surface, r, s, 120, &changes) <= 1e-9);
      Closest(&surface, p, &foot);
      assert_true(fabs(foot.beyond + past) <= 1e-9);
    }
  }
  /* A slave point past the end of a ridge that is sharper than a right angle. */
  Roof(ELEMENT_QUAD4, 2.2, &surface);
  for (int f = 0; f < 2; ++f)
    for (int e = 0; e < 4; ++e)
      if (surface.x[3 * surface.facet[f].nodes[e] + 1] == surface.x[3 * surface.facet[f].nodes[(e + 1) % 4] + 1])
        surface.facet[f].free_edges |= 1 << e;
  for (int trial = 0; trial < 40; ++trial) {
    const double across = Random(-0.5, 0.5), past = Random(0.1, 0.4);

    Closest(&surface, (double[3]){across, -past, 0.5}, &foot);
    assert_true(foot.region == FOOT_EDGE && fabs(foot.gap - hypot(across, 0.5)) <= 1e-12 &&
                fabs(foot.beyond - past) <= 1e-12);
  }
  /* A facet that is really there wins over the extension of another one. */
  Grid(1, 1, 0, &surface);
  for (int i = 0; i < 4; ++i)
    memcpy(&surface.x[3 * (4 + i)],
           (double[3]){surface.x[3 * i] + 1.05, surface.x[3 * i + 1], surface.x[3 * i + 2] + 0.3}, 3 * sizeof(double));
  surface.nodes = 8;
  AddFacet(&surface, ELEMENT_QUAD4, 15, (int[]){4, 5, 7, 6});
  Closest(&surface, (double[3]){0.8, 0.5, 0.01}, &foot);
  assert_int_equal(foot.facet, 1);
  assert_true(foot.beyond == 0 && fabs(foot.gap + 0.29) <= 1e-12);
}

static void TestFreeEnds(void **state)
{
  Surface surface;
  Foot    foot;
  int     changes;

  (void)state;
  Roof(ELEMENT_EDGE2, 0, &surface);
  surface.facet[0].free_edges = 2;
  surface.facet[1].free_edges = 1;
  for (int trial = 0; trial < 200; ++trial) {
    const double slave[2] = {Random(-1.9, 1.9), Random(-0.5, 0.5)};

    Closest(&surface, slave, &foot);
    assert_true(fabs(foot.gap - slave[1]) <= 1e-12 && fabs(foot.beyond - fmax(0, fabs(slave[0]) - 1)) <= 1e-12);
  }
  Closest(&surface, (double[2]){2.5, -0.2}, &foot);
  assert_true(foot.gap > 0 && foot.beyond >= 1 && foot.region == FOOT_VERTEX);
  Roof(ELEMENT_EDGE3, 0.3, &surface);
  surface.facet[0].free_edges = 2;
  surface.facet[1].free_edges = 1;
  assert_true(LargestJump(&surface, (double[2]){0.5, -0.1}, (double[2]){1.3, -0.1}, 100, &changes) <= 1e-9);
  assert_true(changes == 0);
}

static void TestFarAndDegenerate(void **state)
{
  (void)state;
  for (int t = 0; t < 6; ++t) {
    const int nodes = ElementGet(types[t])->nodes, dim = Dim(types[t]), size = (1 + nodes) * dim;
    double    x[MAX_DOFS], N[MAX_DOFS], M[MAX_DOFS * MAX_DOFS];
    Facet     facet;
    Foot      foot;

    for (double far = 1e1; far < 1e9; far *= 10) {
      double slave[3] = {0.3 * far, 0.7 * far, -0.5 * far};

      RandomFacet(types[t], 0.1, &facet, x);
      Move(dim, nodes, x, slave, x);
      FacetProject(dim, &facet, x, &foot);
      assert_true(fabs(fabs(foot.gap) / Sampled(dim, &facet, x, 40) - 1) <= 0.01 / far + 1e-14);
      assert_true(foot.converged);
    }
    for (int collapsed = 0; collapsed < 3; ++collapsed) { /* to a point, a corner onto its neighbour, to a line */
      for (int trial = 0; trial < 20; ++trial) {
        RandomFacet(types[t], 0.1, &facet, x);
        for (int i = 0; collapsed == 0 && i < nodes * dim; ++i) x[i] = x[i % dim];
        for (int k = 0; collapsed == 1 && k < dim; ++k) x[dim + k] = x[k];
        for (int i = 0; collapsed == 2 && i < nodes * dim; ++i) x[i] = x[i - i % dim];
        Move(dim, nodes, x, (double[3]){Random(-1, 1), Random(-1, 1), trial % 2 ? 0 : Random(-1, 1)}, x);
        if (trial == 19) memset(x, 0, sizeof(x));
        facet.free_edges = trial % 3 ? 0 : 15;
        FacetProject(dim, &facet, x, &foot);
        FacetFirstVariation(dim, &facet, x, &foot, N);
        FacetSecondVariation(dim, &facet, x, &foot, M);
        assert_true(isfinite(foot.gap) && fabs(Norm(3, foot.normal) - 1) <= 1e-12);
        assert_true(facet.free_edges ||
                    fabs(foot.gap) <= 1.1 * Sampled(dim, &facet, x, 10) +
                                        1e-12); /* an edge that is folded onto itself has a false stationary point */
        for (int i = 0; i < size; ++i) assert_true(isfinite(N[i]));
        for (int i = 0; i < size * size; ++i) assert_true(isfinite(M[i]));
      }
    }
  }
}

static void TestExtruded(void **state)
{
  (void)state;
  for (int trial = 0; trial < 300; ++trial) {
    const int quadratic = trial % 2;
    double    x[6], solid[27];
    Facet     edge, face = {.type = quadratic ? ELEMENT_QUAD9 : ELEMENT_QUAD4, .nodes = {0, 1, 2, 3, 4, 5, 6, 7, 8}};
    Foot      plane, space;

    RandomFacet(quadratic ? ELEMENT_EDGE3 : ELEMENT_EDGE2, 0.2, &edge, x);
    Move(2, quadratic ? 3 : 2, x, (double[2]){Random(-1.5, 1.5), Random(-0.6, 0.6)}, x);
    if (trial % 3 == 0) {
      edge.free_edges = 3;
      face.free_edges = 10;
    }
    for (int a = 0; a < 9; ++a) {
      const double *node = ElementGet(ELEMENT_QUAD9)->node[a];
      const int     of   = node[0] < 0 ? 0 : node[0] > 0 ? 1 : 2;

      if (of == 2 && !quadratic) continue;
      memcpy(&solid[3 * a], (double[3]){x[2 * of], x[2 * of + 1], node[1]}, 3 * sizeof(double));
    }
    FacetProject(2, &edge, x, &plane);
    FacetProject(3, &face, solid, &space);
    assert_true(fabs(plane.gap - space.gap) <= 1e-13 && MaxDifference(3, plane.normal, space.normal) <= 1e-8);
    assert_int_equal(plane.region == FOOT_VERTEX, space.region == FOOT_EDGE);
    assert_true(plane.beyond < 1 ? fabs(plane.beyond - space.beyond) <= 1e-12 : space.beyond >= 1);
  }
}

static void TestOrder(void **state)
{
  Surface surface, shuffled;
  Foot    foot, other;

  (void)state;
  assert_int_equal(FacetClosest(3, 0, NULL, NULL, -1, &foot), 0);
  Grid(4, 4, 0.2, &surface);
  for (int trial = 0; trial < 400; ++trial) {
    double slave[3] = {Random(-2, 2), Random(0, 4), Random(-0.5, 0.5)}, x[3 * MAX_NODES], least = INFINITY;

    if (trial % 4 == 0) memcpy(slave, &surface.x[3 * (trial % surface.nodes)], sizeof(slave)); /* on a node */
    if (trial % 8 == 0) slave[2] += 0.1;
    if (trial % 3 == 0) slave[2] *= 10;
    shuffled = surface;
    for (int i = 0; i < surface.facets; ++i) {
      const int   j    = (int)Random(0, surface.facets);
      const Facet swap = shuffled.facet[i];

      shuffled.facet[i] = shuffled.facet[j];
      shuffled.facet[j] = swap;
    }
    Move(3, surface.nodes, surface.x, slave, x);
    FacetClosest(3, surface.facets, surface.facet, x, trial % surface.facets, &foot);
    FacetClosest(3, surface.facets, shuffled.facet, x, -1, &other);
    assert_int_equal(surface.facet[foot.facet].tag, shuffled.facet[other.facet].tag);
    assert_true(foot.gap == other.gap && foot.region == other.region && foot.beyond == other.beyond);
    assert_true(MaxDifference(3, foot.normal, other.normal) <= 1e-13);
    /* The list leaves out no facet that is nearer. */
    for (int i = 0; i < surface.facets; ++i) shuffled.facet[i].free_edges = 0;
    FacetClosest(3, surface.facets, shuffled.facet, x, -1, &foot);
    for (int i = 0; i < surface.facets; ++i) {
      FacetProject(3, &shuffled.facet[i], x, &other);
      least = fmin(least, fabs(other.gap));
    }
    assert_true(fabs(fabs(foot.gap) - least) <= 1e-12);
  }
}

/* Side e of a facet is edge e of its element, and corner e is the start of that side. */
static void TestFeatures(void **state)
{
  (void)state;
  for (int t = 2; t < 6; ++t) {
    const Element *element = ElementGet(types[t]);

    for (int e = 0; e < element->corners; ++e) {
      double       x[MAX_DOFS], middle[3] = {0}, corner[3] = {0};
      const double simplex = element->corners == 3 ? 1. / 3 : 0;
      Facet        facet;
      Foot         foot;

      RandomFacet(types[t], 0, &facet, x);
      for (int k = 0; k < 2; ++k) {
        middle[k] =
          0.5 * (element->node[element->edge_corners[e][0]][k] + element->node[element->edge_corners[e][1]][k]);
        middle[k] += 0.1 * (middle[k] - simplex);
        corner[k] = element->node[e][k] + 0.1 * (element->node[e][k] - simplex);
      }
      Move(3, element->nodes, x, middle, x);
      FacetProject(3, &facet, x, &foot);
      assert_true(foot.region == FOOT_EDGE && foot.feature == e && foot.gap > 0);
      RandomFacet(types[t], 0, &facet, x);
      Move(3, element->nodes, x, corner, x);
      FacetProject(3, &facet, x, &foot);
      assert_true(foot.region == FOOT_VERTEX && foot.feature == e);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestFeatures),
                                     cmocka_unit_test(TestVariations),
                                     cmocka_unit_test(TestRigidMotion),
                                     cmocka_unit_test(TestDistance),
                                     cmocka_unit_test(TestEdges),
                                     cmocka_unit_test(TestCutEdges),
                                     cmocka_unit_test(TestFan),
                                     cmocka_unit_test(TestTouching),
                                     cmocka_unit_test(TestFreeEdges),
                                     cmocka_unit_test(TestFreeEnds),
                                     cmocka_unit_test(TestFarAndDegenerate),
                                     cmocka_unit_test(TestExtruded),
                                     cmocka_unit_test(TestOrder)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
