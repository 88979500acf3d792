/* Shows that mixed triangles and tetrahedra, whose corners have pressures, have the exact tangent of their force with
 * every law and give the stress of the law in a uniform strain. An accepted plastic state keeps force and energy. Those
 * of first order resist no pressure that is the same everywhere: only pressures that differ within an element. Those of
 * second order resist none, and no pressure is without a force. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "kernels/elementkernel.h"
#include "laws.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_DOFS = 42 };
static const double    young = 3, length = 0.7, infinite = 0.5;
static const Hardening hardenings[] = {
  {.yield = 0.02, .linear = 0.3},
  {.yield = 0.02, .linear = 0.002}, /* so flat that elements hold J at their points */
};
static const PlasticBatch hardened = {.hardening = &hardenings[0], .dt = 1},
                          flat     = {.hardening = &hardenings[1], .dt = 1};

typedef struct {
  KernelCase   kernel;
  Material     material;
  PlasticBatch plastic;
  int          n, pressures, dim, dofs; /* n: nodes of the element */
  double       X[MAX_DOFS * KERNEL_LANES], u[MAX_DOFS * KERNEL_LANES], f[MAX_DOFS * KERNEL_LANES],
    K[MAX_DOFS * MAX_DOFS * KERNEL_LANES], constants[MATERIAL_MAX_CONSTANTS * KERNEL_LANES],
    state[PLASTIC_MAX_STATE * KERNEL_LANES], J[KERNEL_LANES];
} Case;

/* The place in the element of a node, perhaps of a pressure */
static const double *Place(const Case *c, int node)
{
  return ElementGet(c->kernel.type)->node[node < c->n ? node : node - c->n];
}

static double Random(void)
{
  static unsigned state = 7;

  state = state * 1664525u + 1013904223u;
  return (double)(state >> 8) / (1 << 24) - 0.5;
}

/* Displacements with strains of some hundredths and pressures of some tenths of the modulus, at random */
static void Deform(Case *c)
{
  const int order = ElementGet(c->kernel.type)->order;

  for (int k = 0; k < c->dofs * KERNEL_LANES; k++)
    c->u[k] = k < c->n * c->dim * KERNEL_LANES ? 0.1 / order * Random() : length * Random();
}

/* An element with corners moved at random. One that yields has flowed before. */
static void CaseCreate(Case *c, KernelCase kernel, double nu)
{
  const Element *e = ElementGet(kernel.type);

  memset(c, 0, sizeof(*c));
  c->kernel             = kernel;
  c->material           = ExampleMaterial(kernel.law, young, nu);
  c->kernel.length      = length;
  c->kernel.n_constants = c->material.n_constants;
  if (kernel.plastic) {
    c->plastic        = *kernel.plastic;
    c->plastic.state  = c->state;
    c->kernel.plastic = &c->plastic;
    assert_int_equal(ElementStatePoints(&kernel), 1);
  }
  c->n         = e->nodes;
  c->pressures = e->corners;
  c->dim       = e->dim;
  c->dofs      = ElementNodes(&c->kernel) * e->dim;
  assert_int_equal(c->dofs, (e->nodes + e->corners) * e->dim);
  assert_int_equal(ElementPressures(&c->kernel), 0);
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    for (int k = 0; k < c->material.n_constants; k++) c->constants[k * KERNEL_LANES + lane] = c->material.constants[k];
    for (int k = 0; k < c->dofs; k++)
      c->X[k * KERNEL_LANES + lane] =
        Place(c, k / e->dim)[k % e->dim] + (k % e->dim == 0 ? 3 : 0) + 0.2 / e->order * Random();
  }
  Deform(c);
  if (kernel.plastic) {
    ElementAcceptState(&c->kernel, c->X, c->u, c->constants, NULL);
    for (int lane = 0; lane < KERNEL_LANES; lane++) assert_true(c->state[PLASTIC_STRAIN * KERNEL_LANES + lane] > 0);
    Deform(c);
  }
}

/* Triangles in the plane and axisymmetric, and tetrahedra, of both orders, with small strains, every law and two
   hardenings, and with pressures in the first or second component. Plastic elements of second order have no pressures
   of nodes. */
static int NextCase(KernelCase *kernel)
{
  enum { SHAPES = 6, SMALL = MATERIAL_LAWS, FLAT, LAWS };
  static const struct {
    ElementType type;
    Geometry    geometry;
  } shapes[SHAPES] = {
    {ELEMENT_TRI3, GEOMETRY_PLANE_STRAIN}, {ELEMENT_TRI3, GEOMETRY_AXISYMMETRIC}, {ELEMENT_TET4, GEOMETRY_SOLID},
    {ELEMENT_TRI6, GEOMETRY_PLANE_STRAIN}, {ELEMENT_TRI6, GEOMETRY_AXISYMMETRIC}, {ELEMENT_TET10, GEOMETRY_SOLID},
  };
  static int next = 0;

  for (; next < SHAPES * LAWS; next++) {
    const int         row = next / SHAPES;
    const MaterialLaw law = row == SMALL ? MATERIAL_LINEAR : row == FLAT ? MATERIAL_VON_MISES : (MaterialLaw)row;

    *kernel = (KernelCase){.type        = shapes[next % SHAPES].type,
                           .geometry    = shapes[next % SHAPES].geometry,
                           .kinematics  = row == SMALL ? KINEMATICS_SMALL : KINEMATICS_FINITE,
                           .law         = law,
                           .formulation = FORMULATION_MIXED,
                           .component   = next % 2};
    if (law == MATERIAL_VON_MISES) kernel->plastic = row == FLAT ? &flat : &hardened;
    if (row == MATERIAL_LINEAR || !ElementKernelExists(kernel)) continue;
    if (ElementGet(kernel->type)->order == 2 && MaterialGetLaw(kernel->law)->plastic) {
      assert_true(ElementPressures(kernel) > 0);
      continue;
    }
    next++;
    return 1;
  }
  return next = 0;
}

static void Evaluate(Case *c, double *f, double *K)
{
  ElementKernel(&c->kernel, c->X, c->u, NULL, c->constants, NULL, NULL, f, K, c->J);
}

static void TangentIsTheDerivative(void **state)
{
  const double h      = 1e-6;
  int          tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    for (int stiff = 0; stiff < 2; stiff++) {
      double f[2][MAX_DOFS * KERNEL_LANES], scale = 0;
      Case   c;

      CaseCreate(&c, kernel, stiff ? infinite : 0.4);
      Evaluate(&c, c.f, c.K);
      for (int k = 0; k < c.dofs * c.dofs * KERNEL_LANES; k++) scale = fmax(scale, fabs(c.K[k]));
      assert_true(isfinite(scale) && scale > 0);
      for (int j = 0; j < c.dofs; j++) {
        for (int side = 0; side < 2; side++) {
          for (int lane = 0; lane < KERNEL_LANES; lane++) c.u[j * KERNEL_LANES + lane] += side ? -2 * h : h;
          Evaluate(&c, f[side], NULL);
        }
        for (int lane = 0; lane < KERNEL_LANES; lane++) c.u[j * KERNEL_LANES + lane] += h;
        for (int k = 0; k < c.dofs * KERNEL_LANES; k++) {
          const double difference = (f[0][k] - f[1][k]) / (2 * h);

          assert_near(c.K[(k / KERNEL_LANES * c.dofs + j) * KERNEL_LANES + k % KERNEL_LANES], difference, 1e-7 * scale);
        }
      }
      tested++;
    }
  }
  assert_true(tested >= 2 * 6 * 7);
}

/* The force is the derivative of the energy, with the other sign in the rows of the pressures. */
static void ForceIsTheDerivativeOfTheEnergy(void **state)
{
  const double h      = 1e-6;
  int          tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    for (int stiff = 0; stiff < 2; stiff++) {
      double W[2][KERNEL_LANES], scale = 0;
      Case   c;

      CaseCreate(&c, kernel, stiff ? infinite : 0.4);
      Evaluate(&c, c.f, NULL);
      for (int k = 0; k < c.dofs * KERNEL_LANES; k++) scale = fmax(scale, fabs(c.f[k]));
      assert_true(isfinite(scale) && scale > 0);
      for (int j = 0; j < c.dofs; j++) {
        const int component = j % c.dim, pressure = j >= c.n * c.dim;

        if (pressure && component != c.kernel.component) continue;
        for (int side = 0; side < 2; side++) {
          for (int lane = 0; lane < KERNEL_LANES; lane++) c.u[j * KERNEL_LANES + lane] += side ? -2 * h : h;
          ElementKernel(&c.kernel, c.X, c.u, NULL, c.constants, NULL, W[side], NULL, NULL, c.J);
        }
        for (int lane = 0; lane < KERNEL_LANES; lane++) {
          c.u[j * KERNEL_LANES + lane] += h;
          assert_near(c.f[j * KERNEL_LANES + lane], (pressure ? -1 : 1) * (W[0][lane] - W[1][lane]) / (2 * h),
                      1e-7 * scale);
        }
      }
      tested++;
    }
  }
  assert_true(tested >= 2 * 6 * 7);
}

/* Energy and force are the same after a state was accepted. Accepted again, it stays. */
static void AcceptedStateStays(void **state)
{
  int tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    double f[MAX_DOFS * KERNEL_LANES], W[2][KERNEL_LANES], first[PLASTIC_MAX_STATE * KERNEL_LANES], largest = 0;
    Case   c;

    if (!kernel.plastic) continue;
    CaseCreate(&c, kernel, 0.4);
    ElementKernel(&c.kernel, c.X, c.u, NULL, c.constants, NULL, W[0], c.f, NULL, c.J);
    ElementAcceptState(&c.kernel, c.X, c.u, c.constants, NULL);
    ElementKernel(&c.kernel, c.X, c.u, NULL, c.constants, NULL, W[1], f, NULL, c.J);
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) largest = fmax(largest, fabs(f[k]));
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) assert_near(f[k], c.f[k], 1e-12 * largest);
    for (int lane = 0; lane < KERNEL_LANES; lane++) assert_near(W[1][lane], W[0][lane], 1e-12 * fabs(W[0][lane]));
    memcpy(first, c.state, sizeof first);
    ElementAcceptState(&c.kernel, c.X, c.u, c.constants, NULL);
    for (int k = 0; k < ElementStates(&c.kernel) * KERNEL_LANES; k++) assert_near(c.state[k], first[k], 0);
    tested++;
  }
  assert_int_equal(tested, 6);
}

/* In a uniform strain with the pressure of the law nothing acts on the pressures, and the stress is that of the law. */
static void UniformStrainHasTheStressOfTheLaw(void **state)
{
  const double a = 0.02, b = -0.01;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const int finite = kernel.kinematics == KINEMATICS_FINITE, plane = kernel.geometry == GEOMETRY_PLANE_STRAIN;
    double    H[9] = {a, 0, 0, 0, b, 0, 0, 0, plane ? 0 : a}, P[9], F[3] = {1, 1, 1}, J = 1, tau;
    Case      c;

    if (kernel.law == MATERIAL_VON_MISES) continue;
    CaseCreate(&c, kernel, 0.49);
    for (int i = 0; i < 3 && finite; i++) F[i] += H[4 * i];
    J   = F[0] * F[1] * F[2];
    tau = c.material.constants[0] * (finite ? log(J) : H[0] + H[4] + H[8]);
    MaterialPoint(&c.material, finite, H, NULL, P, NULL);
    for (int k = 0; k < c.dofs * KERNEL_LANES; k++) {
      const int i = k / KERNEL_LANES % c.dim;

      c.u[k] = k < c.n * c.dim * KERNEL_LANES ? H[4 * i] * c.X[k] : tau * length / MaterialShear(&c.material);
    }
    Evaluate(&c, c.f, NULL);
    for (int k = c.n * c.dim * KERNEL_LANES; k < c.dofs * KERNEL_LANES; k++) assert_near(c.f[k], 0, 1e-13 * young);
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
      double X[MAX_DOFS], u[MAX_DOFS], stress[6], volume;

      for (int k = 0; k < c.dofs; k++) {
        X[k] = c.X[k * KERNEL_LANES + lane];
        u[k] = c.u[k * KERNEL_LANES + lane];
      }
      ElementStress(&c.kernel, X, u, c.material.constants, NULL, stress, &volume);
      for (int i = 0; i < 3; i++) assert_near(stress[i], P[4 * i] * F[i] / J, 1e-12 * young);
    }
  }
}

/* Where the volume is kept exactly, the rows and columns of the pressures are opposite but for a block. In elements of
   first order it resists differences of pressures alone, in those of second order nothing. */
static void OnlyDifferencesOfPressuresAreResisted(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const int second = ElementGet(kernel.type)->order == 2;
    Case      c;

    CaseCreate(&c, kernel, infinite);
    Evaluate(&c, c.f, c.K);
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
      const double *K = &c.K[lane];

      for (int a = 0; a < c.pressures; a++) {
        const int p   = (c.n + a) * c.dim + kernel.component;
        double    sum = 0;

        for (int r = 0; r < c.n * c.dim; r++)
          assert_near(K[(r * c.dofs + p) * KERNEL_LANES], -K[(p * c.dofs + r) * KERNEL_LANES], 0);
        for (int b = 0; b < c.pressures; b++)
          sum += K[(p * c.dofs + (c.n + b) * c.dim + kernel.component) * KERNEL_LANES];
        assert_near(sum, 0, 1e-14 * young);
        assert_true(second ? K[(p * c.dofs + p) * KERNEL_LANES] == 0 : K[(p * c.dofs + p) * KERNEL_LANES] > 0);
      }
    }
  }
}

/* Makes a column orthogonal to earlier ones, and returns the square of what is left. */
static double Orthogonalise(int n, int earlier, double G[][MAX_DOFS])
{
  double *g = G[earlier], left = 0;

  for (int b = 0; b < earlier; b++) {
    double product = 0, square = 0;

    for (int r = 0; r < n; r++) product += g[r] * G[b][r];
    for (int r = 0; r < n; r++) square += G[b][r] * G[b][r];
    for (int r = 0; r < n; r++) g[r] -= product / square * G[b][r];
  }
  for (int r = 0; r < n; r++) left += g[r] * g[r];
  return left;
}

/* The pressures of an element of second order have forces on its nodes that are independent. */
static void PressuresOfSecondOrderHaveForces(void **state)
{
  int tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    double G[4][MAX_DOFS], size = 0;
    Case   c;

    if (ElementGet(kernel.type)->order == 1) continue;
    CaseCreate(&c, kernel, infinite);
    Evaluate(&c, c.f, c.K);
    for (int a = 0; a < c.pressures; a++) {
      for (int r = 0; r < c.n * c.dim; r++)
        G[a][r] = c.K[(r * c.dofs + (c.n + a) * c.dim + kernel.component) * KERNEL_LANES];
      for (int r = 0; r < c.n * c.dim; r++) size = fmax(size, fabs(G[a][r]));
      assert_true(Orthogonalise(c.n * c.dim, a, G) > 0.01 * size * size);
    }
    tested++;
  }
  assert_true(tested >= 3 * 7);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(TangentIsTheDerivative),
    cmocka_unit_test(ForceIsTheDerivativeOfTheEnergy),
    cmocka_unit_test(AcceptedStateStays),
    cmocka_unit_test(UniformStrainHasTheStressOfTheLaw),
    cmocka_unit_test(OnlyDifferencesOfPressuresAreResisted),
    cmocka_unit_test(PressuresOfSecondOrderHaveForces),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
