/* The product M = K^T J + J^T K in tiles of LANES rows. A tile stays in registers while the depth is summed. Its
   mirror image is transposed in registers too, because a scalar copy would cost as much as the product. */
#include "symmetricproduct.h"
#include "fitkernel.h"

enum { TILE_ROWS = LANES, TILE_COLUMNS = PRODUCT_VECTORS * LANES };

/* Rows of the factors that are summed at a time: those of a tile's columns then stay in the first cache while all tiles
   above each other are computed. The factors of sixteen second variations have 288. */
enum { PRODUCT_DEPTH = 96 };

/*@
  SymmetricProductStride - gives the least length of a row of the factors, which is a whole number of tiles.

  Not collective

  Input Parameter:
. n - rows of the product

  Note:
  Plain C.
@*/
int SymmetricProductStride(int n)
{
  return (n + TILE_COLUMNS - 1) / TILE_COLUMNS * TILE_COLUMNS;
}

LANES_INLINE void AddOuterProducts(const int vectors, int depth, int stride, const double *left, const double *right,
                                   Lanes (*tile)[PRODUCT_VECTORS])
{
  for (int k = 0; k < depth; k++, left += stride, right += stride) {
    const Lanes *b = (const Lanes *)right;

    for (int r = 0; r < TILE_ROWS; r++) {
      for (int c = 0; c < vectors; c++) tile[r][c] += left[r] * b[c];
    }
  }
}

/* Stores a square that lies above the diagonal and wholly within M, or adds it to what stands there. If M is wanted in
   full, stores the mirror image too. */
LANES_INLINE void StoreInside(const int full, const int add, int n, int row, int column, Lanes square[LANES], double *M)
{
  for (int r = 0; r < LANES; r++) {
    LanesInArray *to = (LanesInArray *)(M + (long)(row + r) * n + column);

    if (add) square[r] += *to;
    *to = square[r];
  }
  if (!full) return;
  Transpose(square);
  for (int r = 0; r < LANES; r++) *(LanesInArray *)(M + (long)(column + r) * n + row) = square[r];
}

/* Stores, or adds, a square that lies on the diagonal or reaches past the end of M. */
LANES_INLINE void StorePart(const int full, const int add, int n, int row, int column, Lanes square[LANES], double *M)
{
  for (int r = row; r < row + LANES && r < n; r++) {
    for (int c = column < r ? r : column; c < column + LANES && c < n; c++) {
      const double entry = square[r - row][c - column] + (add ? M[(long)r * n + c] : 0);

      M[(long)r * n + c] = entry;
      if (full) M[(long)c * n + r] = entry;
    }
  }
}

/* Computes the tile at (row, column), which is a whole number of vectors wide. If M is wanted in full, its mirror
   image is stored too. */
LANES_INLINE void ProductTile(const int full, const int add, const int vectors, int n, int depth, int stride,
                              const double *K, const double *J, int row, int column, double *M)
{
  Lanes tile[TILE_ROWS][PRODUCT_VECTORS] = {{{0}}};

  AddOuterProducts(vectors, depth, stride, K + row, J + column, tile);
  AddOuterProducts(vectors, depth, stride, J + row, K + column, tile);
  for (int c = 0; c < vectors; c++) {
    const int first = column + c * LANES;
    Lanes     square[LANES];

    for (int r = 0; r < LANES; r++) square[r] = tile[r][c];
    if (first > row && first + LANES <= n)
      StoreInside(full, add, n, row, first, square, M);
    else
      StorePart(full, add, n, row, first, square, M);
  }
}

/* Computes the product of some rows of the factors, or adds it to M. */
LANES_INLINE void ProductOfRows(const int full, const int add, int n, int depth, int stride, const double *K,
                                const double *J, double *M)
{
  for (int column = 0; column < n; column += TILE_COLUMNS) {
    const int end = LanesGroups(n) * LANES < column + TILE_COLUMNS ? LanesGroups(n) * LANES : column + TILE_COLUMNS;

    for (int row = 0; row < end; row += TILE_ROWS) {
      const int first = row < column ? column : row;

      switch ((end - first) / LANES) {
      case 1: ProductTile(full, add, 1, n, depth, stride, K, J, row, first, M); break;
      case 2: ProductTile(full, add, 2, n, depth, stride, K, J, row, first, M); break;
      case 3: ProductTile(full, add, 3, n, depth, stride, K, J, row, first, M); break;
      }
    }
  }
}

/* Computes the product part by part of the factors' rows. */
LANES_INLINE void ProductInParts(const int full, int n, int depth, int stride, const double *K, const double *J,
                                 double *M)
{
  ProductOfRows(full, 0, n, depth < PRODUCT_DEPTH ? depth : PRODUCT_DEPTH, stride, K, J, M);
  for (int k = PRODUCT_DEPTH; k < depth; k += PRODUCT_DEPTH) {
    const int rows = depth - k < PRODUCT_DEPTH ? depth - k : PRODUCT_DEPTH;

    ProductOfRows(full, 1, n, rows, stride, K + (long)k * stride, J + (long)k * stride, M);
  }
}

/*@
  SymmetricProduct - computes M = K^T J + J^T K.

  Not collective

  Input Parameters:
+ n      - rows of the product
. depth  - rows of the factors
. stride - length of a row of the factors: at least SymmetricProductStride(n) and a whole number of vectors
. K      - first factor, K[depth][stride], aligned to a vector
- J      - second factor, J[depth][stride], aligned to a vector

  Output Parameter:
. M - the product, M[n][n], symmetric to the last bit

  Note:
  The entries of K and J past n must be finite, because they are read, although they are not used. Plain C.
@*/
void SymmetricProduct(int n, int depth, int stride, const double *K, const double *J, double *M)
{
  ProductInParts(1, n, depth, stride, K, J, M);
}

/*@
  SymmetricProductUpper - computes the upper triangle of M = K^T J + J^T K and leaves the triangle below the diagonal as
  it is.

  Not collective

  Input Parameters:
+ n      - rows of the product
. depth  - rows of the factors
. stride - as in SymmetricProduct()
. K      - first factor, as in SymmetricProduct()
- J      - second factor, as in SymmetricProduct()

  Output Parameter:
. M - the product, M[n][n], of which the upper triangle is written

  Note:
  Plain C.
@*/
void SymmetricProductUpper(int n, int depth, int stride, const double *K, const double *J, double *M)
{
  ProductInParts(0, n, depth, stride, K, J, M);
}
