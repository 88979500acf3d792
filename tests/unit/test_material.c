/* Shows that every law's stress and tangent are derivatives of its energy, and that its linearisation is Hooke's law.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "kernels/material.h"
#include "laws.h"
#include "lameconstants.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double E = 210, nu = 0.3;
static const double strained[9] = {0.1, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2};

static double Tangent(const double A[MATERIAL_TANGENT_SIZE], int r, int s)
{
  return r <= s ? A[MATERIAL_TANGENT_INDEX(r, s)] : A[MATERIAL_TANGENT_INDEX(s, r)];
}

static void StressAndTangentAreDerivatives(void **state)
{
  const double h = 1e-5;

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    for (int finite = 0; finite < 2; finite++) {
      const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
      double         P[9], A[MATERIAL_TANGENT_SIZE];

      MaterialPoint(&material, finite, strained, NULL, P, A);
      for (int s = 0; s < 9; s++) {
        double plus[9], minus[9], P_plus[9], P_minus[9], W_plus, W_minus;

        memcpy(plus, strained, sizeof(plus));
        memcpy(minus, strained, sizeof(minus));
        plus[s] += h;
        minus[s] -= h;
        MaterialPoint(&material, finite, plus, &W_plus, P_plus, NULL);
        MaterialPoint(&material, finite, minus, &W_minus, P_minus, NULL);
        assert_near(P[s], (W_plus - W_minus) / (2 * h), 1e-8 * E);
        for (int r = 0; r < 9; r++) assert_near(Tangent(A, r, s), (P_plus[r] - P_minus[r]) / (2 * h), 1e-8 * E);
      }
    }
  }
}

static void TangentOfTheUndeformedStateIsHooke(void **state)
{
  const double zero[9] = {0};

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double         P[9], A[MATERIAL_TANGENT_SIZE], W, P_small[9], A_small[MATERIAL_TANGENT_SIZE];

    MaterialPoint(&material, 1, zero, &W, P, A);
    MaterialPoint(&material, 0, zero, NULL, P_small, A_small);
    assert_near(W, 0, 0);
    for (int r = 0; r < 9; r++) assert_near(P[r], 0, 0);
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) assert_near(A[k], A_small[k], 1e-14 * E);
  }
}

static void UniaxialStressGivesYoungsModulus(void **state)
{
  const Material material = MaterialFromModuli(MATERIAL_LINEAR, E, nu);
  const double   H[9]     = {1e-3, 0, 0, 0, -nu * 1e-3, 0, 0, 0, -nu * 1e-3};
  double         P[9], W;

  (void)state;
  MaterialPoint(&material, 0, H, &W, P, NULL);
  assert_near(P[0], E * 1e-3, 1e-14 * E);
  assert_near(P[4], 0, 1e-16 * E);
  assert_near(W, E * 1e-6 / 2, 1e-16 * E);
}

/* St. Venant-Kirchhoff under a stretch k in x: S_xx = (lambda + 2 mu) (k^2 - 1) / 2, P_xx = k S_xx */
static void SvkStretchIsExact(void **state)
{
  const Material material = MaterialFromModuli(MATERIAL_SVK, E, nu);
  const double   H[9] = {0.25}, k = 1.25, green = (k * k - 1) / 2;
  double         P[9], lambda, mu;

  (void)state;
  MaterialLame(E, nu, &lambda, &mu);
  MaterialPoint(&material, 1, H, NULL, P, NULL);
  assert_near(P[0], k * (lambda + 2 * mu) * green, 1e-13 * E);
  assert_near(P[4], lambda * green, 1e-13 * E);
}

/* Neo-Hooke under a volume change k^3: P = mu (k - 1/k) + 3 lambda ln k / k */
static void NeoHookeanExpansionIsExact(void **state)
{
  const Material material = MaterialFromModuli(MATERIAL_NEO_HOOKEAN, E, nu);
  const double   k = 1.2, H[9] = {k - 1, 0, 0, 0, k - 1, 0, 0, 0, k - 1};
  double         P[9], W, lambda, mu;

  (void)state;
  MaterialLame(E, nu, &lambda, &mu);
  MaterialPoint(&material, 1, H, &W, P, NULL);
  for (int i = 0; i < 3; i++) assert_near(P[4 * i], mu * (k - 1 / k) + 3 * lambda * log(k) / k, 1e-13 * E);
  assert_near(W, 1.5 * mu * (k * k - 1) - 3 * mu * log(k) + 4.5 * lambda * log(k) * log(k), 1e-13 * E);
}

static void RotationCausesNoStress(void **state)
{
  const double c = cos(1.1), s = sin(1.1), H[9] = {c - 1, -s, 0, s, c - 1, 0, 0, 0, 0};

  (void)state;
  for (int law = MATERIAL_SVK; law < MATERIAL_LAWS; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double         P[9], W;

    MaterialPoint(&material, 1, H, &W, P, NULL);
    assert_near(W, 0, 1e-14 * E);
    for (int r = 0; r < 9; r++) assert_near(P[r], 0, 1e-14 * E);
  }
}

static void SmallStrainsKeepTheirDigits(void **state)
{
  const double strain = 1e-12, H[9] = {strain, 0, 0, 0, strain, 0, 0, 0, strain};

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double         P[9];

    MaterialPoint(&material, 1, H, NULL, P, NULL);
    assert_near(P[0] / (E / (1 - 2 * nu) * strain), 1, 1e-11);
  }
}

static void InvertedPointsStayFinite(void **state)
{
  const double inverted[9] = {-2.5, 0.1, 0, 0, 0.2, 0, 0.3, 0, 0}, flat[9] = {-1};

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double         P[9], A[MATERIAL_TANGENT_SIZE], W;

    for (int k = 0; k < 2; k++) {
      MaterialPoint(&material, 1, k ? flat : inverted, &W, P, A);
      assert_true(isfinite(W));
      for (int r = 0; r < 9; r++) assert_true(isfinite(P[r]));
      for (int r = 0; r < MATERIAL_TANGENT_SIZE; r++) assert_true(isfinite(A[r]));
    }
  }
}

static void NamesEndWithNull(void **state)
{
  (void)state;
  assert_string_equal(MaterialLaws[MATERIAL_LINEAR], "linear");
  assert_string_equal(MaterialLaws[MATERIAL_SVK], "svk");
  assert_string_equal(MaterialLaws[MATERIAL_NEO_HOOKEAN], "neo_hookean");
  assert_null(MaterialLaws[MATERIAL_LAWS]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(StressAndTangentAreDerivatives),
    cmocka_unit_test(TangentOfTheUndeformedStateIsHooke),
    cmocka_unit_test(UniaxialStressGivesYoungsModulus),
    cmocka_unit_test(SvkStretchIsExact),
    cmocka_unit_test(NeoHookeanExpansionIsExact),
    cmocka_unit_test(RotationCausesNoStress),
    cmocka_unit_test(SmallStrainsKeepTheirDigits),
    cmocka_unit_test(InvertedPointsStayFinite),
    cmocka_unit_test(NamesEndWithNull),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
