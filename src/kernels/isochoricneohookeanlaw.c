/* The neo-Hookean law split into shape and volume: W = mu/2 (J^(-2/3) I1 - 3) + K/2 (ln J)^2. Constants: K, mu. */
#include "isochoriclaw.h"
#include "lameconstants.h"

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes     K = constants[0], half = 0.5 * constants[1];
  IsochoricEnergy w = {.w1 = half};
  Isochoric       x;

  (void)n;
  IsochoricStart(H, dilatation, 0, &x);
  w.w = half * x.x1;
  IsochoricFinish(&x, 0, &w, &K, W, P, A);
}

const ElasticLaw MaterialLaw_IsochoricNeoHookean = {.evaluate  = Evaluate,
                                                    .shear     = MaterialLameShear,
                                                    .constants = 2,
                                                    .separable = 1,
                                                    .isochoric = 1,
                                                    .keys      = {"mu"},
                                                    .required  = 1};
