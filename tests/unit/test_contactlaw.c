/* The penalty law, with and without a multiplier, is the derivative of its potential, never pulls and is zero when
 * open. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "contactlaw.h"

static void check_derivatives(const LawState *given)
{
  const Law   *law = LawFind("penalty");
  const double h = 1e-6, gaps[] = {-0.5, -0.02, 0.01, 0.3};

  assert_non_null(law);
  for (int i = 0; i < 4; i++) {
    LawValue at, before, after;

    law->evaluate(gaps[i], given, &at);
    law->evaluate(gaps[i] - h, given, &before);
    law->evaluate(gaps[i] + h, given, &after);
    assert_true(fabs((after.psi - before.psi) / (2 * h) + at.pressure) <= 1e-7 * given->penalty);
    assert_true(fabs((after.pressure - before.pressure) / (2 * h) + at.stiffness) <= 1e-7 * given->penalty);
  }
}

static void test_derivatives(void **state)
{
  (void)state;
  check_derivatives(&(LawState){.penalty = 3e4, .offset = -0.01});
  check_derivatives(&(LawState){.penalty = 3e4, .offset = -0.01, .multiplier = 900});
}

/* The pressure is the multiplier at rest, more behind the master, less before it down to nothing, and never pulls. */
static void test_multiplier(void **state)
{
  const LawState given  = {.penalty = 3e4, .offset = -0.01, .multiplier = 900};
  const double   gaps[] = {-0.02, -0.01, 0.01, 0.0199, 0.0201, 1}, pressures[] = {1200, 900, 300, 3, 0, 0};

  (void)state;
  assert_true(fabs(LawOnsetGap(&given) - 0.02) <= 1e-15);
  for (int i = 0; i < 6; i++) {
    LawValue value;

    LawFind("penalty")->evaluate(gaps[i], &given, &value);
    assert_true(fabs(value.pressure - pressures[i]) <= 1e-9);
    assert_true(value.pressure >= 0 && value.psi >= 0 && (value.stiffness > 0) == (pressures[i] > 0));
  }
}

static void test_open_is_nothing(void **state)
{
  const LawState given = {.penalty = 3e4};
  LawValue       value;

  (void)state;
  LawFind("penalty")->evaluate(1e-12, &given, &value);
  assert_true(value.psi == 0 && value.pressure == 0 && value.stiffness == 0);
  assert_null(LawFind("no such law"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives), cmocka_unit_test(test_multiplier),
                                     cmocka_unit_test(test_open_is_nothing)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
