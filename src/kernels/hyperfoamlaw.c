/* The law of elastomeric foams with any number of terms, in the principal stretches:
   W = sum_i 2 mu_i / alpha_i^2 (lambda_1^alpha_i + lambda_2^alpha_i + lambda_3^alpha_i - 3
                                 + (J^(-alpha_i beta) - 1) / beta).
   beta = nu / (1 - 2 nu) is that of all terms. Constants: Lame's lambda = 2 beta sum_i mu_i, then mu_i and alpha_i of
   each term. The initial shear modulus is sum_i mu_i. With nu = 0 the last part is its limit -alpha_i ln J.

   The principal Kirchhoff stresses are tau_a = sum_i 2 mu_i / alpha_i (lambda_a^alpha_i - J^(-alpha_i beta)).
   Source: Storakers, "On material representation and constitutive branching in finite compressible elasticity", Journal
   of the Mechanics and Physics of Solids 34, 1986. */
#include "principallaw.h"

static void Shear(int n, const Lanes constants[], Lanes *mu)
{
  *mu = (Lanes){0};
  for (int k = 1; k < n; k += 2) *mu += constants[k];
}

/* Adds a term: energy, stresses, and if tangent the stiffnesses. less_1 is lambda^alpha - 1, and shrink_less_1 is
   J^(-alpha beta) - 1. */
LANES_INLINE void AddTerm(const Principal *x, const Lanes *mu, const Lanes *alpha, const Lanes *beta, int tangent,
                          PrincipalStress *p)
{
  const Lanes factor = 2 * *mu / *alpha, log_J = x->m.log_J;
  Lanes       less_1[3], shrink_less_1, volume;

  for (int lane = 0; lane < LANES; lane++) {
    const double z = -(*alpha)[lane] * (*beta)[lane] * log_J[lane];

    for (int a = 0; a < 3; a++) less_1[a][lane] = expm1(fmin((*alpha)[lane] * x->y[a][lane], most_exponent));
    shrink_less_1[lane] = expm1(fmin(z, most_exponent));
    volume[lane]        = z == 0 ? -(*alpha)[lane] * log_J[lane] : shrink_less_1[lane] / (*beta)[lane];
  }
  p->W += factor / *alpha * (less_1[0] + less_1[1] + less_1[2] + volume);
  for (int a = 0; a < 3; a++) p->tau[a] += factor * (less_1[a] - shrink_less_1);
  for (int a = 0; a < 3 && tangent; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;

    for (int d = 0; d < 3; d++) p->stiffness[a][d] += 2 * *mu * *beta * (1 + shrink_less_1);
    p->stiffness[a][a] += 2 * *mu * (1 + less_1[a]);
    for (int lane = 0; lane < LANES; lane++) {
      const double root = sqrt((1 + less_1[b][lane]) * (1 + less_1[c][lane]));
      const double z    = (*alpha)[lane] * (x->y[b][lane] - x->y[c][lane]) / 2;

      p->slope[a][lane] += 2 * (*mu)[lane] * SinhOver(z, root, less_1[b][lane] - less_1[c][lane]);
    }
  }
}

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  Principal       x;
  PrincipalStress p = {.W = {0}};
  Lanes           mu, beta;

  Shear(n, constants, &mu);
  beta = constants[0] / (2 * mu);
  Directions(H, dilatation, &x);
  for (int k = 1; k < n; k += 2) AddTerm(&x, &constants[k], &constants[k + 1], &beta, A != NULL, &p);
  PrincipalForce(&x, &p, P);
  if (W) *W = p.W;
  if (A) PrincipalTangent(&x, &p, A);
}

const ElasticLaw MaterialLaw_Hyperfoam =
  {.evaluate = Evaluate, .shear = Shear, .constants = 3, .keys = {MATERIAL_TERMS}, .required = 1};
