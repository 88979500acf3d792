/* A confined process starts no program, starts threads, and writes in its folder alone. */
#include "base/confinement.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/burnish_confinement_XXXXXX";

static void *Nothing(void *argument)
{
  return argument;
}

static int CanWrite(const char *directory)
{
  char path[256];
  int  file;

  snprintf(path, sizeof path, "%s/file", directory);
  file = open(path, O_WRONLY | O_CREAT, 0600);
  if (file >= 0) close(file);
  return file >= 0;
}

/* What a confined process can do, as bits: 1 a program, 2 a thread, 4 its folder, 8 the folder above. */
static int ConfinedPowers(void)
{
  char      inner[256];
  pthread_t thread;
  int       status, powers = 0;
  pid_t     child;

  snprintf(inner, sizeof inner, "%s/inner", folder);
  mkdir(inner, 0700);
  child = fork();
  if (!child) {
    ConfineProcess(inner);
    powers |= system("true") == 0 ? 1 : 0;
    powers |= !pthread_create(&thread, NULL, Nothing, NULL) && !pthread_join(thread, NULL) ? 2 : 0;
    powers |= CanWrite(inner) ? 4 : 0;
    powers |= CanWrite(folder) ? 8 : 0;
    _exit(powers);
  }
  waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

static void test_powers(void **state)
{
  int guarded = 1;

  (void)state;
#ifdef SYS_landlock_create_ruleset
  guarded = syscall(SYS_landlock_create_ruleset, NULL, 0, 1) > 0; /* the version of Landlock */
#else
  guarded = 0;
#endif
  assert_non_null(mkdtemp(folder));
#if defined(__x86_64__) || defined(__aarch64__)
  assert_int_equal(ConfinedPowers() & 7, 6);
#else
  assert_int_equal(ConfinedPowers() & 6, 6);
#endif
  assert_int_equal(ConfinedPowers() & 8, guarded ? 0 : 8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_powers)};
  const int               failed  = cmocka_run_group_tests(tests, NULL, NULL);
  char                    path[300];

  for (int k = 0; k < 2; k++) {
    snprintf(path, sizeof path, "%s%s/file", folder, k ? "" : "/inner");
    unlink(path);
  }
  snprintf(path, sizeof path, "%s/inner", folder);
  rmdir(path);
  rmdir(folder);
  return failed;
}
