/* Shows that enhanced elements bend like beams, do not hourglass under compression, and report a state in which their
 * modes find no rest. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "eigenvalues.h"
#include "kernels/elementkernel.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { MAX_DOFS = 24 };

static const double young = 200, poisson = 0.3;

typedef struct {
  double W, f[MAX_DOFS], K[MAX_DOFS * MAX_DOFS], J;
  int    dofs;
} Result;

static void Evaluate(const KernelCase *kernel, const double *X, const double *u, double nu, Result *result)
{
  static double lanes_X[MAX_DOFS * KERNEL_LANES], lanes_u[MAX_DOFS * KERNEL_LANES], f[MAX_DOFS * KERNEL_LANES],
    K[MAX_DOFS * MAX_DOFS * KERNEL_LANES];
  const Material material = MaterialFromModuli(kernel->law, young, nu);
  double         constants[2 * KERNEL_LANES], W[KERNEL_LANES], J[KERNEL_LANES];
  const Element *e = ElementGet(kernel->type);

  result->dofs = e->nodes * e->dim;
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    for (int k = 0; k < 2; k++) constants[k * KERNEL_LANES + lane] = material.constants[k];
    for (int k = 0; k < result->dofs; k++) {
      lanes_X[k * KERNEL_LANES + lane] = X[k];
      lanes_u[k * KERNEL_LANES + lane] = u[k];
    }
  }
  ElementKernel(kernel, lanes_X, lanes_u, NULL, constants, NULL, W, f, K, J);
  result->W = W[0];
  result->J = J[0];
  for (int k = 0; k < result->dofs; k++) result->f[k] = f[k * KERNEL_LANES];
  for (int k = 0; k < result->dofs * result->dofs; k++) result->K[k] = K[k * KERNEL_LANES];
}

/* A box of 2 x 2 height x 2 */
static void Box(ElementType type, double height, double *X)
{
  const Element *e = ElementGet(type);

  for (int a = 0; a < e->nodes; a++) {
    for (int i = 0; i < e->dim; i++) X[a * e->dim + i] = e->node[a][i] * (i == 1 ? height : 1);
  }
}

/* u_x = c x y, and in space u_z = -nu c y z: the energy is a beam's, E I c^2 L / 2, with E / (1 - nu^2) in plane strain
 */
static void BendingEnergyIsABeams(void **state)
{
  const double curvature = 1e-3;

  (void)state;
  for (int solid = 0; solid < 2; solid++) {
    for (double height = 0.01; height < 2; height *= 10) {
      const KernelCase kernel = {.type        = solid ? ELEMENT_HEX8 : ELEMENT_QUAD4,
                                 .geometry    = solid ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN,
                                 .kinematics  = KINEMATICS_SMALL,
                                 .law         = MATERIAL_LINEAR,
                                 .formulation = FORMULATION_ENHANCED};
      const int    dim    = solid ? 3 : 2;
      const double moment = 2 * height * height * height / 3 * (solid ? 2 : 1 / (1 - poisson * poisson));
      double       X[MAX_DOFS], u[MAX_DOFS] = {0};
      Result       result;

      Box(kernel.type, height, X);
      for (int a = 0; a < (solid ? 8 : 4); a++) {
        u[a * dim] = curvature * X[a * dim] * X[a * dim + 1];
        if (solid) u[a * dim + 2] = -poisson * curvature * X[a * dim + 1] * X[a * dim + 2];
      }
      Evaluate(&kernel, X, u, poisson, &result);
      assert_near(result.W, young * moment * curvature * curvature, 1e-12 * result.W);
    }
  }
}

/* Stretch across at which a box compressed to `stretch` has no stress there: bisection */
static double FreeStretch(MaterialLaw law, double nu, int dim, double stretch)
{
  const Material material = MaterialFromModuli(law, young, nu);
  double         low = 0.2, high = 3;

  while (high - low > 1e-14) {
    const double middle = (low + high) / 2,
                 H[9]   = {middle - 1, 0, 0, 0, stretch - 1, 0, 0, 0, dim == 3 ? middle - 1 : 0};
    double P[9];

    MaterialPoint(&material, 1, H, NULL, P, NULL);
    if (P[0] > 0)
      high = middle;
    else
      low = middle;
  }
  return low;
}

/* Least eigenvalue of the tangent over the hourglass displacements alone (products of two or three reference
 * coordinates), of a compressed box */
static double LeastHourglass(const KernelCase *kernel, double nu, double height, double stretch)
{
  const Element *e      = ElementGet(kernel->type);
  const double   across = FreeStretch(kernel->law, nu, e->dim, stretch);
  double         X[MAX_DOFS], u[MAX_DOFS], hourglass[12][MAX_DOFS] = {{0}}, A[12 * 12], value[12];
  int            n = 0;
  Result         result;

  Box(kernel->type, height, X);
  for (int k = 0; k < e->nodes * e->dim; k++) u[k] = X[k] * ((k % e->dim == 1 ? stretch : across) - 1);
  Evaluate(kernel, X, u, nu, &result);
  assert_true(result.J > 0);
  for (int mask = 1; mask < 1 << e->dim; mask++) {
    if ((mask & (mask - 1)) == 0) continue;
    for (int i = 0; i < e->dim; i++, n++) {
      for (int a = 0; a < e->nodes; a++) {
        hourglass[n][a * e->dim + i] = 1;
        for (int k = 0; k < e->dim; k++) hourglass[n][a * e->dim + i] *= mask >> k & 1 ? e->node[a][k] : 1;
      }
    }
  }
  for (int r = 0; r < n; r++) {
    for (int s = 0; s < n; s++) {
      A[r * n + s] = 0;
      for (int k = 0; k < result.dofs * result.dofs; k++)
        A[r * n + s] += hourglass[r][k / result.dofs] * result.K[k] * hourglass[s][k % result.dofs];
    }
  }
  Eigenvalues(n, A, value);
  return value[0] / young;
}

/* Flat, square and upright boxes, down to half their height with neo-Hooke; St. Venant-Kirchhoff has no more resistance
   itself below 0.58. A brick has hourglasses that are bending of a flat plate, which buckles: there it is only never
   less stable than the plain brick. */
static void CompressedElementsDoNotHourglass(void **state)
{
  const double heights[] = {0.2, 1, 5}, ratios[] = {0.3, 0.49};

  (void)state;
  for (int law = MATERIAL_SVK; law <= MATERIAL_NEO_HOOKEAN; law++) {
    for (int i = 0; i < 6; i++) {
      for (double stretch = 0.95; stretch > (law == MATERIAL_SVK ? 0.6 : 0.45); stretch -= 0.05) {
        KernelCase   kernel = {.type        = ELEMENT_QUAD4,
                               .geometry    = GEOMETRY_PLANE_STRAIN,
                               .kinematics  = KINEMATICS_FINITE,
                               .law         = (MaterialLaw)law,
                               .formulation = FORMULATION_ENHANCED};
        const double plane  = LeastHourglass(&kernel, ratios[i % 2], heights[i / 2], stretch);
        double       solid, plain;

        kernel.type        = ELEMENT_HEX8;
        kernel.geometry    = GEOMETRY_SOLID;
        solid              = LeastHourglass(&kernel, ratios[i % 2], heights[i / 2], stretch);
        kernel.formulation = FORMULATION_FULL;
        plain              = LeastHourglass(&kernel, ratios[i % 2], heights[i / 2], stretch);
        assert_true(plane > 0);
        assert_true(solid > 0 || solid > plain - 1e-9);
      }
    }
  }
}

static void ModesWithoutRestAreReported(void **state)
{
  const KernelCase kernel = {.type        = ELEMENT_QUAD4,
                             .geometry    = GEOMETRY_PLANE_STRAIN,
                             .kinematics  = KINEMATICS_FINITE,
                             .law         = MATERIAL_SVK,
                             .formulation = FORMULATION_ENHANCED};
  double X[MAX_DOFS], u[MAX_DOFS] = {0};
  Result result;

  (void)state;
  Box(ELEMENT_QUAD4, 1, X);
  for (int a = 0; a < 4; a++) {
    u[2 * a]     = 0.9 * X[2 * a] * X[2 * a + 1];
    u[2 * a + 1] = -0.8 * X[2 * a + 1] + 0.3 * X[2 * a] * X[2 * a + 1];
  }
  Evaluate(&kernel, X, u, poisson, &result);
  assert_false(result.J > 0);
  for (int k = 0; k < 8; k++) assert_true(isfinite(result.f[k]));
  for (int k = 0; k < 64; k++) assert_true(isfinite(result.K[k]));
}

/* A thin box that is bent a little and turned by one radian: its strains are differences of numbers about 1, and its
   modes must come to rest all the same. The force then has the tangent as its derivative. */
static void ForceIsSmoothWhereTheElementTurns(void **state)
{
  static const MaterialLaw laws[] = {MATERIAL_SVK, MATERIAL_NEO_HOOKEAN, MATERIAL_ISOCHORIC_NEO_HOOKEAN};
  const double             turn = 1, bend = 0.1, step = 1e-7;

  (void)state;
  for (int c = 0; c < 6; c++) {
    const int        solid = c / 3, dim = solid ? 3 : 2;
    const KernelCase kernel = {.type        = solid ? ELEMENT_HEX8 : ELEMENT_QUAD4,
                               .geometry    = solid ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN,
                               .kinematics  = KINEMATICS_FINITE,
                               .law         = laws[c % 3],
                               .formulation = FORMULATION_ENHANCED};
    double           X[MAX_DOFS], u[MAX_DOFS], moved[MAX_DOFS], error = 0, size = 0;
    Result           here, plus, minus;

    Box(kernel.type, 0.01, X);
    for (int a = 0; a < ElementGet(kernel.type)->nodes; a++) {
      const double x = X[a * dim] + bend * X[a * dim] * X[a * dim + 1], y = X[a * dim + 1];

      for (int i = 0; i < dim; i++) u[a * dim + i] = 0;
      u[a * dim]     = cos(turn) * x - sin(turn) * y - X[a * dim];
      u[a * dim + 1] = sin(turn) * x + cos(turn) * y - X[a * dim + 1];
    }
    Evaluate(&kernel, X, u, poisson, &here);
    for (int j = 0; j < here.dofs; j++) {
      memcpy(moved, u, sizeof(u));
      moved[j] += step;
      Evaluate(&kernel, X, moved, poisson, &plus);
      moved[j] -= 2 * step;
      Evaluate(&kernel, X, moved, poisson, &minus);
      for (int i = 0; i < here.dofs; i++) {
        error = fmax(error, fabs((plus.f[i] - minus.f[i]) / (2 * step) - here.K[i * here.dofs + j]));
        size  = fmax(size, fabs(here.K[i * here.dofs + j]));
      }
    }
    assert_near(error, 0, 1e-6 * size);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(BendingEnergyIsABeams),
    cmocka_unit_test(ForceIsSmoothWhereTheElementTurns),
    cmocka_unit_test(CompressedElementsDoNotHourglass),
    cmocka_unit_test(ModesWithoutRestAreReported),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
