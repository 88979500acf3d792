/* Shows that the contact edge is that of the root with the nodal forces' moments, exact for a root's, and never beyond
 * the next open node. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "contact/contactedge.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_NODES = 64 };
static const double TOLERANCE = 1e-12;
static const double OF_FORCES = 0.45,
                    OF_VALUES = 0.45; /* of an element: bounds, the first over the elements along a half-width */

/* Moments about x of the pressure beyond it: of the root sqrt(2 - s), and of Hertz's ellipse of half-width 1 */
static double MomentOfRoot(double x)
{
  return x < 2 ? 4.0 / 15 * pow(2 - x, 2.5) : 0;
}

static double MomentOfEllipse(double x)
{
  if (x < -1) return -0.5 * M_PI * x;
  return x < 1 ? pow(1 - x * x, 1.5) / 3 - 0.5 * x * (acos(x) - x * sqrt(1 - x * x)) : 0;
}

/* Pressures of nodes whose forces are the integrals of the pressure times functions linear between the nodes: second
   differences of those moments. The first and the last node are open, and what lies beyond -1. */
static void PressuresOfHats(int n, const double *x, double (*moment)(double), double *p)
{
  p[0] = p[n - 1] = 0;
  for (int i = 1; i < n - 1; i++) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];

    p[i] = x[i + 1] > -1 ? ((moment(x[i - 1]) - moment(x[i])) / before - (moment(x[i]) - moment(x[i + 1])) / after) *
                             2 / (before + after)
                         : 0;
  }
}

/* The same nodes and pressures from the other side */
static void Mirror(int n, const double *x, const double *p, double *mirror_x, double *mirror_p)
{
  for (int i = 0; i < n; i++) {
    mirror_x[i] = -x[n - 1 - i];
    mirror_p[i] = p[n - 1 - i];
  }
}

/* Forces of a root: its end must come out exactly wherever the nodes are, on both sides; with nodes that touch never
 * before the last of them */
static void test_exact_for_root(void **state)
{
  (void)state;
  for (int shift = 0; shift < 20; shift++) {
    const int n = 12;
    double    x[MAX_NODES], p[MAX_NODES], mirror_x[MAX_NODES], mirror_p[MAX_NODES], found;
    int       last = n - 1;

    for (int i = 0; i < n; i++) x[i] = (i + 0.05 * shift + 0.013 + 0.2 * sin(7 * i)) * 0.25 - 0.5;
    PressuresOfHats(n, x, MomentOfRoot, p);
    while (!(p[last] > 0)) last--;
    Mirror(n, x, p, mirror_x, mirror_p);
    assert_near(ContactEdge(EDGE_OF_HATS, n, x, p, 1, &found), 2.0, TOLERANCE);
    assert_near(found, x[last + 1] - x[last], TOLERANCE);
    assert_near(ContactEdge(EDGE_OF_HATS, n, mirror_x, mirror_p, 0, &found), -2.0, TOLERANCE);
    assert_near(ContactEdge(EDGE_AT_NODES, n, x, p, 1, &found), x[last], TOLERANCE);
  }
}

/* Hertz's ellipse, from fine to four elements across: the error stays well within an element, with forces and with the
 * pressure's values at the nodes */
static void test_ellipse(void **state)
{
  (void)state;
  for (int elements = 2; elements <= 16; elements *= 2) { /* along the half-width */
    const int    n       = 2 * elements + 5;
    const double spacing = 1.0 / elements;

    for (int shift = 0; shift < 10; shift++) {
      double x[MAX_NODES], p[MAX_NODES], found;

      for (int i = 0; i < n; i++) x[i] = (i - elements - 2 + 0.1 * shift - 0.45) * spacing;
      PressuresOfHats(n, x, MomentOfEllipse, p);
      for (int side = 0; side < 2; side++)
        assert_near(ContactEdge(EDGE_OF_HATS, n, x, p, side, &found), side ? 1 : -1, OF_FORCES / elements * spacing);
      for (int i = 0; i < n; i++) p[i] = sqrt(fmax(0.0, 1.0 - x[i] * x[i]));
      for (int side = 0; side < 2; side++)
        assert_near(ContactEdge(EDGE_AT_NODES, n, x, p, side, &found), side ? 1 : -1, OF_VALUES * spacing);
    }
  }
}

static void test_bounded_by_open_node(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0}, flat[] = {5.0, 4.99, 0.0, 0.0}, rising[] = {5.0, 6.0, 0.0, 0.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(EDGE_AT_NODES, 4, x, flat, 1, &spacing), 2.0, 0.0);
  assert_near(ContactEdge(EDGE_AT_NODES, 4, x, rising, 1, &spacing), 2.0, 0.0);
  assert_near(spacing, 1.0, 0.0);
}

/* A punch's pressure rises to its end: the edge stays between the last loaded nodes and the open one, whatever the
 * zone's pressures are */
static void test_punch(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};

  (void)state;
  for (int first = 0; first < 6; first++)
    for (double steep = -1.0; steep <= 4.0; steep += 0.5) {
      double p[8] = {0.0}, spacing;

      for (int i = first; i < 6; i++) p[i] = exp(steep * (i - first));
      for (int hats = 0; hats < 2; hats++) {
        const double edge = ContactEdge(hats ? EDGE_OF_HATS : EDGE_AT_NODES, 8, x, p, 1, &spacing);

        assert_true(edge >= (hats && first < 5 ? 4.0 : 5.0) && edge <= 6.0);
        if (first < 5 && steep >= 0.5) assert_near(edge, 6.0, 0.0);
      }
    }
}

/* A flattened shell presses most at its edge: the last two nodes tell where that is */
static void test_shell(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, p[] = {2.0, 2.5, 3.0, 3.5, 5.0, 3.0, 0.0};
  double       spacing;

  (void)state;
  for (int hats = 0; hats < 2; hats++)
    assert_near(ContactEdge(hats ? EDGE_OF_HATS : EDGE_AT_NODES, 7, x, p, 1, &spacing), 5.0 + 9.0 / 16, TOLERANCE);
}

static void test_end_of_line(void **state)
{
  const double x[] = {0.0, 1.0, 2.0}, p[] = {5.0, 4.0, 3.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(EDGE_AT_NODES, 3, x, p, 0, &spacing), 0.0, 0.0);
  assert_near(spacing, 0.0, 0.0);
  assert_near(ContactEdge(EDGE_AT_NODES, 3, x, p, 1, &spacing), 2.0, 0.0);
  assert_near(ContactEdge(EDGE_AT_NODES, 1, x, p, 1, &spacing), 0.0, 0.0);
}

/* Contact in two strips: each side sees its own strip, whatever lies between */
static void test_two_strips(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, p[] = {0.0, 0.0, 1.0, 0.0, 3.0, 4.0, 0.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(EDGE_AT_NODES, 7, x, p, 0, &spacing), 1.5, TOLERANCE); /* one loaded node: half way */
  assert_near(ContactEdge(EDGE_AT_NODES, 7, x, p, 1, &spacing), 6.0, TOLERANCE);
}

static void test_no_contact(void **state)
{
  const double x[] = {0.0, 1.0}, p[] = {0.0, 0.0};
  double       spacing;

  (void)state;
  assert_true(isnan(ContactEdge(EDGE_AT_NODES, 2, x, p, 1, &spacing)) && isnan(spacing));
  assert_true(isnan(ContactEdge(EDGE_AT_NODES, 0, NULL, NULL, 0, &spacing)) && isnan(spacing));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_exact_for_root),
    cmocka_unit_test(test_ellipse),
    cmocka_unit_test(test_bounded_by_open_node),
    cmocka_unit_test(test_punch),
    cmocka_unit_test(test_shell),
    cmocka_unit_test(test_end_of_line),
    cmocka_unit_test(test_two_strips),
    cmocka_unit_test(test_no_contact),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
