/* Functions that the element kernels of all formulations share. Plain C. They are always inlined with constant sizes
   for each element, so that the compiler unrolls the inner loops. Every arithmetic operation acts on LANES elements,
   which are a whole batch or a part of it.

   The tangent of a pair of nodes is g_a . A . g_b with the law's symmetric 9 x 9 tangent A and reference gradients g.
   This costs as much as the closed forms of special laws, and it is the same code for all laws. T = A . g_b is formed
   once for each node b and point. */
#pragma once
#include "kernels/elementkernel.h"
#include <math.h>
#include <stddef.h>

/* CHUNK: number of points that are treated together. A, T and g of a chunk stay in the first-level cache. The blocks of
   K of a hex27 do not fit there; they are loaded and stored once for each chunk.
   TENSOR_HOOP: place of the hoop component in a 3 x 3 tensor. MAX_ROWS: rows of the gradient operator in 3D. */
enum { CHUNK = 9, TENSOR_HOOP = 8, MAX_ROWS = 9 };

_Static_assert(KERNEL_LANES % LANES == 0, "a batch consists of whole vectors");

/* Vector number index of an array of the batch. The array need not be aligned. */
#define LANE(array, index)       (*(LanesInArray *)((array) + (index) * KERNEL_LANES))
#define CONST_LANE(array, index) (*(const LanesInArray *)((array) + (index) * KERNEL_LANES))

/* Component of a 3 x 3 tensor that is row r of the gradient operator. In 2D there are 4 rows in the plane. Axisymmetric
   elements have a fifth row, the hoop component. */
#define TENSOR_ROW(dim, r) ((dim) == 3 ? (r) : (r) == 4 ? TENSOR_HOOP : 3 * ((r) / 2) + (r) % 2)
#define TANGENT(A, r, s)   ((A)[(r) <= (s) ? MATERIAL_TANGENT_INDEX(r, s) : MATERIAL_TANGENT_INDEX(s, r)])

static const double two_pi = 6.28318530717958647693;

typedef struct {
  Lanes g[ELEMENT_MAX_NODES][CHUNK][3];  /* reference gradient; axisymmetric: [2] is N_a / R */
  Lanes A[CHUNK][MATERIAL_TANGENT_SIZE]; /* times weight and volume */
} ChunkPoints;

/* One call treats LANES elements of a batch. H[points][9] is the displacement gradient at which the law is evaluated.
   W, f, K and H may be NULL; ElementKernel() explains them. */
typedef struct {
  const Element      *e;
  const ElasticLaw   *law;
  int                 finite, n_constants;
  int                 thin;   /* of KernelCase */
  Lanes               across; /* where it is thin: nu/(1 - nu) of the undeformed state */
  const Lanes        *constants;
  const PlasticBatch *plastic;
  const double       *state;        /* of a plastic law [points][states], or NULL; its first lane */
  int                 states, part; /* part: of the batch, its first lane */
  int                 hold;         /* where volumehold.h has its numbers in the state of a point; 0: nowhere */
  int                 all;          /* H takes all points of the state */
  int                *fault;        /* [LANES], UmatFaultAt() where a routine of the user fails, or NULL */
  const double       *X, *u;
  const double       *u_0;  /* displacements from which K extrapolates the stress, or NULL */
  double              rate; /* of StressReference */
  double             *W, *f, *K, *J, *H;
  double             *off; /* J less its projection, with hold [points]; or NULL */
  /* Of mixed elements: the part kappa of the modulus of the volume, shear modulus, multipliers or NULL, and results or
     NULL: theta [MIXED_PRESSURES], which mixedkernel.c explains, the pressure at the points of H, and the
     pressures extrapolated from u_0 [MIXED_PRESSURES]. constants[0] is then the local part of VolumeModuli. */
  Lanes         kappa, mu, rest; /* rest: 1 - kappa / projected part */
  Lanes         modulus;         /* the projected part */
  double        length;          /* of KernelCase */
  int           component;       /* of KernelCase */
  const double *multiplier;
  int           held; /* of StressReference */
  double       *theta, *pressure, *follow;
  /* Of routines of users whose tangent is not symmetric: the skew part of dP/dH at the points, which PointUmat() sets,
     else NULL */
  Lanes (*skew)[UMAT_SKEW_SIZE];
} BatchCall;

/* Computes the reference gradients of all nodes at a point with shape functions N and dN. They become point q of the
   chunk. volume is the reference volume of the point. */
LANES_INLINE void PointGradients(const int n, const int dim, const int hoop, const double *N, const double (*dN)[3],
                                 double weight, int q, const double *X, ChunkPoints *c, Lanes *volume)
{
  Lanes G[3][3] = {{{0}}}, B[3][3], inverse;

  for (int a = 0; a < n; a++) {
    for (int k = 0; k < dim; k++) {
      for (int m = 0; m < dim; m++) G[k][m] += dN[a][k] * CONST_LANE(X, a * dim + m);
    }
  }
  if (dim == 3) { /* B holds the cofactors of G */
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

/* Writes the derivatives of the displacement gradient at point q of a chunk by the displacements of the nodes. */
LANES_INLINE void PointGradientDerivatives(const int n, const int dim, const int hoop, int q, const ChunkPoints *c,
                                           Lanes V[][9])
{
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < dim; i++) {
      for (int r = 0; r < 9; r++) V[a * dim + i][r] = (Lanes){0};
      for (int m = 0; m < dim; m++) V[a * dim + i][3 * i + m] = c->g[a][q][m];
    }
    if (hoop) V[a * dim][TENSOR_HOOP] = c->g[a][q][2];
  }
}

static inline double FlooredDilatation(double dilatation)
{
  return dilatation > MATERIAL_LEAST_J - 1 ? dilatation : MATERIAL_LEAST_J - 1;
}

/* Computes the cofactors of F = 1 + H, which are J F^-T. */
LANES_INLINE void Cofactors(const Lanes H[9], Lanes C[9])
{
  Lanes F[9];

  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      C[3 * i + j] = F[i1 + j1] * F[i2 + j2] - F[i1 + j2] * F[i2 + j1];
    }
  }
}

/* Computes J - 1 at the gradient H_0 of an earlier state and the linear change of J from there to H. */
LANES_INLINE void ChangeOfVolume(const Lanes H[9], const Lanes H_0[9], Lanes *dilatation_0, Lanes *change)
{
  Lanes C[9];

  MaterialDilatation(H_0, dilatation_0);
  Cofactors(H_0, C);
  *change = C[0] * (H[0] - H_0[0]);
  for (int r = 1; r < 9; r++) *change += C[r] * (H[r] - H_0[r]);
}

/* Computes what the extrapolated pressure is above that of the state with `dilatation`. Pressure is dU/d(ln J) for the
   energy U = constants[0]/2 (ln J)^2. */
LANES_INLINE void ExcessPressure(const BatchCall *call, const Lanes *dilatation, const Lanes *dilatation_0,
                                 const Lanes *change, Lanes *excess)
{
  for (int lane = 0; lane < LANES; lane++) {
    const double before = FlooredDilatation((*dilatation_0)[lane]), now = FlooredDilatation((*dilatation)[lane]);

    (*excess)[lane] =
      call->constants[0][lane] * (log1p(before) + call->rate * (*change)[lane] / (1 + before) - log1p(now));
  }
}

/* Puts the stress that extrapolates from H_0 into the geometric part of the law's tangent A at a point with gradient H.
 */
LANES_INLINE void PointExtrapolate(const BatchCall *call, const Lanes H[9], const Lanes *dilatation, const Lanes H_0[9],
                                   Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes dilatation_0, change, excess, C[9];

  if (call->law->extrapolate) {
    call->law->extrapolate(H, H_0, call->rate, call->constants, A);
    return;
  }
  ChangeOfVolume(H, H_0, &dilatation_0, &change);
  ExcessPressure(call, dilatation, &dilatation_0, &change, &excess);
  Cofactors(H, C);
  for (int lane = 0; lane < LANES; lane++) {
    const double J = 1 + FlooredDilatation((*dilatation)[lane]);

    excess[lane] /= J * J; /* F^-T = C / J enters twice */
  }
  for (int r = 0, k = 0; r < 9; r++)
    for (int s = r; s < 9; s++, k++) A[k] -= excess * C[3 * (r / 3) + s % 3] * C[3 * (s / 3) + r % 3];
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

/* Adds the chunk's points to the blocks (a, b), a <= b, of K. The last chunk also writes the blocks (b, a). */
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

/* The smallest determinant starts above any determinant. In small kinematics it is 1. */
LANES_INLINE void StartLeastJ(const BatchCall *call)
{
  for (int lane = 0; lane < LANES; lane++) call->J[lane] = call->finite ? __DBL_MAX__ : 1;
}

LANES_INLINE void KeepLeastJ(const BatchCall *call, const Lanes *dilatation)
{
  for (int lane = 0; lane < LANES && call->finite; lane++) {
    if (!(1 + (*dilatation)[lane] >= call->J[lane]))
      call->J[lane] = 1 + (*dilatation)[lane]; /* the negated comparison lets NaN through */
  }
}

UmatPlace UmatPlaceAt(const Element *, int finite, const PlasticBatch *, int number, int p, const double *X,
                      const double *u, int stride);
void      PointUmat(const BatchCall *, int p, const Lanes H[9], double *next, Lanes *W, Lanes P[9],
                    Lanes A[MATERIAL_TANGENT_SIZE]);
void      AddSkewTangent(const BatchCall *, int hoop);
void      AddSkewPoint(int dofs, Lanes V[][9], const Lanes skew[UMAT_SKEW_SIZE], const Lanes *volume, double *K);

/* Evaluates the law at quadrature point p of the element. */
LANES_INLINE void PointLaw(const BatchCall *call, int p, const Lanes H[9], const Lanes *dilatation, Lanes *W,
                           Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  if (call->state && call->plastic->umat)
    PointUmat(call, p, H, NULL, W, P, A);
  else if (call->state) {
    Lanes state[PLASTIC_MAX_STATE];

    for (int k = 0; k < call->states; k++) state[k] = CONST_LANE(call->state, p * call->states + k);
    VonMisesLaw(call->finite, H, dilatation, &call->constants[0], &call->constants[1], call->plastic->hardening,
                call->plastic->dt, state, W, P, A, NULL);
  } else
    call->law->evaluate(H, dilatation, call->n_constants, call->constants, W, P, A);
}

LANES_INLINE void StorePoint(const BatchCall *call, int p, const Lanes H[9])
{
  for (int r = 0; r < 9; r++) LANE(call->H, p * 9 + r) = H[r];
}

typedef void BatchFn(const BatchCall *);

/* Instances by element and geometry (1 is axisymmetric), NULL where a formulation has none */
extern BatchFn *const enhanced_batches[ELEMENT_TYPES][2];
extern BatchFn *const mean_dilatation_batches[ELEMENT_TYPES][2];
extern BatchFn *const mixed_batches[ELEMENT_TYPES][2];
extern BatchFn *const nodal_pressure_batches[ELEMENT_TYPES][2];
extern BatchFn *const taylor_hood_batches[ELEMENT_TYPES][2];
extern const int      mixed_pressures[ELEMENT_TYPES];

int  MixedPoints(const Element *);
void MixedPointVolumes(const Element *, Geometry, const double *X, double *volume);
