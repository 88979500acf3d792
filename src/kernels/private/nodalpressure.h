/* The pressure at a point of a mixed element whose nodes have unknowns for it: its derivatives by tau, which
   nodalpressurekernel.c explains, and what keeps J near j there. Plain C, inlined like elementbatch.h. */
#pragma once
#include "mixedpressure.h"

typedef struct {
  Lanes p;
  Lanes slope, bend;     /* first and second derivative of p by tau */
  Lanes excess, j_slope; /* J - j; derivative of j by tau */
  Lanes scale;           /* derivative of tau by the unknowns */
} NodalPressure;

LANES_INLINE Lanes Exponential(Lanes a)
{
  for (int lane = 0; lane < LANES; lane++) a[lane] = expm1(a[lane]);
  return a;
}

/* Computes the pressure and its derivatives from tau and J - 1. */
LANES_INLINE void NodalPressureSet(const BatchCall *call, const Lanes *tau, const Lanes *dilatation, NodalPressure *x)
{
  const Lanes soft = 1 / call->modulus, strain = *tau * soft;
  Lanes       j;

  x->scale   = call->mu / call->length;
  x->p       = *tau;
  x->slope   = (Lanes){0} + 1;
  x->bend    = (Lanes){0};
  x->excess  = *dilatation - strain;
  x->j_slope = soft;
  if (!call->finite) return;
  j          = 1 + Exponential(strain);
  x->p       = *tau / j;
  x->slope   = (1 - strain) / j;
  x->bend    = soft * (strain - 2) / j;
  x->excess  = *dilatation - (j - 1);
  x->j_slope = soft * j;
}

/* Adds the pressure that keeps J near j: the integral gamma / 2 (J - j)^2 of the Lagrangian. */
LANES_INLINE void KeepVolume(const Lanes *gamma, const BatchCall *call, NodalPressure *x)
{
  x->p += *gamma * x->excess;
  x->slope -= *gamma * x->j_slope;
  if (call->finite) x->bend -= *gamma * x->j_slope / call->modulus;
}

/* Adds the square of the derivatives of J to a tangent of the law. */
LANES_INLINE void AddVolumeModulus(const Lanes *gamma, const Lanes G[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  for (int r = 0; r < 9; r++)
    for (int s = r; s < 9; s++) A[MATERIAL_TANGENT_INDEX(r, s)] += *gamma * G[r] * G[s];
}

/* Stores displacement gradient and pressure, as StoreOutput() of mixedkernel.c. */
LANES_INLINE void NodalPressureStore(const BatchCall *call, int q, const Lanes H[9], const Lanes *dilatation,
                                     const NodalPressure *x)
{
  StorePoint(call, q, H);
  if (!call->pressure) return;
  LANE(call->pressure, q) = x->p;
  if (call->finite) LANE(call->pressure, q) = (1 + *dilatation) * x->p;
}
