/* Shows that von Mises' law is derived from its incremental potential, that it is objective, and that it follows each
   hardening curve in tension. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "kernels/vonmises.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double bulk = 175, shear = 80.7, E = 210;
static const Hardening
  perfect = {.yield = 0.45},
  linear = {.yield = 0.45, .linear = 2.5}, voce = {.yield = 0.45, .linear = 0.129, .saturation = 0.715, .rate = 16.93},
  swift = {.yield = 0.2, .strength = 0.5, .exponent = 0.25, .strain = 0.4 * 0.4 * 0.4 * 0.4},
  sum = {.yield = 0.45, .linear = 0.2, .saturation = 0.7, .rate = 10, .strength = 0.9, .exponent = 0.5, .strain = 0.25},
  table     = {.rows = 4, .table = {{0, 0.45}, {0.02, 0.5}, {0.1, 0.6}, {0.2, 0.62}}},
  viscous   = {.yield = 0.45, .linear = 0.3, .overstress = 0.2, .speed = 0.7, .power = 3},
  prager    = {.yield = 0.45, .terms = 1, .backstress = {{2.5, 0}}},
  armstrong = {.yield = 0.3, .terms = 1, .backstress = {{8, 20}}},
  chaboche  = {.yield      = 0.3,
               .linear     = 0.2,
               .saturation = 0.5,
               .rate       = 10,
               .terms      = 3,
               .backstress = {{40, 300}, {8, 20}, {0.5, 0}}},
  all       = {.rows       = 3,
               .table      = {{0, 0.3}, {0.05, 0.4}, {0.3, 0.45}},
               .terms      = 2,
               .backstress = {{5, 30}, {1, 3}},
               .overstress = 0.2,
               .speed      = 0.7,
               .power      = 5};
/* The first ISOTROPIC ones have a closed form in tension. */
static const Hardening *const hardenings[] = {&perfect, &linear,    &voce,     &swift, &sum,    &table,
                                              &prager,  &armstrong, &chaboche, &all,   &viscous};
enum { HARDENINGS = sizeof hardenings / sizeof *hardenings, ISOTROPIC = 6 };
static double dt = 0.4;

/* Evaluates one point. The lanes hold the same numbers. */
static void Point(int finite, const Hardening *h, const double H[9], const double state[PLASTIC_MAX_STATE], double *W,
                  double P[9], double A[MATERIAL_TANGENT_SIZE], double next[PLASTIC_MAX_STATE])
{
  const int n = PlasticStates(h);
  Lanes H_[9], P_[9], A_[MATERIAL_TANGENT_SIZE], W_, dilatation, state_[PLASTIC_MAX_STATE], next_[PLASTIC_MAX_STATE];
  const Lanes bulk_ = (Lanes){0} + bulk, shear_ = (Lanes){0} + shear;

  for (int r = 0; r < 9; r++) H_[r] = (Lanes){0} + H[r];
  for (int k = 0; k < n; k++) state_[k] = (Lanes){0} + state[k];
  MaterialDilatation(H_, &dilatation);
  VonMisesLaw(finite, H_, &dilatation, &bulk_, &shear_, h, dt, state_, &W_, P_, A_, next_);
  if (W) *W = W_[0];
  for (int r = 0; r < 9 && P; r++) P[r] = P_[r][0];
  for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k] = A_[k][0];
  for (int k = 0; k < n && next; k++) next[k] = next_[k][0];
}

static double Tangent(const double A[MATERIAL_TANGENT_SIZE], int r, int s)
{
  return r <= s ? A[MATERIAL_TANGENT_INDEX(r, s)] : A[MATERIAL_TANGENT_INDEX(s, r)];
}

/* States with equal and with different principal strains, elastic and plastic, small and large increments */
static const double first[9]    = {0.1, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2};
static const double second[][9] = {{0.15, -0.25, 0.02, 0.1, -0.1, 0.35, -0.1, 0.15, 0.1},
                                   {0.1 + 1e-4, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2 - 2e-4},
                                   {0.02, 0, 0, 0, 0.02, 0, 0, 0, 0.02},
                                   {0.3, 0, 0, 0, -0.1, 0, 0, 0, -0.1},
                                   {1e-3, 0, 0, 0, 1e-3, 0, 0, 0, -1e-3},
                                   {0, 1.5, 0, 0, 0, 0, 0, 0, 0}};
enum { SECONDS = sizeof second / sizeof *second };

static void CheckDerivatives(int finite, const Hardening *h, const double H[9], const double state[PLASTIC_MAX_STATE])
{
  const double step = 2e-7;
  double       P[9], A[MATERIAL_TANGENT_SIZE];

  Point(finite, h, H, state, NULL, P, A, NULL);
  for (int s = 0; s < 9; s++) {
    double plus[9], minus[9], P_plus[9], P_minus[9], W_plus, W_minus;

    memcpy(plus, H, sizeof plus);
    memcpy(minus, H, sizeof minus);
    plus[s] += step;
    minus[s] -= step;
    Point(finite, h, plus, state, &W_plus, P_plus, NULL, NULL);
    Point(finite, h, minus, state, &W_minus, P_minus, NULL, NULL);
    assert_near(P[s], (W_plus - W_minus) / (2 * step), 1e-7 * E);
    for (int r = 0; r < 9; r++) assert_near(Tangent(A, r, s), (P_plus[r] - P_minus[r]) / (2 * step), 1e-7 * E);
  }
}

static void StressAndTangentAreDerivatives(void **unused)
{
  (void)unused;
  for (int finite = 0; finite < 2; finite++) {
    for (int h = 0; h < HARDENINGS; h++) {
      double state[2][PLASTIC_MAX_STATE] = {{0}};

      Point(finite, hardenings[h], first, state[0], NULL, NULL, NULL, state[1]);
      assert_true(state[1][PLASTIC_STRAIN] > 0.01);
      CheckDerivatives(finite, hardenings[h], first, state[0]);
      for (int k = 0; k < SECONDS; k++) {
        CheckDerivatives(finite, hardenings[h], second[k], state[0]);
        CheckDerivatives(finite, hardenings[h], second[k], state[1]);
      }
    }
  }
}

/* At the state that it has just reached a point is elastic and has the same stress and potential. */
static void AcceptedStatesAreElastic(void **unused)
{
  (void)unused;
  for (int finite = 0; finite < 2; finite++) {
    for (int h = 0; h < HARDENINGS; h++) {
      const double zero[PLASTIC_MAX_STATE]  = {0};
      double       state[PLASTIC_MAX_STATE] = {0}, again[PLASTIC_MAX_STATE] = {0}, P[9], P_again[9], W, W_again;

      Point(finite, hardenings[h], first, zero, &W, P, NULL, state);
      dt = 0;
      Point(finite, hardenings[h], first, state, &W_again, P_again, NULL, again);
      dt = 0.4;
      if (hardenings[h]->overstress <= 0) assert_near(W, W_again, 1e-13 * W);
      for (int r = 0; r < 9; r++) assert_near(P[r], P_again[r], 1e-13 * E);
      for (int k = 0; k < PLASTIC_MAX_STATE; k++) assert_true(state[k] == again[k]);
    }
  }
}

/* A rotation after the deformation turns the stress and changes nothing else. */
static void RotationTurnsTheStress(void **unused)
{
  const double c = cos(1.1), s = sin(1.1), Q[9] = {c, -s, 0, s, c, 0, 0, 0, 1}, zero[PLASTIC_MAX_STATE] = {0};
  double       H[9], P[9], P_turned[9], W, W_turned, state[PLASTIC_MAX_STATE] = {0}, turned[PLASTIC_MAX_STATE] = {0};

  (void)unused;
  for (int r = 0; r < 9; r++) {
    H[r] = -(double)(r % 4 == 0);
    for (int k = 0; k < 3; k++) H[r] += Q[3 * (r / 3) + k] * (first[3 * k + r % 3] + (k == r % 3));
  }
  Point(1, &voce, first, zero, &W, P, NULL, state);
  Point(1, &voce, H, zero, &W_turned, P_turned, NULL, turned);
  assert_near(W, W_turned, 1e-14 * E);
  for (int r = 0; r < 9; r++) {
    double expected = 0;

    for (int k = 0; k < 3; k++) expected += Q[3 * (r / 3) + k] * P[3 * k + r % 3];
    assert_near(P_turned[r], expected, 1e-13 * E);
  }
  for (int k = 0; k < PLASTIC_MAX_STATE; k++) assert_near(state[k], turned[k], 1e-13);
}

/* Finds the lateral stretch without lateral stress by Newton's method. */
static void Tension(int finite, const Hardening *h, double H[9], const double state[PLASTIC_MAX_STATE], double P[9],
                    double next[PLASTIC_MAX_STATE])
{
  for (int i = 0; i < 30; i++) {
    double A[MATERIAL_TANGENT_SIZE], change;

    Point(finite, h, H, state, NULL, P, A, next);
    change = P[4] / (Tangent(A, 4, 4) + Tangent(A, 4, 8));
    H[4] -= change;
    H[8] -= change;
    if (fabs(change) < 1e-15) break;
  }
}

/* Tension to 60 % in steps: the Kirchhoff stress is the yield stress at the plastic strain ln(stretch) - stress / E.
   Then unloading along Hooke's line. */
static void TensionFollowsTheHardening(void **unused)
{
  const double young = 9 * bulk * shear / (3 * bulk + shear);

  (void)unused;
  for (int finite = 0; finite < 2; finite++) {
    for (int h = 0; h < ISOTROPIC; h++) {
      double state[PLASTIC_MAX_STATE] = {0}, H[9] = {0}, P[9], stress, slope, work, strain;

      for (int step = 1; step <= 12; step++) {
        double next[PLASTIC_MAX_STATE];

        H[0] = 0.05 * step;
        Tension(finite, hardenings[h], H, state, P, next);
        memcpy(state, next, sizeof state);
        stress = finite ? P[0] * (1 + H[0]) : P[0];
        strain = (finite ? log1p(H[0]) : H[0]) - stress / young;
        assert_near(state[PLASTIC_STRAIN], strain, 1e-12);
        assert_near(stress, HardeningStress(hardenings[h], strain, &slope, &work), 1e-11);
      }
      H[0] -= 1e-4;
      Tension(finite, hardenings[h], H, state, P, state);
      strain = (finite ? log1p(H[0]) : H[0]) - strain;
      assert_near(finite ? P[0] * (1 + H[0]) : P[0], young * strain, 1e-10);
    }
  }
}

/* Slope and work of each curve are its derivative and its integral. */
static void HardeningIsConsistent(void **unused)
{
  const double step = 1e-6;

  (void)unused;
  for (int h = 0; h < ISOTROPIC; h++) {
    for (double strain = 0.003; strain < 0.4; strain += 0.0173) {
      double       slope, work, work_plus, work_minus, none;
      const double stress = HardeningStress(hardenings[h], strain, &slope, &work);
      const double plus   = HardeningStress(hardenings[h], strain + step, &none, &work_plus);
      const double minus  = HardeningStress(hardenings[h], strain - step, &none, &work_minus);

      assert_near(slope, (plus - minus) / (2 * step), 1e-8);
      assert_near(stress, (work_plus - work_minus) / (2 * step), 1e-9);
    }
  }
}

/* With small strains both laws agree to the square of the strain. */
static void SmallStrainsAreTheLimit(void **unused)
{
  const double    size                    = 1e-5;
  const double    zero[PLASTIC_MAX_STATE] = {0};
  const Hardening soft                    = {.yield = 1e-4, .linear = 2.5};
  double          H[9], P[2][9], state[2][PLASTIC_MAX_STATE] = {{0}};

  (void)unused;
  for (int r = 0; r < 9; r++) H[r] = size * first[r];
  for (int finite = 0; finite < 2; finite++) Point(finite, &soft, H, zero, NULL, P[finite], NULL, state[finite]);
  assert_true(state[0][PLASTIC_STRAIN] > 0.1 * size);
  for (int r = 0; r < 9; r++) assert_near(P[0][r], P[1][r], 10 * size * size * E);
  for (int k = 0; k < PLASTIC_MAX_STATE; k++) assert_near(state[0][k], state[1][k], 10 * size * size);
}

/* Simple shear to 500 % without hardening: the shear stress stays yield / sqrt(3), the plastic part keeps the volume.
 */
static void LargeShearDoesNotOscillate(void **unused)
{
  double state[PLASTIC_MAX_STATE] = {0}, P[9], determinant;

  (void)unused;
  for (int step = 1; step <= 100; step++) {
    const double H[9] = {0, 0.05 * step, 0, 0, 0, 0, 0, 0, 0};

    Point(1, &perfect, H, state, NULL, P, NULL, state);
    if (step > 1) assert_near(P[1], perfect.yield / sqrt(3), 2e-3 * perfect.yield);
  }
  determinant = (1 + state[2]) * ((1 + state[0]) * (1 + state[1]) - state[3] * state[3]);
  assert_near(determinant, 1, 1e-11);
}

/* A long step of simple shear lags: its shear stress is the true one over cosh(sqrt(3)/2 a), where a is the growth of
   the equivalent plastic strain in the step. */
static void LongStepsOfShearLag(void **unused)
{
  const double steps[] = {0.2, 0.5, 1, 2};

  (void)unused;
  for (int k = 0; k < 4; k++) {
    double state[PLASTIC_MAX_STATE] = {0}, P[9], before;

    for (int step = 1; step <= 20; step++) Point(1, &perfect, (double[9]){0, 0.01 * step}, state, NULL, P, NULL, state);
    before = state[PLASTIC_STRAIN];
    Point(1, &perfect, (double[9]){0, 0.2 + steps[k]}, state, NULL, P, NULL, state);
    assert_near(P[1], perfect.yield / sqrt(3) / cosh(sqrt(3) / 2 * (state[PLASTIC_STRAIN] - before)),
                2e-3 * perfect.yield);
  }
}

static void InvertedPointsStayFinite(void **unused)
{
  const double points[][9] = {{-2.5, 0.1, 0, 0, 0.2, 0, 0.3, 0, 0},
                              {-1},
                              {-1, 0, 0, 0, -1, 0, 0, 0, -1},
                              {1e3, -1e3, 7}};

  (void)unused;
  for (int k = 0; k < 4; k++) {
    double state[PLASTIC_MAX_STATE] = {0}, P[9], A[MATERIAL_TANGENT_SIZE], W;

    Point(1, &voce, points[k], state, &W, P, A, state);
    assert_true(isfinite(W));
    for (int r = 0; r < 9; r++) assert_true(isfinite(P[r]));
    for (int r = 0; r < MATERIAL_TANGENT_SIZE; r++) assert_true(isfinite(A[r]));
    for (int r = 0; r < PLASTIC_MAX_STATE; r++) assert_true(isfinite(state[r]));
  }
}

/* Bodies without load have displacements of round-off, which each step makes smaller, down to the smallest numbers. */
static void TinyStrainsAreElastic(void **unused)
{
  const double zero[9] = {0}, virgin[PLASTIC_MAX_STATE] = {0};
  double       A_0[MATERIAL_TANGENT_SIZE];

  (void)unused;
  for (int finite = 0; finite < 2; finite++) {
    double P[9], W;

    Point(finite, &voce, zero, virgin, &W, P, A_0, NULL);
    for (double size = 1e-20; size > 0; size /= 1e20) {
      double H[9], A[MATERIAL_TANGENT_SIZE];

      for (int r = 0; r < 9; r++) H[r] = size * first[r];
      Point(finite, &voce, H, virgin, &W, P, A, NULL);
      for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) assert_near(A[k], A_0[k], 1e-12 * E);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(StressAndTangentAreDerivatives),
    cmocka_unit_test(AcceptedStatesAreElastic),
    cmocka_unit_test(RotationTurnsTheStress),
    cmocka_unit_test(TensionFollowsTheHardening),
    cmocka_unit_test(HardeningIsConsistent),
    cmocka_unit_test(SmallStrainsAreTheLimit),
    cmocka_unit_test(LargeShearDoesNotOscillate),
    cmocka_unit_test(InvertedPointsStayFinite),
    cmocka_unit_test(LongStepsOfShearLag),
    cmocka_unit_test(TinyStrainsAreElastic),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
