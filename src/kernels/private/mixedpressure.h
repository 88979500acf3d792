/* The pressures of a batch of mixed elements: their shape functions, and pressures, their derivatives and the energy of
   the volume from J at the points. mixedkernel.c explains the method. Plain C, inlined like elementbatch.h. */
#pragma once
#include "elementbatch.h"
#include "mixedrule.h"
#include "volumehold.h"

enum { MAX_BUBBLE = 3 /* displacements of the inner node */ };

/* What a batch knows of its elements */
typedef struct {
  ChunkPoints c;
  double      X[ELEMENT_MAX_NODES * 3 * KERNEL_LANES]; /* with the inner node: X = 0, so that it does not count */
  double      u[ELEMENT_MAX_NODES * 3 * KERNEL_LANES];
  Lanes       volume[ELEMENT_MAX_POINTS];
  Lanes       H[ELEMENT_MAX_POINTS][9];                   /* while the bubble is solved for, without it */
  Lanes       bubble[ELEMENT_MAX_POINTS][3];              /* gradient of the bubble; axisymmetric: [2] is N / R */
  Lanes       shape[ELEMENT_MAX_POINTS][MIXED_PRESSURES]; /* orthonormal shape functions of the pressure */
  Lanes       centre[3];                                  /* about which they are linear */
  Lanes       L[MIXED_PRESSURES][MIXED_PRESSURES];        /* L L^T: matrix of their products before; 1/L_kk at k k */
  Lanes       theta[MIXED_PRESSURES], p[MIXED_PRESSURES]; /* of J - 1 and of the pressure */
  Lanes       C[MIXED_PRESSURES][MIXED_PRESSURES];        /* derivatives of p by theta */
  Lanes       hold;                                       /* modulus of volumehold.h */
  Lanes       geometric[MIXED_PRESSURES];                 /* of the pressure in the tangent's geometric part */
  Lanes       b[MAX_BUBBLE];
} Mixed;

LANES_INLINE Lanes Root(Lanes a)
{
  for (int lane = 0; lane < LANES; lane++) a[lane] = sqrt(a[lane]);
  return a;
}

/* Computes 1 and the coordinates about the centre at a point. */
LANES_INLINE void Monomials(const int nodes, const int modes, const int dim, const double *N, const Mixed *x,
                            Lanes phi[MIXED_PRESSURES])
{
  phi[0] = (Lanes){0} + 1;
  for (int k = 1; k < modes; k++) {
    phi[k] = -x->centre[k - 1];
    for (int a = 0; a < nodes; a++) phi[k] += N[a] * CONST_LANE(x->X, a * dim + k - 1);
  }
}

/* Makes monomials at a point into orthonormal shape functions: phi = L^-1 phi */
LANES_INLINE void Orthonormal(const int modes, const Mixed *x, Lanes phi[MIXED_PRESSURES])
{
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l < k; l++) phi[k] -= x->L[k][l] * phi[l];
    phi[k] *= x->L[k][k];
  }
}

/* Factors the matrix of the products of the monomials, and makes them orthonormal at all points. */
LANES_INLINE void PressureShapes(const int points, const int modes, Mixed *x)
{
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l <= k; l++) {
      x->L[k][l] = (Lanes){0};
      for (int q = 0; q < points; q++) x->L[k][l] += x->volume[q] * x->shape[q][k] * x->shape[q][l];
      for (int m = 0; m < l; m++) x->L[k][l] -= x->L[k][m] * x->L[l][m];
      x->L[k][l] = k == l ? 1 / Root(x->L[k][k]) : x->L[k][l] * x->L[l][l];
    }
  }
  for (int q = 0; q < points; q++) Orthonormal(modes, x, x->shape[q]);
}

/* Computes J - 1 at a point; with small strains it is the trace. */
LANES_INLINE void Dilatation(const BatchCall *call, const Lanes H[9], Lanes *dilatation)
{
  if (call->finite)
    MaterialDilatation(H, dilatation);
  else
    *dilatation = H[0] + H[4] + H[8];
}

LANES_INLINE Lanes LogVolume(Lanes dilatation)
{
  for (int lane = 0; lane < LANES; lane++) dilatation[lane] = log1p(FlooredDilatation(dilatation[lane]));
  return dilatation;
}

/* Computes the derivative G of J by F, the cofactors; with small strains it is the unit tensor. */
LANES_INLINE void DilatationGradient(const BatchCall *call, const Lanes H[9], Lanes G[9])
{
  if (call->finite) {
    Cofactors(H, G);
    return;
  }
  for (int r = 0; r < 9; r++) G[r] = (Lanes){0} + (double)(r % 4 == 0);
}

LANES_INLINE Lanes Multiplier(const BatchCall *call, int k)
{
  Lanes multiplier = {0};

  if (call->multiplier) multiplier = CONST_LANE(call->multiplier, k);
  return multiplier;
}

LANES_INLINE Lanes PressureAt(const int modes, const Lanes p[MIXED_PRESSURES], const Lanes shape[MIXED_PRESSURES])
{
  Lanes sum = p[0] * shape[0];

  for (int k = 1; k < modes; k++) sum += p[k] * shape[k];
  return sum;
}

/* Computes the pressures from theta, their derivatives by theta, and the energy of the volume. With small strains it is
   a square of theta. What holds J at the points (volumehold.h) is c/2 int (J - 1)^2 dV, which MixedLaw() adds there,
   less c/2 times the square of theta. */
LANES_INLINE void Pressures(const BatchCall *call, const int points, const int modes, Mixed *x, Lanes *W)
{
  *W = (Lanes){0};
  for (int k = 0; k < modes; k++) {
    x->p[k] = Multiplier(call, k);
    *W += x->theta[k] * x->p[k];
    for (int l = 0; l < modes; l++) x->C[k][l] = (Lanes){0};
    if (call->finite) continue;
    x->p[k] += call->kappa * x->theta[k];
    x->C[k][k] = call->kappa;
    *W += 0.5 * call->kappa * x->theta[k] * x->theta[k];
  }
  for (int k = 0; k < modes && call->hold; k++) {
    x->p[k] -= x->hold * x->theta[k];
    x->C[k][k] -= x->hold;
    *W -= 0.5 * x->hold * x->theta[k] * x->theta[k];
  }
  for (int q = 0; q < points && call->finite; q++) {
    const Lanes dilatation = PressureAt(modes, x->theta, x->shape[q]), log_j = LogVolume(dilatation);
    const Lanes weight = call->kappa * x->volume[q];
    Lanes       inverse;

    for (int lane = 0; lane < LANES; lane++) inverse[lane] = 1 / (1 + FlooredDilatation(dilatation[lane]));
    *W += 0.5 * weight * log_j * log_j;
    for (int k = 0; k < modes; k++) {
      const Lanes part = weight * x->shape[q][k] * inverse;

      x->p[k] += part * log_j;
      for (int l = 0; l < modes; l++) x->C[k][l] += part * x->shape[q][l] * inverse * (1 - log_j);
    }
  }
}

/* Adds second derivatives of J times the pressure to a tangent of the law: those of J by F_iI and F_kK are components
   of F. */
LANES_INLINE void AddGeometry(const Lanes *pressure, const Lanes H[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  for (int r = 0; r < 9; r++) {
    for (int s = r + 1; s < 9; s++) {
      const int i = r / 3, k = s / 3, I = r % 3, K = s % 3, rest = 3 * (3 - i - k) + 3 - I - K;

      if (i == k || I == K) continue;
      if (((k - i) % 3 + 3) % 3 == ((K - I) % 3 + 3) % 3)
        A[MATERIAL_TANGENT_INDEX(r, s)] += *pressure * (H[rest] + (double)(rest % 4 == 0));
      else
        A[MATERIAL_TANGENT_INDEX(r, s)] -= *pressure * (H[rest] + (double)(rest % 4 == 0));
    }
  }
}

/* Evaluates the law at a point, as PointLaw(), and what holds J there. */
LANES_INLINE void MixedLaw(const BatchCall *call, const Lanes *hold, int q, const Lanes H[9], const Lanes *dilatation,
                           Lanes *W, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes G[9], stress;

  PointLaw(call, q, H, dilatation, W, P, A);
  if (!call->hold) return;
  Cofactors(H, G);
  stress = HoldStress(call, q, hold, dilatation);
  if (W) *W += HoldEnergy(call, q, hold, dilatation);
  for (int r = 0; r < 9; r++) P[r] += stress * G[r];
  if (!A) return;
  AddGeometry(&stress, H, A);
  for (int r = 0, k = 0; r < 9; r++)
    for (int s = r; s < 9; s++, k++) A[k] += *hold * G[r] * G[s];
}
