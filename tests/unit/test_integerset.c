/* Sets of integers: each integer of the lists is there once, ascending, and is found, whether they are close together
   or far apart. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "base/integerset.h"

/* Makes a set of two lists with entries i * step, many of them twice, and looks for all of them. */
static void Check(PetscInt step)
{
  enum { N = 200, FIRST = 3 };

  PetscInt              one[N], other[N];
  const PetscInt        size[] = {N, N};
  const PetscInt *const list[] = {one, other};
  IntegerSet            set;

  for (PetscInt i = 0; i < N; i++) {
    one[i]   = FIRST + step * ((7 * i) % N);
    other[i] = FIRST + step * (i + N / 2);
  }
  assert_int_equal(IntegerSetCreate(2, size, list, &set), PETSC_SUCCESS);
  assert_int_equal(set.n, N + N / 2);
  for (PetscInt i = 0; i < set.n; i++) {
    assert_int_equal(set.value[i], FIRST + step * i);
    assert_int_equal(IntegerSetPlace(&set, set.value[i]), i);
  }
  assert_int_equal(IntegerSetDestroy(&set), PETSC_SUCCESS);
}

static void test_close(void **state)
{
  (void)state;
  Check(1);
  Check(5);
}

static void test_far(void **state)
{
  (void)state;
  Check(1000003);
}

static void test_empty(void **state)
{
  IntegerSet set;

  (void)state;
  assert_int_equal(IntegerSetCreate(0, NULL, NULL, &set), PETSC_SUCCESS);
  assert_int_equal(set.n, 0);
  assert_int_equal(IntegerSetDestroy(&set), PETSC_SUCCESS);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_close), cmocka_unit_test(test_far),
                                     cmocka_unit_test(test_empty)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
