/* The checksum is the one that others know by that name, and shows any single bit and any two blocks that change
 * places. */
#include "checksum.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <unistd.h>

enum { BLOCK = 1 << 20, SIZE = 3 * BLOCK + 5, START = 512 };
static const char name[] = "test_checksum.bin";
static char       bytes[SIZE];

static uint64_t FileSum(void)
{
  FILE      *file = fopen(name, "wb");
  PetscInt64 n;
  uint64_t   sum;

  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, SIZE, file), SIZE);
  fclose(file);
  assert_int_equal(ChecksumFile(PETSC_COMM_SELF, name, START, &n, &sum), 0);
  assert_int_equal(n, SIZE);
  return sum;
}

static void test_known_value(void **state)
{
  (void)state;
  assert_true(Checksum64("123456789", 9) == 0x995dc9bbdf1939faull); /* the check value of CRC-64/XZ */
  assert_true(Checksum64("", 0) == 0);
}

static void test_single_bits(void **state)
{
  const size_t places[] = {START, START + 9, BLOCK - 1, BLOCK + START, 2 * BLOCK, SIZE - 1};
  uint64_t     whole;

  (void)state;
  for (size_t i = 0; i < SIZE; i++) bytes[i] = (char)(i * i >> 7);
  whole = FileSum();
  bytes[START - 1] ^= 1; /* before the part that counts */
  assert_true(FileSum() == whole);
  for (size_t i = 0; i < sizeof(places) / sizeof(*places); i++)
    for (int bit = 0; bit < 8; bit += 7) {
      bytes[places[i]] ^= (char)(1 << bit);
      assert_true(FileSum() != whole);
      bytes[places[i]] ^= (char)(1 << bit);
    }
  assert_true(FileSum() == whole);
}

static void test_order_of_blocks(void **state)
{
  uint64_t whole;

  (void)state;
  memset(bytes, 0, SIZE);
  bytes[START]         = 1; /* a block of zeros but for its first byte, then blocks of zeros */
  whole                = FileSum();
  bytes[START]         = 0;
  bytes[START + BLOCK] = 1;
  assert_true(FileSum() != whole);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_known_value), cmocka_unit_test(test_single_bits),
                                     cmocka_unit_test(test_order_of_blocks)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  unlink(name);
  return PetscFinalize() || failed;
}
