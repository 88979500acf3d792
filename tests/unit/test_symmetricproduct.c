/* K^T J + J^T K is correct and symmetric to the last bit for all sizes around those of the tiles, and for factors whose
   rows are summed in several parts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "symmetricproduct.h"

enum { MAX = 80, MAX_DEPTH = 200, STRIDE = 120 };

static void TestProduct(void **state)
{
  static double K[MAX_DEPTH * STRIDE] __attribute__((aligned(64))), J[MAX_DEPTH * STRIDE] __attribute__((aligned(64))),
    M[MAX * MAX + 1], upper[MAX * MAX + 1];
  const int depths[] = {1, 8, 15, 96, 97, MAX_DEPTH};

  (void)state;
  for (int i = 0; i < MAX_DEPTH * STRIDE; i++) {
    K[i] = sin(i + 1);
    J[i] = cos(3 * i);
  }
  for (int d = 0; d < (int)(sizeof(depths) / sizeof(depths[0])); d++) {
    const int depth = depths[d];

    for (int n = 1; n <= MAX; n++) {
      assert_true(SymmetricProductStride(n) <= STRIDE);
      for (int i = 0; i <= n * n; i++) M[i] = upper[i] = 7;
      SymmetricProduct(n, depth, STRIDE, K, J, M);
      SymmetricProductUpper(n, depth, STRIDE, K, J, upper);
      for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) {
          double sum = 0;

          for (int k = 0; k < depth; k++)
            sum += K[k * STRIDE + r] * J[k * STRIDE + c] + J[k * STRIDE + r] * K[k * STRIDE + c];
          assert_true(fabs(M[r * n + c] - sum) <= 1e-14 * depth);
          assert_true(M[r * n + c] == M[c * n + r]);
          assert_true(upper[r * n + c] == (c < r ? 7 : M[r * n + c]));
        }
      }
      assert_true(M[n * n] == 7 && upper[n * n] == 7);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestProduct)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
