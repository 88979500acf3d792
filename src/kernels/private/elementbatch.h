/* What the element kernels of all formulations share, plain C: always-inline functions, instantiated with constant
   sizes for each element, so that their inner loops unroll; every arithmetic operation acts on LANES elements, all of a
   batch or part of it.

   The tangent of a pair of nodes is g_a . A . g_b with the law's 9 x 9 tangent A (symmetric) and reference gradients g:
   as cheap as the closed forms of special laws, and the same for all. T = A . g_b is formed once per node b and point.
 */
#pragma once
#include "kernels/elementkernel.h"

/* Points treated together: A, T and g of a chunk stay in the first-level cache, while the blocks of K (which do not,
   for hex27) are loaded and stored once per chunk only. */
enum { CHUNK = 9, TENSOR_HOOP = 8, MAX_ROWS = 9 };

_Static_assert(KERNEL_LANES % LANES == 0, "a batch consists of whole vectors");

/* A vector of the batch's arrays of doubles, which need not be aligned */
#define LANE(array, index)       (*(LanesInArray *)((array) + (index) * KERNEL_LANES))
#define CONST_LANE(array, index) (*(const LanesInArray *)((array) + (index) * KERNEL_LANES))

/* Row r of the gradient operator as a component of a 3 x 3 tensor: 2D has 4 in-plane rows and, axisymmetric, the hoop
 */
#define TENSOR_ROW(dim, r) ((dim) == 3 ? (r) : (r) == 4 ? TENSOR_HOOP : 3 * ((r) / 2) + (r) % 2)
#define TANGENT(A, r, s)   ((A)[(r) <= (s) ? MATERIAL_TANGENT_INDEX(r, s) : MATERIAL_TANGENT_INDEX(s, r)])

static const double two_pi = 6.28318530717958647693;

typedef struct {
  Lanes g[ELEMENT_MAX_NODES][CHUNK][3];  /* reference gradient; axisymmetric: [2] is N_a / R */
  Lanes A[CHUNK][MATERIAL_TANGENT_SIZE]; /* times weight and volume */
} ChunkPoints;

/* One call: LANES elements of a batch. H[points][9]: displacement gradient that the law is evaluated at; W, f, K, H may
 * be NULL (elementkernel.h) */
typedef struct {
  const Element *e;
  MaterialLawFn *law;
  int            finite;
  const double  *X, *u;
  Lanes          lambda, mu;
  double        *W, *f, *K, *J, *H;
} BatchCall;

/* Reference gradients of all nodes, at a point with shape functions N and dN, as number q of the chunk; volume: the
 * reference volume of the point */
LANES_INLINE void PointGradients(const int n, const int dim, const int hoop, const double *N, const double (*dN)[3],
                                 double weight, int q, const double *X, ChunkPoints *c, Lanes *volume)
{
  Lanes G[3][3] = {{{0}}}, B[3][3], inverse;

  for (int a = 0; a < n; a++) {
    for (int k = 0; k < dim; k++) {
      for (int m = 0; m < dim; m++) G[k][m] += dN[a][k] * CONST_LANE(X, a * dim + m);
    }
  }
  if (dim == 3) { /* B: cofactors of G */
    for (int k = 0; k < 3; k++) {
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;

      for (int m = 0; m < 3; m++)
        B[k][m] = G[k1][(m + 1) % 3] * G[k2][(m + 2) % 3] - G[k1][(m + 2) % 3] * G[k2][(m + 1) % 3];
    }
    *volume = G[0][0] * B[0][0] + G[0][1] * B[0][1] + G[0][2] * B[0][2];
  } else {
    B[0][0] = G[1][1];
    B[0][1] = -G[1][0];
    B[1][0] = -G[0][1];
    B[1][1] = G[0][0];
    *volume = G[0][0] * B[0][0] + G[0][1] * B[0][1];
  }
  inverse = 1 / *volume;
  for (int k = 0; k < dim; k++) {
    for (int m = 0; m < dim; m++) B[k][m] *= inverse;
  }
  for (int a = 0; a < n; a++) {
    for (int m = 0; m < dim; m++) {
      c->g[a][q][m] = dN[a][0] * B[0][m];
      for (int k = 1; k < dim; k++) c->g[a][q][m] += dN[a][k] * B[k][m];
    }
  }
  *volume *= weight;
  if (hoop) {
    Lanes radius = {0};

    for (int a = 0; a < n; a++) radius += N[a] * CONST_LANE(X, a * dim);
    *volume *= two_pi * radius;
    for (int a = 0; a < n; a++) c->g[a][q][2] = N[a] / radius;
  }
}

LANES_INLINE void PointDisplacementGradient(const int n, const int dim, const int hoop, int q, const double *u,
                                            const ChunkPoints *c, Lanes H[9])
{
  for (int r = 0; r < 9; r++) H[r] = (Lanes){0};
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < dim; i++) {
      for (int m = 0; m < dim; m++) H[3 * i + m] += CONST_LANE(u, a * dim + i) * c->g[a][q][m];
    }
    if (hoop) H[TENSOR_HOOP] += CONST_LANE(u, a * dim) * c->g[a][q][2];
  }
}

LANES_INLINE void AddForce(const int n, const int dim, const int hoop, int q, const ChunkPoints *c, const Lanes P[9],
                           double *f)
{
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < dim; i++) {
      Lanes force = P[3 * i] * c->g[a][q][0];

      for (int m = 1; m < dim; m++) force += P[3 * i + m] * c->g[a][q][m];
      if (hoop && i == 0) force += P[TENSOR_HOOP] * c->g[a][q][2];
      LANE(f, a * dim + i) += force;
    }
  }
}

/* Adds the chunk's points to the blocks (a, b), a <= b, of K; the last chunk also writes their mirror images */
LANES_INLINE void AddTangent(const int n, const int dim, const int hoop, const int count, const int first,
                             const int last, const ChunkPoints *c, double *K)
{
  const int rows = dim * dim + hoop;

  for (int b = 0; b < n; b++) {
    Lanes T[CHUNK][MAX_ROWS][3];

    for (int q = 0; q < count; q++) {
#pragma GCC unroll 9
      for (int r = 0; r < rows; r++) {
#pragma GCC unroll 3
        for (int j = 0; j < dim; j++) {
          T[q][r][j] = TANGENT(c->A[q], TENSOR_ROW(dim, r), 3 * j) * c->g[b][q][0];
          for (int m = 1; m < dim; m++) T[q][r][j] += TANGENT(c->A[q], TENSOR_ROW(dim, r), 3 * j + m) * c->g[b][q][m];
          if (hoop && j == 0) T[q][r][j] += TANGENT(c->A[q], TENSOR_ROW(dim, r), TENSOR_HOOP) * c->g[b][q][2];
        }
      }
    }
    for (int a = 0; a <= b; a++) {
      Lanes block[3][3] = {{{0}}};

      for (int q = 0; q < count; q++) {
#pragma GCC unroll 3
        for (int i = 0; i < dim; i++) {
#pragma GCC unroll 3
          for (int m = 0; m < dim; m++) {
#pragma GCC unroll 3
            for (int j = 0; j < dim; j++) block[i][j] += c->g[a][q][m] * T[q][dim * i + m][j];
          }
        }
        for (int j = 0; j < dim && hoop; j++) block[0][j] += c->g[a][q][2] * T[q][4][j];
      }
#pragma GCC unroll 3
      for (int i = 0; i < dim; i++) {
#pragma GCC unroll 3
        for (int j = 0; j < dim; j++) {
          if (!first) block[i][j] += LANE(K, (a * dim + i) * n * dim + b * dim + j);
          LANE(K, (a * dim + i) * n * dim + b * dim + j) = block[i][j];
          if (last && a < b) LANE(K, (b * dim + j) * n * dim + a * dim + i) = block[i][j];
        }
      }
    }
  }
}

/* J starts above any determinant, small kinematics: at 1 */
LANES_INLINE void StartLeastJ(const BatchCall *call)
{
  for (int lane = 0; lane < LANES; lane++) call->J[lane] = call->finite ? __DBL_MAX__ : 1;
}

LANES_INLINE void KeepLeastJ(const BatchCall *call, const Lanes *dilatation)
{
  for (int lane = 0; lane < LANES && call->finite; lane++) {
    if (!(1 + (*dilatation)[lane] >= call->J[lane]))
      call->J[lane] = 1 + (*dilatation)[lane]; /* written so that NaN gets through */
  }
}

LANES_INLINE void StorePoint(const BatchCall *call, int p, const Lanes H[9])
{
  for (int r = 0; r < 9; r++) LANE(call->H, p * 9 + r) = H[r];
}

typedef void BatchFn(const BatchCall *);

/* Instances by element and geometry (1: axisymmetric), NULL where a formulation has none */
extern BatchFn *const enhanced_batches[ELEMENT_TYPES][2];
extern BatchFn *const mean_dilatation_batches[ELEMENT_TYPES][2];
