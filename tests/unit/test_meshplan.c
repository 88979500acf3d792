/* The next mesh is finer by the power of the error, measured once there are two meshes, and within bounds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "meshplan.h"

static const MeshFigures first  = {.factor = 1, .unknowns = 1000, .error = 8, .cpu_s = 1, .rss_mb = 100};
static const MeshFigures second = {.factor = 2, .unknowns = 4000, .error = 2, .cpu_s = 6, .rss_mb = 130};

static void test_first_mesh(void **state)
{
  (void)state;
  assert_float_equal(MeshPlanFactor(1, &first, 1, 2), 2, 1e-12);     /* order 1: the power 2 */
  assert_float_equal(MeshPlanFactor(1, &first, 2, 1), 2, 1e-12);     /* order 2: 3 */
  assert_float_equal(MeshPlanFactor(1, &first, 1, 1e-9), 3, 1e-12);  /* no further than this */
  assert_float_equal(MeshPlanFactor(1, &first, 1, 7.9), 1.2, 1e-12); /* at least so much */
}

static void test_measured(void **state)
{
  const MeshFigures meshes[] = {first, second};
  const MeshFigures next     = MeshPlanForecast(2, meshes, 2, 2, 4);

  (void)state;
  assert_float_equal(MeshPlanFactor(2, meshes, 2, 0.5), 4, 1e-12); /* the power is 2, though the order is 2 */
  assert_float_equal(next.unknowns, 16000, 1e-6);
  assert_float_equal(next.error, 0.5, 1e-12);
  assert_float_equal(next.cpu_s, 36, 1e-9);
  assert_float_equal(next.rss_mb, 250, 1e-9);
}

/* Errors that do not fall are those of meshes too coarse to tell. */
static void test_no_fall(void **state)
{
  MeshFigures meshes[] = {first, second};

  (void)state;
  meshes[1].error = 9;
  assert_float_equal(MeshPlanFactor(2, meshes, 1, 4), 6, 1e-12);
  assert_true(MeshPlanForecast(2, meshes, 2, 1, 4).error < 9);
}

/* Implied error of a change that no estimate has forecast. */
static double implied(double change, double fall, double finer, int even)
{
  const MeshChange c = {.change = change, .fall = fall, .finer = finer, .even = even};

  return MeshPlanImplied(&c, 2);
}

/* With an answer 1 + C f^q the change of two meshes gives the error of the last one, times the factor of safety. */
static void test_change_implies_error(void **state)
{
  const double coarse = 1 + 0.4, fine = 1 + 0.4 / 4;

  (void)state;
  assert_float_equal(implied(fine - coarse, 0.25, 2, 1), 1.25 * 0.1, 1e-12);
  assert_float_equal(implied(coarse - fine, 0.25, 2, 1), 1.25 * 0.1, 1e-12);
  assert_float_equal(implied(coarse - fine, 0.0625, 2, 0), 1.25 * 0.1,
                     1e-12);                                    /* sizes by the cells: half of the power */
  assert_float_equal(implied(0.3, 2, 1, 0), 1.25 * 0.9, 1e-12); /* no fall: that of the least power */
  assert_float_equal(implied(0.3, NAN, 1, 0), 1.25 * 0.9, 1e-12);
  assert_float_equal(implied(0.7, 0.01, 2, 1), 1.25 * 0.1, 1e-12); /* even meshes: no faster than order + 1 */
  assert_float_equal(implied(0, 0.5, 1, 0), 0, 1e-12);
}

/* Of a change that the estimates forecast the last estimate is left. */
static void test_forecast_change(void **state)
{
  MeshChange c = {.change = -9, .before = -10, .estimate = -1, .fall = 0.1, .finer = 3, .even = 1};

  (void)state;
  assert_float_equal(MeshPlanImplied(&c, 1), 1.25, 1e-12);
  c.change = -27;
  assert_float_equal(MeshPlanImplied(&c, 1), 1.25 + 1.25 * 18.0 / 8, 1e-12);
  c.estimate = NAN; /* no estimate: the power 1 */
  assert_float_equal(MeshPlanImplied(&c, 1), 1.25 * 27 / 2, 1e-12);
}

/* Where surfaces are in contact, what no estimate sees falls with the square of the size of the elements there, and at
   least as what it sees. After one change the factor of safety is 3. */
static void test_zone(void **state)
{
  MeshChange c = {.change = -11, .before = -10, .estimate = -1, .fall = 0.1, .zone = 2, .most = 10, .allowed = 1};

  (void)state;
  assert_float_equal(MeshPlanUnseen(&c, 2), 2.0 / 3, 1e-12);
  assert_float_equal(MeshPlanImplied(&c, 2), 1.25 + 3 * 2.0 / 3, 1e-12);
  c.known = 1;
  assert_float_equal(MeshPlanImplied(&c, 2), 1.25 * (1 + 2.0 / 3), 1e-12);
  c.fall = 0.5;
  assert_float_equal(MeshPlanUnseen(&c, 2), 2, 1e-12);
  c.zone = 0; /* no zone has an end */
  assert_float_equal(MeshPlanUnseen(&c, 2), 2 * sqrt(0.5) / (1 - sqrt(0.5)), 1e-12);
}

/* A change that is beyond all that the mesh before could tell implies nothing, unless it is less than what is asked
   for. */
static void test_mesh_that_cannot_tell(void **state)
{
  MeshChange c = {.change = -40, .before = -10, .estimate = -1, .fall = 0.1, .zone = 2, .most = 10, .allowed = 1};

  (void)state;
  assert_true(isnan(MeshPlanUnseen(&c, 2)));
  assert_true(isnan(MeshPlanImplied(&c, 2)));
  c.allowed = 50;
  assert_float_equal(MeshPlanUnseen(&c, 2), 31.0 / 3, 1e-12);
  c.allowed = 1;
  c.even    = 1; /* all elements became smaller: they are compared whatever they say */
  assert_float_equal(MeshPlanUnseen(&c, 2), 31.0 / 9, 1e-12);
}

/* A change is forecast where estimates miss at most half of what they forecast. */
static void test_foretold(void **state)
{
  MeshChange c = {.change = -13, .before = -10, .estimate = -1};

  (void)state;
  assert_true(MeshPlanForetold(&c));
  c.change = -14;
  assert_false(MeshPlanForetold(&c));
  c.change   = -9;
  c.estimate = NAN; /* there is no estimate */
  assert_false(MeshPlanForetold(&c));
}

/* The zone gets a quarter of what is wanted, or what the bodies leave of it. */
static void test_split(void **state)
{
  MeshWish wish = MeshPlanSplit(1.25, 3, 4);

  (void)state;
  assert_float_equal(wish.bodies, 0.25, 1e-12);
  assert_float_equal(wish.zone, 0.25, 1e-12);
  wish = MeshPlanSplit(1.25, 0.25, 3); /* what is left is to tell something */
  assert_float_equal(wish.bodies, 0.5, 1e-12);
  assert_float_equal(wish.zone, 0.5, 1e-12);
  wish = MeshPlanSplit(1.25, 0.25, NAN);
  assert_float_equal(wish.bodies, 1, 1e-12);
  assert_float_equal(wish.zone, 0.5, 1e-12);
}

/* What a zone's end leaves falls with the square of the size of its faces. */
static void test_resolve(void **state)
{
  (void)state;
  assert_float_equal(MeshPlanResolve(0.375, 0.015), 0.2, 1e-12);
  assert_float_equal(MeshPlanResolve(0.09375, 0.015), 0.4, 1e-12);
  assert_float_equal(MeshPlanResolve(0.0046, 0.015), 1, 1e-12);
}

/* The largest mesh is that whose forecast is the limit, and there is none where a small step is too much. */
static void test_limits(void **state)
{
  const MeshFigures meshes[] = {first, second};

  (void)state;
  assert_float_equal(MeshPlanLargest(2, meshes, 2, 2, (MeshFigures){.cpu_s = 36}), 4, 1e-4);
  assert_float_equal(MeshPlanLargest(2, meshes, 2, 2, (MeshFigures){.rss_mb = 250, .cpu_s = 99}), 4, 1e-4);
  assert_float_equal(MeshPlanLargest(2, meshes, 2, 2, (MeshFigures){.cpu_s = 6}), 0, 1e-12);
  assert_float_equal(MeshPlanLargest(2, meshes, 2, 2, (MeshFigures){.cpu_s = 0}), 6, 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_first_mesh),
                                     cmocka_unit_test(test_measured),
                                     cmocka_unit_test(test_no_fall),
                                     cmocka_unit_test(test_change_implies_error),
                                     cmocka_unit_test(test_forecast_change),
                                     cmocka_unit_test(test_zone),
                                     cmocka_unit_test(test_foretold),
                                     cmocka_unit_test(test_mesh_that_cannot_tell),
                                     cmocka_unit_test(test_split),
                                     cmocka_unit_test(test_resolve),
                                     cmocka_unit_test(test_limits)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
