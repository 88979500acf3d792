/* Shows what mixed elements do with multipliers: force and tangent are derivatives of the energy of an incompressible
 * element, multipliers that do not change any more leave the pressure of the whole modulus, and those that follow
 * Newton's method start from the same pressure. Elements that yield have the forces of the others. test_elementkernel.c
 * treats mixed elements without multipliers. Pressures of triangles and tetrahedra of second order are condensed here;
 * test_nodalpressure.c has those of nodes. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "kernels/elementkernel.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_DOFS = ELEMENT_MAX_NODES * 3 };
static const double mu = 3;

typedef struct {
  KernelCase kernel;
  int        dofs, pressures;
  double     X[MAX_DOFS * KERNEL_LANES], u[MAX_DOFS * KERNEL_LANES], constants[2 * KERNEL_LANES],
    multiplier[MIXED_PRESSURES * KERNEL_LANES];
} Case;

static double Random(void)
{
  static unsigned state = 99;

  state = state * 1664525u + 1013904223u;
  return (double)(state >> 8) / (1 << 24) - 0.5;
}

/* Elements with corners moved at random and straight edges, in a strain of some hundredths */
static void CaseCreate(Case *c, KernelCase kernel, double modulus)
{
  const Element    *e     = ElementGet(kernel.type);
  const ElementType first = e->order == 1 ? e->type : (ElementType)(e->type - 1);

  c->kernel    = kernel;
  c->dofs      = e->nodes * e->dim;
  c->pressures = ElementPressures(&kernel);
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    double corner[8][3];

    c->constants[lane]                = modulus;
    c->constants[KERNEL_LANES + lane] = mu;
    for (int a = 0; a < e->corners; a++) {
      for (int i = 0; i < e->dim; i++) corner[a][i] = e->node[a][i] + 0.2 * Random() + (i == 0 ? 3 : 0);
    }
    for (int k = 0; k < c->dofs; k++) {
      double N[ELEMENT_MAX_NODES];

      ElementShape(first, e->node[k / e->dim], N, NULL, NULL);
      c->X[k * KERNEL_LANES + lane] = 0;
      for (int a = 0; a < e->corners; a++) c->X[k * KERNEL_LANES + lane] += N[a] * corner[a][k % e->dim];
      c->u[k * KERNEL_LANES + lane] = 0.02 * Random();
    }
    for (int k = 0; k < c->pressures; k++) c->multiplier[k * KERNEL_LANES + lane] = mu * Random();
  }
}

/* All mixed elements x geometries x (small, finite) */
static int NextCase(KernelCase *kernel)
{
  static int next = 0;

  for (; next < ELEMENT_TYPES * 4;) {
    *kernel = (KernelCase){.type        = (ElementType)(next / 4),
                           .geometry    = next & 1 ? GEOMETRY_AXISYMMETRIC : GEOMETRY_PLANE_STRAIN,
                           .kinematics  = next & 2 ? KINEMATICS_FINITE : KINEMATICS_SMALL,
                           .law         = next & 2 ? MATERIAL_NEO_HOOKEAN : MATERIAL_LINEAR,
                           .formulation = FORMULATION_MIXED,
                           .condensed   = 1};
    if (ElementGet(kernel->type)->dim == 3) kernel->geometry = next & 1 ? GEOMETRY_AXISYMMETRIC : GEOMETRY_SOLID;
    next++;
    if (ElementGet(kernel->type)->dim > 1 && ElementKernelExists(kernel) && ElementPressures(kernel) > 0) return 1;
  }
  return next = 0;
}

static void MultipliersHaveAnEnergy(void **state)
{
  const double h      = 1e-6;
  int          tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    double W[2][KERNEL_LANES], f[3][MAX_DOFS * KERNEL_LANES], J[KERNEL_LANES], *K, scale = 0;
    Case   c;

    CaseCreate(&c, kernel, INFINITY);
    K = calloc((size_t)c.dofs * c.dofs * KERNEL_LANES, sizeof(double));
    ElementKernel(&kernel, c.X, c.u, NULL, c.constants, c.multiplier, W[0], f[2], K, J);
    for (int k = 0; k < c.dofs * c.dofs * KERNEL_LANES; k++) scale = fmax(scale, fabs(K[k]));
    assert_true(isfinite(scale));
    for (int j = 0; j < c.dofs; j++) {
      for (int side = 0; side < 2; side++) {
        for (int lane = 0; lane < KERNEL_LANES; lane++) c.u[j * KERNEL_LANES + lane] += side ? -2 * h : h;
        ElementKernel(&kernel, c.X, c.u, NULL, c.constants, c.multiplier, W[side], f[side], NULL, J);
      }
      for (int lane = 0; lane < KERNEL_LANES; lane++) {
        c.u[j * KERNEL_LANES + lane] += h;
        assert_near(f[2][j * KERNEL_LANES + lane], (W[0][lane] - W[1][lane]) / (2 * h), 1e-8 * scale);
        for (int i = 0; i < c.dofs; i++)
          assert_near(K[(i * c.dofs + j) * KERNEL_LANES + lane],
                      (f[0][i * KERNEL_LANES + lane] - f[1][i * KERNEL_LANES + lane]) / (2 * h), 1e-8 * scale);
      }
    }
    free(K);
    tested++;
  }
  assert_int_equal(tested, 18);
}

/* A uniform expansion has the same pressure everywhere. With the multipliers at which the augmented Lagrangian settles
 * it is that of the law with its whole modulus. */
static void SettledMultipliersGiveTheWholeModulus(void **state)
{
  const double modulus = 1e5 * mu, a = 1e-3;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const Material material = {.law = kernel.law, .n_constants = 2, .constants = {modulus, mu}};
    double         H[9]     = {a, 0, 0, 0, a, 0, 0, 0, kernel.geometry == GEOMETRY_PLANE_STRAIN ? 0 : a}, P[9];
    double         theta[MIXED_PRESSURES * KERNEL_LANES];
    VolumeModuli   moduli;
    Case           c;

    CaseCreate(&c, kernel, modulus);
    ElementVolumeModuli(&kernel, c.constants, KERNEL_LANES, &moduli);
    assert_true(moduli.kappa < moduli.projected && moduli.mu == mu);
    assert_near(moduli.local + moduli.projected, modulus, 1e-15 * modulus);
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) c.u[k] = a * c.X[k];
    for (int times = 0; times < 400; times++) {
      ElementDilatation(&kernel, c.X, c.u, c.constants, c.multiplier, theta);
      for (int k = 0; k < c.pressures * KERNEL_LANES; k++)
        c.multiplier[k] = (1 - moduli.kappa / moduli.projected) * (c.multiplier[k] + moduli.kappa * theta[k]);
    }
    MaterialPoint(&material, kernel.kinematics == KINEMATICS_FINITE, H, NULL, P, NULL);
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
      double X[MAX_DOFS], u[MAX_DOFS], m[MIXED_PRESSURES], stress[6], volume,
        stretch = kernel.kinematics == KINEMATICS_FINITE ? 1 + a : 1;

      for (int k = 0; k < c.dofs; k++) {
        X[k] = c.X[k * KERNEL_LANES + lane];
        u[k] = c.u[k * KERNEL_LANES + lane];
      }
      for (int k = 0; k < c.pressures; k++) m[k] = c.multiplier[k * KERNEL_LANES + lane];
      ElementStress(&kernel, X, u, material.constants, m, stress, &volume);
      for (int i = 0; i < 3; i++)
        assert_near(stress[i], P[4 * i] * (1 + H[4 * i] * (stretch != 1)) / pow(stretch, H[8] == 0 ? 2 : 3),
                    1e-9 * fabs(P[0]));
    }
  }
}

/* From the state itself the pressure is multiplier + kappa theta, and nothing else. */
static void FollowingStartsFromTheSamePressure(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    double       theta[MIXED_PRESSURES * KERNEL_LANES], next[MIXED_PRESSURES * KERNEL_LANES];
    VolumeModuli moduli;
    Case         c;

    if (kernel.kinematics == KINEMATICS_SMALL) continue;
    CaseCreate(&c, kernel, INFINITY);
    ElementVolumeModuli(&kernel, c.constants, KERNEL_LANES, &moduli);
    ElementDilatation(&kernel, c.X, c.u, c.constants, c.multiplier, theta);
    for (int rate = 0; rate < 2; rate++) {
      const StressReference reference = {c.u, rate, 0};

      ElementFollow(&kernel, c.X, c.u, &reference, c.constants, c.multiplier, next);
      for (int k = 0; k < c.pressures * KERNEL_LANES; k++)
        assert_near(next[k], c.multiplier[k] + moduli.kappa * theta[k], 1e-11 * moduli.kappa);
    }
  }
}

/* With the multipliers of a state itself, elements that yield have the forces of that state. */
static void YieldingElementsHaveTheSameForces(void **state)
{
  int tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    double     f[2][MAX_DOFS * KERNEL_LANES], next[MIXED_PRESSURES * KERNEL_LANES], J[KERNEL_LANES], scale = 0;
    KernelCase soft = kernel;
    Case       c;

    CaseCreate(&c, kernel, 1e3 * mu);
    const StressReference reference = {c.u, 1, 0};

    soft.yields = 1;
    ElementYield(&kernel, c.X, c.u, &reference, c.constants, NULL, next);
    ElementKernel(&kernel, c.X, c.u, NULL, c.constants, NULL, NULL, f[0], NULL, J);
    ElementKernel(&soft, c.X, c.u, NULL, c.constants, next, NULL, f[1], NULL, J);
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) scale = fmax(scale, fabs(f[0][k]));
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) assert_near(f[0][k], f[1][k], 1e-9 * scale);
    tested++;
  }
  assert_int_equal(tested, 18);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(MultipliersHaveAnEnergy),
    cmocka_unit_test(SettledMultipliersGiveTheWholeModulus),
    cmocka_unit_test(FollowingStartsFromTheSamePressure),
    cmocka_unit_test(YieldingElementsHaveTheSameForces),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
