/* The symmetric product M = K^T J + J^T K of two tall thin factors: what second variations of smoothed contact are made
   of. Plain C: no PETSc, no MPI, no allocation. Only the upper triangle is computed; the lower one is its mirror image,
   to the last bit, or left out. */
#pragma once
#include "base/lanes.h"

/* Tile of M that is held in registers: LANES rows, PRODUCT_VECTORS vectors of columns (24 accumulators of 32 registers
 * with AVX-512, 12 of 16 with AVX) */
enum { PRODUCT_VECTORS = 3 };

/* Least length of a row of K and J for a product of n rows: the entries past n must be finite, they are read and not
 * used. */
int SymmetricProductStride(int n);
/* K, J: [depth][stride], stride >= SymmetricProductStride(n), aligned to a vector. M: [n][n], whole or its upper
 * triangle only. */
void SymmetricProduct(int n, int depth, int stride, const double *K, const double *J, double *M);
void SymmetricProductUpper(int n, int depth, int stride, const double *K, const double *J, double *M);
