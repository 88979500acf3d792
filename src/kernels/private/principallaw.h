/* What the laws in principal stretches share: P and its tangent from the principal Kirchhoff stresses tau_a and their
   derivatives by y_a = ln lambda_a. Plain C. LANES points are treated at a time.

   A law calls Directions(), computes its PrincipalStress from y, and calls PrincipalForce() and PrincipalTangent(). Two
   equal stretches need no case of their own: all differences are written with sinh(z) / z, which is a series where z is
   small. Source: Ogden, "Non-linear elastic deformations", section 6.1.4. */
#pragma once
#include "isochoriclaw.h"
#include "principalstretches.h"

/* Least square of a stretch at which the logarithm is evaluated, for states that a line search evaluates and that are
   never accepted, see MATERIAL_LEAST_J */
static const double least_square = MATERIAL_LEAST_J * MATERIAL_LEAST_J;
/* Largest exponent of a stretch: above it numbers are not finite. No state with such an energy is accepted. */
static const double most_exponent = 300;
/* Below this z, sinh(z) / z is evaluated by its series. Both have errors of a few units of rounding there. */
static const double series_end = 0.1;

typedef struct {
  LawMotion m;
  Lanes     n[3][3]; /* [i][a]: principal directions in space */
  Lanes     N[3][3]; /* [I][a]: in the reference configuration */
  Lanes     stretch[3], y[3];
} Principal;

/* Stresses and stiffnesses by y. slope[c] is (tau_a - tau_b) / (y_a - y_b) of the two directions other than c. */
typedef struct {
  Lanes W, tau[3], stiffness[3][3], slope[3];
} PrincipalStress;

LANES_INLINE void Directions(const Lanes H[9], const Lanes *dilatation, Principal *x)
{
  Lanes square[3];

  LawMotionStart(H, dilatation, &x->m);
  PrincipalValues(x->m.e, square, x->n);
  for (int a = 0; a < 3; a++) {
    for (int lane = 0; lane < LANES; lane++) {
      const double less_1 = square[a][lane] > least_square - 1 ? square[a][lane] : least_square - 1;

      x->y[a][lane]       = log1p(less_1) / 2;
      x->stretch[a][lane] = sqrt(1 + less_1);
    }
    for (int I = 0; I < 3; I++)
      x->N[I][a] = (x->m.F[I] * x->n[0][a] + x->m.F[3 + I] * x->n[1][a] + x->m.F[6 + I] * x->n[2][a]) / x->stretch[a];
  }
}

/* Computes factor sinh(z) / z from difference = 2 factor sinh(z), which cancels where z is small. */
static inline double SinhOver(double z, double factor, double difference)
{
  const double z2 = z * z;

  if (z2 > series_end * series_end) return difference / (2 * z);
  return factor * (1 + z2 / 6 * (1 + z2 / 20 * (1 + z2 / 42 * (1 + z2 / 72))));
}

/* P = sum_a tau_a n_a (x) n_a F^-T */
LANES_INLINE void PrincipalForce(const Principal *x, const PrincipalStress *p, Lanes P[9])
{
  Lanes tau[9];

  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      Lanes sum = p->tau[0] * x->n[i][0] * x->n[j][0];

      for (int a = 1; a < 3; a++) sum += p->tau[a] * x->n[i][a] * x->n[j][a];
      tau[3 * i + j] = tau[3 * j + i] = sum;
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      P[3 * i + j] = tau[3 * i] * x->m.G[j] + tau[3 * i + 1] * x->m.G[3 + j] + tau[3 * i + 2] * x->m.G[6 + j];
  }
}

/* With M_ab = n_a (x) N_b the tangent is sum_ab (stiffness_ab - tau_a d_ab) / (lambda_a lambda_b) M_aa (x) M_bb and,
   for each pair a < b, R (M_ab (x) M_ab + M_ba (x) M_ba) + T (M_ab (x) M_ba + M_ba (x) M_ab) with R = (tau_a - tau_b) /
   (lambda_a^2 - lambda_b^2) and T = ((lambda_a^2 + lambda_b^2) R - tau_a - tau_b) / (2 lambda_a lambda_b). R is the
   slope over 2 lambda_a lambda_b sinh(y_a - y_b) / (y_a - y_b). */
LANES_INLINE void PrincipalTangent(const Principal *x, const PrincipalStress *p, Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes *l = x->stretch;
  Lanes        M[3][3][9], Y[3][9], R[3], T[3];

  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) {
      for (int r = 0; r < 9; r++) M[a][b][r] = x->n[r / 3][a] * x->N[r % 3][b];
    }
  }
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;

    for (int r = 0; r < 9; r++) {
      Y[a][r] = (p->stiffness[a][a] - p->tau[a]) / (l[a] * l[a]) * M[a][a][r];
      for (int d = b; d != a; d = (d + 1) % 3) Y[a][r] += p->stiffness[a][d] / (l[a] * l[d]) * M[d][d][r];
    }
    for (int lane = 0; lane < LANES; lane++) {
      const double z = x->y[b][lane] - x->y[c][lane], ratio = l[b][lane] / l[c][lane];

      R[a][lane] = p->slope[a][lane] / (2 * l[b][lane] * l[c][lane] * SinhOver(z, 1, ratio - 1 / ratio));
    }
    T[a] = ((l[b] * l[b] + l[c] * l[c]) * R[a] - p->tau[b] - p->tau[c]) / (2 * l[b] * l[c]);
  }
  for (int r = 0, k = 0; r < 9; r++) {
    for (int s = r; s < 9; s++, k++) {
      A[k] = (Lanes){0};
      for (int a = 0; a < 3; a++) {
        const int    b = (a + 1) % 3, c = (a + 2) % 3;
        const Lanes *one = M[b][c], *other = M[c][b];

        A[k] += M[a][a][r] * Y[a][s] + one[r] * (R[a] * one[s] + T[a] * other[s]) +
                other[r] * (R[a] * other[s] + T[a] * one[s]);
      }
    }
  }
}
