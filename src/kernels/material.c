/* Materials: elastic laws with their constants. */
#include "kernels/material.h"
#include "lameconstants.h"
#include <stddef.h>
#include <string.h>

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
  MaterialHasModuli - tells whether the shear modulus is a law's only own constant, so that E may be given instead.

  Not collective
@*/
int MaterialHasModuli(MaterialLaw law)
{
  return !strcmp(laws[law]->keys[0], "mu") && !laws[law]->keys[1];
}

/*@
  MaterialFromModuli - makes a material of a law whose only own constant is the shear modulus.

  Not collective

  Input Parameters:
+ law - a law of MaterialHasModuli()
. E   - Young's modulus (stress)
- nu  - Poisson's ratio, -1 < nu <= 1/2
@*/
Material MaterialFromModuli(MaterialLaw law, double E, double nu)
{
  Material material = {.law = law, .n_constants = 2, .E = E, .nu = nu};

  MaterialLame(E, nu, &material.constants[0], &material.constants[1]);
  if (laws[law]->isochoric) material.constants[0] = MaterialBulk(material.constants[1], nu);
  return material;
}

/*@
  MaterialFromConstants - makes a material without its volume part, which MaterialSetBulk() sets.

  Not collective

  Input Parameters:
+ law - the law
. n   - number of its own constants
- own - the constants
@*/
Material MaterialFromConstants(MaterialLaw law, int n, const double own[])
{
  Material material = {.law = law, .n_constants = n + 1};

  for (int k = 0; k < n; k++) material.constants[k + 1] = own[k];
  return material;
}

/*@
  MaterialSetBulk - sets the bulk modulus of the undeformed state, and the moduli that follow.

  Not collective

  Input Parameters:
+ material - of a law with a shear modulus above 0
- K        - bulk modulus (stress), or INFINITY if the material is incompressible
@*/
void MaterialSetBulk(Material *material, double K)
{
  const double mu = MaterialShear(material), ratio = mu / K; /* 0 if incompressible */

  material->constants[0] = laws[material->law]->isochoric ? K : K - 2 * mu / 3;
  material->E            = 9 * mu / (3 + ratio);
  material->nu           = (3 - 2 * ratio) / (2 * (3 + ratio));
}

/*@
  MaterialBulk - returns the bulk modulus that belongs to a shear modulus and Poisson's ratio, INFINITY for 1/2.

  Not collective
@*/
double MaterialBulk(double mu, double nu)
{
  return 2 * mu * (1 + nu) / (3 * (1 - 2 * nu));
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
