/* Gaps to planes, cylinders and spheres, outside and inside, have the right sign and size, and their N and M are the
   derivatives of the gap. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "smooth/analyticsurface.h"

static double Random(double low, double high)
{
  static uint64_t state = 88172645463325252u;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

static const double still[3] = {0, 0, 0};

/* Replaces assert_float_equal(), which compares as float. */
static void AssertNear(double a, double b, double tolerance)
{
  if (!(fabs(a - b) <= tolerance)) {
    print_error("%.17g and %.17g differ by more than %g\n", a, b, tolerance);
    fail();
  }
}

static void TestValues(void **state)
{
  const AnalyticSurface plane    = {.shape = ANALYTIC_PLANE, .axis = {0, 0, 2}};
  const AnalyticSurface cylinder = {.shape = ANALYTIC_CYLINDER, .axis = {0, 3, 0}, .radius = 2};
  const AnalyticSurface bore     = {.shape = ANALYTIC_CYLINDER, .inside = 1, .axis = {0, 3, 0}, .radius = 2};
  const AnalyticSurface sphere   = {.shape = ANALYTIC_SPHERE, .radius = 5};
  const AnalyticSurface socket   = {.shape = ANALYTIC_SPHERE, .inside = 1, .radius = 5};
  AnalyticResult        out;

  (void)state;
  assert_true(AnalyticSurfaceEvaluate(&plane, 3, (double[3]){7, 8, -0.25}, still, &out));
  AssertNear(out.gap, -0.25, 0);
  AssertNear(out.curvature, 0, 0);
  assert_true(AnalyticSurfaceEvaluate(&cylinder, 3, (double[3]){1.8, 40, 2.4}, still, &out));
  AssertNear(out.gap, 1, 1e-14);
  AssertNear(out.normal[0], 0.6, 1e-14);
  AssertNear(out.normal[1], 0, 1e-14);
  AssertNear(out.curvature, 0.5, 1e-14);
  assert_true(AnalyticSurfaceEvaluate(&bore, 3, (double[3]){1.8, 40, 2.4}, still, &out));
  AssertNear(out.gap, -1, 1e-14);
  AssertNear(out.normal[2], -0.8, 1e-14);
  assert_true(AnalyticSurfaceEvaluate(&sphere, 3, (double[3]){0, 3, -4.5}, still, &out));
  AssertNear(out.gap, sqrt(29.25) - 5, 1e-14);
  assert_true(AnalyticSurfaceEvaluate(&socket, 3, (double[3]){0, 3, -4.5}, still, &out));
  AssertNear(out.gap, 5 - sqrt(29.25), 1e-14);
}

static void TestNoClosestPoint(void **state)
{
  const AnalyticSurface cylinder = {.shape = ANALYTIC_CYLINDER, .inside = 1, .axis = {0, 0, 1}, .radius = 2};
  const AnalyticSurface sphere   = {.shape = ANALYTIC_SPHERE, .radius = 2};
  const AnalyticSurface plane    = {.shape = ANALYTIC_PLANE};
  AnalyticResult        out;

  (void)state;
  assert_false(AnalyticSurfaceEvaluate(&cylinder, 3, (double[3]){0, 0, 5}, still, &out));
  assert_false(AnalyticSurfaceEvaluate(&sphere, 3, (double[3]){0, 0, 1e-9}, still, &out));
  assert_false(AnalyticSurfaceEvaluate(&plane, 3, (double[3]){0, 0, 1}, still, &out));
}

/* Fourth-order central difference from the values at -2h, -h, h, 2h. */
static double Difference(const double value[4], double h)
{
  return (value[0] - 8 * value[1] + 8 * value[2] - value[3]) / (12 * h);
}

/* N and M agree with central differences of gap and N, and M annihilates the normal. */
static void CheckVariations(const AnalyticSurface *master, int dim)
{
  const double   h = 1e-4;
  double         x[3], X[3], u[3];
  AnalyticResult out, step;

  for (int c = 0; c < 3; c++) x[c] = c < dim ? Random(0.5, 2) : 0;
  for (int c = 0; c < 3; c++) {
    u[c] = c < dim ? 0.3 * x[(c + 1) % dim] : 0;
    X[c] = x[c] - u[c];
  }
  assert_true(AnalyticSurfaceEvaluate(master, dim, X, u, &out));
  for (int c = 0; c < dim; c++) {
    double product = 0, size = 1, gap[4], N[3][4];

    for (int i = 0; i < 4; i++) {
      double moved[3];

      memcpy(moved, u, sizeof(u));
      moved[c] += (i < 2 ? i - 2 : i - 1) * h;
      assert_true(AnalyticSurfaceEvaluate(master, dim, X, moved, &step));
      gap[i] = step.gap;
      for (int d = 0; d < dim; d++) N[d][i] = step.N[d];
    }
    AssertNear(out.N[c], Difference(gap, h), 1e-7);
    for (int d = 0; d < dim; d++) {
      AssertNear(out.M[d * dim + c], Difference(N[d], h), 1e-7 * (1 + fabs(out.M[d * dim + c])));
      AssertNear(out.M[d * dim + c], out.M[c * dim + d], 0);
      product += out.M[c * dim + d] * out.normal[d];
      size += fabs(out.M[c * dim + d]);
    }
    AssertNear(product, 0, 1e-14 * size); /* the rounding of M's entries */
  }
}

static void TestVariations(void **state)
{
  (void)state;
  for (int trial = 0; trial < 20; trial++) {
    for (int inside = 0; inside < 2; inside++) {
      for (AnalyticShape shape = ANALYTIC_PLANE; shape <= ANALYTIC_SPHERE; shape++) {
        const AnalyticSurface solid = {.shape  = shape,
                                       .inside = inside,
                                       .axis   = {Random(-1, 1), Random(-1, 1), Random(0.1, 1)},
                                       .radius = Random(0.5, 3)};
        AnalyticSurface       flat  = solid;

        CheckVariations(&solid, 3);
        if (shape == ANALYTIC_CYLINDER)
          flat.axis[0] = flat.axis[1] = 0;
        else
          flat.axis[2] = 0;
        CheckVariations(&flat, 2);
      }
    }
  }
}

/* Far from the origin a change of the displacement changes the gap by as much, to the digits of the displacement. */
static void TestDigits(void **state)
{
  const AnalyticSurface  plane    = {.shape = ANALYTIC_PLANE, .axis = {-0.5, 0.75, 0.25}};
  const AnalyticSurface  cylinder = {.shape = ANALYTIC_CYLINDER, .axis = {0, 0, 1}, .radius = 50};
  const AnalyticSurface  sphere   = {.shape = ANALYTIC_SPHERE, .radius = 50};
  const AnalyticSurface *all[3]   = {&plane, &cylinder, &sphere};

  (void)state;
  for (int k = 0; k < 3; k++) {
    const double   X[3] = {30.1, 40.2, 7.3}, u[3] = {3.1e-9, 1.7e-9, -2.3e-9};
    double         along = 0;
    AnalyticResult before, after;

    assert_true(AnalyticSurfaceEvaluate(all[k], 3, X, still, &before));
    assert_true(AnalyticSurfaceEvaluate(all[k], 3, X, u, &after));
    for (int c = 0; c < 3; c++) along += before.normal[c] * u[c];
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) along += before.M[c * 3 + d] * u[c] * u[d] / 2;
    AssertNear(after.gap - before.gap, along, 2e-15); /* the rounding of the two gaps, not of 50 */
  }
}

/* In the meridian of an axisymmetric scene a cylinder about the axis is a straight wall. */
static void TestAxisymmetricCylinder(void **state)
{
  const AnalyticSurface cylinder = {.shape = ANALYTIC_CYLINDER, .axis = {0, 1, 0}, .radius = 2};
  AnalyticResult        out;

  (void)state;
  assert_true(AnalyticSurfaceEvaluate(&cylinder, 2, (double[2]){2.5, 7}, still, &out));
  AssertNear(out.gap, 0.5, 1e-15);
  AssertNear(out.N[0], 1, 0);
  for (int i = 0; i < 4; i++) AssertNear(out.M[i], 0, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestValues), cmocka_unit_test(TestNoClosestPoint),
                                     cmocka_unit_test(TestVariations), cmocka_unit_test(TestDigits),
                                     cmocka_unit_test(TestAxisymmetricCylinder)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
