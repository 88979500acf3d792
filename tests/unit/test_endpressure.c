/* A pressure that ends as a root comes back from its force and moments, and its rate from theirs; moments that none has
   are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "kernels/endpressure.h"

enum { SIDE = 20, POINTS = SIDE * SIDE };

static double term[POINTS * 3], weight[POINTS];

/* Fills a line or a square from -1 to 1; returns the number of points. */
static int Fill(int terms)
{
  const int rows = terms == 3 ? SIDE : 1;

  for (int j = 0; j < rows; j++) {
    for (int i = 0; i < SIDE; i++) {
      const int k = j * SIDE + i;

      term[k * terms]     = 1;
      term[k * terms + 1] = (2 * i + 1.) / SIDE - 1;
      if (terms == 3) term[k * terms + 2] = (2 * j + 1.) / SIDE - 1;
      weight[k] = 1 + 0.3 * term[k * terms + 1];
    }
  }
  return rows * SIDE;
}

/* Sums up the moments of a pressure and of its rate. */
static void Moments(int terms, int points, const EndPressure *of, double *moment, double *rate)
{
  for (int i = 0; i < terms; i++) moment[i] = rate[i] = 0;
  for (int k = 0; k < points; k++) {
    double square = 0, square_rate = 0, p, r;

    for (int i = 0; i < terms; i++) {
      square += of->square[i] * term[k * terms + i];
      square_rate += of->rate[i] * term[k * terms + i];
    }
    EndPressureAt(square, square_rate, of->least, &p, &r);
    for (int i = 0; i < terms; i++) {
      moment[i] += weight[k] * p * term[k * terms + i];
      rate[i] += weight[k] * r * term[k * terms + i];
    }
  }
}

static void test_comes_back(void **state)
{
  const EndPressure given[] = {{{4.1e6, -9e6, 1.07e6}, {1e3, -2e2, 3e2}, 0},
                               {{2e-4, 1e-5, 0}, {1, 1, 0}, 0},
                               {{-1e2, 3e2, 2e2}, {1, -1, 2}, 0}};

  (void)state;
  for (int terms = 2; terms <= 3; terms++) {
    const int points = Fill(terms);

    for (int g = 0; g < 3; g++) {
      double      moment[3], rate[3];
      EndPressure of = given[g], found;

      of.least = hypot(of.square[1], terms == 3 ? of.square[2] : 0) / SIDE / 2;
      Moments(terms, points, &of, moment, rate);
      assert_true(EndPressureFit(terms, points, 1. / SIDE, term, weight, moment, rate, &found));
      assert_true(fabs(found.least / of.least - 1) < 1e-4);
      for (int i = 0; i < terms; i++) {
        assert_true(fabs(found.square[i] - given[g].square[i]) < 1e-5 * fabs(given[g].square[1]));
        assert_true(fabs(found.rate[i] - given[g].rate[i]) < 1e-4 * fabs(given[g].rate[0]));
      }
    }
  }
}

static void test_none(void **state)
{
  const double outside[] = {1, 1.5}, pull[] = {-1, 0}, rate[] = {0, 0};
  const int    points = Fill(2);
  EndPressure  found;

  (void)state;
  assert_false(EndPressureFit(2, points, 1. / SIDE, term, weight, outside, rate, &found));
  assert_false(EndPressureFit(2, points, 1. / SIDE, term, weight, pull, rate, &found));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_comes_back), cmocka_unit_test(test_none)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
