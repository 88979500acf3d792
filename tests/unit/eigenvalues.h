/* Eigenvalues of small symmetric matrices, for tests: Jacobi's rotations (Golub and Van Loan, section 8.5). */
#pragma once
#include <math.h>

static const double eigenvalue_accuracy = 1e-30; /* square of what may be left off the diagonal, relative */

/* Turns rows and columns p and q so that A[p][q] becomes 0 */
static inline void EigenvaluesRotate(int n, double *A, int p, int q)
{
  const double tau = (A[q * n + q] - A[p * n + p]) / (2 * A[p * n + q]),
               t   = (tau < 0 ? -1 : 1) / (fabs(tau) + sqrt(1 + tau * tau));
  const double c = 1 / sqrt(1 + t * t), s = t * c;

  for (int k = 0; k < n; k++) {
    const double kp = A[k * n + p], kq = A[k * n + q];

    A[k * n + p] = c * kp - s * kq;
    A[k * n + q] = s * kp + c * kq;
  }
  for (int k = 0; k < n; k++) {
    const double pk = A[p * n + k], qk = A[q * n + k];

    A[p * n + k] = c * pk - s * qk;
    A[q * n + k] = s * pk + c * qk;
  }
}

/* A[n][n] is spoilt; value[n]: ascending */
static inline void Eigenvalues(int n, double *A, double *value)
{
  double total = 0, off = 1;

  for (int k = 0; k < n * n; k++) total += A[k] * A[k];
  while (off > eigenvalue_accuracy) {
    off = 0;
    for (int p = 0; p < n; p++) {
      for (int q = p + 1; q < n; q++) {
        off += A[p * n + q] * A[p * n + q] / total;
        if (A[p * n + q] != 0) EigenvaluesRotate(n, A, p, q);
      }
    }
  }
  for (int k = 0; k < n; k++) {
    int i = k;

    for (; i > 0 && value[i - 1] > A[k * n + k]; i--) value[i] = value[i - 1];
    value[i] = A[k * n + k];
  }
}
