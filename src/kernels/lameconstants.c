/* Lame's constants, which linear, svk and neo_hookean have. */
#include "lameconstants.h"

/*@
  MaterialLame - computes Lame's constants.

  Not collective

  Input Parameters:
+ E  - Young's modulus (stress)
- nu - Poisson's ratio, -1 < nu <= 1/2

  Output Parameters:
+ lambda - first constant (stress); INFINITY for nu = 1/2
- mu     - shear modulus (stress)
@*/
void MaterialLame(double E, double nu, double *lambda, double *mu)
{
  *lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  *mu     = E / (2 * (1 + nu));
}

/*@
  MaterialLameShear - gives the shear modulus of laws whose constants are Lame's.

  Not collective

  Input Parameters:
+ n         - number of constants
- constants - lambda and mu (stress)

  Output Parameter:
. mu - shear modulus (stress)
@*/
void MaterialLameShear(int n, const Lanes constants[], Lanes *mu)
{
  (void)n;
  *mu = constants[1];
}
