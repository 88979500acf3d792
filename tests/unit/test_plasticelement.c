/* Shows for plastic elements of every type, geometry, kinematics and formulation that force and tangent are derivatives
   of the incremental potential from a state that has flowed, and that an accepted state is taken on once. */
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

static const double    E = 200, nu = 0.3;
static const Hardening hardenings[] = {
  {.yield = 0.5, .linear = 3, .saturation = 0.9, .rate = 15},
  {.yield = 0.5, .linear = 3, .terms = 2, .backstress = {{5, 30}, {2, 0}}, .overstress = 0.2, .speed = 0.7, .power = 3},
  {.yield = 0.5, .linear = 3, .terms = 1, .backstress = {{5, 30}}},
  {.yield = 0.5, .linear = 0.1}, /* so flat that elements hold J at their points */
};
enum { HARDENINGS = sizeof hardenings / sizeof *hardenings };

typedef struct {
  KernelCase     kernel;
  PlasticBatch   plastic;
  const Element *e;
  int            dofs, states; /* states: of a point */
  double         X[MAX_DOFS * KERNEL_LANES], u[MAX_DOFS * KERNEL_LANES], constants[2 * KERNEL_LANES],
    state[ELEMENT_MAX_POINTS * PLASTIC_MAX_STATE * KERNEL_LANES], W[KERNEL_LANES], f[MAX_DOFS * KERNEL_LANES],
    J[KERNEL_LANES];
} Batch;

static double Random(void)
{
  static unsigned state = 4711;

  state = state * 1664525u + 1013904223u;
  return (double)(state >> 8) / (1 << 24) - 0.5;
}

/* Displacements that stretch by `stretch` along x, and random ones beside */
static void Deform(Batch *b, double stretch)
{
  for (int k = 0; k < b->dofs; k++) {
    for (int lane = 0; lane < KERNEL_LANES; lane++)
      b->u[k * KERNEL_LANES + lane] =
        0.02 * Random() + (k % b->e->dim == 0 ? stretch * b->X[k * KERNEL_LANES + lane] : 0);
  }
}

static void BatchCreate(Batch *b, KernelCase kernel, const Hardening *hardening)
{
  const Material material = MaterialFromModuli(MATERIAL_VON_MISES, E, nu);

  memset(b, 0, sizeof *b);
  b->kernel         = kernel;
  b->plastic        = (PlasticBatch){.hardening = hardening, .dt = 0.4, .state = b->state};
  b->kernel.plastic = &b->plastic;
  b->e              = ElementGet(kernel.type);
  b->states         = ElementStates(&b->kernel);
  b->dofs           = b->e->nodes * b->e->dim;
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    for (int k = 0; k < 2; k++) b->constants[k * KERNEL_LANES + lane] = material.constants[k];
    for (int k = 0; k < b->dofs; k++)
      b->X[k * KERNEL_LANES + lane] =
        b->e->node[k / b->e->dim][k % b->e->dim] + 0.1 * Random() + (k % b->e->dim == 0 ? 3 : 0);
  }
  Deform(b, 0.04);
  ElementAcceptState(&b->kernel, b->X, b->u, b->constants, NULL);
}

static void Evaluate(Batch *b, double *W, double *f, double *K)
{
  ElementKernel(&b->kernel, b->X, b->u, NULL, b->constants, NULL, W, f, K, b->J);
}

/* All hardenings x elements x geometries x formulations with a kernel, in small and in finite strains */
static int NextCase(KernelCase *kernel, const Hardening **hardening)
{
  static int next = 0;

  for (; next < HARDENINGS * ELEMENT_TYPES * 2 * 2 * FORMULATIONS; next++) {
    const ElementType type = (ElementType)(next / (4 * FORMULATIONS) % ELEMENT_TYPES);
    const int         axis = next / (2 * FORMULATIONS) % 2, dim = ElementGet(type)->dim;

    *kernel = (KernelCase){.type        = type,
                           .geometry    = dim == 3 ? GEOMETRY_SOLID
                                          : axis   ? GEOMETRY_AXISYMMETRIC
                                                   : GEOMETRY_PLANE_STRAIN,
                           .kinematics  = next / FORMULATIONS % 2 ? KINEMATICS_FINITE : KINEMATICS_SMALL,
                           .law         = MATERIAL_VON_MISES,
                           .formulation = (Formulation)(next % FORMULATIONS)};
    if (dim < 2 || (dim == 3 && axis) || !ElementKernelExists(kernel)) continue;
    if (ElementNodes(kernel) > ElementGet(type)->nodes) continue; /* test_nodalpressure.c */
    *hardening = &hardenings[next / (ELEMENT_TYPES * 4 * FORMULATIONS)];
    next++;
    return 1;
  }
  next = 0;
  return 0;
}

static double LargestStrain(const Batch *b, int lane)
{
  double strain = 0;

  for (int p = 0; p < b->e->points; p++)
    strain = fmax(strain, b->state[(p * b->states + PLASTIC_STRAIN) * KERNEL_LANES + lane]);
  return strain;
}

static void ForceAndTangentAreDerivatives(void **unused)
{
  const double     step = 2e-7; /* the onset of viscous flow is curved */
  const Hardening *hardening;
  KernelCase       kernel;
  int              cases = 0;

  (void)unused;
  for (; NextCase(&kernel, &hardening); cases++) {
    Batch   b;
    double *K, f[MAX_DOFS * KERNEL_LANES], plus[MAX_DOFS * KERNEL_LANES], minus[MAX_DOFS * KERNEL_LANES],
      W[2][KERNEL_LANES];
    double stiffness = 0;

    BatchCreate(&b, kernel, hardening);
    for (int lane = 0; lane < KERNEL_LANES; lane++) assert_true(LargestStrain(&b, lane) > 0.005);
    Deform(&b, 0.06);
    K = calloc((size_t)b.dofs * b.dofs * KERNEL_LANES, sizeof *K);
    Evaluate(&b, NULL, f, K);
    for (int k = 0; k < b.dofs * b.dofs * KERNEL_LANES; k++) stiffness = fmax(stiffness, fabs(K[k]));
    for (int s = 0; s < b.dofs; s++) {
      for (int lane = 0; lane < KERNEL_LANES; lane++) b.u[s * KERNEL_LANES + lane] += step;
      Evaluate(&b, W[0], plus, NULL);
      for (int lane = 0; lane < KERNEL_LANES; lane++) b.u[s * KERNEL_LANES + lane] -= 2 * step;
      Evaluate(&b, W[1], minus, NULL);
      for (int lane = 0; lane < KERNEL_LANES; lane++) {
        const int k = s * KERNEL_LANES + lane;

        b.u[k] += step;
        assert_near(f[k], (W[0][lane] - W[1][lane]) / (2 * step), 1e-7 * stiffness);
        for (int r = 0; r < b.dofs; r++)
          assert_near(K[(r * b.dofs + s) * KERNEL_LANES + lane],
                      (plus[r * KERNEL_LANES + lane] - minus[r * KERNEL_LANES + lane]) / (2 * step), 1e-7 * stiffness);
      }
    }
    free(K);
  }
  assert_true(cases > 80);
}

/* Energy and force are the same after a state was accepted. Accepted again, it stays. */
static void AcceptedStateStays(void **unused)
{
  const Hardening *hardening;
  KernelCase       kernel;

  (void)unused;
  while (NextCase(&kernel, &hardening)) {
    Batch  b, again;
    double f[MAX_DOFS * KERNEL_LANES], W[KERNEL_LANES], largest = 0;
    int    bubble = ElementStatePoints(&kernel) > ElementGet(kernel.type)->points;

    BatchCreate(&b, kernel, hardening);
    Deform(&b, 0.06);
    Evaluate(&b, b.W, b.f, NULL);
    ElementAcceptState(&b.kernel, b.X, b.u, b.constants, NULL);
    b.plastic.dt = 0;
    Evaluate(&b, W, f, NULL);
    for (int k = 0; k < b.dofs * KERNEL_LANES; k++) largest = fmax(largest, fabs(f[k]));
    for (int k = 0; k < b.dofs * KERNEL_LANES; k++) assert_near(f[k], b.f[k], 1e-7 * largest);
    for (int lane = 0; lane < KERNEL_LANES && hardening->overstress <= 0; lane++)
      assert_near(W[lane], b.W[lane], 1e-9 * W[lane]);
    again                = b;
    again.plastic.state  = again.state;
    again.kernel.plastic = &again.plastic;
    ElementAcceptState(&again.kernel, b.X, b.u, b.constants, NULL);
    for (int k = 0; k < ElementStatePoints(&b.kernel) * b.states * KERNEL_LANES; k++)
      assert_near(again.state[k], b.state[k], kernel.formulation == FORMULATION_ENHANCED || bubble ? 1e-7 : 0);
  }
}

/* The stress of one cell is that of its lane. */
static void StressIsThatOfTheLane(void **unused)
{
  const Hardening *hardening;
  KernelCase       kernel;

  (void)unused;
  while (NextCase(&kernel, &hardening)) {
    Batch b;

    if (hardening->terms) continue;
    BatchCreate(&b, kernel, hardening);
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
      double X[MAX_DOFS], u[MAX_DOFS], constants[2], stress[ELEMENT_MAX_POINTS * 6], volume[ELEMENT_MAX_POINTS];

      for (int k = 0; k < b.dofs; k++) {
        X[k] = b.X[k * KERNEL_LANES + lane];
        u[k] = b.u[k * KERNEL_LANES + lane];
      }
      for (int k = 0; k < 2; k++) constants[k] = b.constants[k * KERNEL_LANES + lane];
      b.plastic.lane = lane;
      ElementPointStress(&b.kernel, X, u, constants, NULL, stress, volume);
      for (int p = 0; p < b.e->points; p++) {
        const double *s = &stress[6 * p], mean = (s[0] + s[1] + s[2]) / 3;
        const double  strain = b.state[(p * b.states + PLASTIC_STRAIN) * KERNEL_LANES + lane];
        double        slope, work, yield = HardeningStress(hardening, strain, &slope, &work), square = 0, J = 1;

        for (int i = 0; i < 3; i++) square += (s[i] - mean) * (s[i] - mean) + 2 * s[3 + i] * s[3 + i];
        for (int i = 0; i < 50; i++) J = exp(3 * mean * (1 - 2 * nu) / E * J); /* mean = bulk ln J / J */
        if (kernel.kinematics == KINEMATICS_FINITE) yield /= J;                /* Kirchhoff stress is J times Cauchy */
        if (strain > 0 && kernel.formulation != FORMULATION_ENHANCED && kernel.formulation != FORMULATION_MIXED)
          assert_near(sqrt(1.5 * square), yield, 1e-10 * yield);
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ForceAndTangentAreDerivatives),
    cmocka_unit_test(AcceptedStateStays),
    cmocka_unit_test(StressIsThatOfTheLane),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
