/* The compressible neo-Hookean law W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2. Source: Bonet and Wood, "Nonlinear
   Continuum Mechanics for Finite Element Analysis", section 6.4.3. */
#include "isochoriclaw.h"
#include "lameconstants.h"

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes  lambda = constants[0], mu = constants[1];
  LawMotion    m;
  Lanes        pressure;
  const Lanes *G = m.G, *e = m.e;

  (void)n;
  LawMotionStart(H, dilatation, &m);
  pressure = lambda * m.log_J;
  for (int i = 0; i < 3; i++) { /* P = mu (F - F^-T) + lambda ln J F^-T with F - F^-T = (F F^T - 1) F^-T */
    for (int j = 0; j < 3; j++)
      P[3 * i + j] =
        mu * (e[3 * i] * G[j] + e[3 * i + 1] * G[3 + j] + e[3 * i + 2] * G[6 + j]) + pressure * G[3 * i + j];
  }
  if (W) *W = 0.5 * mu * m.trace - mu * m.log_J + 0.5 * pressure * m.log_J; /* I1 - 3 = tr(F F^T - 1) */
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
