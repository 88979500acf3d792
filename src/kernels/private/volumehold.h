/* What keeps J together within plastic elements that hold their volume in the mean, or its linear part, alone. Plain C,
   inlined like elementbatch.h.

   Where the projection does not see J at a point, a stretch e along a tension s strains the shape by 2/3 e only. Its
   second variation is 4/9 e^2 times the slope of the hardening curve, less 2/3 e^2 times s: once the tension is above
   2/3 of that slope, points of an element that is flat along the tension are stretched and squeezed in turn, and gain
   energy by it. Elastic laws are far from this, as their tensions are below the shear modulus.

   So the element has the energy c/2 int (J - Pi J)^2 dV in finite strains, Pi the element's projection, whose second
   variation is c e^2. c is half as much again as is needed, s - 2/3 of the slope, in the mean over the points, and 0
   where that is negative. It vanishes where J is what the projection sees, and with the size of the elements. It does
   not lock, as the flow itself takes as much stress times the strain.

   Routines of users do not tell their hardening. Their slope is that of DDSDDE along the deviator of the stress, and c
   the largest so far of the accepted states.

   c is that of the accepted state, a constant of the step. A point has two numbers more in its state: what it carries
   over from earlier c, a stress and an energy, so that an accepted state keeps forces and energies. The stresses have
   no part that the projection sees. */
#pragma once
#include "elementbatch.h"
#include "kernels/hardening.h"

/* Adds what a point of a built-in law needs. */
LANES_INLINE void AddNeed(const Hardening *hardening, const Lanes *strain, Lanes *sum)
{
  for (int lane = 0; lane < LANES; lane++) {
    double       slope;
    const double stress = HardeningMost(hardening, (*strain)[lane], &slope);

    (*sum)[lane] += fmax(0, stress - 2 * slope / 3);
  }
}

/* Computes the modulus c, 0 where nothing holds. points: of integration */
LANES_INLINE Lanes HoldModulus(const BatchCall *call, const int points)
{
  Lanes sum = {0};

  for (int q = 0; q < points && call->hold; q++) {
    const Lanes strain = CONST_LANE(call->state, q * call->states + PLASTIC_STRAIN);

    if (call->plastic->umat)
      sum += CONST_LANE(call->state, q * call->states + call->hold + PLASTIC_HOLD);
    else
      AddNeed(call->plastic->hardening, &strain, &sum);
  }
  return sum / points;
}

/* Computes the stress at a point: the derivative of the energy by J. off: J - Pi J, or J less what a caller accounts
   for with the projection */
LANES_INLINE Lanes HoldStress(const BatchCall *call, int q, const Lanes *modulus, const Lanes *off)
{
  Lanes stress = {0};

  if (call->hold) stress = CONST_LANE(call->state, q * call->states + call->hold) + *modulus * *off;
  return stress;
}

/* Computes the energy at a point over the volume. */
LANES_INLINE Lanes HoldEnergy(const BatchCall *call, int q, const Lanes *modulus, const Lanes *off)
{
  Lanes energy = {0};

  if (call->hold)
    energy = CONST_LANE(call->state, q * call->states + call->hold + 1) +
             (HoldStress(call, q, modulus, off) - *modulus / 2 * *off) * *off;
  return energy;
}

/* Takes on what the points carry over when the modulus becomes that of the state. off: J - Pi J [points][lanes] */
LANES_INLINE void HoldAccept(const BatchCall *call, const int points, const Lanes *before, const double *off,
                             double *state)
{
  const Lanes change = HoldModulus(call, points) - *before;

  for (int q = 0; q < points; q++) {
    const Lanes   at    = CONST_LANE(off, q);
    double *const first = state + (q * call->states + call->hold) * KERNEL_LANES;

    LANE(first, 0) -= change * at;
    LANE(first, 1) += change / 2 * at * at;
  }
}
