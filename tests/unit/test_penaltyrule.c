/* The penalty follows the penetration as eq. 16 says, and its guards hold: nothing at rest or apart, light nodes,
 * clamp, range, narrow windows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "penaltyrule.h"

#define assert_near(a, b) assert_true(fabs((a) - (b)) <= 1e-12 * fabs(b))

static const double Automatic = 8e5, GMin = 1e-6, GMax = 5e-6;

static PenaltyUpdate Adjust(int inside, double penetration, double share, double penalty)
{
  const PenaltyRule rule = PenaltyMakeRule(GMin, GMax, inside, 100, Automatic, 1e4);
  PenaltyUpdate     update;

  PenaltyAdjust(&rule, penetration, share, penalty, &update);
  return update;
}

static void test_automatic(void **state)
{
  (void)state;
  assert_true(PenaltyAutomatic(200, 50) == 50);
  assert_true(PenaltyAutomatic(50, 200) == 50);
  assert_true(PenaltyAutomatic(50, 0) == 50); /* rigid master */
}

static void test_factor(void **state)
{
  PenaltyUpdate update;

  (void)state;
  update = Adjust(0, 4e-5, 1, Automatic); /* eight times g_max */
  assert_near(update.penalty, 8 * Automatic);
  assert_true(update.change == PENALTY_RAISED && update.outside == 1 && !update.clamped);
  update = Adjust(0, 2e-7, 1, Automatic); /* a fifth of g_min */
  assert_near(update.penalty, 0.2 * Automatic);
  assert_true(update.change == PENALTY_LOWERED && update.outside == -1 && !update.clamped);
  for (int i = 0; i < 3; i++) {
    const double inside[] = {GMin, 2e-6, GMax};

    update = Adjust(0, inside[i], 1, Automatic);
    assert_true(update.penalty == Automatic && update.change == PENALTY_KEPT && !update.outside && !update.clamped);
  }
}

/* The force stays and the penalty changes: the penetration is on the edge of the window after one update, or where the
 * update aims. */
static void test_constant_force_lands_on_the_edge(void **state)
{
  const double start[] = {3e-4, 4e-8}, edge[2][2] = {{5e-6, 1e-6}, {PENALTY_AIM_HIGH * 5e-6, PENALTY_AIM_LOW * 1e-6}};

  (void)state;
  for (int inside = 0; inside < 2; inside++) {
    for (int i = 0; i < 2; i++) {
      const double force = Automatic * start[i];

      const double found = force / Adjust(inside, start[i], 1, Automatic).penalty;

      assert_near(found, edge[inside][i]);
      for (int round = -1; round <= 1; round++)
        assert_true(Adjust(inside, found * (1 + 1e-14 * round), 1, Automatic).change == PENALTY_KEPT);
    }
  }
}

static void test_at_rest_and_apart(void **state)
{
  PenaltyUpdate update;

  (void)state;
  update = Adjust(0, 0, 0, Automatic); /* g = 0: a node at rest carries nothing */
  assert_true(update.penalty == Automatic && !update.outside);
  update = Adjust(0, -1e-3, 0, Automatic); /* apart */
  assert_true(update.penalty == Automatic && !update.outside);
  update = Adjust(0, -1e-3, 1, Automatic);
  assert_true(update.penalty == Automatic && !update.outside);
  update = Adjust(0, NAN, 0, Automatic); /* no master near */
  assert_true(update.penalty == Automatic && !update.outside);
  update = Adjust(0, 0, 1, Automatic); /* the factor 0 never makes a penalty 0 */
  assert_near(update.penalty, Automatic / 100);
  assert_true(update.clamped);
}

static void test_light_nodes(void **state)
{
  const double light = 0.99 * PENALTY_LOADED;

  (void)state;
  assert_true(Adjust(0, 1e-8, light, Automatic).change == PENALTY_KEPT);
  assert_true(Adjust(0, 1e-8, light, Automatic).light && !Adjust(0, 1e-8, light, Automatic).outside);
  assert_true(Adjust(0, 1e-8, PENALTY_LOADED, Automatic).change == PENALTY_LOWERED);
  assert_true(Adjust(0, 1e-4, light, Automatic).change == PENALTY_RAISED);
  assert_true(Adjust(0, 1e-4, 0, Automatic).outside == 1);
}

static void test_clamp(void **state)
{
  (void)state;
  assert_near(Adjust(0, 1e3 * GMax, 1, Automatic).penalty, 100 * Automatic);
  assert_true(Adjust(0, 1e3 * GMax, 1, Automatic).clamped);
  assert_near(Adjust(0, 1e-3 * GMin, 1, Automatic).penalty, 0.01 * Automatic);
  assert_true(Adjust(0, 1e-3 * GMin, 1, Automatic).clamped);
}

static void test_range(void **state)
{
  PenaltyUpdate update;

  (void)state;
  update = Adjust(0, 10 * GMax, 1, 5e3 * Automatic);
  assert_near(update.penalty, 1e4 * Automatic);
  assert_true(update.change == PENALTY_RAISED && update.clamped);
  update = Adjust(0, 10 * GMax, 1, 1e4 * Automatic); /* at the bound: outside, and nothing to be done */
  assert_true(update.change == PENALTY_KEPT && update.outside == 1 && update.clamped);
  update = Adjust(0, 10 * GMax, 1, 3e4 * Automatic); /* a start beyond the bounds */
  assert_true(update.penalty == 3e4 * Automatic && update.change == PENALTY_KEPT);
  assert_near(Adjust(0, 0.1 * GMin, 1, 3e4 * Automatic).penalty, 3e3 * Automatic);
  assert_near(Adjust(0, 0.1 * GMin, 1, 5e-4 * Automatic).penalty, 1e-4 * Automatic);
  assert_true(Adjust(0, 0.1 * GMin, 1, 1e-5 * Automatic).penalty == 1e-5 * Automatic);
  assert_near(Adjust(0, 10 * GMax, 1, 1e-5 * Automatic).penalty, 1e-4 * Automatic);
}

/* g_max only 1.2 g_min: 0.6 g_max lies below it and 1.6 g_min above */
static void test_narrow_window(void **state)
{
  const PenaltyRule rule = PenaltyMakeRule(1, 1.2, 1, 100, 1, 1e4);

  (void)state;
  assert_true(rule.low > 1 && rule.low < 1.2 && rule.high > 1 && rule.high < 1.2);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_automatic),
                                     cmocka_unit_test(test_factor),
                                     cmocka_unit_test(test_constant_force_lands_on_the_edge),
                                     cmocka_unit_test(test_at_rest_and_apart),
                                     cmocka_unit_test(test_light_nodes),
                                     cmocka_unit_test(test_clamp),
                                     cmocka_unit_test(test_range),
                                     cmocka_unit_test(test_narrow_window)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
