/* Materials: elastic laws with their constants. */
#include "kernels/material.h"
#include "lameconstants.h"
#include <stddef.h>

const char *const              MaterialLaws[MATERIAL_LAWS + 1] = {ELASTIC_LAWS(CHOICE_NAME) NULL};
static const ElasticLaw *const laws[MATERIAL_LAWS]             = {ELASTIC_LAWS(CHOICE_POINTER)};

/*@
  MaterialGetLaw - returns a law.

  Not collective

  Note:
  Small kinematics takes MATERIAL_LINEAR, with the constants of MaterialLinearise().
@*/
const ElasticLaw *MaterialGetLaw(MaterialLaw law)
{
  return laws[law];
}

/*@
  MaterialShear - returns the shear modulus (stress) of the undeformed state.

  Not collective
@*/
double MaterialShear(const Material *material)
{
  Lanes constants[MATERIAL_MAX_CONSTANTS], mu;

  for (int k = 0; k < material->n_constants; k++) constants[k] = (Lanes){0} + material->constants[k];
  laws[material->law]->shear(material->n_constants, constants, &mu);
  return mu[0];
}

/*@
  MaterialFromModuli - makes a material of a law whose constants are Lame's.

  Not collective

  Input Parameters:
+ law - MATERIAL_LINEAR, MATERIAL_SVK or MATERIAL_NEO_HOOKEAN
. E   - Young's modulus (stress)
- nu  - Poisson's ratio, -1 < nu <= 1/2
@*/
Material MaterialFromModuli(MaterialLaw law, double E, double nu)
{
  Material material = {.law = law, .n_constants = 2, .E = E, .nu = nu};

  MaterialLame(E, nu, &material.constants[0], &material.constants[1]);
  return material;
}

/*@
  MaterialLinearise - returns Hooke's law with the moduli of the undeformed state, for small kinematics.

  Not collective
@*/
Material MaterialLinearise(const Material *material)
{
  Material     linear = {.law = MATERIAL_LINEAR, .n_constants = 2, .E = material->E, .nu = material->nu};
  const double mu     = MaterialShear(material);

  linear.constants[0] = material->constants[0] - (laws[material->law]->isochoric ? 2 * mu / 3 : 0);
  linear.constants[1] = mu;
  return linear;
}

/*@
  MaterialEvaluate - computes energy, stress and tangent of a law at one point.

  Not collective

  Input Parameters:
+ law       - the law
. n         - number of constants
. constants - of the law
- H         - displacement gradient du_i/dX_I at 3 i + I

  Output Parameters:
+ W - energy per reference volume, or NULL
. P - first Piola-Kirchhoff stress; with MATERIAL_LINEAR the stress
- A - tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), r <= s, or NULL
@*/
void MaterialEvaluate(MaterialLaw law, int n, const double constants[], const double H[9], double *W, double P[9],
                      double A[MATERIAL_TANGENT_SIZE])
{
  Lanes lanes_H[9], lanes_P[9], lanes_A[MATERIAL_TANGENT_SIZE], lanes_W, dilatation,
    lanes_constants[MATERIAL_MAX_CONSTANTS];

  for (int r = 0; r < 9; r++) lanes_H[r] = (Lanes){0} + H[r];
  for (int k = 0; k < n; k++) lanes_constants[k] = (Lanes){0} + constants[k];
  MaterialDilatation(lanes_H, &dilatation);
  laws[law]->evaluate(lanes_H, &dilatation, n, lanes_constants, W ? &lanes_W : NULL, lanes_P, A ? lanes_A : NULL);
  if (W) *W = lanes_W[0];
  for (int r = 0; r < 9; r++) P[r] = lanes_P[r][0];
  for (int k = 0; k < MATERIAL_TANGENT_SIZE && A; k++) A[k] = lanes_A[k][0];
}

/*@
  MaterialPoint - computes energy, stress and tangent of a material at one point.

  Not collective

  Input Parameters:
+ material - law and constants
. finite   - 0 for small strains, else the law itself
- H        - displacement gradient du_i/dX_I at 3 i + I

  Output Parameters:
+ W - energy per reference volume, or NULL
. P - first Piola-Kirchhoff stress; with small strains the stress
- A - tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), r <= s, or NULL
@*/
void MaterialPoint(const Material *material, int finite, const double H[9], double *W, double P[9],
                   double A[MATERIAL_TANGENT_SIZE])
{
  const Material used = finite ? *material : MaterialLinearise(material);

  MaterialEvaluate(used.law, used.n_constants, used.constants, H, W, P, A);
}
