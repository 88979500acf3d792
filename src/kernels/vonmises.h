/* Plasticity with von Mises' yield condition, associative flow, isotropic and kinematic hardening at a point. Plain C,
   no PETSc, no allocation.

   Finite strains: the elastic energy is Hencky's, bulk/2 (ln J)^2 + shear |dev e|^2 with the logarithmic elastic strain
   e = 1/2 ln(F Cp^-1 F^T). The yield condition holds for the Kirchhoff stress. The flow is multiplicative and is
   integrated by the exponential map, so that it keeps volumes. Small strains: e = sym H - plastic strain, radial
   return.

   Backstresses are those of Armstrong and Frederick, by a split of the plastic part, see backstress.c.

   The functions compute an incremental potential: the least sum of elastic energy and plastic work over all plastic
   strains that can follow the accepted state. Stress and tangent are its derivatives. The tangent is symmetric.

   Sources: Simo, "Algorithms for static and dynamic multiplicative plasticity that preserve the classical return
   mapping schemes of the infinitesimal theory", Computer Methods in Applied Mechanics and Engineering 99, 1992; Ortiz
   and Stainier, "The variational formulation of viscoplastic constitutive updates", the same journal 171, 1999. */
#pragma once
#include "base/lanes.h"
#include "kernels/hardening.h"
#include "kernels/material.h"

/* State of a point: Cp^-1 - 1 (xx yy zz xy yz xz) with the plastic right Cauchy-Green tensor Cp, then the equivalent
   plastic strain. In small strains the first six are -2 times the plastic strain, the linearisation. Zero is the virgin
   state. Laws with a backstress or an overstress have more: the plastic work that does not follow from the equivalent
   plastic strain, then Ci^-1 - 1 for every backstress, with the right Cauchy-Green tensor Ci of the part of the plastic
   deformation that does not store energy. PlasticStates() counts the numbers of a law. After them, elements that hold J within
   (volumehold.h) have PLASTIC_HOLD numbers more. */
enum {
  PLASTIC_STATE      = 7,
  PLASTIC_STRAIN     = 6,
  PLASTIC_WORK       = 7,
  PLASTIC_BACKSTRESS = 8,
  PLASTIC_HOLD       = 2,
  PLASTIC_MAX_STATE  = PLASTIC_BACKSTRESS + 6 * HARDENING_MAX_TERMS + PLASTIC_HOLD
};

int  PlasticStates(const Hardening *);
void PlasticStrainTensor(int finite, const double state[6], double strain[6]);
void VonMisesLaw(int finite, const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                 const Hardening *, double dt, const Lanes state[], Lanes *W, Lanes P[9],
                 Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[]);
