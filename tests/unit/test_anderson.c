/* Anderson ends a linear iteration with three slow modes in four results, weights or not, and leaves one result alone
 * after a start. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "anderson.h"

enum { N = 6 };

/* Slow in three modes, at once there in the others; the fixed point is 1, 2, ... */
static void iterate(const PetscReal *x, PetscReal *g)
{
  const PetscReal factor[N] = {0.99, 0.9, 0.5, 0, 0, 0};

  for (int i = 0; i < N; i++) g[i] = i + 1 + factor[i] * (x[i] - (i + 1));
}

static void check_linear(const PetscReal weight[N])
{
  PetscReal x[N] = {0}, g[N];
  Anderson  mixing;

  assert_int_equal(AndersonCreate(PETSC_COMM_SELF, N, weight, &mixing), 0);
  for (int run = 0; run < 2; run++) {
    AndersonStart(mixing);
    for (int i = 0; i < N; i++) x[i] = 0;
    for (int k = 0; k < 5; k++) {
      iterate(x, g);
      assert_int_equal(AndersonNext(mixing, x, g), 0);
      for (int i = 0; i < N; i++) x[i] = g[i];
      if (k == 0) assert_true(PetscAbsReal(x[0] - 0.01) <= 1e-15);
    }
    for (int i = 0; i < N; i++) assert_true(PetscAbsReal(x[i] - (i + 1)) <= 1e-4);
  }
  assert_int_equal(AndersonNext(mixing, x, x), 0); /* at the fixed point it stays */
  for (int i = 0; i < N; i++) assert_true(PetscAbsReal(x[i] - (i + 1)) <= 1e-4);
  assert_int_equal(AndersonDestroy(&mixing), 0);
}

static void test_linear(void **state)
{
  (void)state;
  check_linear((const PetscReal[N]){1, 1, 1, 1, 1, 1});
  check_linear((const PetscReal[N]){1, 2, 1, 3, 1, 1});
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_linear)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
