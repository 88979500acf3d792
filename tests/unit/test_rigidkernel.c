/* The null space of constraints on rigid motions is found whole and told in one way: points, lines and planes held, and
 * a direction that is none of the axes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "kernels/rigidkernel.h"

enum { N = RIGID_MODES };

static const int    Order[N]  = {0, 1, 2, 3, 4, 5};
static const double Tolerance = 1e-12, RoundOff = 1e-9;

static void Hold(const double x[3], const double n[3], double gram[N * N])
{
  double row[N];

  RigidRow(x, n, row);
  RigidAddRow(N, row, 1, gram);
}

static int Free(double gram[N * N], double free[N * N])
{
  const int m = RigidFree(N, gram, Tolerance, free);

  RigidReduce(m, N, Order, free);
  return m;
}

static void ExpectRow(const double row[N], const double expected[N])
{
  for (int i = 0; i < N; i++) assert_float_equal(row[i], expected[i], RoundOff);
}

static void test_nothing(void **state)
{
  double gram[N * N] = {0}, free[N * N];

  (void)state;
  assert_int_equal(Free(gram, free), N);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) assert_float_equal(free[i * N + j], i == j, RoundOff);
}

static void test_point(void **state)
{
  const double x[3]        = {0.5, 0, 0};
  double       gram[N * N] = {0}, free[N * N];

  (void)state;
  for (int d = 0; d < 3; d++) Hold(x, (const double[3]){d == 0, d == 1, d == 2}, gram);
  assert_int_equal(Free(gram, free), 3);
  ExpectRow(&free[0], (const double[N]){1, 0, 0, 0, 0, 0});
  ExpectRow(&free[N],
            (const double[N]){0, 1, 0, 0, 0, 0.5}); /* u = omega cross (X - x): at the centre, -y cross x/2 = z/2 */
  ExpectRow(&free[2 * N], (const double[N]){0, 0, 1, 0, -0.5, 0});
}

static void test_line(void **state)
{
  double gram[N * N] = {0}, free[N * N];

  (void)state;
  for (int p = 0; p < 3; p++)
    for (int d = 0; d < 3; d++)
      Hold((const double[3]){0, 0.3, 0.2 * p}, (const double[3]){d == 0, d == 1, d == 2}, gram);
  assert_int_equal(Free(gram, free), 1);
  ExpectRow(free, (const double[N]){0, 0, 1, 0.3, 0, 0});
}

static void test_oblique_plane(void **state)
{
  const double n[3]        = {0.6, 0.8, 0};
  double       gram[N * N] = {0}, free[N * N];

  (void)state;
  for (int p = 0; p < 9; p++)
    Hold((const double[3]){0.8 * (p % 3 - 1), -0.6 * (p % 3 - 1), 0.5 * (p / 3 - 1)}, n, gram);
  assert_int_equal(Free(gram, free), 3);
  ExpectRow(&free[0], (const double[N]){1, 4.0 / 3, 0, 0, 0, 0}); /* about the normal */
  ExpectRow(&free[N], (const double[N]){0, 0, 0, 1, -0.75, 0});   /* along the plane */
  ExpectRow(&free[2 * N], (const double[N]){0, 0, 0, 0, 0, 1});
}

static void test_all_held(void **state)
{
  double gram[N * N] = {0}, free[N * N];

  (void)state;
  for (int p = 0; p < 3; p++)
    for (int d = 0; d < 3; d++)
      Hold((const double[3]){1e-4 * (p == 0), 1e-4 * (p == 1), 0}, (const double[3]){d == 0, d == 1, d == 2}, gram);
  assert_int_equal(Free(gram, free), 0);
}

/* A quarter of a turn about z through (1, 0, 0): the axis stays, the origin goes to (1, -1, 0), and the way is no
   chord. A translation moves all points alike. */
static void test_move(void **state)
{
  const double turn[N] = {0, 0, M_PI / 2, 0, -M_PI / 2, 0}, push[N] = {0, 0, 0, 1, 2, 3};
  double       axis[3] = {1, 0, 5}, origin[3] = {0, 0, 0}, small[3] = {2, 0, 0}, v[3];

  (void)state;
  RigidVelocity(turn, axis, v);
  for (int d = 0; d < 3; d++) assert_float_equal(v[d], 0, RoundOff);
  RigidMove(turn, axis);
  assert_float_equal(axis[0], 1, RoundOff);
  RigidMove(turn, origin);
  assert_float_equal(origin[0], 1, RoundOff);
  assert_float_equal(origin[1], -1, RoundOff);
  RigidMove((const double[N]){0, 0, 1e-3, 0, 0, 0}, small);
  assert_float_equal(small[0], 2 * cos(1e-3), RoundOff);
  assert_float_equal(small[1], 2 * sin(1e-3), RoundOff);
  RigidMove(push, origin);
  assert_float_equal(origin[2], 3, RoundOff);
}

/* The solution of a system of two, by both triangles. */
static void test_solve(void **state)
{
  const double matrix[] = {4, 2, 2, 3};
  double       L[4], x[2] = {8, 7};

  (void)state;
  RigidCholesky(2, matrix, L);
  RigidSolve(2, L, x);
  assert_float_equal(x[0], 1.25, RoundOff);
  assert_float_equal(x[1], 1.5, RoundOff);
}

/* Turns a point by a rotation vector. */
static void Turn(const double turn[3], const double X[3], double x[3])
{
  const double motion[N] = {turn[0], turn[1], turn[2], 0, 0, 0};

  for (int d = 0; d < 3; d++) x[d] = X[d];
  RigidMove(motion, x);
}

/* The spins of a rotation vector are the differences of a turned point, and their changes the differences of the
   spins: small, large and across the angle below which series are taken. */
static void test_turn_rate(void **state)
{
  static const double turns[][3] = {{0, 0, 0}, {1e-3, -2e-3, 3e-3}, {0.6, 0.3, -1.1}, {0.02, 0.01, 0}};
  const double        X[3] = {0.3, -0.7, 1.1}, step = 1e-6;

  (void)state;
  for (int i = 0; i < 4; i++) {
    double spin[3][3], change[3][3][3], x[3];

    RigidTurnRate(turns[i], spin);
    RigidTurnRateChange(turns[i], change);
    Turn(turns[i], X, x);
    for (int k = 0; k < 3; k++) {
      double up[3], down[3], ahead[3], behind[3], spin_up[3][3], spin_down[3][3], velocity[3];

      for (int d = 0; d < 3; d++) {
        up[d]   = turns[i][d] + step * (d == k);
        down[d] = turns[i][d] - step * (d == k);
      }
      Turn(up, X, ahead);
      Turn(down, X, behind);
      RigidVelocity((const double[N]){spin[k][0], spin[k][1], spin[k][2], 0, 0, 0}, x, velocity);
      for (int d = 0; d < 3; d++) assert_float_equal(velocity[d], (ahead[d] - behind[d]) / (2 * step), 1e-8);
      RigidTurnRate(up, spin_up);
      RigidTurnRate(down, spin_down);
      for (int l = 0; l < 3; l++)
        for (int d = 0; d < 3; d++)
          assert_float_equal(change[k][l][d], (spin_up[l][d] - spin_down[l][d]) / (2 * step), 1e-7);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_turn_rate),     cmocka_unit_test(test_move),
                                     cmocka_unit_test(test_solve),         cmocka_unit_test(test_nothing),
                                     cmocka_unit_test(test_point),         cmocka_unit_test(test_line),
                                     cmocka_unit_test(test_oblique_plane), cmocka_unit_test(test_all_held)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
