/* The nearest point in half-spaces: a corner, an edge, more half-spaces than dimensions, some that have no point in
   common. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "base/halfspaces.h"

#define assert_near(value, reference, tolerance) assert_float_equal(value, reference, tolerance)

/* Beyond a face, an edge and the corner of the quadrant x >= 1, y >= 2; a point inside stays. */
static void test_quadrant(void **state)
{
  const double normal[] = {2, 0, 0, 3}, bound[] = {2, 6};
  const double from[][2] = {{0, 5}, {0, 0}, {4, -1}, {3, 3}}, to[][2] = {{1, 5}, {1, 2}, {4, 2}, {3, 3}};

  (void)state;
  for (int i = 0; i < 4; i++) {
    double y[2] = {from[i][0], from[i][1]};

    assert_int_equal(HalfspacesProject(2, 2, normal, bound, 1e-12, y), 0);
    assert_near(y[0], to[i][0], 1e-12);
    assert_near(y[1], to[i][1], 1e-12);
  }
}

/* Sixty tangents of a circle: the nearest point of the polygon to one far away on the bisector of two of them is their
   corner. Each half-space that is met first is dropped again. */
static void test_circle(void **state)
{
  enum { N = 60 };
  double normal[2 * N], bound[N], y[2];

  (void)state;
  for (int i = 0; i < N; i++) {
    normal[2 * i]     = -cos(2 * M_PI * i / N);
    normal[2 * i + 1] = -sin(2 * M_PI * i / N);
    bound[i]          = -1;
  }
  y[0] = 50 * cos(M_PI / N);
  y[1] = 50 * sin(M_PI / N);
  assert_int_equal(HalfspacesProject(2, N, normal, bound, 1e-12, y), 0);
  assert_near(y[0], 1, 1e-10);
  assert_near(y[1], tan(M_PI / N), 1e-10);
}

/* Two half-spaces without a common point: one is left out and said so. The same half-space twice is no trouble. */
static void test_apart(void **state)
{
  const double normal[] = {1, -1, 1, 1}, bound[] = {1, 0, 1, 1};
  double       y[1] = {0.5};

  (void)state;
  assert_int_equal(HalfspacesProject(1, 2, normal, bound, 1e-12, y), 1);
  y[0] = 0;
  assert_int_equal(HalfspacesProject(1, 2, &normal[2], &bound[2], 1e-12, y), 0);
  assert_near(y[0], 1, 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_quadrant), cmocka_unit_test(test_circle),
                                     cmocka_unit_test(test_apart)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
