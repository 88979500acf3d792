/* Ogden's law with any number of terms, in the principal stretches l_a = J^(-1/3) lambda_a of the part of F that keeps
   the volume: W = sum_i mu_i / alpha_i (l_1^alpha_i + l_2^alpha_i + l_3^alpha_i - 3) + K/2 (ln J)^2. Constants: K, then
   mu_i and alpha_i of each term. The initial shear modulus is sum_i mu_i alpha_i / 2.

   Stress and tangent are written in y_a = ln l_a. With E_ia = exp(alpha_i y_a), the principal Kirchhoff stresses are
   tau_a = sum_i mu_i (E_ia - mean_b E_ib).
   Source: Ogden, "Large deformation isotropic elasticity", Proceedings of the Royal Society A 326, 1972. */
#include "principallaw.h"

/* Adds a term: energy, stresses, and if tangent the stiffnesses. less_1 is E - 1, which keeps the digits of small
   strains. (E_a - E_b) / (y_a - y_b) = alpha sqrt(E_a E_b) sinh(z) / z with z = alpha (y_a - y_b) / 2. */
LANES_INLINE void AddTerm(const Principal *x, const Lanes *mu, const Lanes *alpha, int tangent, PrincipalStress *p)
{
  Lanes less_1[3], mean;

  for (int a = 0; a < 3; a++) {
    for (int lane = 0; lane < LANES; lane++)
      less_1[a][lane] = expm1(fmin((*alpha)[lane] * x->y[a][lane], most_exponent));
  }
  mean = (less_1[0] + less_1[1] + less_1[2]) / 3;
  p->W += *mu / *alpha * 3 * mean;
  for (int a = 0; a < 3; a++) p->tau[a] += *mu * (less_1[a] - mean);
  for (int a = 0; a < 3 && tangent; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    Lanes     slope;

    for (int b2 = 0; b2 < 3; b2++) p->stiffness[a][b2] += *mu * *alpha * ((mean - less_1[a] - less_1[b2] - 1) / 3);
    p->stiffness[a][a] += *mu * *alpha * (1 + less_1[a]);
    for (int lane = 0; lane < LANES; lane++) {
      const double root = sqrt((1 + less_1[b][lane]) * (1 + less_1[c][lane]));
      const double z    = (*alpha)[lane] * (x->y[b][lane] - x->y[c][lane]) / 2;

      slope[lane] = SinhOver(z, root, less_1[b][lane] - less_1[c][lane]);
    }
    p->slope[a] += *mu * *alpha * slope;
  }
}

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  Principal       x;
  PrincipalStress p = {.W = {0}};
  Lanes           mean;

  Directions(H, dilatation, &x);
  mean = (x.y[0] + x.y[1] + x.y[2]) / 3;
  for (int a = 0; a < 3; a++) x.y[a] -= mean; /* of the part that keeps the volume */
  for (int k = 1; k < n; k += 2) AddTerm(&x, &constants[k], &constants[k + 1], A != NULL, &p);
  PrincipalForce(&x, &p, P);
  if (W) *W = p.W;
  if (A) PrincipalTangent(&x, &p, A);
  VolumePart(&x.m, &constants[0], W, P, A);
}

static void Shear(int n, const Lanes constants[], Lanes *mu)
{
  *mu = (Lanes){0};
  for (int k = 1; k < n; k += 2) *mu += constants[k] * constants[k + 1] / 2;
}

const ElasticLaw MaterialLaw_Ogden = {.evaluate  = Evaluate,
                                      .shear     = Shear,
                                      .constants = 3,
                                      .separable = 1,
                                      .isochoric = 1,
                                      .keys      = {MATERIAL_TERMS},
                                      .required  = 1};
