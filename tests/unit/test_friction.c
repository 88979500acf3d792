/* Coulomb's law at a node and the foot of its force on the master: derivatives against differences of fourth order,
   balance of forces and moments, bound, and indifference to rigid rotations. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "frictionfoot.h"
#include "frictionframe.h"
#include "contact/frictionlaw.h"

/* Allowed difference between derivatives and differences, relative to the largest of them. */
#define ALLOWED 1e-8

/* A number in (-1, 1) from a small generator that is the same everywhere. */
static double any(void)
{
  static unsigned long long seed = 12345;

  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(seed >> 33) / (double)(1ULL << 31) * 2 - 1;
}

static void fill(int dim, double scale, double *v)
{
  for (int d = 0; d < 3; d++) v[d] = d < dim ? scale * any() : 0;
}

/* A function with three values of n numbers. */
typedef void (*Function)(const double *x, void *context, double value[3]);

/* Derivative along direction by differences of fourth order. */
static void difference(Function f, void *context, int n, const double *x, const double *direction, double h,
                       double slope[3])
{
  double at[64], value[4][3];

  for (int k = 0; k < 4; k++) {
    const double step[] = {h, -h, 2 * h, -2 * h};

    for (int i = 0; i < n; i++) at[i] = x[i] + step[k] * direction[i];
    f(at, context, value[k]);
  }
  for (int d = 0; d < 3; d++) slope[d] = (8 * (value[0][d] - value[1][d]) - (value[2][d] - value[3][d])) / (12 * h);
}

static double norm(const double v[3])
{
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The law over normal, slip, along and gap, ten numbers. The pressure falls with the gap. */
static void law(const double *x, void *context, double value[3])
{
  const FrictionInput *given = context;
  FrictionInput        in    = *given;
  FrictionTraction     out;

  memcpy(in.normal, x, sizeof(in.normal));
  memcpy(in.slip, x + 3, sizeof(in.slip));
  memcpy(in.along, x + 6, sizeof(in.along));
  in.opening  = given->opening + x[9];
  in.pressure = given->pressure - given->rate * x[9];
  in.coefficient += given->steepness * (in.pressure - given->pressure);
  FrictionEvaluate(&in, &out);
  memcpy(value, out.traction, sizeof(out.traction));
}

static FrictionInput node(int dim, double coefficient, double began)
{
  FrictionInput in = {.coefficient = coefficient,
                      .stiffness   = 30,
                      .kept        = {0.1 * any(), dim == 3 ? 0.1 * any() : 0},
                      .rate        = 50,
                      .opening     = -0.05,
                      .pressure    = 2.5,
                      .began       = began};

  do fill(dim, 1, in.normal);
  while (norm(in.normal) < 0.3);
  fill(dim, 0.2, in.slip);
  do {
    double across = 0;

    fill(dim, 1, in.along);
    for (int d = 0; d < 3; d++) across += in.along[d] * in.normal[d];
    if (fabs(across) < 0.8 * norm(in.along) * norm(in.normal) && norm(in.along) > 0.3) break;
  } while (1);
  return in;
}

/* What bounds the traction: mu p; with cohesion and a mu over the pressure too; the limit. */
typedef enum { MU, MORE, LIMITED, BOUNDS } Bound;

static double bound_node(Bound bound, FrictionInput *in)
{
  if (bound == MORE) {
    in->cohesion  = 0.02;
    in->steepness = -0.3 * in->coefficient / in->pressure;
  }
  if (bound == LIMITED) in->limit = 0.6 * in->coefficient * in->pressure;
  return bound == LIMITED ? in->limit : in->cohesion + in->coefficient * in->pressure;
}

static void check_law(int dim, double coefficient, double began, Bound bound, FrictionState state)
{
  for (int trial = 0; trial < 20; trial++) {
    FrictionInput    in = node(dim, coefficient, began);
    FrictionTraction out;
    double           x[10], direction[10], slope[3], sum[3], worst = 1, along[3], most = bound_node(bound, &in);

    memcpy(x, in.normal, sizeof(in.normal));
    memcpy(x + 3, in.slip, sizeof(in.slip));
    memcpy(x + 6, in.along, sizeof(in.along));
    x[9] = 0;
    for (int i = 0; i < 9; i += 3) fill(dim, 1, direction + i);
    direction[9] = any();
    FrictionEvaluate(&in, &out);
    assert_int_equal(out.state, state);
    for (int i = 0; i < 3; i++) {
      sum[i] = out.by_gap[i] * direction[9];
      for (int j = 0; j < 3; j++)
        sum[i] += out.by_normal[i][j] * direction[j] + out.by_slip[i][j] * direction[3 + j] +
                  out.by_along[i][j] * direction[6 + j];
    }
    for (double h = 3e-3; h > 2e-6; h /= 3) {
      double error[3];

      difference(law, &in, 10, x, direction, h, slope);
      for (int d = 0; d < 3; d++) error[d] = slope[d] - sum[d];
      worst = fmin(worst, norm(error) / norm(sum));
    }
    assert_true(worst <= ALLOWED);
    if (state == FRICTION_SLIPS) assert_true(fabs(norm(out.traction) - most) <= 1e-13);
    for (int d = 0; d < 3; d++) along[d] = in.normal[d] * out.traction[d];
    /* what is left of the part of the slip along the normal is rounding */
    assert_true(fabs(along[0] + along[1] + along[2]) <=
                1e-13 * norm(out.traction) * fmax(1, norm(in.slip) / (out.elastic + out.slipped)));
  }
}

static void test_law(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    for (int open = 0; open <= 1; open++) {
      for (Bound bound = MU; bound < BOUNDS; bound++) {
        check_law(dim, 1e3, open * 0.03, bound, FRICTION_STICKS);
        check_law(dim, 0.01, open * 0.03, bound, FRICTION_SLIPS);
      }
    }
  }
}

/* v turned by the angle about the axis, which is of length 1. */
static void turn(const double axis[3], double angle, const double v[3], double out[3])
{
  double along = 0;

  for (int d = 0; d < 3; d++) along += axis[d] * v[d];
  for (int d = 0; d < 3; d++)
    out[d] = cos(angle) * v[d] +
             sin(angle) * (axis[(d + 1) % 3] * v[(d + 2) % 3] - axis[(d + 2) % 3] * v[(d + 1) % 3]) +
             (1 - cos(angle)) * along * axis[d];
}

/* What is kept turns with the bodies. */
static void test_rotation(void **state)
{
  const double axis[3] = {0.6, 0, 0.8};

  (void)state;
  for (int trial = 0; trial < 10; trial++) {
    FrictionInput    in = node(3, trial % 2 ? 0.01 : 1e3, 0), turned = in;
    FrictionTraction a, b;
    double           expected[3];

    turn(axis, 2, in.normal, turned.normal);
    turn(axis, 2, in.slip, turned.slip);
    turn(axis, 2, in.along, turned.along);
    FrictionEvaluate(&in, &a);
    FrictionEvaluate(&turned, &b);
    turn(axis, 2, a.traction, expected);
    for (int d = 0; d < 3; d++) assert_true(fabs(b.traction[d] - expected[d]) <= 1e-13 * norm(expected));
  }
}

/* What is kept for a traction gives this traction back; so does a slip of 0 at the start. */
static void test_kept(void **state)
{
  FrictionInput    in = node(3, 1e3, 0);
  FrictionTraction out;
  double           traction[3], component[2], slip[2];

  (void)state;
  FrictionEvaluate(&in, &out);
  memcpy(traction, out.traction, sizeof(traction));
  fill(3, 0.3, in.slip); /* other anchors */
  FrictionComponents(in.normal, in.along, traction, component);
  FrictionComponents(in.normal, in.along, in.slip, slip);
  for (int k = 0; k < 2; k++) in.kept[k] = component[k] / in.stiffness - slip[k];
  FrictionEvaluate(&in, &out);
  for (int d = 0; d < 3; d++) assert_true(fabs(out.traction[d] - traction[d]) <= 1e-13 * norm(traction));
}

/* The force on one node of the face over slave point, normal and nodes of the face. */
typedef struct {
  int         dim, node;
  ElementType type;
  double      F[3];
} Case;

static int place(const Case *c, const double *x, FrictionFoot *foot)
{
  double relative[FACE_MAX_NODES * 3];

  for (int k = 0; k < ElementGet(c->type)->nodes; k++)
    for (int d = 0; d < c->dim; d++) relative[k * c->dim + d] = x[6 + 3 * k + d] - x[d];
  return FrictionFootFind(c->dim, c->type, relative, x + 3, foot);
}

static void nodal(const double *x, void *context, double value[3])
{
  const Case  *c = context;
  FrictionFoot foot;
  double       force[3][3];

  assert_true(place(c, x, &foot));
  FrictionFootForces(&foot, c->node, force);
  for (int d = 0; d < 3; d++) value[d] = force[d][0] * c->F[0] + force[d][1] * c->F[1] + force[d][2] * c->F[2];
}

/* Slave point, normal and a shaken, bent face: 6 + 3 nodes numbers. */
static void make_case(Case *c, double *x)
{
  const Element *e = ElementGet(c->type);

  for (int d = 0; d < 3; d++) x[d] = d < c->dim ? 0.1 * any() + (e->corners == 3 ? 0.3 : 0) : 0;
  x[c->dim - 1] = 0.3 + 0.1 * any();
  fill(c->dim, 0.2, x + 3);
  x[3 + c->dim - 1] = 1 + 0.1 * any();
  for (int k = 0; k < e->nodes; k++) {
    fill(c->dim, 0.05, x + 6 + 3 * k);
    for (int a = 0; a < e->dim; a++) x[6 + 3 * k + a] += e->node[k][a];
  }
  fill(c->dim, 1, c->F);
}

/* The derivative along a direction from FrictionFootVary(). */
static void vary(const Case *c, const double *x, const double *direction, double slope[3])
{
  FrictionFoot          foot;
  FrictionFootVariation by;
  double                w[3], tangent[2][3] = {{0}};

  assert_true(place(c, x, &foot));
  FrictionFootVary(&foot, c->F, c->node, &by);
  for (int d = 0; d < 3; d++) {
    w[d] = direction[d];
    for (int k = 0; k < foot.nodes; k++) {
      w[d] -= foot.N[k] * direction[6 + 3 * k + d];
      for (int a = 0; a < foot.tangents; a++) tangent[a][d] += foot.dN[k][a] * direction[6 + 3 * k + d];
    }
  }
  for (int i = 0; i < 3; i++) {
    slope[i] = 0;
    for (int j = 0; j < 3; j++)
      slope[i] += by.by_place[i][j] * w[j] + by.by_normal[i][j] * direction[3 + j] +
                  by.by_tangent[0][i][j] * tangent[0][j] + by.by_tangent[1][i][j] * tangent[1][j];
  }
}

static void check_foot(int dim, ElementType type)
{
  for (int trial = 0; trial < 10; trial++) {
    Case      c = {.dim = dim, .type = type};
    double    x[6 + 3 * FACE_MAX_NODES], direction[6 + 3 * FACE_MAX_NODES], slope[3], expected[3];
    const int n = 6 + 3 * ElementGet(type)->nodes;

    make_case(&c, x);
    for (int i = 0; i < n; i += 3) fill(dim, 1, direction + i);
    for (c.node = 0; c.node < ElementGet(type)->nodes; c.node++) {
      double worst = 1;

      vary(&c, x, direction, expected);
      for (double h = 3e-3; h > 2e-6; h /= 3) {
        double error[3];

        difference(nodal, &c, n, x, direction, h, slope);
        for (int d = 0; d < 3; d++) error[d] = slope[d] - expected[d];
        worst = fmin(worst, norm(error) / norm(expected));
      }
      assert_true(worst <= ALLOWED);
    }
  }
}

static void test_foot(void **state)
{
  (void)state;
  check_foot(2, ELEMENT_EDGE2);
  check_foot(2, ELEMENT_EDGE3);
  check_foot(3, ELEMENT_TRI3);
  check_foot(3, ELEMENT_TRI6);
  check_foot(3, ELEMENT_QUAD4);
  check_foot(3, ELEMENT_QUAD9);
}

/* The forces on slave point and face have no sum and no moment. */
static void check_balance(int dim, ElementType type)
{
  for (int trial = 0; trial < 10; trial++) {
    Case         c = {.dim = dim, .type = type};
    FrictionFoot foot;
    double       x[6 + 3 * FACE_MAX_NODES], sum[3], moment[3] = {0, 0, 0};

    make_case(&c, x);
    assert_true(place(&c, x, &foot));
    memcpy(sum, c.F, sizeof(sum));
    for (c.node = 0; c.node < foot.nodes; c.node++) {
      double force[3], arm[3];

      nodal(x, &c, force);
      for (int d = 0; d < 3; d++) {
        sum[d] += force[d];
        arm[d] = x[6 + 3 * c.node + d] - x[d];
      }
      for (int d = 0; d < 3; d++)
        moment[d] += arm[(d + 1) % 3] * force[(d + 2) % 3] - arm[(d + 2) % 3] * force[(d + 1) % 3];
    }
    assert_true(norm(sum) <= 1e-14 * norm(c.F) && norm(moment) <= 1e-13 * norm(c.F));
  }
}

static void test_balance(void **state)
{
  (void)state;
  check_balance(2, ELEMENT_EDGE3);
  check_balance(3, ELEMENT_TRI3);
  check_balance(3, ELEMENT_QUAD9);
}

/* The vector with given components in the frame of two tangents, six numbers. */
static void carried(const double *x, void *context, double value[3])
{
  double        tangent[2][3];
  FrictionFrame frame;

  memcpy(tangent, x, sizeof(tangent));
  assert_true(FrictionFrameMake(tangent, &frame));
  FrictionFrameCarry(&frame, context, value);
}

/* The frame is orthonormal, and what has fixed components in it varies as differences say. */
static void check_frame(int dim)
{
  for (int trial = 0; trial < 20; trial++) {
    double x[6] = {0, 0, 0, 0, 0, dim == 2}, direction[6] = {0}, component[3], back[3], v[3], by[2][3][3], sum[3];
    double slope[3], worst                                = 1;
    FrictionFrame frame;

    do {
      fill(dim, 1, x);
      if (dim == 3) fill(dim, 1, x + 3);
    } while (!FrictionFrameMake((const double(*)[3])x, &frame) || frame.area < 0.2);
    fill(dim, 1, direction);
    if (dim == 3) fill(dim, 1, direction + 3);
    fill(3, 1, component);
    FrictionFrameCarry(&frame, component, v);
    FrictionFrameTake(&frame, v, back);
    for (int d = 0; d < 3; d++) assert_true(fabs(back[d] - component[d]) < 1e-14);
    FrictionFrameVary(&frame, component, by);
    for (int i = 0; i < 3; i++) {
      sum[i] = 0;
      for (int a = 0; a < 2; a++)
        for (int j = 0; j < 3; j++) sum[i] += by[a][i][j] * direction[3 * a + j];
    }
    for (double h = 3e-3; h > 2e-6; h /= 3) {
      double error[3];

      difference(carried, component, 6, x, direction, h, slope);
      for (int d = 0; d < 3; d++) error[d] = slope[d] - sum[d];
      worst = fmin(worst, norm(error) / fmax(norm(sum), 1e-3));
    }
    assert_true(worst < ALLOWED);
  }
}

static void test_frame(void **state)
{
  (void)state;
  check_frame(2);
  check_frame(3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_law),     cmocka_unit_test(test_rotation),
                                     cmocka_unit_test(test_kept),    cmocka_unit_test(test_foot),
                                     cmocka_unit_test(test_balance), cmocka_unit_test(test_frame)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
