/* Patches give polynomials of their degree back exactly, whatever their points, and sums may be shared between ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "kernels/recovery.h"

enum { POINTS = 40 };

/* Scattered numbers between -1 and 1 */
static double Scattered(int i)
{
  const double x = 43758.5453 * sin(12.9898 * (i + 1));

  return 2 * (x - floor(x)) - 1;
}

static double Value(int n, const double *terms)
{
  double sum = 0;

  for (int t = 0; t < n; t++) sum += (1 + t) * terms[t];
  return sum;
}

/* Fits n_points points as two ranks would; returns the largest error of a coefficient. */
static double Fit(int dim, int degree, int n_points, double *variance)
{
  const int n = RecoveryTerms(dim, degree);
  double    matrix[2][RECOVERY_MATRIX] = {{0}}, sums[2][RECOVERY_TERMS] = {{0}}, terms[RECOVERY_TERMS], x[3], worst = 0;

  for (int p = 0; p < n_points; p++) {
    for (int i = 0; i < dim; i++) x[i] = Scattered(3 * p + i);
    RecoveryBasis(dim, degree, x, terms);
    RecoveryAdd(n, terms, matrix[p % 2]);
    for (int t = 0; t < n; t++) sums[p % 2][t] += terms[t] * Value(n, terms);
  }
  for (int k = 0; k < RECOVERY_MATRIX; k++) matrix[0][k] += matrix[1][k];
  for (int t = 0; t < n; t++) sums[0][t] += sums[1][t];
  assert_int_equal(RecoveryFactor(dim, degree, matrix[0], variance), degree);
  RecoverySolve(n, matrix[0], 1, sums[0]);
  for (int t = 0; t < n; t++) worst = fmax(worst, fabs(sums[0][t] - (1 + t)));
  return worst;
}

static void test_polynomials_come_back(void **state)
{
  double few, many;

  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    for (int degree = 0; degree <= RECOVERY_DEGREE; degree++) {
      assert_true(Fit(dim, degree, POINTS, &many) < 1e-11);
      assert_true(Fit(dim, degree, RecoveryTerms(dim, degree) + 2, &few) < 1e-9);
      assert_true(many < few);
    }
  }
}

/* Points on a line do not tell a plane: the degree falls to 0, where the value is the mean. */
static void test_too_few_points(void **state)
{
  double matrix[RECOVERY_MATRIX] = {0}, sum = 0, terms[RECOVERY_TERMS], variance;

  (void)state;
  for (int p = 0; p < 4; p++) {
    const double x[2] = {0.25 * p, 0.5 * p};

    RecoveryBasis(2, 1, x, terms);
    RecoveryAdd(3, terms, matrix);
    sum += p;
  }
  assert_int_equal(RecoveryFactor(2, 1, matrix, &variance), 0);
  RecoverySolve(1, matrix, 1, &sum);
  assert_true(fabs(sum - 1.5) < 1e-14);
  assert_true(fabs(variance - 0.25) < 1e-14);
}

static void test_no_point(void **state)
{
  double matrix[RECOVERY_MATRIX] = {0}, variance;

  (void)state;
  assert_int_equal(RecoveryFactor(3, 2, matrix, &variance), -1);
  assert_true(isinf(variance));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_polynomials_come_back),
    cmocka_unit_test(test_too_few_points),
    cmocka_unit_test(test_no_point),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
