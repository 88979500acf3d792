/* What the laws with a separate volume part share: W = w(x1, x2) + K/2 (ln J)^2 with the invariants of the part of F
   that keeps the volume, x1 = J^(-2/3) I1 - 3 and x2 = J^(-4/3) I2 - 3. Plain C. LANES points are treated at a time.

   A law calls IsochoricStart(), computes its w with derivatives from x1 and x2, and calls IsochoricFinish().
   `second` is a constant of the law: whether w depends on x2. VolumePart() alone is for laws in principal stretches.
   Source: Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", section 6.5. */
#pragma once
#include "kernels/material.h"
#include <math.h>
#include <stddef.h>

/* The motion at a point: e = F F^T - 1 keeps the digits of small strains. G = F^-T. */
typedef struct {
  Lanes F[9], G[9], e[9], log_J, trace; /* trace of e */
} LawMotion;

typedef struct {
  LawMotion m;
  Lanes     shrink;       /* J^(-2/3) */
  Lanes     x1, x2;       /* invariants */
  Lanes     D1[9], D2[9]; /* their derivatives by F */
} Isochoric;

/* w and its derivatives by x1 and x2 */
typedef struct {
  Lanes w, w1, w2, w11, w12, w22;
} IsochoricEnergy;

/* Where det(b) - 1 is smaller than this, it is taken from e = b - 1. Of larger ones det(F) keeps more digits. */
static const double small_square = 0.5;

/* Computes ln J = ln(det b)/2 from e = b - 1, b = F F^T. Differences of ln J and invariants of e then keep their digits
   where a body turns: the round-off of e, which is that of numbers about 1, is the same in both. */
LANES_INLINE void LogarithmOfVolume(const Lanes *dilatation, const Lanes e[9], Lanes *log_J)
{
  const Lanes m0 = e[4] * e[8] - e[5] * e[7], m1 = e[5] * e[6] - e[3] * e[8], m2 = e[3] * e[7] - e[4] * e[6];
  const Lanes less_1 = e[0] + e[4] + e[8] + m0 + (e[0] * e[4] - e[1] * e[3]) + (e[0] * e[8] - e[2] * e[6]) +
                       e[0] * m0 + e[1] * m1 + e[2] * m2;

  for (int lane = 0; lane < LANES; lane++) {
    const double less = (*dilatation)[lane];

    if (!(1 + less > MATERIAL_LEAST_J))
      (*log_J)[lane] = log(MATERIAL_LEAST_J);
    else
      (*log_J)[lane] = fabs(less_1[lane]) < small_square ? 0.5 * log1p(less_1[lane]) : log1p(less);
  }
}

LANES_INLINE void LawMotionStart(const Lanes H[9], const Lanes *dilatation, LawMotion *m)
{
  Lanes inverse_J;

  for (int r = 0; r < 9; r++) m->F[r] = H[r] + (double)(r % 4 == 0);
  for (int lane = 0; lane < LANES; lane++) {
    const double J = 1 + (*dilatation)[lane];

    inverse_J[lane] = 1 / (J > MATERIAL_LEAST_J ? J : MATERIAL_LEAST_J);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      m->G[3 * i + j] = inverse_J * (m->F[i1 + j1] * m->F[i2 + j2] - m->F[i1 + j2] * m->F[i2 + j1]);
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      m->e[3 * i + j] = m->e[3 * j + i] =
        H[3 * i + j] + H[3 * j + i] + H[3 * i] * H[3 * j] + H[3 * i + 1] * H[3 * j + 1] + H[3 * i + 2] * H[3 * j + 2];
  }
  m->trace = m->e[0] + m->e[4] + m->e[8];
  LogarithmOfVolume(dilatation, m->e, &m->log_J);
}

/* D = factor (dev M) G with a symmetric M */
LANES_INLINE void DeviatorTimesG(const Lanes M[9], const Lanes *factor, const Lanes G[9], Lanes D[9])
{
  const Lanes mean = (M[0] + M[4] + M[8]) / 3;

  for (int i = 0; i < 3; i++) {
    Lanes row[3];

    for (int k = 0; k < 3; k++) row[k] = *factor * (M[3 * i + k] - (k == i ? mean : (Lanes){0}));
    for (int j = 0; j < 3; j++) D[3 * i + j] = row[0] * G[j] + row[1] * G[3 + j] + row[2] * G[6 + j];
  }
}

/* J^(-2/3) I1 - 3 = 3 (J^(-2/3) - 1) + J^(-2/3) tr e. With b = 1 + e, the derivatives are 2 J^(-2/3) dev(e) G and
   2 J^(-4/3) dev((1 + tr e) e - e^2) G, and I2 = 3 + 2 tr e + ((tr e)^2 - e : e) / 2. */
LANES_INLINE void IsochoricStart(const Lanes H[9], const Lanes *dilatation, const int second, Isochoric *x)
{
  Lanes shrink_less_1, factor;

  LawMotionStart(H, dilatation, &x->m);
  for (int lane = 0; lane < LANES; lane++) shrink_less_1[lane] = expm1(-2 * x->m.log_J[lane] / 3);
  x->shrink = 1 + shrink_less_1;
  x->x1     = 3 * shrink_less_1 + x->shrink * x->m.trace;
  x->x2     = (Lanes){0};
  factor    = 2 * x->shrink;
  DeviatorTimesG(x->m.e, &factor, x->m.G, x->D1);
  if (second) {
    const Lanes *e = x->m.e, trace = x->m.trace;
    Lanes        M[9], square      = {0};

    for (int i = 0; i < 3; i++) {
      for (int j = i; j < 3; j++)
        M[3 * i + j] = M[3 * j + i] =
          (1 + trace) * e[3 * i + j] - e[3 * i] * e[3 * j] - e[3 * i + 1] * e[3 * j + 1] - e[3 * i + 2] * e[3 * j + 2];
    }
    for (int r = 0; r < 9; r++) square += e[r] * e[r];
    x->x2  = 3 * shrink_less_1 * (1 + x->shrink) + x->shrink * x->shrink * (2 * trace + 0.5 * (trace * trace - square));
    factor = 2 * x->shrink * x->shrink;
    DeviatorTimesG(M, &factor, x->m.G, x->D2);
  }
}

/* Adds the volume part K/2 (ln J)^2 to P, and to W and A where they are not NULL. */
LANES_INLINE void VolumePart(const LawMotion *m, const Lanes *K, Lanes *W, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes *G = m->G, pressure = *K * m->log_J;

  if (W) *W += 0.5 * pressure * m->log_J;
  for (int r = 0; r < 9; r++) P[r] += pressure * G[r];
  for (int r = 0, k = 0; r < 9 && A; r++) {
    const Lanes K_G = *K * G[r];

    for (int s = r; s < 9; s++, k++) A[k] += K_G * G[s] - pressure * G[3 * (r / 3) + s % 3] * G[3 * (s / 3) + r % 3];
  }
}

/* Tangent of w. The second derivatives of the invariants by F_iI (index r) and F_jJ (index s) are
   J^(-2/3) [2 d_ij d_IJ - 4/3 (F_r G_s + G_r F_s) + 4/9 I1 G_r G_s + 2/3 I1 G_iJ G_jI] and
   J^(-4/3) [2 (2 F_r F_s + I1 d_ij d_IJ - d_ij C_IJ - F_iJ F_jI - d_IJ b_ij) - 8/3 (B_r G_s + G_r B_s)
   + 16/9 I2 G_r G_s + 4/3 I2 G_iJ G_jI] with B = (I1 - b) F. */
LANES_INLINE void IsochoricTangent(const Isochoric *x, const int second, const IsochoricEnergy *w,
                                   Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes *F = x->m.F, *G = x->m.G, *e = x->m.e;
  const Lanes  I1 = 3 + x->m.trace, a = w->w1 * x->shrink, b = w->w2 * x->shrink * x->shrink;
  Lanes        B[9], C[9], Y[9], square = {0}, I2 = {0}, GG, turned;

  if (second) {
    for (int r = 0; r < 9; r++) square += e[r] * e[r];
    I2 = 3 + 2 * x->m.trace + 0.5 * (x->m.trace * x->m.trace - square);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        C[3 * i + j] = F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j];
        B[3 * i + j] = (I1 - 1) * F[3 * i + j] - e[3 * i] * F[j] - e[3 * i + 1] * F[3 + j] - e[3 * i + 2] * F[6 + j];
      }
    }
  }
  GG     = 4. / 9 * a * I1 + 16. / 9 * b * I2;
  turned = 2. / 3 * a * I1 + 4. / 3 * b * I2;
  for (int r = 0; r < 9; r++) {
    Y[r] = -4. / 3 * a * F[r];
    if (second) Y[r] -= 8. / 3 * b * B[r];
  }
  for (int r = 0, k = 0; r < 9; r++) {
    for (int s = r; s < 9; s++, k++) {
      const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

      A[k] = Y[r] * G[s] + G[r] * Y[s] + GG * G[r] * G[s] + turned * G[3 * i + J] * G[3 * j + I] +
             w->w11 * x->D1[r] * x->D1[s];
      if (r == s) A[k] += 2 * a;
      if (!second) continue;
      A[k] += w->w12 * (x->D1[r] * x->D2[s] + x->D2[r] * x->D1[s]) + w->w22 * x->D2[r] * x->D2[s] +
              2 * b * (2 * F[r] * F[s] - F[3 * i + J] * F[3 * j + I]);
      if (r == s) A[k] += 2 * b * I1;
      if (i == j) A[k] -= 2 * b * C[3 * I + J];
      if (I == J) A[k] -= 2 * b * (e[3 * i + j] + (double)(i == j));
    }
  }
}

LANES_INLINE void IsochoricFinish(const Isochoric *x, const int second, const IsochoricEnergy *w, const Lanes *K,
                                  Lanes *W, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  if (W) *W = w->w;
  for (int r = 0; r < 9; r++) {
    P[r] = w->w1 * x->D1[r];
    if (second) P[r] += w->w2 * x->D2[r];
  }
  if (A) IsochoricTangent(x, second, w, A);
  VolumePart(&x->m, K, W, P, A);
}
