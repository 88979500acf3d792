/* Arnoldi's method with the inverse of a matrix. */
#include "linear/negativemode.h"
#include <petscblaslapack.h>

/* Solves of a search. A strip that is pressed far beyond its first critical loads needs four. */
enum { NEGATIVE_SOLVES = 6 };

/* An eigenvalue counts that is known to this part of itself. */
#define NEGATIVE_REST 0.1

/* Eigenvalues of the inverse that are smaller than this part of the largest one are round-off: bodies that nothing but
   weak springs holds have eigenvalues of 1e9 times those of others. */
#define NEGATIVE_ROUND_OFF 1e-11

/* The eigenvalues and eigenvectors of the projected inverse, Hessenberg H[column][row]. */
typedef struct {
  PetscScalar real[NEGATIVE_SOLVES], imaginary[NEGATIVE_SOLVES], vectors[NEGATIVE_SOLVES * NEGATIVE_SOLVES];
} Eigenpairs;

static PetscErrorCode SolveProjected(PetscScalar H[NEGATIVE_SOLVES + 1][NEGATIVE_SOLVES + 1], int m, Eigenpairs *pairs)
{
  PetscScalar  a[NEGATIVE_SOLVES * NEGATIVE_SOLVES], work[8 * NEGATIVE_SOLVES], none;
  PetscBLASInt n = m, one = 1, size = 8 * NEGATIVE_SOLVES, info;

  PetscFunctionBeginUser;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < m; i++) a[j * m + i] = H[j][i];
  PetscCallBLAS("LAPACKgeev", LAPACKgeev_("N", "V", &n, a, &n, pairs->real, pairs->imaginary, &none, &one,
                                          pairs->vectors, &n, work, &size, &info));
  PetscCheck(info == 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK geev returned %d", (int)info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the place of the largest negative eigenvalue that is known, of m; -1 without any. rest: length of the part of
   the last solve that is outside the space. */
static int LargestNegative(const Eigenpairs *pairs, int m, PetscReal rest)
{
  PetscReal largest = 0, most = 0;
  int       place = -1;

  for (int k = 0; k < m; k++)
    largest = PetscMax(largest, PetscSqrtReal(PetscSqr(pairs->real[k]) + PetscSqr(pairs->imaginary[k])));
  for (int k = 0; k < m; k++) {
    const PetscReal size = -pairs->real[k];

    if (pairs->imaginary[k] != 0 || size <= PetscMax(most, NEGATIVE_ROUND_OFF * largest)) continue;
    if (rest * PetscAbsReal(pairs->vectors[k * m + m - 1]) > NEGATIVE_REST * size) continue;
    most  = size;
    place = k;
  }
  return place;
}

/* Fills the orthonormal vectors v[0..m] of the space from v[0], and the projection of the inverse. *rest: what of the
   last solve is outside the space. */
static PetscErrorCode FillSpace(Factor factor, Vec v[], PetscScalar H[NEGATIVE_SOLVES + 1][NEGATIVE_SOLVES + 1], int *m,
                                PetscReal *rest)
{
  PetscFunctionBeginUser;
  *m = 0;
  PetscCall(VecNormalize(v[0], rest));
  while (*rest > 0 && *m < NEGATIVE_SOLVES) {
    const int j = (*m)++;

    PetscCall(FactorSolve(factor, v[j], v[j + 1]));
    for (int i = 0; i <= j; i++) {
      PetscCall(VecDot(v[j + 1], v[i], &H[j][i]));
      PetscCall(VecAXPY(v[j + 1], -H[j][i], v[i]));
    }
    PetscCall(VecNormalize(v[j + 1], rest));
    H[j][j + 1] = *rest;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NegativeModeFind - finds the real negative eigenvalue of a matrix that is closest to 0, as far as a few solves tell.

  Collective

  Input Parameter:
. factor - of the matrix, which need not be symmetric

  Input/Output Parameter:
. mode - a vector with a part of all motions; then the eigenvector of length 1, if there is one

  Output Parameter:
. eigenvalue - of the matrix; 0: none was found

  Source: Y. Saad, Numerical methods for large eigenvalue problems, 2nd ed., SIAM 2011, section 6.2.
@*/
PetscErrorCode NegativeModeFind(Factor factor, Vec mode, PetscReal *eigenvalue)
{
  PetscScalar H[NEGATIVE_SOLVES + 1][NEGATIVE_SOLVES + 1] = {{0}};
  Eigenpairs  pairs;
  PetscReal   rest;
  Vec        *v;
  int         m, k = -1;

  PetscFunctionBeginUser;
  *eigenvalue = 0;
  PetscCall(VecDuplicateVecs(mode, NEGATIVE_SOLVES + 1, &v));
  PetscCall(VecCopy(mode, v[0]));
  PetscCall(FillSpace(factor, v, H, &m, &rest));
  if (m && !PetscIsInfOrNanReal(rest)) { /* a factor that is singular to round-off gives no numbers */
    PetscCall(SolveProjected(H, m, &pairs));
    k = LargestNegative(&pairs, m, rest);
  }
  if (k >= 0) {
    *eigenvalue = 1 / pairs.real[k];
    PetscCall(VecSet(mode, 0));
    PetscCall(VecMAXPY(mode, m, &pairs.vectors[k * m], v));
  }
  PetscCall(VecDestroyVecs(NEGATIVE_SOLVES + 1, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
