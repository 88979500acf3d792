/* Shows that backstresses follow Armstrong and Frederick: cyclic tension against their closed form, a path with corners
   against their rate equations, shear to 500 %, objectivity; and that the overstress is Perzyna's. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "kernels/vonmises.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double    bulk = 175, shear = 80.7;
static const Hardening armstrong = {.yield = 0.3, .terms = 1, .backstress = {{8, 20}}},
                       chaboche  = {.yield      = 0.3,
                                    .saturation = 0.4,
                                    .rate       = 10,
                                    .terms      = 3,
                                    .backstress = {{40, 300}, {8, 20}, {0.5, 0}}};

/* Evaluates one point and takes its state on. The last lane is another point, which must not matter. */
static void Point(int finite, const Hardening *h, double dt, const double H[9], double state[PLASTIC_MAX_STATE],
                  double P[9], double A[MATERIAL_TANGENT_SIZE])
{
  const int   n     = PlasticStates(h);
  const Lanes bulk_ = (Lanes){0} + bulk, shear_ = (Lanes){0} + shear;
  Lanes       H_[9], P_[9], A_[MATERIAL_TANGENT_SIZE], dilatation, state_[PLASTIC_MAX_STATE];

  for (int r = 0; r < 9; r++) {
    H_[r]            = (Lanes){0} + H[r];
    H_[r][LANES - 1] = -0.3 * H[r];
  }
  for (int k = 0; k < n; k++) state_[k] = (Lanes){0} + state[k];
  MaterialDilatation(H_, &dilatation);
  VonMisesLaw(finite, H_, &dilatation, &bulk_, &shear_, h, dt, state_, NULL, P_, A_, state_);
  for (int r = 0; r < 9; r++) P[r] = P_[r][0];
  for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k] = A_[k][0];
  for (int k = 0; k < n; k++) state[k] = state_[k][0];
}

/* Goes to a strain in tension, without lateral stress. Returns the Kirchhoff stress. */
static double Tension(int finite, const Hardening *h, double dt, double strain, double H[9],
                      double state[PLASTIC_MAX_STATE])
{
  double P[9], A[MATERIAL_TANGENT_SIZE], trial[PLASTIC_MAX_STATE], change = 1;

  H[0] = finite ? expm1(strain) : strain;
  for (int i = 0; i < 50 && fabs(change) > 1e-15; i++) {
    memcpy(trial, state, sizeof trial);
    Point(finite, h, dt, H, trial, P, A);
    change = P[4] / (A[MATERIAL_TANGENT_INDEX(4, 4)] + A[MATERIAL_TANGENT_INDEX(4, 8)]);
    H[4] -= change;
    H[8] -= change;
  }
  memcpy(state, trial, sizeof trial);
  return finite ? P[0] * (1 + H[0]) : P[0];
}

/* Tension and compression between strains of 5 %: one step for each way gives the closed form
   X = sign C/gamma + (X_0 - sign C/gamma) exp(-gamma p), whose loops settle down. */
static void CyclicTensionHasTheClosedForm(void **unused)
{
  const double young = 9 * bulk * shear / (3 * bulk + shear);

  (void)unused;
  for (int finite = 0; finite < 2; finite++) {
    double state[PLASTIC_MAX_STATE] = {0}, H[9] = {0}, X[HARDENING_MAX_TERMS] = {0}, plastic = 0, strain = 0;

    for (int way = 0; way < 12; way++) {
      const double sign = way % 2 ? -1 : 1, stress = Tension(finite, &chaboche, 0, 0.05 * sign, H, state);
      const double p   = sign * (0.05 * sign - stress / young - plastic);
      double       sum = 0, slope, work;

      plastic += sign * p;
      strain += p;
      for (int k = 0; k < chaboche.terms; k++) {
        const double C = chaboche.backstress[k][0], gamma = chaboche.backstress[k][1];

        X[k] = gamma > 0 ? sign * C / gamma + (X[k] - sign * C / gamma) * exp(-gamma * p) : X[k] + sign * C * p;
        sum += X[k];
      }
      assert_near(state[PLASTIC_STRAIN], strain, 1e-12);
      assert_near(stress, sum + sign * HardeningStress(&chaboche, strain, &slope, &work), 1e-11);
    }
  }
}

/* Rate equations in small strains with many explicit steps. The strain rate is sym(D), in the plane of tension and
   shear. */
static void Rates(const Hardening *h, const double D[9], int steps, double s[9], double X[9])
{
  const double C = h->backstress[0][0], gamma = h->backstress[0][1];

  for (int step = 0; step < steps; step++) {
    double n[9], size = 0, along = 0, hardening = 0, p = 0;

    for (int k = 0; k < 9; k++) size += (s[k] - X[k]) * (s[k] - X[k]);
    size = sqrt(1.5 * size);
    for (int k = 0; k < 9; k++) {
      n[k] = size > 0 ? 1.5 * (s[k] - X[k]) / size : 0;
      along += 2 * shear * n[k] * D[k] / steps;
      hardening += n[k] * gamma * X[k];
    }
    if (size >= h->yield) p = fmax(0, along + size - h->yield) / (3 * shear + C - hardening);
    for (int k = 0; k < 9; k++) {
      s[k] += 2 * shear * (D[k] / steps - p * n[k]);
      X[k] += p * (2 * C / 3 * n[k] - gamma * X[k]);
    }
  }
}

/* Tension, then shear, then compression: the error of the stress falls with the length of the steps. */
static void CornersConvergeToTheRateEquations(void **unused)
{
  static const double ways[3][9] = {{0.02, 0, 0, 0, -0.01, 0, 0, 0, -0.01},
                                    {0, 0.02, 0, 0.02, 0, 0, 0, 0, 0},
                                    {-0.03, 0, 0, 0, 0.03, 0, 0, 0, 0}};
  double              s[9] = {0}, X[9] = {0}, last = 0;

  (void)unused;
  for (int way = 0; way < 3; way++) Rates(&armstrong, ways[way], 200000, s, X);
  for (int steps = 10; steps <= 320; steps *= 2) {
    double state[PLASTIC_MAX_STATE] = {0}, H[9] = {0}, P[9], error = 0;

    for (int step = 0; step < 3 * steps; step++) {
      for (int k = 0; k < 9; k++) H[k] += ways[step / steps][k] / steps;
      Point(0, &armstrong, 0, H, state, P, NULL);
    }
    for (int k = 0; k < 9; k++) error = fmax(error, fabs(P[k] - s[k]));
    if (steps > 10) assert_true(error < 0.6 * last);
    last = error;
  }
  assert_true(last < 1e-3 * armstrong.yield);
}

/* Shear to 500 % in steps of 5 %: the shear stress does not fall, and comes to rest where a backstress saturates. */
static void LargeShearDoesNotOscillate(void **unused)
{
  const Hardening *const laws[] = {&armstrong, &chaboche};

  (void)unused;
  for (int law = 0; law < 2; law++) {
    double state[PLASTIC_MAX_STATE] = {0}, P[9], before = 0, first = 0;

    for (int step = 1; step <= 100; step++) {
      const double H[9] = {0, 0.05 * step, 0, 0, 0, 0, 0, 0, 0};

      Point(1, laws[law], 0, H, state, P, NULL);
      assert_true(P[1] >= before * (1 - 2e-3));
      before = P[1];
      if (step == 40) first = P[1];
    }
    if (law == 0) assert_near(P[1], first, 2e-2 * first);
    assert_near((1 + state[2]) * ((1 + state[0]) * (1 + state[1]) - state[3] * state[3]), 1, 1e-10);
  }
}

/* A rotation after the deformation turns the stress; one before it turns the state. Both change nothing else. */
static void TheLawIsObjective(void **unused)
{
  static const double ways[2][9] = {{0.1, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2},
                                    {0.15, -0.3, 0.02, 0.1, -0.1, 0.35, -0.1, 0.15, 0.1}};
  const double        c = cos(1.1), s = sin(1.1), Q[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  double              state[3][PLASTIC_MAX_STATE] = {{0}}, P[3][9];

  (void)unused;
  for (int way = 0; way < 2; way++) {
    double H[2][9] = {{0}};

    for (int r = 0; r < 9; r++) {
      for (int k = 0; k < 3; k++) {
        H[0][r] += Q[3 * (r / 3) + k] * (ways[way][3 * k + r % 3] + (k == r % 3));
        H[1][r] += (ways[way][3 * (r / 3) + k] + (k == r / 3)) * Q[3 * k + r % 3];
      }
      for (int k = 0; k < 2; k++) H[k][r] -= r % 4 == 0;
    }
    Point(1, &chaboche, 0, ways[way], state[0], P[0], NULL);
    Point(1, &chaboche, 0, H[0], state[1], P[1], NULL);
    Point(1, &chaboche, 0, H[1], state[2], P[2], NULL);
    for (int r = 0; r < 9; r++) {
      double turned = 0, other = 0;

      for (int k = 0; k < 3; k++) {
        turned += Q[3 * (r / 3) + k] * P[0][3 * k + r % 3];
        other += P[0][3 * (r / 3) + k] * Q[3 * k + r % 3];
      }
      assert_near(P[1][r], turned, 1e-10);
      assert_near(P[2][r], other, 1e-10);
    }
    for (int k = 0; k < PLASTIC_MAX_STATE; k++) assert_near(state[1][k], state[0][k], 1e-11);
    assert_near(state[2][PLASTIC_STRAIN], state[0][PLASTIC_STRAIN], 1e-12);
  }
}

/* With small strains both laws agree to the square of the strain. */
static void SmallStrainsAreTheLimit(void **unused)
{
  const double    size = 1e-5, ways[2][9] = {{0.1, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2},
                                             {0.15, 0.3, 0.02, -0.1, -0.1, -0.35, -0.1, 0.15, 0.1}};
  const Hardening soft                        = {.yield = 1e-4, .terms = 2, .backstress = {{8, 2e4}, {3, 0}}};
  double          state[2][PLASTIC_MAX_STATE] = {{0}}, P[2][9];

  (void)unused;
  for (int way = 0; way < 2; way++) {
    double H[9];

    for (int r = 0; r < 9; r++) H[r] = size * ways[way][r];
    for (int finite = 0; finite < 2; finite++) Point(finite, &soft, 0, H, state[finite], P[finite], NULL);
    assert_true(state[0][PLASTIC_STRAIN] > 0.1 * size);
    for (int r = 0; r < 9; r++) assert_near(P[0][r], P[1][r], 1e4 * size * size);
    for (int k = 0; k < PLASTIC_MAX_STATE; k++) assert_near(state[0][k], state[1][k], 100 * size * size);
  }
}

/* Tension at a constant rate: at the end stress - yield stress is overstress (rate / speed)^(1 / power). A strain that
   is held lets the stress relax; with power 1 and linear hardening it does so by (1 + dt / time)^-n. */
static void OverstressIsPerzynas(void **unused)
{
  const Hardening fast = {.yield = 0.45, .overstress = 0.2, .speed = 0.7, .power = 3},
                  held = {.yield = 0.3, .linear = 5, .overstress = 0.2, .speed = 0.01, .power = 1};
  const double young = 9 * bulk * shear / (3 * bulk + shear), rate = 0.05;
  double       state[2][PLASTIC_MAX_STATE] = {{0}}, H[9] = {0}, stress = 0, over;

  (void)unused;
  for (int step = 1; step <= 20; step++) stress = Tension(0, &fast, 0.02, rate * 0.02 * step, H, state[0]);
  assert_near(stress, 0.45 + 0.2 * pow(rate / 0.7, 1. / 3), 1e-6);
  memset(H, 0, sizeof H);
  stress = Tension(0, &held, 1e-9, 0.003, H, state[1]); /* no time to flow */
  assert_near(stress, young * 0.003, 1e-6);
  over = stress - 0.3;
  for (int step = 1; step <= 10; step++) { /* d(over)/dt = -(E + 5) 0.01 over / 0.2 */
    stress = Tension(0, &held, 0.03, 0.003, H, state[1]);
    over /= 1 + (young + 5) * 0.01 / 0.2 * 0.03;
    assert_near(stress - 0.3 - 5 * state[1][PLASTIC_STRAIN], over, 1e-6);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(CyclicTensionHasTheClosedForm), cmocka_unit_test(CornersConvergeToTheRateEquations),
    cmocka_unit_test(LargeShearDoesNotOscillate),    cmocka_unit_test(TheLawIsObjective),
    cmocka_unit_test(SmallStrainsAreTheLimit),       cmocka_unit_test(OverstressIsPerzynas),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
