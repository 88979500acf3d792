/* What keeps J together within plastic elements that hold their volume in the mean, or its linear part, alone. Plain C,
   inlined like elementbatch.h.

   Where the projection does not see J at a point, a stretch e along a tension s strains the shape by 2/3 e only. Its
   second variation is 4/9 e^2 times the slope of the hardening curve, less 2/3 e^2 times s: once the tension is above
   2/3 of that slope, points of an element that is flat along the tension are stretched and squeezed in turn, and gain
   energy by it. Elastic laws are far from this, as their tensions are below the shear modulus.

   So the element has the energy c/2 int (J - Pi J)^2 dV in finite strains, Pi the element's projection. Its second
   variation is c e^2. c is the flow stress at a plastic strain of 1. With any curve that is convex upwards this is
   enough up to a strain of 2.2, at which a neck has a ninth of its area. c is a constant of the law, so that forces
   have a potential and an accepted state keeps them. The energy vanishes where J is what the projection sees, and with
   the size of the elements. It does not lock, as the flow itself takes as much stress times the strain. */
#pragma once
#include "elementbatch.h"
#include "kernels/hardening.h"

/* Returns the modulus c of a batch, 0 without a plastic law of the program. */
LANES_INLINE double HoldModulus(const BatchCall *call)
{
  static const double strain = 1;

  return call->finite && call->state && !call->plastic->umat ? HardeningMost(call->plastic->hardening, strain) : 0;
}
