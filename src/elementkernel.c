/* Batched element kernels. One always-inline function, instantiated with constant sizes for each element, so that its inner loops unroll;
   every arithmetic operation acts on LANES elements, all of a batch or part of it.

   The tangent of a pair of nodes is g_a . A . g_b with the law's 9 x 9 tangent A (symmetric) and reference gradients g: as cheap as the
   closed forms of special laws, and the same for all. T = A . g_b is formed once per node b and point. */
#include "elementkernel.h"
#include <stddef.h>

/* Points treated together: A, T and g of a chunk stay in the first-level cache, while the blocks of K (which do not, for hex27) are
   loaded and stored once per chunk only. */
enum { CHUNK = 9, TENSOR_HOOP = 8, MAX_ROWS = 9 };

_Static_assert(KERNEL_LANES % LANES == 0, "a batch consists of whole vectors");

/* A vector of the batch's arrays of doubles, which need not be aligned */
#define LANE(array, index)       (*(LanesInArray *)((array) + (index)*KERNEL_LANES))
#define CONST_LANE(array, index) (*(const LanesInArray *)((array) + (index)*KERNEL_LANES))

/* Row r of the gradient operator as a component of a 3 x 3 tensor: 2D has 4 in-plane rows and, axisymmetric, the hoop */
#define TENSOR_ROW(dim, r) ((dim) == 3 ? (r) : (r) == 4 ? TENSOR_HOOP : 3 * ((r) / 2) + (r) % 2)
#define TANGENT(A, r, s)   ((A)[(r) <= (s) ? MATERIAL_TANGENT_INDEX(r, s) : MATERIAL_TANGENT_INDEX(s, r)])

static const double two_pi = 6.28318530717958647693;

typedef struct {
  Lanes g[ELEMENT_MAX_NODES][CHUNK][3];  /* reference gradient; axisymmetric: [2] is N_a / R */
  Lanes A[CHUNK][MATERIAL_TANGENT_SIZE]; /* times weight and volume */
} ChunkPoints;

#define KERNEL_INLINE static inline __attribute__((always_inline))

/* Reference gradients of all nodes at point p as number q of the chunk; returns the reference volume of the point */
KERNEL_INLINE void PointGradients(const Element *e, const int n, const int dim, const int hoop, int p, int q, const double *X, ChunkPoints *c, Lanes *volume)
{
  Lanes G[3][3] = {{{0}}}, B[3][3], inverse;

  for (int a = 0; a < n; a++) {
    for (int k = 0; k < dim; k++) {
      for (int m = 0; m < dim; m++) G[k][m] += e->dN[p][a][k] * CONST_LANE(X, a * dim + m);
    }
  }
  if (dim == 3) { /* B: cofactors of G */
    for (int k = 0; k < 3; k++) {
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;

      for (int m = 0; m < 3; m++) B[k][m] = G[k1][(m + 1) % 3] * G[k2][(m + 2) % 3] - G[k1][(m + 2) % 3] * G[k2][(m + 1) % 3];
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
      c->g[a][q][m] = e->dN[p][a][0] * B[0][m];
      for (int k = 1; k < dim; k++) c->g[a][q][m] += e->dN[p][a][k] * B[k][m];
    }
  }
  *volume *= e->weight[p];
  if (hoop) {
    Lanes radius = {0};

    for (int a = 0; a < n; a++) radius += e->N[p][a] * CONST_LANE(X, a * dim);
    *volume *= two_pi * radius;
    for (int a = 0; a < n; a++) c->g[a][q][2] = e->N[p][a] / radius;
  }
}

KERNEL_INLINE void PointDisplacementGradient(const int n, const int dim, const int hoop, int q, const double *u, const ChunkPoints *c, Lanes H[9])
{
  for (int r = 0; r < 9; r++) H[r] = (Lanes){0};
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < dim; i++) {
      for (int m = 0; m < dim; m++) H[3 * i + m] += CONST_LANE(u, a * dim + i) * c->g[a][q][m];
    }
    if (hoop) H[TENSOR_HOOP] += CONST_LANE(u, a * dim) * c->g[a][q][2];
  }
}

KERNEL_INLINE void AddForce(const int n, const int dim, const int hoop, int q, const ChunkPoints *c, const Lanes P[9], double *f)
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
KERNEL_INLINE void AddTangent(const int n, const int dim, const int hoop, const int count, const int first, const int last, const ChunkPoints *c, double *K)
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

/* Everything of the first LANES elements that the arrays show; n, points, dim and hoop are constants of the instance */
KERNEL_INLINE void Batch(const Element *e, const int n, const int points, const int dim, const int hoop, MaterialLawFn *law, int finite, const double *X,
                         const double *u, const Lanes *lambda, const Lanes *mu, double *W, double *f, double *K, double *J)
{
  ChunkPoints c;
  const Lanes zero = {0};

  if (W) LANE(W, 0) = zero;
  for (int i = 0; i < n * dim && f; i++) LANE(f, i) = zero;
  for (int lane = 0; lane < LANES; lane++) J[lane] = finite ? __DBL_MAX__ : 1;
  for (int first = 0; first < points; first += CHUNK) {
    const int count = points - first < CHUNK ? points - first : CHUNK;

    for (int q = 0; q < count; q++) {
      Lanes H[9], P[9], energy, volume, dilatation;

      PointGradients(e, n, dim, hoop, first + q, q, X, &c, &volume);
      PointDisplacementGradient(n, dim, hoop, q, u, &c, H);
      MaterialDilatation(H, &dilatation);
      for (int lane = 0; lane < LANES && finite; lane++) {
        if (!(1 + dilatation[lane] >= J[lane])) J[lane] = 1 + dilatation[lane]; /* written so that NaN gets through */
      }
      law(H, &dilatation, lambda, mu, W ? &energy : NULL, P, K ? c.A[q] : NULL);
      if (W) LANE(W, 0) += energy * volume;
      for (int r = 0; r < 9; r++) P[r] *= volume;
      if (f) AddForce(n, dim, hoop, q, &c, P, f);
      for (int k = 0; k < MATERIAL_TANGENT_SIZE && K; k++) c.A[q][k] *= volume;
    }
    if (K) AddTangent(n, dim, hoop, count, first == 0, first + count == points, &c, K);
  }
}

typedef void BatchFn(const Element *, MaterialLawFn *, int, const double *, const double *, const Lanes *, const Lanes *, double *, double *, double *,
                     double *);

#define BATCH_INSTANCE(name, nodes, points, dim, hoop)                                                                                                  \
  static void name(const Element *e, MaterialLawFn *law, int finite, const double *X, const double *u, const Lanes *lambda, const Lanes *mu, double *W, \
                   double *f, double *K, double *J)                                                                                                     \
  {                                                                                                                                                     \
    Batch(e, nodes, points, dim, hoop, law, finite, X, u, lambda, mu, W, f, K, J);                                                                      \
  }

BATCH_INSTANCE(BatchTri3, 3, 1, 2, 0)
BATCH_INSTANCE(BatchTri6, 6, 3, 2, 0)
BATCH_INSTANCE(BatchQuad4, 4, 4, 2, 0)
BATCH_INSTANCE(BatchQuad9, 9, 9, 2, 0)
BATCH_INSTANCE(BatchTri3Axisymmetric, 3, 1, 2, 1)
BATCH_INSTANCE(BatchTri6Axisymmetric, 6, 3, 2, 1)
BATCH_INSTANCE(BatchQuad4Axisymmetric, 4, 4, 2, 1)
BATCH_INSTANCE(BatchQuad9Axisymmetric, 9, 9, 2, 1)
BATCH_INSTANCE(BatchTet4, 4, 1, 3, 0)
BATCH_INSTANCE(BatchTet10, 10, 4, 3, 0)
BATCH_INSTANCE(BatchHex8, 8, 8, 3, 0)
BATCH_INSTANCE(BatchHex27, 27, 27, 3, 0)

static BatchFn *const batch_functions[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI3]  = {BatchTri3,  BatchTri3Axisymmetric },
  [ELEMENT_TRI6]  = {BatchTri6,  BatchTri6Axisymmetric },
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_QUAD9] = {BatchQuad9, BatchQuad9Axisymmetric},
  [ELEMENT_TET4]  = {BatchTet4,  NULL                  },
  [ELEMENT_TET10] = {BatchTet10, NULL                  },
  [ELEMENT_HEX8]  = {BatchHex8,  NULL                  },
  [ELEMENT_HEX27] = {BatchHex27, NULL                  },
};

/*
  ElementKernel - Energy, internal force and tangent of a batch of KERNEL_LANES elements, total Lagrangian

  Not collective

  Input:
+ kernel - element type, geometry, kinematics and law of the batch
. X      - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u      - displacements (length) [nodes][dim][lanes]
- E, nu  - Young's modulus (stress) and Poisson's ratio [lanes]

  Output:
+ W - strain energy [lanes], or NULL
. f - internal force [nodes][dim][lanes], or NULL
. K - tangent [nodes*dim][nodes*dim][lanes], or NULL
- J - smallest determinant of F over the quadrature points [lanes]; 1 for small kinematics

  Notes:
  2D solids have unit thickness; axisymmetric quantities are over 360 degrees. J <= 0, or NaN, means that the state is not admissible;
  all arrays hold finite numbers all the same if X and u do.

  Source: Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", sections 8.4 and 8.5 (reference configuration)
*/
void ElementKernel(const KernelCase *kernel, const double *X, const double *u, const double *E, const double *nu, double *W, double *f, double *K, double *J)
{
  const int      finite = kernel->kinematics == KINEMATICS_FINITE;
  const Element *e      = ElementGet(kernel->type);
  MaterialLawFn *law    = MaterialGetLaw(kernel->law, finite);
  BatchFn       *batch  = batch_functions[kernel->type][kernel->geometry == GEOMETRY_AXISYMMETRIC];

  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    Lanes lambda, mu;

    for (int lane = 0; lane < LANES; lane++) {
      double l, m;

      MaterialLame(E[part + lane], nu[part + lane], &l, &m);
      lambda[lane] = l;
      mu[lane]     = m;
    }
    batch(e, law, finite, X + part, u + part, &lambda, &mu, W ? W + part : NULL, f ? f + part : NULL, K ? K + part : NULL, J + part);
  }
}
