/* Kernels for lesser processors are recognised by OpenBLAS's names for them, in either spelling; what serves better is
   a name that it knows and that the processor can run. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "base/blas.h"

static void test_old_kernels(void **state)
{
  static const char *const old[] = {"Prescott",     "PRESCOTT",  "Core2",  "Penryn", "Nehalem",
                                    "Opteron_SSE3", "Barcelona", "Bobcat", "generic"};

  (void)state;
  for (size_t i = 0; i < sizeof(old) / sizeof(old[0]); i++) {
    assert_string_equal(BlasFasterKernels(old[i], PROCESSOR_AVX512), "SkylakeX");
    assert_string_equal(BlasFasterKernels(old[i], PROCESSOR_AVX2), "Haswell");
    assert_null(BlasFasterKernels(old[i], PROCESSOR_OTHER));
  }
}

static void test_good_kernels(void **state)
{
  static const char *const good[] = {"Haswell",    "HASWELL",        "Zen",        "Excavator",  "SkylakeX",
                                     "Cooperlake", "SapphireRapids", "neoversen1", "a later one"};

  (void)state;
  for (size_t i = 0; i < sizeof(good) / sizeof(good[0]); i++)
    for (ProcessorVectors vectors = PROCESSOR_OTHER; vectors <= PROCESSOR_AVX512; vectors++)
      assert_null(BlasFasterKernels(good[i], vectors));
  assert_null(BlasFasterKernels(NULL, PROCESSOR_AVX512)); /* another BLAS */
}

/* Whichever BLAS and processor these are */
static void test_here(void **state)
{
  Blas   blas;
  char  *text;
  size_t size;
  FILE  *stream = open_memstream(&text, &size);

  (void)state;
  BlasFind(&blas);
  assert_true(*blas.file);
  assert_true(blas.kernels || !blas.faster_kernels);
  if (ProcessorGetVectors() == PROCESSOR_OTHER) assert_null(blas.faster_kernels);
  BlasPrint(&blas, stream);
  fclose(stream);
  assert_int_equal(strncmp(text, blas.file, strlen(blas.file)), 0);
  assert_ptr_equal(strchr(text, '\n'), text + size - 1);
  free(text);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_old_kernels), cmocka_unit_test(test_good_kernels),
                                     cmocka_unit_test(test_here)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
