/* Shows that the contact edge is the zero of p^2 beyond the last loaded node, or where the hat functions' force says, never beyond the next open node. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "contactedge.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_NODES = 64 };
static const double TOLERANCE = 1e-12;

/* p = sqrt(max(0, a - slope |x|)): its square is linear, so the edge +-a/slope must come out exactly wherever the nodes are */
static void test_exact_for_linear_square(void **state)
{
  (void)state;
  for (int shift = 0; shift < 10; shift++) {
    const double edge = 2.0, spacing = 0.37;
    double       x[MAX_NODES], p[MAX_NODES], found;
    int          n = 0;

    for (int i = -10; i <= 10; i++, n++) {
      x[n] = (i + 0.1 * shift + 0.013) * spacing;
      p[n] = sqrt(fmax(0.0, edge - fabs(x[n])));
    }
    for (int side = 0; side < 2; side++) {
      assert_near(ContactEdge(EDGE_AT_NODES, n, x, p, side, &found), side ? edge : -edge, TOLERANCE);
      assert_near(found, spacing, TOLERANCE);
    }
  }
}

/* Hertz's ellipse: the error is of second order in the spacing and stays well within it */
static void test_ellipse(void **state)
{
  (void)state;
  for (int shift = 0; shift < 10; shift++) {
    const double edge = 1.0, spacing = 0.1;
    double       x[MAX_NODES], p[MAX_NODES], found;
    int          n = 0;

    for (int i = -15; i <= 15; i++, n++) {
      x[n] = (i + 0.1 * shift + 0.05) * spacing;
      p[n] = 3590.0 * sqrt(fmax(0.0, 1.0 - x[n] * x[n]));
    }
    for (int side = 0; side < 2; side++) assert_true(fabs(ContactEdge(EDGE_AT_NODES, n, x, p, side, &found) - (side ? edge : -edge)) < 0.1 * spacing);
  }
}

/* Hat functions with the force and the moment of a root beyond the last but one loaded node: the root's end comes out exactly, on both sides */
static void test_hats(void **state)
{
  const double spacing = 0.37;

  (void)state;
  for (double end = 0.85; end <= 2; end += 0.05) { /* spacings beyond the last but one; the hats reach two */
    const double force = 2.0 / 3 * pow(end, 1.5), moment = 4.0 / 15 * pow(end, 2.5), inner = 3 * (force - moment), last = 1.5 * moment - 0.5 * force;
    const double right[] = {7, inner, last, 0}, left[] = {0, last, inner, 7}, x[] = {0, spacing, 2 * spacing, 3 * spacing};
    double       found;

    assert_near(ContactEdge(EDGE_OF_HATS, 4, x, right, 1, &found), (1 + end) * spacing, TOLERANCE);
    assert_near(found, spacing, TOLERANCE);
    assert_near(ContactEdge(EDGE_OF_HATS, 4, x, left, 0, &found), (2 - end) * spacing, TOLERANCE);
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
    cmocka_unit_test(test_exact_for_linear_square),
    cmocka_unit_test(test_ellipse),
    cmocka_unit_test(test_hats),
    cmocka_unit_test(test_bounded_by_open_node),
    cmocka_unit_test(test_end_of_line),
    cmocka_unit_test(test_two_strips),
    cmocka_unit_test(test_no_contact),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
