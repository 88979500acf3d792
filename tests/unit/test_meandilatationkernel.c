/* Shows that the law sees one dilatation all over an element of formulation fbar, and that bending it keeps a finite
 * stiffness as solids become incompressible.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include "kernels/elementkernel.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_DOFS = 24, MAX_POINTS = 8 };

#define CASE(element, shape, strains, material) \
  {.type = element, .geometry = shape, .kinematics = strains, .law = material, .formulation = FORMULATION_FBAR}

/* All elements x geometries x kinematics with a kernel */
static int NextCase(KernelCase *kernel)
{
  static const KernelCase cases[] = {
    CASE(ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, KINEMATICS_SMALL, MATERIAL_LINEAR),
    CASE(ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, KINEMATICS_SMALL, MATERIAL_LINEAR),
    CASE(ELEMENT_HEX8, GEOMETRY_SOLID, KINEMATICS_SMALL, MATERIAL_LINEAR),
    CASE(ELEMENT_QUAD4, GEOMETRY_PLANE_STRAIN, KINEMATICS_FINITE, MATERIAL_SVK),
    CASE(ELEMENT_QUAD4, GEOMETRY_AXISYMMETRIC, KINEMATICS_FINITE, MATERIAL_NEO_HOOKEAN),
    CASE(ELEMENT_HEX8, GEOMETRY_SOLID, KINEMATICS_FINITE, MATERIAL_NEO_HOOKEAN),
  };
  static unsigned next = 0;

  if (next == sizeof(cases) / sizeof(*cases)) return next = 0;
  *kernel = cases[next++];
  return 1;
}

/* A distorted element away from the axis, bent */
static void Bent(const KernelCase *kernel, double *X, double *u)
{
  const Element *e = ElementGet(kernel->type);

  for (int a = 0; a < e->nodes; a++) {
    for (int i = 0; i < e->dim; i++) {
      X[a * e->dim + i] = e->node[a][i] + 0.1 * sin(7 * a + i) + (i == 0 ? 4 : 0);
      u[a * e->dim + i] = i == 0 ? 0.1 * e->node[a][0] * e->node[a][1] : 0;
    }
  }
}

static void LawSeesOneDilatation(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const Material material = MaterialFromModuli(kernel.law, 100, 0.4);
    double         X[MAX_DOFS], u[MAX_DOFS], H[MAX_POINTS * 9], pressure[MAX_POINTS], first = 0;

    Bent(&kernel, X, u);
    ElementPointState(&kernel, X, u, material.constants, NULL, H, pressure);
    for (int p = 0; p < ElementGet(kernel.type)->points; p++) {
      const double *h = &H[9 * p];
      double        J = 1 + h[0] + h[4] + h[8];

      if (kernel.kinematics == KINEMATICS_FINITE)
        J = (1 + h[0]) * ((1 + h[4]) * (1 + h[8]) - h[5] * h[7]) - h[1] * (h[3] * (1 + h[8]) - h[5] * h[6]) +
            h[2] * (h[3] * h[7] - (1 + h[4]) * h[6]);
      if (p == 0) first = J;
      assert_near(J, first, 1e-14);
    }
  }
}

static double Energy(const KernelCase *kernel, const double *X, const double *u, double nu)
{
  const int      dofs     = ElementGet(kernel->type)->nodes * ElementGet(kernel->type)->dim;
  const Material material = MaterialFromModuli(kernel->law, 1 + nu, nu); /* shear modulus 1/2 */
  double         lanes_X[MAX_DOFS * KERNEL_LANES], lanes_u[MAX_DOFS * KERNEL_LANES], constants[2 * KERNEL_LANES],
    W[KERNEL_LANES], J[KERNEL_LANES];

  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    for (int k = 0; k < 2; k++) constants[k * KERNEL_LANES + lane] = material.constants[k];
    for (int k = 0; k < dofs; k++) {
      lanes_X[k * KERNEL_LANES + lane] = X[k];
      lanes_u[k * KERNEL_LANES + lane] = u[k];
    }
  }
  ElementKernel(kernel, lanes_X, lanes_u, NULL, constants, NULL, W, NULL, NULL, J);
  return W[0];
}

/* A box is bent, at constant volume on the whole: at equal shear modulus the energy settles as the bulk modulus grows,
   that of the plain element does not. St. Venant-Kirchhoff resists the trace of Green's strain, which a constant J does
   not hold: that law is incompressible in small strains only. */
static void BendingDoesNotLock(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const Element *e = ElementGet(kernel.type);
    double         X[MAX_DOFS], u[MAX_DOFS] = {0};

    if (kernel.geometry == GEOMETRY_AXISYMMETRIC || kernel.law == MATERIAL_SVK)
      continue; /* bending moves the one along the radius */
    for (int a = 0; a < e->nodes; a++) {
      for (int i = 0; i < e->dim; i++) X[a * e->dim + i] = e->node[a][i];
      u[a * e->dim] = 0.1 * X[a * e->dim] * X[a * e->dim + 1];
    }
    assert_near(Energy(&kernel, X, u, 0.49999) / Energy(&kernel, X, u, 0.499), 1, 1e-2);
    kernel.formulation = FORMULATION_FULL;
    assert_true(Energy(&kernel, X, u, 0.49999) > 50 * Energy(&kernel, X, u, 0.499));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(LawSeesOneDilatation),
    cmocka_unit_test(BendingDoesNotLock),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
