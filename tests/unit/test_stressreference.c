/* Shows that a tangent with a reference state differs from the derivative of the force by the replaced stress alone,
 * and that the energy of the volume is what it is said to be.
 */
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
static const double constants[2] = {160, 3.4}; /* Lame's, nu about 0.49 */

typedef struct {
  KernelCase     kernel;
  const Element *e;
  int            dofs;
  double         X[MAX_DOFS], u[MAX_DOFS], r[MAX_DOFS]; /* an element, its state and an earlier one */
  double         volume[ELEMENT_MAX_POINTS];
} Case;

static double Random(void)
{
  static unsigned state = 4711;

  state = state * 1664525u + 1013904223u;
  return (double)(state >> 8) / (1 << 24) - 0.5;
}

static void CaseCreate(Case *c, KernelCase kernel)
{
  double stress[ELEMENT_MAX_POINTS * 6];

  c->kernel = kernel;
  c->e      = ElementGet(kernel.type);
  c->dofs   = c->e->nodes * c->e->dim;
  for (int k = 0; k < c->dofs; k++) {
    c->X[k] = c->e->node[k / c->e->dim][k % c->e->dim] + 0.1 * Random() + (k % c->e->dim == 0 ? 3 : 0);
    c->u[k] = 0.15 * Random();
    c->r[k] = c->u[k] + 0.1 * Random();
  }
  ElementPointStress(&kernel, c->X, c->u, constants, NULL, stress, c->volume);
}

/* All elements x geometries x formulations with finite strains */
static int NextCase(KernelCase *kernel)
{
  static int next = 0;

  for (; next < ELEMENT_TYPES * FORMULATIONS * 2; next++) {
    *kernel = (KernelCase){.type        = (ElementType)(next % ELEMENT_TYPES),
                           .geometry    = GEOMETRY_AXISYMMETRIC,
                           .kinematics  = KINEMATICS_FINITE,
                           .law         = MATERIAL_NEO_HOOKEAN,
                           .formulation = (Formulation)(next / ELEMENT_TYPES % FORMULATIONS),
                           .condensed   = 1};
    if (next >= ELEMENT_TYPES * FORMULATIONS)
      kernel->geometry = ElementGet(kernel->type)->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN;
    if ((kernel->geometry == GEOMETRY_AXISYMMETRIC && ElementGet(kernel->type)->dim == 3) ||
        kernel->type >= ELEMENT_TYPES || !ElementKernelExists(kernel) ||
        ElementNodes(kernel) > ElementGet(kernel->type)->nodes)
      continue;
    next++;
    return 1;
  }
  return next = 0;
}

/* The tangent, with the reference r unless rate < 0 */
static double *Tangent(const Case *c, const double *r, double rate)
{
  double lanes_X[MAX_DOFS * KERNEL_LANES], lanes_u[MAX_DOFS * KERNEL_LANES], lanes_r[MAX_DOFS * KERNEL_LANES],
    lanes_constants[2 * KERNEL_LANES], J[KERNEL_LANES];
  const StressReference reference = {lanes_r, rate, 0};
  double               *lanes_K   = calloc((size_t)c->dofs * c->dofs * KERNEL_LANES, sizeof(double)),
         *K                       = calloc((size_t)c->dofs * c->dofs, sizeof(double));

  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    for (int k = 0; k < 2; k++) lanes_constants[k * KERNEL_LANES + lane] = constants[k];
    for (int k = 0; k < c->dofs; k++) {
      lanes_X[k * KERNEL_LANES + lane] = c->X[k];
      lanes_u[k * KERNEL_LANES + lane] = c->u[k];
      lanes_r[k * KERNEL_LANES + lane] = r[k];
    }
  }
  ElementKernel(&c->kernel, lanes_X, lanes_u, rate < 0 ? NULL : &reference, lanes_constants, NULL, NULL, NULL, lanes_K,
                J);
  for (int k = 0; k < c->dofs * c->dofs; k++) K[k] = lanes_K[k * KERNEL_LANES + 3];
  free(lanes_K);
  return K;
}

/* det F at the points, as the law sees it, of the state u + a v + b w. Not for mixed elements, whose pressure has shape
   functions of its own. */
static void Volumes(const Case *c, const double *u, double a, const double *v, double b, const double *w,
                    double J[ELEMENT_MAX_POINTS])
{
  double state[MAX_DOFS], H[ELEMENT_MAX_POINTS * 9], pressure[ELEMENT_MAX_POINTS];

  for (int k = 0; k < c->dofs; k++) state[k] = u[k] + a * v[k] + b * w[k];
  ElementPointState(&c->kernel, c->X, state, constants, NULL, H, pressure);
  for (int p = 0; p < c->e->points; p++) {
    const double *h = &H[9 * p];

    J[p] = (1 + h[0]) * ((1 + h[4]) * (1 + h[8]) - h[5] * h[7]) - h[1] * (h[3] * (1 + h[8]) - h[5] * h[6]) +
           h[2] * (h[3] * h[7] - (1 + h[4]) * h[6]);
  }
}

/* What the extrapolated pressure is above that of u, times the points' volumes */
static void Excess(const Case *c, double rate, double excess[ELEMENT_MAX_POINTS])
{
  const double h = 1e-3;
  double       J[ELEMENT_MAX_POINTS], J_r[ELEMENT_MAX_POINTS], plus[ELEMENT_MAX_POINTS], minus[ELEMENT_MAX_POINTS],
    way[MAX_DOFS];

  for (int k = 0; k < c->dofs; k++) way[k] = c->u[k] - c->r[k];
  Volumes(c, c->u, 0, way, 0, way, J);
  Volumes(c, c->r, 0, way, 0, way, J_r);
  Volumes(c, c->r, h, way, 0, way, plus);
  Volumes(c, c->r, -h, way, 0, way, minus);
  for (int p = 0; p < c->e->points; p++)
    excess[p] =
      c->volume[p] * constants[0] * (log(J_r[p]) + rate * (plus[p] - minus[p]) / (2 * h * J_r[p]) - log(J[p]));
}

/* Second derivative of sum of excess ln J in the directions v and w, by differences */
static double SecondVariation(const Case *c, const double *excess, const double *v, const double *w, double h)
{
  double sum = 0;

  for (int sign = 0; sign < 4; sign++) {
    const double a = sign & 1 ? -h : h, b = sign & 2 ? -h : h;
    double       J[ELEMENT_MAX_POINTS];

    Volumes(c, c->u, a, v, b, w, J);
    for (int p = 0; p < c->e->points; p++) sum += (a * b > 0 ? 1 : -1) * excess[p] * log(J[p]);
  }
  return sum / (4 * h * h);
}

static double Product(const Case *c, const double *K, const double *v, const double *w)
{
  double sum = 0;

  for (int i = 0; i < c->dofs; i++) {
    for (int j = 0; j < c->dofs; j++) sum += v[i] * K[i * c->dofs + j] * w[j];
  }
  return sum;
}

static void PressureAloneIsReplaced(void **state)
{
  int replaced = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    Case    c;
    double *exact, *K, v[MAX_DOFS], w[MAX_DOFS], excess[ELEMENT_MAX_POINTS];

    if (kernel.formulation == FORMULATION_ENHANCED || kernel.formulation == FORMULATION_MIXED)
      continue; /* modes of their own */
    assert_true(ElementExtrapolates(&kernel));
    CaseCreate(&c, kernel);
    exact = Tangent(&c, c.r, -1);
    for (int rate = 0; rate < 2; rate++) {
      K = Tangent(&c, c.r, rate);
      Excess(&c, rate, excess);
      for (int k = 0; k < c.dofs * c.dofs; k++) K[k] -= exact[k];
      for (int times = 0; times < 3; times++) {
        double difference, coarse, fine, size = 0;

        for (int k = 0; k < c.dofs; k++) {
          v[k] = Random();
          w[k] = Random();
        }
        for (int k = 0; k < c.dofs * c.dofs; k++) size = fmax(size, fabs(K[k]));
        difference = Product(&c, K, v, w);
        coarse     = SecondVariation(&c, excess, v, w, 2e-3);
        fine       = SecondVariation(&c, excess, v, w, 1e-3);
        assert_near(difference, (4 * fine - coarse) / 3, 1e-5 * size * c.dofs);
        replaced += size > 1e-3 * constants[1];
      }
      free(K);
    }
    free(exact);
  }
  assert_true(replaced > 50);
}

/* Largest difference between the tangent with a reference state on the way from u to r and the exact one */
static double Difference(const Case *c, double part, double rate)
{
  double r[MAX_DOFS], *exact = Tangent(c, c->r, -1), *K, largest = 0;

  for (int k = 0; k < c->dofs; k++) r[k] = c->u[k] + part * (c->r[k] - c->u[k]);
  K = Tangent(c, r, rate);
  for (int k = 0; k < c->dofs * c->dofs; k++) largest = fmax(largest, fabs(K[k] - exact[k]));
  free(K);
  free(exact);
  return largest;
}

/* The pressure with its linear change differs by the square of the way, that without by the way. With an inner node
   this needs the way of the inner node too. */
static void MixedPressureIsLinear(void **state)
{
  int tested = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    Case c;

    if (kernel.formulation != FORMULATION_MIXED) continue;
    CaseCreate(&c, kernel);
    assert_near(Difference(&c, 0.02, 1) / Difference(&c, 0.01, 1), 4, 0.2);
    assert_near(Difference(&c, 0.02, 0) / Difference(&c, 0.01, 0), 2, 0.1);
    tested++;
  }
  assert_int_equal(tested, 9);
}

/* The stress that replaces that of u, less it, by St. Venant-Kirchhoff's law at one point: of E_0 + rate (dE/du)_0
   (u - u_0) - E. */
static void ReplacedStress(const double *H, const double *H_0, double rate, double S[3][3])
{
  double D[3][3], trace = 0;

  for (int I = 0; I < 3; I++) {
    for (int J = 0; J < 3; J++) {
      D[I][J] = 0;
      for (int i = 0; i < 3; i++) {
        const double F_I = H[3 * i + I] + (i == I), F_J = H[3 * i + J] + (i == J), F_0I = H_0[3 * i + I] + (i == I),
                     F_0J = H_0[3 * i + J] + (i == J);

        D[I][J] += (F_0I * F_0J - F_I * F_J) / 2 + rate * (F_0I * (F_J - F_0J) + (F_I - F_0I) * F_0J) / 2;
      }
    }
    trace += D[I][I];
  }
  for (int I = 0; I < 3; I++) {
    for (int J = 0; J < 3; J++) S[I][J] = 2 * constants[1] * D[I][J] + (I == J) * constants[0] * trace;
  }
}

/* S : dF^T dF with dF linear in the displacements v and w, which full elements have: that is v K w of the replaced S.
 */
static void StressAloneIsReplaced(void **state)
{
  int replaced = 0;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    Case   c;
    double H[ELEMENT_MAX_POINTS * 9], H_0[ELEMENT_MAX_POINTS * 9], V[ELEMENT_MAX_POINTS * 9], W[ELEMENT_MAX_POINTS * 9],
      v[MAX_DOFS], w[MAX_DOFS], pressure[ELEMENT_MAX_POINTS], *exact;

    if (kernel.formulation != FORMULATION_FULL) continue;
    kernel.law = MATERIAL_SVK;
    assert_true(ElementExtrapolates(&kernel));
    CaseCreate(&c, kernel);
    for (int k = 0; k < c.dofs; k++) {
      v[k] = Random();
      w[k] = Random();
    }
    ElementPointState(&kernel, c.X, c.u, constants, NULL, H, pressure);
    ElementPointState(&kernel, c.X, c.r, constants, NULL, H_0, pressure);
    ElementPointState(&kernel, c.X, v, constants, NULL, V, pressure);
    ElementPointState(&kernel, c.X, w, constants, NULL, W, pressure);
    exact = Tangent(&c, c.r, -1);
    for (int rate = 0; rate < 2; rate++) {
      double *K = Tangent(&c, c.r, rate), expected = 0, size = 0;

      for (int p = 0; p < c.e->points; p++) {
        double S[3][3];

        ReplacedStress(&H[9 * p], &H_0[9 * p], rate, S);
        for (int k = 0; k < 27; k++)
          expected += c.volume[p] * V[9 * p + k / 3] * S[k / 3 % 3][k % 3] * W[9 * p + k / 9 * 3 + k % 3];
      }
      for (int k = 0; k < c.dofs * c.dofs; k++) K[k] -= exact[k];
      for (int k = 0; k < c.dofs * c.dofs; k++) size = fmax(size, fabs(K[k]));
      assert_near(Product(&c, K, v, w), expected, 1e-12 * size * c.dofs);
      replaced += size > 1e-3 * constants[1];
      free(K);
    }
    free(exact);
  }
  assert_true(replaced > 20);
}

/* With a reference that comes closer the tangent of an enhanced element tends to the exact one: with the way at rate 0,
   with its square at rate 1. */
static void EnhancedTendsToExact(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    if (kernel.formulation != FORMULATION_ENHANCED) continue;
    for (int law = 0; law < 2; law++) {
      Case    c;
      double *exact;

      kernel.law = law ? MATERIAL_SVK : MATERIAL_NEO_HOOKEAN;
      assert_true(ElementExtrapolates(&kernel));
      CaseCreate(&c, kernel);
      exact = Tangent(&c, c.u, -1);
      for (int rate = 0; rate < 2; rate++) {
        double error[2] = {0, 0}, r[MAX_DOFS];

        for (int closer = 0; closer < 2; closer++) {
          double *K;

          for (int k = 0; k < c.dofs; k++) r[k] = c.u[k] + (closer ? 0.01 : 0.02) * (c.r[k] - c.u[k]);
          K = Tangent(&c, r, rate);
          for (int k = 0; k < c.dofs * c.dofs; k++) error[closer] = fmax(error[closer], fabs(K[k] - exact[k]));
          free(K);
        }
        assert_true(error[1] > 0);
        assert_near(log2(error[0] / error[1]), 1 + rate, 0.1);
      }
      free(exact);
    }
  }
}

static void SameStateChangesNothing(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    Case    c;
    double *exact, scale = 0;

    if (kernel.type % 2 && kernel.formulation != FORMULATION_MIXED) kernel.law = MATERIAL_SVK;
    CaseCreate(&c, kernel);
    exact = Tangent(&c, c.u, -1);
    for (int k = 0; k < c.dofs * c.dofs; k++) scale = fmax(scale, fabs(exact[k]));
    for (int rate = 0; rate < 2; rate++) {
      double *K = Tangent(&c, c.u, rate);

      for (int k = 0; k < c.dofs * c.dofs; k++) assert_near(K[k], exact[k], 1e-13 * scale);
      free(K);
    }
    free(exact);
  }
}

static void OthersTakeNoReference(void **state)
{
  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    Case    c;
    double *exact, *K;

    kernel.law = MATERIAL_LINEAR;
    assert_false(ElementExtrapolates(&kernel));
    kernel.kinematics = KINEMATICS_SMALL;
    assert_false(ElementExtrapolates(&kernel));
    CaseCreate(&c, kernel);
    exact = Tangent(&c, c.r, -1);
    K     = Tangent(&c, c.r, 1);
    assert_memory_equal(K, exact, sizeof(double) * c.dofs * c.dofs);
    free(K);
    free(exact);
  }
}

/* An element blown up by a factor a: its energy of volume is constants[0]/2 (d ln a)^2 times its volume in d
 * dimensions. */
static void EnergyOfVolume(void **state)
{
  const double a = 1.1;

  (void)state;
  for (KernelCase kernel; NextCase(&kernel);) {
    const int dimensions = kernel.geometry == GEOMETRY_PLANE_STRAIN ? 2 : 3;
    Case      c;
    double    expected;

    /* curved mixed tri6 and tet10 have other points than the table */
    if (kernel.formulation == FORMULATION_MIXED && (kernel.type == ELEMENT_TRI6 || kernel.type == ELEMENT_TET10))
      continue;
    CaseCreate(&c, kernel);
    for (int k = 0; k < c.dofs; k++) c.u[k] = (a - 1) * c.X[k];
    expected = constants[0] / 2 * pow(dimensions * log(a), 2) * CellVolume(kernel.type, c.e->dim, kernel.geometry, c.X);
    assert_near(ElementVolumeEnergy(&kernel, c.X, c.u, constants, NULL), expected, 1e-12 * expected);
    kernel.law = MATERIAL_SVK;
    assert_true(ElementVolumeEnergy(&kernel, c.X, c.u, constants, NULL) == 0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(PressureAloneIsReplaced), cmocka_unit_test(MixedPressureIsLinear),
    cmocka_unit_test(StressAloneIsReplaced),   cmocka_unit_test(EnhancedTendsToExact),
    cmocka_unit_test(SameStateChangesNothing), cmocka_unit_test(OthersTakeNoReference),
    cmocka_unit_test(EnergyOfVolume),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
