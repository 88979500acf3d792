/* The densities of a .geo are the parameters whose Name says so, with a default that is a number above 0. */
#include "geodensities.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

static void Read(const char *text, GeoDensities *densities)
{
  GeoTokens tokens;

  *densities = (GeoDensities){0};
  assert_int_equal(GeoTokensCreate(text, strlen(text), &tokens), 0);
  assert_int_equal(GeoDensitiesAdd(densities, &tokens), 0);
  assert_int_equal(GeoTokensDestroy(&tokens), 0);
}

static void test_kinds(void **state)
{
  GeoDensities densities;

  (void)state;
  Read("DefineConstant[ r = {2, Name \"radius\"}, n = {8, Name \"elements along it\"}, m = {3, Min 1, Name \"faces\"},\n"
       "h = {0.5, Name \"element size\"}, f = {1, Name \"divides all element sizes\"} ];",
       &densities);
  assert_int_equal(densities.n, 4);
  assert_string_equal(densities.density[0].name, "n");
  assert_int_equal(densities.density[0].kind, DENSITY_COUNT);
  assert_int_equal(densities.density[1].kind, DENSITY_COUNT);
  assert_int_equal(densities.density[2].kind, DENSITY_SIZE);
  assert_true(densities.density[2].value == 0.5);
  assert_int_equal(densities.density[3].kind, DENSITY_DIVISOR);
  assert_false(densities.structured);
  assert_int_equal(GeoDensitiesReset(&densities), 0);
}

static void test_none(void **state)
{
  GeoDensities densities;

  (void)state;
  Read("DefineConstant[ n = {0, Name \"elements\"}, m = 4, k = {a, Name \"elements\"} ]; x = {3, Name \"elements\"};\n"
       "// DefineConstant[ n = {8, Name \"elements\"} ];\nTransfinite Curve{1} = n;",
       &densities);
  assert_int_equal(densities.n, 0);
  assert_true(densities.structured);
  assert_int_equal(GeoDensitiesReset(&densities), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_kinds), cmocka_unit_test(test_none)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
