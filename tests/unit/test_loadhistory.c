/* Shows that a history is linear between its breakpoints, exact at them and constant beyond them. */
#include "scene/loadhistory.h"
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

/* A free component has the iterate's value, at the accepted load parameter the accepted one; forces follow their
   history. */
static void FreeComponentsHaveTheirState(void **state)
{
  const double before[MOTION_COMPONENTS] = {0, -1}, now[MOTION_COMPONENTS] = {5, -2}, X[3] = {1, 1, 0};
  Motion       motion = {.n_free = 1, .free = {0, 1}, .force = {0, -10}, .history = Press};
  double       x[3];

  (void)state;
  MotionAccept(&motion, 0.2, before);
  MotionSet(&motion, 0.7, now);
  MotionPlace(&motion, 0.2, X, x);
  assert_true(x[0] == 1 && x[1] == 0);
  MotionPlace(&motion, 0.7, X, x);
  assert_true(x[0] == 1 && x[1] == -1);
  assert_float_equal(MotionForce(&motion, 0.85, 1), -2.5, 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ValueIsExactAtBreakpoints),
    cmocka_unit_test(ValueIsLinearBetweenAndConstantBeyond),
    cmocka_unit_test(FreeComponentsHaveTheirState),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
