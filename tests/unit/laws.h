/* A material of each law for tests, whose undeformed state has the moduli E and nu. The constants have both signs, as
   fits of rubber have. Ogden's are three terms with sum mu_i alpha_i / 2 = mu. */
#pragma once
#include "kernels/material.h"

static inline Material ExampleMaterial(MaterialLaw law, double E, double nu)
{
  const double mu       = E / (2 * (1 + nu));
  const double own[][6] = {[MATERIAL_MOONEY_RIVLIN] = {0.6 * mu, -0.1 * mu},
                           [MATERIAL_YEOH]          = {0.5 * mu, -0.03 * mu, 0.01 * mu},
                           [MATERIAL_OGDEN]         = {1.3 * mu, 1.3, 0.01 * mu, 5, -0.13 * mu, -2},
                           [MATERIAL_ARRUDA_BOYCE]  = {mu, 2},
                           [MATERIAL_HYPERFOAM]     = {1.2 * mu, 3, -0.2 * mu, -2}};
  const int    n[MATERIAL_LAWS] =
    {[MATERIAL_MOONEY_RIVLIN] = 2, [MATERIAL_YEOH] = 3, [MATERIAL_OGDEN] = 6, [MATERIAL_ARRUDA_BOYCE] = 2,
     [MATERIAL_HYPERFOAM] = 4};
  Material material;

  if (!n[law]) return MaterialFromModuli(law, E, nu);
  material = MaterialFromConstants(law, n[law], own[law]);
  if (law == MATERIAL_ARRUDA_BOYCE) material.constants[1] *= mu / MaterialShear(&material);
  MaterialSetBulk(&material, MaterialBulk(mu, nu));
  return material;
}
