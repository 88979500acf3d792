/* How much of what a body stores is in strains that vary within its elements.

   Elements of first order have few strains that vary: those of a bent quadrangle or brick go with a shear that a bent
   body does not have. With volumes dV, strains E and stresses S that belong to them (Green's and the second Piola
   Kirchhoff one) and their means over an element, the share is

     sum over elements of the integral of (S - S_mean) : (E - E_mean) dV, over that of S : E dV.

   In a wall of m elements across that bends by a linear law with nu = 0 it is (1 + c) / (m^2 + c), and the wall is too
   stiff by the part c / m^2. c is half of the square of an element's length over its width. */
#pragma once
#include "bodies/elasticity.h"

PetscErrorCode StrainVariation(Mesh, Scene, Elasticity, const PetscReal *u, PetscReal *share);
