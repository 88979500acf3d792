/* beta_k and beta_{N_c} are those of eqs 17 to 20: by count and by area, with fewer candidates than wanted, at rest,
 * apart, and with ties. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "contact/touchstep.h"

static const double Resting = 1e-9;

static void test_beta(void **state)
{
  (void)state;
  assert_true(TouchStepBeta(0.4, 0, Resting) == 1);         /* touches at the end of the step */
  assert_true(TouchStepBeta(0.25, -0.75, Resting) == 0.25); /* went through: a quarter of the step was enough */
  assert_true(TouchStepBeta(0.75, 0.5, Resting) == 3);      /* still open: three such steps */
  assert_true(isnan(TouchStepBeta(0, 0, Resting)));         /* at rest, 0/0 */
  assert_true(isnan(TouchStepBeta(0, -0.1, Resting)));      /* touches already */
  assert_true(isnan(TouchStepBeta(1e-10, -0.1, Resting)));  /* round-off of a touch */
  assert_true(isnan(TouchStepBeta(0.1, 0.2, Resting)));     /* separates */
  assert_true(isnan(TouchStepBeta(0.1, 0.1, Resting)));     /* keeps its distance */
  assert_true(isnan(TouchStepBeta(-0.1, 0.1, Resting)));    /* leaves */
  assert_true(isnan(TouchStepBeta(NAN, -0.1, Resting)) && isnan(TouchStepBeta(0.1, NAN, Resting)));
}

static void test_by_count(void **state)
{
  const Touch     touch[] = {{0.1, 4, 1}, {0.2, 2, 1}, {0.4, 9, 1}, {0.8, 1, 1}};
  TouchStepChoice choice;

  (void)state;
  for (int wanted = 1; wanted <= 4; wanted++) {
    TouchStepChoose(4, touch, wanted, 1e-3, &choice);
    assert_true(choice.beta == touch[wanted - 1].beta && choice.nodes == wanted && choice.met == wanted &&
                choice.tied == 0);
  }
}

static void test_fewer_than_wanted(void **state)
{
  const Touch     touch[] = {{0.1, 4, 1}, {0.2, 2, 1}};
  TouchStepChoice choice;

  (void)state;
  TouchStepChoose(2, touch, 5, 1e-3, &choice);
  assert_true(choice.beta == 0.2 && choice.nodes == 2);
  TouchStepChoose(0, NULL, 5, 1e-3, &choice);
  assert_true(isnan(choice.beta) && choice.nodes == 0 && choice.met == 0 && choice.tied == 0);
}

static void test_by_area(void **state)
{
  const Touch     touch[] = {{0.1, 4, 0.25}, {0.2, 2, 0.5}, {0.4, 9, 0.25}, {0.8, 1, 3}};
  TouchStepChoice choice;

  (void)state;
  TouchStepChoose(4, touch, 0.3, 1e-3, &choice);
  assert_true(choice.beta == 0.2 && choice.met == 0.75);
  TouchStepChoose(4, touch, 0.75 * (1 + 1e-12), 1e-3, &choice); /* round-off of a sum asks for no further node */
  assert_true(choice.beta == 0.2);
  TouchStepChoose(4, touch, 1.5, 1e-3, &choice);
  assert_true(choice.beta == 0.8 && choice.met == 4);
}

static void test_ties(void **state)
{
  const Touch     touch[] = {{0.3, 1, 1}, {0.3, 2, 1}, {0.30001, 3, 1}, {0.5, 4, 1}};
  TouchStepChoice choice;

  (void)state;
  TouchStepChoose(4, touch, 1, 1e-4, &choice);
  assert_true(choice.beta == 0.3 && choice.nodes == 3 && choice.tied == 2 && choice.met == 3);
  TouchStepChoose(4, touch, 1, 0, &choice);
  assert_true(choice.nodes == 2 && choice.tied == 1);
  TouchStepChoose(4, touch, 3, 1e-4, &choice);
  assert_true(choice.nodes == 3 && choice.tied == 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_beta), cmocka_unit_test(test_by_count),
                                     cmocka_unit_test(test_fewer_than_wanted), cmocka_unit_test(test_by_area),
                                     cmocka_unit_test(test_ties)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
