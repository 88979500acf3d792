/* A process that runs alone gets settings for a short start; one of a launcher, and what the user has set, stay. */
#include "base/loneprocess.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>

static const char daemon[] = "OMPI_MCA_ess_singleton_isolated", network[] = "OMPI_MCA_pml";

static void test_alone(void **state)
{
  (void)state;
  clearenv();
  LoneProcessPrepare();
  assert_string_equal(getenv(daemon), "1");
  assert_string_equal(getenv(network), "ob1");
}

static void test_user(void **state)
{
  (void)state;
  clearenv();
  setenv(network, "ucx", 1);
  LoneProcessPrepare();
  assert_string_equal(getenv(daemon), "1");
  assert_string_equal(getenv(network), "ucx");
}

static void test_launched(void **state)
{
  static const char *const names[] = {"PMI_RANK", "PMIX_RANK", "OMPI_COMM_WORLD_SIZE", "SLURM_STEP_ID"};

  (void)state;
  for (size_t i = 0; i < sizeof(names) / sizeof(*names); i++) {
    clearenv();
    setenv(names[i], "0", 1);
    LoneProcessPrepare();
    assert_null(getenv(daemon));
    assert_null(getenv(network));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_alone), cmocka_unit_test(test_user),
                                     cmocka_unit_test(test_launched)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
