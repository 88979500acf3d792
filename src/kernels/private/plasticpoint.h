/* A point of a plastic law: trial state, and tangents at a given plastic state. Plain C. */
#pragma once
#include "kernels/vonmises.h"
#include "principal.h"
#include <math.h>

/* Smallest principal value of F Cp^-1 F^T whose logarithm is taken; smaller ones are replaced by it, as determinants
   below MATERIAL_LEAST_J are. */
static const double least_square = MATERIAL_LEAST_J * MATERIAL_LEAST_J;
/* A trial stress yields when it exceeds the yield stress by this part. An accepted state lies on the yield surface up
   to round-off and must be elastic when it is evaluated again. */
static const double yield_round_off = 1e-12;

/* What the return mapping of a trial state gives, the same in small and finite strains */
typedef struct {
  Lanes theta; /* deviatoric stress over that of the trial state */
  Lanes fall;  /* part by which the tangent along the trial stress is smaller: theta minus it is the tangent there */
  Lanes increment; /* of the equivalent plastic strain */
  Lanes work;      /* plastic work that does not follow from the equivalent plastic strain, to the end of the step */
  Lanes W;         /* deviatoric part of the incremental potential */
} Return;

/* Nothing flows in no time where there is an overstress. */
static inline int PlasticFlows(const Hardening *hardening, double dt)
{
  return hardening->overstress <= 0 || dt > 0;
}

/* Components of a symmetric tensor: xx yy zz xy yz xz */
static const int component[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/* The trial state in finite strains */
typedef struct {
  Lanes square[3];    /* principal values of b = F Cp^-1 F^T */
  Lanes strain[3];    /* half their logarithms */
  Lanes axis[3][3];   /* n: principal axes of b */
  Lanes pulled[3][3]; /* F^-1 n */
  Lanes deviator[3];  /* of the logarithmic strains */
  Lanes stress[3];    /* principal Kirchhoff stresses after the return */
  Lanes log_J;
} Trial;

/* Computes principal values and axes of F Cp^-1 F^T. Its difference to 1 is formed, so that small strains keep their
   digits. */
LANES_INLINE void TrialState(const Lanes H[9], const Lanes *dilatation, const Lanes state[], Trial *x)
{
  Lanes FC[9], b[6], mean;

  for (int i = 0; i < 3; i++) { /* F (Cp^-1 - 1) */
    for (int J = 0; J < 3; J++) {
      FC[3 * i + J] = state[component[i][J]];
      for (int K = 0; K < 3; K++) FC[3 * i + J] += H[3 * i + K] * state[component[K][J]];
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      Lanes sum = H[3 * i + j] + H[3 * j + i] + FC[3 * i + j];

      for (int K = 0; K < 3; K++) sum += (H[3 * i + K] + FC[3 * i + K]) * H[3 * j + K];
      b[component[i][j]] = sum;
    }
  }
  PrincipalAxes(b, x->square, x->axis);
  for (int lane = 0; lane < LANES; lane++) {
    x->log_J[lane] = log1p(fmax((*dilatation)[lane], MATERIAL_LEAST_J - 1));
    for (int a = 0; a < 3; a++) {
      const double excess = fmax(x->square[a][lane], least_square - 1);

      x->square[a][lane] = 1 + excess;
      x->strain[a][lane] = log1p(excess) / 2;
    }
  }
  mean = (x->strain[0] + x->strain[1] + x->strain[2]) / 3;
  for (int a = 0; a < 3; a++) x->deviator[a] = x->strain[a] - mean;
  for (int i = 0; i < 9; i++) FC[i] += H[i] + (double)(i % 4 == 0); /* F Cp^-1 */
  for (int a = 0; a < 3; a++) {                                     /* F^-1 n = Cp^-1 F^T n / b */
    for (int I = 0; I < 3; I++)
      x->pulled[a][I] = (FC[I] * x->axis[a][0] + FC[3 + I] * x->axis[a][1] + FC[6 + I] * x->axis[a][2]) / x->square[a];
  }
}

/* Piola-Kirchhoff stress from the principal Kirchhoff stresses */
LANES_INLINE void PrincipalStress(const Trial *x, Lanes P[9])
{
  for (int k = 0; k < 9; k++) {
    P[k] = x->stress[0] * x->axis[0][k / 3] * x->pulled[0][k % 3];
    for (int a = 1; a < 3; a++) P[k] += x->stress[a] * x->axis[a][k / 3] * x->pulled[a][k % 3];
  }
}

/* A += factor * v w^T + w v^T, or v v^T where v is w */
LANES_INLINE void AddDyad(const Lanes *factor, const Lanes v[9], const Lanes w[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  for (int r = 0, k = 0; r < 9; r++) {
    const Lanes vr = *factor * v[r], wr = *factor * w[r];

    for (int s = r; s < 9; s++, k++) A[k] += v == w ? vr * v[s] : vr * w[s] + wr * v[s];
  }
}

/* x / (exp(2 x) - 1), which is 1/2 at 0 */
static inline double ShearFactor(double x)
{
  return x == 0 ? 0.5 : x / expm1(2 * x);
}

/* Tangent in the frame of the principal axes: A = sum_abcd a_abcd (n_a x F^-1 n_b) (n_c x F^-1 n_d). The factors
   between two axes do not divide by the difference of their strains, because stress differences are strain differences
   times 2 shear theta. */
LANES_INLINE void FiniteTangent(const Lanes *bulk, const Lanes *shear, const Lanes *square, const Return *r,
                                const Trial *x, Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes zero = {0}, along = 2 * *shear * r->theta;
  Lanes       T[3][3][9], fall;

  for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) A[k] = zero;
  /* Not by the inverse of the square: it overflows at strains of 1e-160, which bodies without load have. */
  for (int lane = 0; lane < LANES; lane++)
    fall[lane] = (*square)[lane] > 0 ? 2 * (*shear)[lane] * r->fall[lane] / (*square)[lane] : 0;
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) {
      for (int k = 0; k < 9; k++) T[a][b][k] = x->axis[a][k / 3] * x->pulled[b][k % 3];
    }
  }
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++) { /* change of stress a with strain b, then the shear of both axes */
      Lanes normal = *bulk - along / 3 - fall * x->deviator[a] * x->deviator[b];
      Lanes factor, other, shear_ab;

      if (a == b) {
        normal += along - x->stress[a];
        AddDyad(&normal, T[a][a], T[a][a], A);
        continue;
      }
      AddDyad(&normal, T[a][a], T[b][b], A);
      for (int lane = 0; lane < LANES; lane++)
        factor[lane] = along[lane] * ShearFactor(x->strain[a][lane] - x->strain[b][lane]);
      shear_ab = factor - x->stress[b];
      other    = shear_ab + x->stress[a];
      AddDyad(&factor, T[a][b], T[a][b], A);
      AddDyad(&other, T[b][a], T[b][a], A);
      AddDyad(&shear_ab, T[a][b], T[b][a], A);
    }
  }
}

/* Tangent of small strains, with the deviatoric trial strain and its square */
LANES_INLINE void SmallTangent(const Lanes *bulk, const Lanes *shear, const Lanes *square, const Return *r,
                               const Lanes deviator[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes mu = *shear * r->theta, lambda = *bulk - 2 * mu / 3;
  Lanes       factor;

  for (int lane = 0; lane < LANES; lane++)
    factor[lane] = (*square)[lane] > 0 ? -2 * (*shear)[lane] * r->fall[lane] / (*square)[lane] : 0;
  for (int s = 0, k = 0; s < 9; s++) {
    for (int t = s; t < 9; t++, k++) {
      const int i = s / 3, I = s % 3, j = t / 3, J = t % 3;

      A[k] = lambda * (double)(i == I && j == J) + mu * (double)((i == j && I == J) + (i == J && j == I));
    }
  }
  AddDyad(&factor, deviator, deviator, A);
}
