/* Strains at points and principal values, see pointstrain.h. */
#include "kernels/pointstrain.h"
#include "lawconstants.h"
#include "principal.h"
#include <math.h>
#include <stddef.h>

/* Rows and columns of the components xx yy zz xy yz xz */
static const int component[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};

/*@
  PrincipalValues - computes principal values and axes of a symmetric tensor.

  Not collective

  Input Parameter:
. tensor - xx yy zz xy yz xz

  Output Parameters:
+ value - the principal values, the largest first
- axis  - axis[a] is the unit vector of value[a]; its component of the largest amount is positive
@*/
void PrincipalValues(const double tensor[6], double value[3], double axis[3][3])
{
  Lanes lanes[6], values[3], axes[3][3];
  int   order[3] = {0, 1, 2};

  for (int c = 0; c < 6; c++) lanes[c] = (Lanes){0} + tensor[c];
  PrincipalAxes(lanes, values, axes);
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2 - a; b++)
      if (values[order[b]][0] < values[order[b + 1]][0]) {
        const int swap = order[b];

        order[b]     = order[b + 1];
        order[b + 1] = swap;
      }
  for (int a = 0; a < 3; a++) {
    double sign;
    int    most = 0;

    value[a] = values[order[a]][0];
    for (int i = 0; i < 3; i++) axis[a][i] = axes[order[a]][i][0];
    for (int i = 1; i < 3; i++)
      if (fabs(axis[a][i]) > fabs(axis[a][most])) most = i;
    sign = axis[a][most] < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) axis[a][i] *= sign;
  }
}

/* Left Cauchy-Green tensor less 1, H + H^T + H H^T, in which small strains keep their digits. */
static void LeftTensor(const double H[9], double b[6])
{
  for (int c = 0; c < 6; c++) {
    const int i = component[c][0], j = component[c][1];

    b[c] = H[3 * i + j] + H[3 * j + i];
    for (int k = 0; k < 3; k++) b[c] += H[3 * i + k] * H[3 * j + k];
  }
}

/*@
  StrainOfGradient - computes the strain of a displacement gradient.

  Not collective

  Input Parameters:
+ finite - 0: small strains
- H      - F - 1 at 3 i + I

  Output Parameter:
. strain - xx yy zz xy yz xz (half of the engineering shear); finite: the logarithmic strain 1/2 ln F F^T, along the
axes of space as the Cauchy stress
@*/
void StrainOfGradient(int finite, const double H[9], double strain[6])
{
  double b[6], value[3], axis[3][3];

  for (int c = 0; c < 6; c++)
    strain[c] = finite ? 0 : (H[3 * component[c][0] + component[c][1]] + H[3 * component[c][1] + component[c][0]]) / 2;
  if (!finite) return;
  LeftTensor(H, b);
  PrincipalValues(b, value, axis);
  for (int a = 0; a < 3; a++)
    for (int c = 0; c < 6; c++) strain[c] += log1p(value[a]) / 2 * axis[a][component[c][0]] * axis[a][component[c][1]];
}

/* Energy per reference volume of an elastic law at a point. */
static double PointEnergy(const KernelCase *kernel, const double *constants, const double H[9], double pressure)
{
  const int mixed = kernel->formulation == FORMULATION_MIXED;
  double    used[MATERIAL_MAX_CONSTANTS], P[9], W;

  if (kernel->plastic) return NAN;
  MaterialEvaluate(kernel->law, ElementLawConstants(kernel, constants, used), used, H, &W, P, NULL);
  return W + (mixed && isfinite(constants[0]) && constants[0] > 0 ? pressure * pressure / (2 * constants[0]) : 0);
}

/*@
  ElementPointStrain - computes strain and energy density at the quadrature points of one element.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics and law
. X          - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim]
. constants  - of the law [n_constants]
- multiplier - of a mixed element (stress times root of volume) [pressures]; NULL: they are 0

  Output Parameters:
+ strain - StrainOfGradient() at each point, where the element evaluates its law [points][6]
- energy - per reference volume [points]; NaN of laws with a state
@*/
void ElementPointStrain(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                        const double *multiplier, double *strain, double *energy)
{
  double H[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  ElementPointState(kernel, X, u, constants, multiplier, H, pressure);
  for (int p = 0; p < ElementGet(kernel->type)->points; p++) {
    StrainOfGradient(kernel->kinematics == KINEMATICS_FINITE, &H[9 * p], &strain[6 * p]);
    energy[p] = PointEnergy(kernel, constants, &H[9 * p], pressure[p]);
  }
}
