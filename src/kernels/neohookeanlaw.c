/* The compressible neo-Hookean law W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2. Source: Bonet and Wood, "Nonlinear
   Continuum Mechanics for Finite Element Analysis", section 6.4.3. */
#include "kernels/material.h"
#include "lameconstants.h"
#include <math.h>
#include <stddef.h>

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes lambda = constants[0], mu = constants[1];
  Lanes       F[9], G[9], logJ, inverseJ, pressure; /* G = F^-T */

  (void)n;
  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int lane = 0; lane < LANES; lane++) {
    const double J = 1 + (*dilatation)[lane];

    inverseJ[lane] = 1 / (J > MATERIAL_LEAST_J ? J : MATERIAL_LEAST_J);
    logJ[lane]     = J > MATERIAL_LEAST_J ? log1p((*dilatation)[lane]) : log(MATERIAL_LEAST_J);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      G[3 * i + j] = inverseJ * (F[i1 + j1] * F[i2 + j2] - F[i1 + j2] * F[i2 + j1]);
    }
  }
  pressure = lambda * logJ;
  for (int i = 0; i < 3; i++) { /* P = mu (F - F^-T) + lambda ln J F^-T with F - F^-T = (F F^T - 1) F^-T */
    Lanes e[3];

    for (int j = 0; j < 3; j++)
      e[j] = mu * (H[3 * i + j] + H[3 * j + i] + H[3 * i] * H[3 * j] + H[3 * i + 1] * H[3 * j + 1] +
                   H[3 * i + 2] * H[3 * j + 2]);
    for (int j = 0; j < 3; j++)
      P[3 * i + j] = e[0] * G[j] + e[1] * G[3 + j] + e[2] * G[6 + j] + pressure * G[3 * i + j];
  }
  if (W) {
    Lanes stretch = 2 * (H[0] + H[4] + H[8]); /* I1 - 3 */

    for (int r = 0; r < 9; r++) stretch += H[r] * H[r];
    *W = 0.5 * mu * stretch - mu * logJ + 0.5 * pressure * logJ;
  }
  if (A) { /* A_iIjJ = mu delta_ij delta_IJ + lambda G_iI G_jJ + (mu - lambda ln J) G_iJ G_jI */
    const Lanes shear = mu - pressure;

    for (int r = 0, k = 0; r < 9; r++) {
      const Lanes lambda_G = lambda * G[r];

      for (int s = r; s < 9; s++, k++) {
        const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

        A[k] = lambda_G * G[s] + shear * G[3 * i + J] * G[3 * j + I];
        if (r == s) A[k] += mu;
      }
    }
  }
}

const ElasticLaw MaterialLaw_NeoHookean =
  {.evaluate = Evaluate, .shear = MaterialLameShear, .constants = 2, .separable = 1, .keys = {"mu"}, .required = 1};
