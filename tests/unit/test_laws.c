/* Shows that laws of rubber have the closed forms of textbooks, that Ogden's law in principal stretches equals the laws
 * in invariants, with equal stretches too, and that stability is lost where the closed forms say. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "kernels/stability.h"
#include "laws.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double E = 3, nu = 0.49;
static const double stretches[] = {0.25, 0.6, 0.9, 0.999, 1.001, 1.2, 1.7, 3, 4.5};
enum { STRETCHES = sizeof stretches / sizeof *stretches };

/* dW/dI1 and dW/dI2 of the laws in invariants, at constant volume */
static void Derivatives(const Material *m, double I1, double *w1, double *w2)
{
  static const double series[5] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
  const double       *c         = m->constants;

  *w1 = c[1] / 2;
  *w2 = 0;
  if (m->law == MATERIAL_MOONEY_RIVLIN) {
    *w1 = c[1];
    *w2 = c[2];
  } else if (m->law == MATERIAL_YEOH)
    *w1 = c[1] + 2 * c[2] * (I1 - 3) + 3 * c[3] * (I1 - 3) * (I1 - 3);
  else if (m->law == MATERIAL_ARRUDA_BOYCE) {
    *w1 = 0;
    for (int k = 1; k <= 5; k++) *w1 += c[1] * series[k - 1] * k * pow(I1, k - 1) / pow(c[2], 2 * k - 2);
  }
}

/* Nominal stress of an incompressible solid in direction 0 with no stress in direction 2: sum mu_i (l0^(a_i) -
   l2^(a_i)) / l0 for Ogden, else 2 (l0^2 - l2^2) (w1 + l1^2 w2) / l0 */
static double ClosedForm(const Material *m, const double l[3])
{
  double stress = 0, w1, w2;

  if (m->law == MATERIAL_OGDEN) {
    for (int k = 1; k < m->n_constants; k += 2)
      stress += m->constants[k] * (pow(l[0], m->constants[k + 1]) - pow(l[2], m->constants[k + 1])) / l[0];
    return stress;
  }
  Derivatives(m, l[0] * l[0] + l[1] * l[1] + l[2] * l[2], &w1, &w2);
  return 2 * (l[0] * l[0] - l[2] * l[2]) * (w1 + l[1] * l[1] * w2) / l[0];
}

static void Stretches(MaterialTest test, double l, double stretch[3])
{
  stretch[0] = l;
  stretch[1] = test == TEST_UNIAXIAL ? 1 / sqrt(l) : test == TEST_EQUIBIAXIAL ? l : 1;
  stretch[2] = 1 / (stretch[0] * stretch[1]);
}

/* The pressure that constant volume calls for is eliminated by the direction without stress. */
static void HomogeneousStressesAreExact(void **state)
{
  (void)state;
  for (int law = MATERIAL_NEO_HOOKEAN; law <= MATERIAL_ARRUDA_BOYCE; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);

    for (int test = 0; test < MATERIAL_TESTS; test++) {
      for (int i = 0; i < STRETCHES; i++) {
        double l[3], H[9] = {0}, P[9], expected;

        Stretches((MaterialTest)test, stretches[i], l);
        for (int a = 0; a < 3; a++) H[4 * a] = l[a] - 1;
        MaterialPoint(&material, 1, H, NULL, P, NULL);
        expected = ClosedForm(&material, l);
        assert_near(P[0] - P[8] * l[2] / l[0], expected, 1e-11 * fmax(E, fabs(expected)));
      }
    }
  }
}

/* Without the modulus of the volume an isochoric law does not notice a change of volume, and U = K/2 (ln J)^2 gives the
   pressure K ln J / J, here P k = K ln J. */
static void VolumeAndShapeAreSeparate(void **state)
{
  const double H[9] = {0.3, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2}, k = 1.3, J = k * k * k;
  const double expansion[9] = {k - 1, 0, 0, 0, k - 1, 0, 0, 0, k - 1};

  (void)state;
  for (int law = MATERIAL_ISOCHORIC_NEO_HOOKEAN; law <= MATERIAL_ARRUDA_BOYCE; law++) {
    Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double   larger[9], P[9], W, W_larger;

    assert_true(MaterialGetLaw((MaterialLaw)law)->separable && MaterialGetLaw((MaterialLaw)law)->isochoric);
    MaterialPoint(&material, 1, expansion, &W, P, NULL);
    for (int i = 0; i < 3; i++) assert_near(P[4 * i] * k, material.constants[0] * log(J), 1e-13 * E / (1 - 2 * nu));
    assert_near(W, material.constants[0] * log(J) * log(J) / 2, 1e-13 * E / (1 - 2 * nu));
    material.constants[0] = 0;
    for (int r = 0; r < 9; r++) larger[r] = k * (H[r] + (r % 4 == 0)) - (r % 4 == 0);
    MaterialPoint(&material, 1, H, &W, P, NULL);
    MaterialPoint(&material, 1, larger, &W_larger, P, NULL);
    assert_near(W, W_larger, 1e-13 * E);
  }
}

/* A material with powers of J has no digits left for other strains where nu is near 1/2. */
static Material LawOfTest(int law)
{
  return ExampleMaterial((MaterialLaw)law, E, law == MATERIAL_HYPERFOAM ? 0.3 : nu);
}

/* Deformations with distinct stretches, two equal ones, three equal ones, and ones that nearly are */
static void Deformation(int i, double H[9])
{
  static const double general[9] = {0.3, -0.2, 0.05, 0.15, -0.12, 0.3, -0.07, 0.11, 0.2};
  const double        c = cos(0.7), s = sin(0.7), twist = i < 4 ? 0 : pow(10, -i);
  const double        stretch[3] = {i == 2 ? 1.2 : 1.7, 1.2 + twist, 1.2 - 2 * twist};
  const double        Q[9]       = {c, -s, 0, 0.6 * s, 0.6 * c, -0.8, 0.8 * s, 0.8 * c, 0.6};

  for (int r = 0; r < 9; r++) H[r] = i == 0 ? general[r] : i == 3 ? 1e-9 * general[r] : -(double)(r % 4 == 0);
  for (int r = 0; r < 9 && i && i != 3; r++) {
    for (int a = 0; a < 3; a++) H[r] += Q[3 * (r / 3) + a] * stretch[a] * Q[3 * (r % 3) + a];
  }
}

/* With the exponents 2 and -2, mu_1 = 2 c10 and mu_2 = -2 c01, Ogden's law is Mooney's and Rivlin's. */
static void OgdenWithSquaresIsMooneyRivlin(void **state)
{
  const double mooney[2] = {0.4, 0.1}, ogden[4] = {0.8, 2, -0.2, -2};
  Material     one = MaterialFromConstants(MATERIAL_MOONEY_RIVLIN, 2, mooney),
           other   = MaterialFromConstants(MATERIAL_OGDEN, 4, ogden);

  (void)state;
  MaterialSetBulk(&one, 50);
  MaterialSetBulk(&other, 50);
  for (int i = 0; i < 14; i++) {
    double H[9], P[2][9], A[2][MATERIAL_TANGENT_SIZE], W[2];

    Deformation(i, H);
    MaterialPoint(&one, 1, H, &W[0], P[0], A[0]);
    MaterialPoint(&other, 1, H, &W[1], P[1], A[1]);
    assert_near(W[0], W[1], 1e-13);
    for (int r = 0; r < 9; r++) assert_near(P[0][r], P[1][r], 1e-13 * fmax(1, fabs(P[0][r])));
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) assert_near(A[0][k], A[1][k], 1e-12 * 50);
  }
}

/* A follows P, at equal stretches and at large ones. Central differences of order 4. */
static void TangentsAreDerivatives(void **state)
{
  static const double weight[2] = {2. / 3, -1. / 12}, h = 1e-3;

  (void)state;
  for (int law = MATERIAL_NEO_HOOKEAN; law < MATERIAL_LAWS; law++) {
    const Material material = LawOfTest(law);

    for (int i = 0; i < 14; i++) {
      double H[9], P[9], A[MATERIAL_TANGENT_SIZE], scale = 0;

      Deformation(i, H);
      MaterialPoint(&material, 1, H, NULL, P, A);
      for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) scale = fmax(scale, fabs(A[k]));
      for (int s = 0; s < 9; s++) {
        double dP[9] = {0}, dW = 0;

        for (int m = -2; m <= 2; m++) {
          double moved[9], P_moved[9], W;

          if (!m) continue;
          memcpy(moved, H, sizeof moved);
          moved[s] += m * h;
          MaterialPoint(&material, 1, moved, &W, P_moved, NULL);
          dW += (m > 0 ? 1 : -1) * weight[abs(m) - 1] / h * W;
          for (int r = 0; r < 9; r++) dP[r] += (m > 0 ? 1 : -1) * weight[abs(m) - 1] / h * P_moved[r];
        }
        assert_near(P[s], dW, 1e-9 * scale);
        for (int r = 0; r <= s; r++) assert_near(A[MATERIAL_TANGENT_INDEX(r, s)], dP[r], 1e-9 * scale);
      }
    }
  }
}

/* P(Q F) = Q P(F) */
static void LawsAreObjective(void **state)
{
  const double c = cos(1.1), s = sin(1.1), Q[9] = {c, -s, 0, 0.6 * s, 0.6 * c, -0.8, 0.8 * s, 0.8 * c, 0.6};

  (void)state;
  for (int law = MATERIAL_SVK; law < MATERIAL_LAWS; law++) {
    const Material material = LawOfTest(law);

    for (int i = 0; i < 14; i++) {
      double H[9], turned[9], P[9], P_turned[9], W, W_turned;

      Deformation(i, H);
      for (int r = 0; r < 9; r++) {
        turned[r] = -(double)(r % 4 == 0);
        for (int k = 0; k < 3; k++) turned[r] += Q[3 * (r / 3) + k] * (H[3 * k + r % 3] + (k == r % 3));
      }
      MaterialPoint(&material, 1, H, &W, P, NULL);
      MaterialPoint(&material, 1, turned, &W_turned, P_turned, NULL);
      assert_near(W, W_turned, 1e-12 * E);
      for (int r = 0; r < 9; r++) {
        double expected = 0;

        for (int k = 0; k < 3; k++) expected += Q[3 * (r / 3) + k] * P[3 * k + r % 3];
        assert_near(P_turned[r], expected, 1e-12 * E / (1 - 2 * nu));
      }
    }
  }
}

/* Small shear strains keep their digits, and so does the stress of a small change of shape. */
static void SmallShearKeepsItsDigits(void **state)
{
  const double strain = 1e-10, H[9] = {strain, 2 * strain, 0, 0, -strain, 0, 0, 0, 0};

  (void)state;
  for (int law = 0; law < MATERIAL_LAWS; law++) {
    const Material material = ExampleMaterial((MaterialLaw)law, E, nu);
    double         P[9];

    MaterialPoint(&material, 1, H, NULL, P, NULL);
    assert_near(P[0] / (E / (1 + nu) * strain), 1, 1e-7);
    assert_near(P[1] / (E / (1 + nu) * strain), 1, 1e-7);
  }
}

/* Mooney-Rivlin with c01 < 0 and c10 = 1: Drucker's condition in planar tension is 4 (l^2 + l^-2) (c10 + c01) > 0 for
   strains in the plane; for those across it, at l1 = l and l2 = 1, it is solved here by the closed form of T. */
static void StabilityEndsWhereTheClosedFormSays(void **state)
{
  const double own[2]   = {1, -0.2};
  Material     material = MaterialFromConstants(MATERIAL_MOONEY_RIVLIN, 2, own);

  (void)state;
  MaterialSetBulk(&material, 1000);
  for (int test = 0; test < MATERIAL_TESTS; test++) {
    for (int tension = 0; tension < 2; tension++) {
      double       low = 0, high = tension ? log(10) : -log(10);
      const double end = MaterialStableEnd(&material, (MaterialTest)test, tension);

      while (fabs(high - low) >
             1e-9) { /* T_ab = 4 c10 l_a^2 d_ab + 4 c01 l_a^-2 d_ab on strains with no change of volume */
        const double middle = (low + high) / 2;
        double       l[3], T[3];

        Stretches((MaterialTest)test, exp(middle), l);
        for (int a = 0; a < 3; a++) T[a] = 4 * (own[0] * l[a] * l[a] + own[1] / (l[a] * l[a]));
        /* positive on strains of sum 0, and positive shear 2 (c10 + c01 l_c^2) */
        if (T[0] + T[1] > 0 && (T[0] + T[1]) * (T[0] + T[1] + 4 * T[2]) > (T[0] - T[1]) * (T[0] - T[1]) &&
            own[0] + own[1] * fmax(l[0] * l[0], fmax(l[1] * l[1], l[2] * l[2])) > 0)
          low = middle;
        else
          high = middle;
      }
      assert_near(end / exp(low), 1, 1e-5);
      assert_true(end < 9.9 && end > 0.11);
    }
  }
}

/* A foam of two terms under stretches of its own and under pressure, with nu from 0 to 0.45: nominal stresses
   sum 2 mu / alpha (l_a^alpha - J^(-alpha beta)) / l_a. Uniaxial tension leaves l_a = l^(-nu), since one beta for all
   terms makes J^(-beta) = l_a there. Energy is the work of the stress. */
static void FoamHasItsClosedForm(void **state)
{
  static const double own[4] = {0.7, 2.4, 0.3, -1.6}, ratios[] = {0, 1e-9, 0.2, 0.45};

  (void)state;
  for (int k = 0; k < 4; k++) {
    const double nu_k = ratios[k], beta = nu_k / (1 - 2 * nu_k);
    Material     foam = MaterialFromConstants(MATERIAL_HYPERFOAM, 4, own);

    MaterialSetBulk(&foam, MaterialBulk(1, nu_k));
    assert_near(foam.E, 2 * (1 + nu_k), 1e-14);
    for (int i = 0; i < STRETCHES; i++) {
      for (int test = 0; test < 2; test++) {
        const double side = test ? stretches[i] : pow(stretches[i], -nu_k), J = stretches[i] * side * side;
        const double H[9] = {stretches[i] - 1, 0, 0, 0, side - 1, 0, 0, 0, side - 1};
        double       P[9], W, expected = 0, energy = 0;

        MaterialPoint(&foam, 1, H, &W, P, NULL);
        for (int t = 0; t < 4; t += 2) {
          const double mu = own[t], alpha = own[t + 1], part = pow(J, -alpha * beta);

          expected += 2 * mu / alpha * (pow(stretches[i], alpha) - part) / stretches[i];
          energy += 2 * mu / (alpha * alpha) *
                    (pow(stretches[i], alpha) + 2 * pow(side, alpha) - 3 +
                     (beta > 1e-6 ? (part - 1) / beta : -alpha * log(J)));
        }
        assert_near(P[0], expected, 1e-12 * fmax(1, fabs(expected)));
        assert_near(P[4], test ? expected : 0, 1e-12 * fmax(1, fabs(expected)));
        assert_near(W, energy, 1e-7 * fmax(1, fabs(energy)));
      }
    }
  }
}

static void StableLawsAreStableEverywhere(void **state)
{
  const double treloar[6] = {6.3e5, 1.3, 1.2e3, 5, -1e4, -2}; /* Ogden 1972, in Pa */
  Material     ogden      = MaterialFromConstants(MATERIAL_OGDEN, 6, treloar);

  (void)state;
  MaterialSetBulk(&ogden, 1e9);
  for (int test = 0; test < MATERIAL_TESTS; test++) {
    const Material hooke = MaterialFromModuli(MATERIAL_NEO_HOOKEAN, E, nu),
                   split = MaterialFromModuli(MATERIAL_ISOCHORIC_NEO_HOOKEAN, E, nu),
                   chain = ExampleMaterial(MATERIAL_ARRUDA_BOYCE, E, nu);

    for (int tension = 0; tension < 2; tension++) {
      const double end = tension ? STABILITY_MOST_STRETCH : STABILITY_LEAST_STRETCH;

      assert_true(MaterialStableEnd(&hooke, (MaterialTest)test, tension) == end);
      assert_true(MaterialStableEnd(&split, (MaterialTest)test, tension) == end);
      assert_true(MaterialStableEnd(&chain, (MaterialTest)test, tension) == end);
      assert_true(MaterialStableEnd(&ogden, (MaterialTest)test, tension) == end);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(HomogeneousStressesAreExact),
    cmocka_unit_test(VolumeAndShapeAreSeparate),
    cmocka_unit_test(OgdenWithSquaresIsMooneyRivlin),
    cmocka_unit_test(TangentsAreDerivatives),
    cmocka_unit_test(LawsAreObjective),
    cmocka_unit_test(SmallShearKeepsItsDigits),
    cmocka_unit_test(StabilityEndsWhereTheClosedFormSays),
    cmocka_unit_test(FoamHasItsClosedForm),
    cmocka_unit_test(StableLawsAreStableEverywhere),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
