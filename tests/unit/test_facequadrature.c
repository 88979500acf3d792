/* The face rules integrate polynomials up to their order, the hat functions are positive with sum one, and every
   node of a face gets area. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include "search/facequadrature.h"

static const ElementType types[] = {ELEMENT_EDGE2, ELEMENT_EDGE3, ELEMENT_TRI3,
                                    ELEMENT_TRI6,  ELEMENT_QUAD4, ELEMENT_QUAD9};
enum { TYPES = sizeof(types) / sizeof(types[0]) };

static double Factorial(int n)
{
  return n > 1 ? n * Factorial(n - 1) : 1;
}

/* Integral of x^i y^j over the reference face. */
static double Exact(const Element *e, int i, int j)
{
  if (e->dim == 2 && e->corners == 3) return Factorial(i) * Factorial(j) / Factorial(i + j + 2);
  return (i % 2 ? 0 : 2. / (i + 1)) * (e->dim == 1 ? 1 : j % 2 ? 0 : 2. / (j + 1));
}

static void test_degree(void **state)
{
  static const int triangle[2][FACE_RULES] = {{2, 4, 4}, {4, 6, 6}}; /* by order and rule */

  (void)state;
  for (int t = 0; t < TYPES; t++) {
    const Element *e = ElementGet(types[t]);

    for (int finer = 0; finer < FACE_RULES; finer++) {
      const FaceRule *rule   = FaceRuleGet(types[t], finer);
      const int       tensor = 2 * (e->order + 1 + (finer > 0)) - 1,
                degree       = e->corners == 3 ? triangle[e->order - 1][finer] : tensor;

      for (int i = 0; i <= degree; i++) {
        for (int j = 0; j <= (e->dim == 1 ? 0 : e->corners == 3 ? degree - i : degree); j++) {
          double sum = 0;

          for (int q = 0; q < rule->n; q++) sum += rule->weight[q] * pow(rule->xi[q][0], i) * pow(rule->xi[q][1], j);
          assert_true(fabs(sum - Exact(e, i, j)) < 1e-14);
        }
      }
    }
  }
}

static void test_hats(void **state)
{
  (void)state;
  for (int t = 0; t < TYPES; t++) {
    const Element *e = ElementGet(types[t]);

    for (int a = 0; a < e->nodes; a++) { /* each is one at its node and zero at the others */
      double psi[FACE_MAX_NODES];

      FaceHat(types[t], e->node[a], psi);
      for (int b = 0; b < e->nodes; b++) assert_true(fabs(psi[b] - (a == b)) < 1e-15);
    }
    for (int finer = 0; finer < FACE_RULES; finer++) {
      const FaceRule *rule                 = FaceRuleGet(types[t], finer);
      double          area[FACE_MAX_NODES] = {0};

      for (int q = 0; q < rule->n; q++) {
        double sum = 0;

        for (int a = 0; a < e->nodes; a++) {
          assert_true(rule->hat[q][a] >= 0);
          sum += rule->hat[q][a];
          area[a] += rule->weight[q] * rule->hat[q][a];
        }
        assert_true(fabs(sum - 1) < 1e-15);
      }
      for (int a = 0; a < e->nodes; a++) assert_true(area[a] > 0);
    }
  }
}

/* Degree up to which a rule with ends is exact: on lines as the other one, in space up to 5. */
static int DegreeWithEnds(const Element *e, int finer)
{
  const int line = 2 * (e->order + 1 + (finer > 0) + (e->dim == 1)) - 1;

  return e->corners == 3 || (e->dim == 2 && line > 5) ? 5 : line;
}

/* Rules with ends are exact up to their degree, have positive weights, and give all corners and edges a point. */
static void test_ends(void **state)
{
  (void)state;
  for (int k = 0; k < FACE_RULES * TYPES; k++) {
    const Element  *e     = ElementGet(types[k / FACE_RULES]);
    const int       finer = k % FACE_RULES, degree = DegreeWithEnds(e, finer), edges = e->dim == 1 ? 2 : e->edges;
    const FaceRule *rule   = FaceRuleWithEnds(e->type, finer);
    int             at_two = 0, seen = 0;

    assert_true(rule->n <= FACE_RULE_POINTS && FaceRuleOf(e->type, finer, 1) == rule);
    assert_true(FaceRuleOf(e->type, finer, 0) == FaceRuleGet(e->type, finer));
    for (int i = 0; i <= degree; i++) {
      for (int j = 0; j <= (e->dim == 1 ? 0 : e->corners == 3 ? degree - i : degree); j++) {
        double sum = 0;

        for (int q = 0; q < rule->n; q++) sum += rule->weight[q] * pow(rule->xi[q][0], i) * pow(rule->xi[q][1], j);
        assert_true(fabs(sum - Exact(e, i, j)) < 1e-14);
      }
    }
    for (int q = 0; q < rule->n; q++) {
      assert_true(rule->weight[q] > 0);
      seen |= rule->edges[q];
      at_two += (rule->edges[q] & (rule->edges[q] - 1)) != 0;
    }
    assert_int_equal(seen, (1 << edges) - 1);
    assert_int_equal(at_two, e->dim == 1 ? 0 : e->corners);
  }
}

/* The values for the element's quadrature points are shares of 1 and keep the hats' products with shape functions, as
   the finer rule has them; in second-order triangles those with linear functions. */
static void test_hats_around(void **state)
{
  (void)state;
  for (int k = 0; k < FACE_RULES * TYPES; k++) {
    const int       t = k / FACE_RULES, finer = k % FACE_RULES;
    const Element  *e                                     = ElementGetFace(types[t]);
    const FaceRule *rule                                  = FaceRuleGet(types[t], finer);
    const int       linear                                = e->corners == 3 && e->dim == 2 && e->order == 2;
    double          whole[FACE_MAX_NODES][FACE_MAX_NODES] = {{0}}, points[FACE_MAX_NODES][FACE_MAX_NODES] = {{0}};

    for (int q = 0; q < rule->n; q++)
      for (int a = 0; a < e->nodes; a++)
        for (int b = 0; b < e->nodes; b++)
          whole[a][b] += rule->weight[q] * (linear ? (b < 2 ? rule->xi[q][b] : 1) : rule->N[q][b]) * rule->hat[q][a];
    for (int p = 0; p < e->points; p++) {
      double psi[FACE_MAX_NODES], sum = 0;

      FaceHatAround(types[t], p, finer, psi);
      for (int a = 0; a < e->nodes; a++) {
        assert_true(psi[a] > -0.1);
        sum += psi[a];
        for (int b = 0; b < e->nodes; b++)
          points[a][b] += e->weight[p] * (linear ? (b < 2 ? e->point[p][b] : 1) : e->N[p][b]) * psi[a];
      }
      assert_true(fabs(sum - 1) < 1e-14);
    }
    for (int a = 0; a < e->nodes; a++)
      for (int b = 0; b < e->nodes; b++) assert_true(fabs(points[a][b] - whole[a][b]) < 1e-14);
  }
}

/* The rule on halves integrates the hat functions of a second-order edge, which have a kink in its middle, times a
   parabola. */
static void test_kink(void **state)
{
  static const double exact[2] = {0.5, 1}, moment[2] = {1. / 4, 1. / 6}; /* corner, middle */
  const FaceRule     *rule = FaceRuleGet(ELEMENT_EDGE3, FACE_RULE_FINEST);

  (void)state;
  for (int a = 0; a < 3; a++) {
    const int node   = fabs(ElementGet(ELEMENT_EDGE3)->node[a][0]) < 0.5 ? 1 : 0;
    double    sum[2] = {0, 0};

    for (int q = 0; q < rule->n; q++)
      for (int k = 0; k < 2; k++) sum[k] += rule->weight[q] * rule->hat[q][a] * (k ? pow(rule->xi[q][0], 2) : 1);
    assert_true(fabs(sum[0] - exact[node]) < 1e-15 && fabs(sum[1] - moment[node]) < 1e-15);
  }
}

/* Areas and normals of a tilted square and of an edge about the axis. */
static void test_areas(void **state)
{
  const double    square[12] = {0, 0, 0, 2, 0, 1, 2, 2, 1, 0, 2, 0}, edge[4] = {1, 0, 3, 2};
  double          area[FACE_RULE_POINTS], normal[FACE_RULE_POINTS * 3], sum = 0;
  const FaceRule *rule = FaceRuleGet(ELEMENT_QUAD4, 1);

  (void)state;
  FaceRuleAreas(rule, ELEMENT_QUAD4, 3, GEOMETRY_SOLID, square, area, normal);
  for (int q = 0; q < rule->n; q++) {
    sum += area[q];
    assert_true(fabs(normal[3 * q] + 1 / sqrt(5)) < 1e-14 && fabs(normal[3 * q + 1]) < 1e-14 &&
                fabs(normal[3 * q + 2] - 2 / sqrt(5)) < 1e-14);
  }
  assert_true(fabs(sum - 2 * sqrt(5)) < 1e-13);
  rule = FaceRuleGet(ELEMENT_EDGE2, 0);
  sum  = 0;
  FaceRuleAreas(rule, ELEMENT_EDGE2, 2, GEOMETRY_AXISYMMETRIC, edge, area, normal);
  for (int q = 0; q < rule->n; q++) sum += area[q];
  assert_true(fabs(sum - 8 * acos(-1) * sqrt(2)) < 1e-12 * sum); /* 2 pi 2 times the length 2 sqrt 2 */
  assert_true(fabs(normal[0] - sqrt(0.5)) < 1e-14 && fabs(normal[1] + sqrt(0.5)) < 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_degree), cmocka_unit_test(test_hats),
                                     cmocka_unit_test(test_ends),   cmocka_unit_test(test_hats_around),
                                     cmocka_unit_test(test_kink),   cmocka_unit_test(test_areas)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
