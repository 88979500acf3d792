/* The penalty law is the derivative of its potential and is zero when open. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "law.h"

static void test_derivatives(void **state)
{
  const Law     *law   = LawFind("penalty");
  const LawState given = {.penalty = 3e4, .offset = -0.01};
  const double   h = 1e-6, gaps[] = {-0.5, -0.02, 0.3};

  (void)state;
  assert_non_null(law);
  for (int i = 0; i < 3; i++) {
    LawValue at, before, after;

    law->evaluate(gaps[i], &given, &at);
    law->evaluate(gaps[i] - h, &given, &before);
    law->evaluate(gaps[i] + h, &given, &after);
    assert_true(fabs((after.psi - before.psi) / (2 * h) + at.pressure) <= 1e-7 * given.penalty);
    assert_true(fabs((after.pressure - before.pressure) / (2 * h) + at.stiffness) <= 1e-7 * given.penalty);
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives), cmocka_unit_test(test_open_is_nothing)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
