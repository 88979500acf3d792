/* St. Venant-Kirchhoff's law: S = lambda tr(E) 1 + 2 mu E with Green's strain E, P = F S. Source: Bonet and Wood,
   "Nonlinear Continuum Mechanics for Finite Element Analysis", section 6.4. */
#include "kernels/material.h"
#include "lameconstants.h"
#include <stddef.h>

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes lambda = constants[0], mu = constants[1];
  Lanes       F[9], E[9], S[9], trace;

  (void)dilatation, (void)n;
  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      E[3 * i + j] = E[3 * j + i] =
        0.5 * (H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] + H[6 + i] * H[6 + j]);
  }
  trace = E[0] + E[4] + E[8];
  for (int r = 0; r < 9; r++) S[r] = 2 * mu * E[r] + lambda * trace * (double)(r % 4 == 0);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) P[3 * i + j] = F[3 * i] * S[j] + F[3 * i + 1] * S[3 + j] + F[3 * i + 2] * S[6 + j];
  }
  if (W) {
    *W = S[0] * E[0];
    for (int r = 1; r < 9; r++) *W += S[r] * E[r];
    *W *= 0.5;
  }
  if (A) { /* A_iIjJ = delta_ij S_IJ + lambda F_iI F_jJ + mu (F_iJ F_jI + b_ij delta_IJ), b = F F^T */
    Lanes b[9];

    for (int i = 0; i < 3; i++) {
      for (int j = i; j < 3; j++)
        b[3 * i + j] = b[3 * j + i] =
          mu * (F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2]);
    }
    for (int r = 0, k = 0; r < 9; r++) {
      const Lanes lambda_F = lambda * F[r];

      for (int s = r; s < 9; s++, k++) {
        const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

        A[k] = lambda_F * F[s] + mu * F[3 * i + J] * F[3 * j + I];
        if (i == j) A[k] += S[3 * I + J];
        if (I == J) A[k] += b[3 * i + j];
      }
    }
  }
}

/* Green's strain is quadratic in u. Linearly extrapolated from H_0 it lacks D = (H - H_0)^T (H - H_0) / 2, and
   unchanged from there it lacks the change of E. The stress lacks what Hooke's law makes of D. */
static void Extrapolate(const Lanes H[9], const Lanes H_0[9], double rate, const Lanes constants[],
                        Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes d[9], D[9], F[9], S[9], trace;

  for (int r = 0; r < 9; r++) d[r] = H[r] - H_0[r];
  for (int r = 0; r < 9; r++) F[r] = (1 - rate) * (H_0[r] + (double)(r % 4 == 0)); /* D += sym F_0^T d at rate 0 */
  for (int I = 0; I < 3; I++) {
    for (int J = I; J < 3; J++)
      D[3 * I + J] = D[3 * J + I] =
        0.5 * (d[I] * d[J] + d[3 + I] * d[3 + J] + d[6 + I] * d[6 + J] + F[I] * d[J] + F[3 + I] * d[3 + J] +
               F[6 + I] * d[6 + J] + d[I] * F[J] + d[3 + I] * F[3 + J] + d[6 + I] * F[6 + J]);
  }
  trace = D[0] + D[4] + D[8];
  for (int r = 0; r < 9; r++) S[r] = 2 * constants[1] * D[r] + constants[0] * trace * (double)(r % 4 == 0);
  for (int r = 0, k = 0; r < 9; r++) {
    for (int s = r; s < 9; s++, k++) {
      if (r / 3 == s / 3) A[k] -= S[3 * (r % 3) + s % 3];
    }
  }
}

const ElasticLaw MaterialLaw_Svk = {.evaluate    = Evaluate,
                                    .extrapolate = Extrapolate,
                                    .shear       = MaterialLameShear,
                                    .constants   = 2,
                                    .keys        = {"mu"},
                                    .required    = 1};
