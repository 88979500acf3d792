/* Shows that nested purposes never count a second twice and that the outer one goes on after the inner. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <mpi.h>
#include "base/timing.h"

static const double NAP = 0.01; /* s, far above the clock's resolution */

static void Wait(void)
{
  for (const double start = MPI_Wtime(); MPI_Wtime() - start < NAP;) {}
}

/* Seconds of all purposes when Take() was called last */
static double before[TIMING_KINDS];

static void Take(void)
{
  for (int k = 0; k < TIMING_KINDS; k++) before[k] = TimingSeconds((TimingKind)k);
}

static double Gained(TimingKind kind)
{
  return TimingSeconds(kind) - before[kind];
}

static double GainedInAll(void)
{
  double sum = 0;

  for (int k = 0; k < TIMING_KINDS; k++) sum += Gained((TimingKind)k);
  return sum;
}

static void test_one_after_the_other(void **state)
{
  (void)state;
  Take();
  TimingBegin(TIMING_SOLVE);
  Wait();
  TimingEnd(TIMING_SOLVE);
  Wait();
  TimingBegin(TIMING_SEARCH);
  TimingEnd(TIMING_SEARCH);
  assert_true(Gained(TIMING_SOLVE) >= NAP && Gained(TIMING_SEARCH) < Gained(TIMING_SOLVE));
}

static void test_inner_stops_outer(void **state)
{
  const double start = MPI_Wtime();
  double       wall;

  (void)state;
  Take();
  TimingBegin(TIMING_SETUP);
  Wait();
  TimingBegin(TIMING_SEARCH);
  for (int i = 0; i < 3; i++) Wait();
  TimingBegin(TIMING_FIT);
  Wait();
  TimingEnd(TIMING_FIT);
  TimingEnd(TIMING_SEARCH);
  Wait();
  TimingEnd(TIMING_SETUP);
  wall = MPI_Wtime() - start;
  assert_true(Gained(TIMING_SETUP) >= 2 * NAP && Gained(TIMING_SEARCH) >= 3 * NAP && Gained(TIMING_FIT) >= NAP);
  assert_true(GainedInAll() <= wall); /* not one second twice */
  assert_true(Gained(TIMING_SETUP) <= wall - 4 * NAP);
}

/* The same purpose within itself */
static void test_within_itself(void **state)
{
  const double start = MPI_Wtime();

  (void)state;
  Take();
  TimingBegin(TIMING_OUTPUT);
  TimingBegin(TIMING_OUTPUT);
  Wait();
  TimingEnd(TIMING_OUTPUT);
  Wait();
  TimingEnd(TIMING_OUTPUT);
  assert_true(Gained(TIMING_OUTPUT) >= 2 * NAP && Gained(TIMING_OUTPUT) <= MPI_Wtime() - start);
}

/* An end that was forgotten, or one too many, harms nothing that comes later */
static void test_unpaired(void **state)
{
  (void)state;
  Take();
  TimingBegin(TIMING_SETUP);
  TimingBegin(TIMING_SOLVE);
  TimingEnd(TIMING_SETUP);
  TimingEnd(TIMING_SETUP);
  Wait();
  assert_true(GainedInAll() < NAP);
  TimingBegin(TIMING_FIT);
  Wait();
  TimingEnd(TIMING_FIT);
  assert_true(Gained(TIMING_FIT) >= NAP && Gained(TIMING_SOLVE) < NAP);
}

static void test_deep(void **state)
{
  enum { DEEP = 1000 };

  (void)state;
  Take();
  for (int i = 0; i < DEEP; i++) TimingBegin((TimingKind)(i % TIMING_KINDS));
  for (int i = DEEP; i-- > 0;) TimingEnd((TimingKind)(i % TIMING_KINDS));
  TimingBegin(TIMING_FIT);
  Wait();
  TimingEnd(TIMING_FIT);
  assert_true(Gained(TIMING_FIT) >= NAP);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_one_after_the_other),
    cmocka_unit_test(test_inner_stops_outer),
    cmocka_unit_test(test_within_itself),
    cmocka_unit_test(test_unpaired),
    cmocka_unit_test(test_deep),
  };
  int failed;

  MPI_Init(&argc, &argv);
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  MPI_Finalize();
  return failed;
}
