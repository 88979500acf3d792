/* Yeoh's law: w = c10 x1 + c20 x1^2 + c30 x1^3, see isochoriclaw.h. Constants: K, c10, c20, c30. The initial shear
   modulus is 2 c10. Source: Yeoh, "Some forms of the strain energy function for rubber", Rubber Chemistry and
   Technology 66, 1993. */
#include "isochoriclaw.h"

static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes     K = constants[0], c10 = constants[1], c20 = constants[2], c30 = constants[3];
  IsochoricEnergy w = {.w2 = {0}};
  Isochoric       x;

  (void)n;
  IsochoricStart(H, dilatation, 0, &x);
  w.w   = x.x1 * (c10 + x.x1 * (c20 + x.x1 * c30));
  w.w1  = c10 + x.x1 * (2 * c20 + x.x1 * 3 * c30);
  w.w11 = 2 * c20 + 6 * c30 * x.x1;
  IsochoricFinish(&x, 0, &w, &K, W, P, A);
}

static void Shear(int n, const Lanes constants[], Lanes *mu)
{
  (void)n;
  *mu = 2 * constants[1];
}

const ElasticLaw MaterialLaw_Yeoh = {.evaluate  = Evaluate,
                                     .shear     = Shear,
                                     .constants = 4,
                                     .separable = 1,
                                     .isochoric = 1,
                                     .keys      = {"c10", "c20", "c30"},
                                     .required  = 1};
