/* Measures the facet smoother in CPU microseconds per slave point, by type of facet, and the search tree. Of the
   smoother it measures one projection, the closest point in lists of 9 and of 25 facets, N and M. A line is row, column
   and value; a line with # begins a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "bench.h"
#include "smooth/facet.h"
#include "base/boxtree.h"

/* Numbers of slave points and of repetitions, largest number of dofs of a slave node and a facet, largest side of a
   patchwork in facets, and largest number of its nodes. */
enum {
  POINTS        = 2000,
  REPEATS       = 20,
  MAX_DOFS      = 3 * (1 + FACE_MAX_NODES),
  MAX_SIDE      = 5,
  MAX_POSITIONS = 25 * FACE_MAX_NODES
};

/* Makes side times side facets of width 1 on a sphere or circle of radius 8. Each facet has its own nodes. In 2D the
   facets are a strip, and triangles are pairs that fill a square. Returns the number of nodes. */
static int Patchwork(ElementType type, int side, Facet *facets, double *x)
{
  const Element *element = ElementGet(type);
  const int      dim = element->dim + 1, simplex = element->dim == 2 && element->corners == 3;
  int            n = 0, nodes = 0;

  for (int f = 0; f < side * side; ++f) {
    const int    cell = simplex ? f / 2 : f, row = element->dim == 1 ? 0 : cell / side;
    const double corner[2] = {(element->dim == 1 ? f : cell % side) - 0.5 * side, row - 0.5 * side};

    facets[n] = (Facet){.type = type, .tag = n};
    for (int a = 0; a < element->nodes; ++a, ++nodes) {
      const double *node = element->node[a];
      double        at[2], r2 = 0;

      for (int k = 0; k < element->dim; ++k) {
        at[k] = corner[k] + (simplex ? (f % 2 ? 1 - node[k] : node[k]) : 0.5 + 0.5 * node[k]);
        r2 += at[k] * at[k];
        x[nodes * dim + k] = at[k];
      }
      x[nodes * dim + dim - 1] = -r2 / 16;
      facets[n].nodes[a]       = nodes;
    }
    ++n;
  }
  return nodes;
}

/* Returns the shortest time of some repetitions, in microseconds per point. The time includes the projection and the
   variations up to `order`; with order < 0 it includes only the preparation. If `seeded` is not 0, the closest point is
   searched a second time from the facet that was found. */
static double Time(ElementType type, int n, int nodes, const Facet *facets, const double *x, int order, int seeded)
{
  const int dim  = ElementGet(type)->dim + 1;
  double    best = INFINITY, N[MAX_DOFS], M[MAX_DOFS * MAX_DOFS];

  for (int repeat = 0; repeat < REPEATS; ++repeat) {
    double begin, sum = 0;

    srand(1);
    begin = Seconds();
    for (int p = 0; p < POINTS; ++p) {
      const double slave[3] = {Random(-1, 1), dim == 2 ? -0.05 : Random(-1, 1), -0.1};
      double       relative[3 * MAX_POSITIONS];
      Foot         foot;

      for (int i = 0; i < nodes * dim; ++i) relative[i] = x[i] - slave[i % dim];
      if (order < 0) {
        sum += relative[0];
        continue;
      }
      FacetClosest(dim, n, facets, relative, -1, &foot);
      if (seeded) FacetClosest(dim, n, facets, relative, foot.facet, &foot);
      if (order > 0) FacetFirstVariation(dim, &facets[foot.facet], relative, &foot, N);
      if (order > 1) FacetSecondVariation(dim, &facets[foot.facet], relative, &foot, M);
      sum += foot.gap + (order > 0 ? N[0] : 0) + (order > 1 ? M[0] : 0);
    }
    best = fmin(best, 1e6 * (Seconds() - begin) / POINTS);
    if (sum == 1) puts("");
  }
  return best;
}

static void Print(const char *row, const char *column, double value)
{
  printf("%s %s %.2f\n", row, column, value);
}

static void BenchFacets(void)
{
  static const ElementType types[] = {ELEMENT_EDGE2, ELEMENT_EDGE3, ELEMENT_TRI3,
                                      ELEMENT_TRI6,  ELEMENT_QUAD4, ELEMENT_QUAD9};

  puts("# facet smoother, CPU microseconds per slave point: closest point in a list, again from the last one (seeded), "
       "first and second variation");
  for (int t = 0; t < 6; ++t) {
    double us[3][2], N = 0, M = 0;

    for (int s = 0; s < 3; ++s) {
      Facet     facets[MAX_SIDE * MAX_SIDE];
      double    x[3 * MAX_POSITIONS], base;
      const int side = 1 + 2 * s, n = side * side, nodes = Patchwork(types[t], side, facets, x);

      base     = Time(types[t], n, nodes, facets, x, -1, 0);
      us[s][0] = Time(types[t], n, nodes, facets, x, 0, 0);
      us[s][1] = Time(types[t], n, nodes, facets, x, 0, 1) - us[s][0];
      if (s == 1) {
        N = Time(types[t], n, nodes, facets, x, 1, 0) - us[s][0];
        M = Time(types[t], n, nodes, facets, x, 2, 0) - us[s][0] - N;
      }
      us[s][0] -= base;
    }
    Print(ElementGet(types[t])->name, "closest-of-1", us[0][0]);
    Print(ElementGet(types[t])->name, "closest-of-9", us[1][0]);
    Print(ElementGet(types[t])->name, "seeded-of-9", us[1][1]);
    Print(ElementGet(types[t])->name, "closest-of-25", us[2][0]);
    Print(ElementGet(types[t])->name, "seeded-of-25", us[2][1]);
    Print(ElementGet(types[t])->name, "N", N);
    Print(ElementGet(types[t])->name, "M", M);
  }
}

static void VisitCentre(void *context, int index, double *bound)
{
  const double *const *data = context;
  double               sum  = 0;

  for (int k = 0; k < 3; ++k) {
    const double d = 0.5 * (data[0][3 * index + k] + data[1][3 * index + k]) - data[2][k];

    sum += d * d;
  }
  *bound = fmin(*bound, sqrt(sum));
}

/* Measures the search tree of n boxes on a sheet, because the facets of a contact surface lie in the same way. */
static int BenchTree(int n)
{
  const int side = (int)sqrt(n);
  double *lower = malloc(sizeof(double) * 3 * n), *upper = malloc(sizeof(double) * 3 * n), begin, build, near, closest;
  int     found[64], total                               = 0;
  char    row[16];
  BoxTree tree;

  if (!lower || !upper) return 1;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      lower[3 * i + k] = k == 0 ? i % side : k == 1 ? (double)(i / side) : 0;
      upper[3 * i + k] = lower[3 * i + k] + (k < 2);
    }
  }
  begin = Seconds();
  if (BoxTreeBuild(3, n, lower, upper, &tree)) return 1;
  build = Seconds() - begin;
  begin = Seconds();
  for (int p = 0; p < POINTS; ++p)
    total += BoxTreeNear(tree, (double[3]){Random(0, side), Random(0, side), 0.1}, 1.2, 64, found);
  near  = Seconds() - begin;
  begin = Seconds();
  for (int p = 0; p < POINTS; ++p) {
    const double  point[3] = {Random(0, side), Random(0, side), 0.1};
    const double *data[3]  = {lower, upper, point};
    double        bound    = INFINITY;

    BoxTreeClosest(tree, point, NULL, &bound, VisitCentre, data);
  }
  closest = Seconds() - begin;
  snprintf(row, sizeof(row), "%d", n);
  Print(row, "build", 1e6 * build / n);
  Print(row, "near", 1e6 * near / POINTS);
  Print(row, "found", (double)total / POINTS);
  Print(row, "closest", 1e6 * closest / POINTS);
  BoxTreeDestroy(&tree);
  free(lower);
  free(upper);
  return 0;
}

int main(void)
{
  BenchFacets();
  puts("# search tree, by its number of boxes: CPU microseconds per box (build) and per point (near, closest); boxes "
       "found near a point");
  return BenchTree(100) || BenchTree(10000) || BenchTree(250000);
}
