/* Plane stress at a point: the stretch across the plane at which the stress across it vanishes, and the tangent in the
   plane at that stretch. Plain C.

   PointStretch() sets H_33 before the law is evaluated. PlaneTangent() condenses the law's tangent afterwards. As P_33
   = dW/dH_33 = 0, energy and stress in the plane are those of the law at this stretch. Source: Bonet and Wood,
   "Nonlinear Continuum Mechanics for Finite Element Analysis", section 6.6.7 (plane stress); Klinkel and Govindjee,
   "Using finite strain 3D-material models in beam and shell elements", Engineering Computations 19, 2002, for the
   iteration. */
#pragma once
#include "elementbatch.h"

/* Iterations of Newton's method for the stretch. Rubber at a stretch of 3 takes 6 to 8. */
enum { STRETCH_ITERATIONS = 60 };
/* The stretch has converged where its change is below this part of it, or of the strains where they are small. It is
   some ten times the round-off of the stresses over the stiffness. */
static const double stretch_converged = 1e-14;
/* Largest factor by which one iteration changes the stretch. */
static const double stretch_factor = 2;

/* Changes H_33 of a lane by Newton's method. Returns whether it has converged. */
static inline int AdvanceStretch(int finite, const Lanes H[9], double P, double A, int lane, double *h)
{
  const double before = *h, stretch = 1 + before;
  const double scale = finite ? stretch : fabs(H[0][lane]) + fabs(H[4][lane]) + fabs(before);
  double       step  = A != 0 ? -P / fabs(A) : 0;

  if (finite) step = fmin(fmax(step, stretch / stretch_factor - stretch), stretch_factor * stretch - stretch);
  *h = before + step;
  return !(fabs(step) > stretch_converged * scale);
}

/* Sets the component of the displacement gradient across the plane so that no stress acts there. */
LANES_INLINE void PointStretch(const BatchCall *call, Lanes H[9])
{
  int left = LANES, done[LANES] = {0};

  for (int lane = 0; lane < LANES; lane++) {
    const double flat = (1 + H[0][lane]) * (1 + H[4][lane]) - H[1][lane] * H[3][lane];

    H[8][lane] = call->finite ? pow(fmax(flat, MATERIAL_LEAST_J), -call->across[lane]) - 1
                              : -call->across[lane] * (H[0][lane] + H[4][lane]);
  }
  for (int iteration = 0; left && iteration < STRETCH_ITERATIONS; iteration++) {
    Lanes P[9], A[MATERIAL_TANGENT_SIZE], dilatation;

    MaterialDilatation(H, &dilatation);
    call->law->evaluate(H, &dilatation, call->n_constants, call->constants, NULL, P, A);
    for (int lane = 0; lane < LANES; lane++) {
      double h = H[8][lane];

      if (done[lane]) continue;
      done[lane] = AdvanceStretch(call->finite, H, P[8][lane], A[MATERIAL_TANGENT_INDEX(8, 8)][lane], lane, &h);
      H[8][lane] = h;
      left -= done[lane];
    }
  }
}

/* Condenses the tangent: the stress across the plane stays 0. Only the components in the plane are changed. */
LANES_INLINE void PlaneTangent(Lanes A[MATERIAL_TANGENT_SIZE])
{
  static const int plane[4] = {0, 1, 3, 4};
  Lanes            inverse;

  for (int lane = 0; lane < LANES; lane++) {
    const double across = A[MATERIAL_TANGENT_INDEX(8, 8)][lane];

    inverse[lane] = across != 0 ? 1 / across : 0;
  }
  for (int i = 0; i < 4; i++)
    for (int j = i; j < 4; j++)
      A[MATERIAL_TANGENT_INDEX(plane[i], plane[j])] -=
        inverse * A[MATERIAL_TANGENT_INDEX(plane[i], 8)] * A[MATERIAL_TANGENT_INDEX(plane[j], 8)];
}
