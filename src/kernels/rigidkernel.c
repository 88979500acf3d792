#include "kernels/rigidkernel.h"
#include <math.h>

/* Entries of unit scale that round-off leaves; far below any motion, far above machine precision times the number of
 * bodies. */
static const double ROUND_OFF = 1e-9;

/* RigidRow - the velocity along n of each of the six motions at x (relative to the centre, in sizes). */
void RigidRow(const double x[3], const double n[3], double row[RIGID_MODES])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    row[d]     = x[e] * n[f] - x[f] * n[e]; /* n . (axis d cross x) */
    row[3 + d] = n[d];
  }
}

/* RigidAddRow - adds a constraint to the sum of squares. */
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

/* Rows and columns a and b change places. */
static void SwapBoth(int n, int a, int b, double gram[], int place[])
{
  const int kept = place[a];

  for (int i = 0; i < n; i++) SwapEntries(&gram[a * n + i], &gram[b * n + i]);
  for (int i = 0; i < n; i++) SwapEntries(&gram[i * n + a], &gram[i * n + b]);
  place[a] = place[b];
  place[b] = kept;
}

/* Gauss-Jordan elimination by row p of the rows 0..n-1 */
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

/* RigidFree - the null space of a positive semidefinite matrix.

   Elimination with the largest diagonal entry as pivot, until none exceeds tolerance times the largest entry
   (absolutely tolerance if that is below 1): what is left over is free. The basis is that of the elimination;
   RigidReduce() makes it unique. */
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

/* RigidReduce - reduced row echelon form, columns cleared in the given order; what round-off leaves becomes 0. */
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
