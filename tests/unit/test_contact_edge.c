/* Shows that the contact edge is the zero of p^2 beyond the last loaded node, never beyond the next open one, on both sides of a line of nodes. */
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
      assert_near(ContactEdge(n, x, p, side, &found), side ? edge : -edge, TOLERANCE);
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
    for (int side = 0; side < 2; side++) assert_true(fabs(ContactEdge(n, x, p, side, &found) - (side ? edge : -edge)) < 0.1 * spacing);
  }
}

static void test_bounded_by_open_node(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0}, flat[] = {5.0, 4.99, 0.0, 0.0}, rising[] = {5.0, 6.0, 0.0, 0.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(4, x, flat, 1, &spacing), 2.0, 0.0);
  assert_near(ContactEdge(4, x, rising, 1, &spacing), 2.0, 0.0);
  assert_near(spacing, 1.0, 0.0);
}

static void test_end_of_line(void **state)
{
  const double x[] = {0.0, 1.0, 2.0}, p[] = {5.0, 4.0, 3.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(3, x, p, 0, &spacing), 0.0, 0.0);
  assert_near(spacing, 0.0, 0.0);
  assert_near(ContactEdge(3, x, p, 1, &spacing), 2.0, 0.0);
  assert_near(ContactEdge(1, x, p, 1, &spacing), 0.0, 0.0);
}

/* Contact in two strips: each side sees its own strip, whatever lies between */
static void test_two_strips(void **state)
{
  const double x[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, p[] = {0.0, 0.0, 1.0, 0.0, 3.0, 4.0, 0.0};
  double       spacing;

  (void)state;
  assert_near(ContactEdge(7, x, p, 0, &spacing), 1.5, TOLERANCE); /* one loaded node: half way */
  assert_near(ContactEdge(7, x, p, 1, &spacing), 6.0, TOLERANCE);
}

static void test_no_contact(void **state)
{
  const double x[] = {0.0, 1.0}, p[] = {0.0, 0.0};
  double       spacing;

  (void)state;
  assert_true(isnan(ContactEdge(2, x, p, 1, &spacing)) && isnan(spacing));
  assert_true(isnan(ContactEdge(0, NULL, NULL, 0, &spacing)) && isnan(spacing));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_exact_for_linear_square),
    cmocka_unit_test(test_ellipse),
    cmocka_unit_test(test_bounded_by_open_node),
    cmocka_unit_test(test_end_of_line),
    cmocka_unit_test(test_two_strips),
    cmocka_unit_test(test_no_contact),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
