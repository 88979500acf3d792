/* Eigenvalues and eigenvectors of symmetric 3 x 3 tensors, LANES at a time, by Jacobi's rotations. Plain C.

   The rotations need no cases for equal eigenvalues: the vectors are orthonormal to rounding, and the eigenvalues are
   exact to rounding of the largest one. A lane that has converged does not change any more, so that its result does
   not depend on the others.
   Source: Golub and Van Loan, "Matrix Computations", section 8.5. */
#pragma once
#include "base/lanes.h"
#include <math.h>

/* Rounds of three rotations. Convergence is quadratic: 3 x 3 tensors take 3 to 5 rounds. */
enum { JACOBI_MOST_ROUNDS = 12 };
/* An entry off the diagonal is negligible below this part of the tensor's norm, far below rounding. */
static const double jacobi_negligible = 1e-20;

/* Computes cosine and sine of the rotation that makes M_pq zero. A lane with a negligible M_pq is not turned. Returns
   how many lanes are. */
LANES_INLINE int JacobiAngle(const Lanes M[3][3], int p, int q, const Lanes *norm2, Lanes *c, Lanes *s)
{
  int rotated = 0;

  for (int lane = 0; lane < LANES; lane++) {
    const double off = M[p][q][lane], turn = off * off > jacobi_negligible * jacobi_negligible * (*norm2)[lane];
    const double tau     = turn ? (M[q][q][lane] - M[p][p][lane]) / (2 * off) : 0;
    const double tangent = turn ? (tau < 0 ? -1 : 1) / (fabs(tau) + sqrt(1 + tau * tau)) : 0;

    (*c)[lane] = 1 / sqrt(1 + tangent * tangent);
    (*s)[lane] = tangent * (*c)[lane];
    rotated += turn != 0;
  }
  return rotated;
}

/* Rotates M and the columns p and q of the vectors. */
LANES_INLINE void JacobiRotate(Lanes M[3][3], Lanes vector[3][3], int p, int q, const Lanes *c, const Lanes *s)
{
  const int   r  = 3 - p - q;
  const Lanes pp = M[p][p], qq = M[q][q], pq = M[p][q], pr = M[p][r], qr = M[q][r];

  M[p][p] = *c * (*c * pp - *s * pq) - *s * (*c * pq - *s * qq);
  M[q][q] = *s * (*s * pp + *c * pq) + *c * (*s * pq + *c * qq);
  M[p][q] = M[q][p] = (Lanes){0};
  M[p][r] = M[r][p] = *c * pr - *s * qr;
  M[q][r] = M[r][q] = *s * pr + *c * qr;
  for (int i = 0; i < 3; i++) {
    const Lanes vp = vector[i][p], vq = vector[i][q];

    vector[i][p] = *c * vp - *s * vq;
    vector[i][q] = *s * vp + *c * vq;
  }
}

/* vector[i][a] is component i of the eigenvector of value[a]. */
LANES_INLINE void PrincipalValues(const Lanes tensor[9], Lanes value[3], Lanes vector[3][3])
{
  Lanes M[3][3], norm2 = {0}, c = {0}, s = {0};
  int   rotated = 1;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      M[i][j]      = tensor[3 * i + j];
      vector[i][j] = (Lanes){0} + (double)(i == j);
      norm2 += M[i][j] * M[i][j];
    }
  }
  for (int round = 0; round < JACOBI_MOST_ROUNDS && rotated; round++) {
    rotated = 0;
    for (int pair = 0; pair < 3; pair++) {
      const int p = pair == 2, q = pair == 0 ? 1 : 2;

      rotated += JacobiAngle(M, p, q, &norm2, &c, &s);
      JacobiRotate(M, vector, p, q, &c, &s);
    }
  }
  for (int a = 0; a < 3; a++) value[a] = M[a][a];
}
