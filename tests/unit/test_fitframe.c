/* Frames are those of the points' plane, with the normal outwards, and are refused where there is no plane. Supports
   hold pi s^2 nodes on any mesh. */
#include <math.h>
#include <string.h>
#include "fitcase.h"

static void CheckOrthonormal(int dim, double (*frame)[3])
{
  for (int a = 0; a < dim; a++) {
    for (int b = 0; b < dim; b++)
      AssertNear(frame[a][0] * frame[b][0] + frame[a][1] * frame[b][1] + frame[a][2] * frame[b][2], a == b, 1e-14);
  }
}

/* Points of a tilted plane, and points that are symmetric about a plane only with their multipliers. */
static void TestPlane(void **state)
{
  static Case c;

  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    for (int trial = 0; trial < 50; trial++) {
      double R[3][3], x[3 * MAX], outward[3], frame[3][3];

      Straight(&c, dim, 2, 4, 3);
      AddBowl(&c, 4, 4);
      for (int i = 0; i < c.in.n; i++) c.x[i * dim + dim - 1] = 2;
      /* One point of a pair lies above the plane. The other one is twice as heavy and lies half as far below it. */
      for (int i = 0, n = c.in.n; i < n; i++) {
        AddPoint(&c, c.x[i * dim], dim == 3 ? c.x[i * dim + 1] : 0, 3, 1);
        AddPoint(&c, c.x[i * dim], dim == 3 ? c.x[i * dim + 1] : 0, 1.5, 2);
      }
      Rotation(dim, R);
      Turn(dim, c.in.n, R, c.x, x);
      for (int k = 0; k < dim; k++) outward[k] = 3 * R[k][dim - 1] + R[k][0];
      assert_true(FitFrame(dim, c.in.n, x, c.v, outward, frame));
      CheckOrthonormal(dim, frame);
      for (int k = 0; k < dim; k++) AssertNear(frame[dim - 1][k], R[k][dim - 1], 1e-13);
    }
  }
}

static void TestNoPlane(void **state)
{
  static Case  c;
  double       frame[3][3];
  const double up[3] = {0, 0, 1}, aside[3] = {1, 0, 0.1};

  (void)state;
  Straight(&c, 3, 2, 4, 3);
  assert_false(FitFrame(3, 0, c.x, c.v, up, frame)); /* no points */
  for (int i = 0; i < 9; i++) AddPoint(&c, i, 2 * i, 3 * i, 1);
  assert_false(FitFrame(3, c.in.n, c.x, c.v, up, frame)); /* points on a line */
  CheckOrthonormal(3, frame);
  AssertNear(frame[2][2], 1, 0);
  c.in.n = 0;
  for (int i = 0; i < 8; i++) AddPoint(&c, i & 1, (i >> 1) & 1, i >> 2, 1);
  assert_false(FitFrame(3, c.in.n, c.x, c.v, up, frame)); /* the corners of a cube */
  for (int i = 0; i < 8; i++) c.x[3 * i + 2] *= 0.2;
  assert_true(FitFrame(3, c.in.n, c.x, c.v, up, frame));
  assert_false(FitFrame(3, c.in.n, c.x, c.v, aside, frame)); /* a plane seen edge-on */
}

/* Counts the nodes of a sheared and stretched grid inside the support. */
static int CountInside(double ratio, double shear, double support)
{
  double    frame[3][3], covariance[3][3] = {{0}}, Q[2][2];
  const int reach = 40;
  int       count = 0;

  FitFrameFromNormal(3, (double[3]){0.3, -0.2, 1}, frame);
  for (int i = -1; i <= 1; i++) {
    for (int j = -1; j <= 1; j++) {
      for (int k = 0; k < 9; k++) {
        const double a = ratio * i + shear * j, x = a * frame[0][k / 3] + j * frame[1][k / 3],
                     y = a * frame[0][k % 3] + j * frame[1][k % 3];

        covariance[k / 3][k % 3] += x * y;
      }
    }
  }
  FitMetricFromCovariance(3, frame, covariance, ratio, support, Q);
  for (int i = -reach; i <= reach; i++) {
    for (int j = -reach; j <= reach; j++) {
      const double s = ratio * i + shear * j + 0.3, t = j + 0.1;

      count += Q[0][0] * s * s + 2 * Q[0][1] * s * t + Q[1][1] * t * t < 1;
    }
  }
  return count;
}

static void TestMetric(void **state)
{
  const double ratios[] = {1, 3, 10}, support = 10;
  double       frame[3][3], Q[2][2], line[3][3] = {{0}};

  (void)state;
  for (int i = 0; i < 3; i++) {
    for (int shear = 0; shear < 2; shear++)
      AssertNear(CountInside(ratios[i], 0.5 * shear, support) / (3.14159265 * support * support), 1, 0.02);
  }
  FitFrameFromNormal(2, (double[2]){0, 1}, frame);
  FitMetricFromCovariance(2, frame, NULL, 0.5, 4, Q);
  AssertNear(Q[0][0], 0.25, 1e-15);
  FitFrameFromNormal(3, (double[3]){0, 0, 1}, frame);
  line[0][0] = 1; /* a ring without width gives a round support */
  FitMetricFromCovariance(3, frame, line, 2, 3, Q);
  AssertNear(Q[0][0], 1 / 18., 1e-15);
  AssertNear(Q[1][1], 1 / 18., 1e-15);
  AssertNear(Q[0][1], 0, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestPlane), cmocka_unit_test(TestNoPlane),
                                     cmocka_unit_test(TestMetric)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
