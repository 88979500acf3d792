/* Elastic laws in terms of the displacement gradient H = F - 1, LANES points at a time. */
#include "kernels/material.h"
#include <math.h>
#include <stddef.h>

/* Smallest determinant of F at which the neo-Hookean energy is evaluated; smaller ones are replaced by it. No state
   with J <= 0 is accepted, but a line search evaluates such states and needs finite numbers. The value is far below any
   J of an accepted state. */
static const double jacobian_floor = 1e-8;

/*@
  MaterialLaw_Linear - Hooke's law: P = lambda tr(e) 1 + 2 mu e with e = sym H.

  Not collective

  Note:
  A MaterialLawFn; material.h explains the arguments. Plain C.
@*/
void MaterialLaw_Linear(const Lanes H[9], const Lanes *dilatation, const Lanes *lambda, const Lanes *mu, Lanes *W,
                        Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes trace = H[0] + H[4] + H[8];

  (void)dilatation;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) P[3 * i + j] = *mu * (H[3 * i + j] + H[3 * j + i]);
    P[4 * i] += *lambda * trace;
  }
  if (W) {
    *W = P[0] * H[0];
    for (int r = 1; r < 9; r++) *W += P[r] * H[r];
    *W *= 0.5;
  }
  for (int r = 0, k = 0; r < 9 && A; r++) {
    for (int s = r; s < 9; s++, k++) {
      const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

      A[k] = *lambda * (double)(i == I && j == J) + *mu * (double)((i == j && I == J) + (i == J && j == I));
    }
  }
}

/*@
  MaterialLaw_Svk - St. Venant-Kirchhoff's law: S = lambda tr(E) 1 + 2 mu E with Green's strain E, P = F S.

  Not collective

  Note:
  A MaterialLawFn; material.h explains the arguments. Source: Bonet and Wood, section 6.4.
@*/
void MaterialLaw_Svk(const Lanes H[9], const Lanes *dilatation, const Lanes *lambda, const Lanes *mu, Lanes *W,
                     Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes F[9], E[9], S[9], trace;

  (void)dilatation;
  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      E[3 * i + j] = E[3 * j + i] =
        0.5 * (H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] + H[6 + i] * H[6 + j]);
  }
  trace = E[0] + E[4] + E[8];
  for (int r = 0; r < 9; r++) S[r] = 2 * *mu * E[r] + *lambda * trace * (double)(r % 4 == 0);
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
          *mu * (F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2]);
    }
    for (int r = 0, k = 0; r < 9; r++) {
      const Lanes lambda_F = *lambda * F[r];

      for (int s = r; s < 9; s++, k++) {
        const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

        A[k] = lambda_F * F[s] + *mu * F[3 * i + J] * F[3 * j + I];
        if (i == j) A[k] += S[3 * I + J];
        if (I == J) A[k] += b[3 * i + j];
      }
    }
  }
}

/*@
  MaterialLaw_NeoHookean - compressible neo-Hookean law: W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2.

  Not collective

  Note:
  A MaterialLawFn; material.h explains the arguments. Source: Bonet and Wood, section
  6.4.3.
@*/
void MaterialLaw_NeoHookean(const Lanes H[9], const Lanes *dilatation, const Lanes *lambda, const Lanes *mu, Lanes *W,
                            Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes F[9], G[9], logJ, inverseJ, pressure; /* G = F^-T */

  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int lane = 0; lane < LANES; lane++) {
    const double J = 1 + (*dilatation)[lane];

    inverseJ[lane] = 1 / (J > jacobian_floor ? J : jacobian_floor);
    logJ[lane]     = J > jacobian_floor ? log1p((*dilatation)[lane]) : log(jacobian_floor);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      G[3 * i + j] = inverseJ * (F[i1 + j1] * F[i2 + j2] - F[i1 + j2] * F[i2 + j1]);
    }
  }
  pressure = *lambda * logJ;
  for (int i = 0; i < 3; i++) { /* P = mu (F - F^-T) + lambda ln J F^-T with F - F^-T = (F F^T - 1) F^-T */
    Lanes e[3];

    for (int j = 0; j < 3; j++)
      e[j] = *mu * (H[3 * i + j] + H[3 * j + i] + H[3 * i] * H[3 * j] + H[3 * i + 1] * H[3 * j + 1] +
                    H[3 * i + 2] * H[3 * j + 2]);
    for (int j = 0; j < 3; j++)
      P[3 * i + j] = e[0] * G[j] + e[1] * G[3 + j] + e[2] * G[6 + j] + pressure * G[3 * i + j];
  }
  if (W) {
    Lanes stretch = 2 * (H[0] + H[4] + H[8]); /* I1 - 3 */

    for (int r = 0; r < 9; r++) stretch += H[r] * H[r];
    *W = 0.5 * *mu * stretch - *mu * logJ + 0.5 * pressure * logJ;
  }
  if (A) { /* A_iIjJ = mu delta_ij delta_IJ + lambda G_iI G_jJ + (mu - lambda ln J) G_iJ G_jI */
    const Lanes shear = *mu - pressure;

    for (int r = 0, k = 0; r < 9; r++) {
      const Lanes lambda_G = *lambda * G[r];

      for (int s = r; s < 9; s++, k++) {
        const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

        A[k] = lambda_G * G[s] + shear * G[3 * i + J] * G[3 * j + I];
        if (r == s) A[k] += *mu;
      }
    }
  }
}

#define LAW_FUNCTION(law, word, function) [law] = function,
const char *const           MaterialLaws[MATERIAL_LAWS + 1] = {ELASTIC_LAWS(CHOICE_NAME) NULL};
static MaterialLawFn *const law_functions[MATERIAL_LAWS]    = {ELASTIC_LAWS(LAW_FUNCTION)};

/*@
  MaterialGetLaw - returns the function of a law.

  Not collective

  Input Parameters:
+ law    - the law
- finite - 0 for the linearisation (small strains), else the law itself

  Output Parameter:
. function - energy, stress and tangent of LANES points

  Note:
  Every law must linearise to Hooke's law with E and nu. Small kinematics then needs no second function.
@*/
MaterialLawFn *MaterialGetLaw(MaterialLaw law, int finite)
{
  return finite ? law_functions[law] : MaterialLaw_Linear;
}

/*@
  MaterialLame - computes Lame's constants.

  Not collective

  Input Parameters:
+ E  - Young's modulus (stress)
- nu - Poisson's ratio, -1 < nu <= 1/2

  Output Parameters:
+ lambda - first constant (stress); infinite for nu = 1/2
- mu     - shear modulus (stress)
@*/
void MaterialLame(double E, double nu, double *lambda, double *mu)
{
  *lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  *mu     = E / (2 * (1 + nu));
}

/*@
  MaterialShapeOnly - returns a material without its modulus of the volume: lambda = 0, and mu as given.

  Not collective

  Input Parameters:
+ law - the law
. E   - Young's modulus (stress)
- nu  - Poisson's ratio, -1 < nu <= 1/2
@*/
Material MaterialShapeOnly(MaterialLaw law, double E, double nu)
{
  double lambda, mu;

  MaterialLame(E, nu, &lambda, &mu);
  return (Material){law, 2 * mu, 0};
}

/*@
  MaterialPoint - computes energy, stress and tangent of one point.

  Not collective

  Input Parameters:
+ material - law, Young's modulus (stress), Poisson's ratio
. finite   - 0 for small strains, else the law itself
- H        - displacement gradient du_i/dX_I at 3 i + I

  Output Parameters:
+ W - energy per reference volume, or NULL
. P - first Piola-Kirchhoff stress; with small strains the stress
- A - tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), r <= s, or NULL
@*/
void MaterialPoint(const Material *material, int finite, const double H[9], double *W, double P[9],
                   double A[MATERIAL_TANGENT_SIZE])
{
  Lanes  lanes_H[9], lanes_P[9], lanes_A[MATERIAL_TANGENT_SIZE], lanes_W, dilatation, lambda, mu;
  double l, m;

  MaterialLame(material->E, material->nu, &l, &m);
  for (int lane = 0; lane < LANES; lane++) {
    for (int r = 0; r < 9; r++) lanes_H[r][lane] = H[r];
    lambda[lane] = l;
    mu[lane]     = m;
  }
  MaterialDilatation(lanes_H, &dilatation);
  MaterialGetLaw(material->law, finite)(lanes_H, &dilatation, &lambda, &mu, W ? &lanes_W : NULL, lanes_P,
                                        A ? lanes_A : NULL);
  if (W) *W = lanes_W[0];
  for (int r = 0; r < 9; r++) P[r] = lanes_P[r][0];
  for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k] = lanes_A[k][0];
}
