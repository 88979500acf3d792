/* The polynomial of a patch by least squares, see recovery.h. */
#include "kernels/recovery.h"
#include <math.h>

/* A pivot below this part of its diagonal entry is round-off: the points of the patch do not tell the terms apart.
   Coordinates are of the size of the patch, so that entries that count are above 1e-4. */
static const double smallest_pivot = 1e-8;

/*@
  RecoveryTerms - returns the number of terms of a polynomial.

  Not collective

  Input Parameters:
+ dim    - number of coordinates, 2 or 3
- degree - at most RECOVERY_DEGREE
@*/
int RecoveryTerms(int dim, int degree)
{
  if (degree == 0) return 1;
  if (degree == 1) return 1 + dim;
  return dim == 2 ? 6 : 10;
}

/*@
  RecoveryAdd - adds a point to the matrix of a patch.

  Not collective

  Input Parameters:
+ n     - number of terms
- terms - of RecoveryBasis() at the point

  Input/Output Parameter:
. matrix - lower triangle, row by row [n (n + 1) / 2]
@*/
void RecoveryAdd(int n, const double *terms, double *matrix)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) *matrix++ += terms[i] * terms[j];
}

/* Factors the first n rows as L L^T in place; returns 0 where a pivot is too small. */
static int Cholesky(int n, double *matrix)
{
  for (int i = 0; i < n; i++) {
    double *row = &matrix[i * (i + 1) / 2], entry = row[i];

    for (int j = 0; j <= i; j++) {
      const double *other = &matrix[j * (j + 1) / 2];
      double        sum   = row[j];

      for (int k = 0; k < j; k++) sum -= row[k] * other[k];
      if (j < i)
        row[j] = sum / other[j];
      else if (!(sum > smallest_pivot * entry))
        return 0;
      else
        row[i] = sqrt(sum);
    }
  }
  return 1;
}

/* Variance of the polynomial at the node, in parts of that of the values: the first entry of the inverse. */
static double NodeVariance(int n, const double *factor)
{
  double sum = 0, x[RECOVERY_TERMS];

  for (int i = 0; i < n; i++) {
    const double *row = &factor[i * (i + 1) / 2];

    x[i] = i == 0;
    for (int k = 0; k < i; k++) x[i] -= row[k] * x[k];
    x[i] /= row[i];
    sum += x[i] * x[i];
  }
  return sum;
}

/*@
  RecoveryFactor - factors the matrix of a patch, for the highest degree that its points allow.

  Not collective

  Input Parameters:
+ dim    - number of coordinates, 2 or 3
- degree - the highest degree

  Input/Output Parameter:
. matrix - the sums of RecoveryAdd(); replaced by the factor for RecoverySolve()

  Output Parameter:
. variance - of the polynomial at the node, in parts of the variance of the values; the smaller, the better it is known

  Note:
  Returns the degree, -1 for a patch without points.
@*/
int RecoveryFactor(int dim, int degree, double *matrix, double *variance)
{
  double sums[RECOVERY_MATRIX];

  *variance = INFINITY;
  if (!(matrix[0] > 0)) return -1;
  for (int k = 0; k < RECOVERY_MATRIX && degree >= 0; k++)
    if (k < RecoveryTerms(dim, degree) * (RecoveryTerms(dim, degree) + 1) / 2) sums[k] = matrix[k];
  while (!Cholesky(RecoveryTerms(dim, degree), matrix)) {
    degree--;
    for (int k = 0; k < RecoveryTerms(dim, degree) * (RecoveryTerms(dim, degree) + 1) / 2; k++) matrix[k] = sums[k];
  }
  *variance = NodeVariance(RecoveryTerms(dim, degree), matrix);
  return degree;
}

/*@
  RecoverySolve - computes the coefficients of a patch's polynomial.

  Not collective

  Input Parameters:
+ n      - number of terms
. factor - of RecoveryFactor()
- stride - from one term to the next in sums

  Input/Output Parameter:
. sums - the values at the points times the terms, summed over the points; replaced by the coefficients [n][stride]
@*/
void RecoverySolve(int n, const double *factor, int stride, double *sums)
{
  for (int i = 0; i < n; i++) {
    const double *row = &factor[i * (i + 1) / 2];

    for (int k = 0; k < i; k++) sums[i * stride] -= row[k] * sums[k * stride];
    sums[i * stride] /= row[i];
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) sums[i * stride] -= factor[k * (k + 1) / 2 + i] * sums[k * stride];
    sums[i * stride] /= factor[i * (i + 1) / 2 + i];
  }
}
