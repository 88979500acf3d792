/* Mooney and Rivlin's law: w = c10 x1 + c01 x2, see isochoriclaw.h. Constants: K, c10, c01. The initial shear modulus
   is 2 (c10 + c01). Source: Rivlin, "Large elastic deformations of isotropic materials IV", Philosophical Transactions
   of the Royal Society A 241, 1948. */
#include "isochoriclaw.h"

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes     K = constants[0], c10 = constants[1], c01 = constants[2];
  IsochoricEnergy w = {.w1 = c10, .w2 = c01};
  Isochoric       x;

  (void)n;
  IsochoricStart(H, dilatation, 1, &x);
  w.w = c10 * x.x1 + c01 * x.x2;
  IsochoricFinish(&x, 1, &w, &K, W, P, A);
}

static void Shear(int n, const Lanes constants[], Lanes *mu)
{
  (void)n;
  *mu = 2 * (constants[1] + constants[2]);
}

const ElasticLaw MaterialLaw_MooneyRivlin = {.evaluate  = Evaluate,
                                             .shear     = Shear,
                                             .constants = 3,
                                             .separable = 1,
                                             .isochoric = 1,
                                             .keys      = {"c10", "c01"},
                                             .required  = 2};
