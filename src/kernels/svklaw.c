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

const ElasticLaw MaterialLaw_Svk = {.evaluate = Evaluate, .shear = MaterialLameShear, .constants = 2};
