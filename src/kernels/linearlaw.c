/* Hooke's law for small strains. */
#include "kernels/material.h"
#include "lameconstants.h"
#include <stddef.h>

/* Lame's constants lambda and mu: P = lambda tr(e) 1 + 2 mu e with e = sym H. */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes lambda = constants[0], mu = constants[1];
  const Lanes trace = H[0] + H[4] + H[8];

  (void)dilatation, (void)n;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) P[3 * i + j] = mu * (H[3 * i + j] + H[3 * j + i]);
    P[4 * i] += lambda * trace;
  }
  if (W) {
    *W = P[0] * H[0];
    for (int r = 1; r < 9; r++) *W += P[r] * H[r];
    *W *= 0.5;
  }
  for (int r = 0, k = 0; r < 9 && A; r++) {
    for (int s = r; s < 9; s++, k++) {
      const int i = r / 3, I = r % 3, j = s / 3, J = s % 3;

      A[k] = lambda * (double)(i == I && j == J) + mu * (double)((i == j && I == J) + (i == J && j == I));
    }
  }
}

const ElasticLaw MaterialLaw_Linear = {.evaluate  = Evaluate,
                                       .shear     = MaterialLameShear,
                                       .constants = 2,
                                       .keys      = {"mu"},
                                       .required  = 1};
