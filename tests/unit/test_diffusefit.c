/* The diffuse fit reproduces polynomials and follows spheres, and its guards are set before it fails. */
#include "fitcase.h"

static double Polynomial(const double *c, int degree, double s, double t)
{
  double sum = 0;

  for (int k = 0, i = 0; k <= degree; k++) {
    for (int b = 0; b <= k; b++, i++) sum += c[i] * pow(s, k - b) * pow(t, b);
  }
  return sum;
}

/* The fit reproduces graphs of polynomials of its degree exactly, and the foot is their closest point. */
static void TestPolynomials(void **state)
{
  static Case c;

  (void)state;
  for (int i = 0; i < 6; i++) {
    const int    dim = cases[i][0], degree = cases[i][1];
    const double support = dim == 2 ? 6 : 4;
    double       coefficient[FIT_MAX_TERMS], q, gradient[2] = {0};

    Straight(&c, dim, degree, support, 4);
    AddBowl(&c, support, support);
    for (int k = 0, term = 0; k <= degree; k++) {
      for (int b = 0; b <= k; b++, term++) coefficient[term] = Random(-0.3, 0.3) * pow(support, -k);
    }
    for (int p = 0; p < c.in.n; p++)
      c.x[p * dim + dim - 1] = Polynomial(coefficient, degree, c.x[p * dim], dim == 3 ? c.x[p * dim + 1] : 0);
    assert_true(Evaluate(&c, FIT_GAP));
    for (int trial = 0; trial < 20; trial++) {
      const double y[2] = {Random(-1, 1), dim == 3 ? Random(-1, 1) : 0};

      AssertNear(FitSurfaceHeight(&c.out.surface, y, NULL), Polynomial(coefficient, degree, y[0], y[1]), 1e-12);
    }
    q = FitSurfaceHeight(&c.out.surface, c.out.foot, gradient);
    for (int k = 0; k < dim - 1; k++) AssertNear(c.out.foot[k] + q * gradient[k], 0, 1e-14);
    for (int k = 0; k < dim; k++) AssertNear(-c.out.gap * c.out.normal[k], k < dim - 1 ? c.out.foot[k] : q, 1e-14);
    for (int k = 0; k < dim - 1; k++) {
      double product = 0;

      for (int j = 0; j < dim; j++) product += c.out.tangent[k][j] * c.out.normal[j];
      AssertNear(product, 0, 1e-15);
    }
  }
}

/* The fit through the section of a cylinder agrees with the fit through the cylinder. */
static void TestPlaneEqualsSpace(void **state)
{
  static Case plane, space;

  (void)state;
  for (int degree = 1; degree <= 4; degree += degree == 1 ? 1 : 2) {
    double coefficient[5];

    for (int k = 0; k <= degree; k++) coefficient[k] = Random(-0.3, 0.3) * pow(4, -k);
    Straight(&plane, 2, degree, 6, 4);
    Straight(&space, 3, degree, 4, 3);
    AddBowl(&plane, 6, 6);
    AddBowl(&space, 4, 4);
    for (int dim = 2; dim <= 3; dim++) {
      Case *c = dim == 2 ? &plane : &space;

      for (int p = 0; p < c->in.n; p++) {
        double *x = c->x + p * dim;

        for (int k = degree, first = 1; k >= 0; k--, first = 0)
          x[dim - 1] = (first ? 0 : x[dim - 1] * x[0]) + coefficient[k];
      }
      assert_true(Evaluate(c, FIT_GAP));
    }
    AssertNear(plane.out.gap, space.out.gap, 1e-12);
    AssertNear(plane.out.foot[0], space.out.foot[0], 1e-12);
    AssertNear(plane.out.normal[0], space.out.normal[0], 1e-12);
    AssertNear(plane.out.curvature, space.out.curvature, 1e-12);
  }
}

/* Nodes of a sphere, h apart, seen from a point close to it: accuracy of gap and curvature, and angular momentum to
   the lever arm. */
static void TestSphere(void **state)
{
  static const double support = 3.5, R = 20, h = 1.309;
  static Case         c;

  (void)state;
  for (int degree = 2; degree <= 4; degree += 2) {
    for (int trial = 0; trial < 20; trial++) {
      const double shift[2] = {Random(0, 1), Random(0, 1)}, gap = Random(-0.01, 0.01);
      double       arm[3] = {0};

      Straight(&c, 3, degree, support * h, degree == 2 ? 6 : 3);
      for (int i = -6; i <= 6; i++) {
        for (int j = -6; j <= 6; j++) {
          const double s = (i + shift[0]) * h, t = (j + shift[1]) * h;

          if (i * i + j * j < 36) AddPoint(&c, s, t, sqrt(R * R - s * s - t * t) - R - gap, 1);
        }
      }
      assert_true(Evaluate(&c, FIT_FIRST_VARIATION));
      assert_int_equal(c.out.guards, FIT_HOLDS);
      AssertNear(c.out.gap, gap, degree == 2 ? 1e-3 : 1e-5);
      AssertNear(c.out.curvature * R, 1, degree == 2 ? 3e-2 : 3e-3);
      for (int i = 0; i < c.out.n; i++) {
        for (int k = 0; k < 3; k++)
          arm[k] += c.x[3 * c.points[i] + (k + 1) % 3] * c.N[3 * (1 + i) + (k + 2) % 3] -
                    c.x[3 * c.points[i] + (k + 2) % 3] * c.N[3 * (1 + i) + (k + 1) % 3];
      }
      AssertNear(MaxAbs(3, arm), 0, (degree == 2 ? 1e-3 : 1e-5) * h);
    }
  }
}

/* The larger principal curvature at the pass of a saddle, and of a cylinder in a frame that leans. */
static void TestCurvature(void **state)
{
  static Case  c;
  const double R = 20;

  (void)state;
  Straight(&c, 3, 2, 4, 3);
  AddBowl(&c, 4, 4);
  for (int i = 0; i < c.in.n; i++) {
    double *x = c.x + 3 * i;

    x[2] = -0.05 * x[0] * x[0] + 0.02 * x[0] * x[1] + 0.03 * x[1] * x[1] - 0.1;
  }
  assert_true(Evaluate(&c, FIT_GAP));
  AssertNear(c.out.curvature, 0.02 + hypot(0.08, 0.02), 1e-13);
  Straight(&c, 3, 4, 4, 3);
  AddBowl(&c, 4, 4);
  for (int i = 0; i < c.in.n; i++) {
    const double across = 0.6 * c.x[3 * i] - 0.8 * c.x[3 * i + 1];

    c.x[3 * i + 2] = sqrt(R * R - across * across) - R;
  }
  FitFrameFromNormal(3, (double[3]){0.4, 0.3, 1}, c.in.frame);
  assert_true(Evaluate(&c, FIT_GAP));
  AssertNear(c.out.curvature * R, 1, 3e-3);
}

/* A point has no force when it leaves the support. */
static void TestSupportEnd(void **state)
{
  static Case c;
  double      N[2];

  (void)state;
  Straight(&c, 3, 2, 3, 3);
  AddBowl(&c, 3, 3);
  AddPoint(&c, 2.9, 0, -0.5, 1);
  for (int out = 0; out < 2; out++) {
    c.x[3 * (c.in.n - 1)] = out ? 3 + 1e-6 : 3 - 1e-6;
    assert_true(Evaluate(&c, FIT_FIRST_VARIATION));
    N[out] = c.N[2];
    if (!out) AssertNear(MaxAbs(3, c.N + 3 * c.out.n), 0, 1e-11);
  }
  AssertNear(N[0], N[1], 1e-11);
}

/* Shape values: at the foot their sum is 1, and for a flat surface they are N along the normal. Those of a
   combination are its derivatives. */
static void TestShape(void **state)
{
  static Case  c;
  const double y[4] = {0.3, -0.2, -0.4, 0.1}, factor[2] = {1, -0.7};
  double       shape[MAX], sum                          = 0;

  (void)state;
  RandomCase(&c, 3, 4, 3);
  assert_true(Evaluate(&c, FIT_GAP));
  for (int i = 0; i < c.out.n; i++) sum += c.shape[i];
  AssertNear(sum, 1, 1e-13);
  assert_true(FitShape(&c.in, 1, c.out.foot, (double[1]){1}, work, shape));
  for (int i = 0; i < c.out.n; i++) AssertNear(shape[c.points[i]], c.shape[i], 1e-13);
  assert_true(FitShape(&c.in, 2, y, factor, work, shape));
  for (int i = 0; i < c.in.n; i++) {
    double height[2];

    for (int s = 0; s < 2; s++) {
      for (int k = 0; k < 3; k++) c.x[3 * i + k] += (s ? 2 : -1) * 0.5 * c.in.frame[2][k];
      Evaluate(&c, FIT_SURFACE);
      height[s] = factor[0] * FitSurfaceHeight(&c.out.surface, y, NULL) +
                  factor[1] * FitSurfaceHeight(&c.out.surface, y + 2, NULL);
    }
    for (int k = 0; k < 3; k++) c.x[3 * i + k] -= 0.5 * c.in.frame[2][k];
    AssertNear(shape[i], height[1] - height[0], 1e-13); /* linear in the heights */
  }
}

static void TestGuards(void **state)
{
  static Case c;

  (void)state;
  Straight(&c, 3, 2, 3, 3); /* the points are collinear */
  for (int i = -10; i <= 10; i++) AddPoint(&c, 0.25 * i, 0.1 * i, 0.01 * i * i, 1);
  assert_false(Evaluate(&c, FIT_SECOND_VARIATION));
  assert_int_equal(c.out.guards, FIT_NO_SURFACE);
  for (int i = 0; i < c.in.n; i++) c.x[3 * i + 1] += 1e-4 * (i % 5); /* nearly collinear */
  assert_true(Evaluate(&c, FIT_SURFACE));
  assert_true(c.out.guards & FIT_LOW_PIVOT);
  Straight(&c, 3, 2, 3, 3); /* five nodes, each four times */
  for (int i = 0; i < 20; i++) AddPoint(&c, i % 5 == 0 ? 0 : i % 5 < 3 ? 1 : -1, i % 5 == 0 ? 0 : i % 2 ? 1 : -1, 0, 1);
  assert_false(Evaluate(&c, FIT_SECOND_VARIATION));
  assert_int_equal(c.out.guards, FIT_NO_SURFACE);
  Straight(&c, 3, 2, 3, 3); /* two by three nodes do not determine the second derivative across */
  for (int i = 0; i < 6; i++) AddPoint(&c, i / 2 - 1, i % 2 - 0.4, 0, 1);
  assert_false(Evaluate(&c, FIT_SECOND_VARIATION));
  assert_int_equal(c.out.guards, FIT_NO_SURFACE);
  c.in.degree = 1; /* they are enough for a plane */
  assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
  assert_int_equal(c.out.guards, FIT_HOLDS);
  Straight(&c, 3, 2, 2.5, 3); /* points on one side only: the foot is far, or the fit amplifies errors */
  for (int i = 0; i < 30; i++) AddPoint(&c, 1.2 + 0.25 * (i % 5), 0.4 * (i / 5) - 1, 0.02 * (i % 3), 1);
  assert_true(Evaluate(&c, FIT_GAP));
  assert_true(c.out.guards & FIT_HIGH_SUM);
  Straight(&c, 3, 1, 2, 3); /* on a steep plane the foot is far away */
  AddBowl(&c, 2, 2);
  for (int i = 0; i < c.in.n; i++) c.x[3 * i + 2] = 3 + c.x[3 * i];
  assert_true(Evaluate(&c, FIT_GAP));
  AssertNear(c.out.reach, 0.75, 1e-12);
  assert_true(c.out.guards & FIT_FAR_FOOT);
  Straight(&c, 2, 2, 4, 3); /* at the centre of curvature of a bore J is singular */
  for (int i = -3; i <= 3; i++) AddPoint(&c, i, -(5 - 0.1 * i * i), 0, 1);
  for (int i = 0; i < c.in.n; i++) c.x[2 * i + 1] = -5 + 0.1 * c.x[2 * i] * c.x[2 * i];
  assert_false(Evaluate(&c, FIT_SECOND_VARIATION));
  assert_int_equal(c.out.guards & ~FIT_FEW_POINTS, FIT_NO_FOOT);
  for (int i = 0; i < c.in.n; i++) c.x[2 * i + 1] += 3; /* nearer to the wall */
  assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
  Straight(&c, 3, 4, 3, 3);
  c.in.metric[1][1] = 0;
  AddBowl(&c, 3, 3);
  assert_false(Evaluate(&c, FIT_GAP));
  Straight(&c, 2, 4, 4, 3); /* one node more or less */
  for (int i = 0; i < 7; i++) AddPoint(&c, i - 3, 0, 0, 1);
  assert_true(Evaluate(&c, FIT_GAP) && !(c.out.guards & FIT_FEW_POINTS));
  c.in.n--;
  assert_true(Evaluate(&c, FIT_GAP) && (c.out.guards & FIT_FEW_POINTS));
  assert_int_equal(FitPointsWanted(3, 4), 30);
  assert_int_equal(FitPointsWanted(3, 2), 12);
  assert_int_equal(FitPointsWanted(2, 4), 7);
  assert_int_equal(FitPointsWanted(2, 2), 4);
}

/* For any neighbourhood the result is either nothing, with a guard set, or finite and balanced numbers. */
static void TestNeverNaN(void **state)
{
  static Case c;
  int         whole = 0;

  (void)state;
  for (int trial = 0; trial < 6000; trial++) {
    const int    dim = cases[trial % 6][0], degree = cases[trial % 6][1], n = (int)Random(0, 24), grid = trial % 2;
    const double bend = Random(0, 3);

    Straight(&c, dim, degree, 2, 3);
    for (int i = 0; i < n; i++) {
      const double s = grid ? (int)Random(-3, 3) : Random(-2, 2), t = dim == 2 ? 0
                                                                      : grid   ? (int)Random(-3, 3)
                                                                               : Random(-2, 2);

      AddPoint(&c, s, t, Random(-bend, bend), 1);
    }
    memset(c.N, -1, sizeof(c.N)); /* fills N with NaN */
    memset(c.M, -1, sizeof(c.M));
    if (!Evaluate(&c, FIT_SECOND_VARIATION)) {
      assert_true(c.out.guards & (FIT_NO_SURFACE | FIT_NO_FOOT));
      continue;
    }
    whole++;
    assert_true(isfinite(c.out.gap) && isfinite(c.out.curvature) && isfinite(c.out.amplified) && isfinite(c.out.pivot));
    assert_true(isfinite(MaxAbs(dim * (1 + c.out.n), c.N)) &&
                isfinite(MaxAbs((long)dim * dim * (1 + c.out.n) * (1 + c.out.n), c.M)));
  }
  assert_true(whole > 1000);
}

/* Other units of length change no guard, and they scale the quantities that have a length. */
static void TestUnits(void **state)
{
  static Case  c, scaled;
  const double units[] = {1e-6, 1e6};

  (void)state;
  for (int i = 0; i < 12; i++) {
    const double unit = units[i / 6];

    RandomCase(&c, cases[i % 6][0], cases[i % 6][1], 3);
    scaled = c;
    for (int k = 0; k < 3 * MAX; k++) scaled.x[k] *= unit;
    for (int k = 0; k < 4; k++) scaled.in.metric[k / 2][k % 2] /= unit * unit;
    assert_true(Evaluate(&c, FIT_FIRST_VARIATION) && Evaluate(&scaled, FIT_FIRST_VARIATION));
    assert_true(c.out.n == scaled.out.n && c.out.guards == scaled.out.guards);
    AssertNear(scaled.out.gap / unit, c.out.gap, 1e-14);
    for (int k = 0; k < c.in.dim * (1 + c.out.n); k++) AssertNear(scaled.N[k], c.N[k], 1e-14);
  }
}

/* As many points as a list may hold, and many slave points in one call. */
static void TestLargeAndBatch(void **state)
{
  static Case c, batch[3];
  FitProblem  in[3];
  FitResult   out[3];
  double      sum[3] = {0};

  (void)state;
  Straight(&c, 3, 4, 13.5, 3);
  for (int i = 0; i < MAX; i++) AddPoint(&c, 0.8 * (i % 23 - 11), 0.8 * (i / 23 - 11), 0.01 * (i % 3), 1);
  assert_true(Evaluate(&c, FIT_FIRST_VARIATION));
  assert_int_equal(c.out.n, MAX);
  for (int i = 0; i < 3 * (1 + c.out.n); i++) sum[i % 3] += c.N[i];
  AssertNear(MaxAbs(3, sum), 0, 1e-14);
  for (int i = 0; i < 3; i++) {
    RandomCase(&batch[i], 3, 4, 3);
    if (i == 1) batch[i].in.n = 4;
    Evaluate(&batch[i], FIT_SECOND_VARIATION);
    in[i]  = batch[i].in;
    out[i] = (FitResult){.points = batch[i].points};
  }
  assert_int_equal(DiffuseFitEvaluateBatch(3, in, FIT_GAP, work, out), 2);
  for (int i = 0; i < 3; i++)
    assert_true(out[i].guards == batch[i].out.guards && (i == 1 || out[i].gap == batch[i].out.gap));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestPolynomials), cmocka_unit_test(TestPlaneEqualsSpace),
                                     cmocka_unit_test(TestSphere),      cmocka_unit_test(TestCurvature),
                                     cmocka_unit_test(TestSupportEnd),  cmocka_unit_test(TestShape),
                                     cmocka_unit_test(TestGuards),      cmocka_unit_test(TestUnits),
                                     cmocka_unit_test(TestNeverNaN),    cmocka_unit_test(TestLargeAndBatch)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
