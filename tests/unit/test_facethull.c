/* The hull of a facet holds the facet and its normals, and tells of a point no other side than the foot on the facet.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "smooth/facethull.h"

enum { FACETS = 400, POINTS = 20 };

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

/* A facet about one unit wide, whose nodes are moved by up to `bend`. Returns its dimension. */
static int RandomFacet(ElementType type, double bend, Facet *facet, double *x)
{
  const Element *element = ElementGet(type);
  const int      dim     = element->dim + 1;

  memset(facet, 0, sizeof(*facet));
  facet->type = type;
  for (int a = 0; a < element->nodes; ++a) {
    facet->nodes[a] = a;
    for (int k = 0; k < dim; ++k) x[a * dim + k] = (k < element->dim ? element->node[a][k] : 0) + Random(-bend, bend);
  }
  return dim;
}

/* Foot of a point on the facet. */
static void Project(int dim, const Facet *facet, const double *x, const double point[3], Foot *foot)
{
  double relative[FACE_MAX_NODES * 3];

  for (int i = 0; i < ElementGet(facet->type)->nodes * dim; ++i) relative[i] = x[i] - point[i % dim];
  FacetProject(dim, facet, relative, foot);
}

/* The feet of random points lie in the sphere and in the slab, and the side is that of their gap. Flat facets tell it
   of nearly all points, bent ones of many where their nodes are off by a hundredth of the width. */
static void TestSides(void **state)
{
  (void)state;
  for (int t = 0; t < 6; ++t) {
    const int flat = types[t] == ELEMENT_EDGE2 || types[t] == ELEMENT_TRI3;
    int       told = 0;

    for (int f = 0; f < FACETS; ++f) {
      double    x[FACE_MAX_NODES * 3];
      Facet     facet;
      FacetHull hull;
      const int dim = RandomFacet(types[t], f % 2 ? 0.1 : 0.02, &facet, x);

      FacetHullOf(dim, &facet, x, &hull);
      for (int p = 0; p < POINTS; ++p) {
        const double point[3] = {Random(-3, 3), Random(-3, 3), dim == 3 ? Random(-3, 3) : 0};
        double       way = 0, height = 0;
        Foot         foot;
        const int    side = FacetHullSide(&hull, point, 1e-6);

        Project(dim, &facet, x, point, &foot);
        for (int k = 0; k < 3; ++k) {
          const double at = point[k] - foot.gap * foot.normal[k] - hull.centre[k];

          way += at * at;
          height += hull.normal[k] * at;
        }
        assert_true(sqrt(way) <= hull.radius + 1e-9);
        assert_true(height >= hull.low - 1e-9 && height <= hull.high + 1e-9);
        assert_true(side == 0 || (side > 0) == (foot.gap > 0));
        told += f % 2 == 0 && side != 0;
      }
    }
    assert_true(told > (flat ? 0.99 : 0.3) * FACETS / 2 * POINTS);
  }
}

/* The normal at any foot turns from that of the middle by no more than the hull says. */
static void TestTurn(void **state)
{
  (void)state;
  for (int t = 0; t < 6; ++t) {
    for (int f = 0; f < FACETS; ++f) {
      double    x[FACE_MAX_NODES * 3];
      Facet     facet;
      FacetHull hull;
      const int dim = RandomFacet(types[t], 0.05, &facet, x);

      FacetHullOf(dim, &facet, x, &hull);
      for (int p = 0; p < POINTS; ++p) {
        const double point[3] = {Random(-0.8, 0.8), Random(-0.8, 0.8), dim == 3 ? Random(-0.8, 0.8) : 0};
        double       cosine   = 0;
        Foot         foot;

        Project(dim, &facet, x, point, &foot);
        if (foot.region != FOOT_INTERIOR || hull.turn >= 1) continue;
        for (int k = 0; k < 3; ++k) cosine += hull.normal[k] * foot.normal[k];
        assert_true(cosine >= sqrt(1 - hull.turn * hull.turn) - 1e-9);
      }
    }
  }
}

/* A facet without area has no side, and its sphere still holds it. */
static void TestCollapsed(void **state)
{
  const double point[3] = {0, 0, 3}, x[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  const Facet  facet = {.type = ELEMENT_TRI3, .nodes = {0, 1, 2}};
  FacetHull    hull;

  (void)state;
  FacetHullOf(3, &facet, x, &hull);
  assert_true(FacetHullSide(&hull, point, 1e-6) == 0);
  assert_true(fabs(hull.radius - 1) < 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestSides), cmocka_unit_test(TestTurn),
                                     cmocka_unit_test(TestCollapsed)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
