/* A history is linear between its breakpoints, exact at them, constant beyond them, and its slope is the one of the interval to come. */
#include "history.h"
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static double  Times[] = {0, 0.2, 0.7, 1}, Factors[] = {0, 1, 1, -0.5};
static History Press = {4, Times, Factors};

static void ValueIsExactAtBreakpoints(void **state)
{
  (void)state;
  for (int i = 0; i < Press.n; i++) assert_true(HistoryValue(&Press, Times[i]) == Factors[i]);
}

static void ValueIsLinearBetweenAndConstantBeyond(void **state)
{
  (void)state;
  assert_float_equal(HistoryValue(&Press, 0.05), 0.25, 1e-15);
  assert_float_equal(HistoryValue(&Press, 0.5), 1, 1e-15);
  assert_float_equal(HistoryValue(&Press, 0.85), 0.25, 1e-15);
  assert_true(HistoryValue(&Press, -1) == 0);
  assert_true(HistoryValue(&Press, 2) == -0.5);
}

static void SlopeIsRightSided(void **state)
{
  (void)state;
  assert_float_equal(HistorySlope(&Press, 0), 5, 1e-14);
  assert_float_equal(HistorySlope(&Press, 0.1), 5, 1e-14);
  assert_true(HistorySlope(&Press, 0.2) == 0);
  assert_float_equal(HistorySlope(&Press, 0.7), -5, 1e-14);
  assert_true(HistorySlope(&Press, 1) == 0);
  assert_true(HistorySlope(&Press, -0.1) == 0);
}

static void SlopeIsTheDerivativeOfTheValue(void **state)
{
  const double h = 1e-6;

  (void)state;
  for (double t = 0.03; t < 1; t += 0.1)
    assert_float_equal((HistoryValue(&Press, t + h) - HistoryValue(&Press, t - h)) / (2 * h), HistorySlope(&Press, t), 1e-8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ValueIsExactAtBreakpoints),
    cmocka_unit_test(ValueIsLinearBetweenAndConstantBeyond),
    cmocka_unit_test(SlopeIsRightSided),
    cmocka_unit_test(SlopeIsTheDerivativeOfTheValue),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
