/* The symmetric product M = K^T J + J^T K of two tall thin factors, of which the second variations of smoothed contact
   are made. Plain C: no PETSc, no MPI, no allocation.

   SymmetricProductStride() tells how long the rows of the factors must be. SymmetricProduct() makes the whole matrix
   and SymmetricProductUpper() its upper triangle. Only the upper triangle is computed: the lower one is its mirror
   image to the last bit. */
#pragma once
#include "base/lanes.h"

/* Vectors of columns in a tile of M that is held in registers; the tile has LANES rows. These are 24 accumulators of
   the 32 registers with AVX-512, and 12 of 16 with AVX. */
enum { PRODUCT_VECTORS = 3 };

int  SymmetricProductStride(int n);
void SymmetricProduct(int n, int depth, int stride, const double *K, const double *J, double *M);
void SymmetricProductUpper(int n, int depth, int stride, const double *K, const double *J, double *M);
