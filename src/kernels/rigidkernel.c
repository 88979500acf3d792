/* Rigid motions that constraints leave free: Gram matrix, null space, reduced basis. */
#include "kernels/rigidkernel.h"
#include <float.h>
#include <math.h>

/* Entries up to this size are round-off and become 0. Entries have unit scale. The value is far below any motion and
   far above machine precision times the number of bodies. */
static const double ROUND_OFF = 1e-9;
/* Below this angle sines are replaced by the first terms of their series, which leave 1e-12 there. */
static const double SMALL_ANGLE = 1e-2;

/*@
  RigidRow - computes the velocity of each of the six motions at a point along a direction.

  Not collective

  Input Parameters:
+ x - position relative to the body's centre, divided by the body's size
- n - the direction, a unit vector

  Output Parameter:
. row - velocity along n of each motion
@*/
void RigidRow(const double x[3], const double n[3], double row[RIGID_MODES])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    row[d]     = x[e] * n[f] - x[f] * n[e]; /* n . (axis d cross x) */
    row[3 + d] = n[d];
  }
}

/*@
  RigidAddRow - adds weight * row row^T to a Gram matrix.

  Not collective

  Input Parameters:
+ n      - entries of the row
. row    - velocities that the constraint forbids [n]
- weight - of the constraint, without unit

  Output Parameter:
. gram - Gram matrix [n][n], added to
@*/
void RigidAddRow(int n, const double row[], double weight, double gram[])
{
  for (int i = 0; i < n; i++) {
    if (row[i] == 0) continue;
    for (int j = 0; j < n; j++) gram[i * n + j] += weight * row[i] * row[j];
  }
}

static void SwapEntries(double *a, double *b)
{
  const double kept = *a;

  *a = *b;
  *b = kept;
}

/* Exchanges rows and columns a and b. */
static void SwapBoth(int n, int a, int b, double gram[], int place[])
{
  const int kept = place[a];

  for (int i = 0; i < n; i++) SwapEntries(&gram[a * n + i], &gram[b * n + i]);
  for (int i = 0; i < n; i++) SwapEntries(&gram[i * n + a], &gram[i * n + b]);
  place[a] = place[b];
  place[b] = kept;
}

/* Gauss-Jordan elimination of a column by row p. */
static void ClearColumn(int m, int n, int p, int column, double rows[])
{
  const double pivot = rows[p * n + column];

  for (int j = 0; j < n; j++) rows[p * n + j] /= pivot;
  for (int i = 0; i < m; i++) {
    const double factor = rows[i * n + column];

    if (i == p || factor == 0) continue;
    for (int j = 0; j < n; j++) rows[i * n + j] -= factor * rows[p * n + j];
  }
}

/*@
  RigidFree - computes the null space of a positive semidefinite matrix.

  Not collective

  Input Parameters:
+ n         - size of the matrix
. gram      - the matrix [n][n], overwritten
- tolerance - smallest pivot, relative to the largest diagonal entry, or absolute if that entry is below 1

  Output Parameter:
. free - basis of the null space, rows of n; room for [n][n]

  Note:
  Returns the number of rows. The largest diagonal entry is the pivot of each elimination. Elimination ends when no
  pivot exceeds the tolerance; the columns that are left are free. The basis depends on the order of elimination;
  RigidReduce() makes it unique.
@*/
int RigidFree(int n, double gram[], double tolerance, double free[])
{
  int    place[n > 0 ? n : 1], rank = 0;
  double largest = 1;

  for (int i = 0; i < n; i++) {
    place[i] = i;
    largest  = fmax(largest, gram[i * n + i]);
  }
  for (; rank < n; rank++) {
    int best = rank;

    for (int i = rank + 1; i < n; i++)
      if (gram[i * n + i] > gram[best * n + best]) best = i;
    if (!(gram[best * n + best] > tolerance * largest)) break;
    SwapBoth(n, rank, best, gram, place);
    ClearColumn(n, n, rank, rank, gram);
  }
  for (int f = rank; f < n; f++) {
    double *row = &free[(f - rank) * n];

    for (int j = 0; j < n; j++) row[j] = 0;
    for (int i = 0; i < rank; i++) row[place[i]] = -gram[i * n + f];
    row[place[f]] = 1;
  }
  return n - rank;
}

/*@
  RigidReduce - brings rows to reduced row echelon form, which is the one basis of their span that depends on nothing
  else.

  Not collective

  Input Parameters:
+ m       - number of rows
. n       - entries of a row
. columns - order in which columns are cleared [n]
- rows    - the rows [m][n], overwritten

  Note:
  Entries that are round-off become 0.
@*/
void RigidReduce(int m, int n, const int columns[], double rows[])
{
  int p = 0;

  for (int c = 0; c < n && p < m; c++) {
    int best = p;

    for (int i = p + 1; i < m; i++)
      if (fabs(rows[i * n + columns[c]]) > fabs(rows[best * n + columns[c]])) best = i;
    if (!(fabs(rows[best * n + columns[c]]) > ROUND_OFF)) continue;
    for (int j = 0; j < n; j++) SwapEntries(&rows[p * n + j], &rows[best * n + j]);
    ClearColumn(m, n, p++, columns[c], rows);
  }
  for (int i = 0; i < m * n; i++)
    if (fabs(rows[i]) <= ROUND_OFF) rows[i] = 0;
}

/*@
  RigidVelocity - computes the velocity of a motion at a point.

  Not collective

  Input Parameters:
+ q - the motion
- x - position relative to the body's centre, divided by the body's size

  Output Parameter:
. v - translation + rotation x X, in units of the body's size
@*/
void RigidVelocity(const double q[RIGID_MODES], const double x[3], double v[3])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    v[d] = q[3 + d] + q[e] * x[f] - q[f] * x[e];
  }
}

/* (1 - cos a) / a^2 and (a - sin a) / a^3, also for small angles. */
static void MoveFactors(double a, double *second, double *third)
{
  if (a < SMALL_ANGLE) {
    *second = 0.5 - a * a / 24;
    *third  = 1. / 6 - a * a / 120;
  } else {
    *second = (1 - cos(a)) / (a * a);
    *third  = (a - sin(a)) / (a * a * a);
  }
}

/*@
  RigidMove - takes a point along a motion for a unit of time. The body keeps its shape, however far it turns.

  Not collective

  Input Parameter:
. q - the motion; it keeps its axis, so that what does not move at the start stays where it is

  Input/Output Parameter:
. x - position relative to the body's centre, divided by the body's size

  Note:
  The exponential of the motion: x + v + w x v (1 - cos a) / a^2 + w x (w x v) (a - sin a) / a^3, with the velocity v at
  x, the rotation w and its angle a.
@*/
void RigidMove(const double q[RIGID_MODES], double x[3])
{
  const double turn[RIGID_MODES] = {q[0], q[1], q[2], 0, 0, 0};
  double       v[3], wv[3], wwv[3], second, third;

  MoveFactors(sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]), &second, &third);
  RigidVelocity(q, x, v);
  RigidVelocity(turn, v, wv);
  RigidVelocity(turn, wv, wwv);
  for (int d = 0; d < 3; d++) x[d] += v[d] + second * wv[d] + third * wwv[d];
}

/* (1 - cos a) / a^2 and (a - sin a) / a^3, differentiated by a and divided by a, also for small angles. */
static void MoveFactorRates(double a, double *second, double *third)
{
  if (a < SMALL_ANGLE) {
    *second = -1. / 12 + a * a / 180;
    *third  = -1. / 60 + a * a / 1260;
  } else {
    *second = (a * sin(a) - 2 * (1 - cos(a))) / (a * a * a * a);
    *third  = (a * (1 - cos(a)) - 3 * (a - sin(a))) / (a * a * a * a * a);
  }
}

static void Cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/*@
  RigidTurnRate - computes the spin of a body whose rotation vector changes.

  Not collective

  Input Parameter:
. turn - rotation vector (radians): the rotation is its exponential

  Output Parameter:
. spin - spin[k]: angular velocity where component k of the rotation vector grows at rate 1

  Note:
  The spin of a rate v is v + w x v (1 - cos a) / a^2 + w x (w x v) (a - sin a) / a^3, with the rotation vector w and
  its length a.
@*/
void RigidTurnRate(const double turn[3], double spin[3][3])
{
  double second, third;

  MoveFactors(sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]), &second, &third);
  for (int k = 0; k < 3; k++) {
    const double unit[3] = {k == 0, k == 1, k == 2};
    double       once[3], twice[3];

    Cross(turn, unit, once);
    Cross(turn, once, twice);
    for (int d = 0; d < 3; d++) spin[k][d] = unit[d] + second * once[d] + third * twice[d];
  }
}

/*@
  RigidTurnRateChange - computes how the spins of RigidTurnRate() change with the rotation vector.

  Not collective

  Input Parameter:
. turn - rotation vector (radians)

  Output Parameter:
. change - change[l][k]: derivative of spin[k] by component l of the rotation vector
@*/
void RigidTurnRateChange(const double turn[3], double change[3][3][3])
{
  const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  double       second, third, second_rate, third_rate;

  MoveFactors(angle, &second, &third);
  MoveFactorRates(angle, &second_rate, &third_rate);
  for (int l = 0; l < 3; l++) {
    const double by[3] = {l == 0, l == 1, l == 2};

    for (int k = 0; k < 3; k++) {
      const double unit[3] = {k == 0, k == 1, k == 2};
      double       once[3], twice[3], once_by[3], left[3], right[3];

      Cross(turn, unit, once);
      Cross(turn, once, twice);
      Cross(by, unit, once_by);
      Cross(by, once, left);
      Cross(turn, once_by, right);
      for (int d = 0; d < 3; d++)
        change[l][k][d] = second_rate * turn[l] * once[d] + second * once_by[d] + third_rate * turn[l] * twice[d] +
                          third * (left[d] + right[d]);
    }
  }
}

/*@
  RigidCholesky - computes Cholesky's factor L of a positive definite matrix, in its lower triangle.

  Not collective

  Input Parameters:
+ n      - size of the matrix
- matrix - the matrix [n][n]

  Output Parameter:
. L - the factor [n][n]; may be the matrix
@*/
void RigidCholesky(int n, const double *matrix, double *L)
{
  for (int i = 0; i < n; i++) {
    for (int j = 0; j <= i; j++) {
      const double own = matrix[i * n + i];
      double       sum = matrix[i * n + j];

      for (int k = 0; k < j; k++) sum -= L[i * n + k] * L[j * n + k];
      L[i * n + j] = i == j ? sqrt(fmax(sum, DBL_EPSILON * own)) : sum / L[j * n + j];
    }
  }
}

/*@
  RigidForward - replaces x by L^-1 x.

  Not collective

  Input Parameters:
+ n - size
- L - of RigidCholesky()

  Input/Output Parameter:
. x - x[n]
@*/
void RigidForward(int n, const double *L, double x[])
{
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < i; k++) x[i] -= L[i * n + k] * x[k];
    x[i] /= L[i * n + i];
  }
}

/*@
  RigidBackward - replaces x by L^-T x.

  Not collective

  Input Parameters:
+ n - size
- L - of RigidCholesky()

  Input/Output Parameter:
. x - x[n]
@*/
void RigidBackward(int n, const double *L, double x[])
{
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) x[i] -= L[k * n + i] * x[k];
    x[i] /= L[i * n + i];
  }
}

/*@
  RigidSolve - replaces x by (L L^T)^-1 x.

  Not collective

  Input Parameters:
+ n - size
- L - of RigidCholesky()

  Input/Output Parameter:
. x - x[n]
@*/
void RigidSolve(int n, const double *L, double x[])
{
  RigidForward(n, L, x);
  RigidBackward(n, L, x);
}
