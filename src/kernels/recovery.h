/* Recovery of a field from its values at points around a node: the polynomial of a patch. Plain C, no PETSc, no
   allocation.

   A patch is the cells around a node. Its polynomial is the one of given degree that is next to the values at the
   points of the patch, by least squares. RecoveryBasis() evaluates the terms of a polynomial at a point,
   RecoveryAdd() adds a point to the sums of a patch. The sums of two parts of a patch are added, so that ranks may
   share it. RecoveryFactor() factors the matrix of the sums once, RecoverySolve() then gives the coefficients of
   any field. A field that is a polynomial of that degree comes back exactly.

   The terms are ordered by degree. The matrix of a lower degree is therefore the upper left part of that of a
   higher one, and a patch of too few points has a polynomial of lower degree without new sums.

   Sources: Zienkiewicz and Zhu, International Journal for Numerical Methods in Engineering 33 (1992), part 1, for
   the patches; Zhang and Naga, SIAM Journal on Scientific Computing 26 (2005), for polynomials of the order of the
   elements and for nodes at the boundary, where patches of nodes inside serve. */
#pragma once

enum {
  RECOVERY_DEGREE = 2,                                         /* the largest one */
  RECOVERY_TERMS  = 10,                                        /* of that degree in space */
  RECOVERY_MATRIX = RECOVERY_TERMS * (RECOVERY_TERMS + 1) / 2, /* entries of the lower triangle, row by row */
};

int  RecoveryTerms(int dim, int degree);
void RecoveryAdd(int n, const double *terms, double *matrix);
int  RecoveryFactor(int dim, int degree, double *matrix, double *variance);
void RecoverySolve(int n, const double *factor, int stride, double *sums);

/*@
  RecoveryBasis - evaluates the terms of a polynomial.

  Not collective

  Input Parameters:
+ dim    - number of coordinates, 2 or 3
. degree - at most RECOVERY_DEGREE
- x      - the point, from the node of the patch and over the size of the patch [dim]

  Output Parameter:
. terms - 1, x_i, x_i x_j for i <= j [RecoveryTerms()]
@*/
static inline void RecoveryBasis(int dim, int degree, const double *x, double *terms)
{
  int n = 0;

  terms[n++] = 1;
  for (int i = 0; i < dim && degree > 0; i++) terms[n++] = x[i];
  for (int i = 0; i < dim && degree > 1; i++)
    for (int j = i; j < dim; j++) terms[n++] = x[i] * x[j];
}
