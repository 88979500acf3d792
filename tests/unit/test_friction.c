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
  in.pressure = given->pressure - given->rate * x[9];
  in.stiffness *= exp(x[10]);
  in.coefficient += given->steepness * (in.pressure - given->pressure);
  FrictionEvaluate(&in, &out);
  memcpy(value, out.traction, sizeof(out.traction));
}

/* With a multiplier, or without. */
static FrictionInput node(int dim, double coefficient, double began, double grip)
{
  FrictionInput in = {.coefficient = coefficient,
                      .stiffness   = 30,
                      .kept        = {0.1 * any(), dim == 3 ? 0.1 * any() : 0},
                      .grip        = {grip * any(), dim == 3 ? grip * any() : 0},
                      .rate        = 50,
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

/* What bounds the traction: mu p; with cohesion, a fluid's pressure and a mu over the pressure too; the limit. */
typedef enum { MU, MORE, LIMITED, BOUNDS } Bound;

static double bound_node(Bound bound, FrictionInput *in)
{
  if (bound == MORE) {
    in->cohesion  = 0.02;
    in->fluid     = 1.5;
    in->steepness = -0.3 * in->coefficient / in->pressure;
  }
  if (bound == LIMITED) in->limit = 0.6 * in->coefficient * in->pressure;
  return bound == LIMITED ? in->limit : in->cohesion + in->coefficient * (in->pressure + in->fluid);
}

static void check_law(int dim, double coefficient, double began, double grip, Bound bound, FrictionState state)
{
  for (int trial = 0; trial < 20; trial++) {
    FrictionInput    in;
    FrictionTraction out;
    double           x[11], direction[11], slope[3], sum[3], worst = 1, along[3], most;

    do { /* a chance node may be at its bound */
      in   = node(dim, coefficient, began, grip);
      most = bound_node(bound, &in);
      FrictionEvaluate(&in, &out);
    } while (out.state != state);
    memcpy(x, in.normal, sizeof(in.normal));
    memcpy(x + 3, in.slip, sizeof(in.slip));
    memcpy(x + 6, in.along, sizeof(in.along));
    x[9] = x[10] = 0;
    for (int i = 0; i < 9; i += 3) fill(dim, 1, direction + i);
    direction[9]  = any();
    direction[10] = 0.7;
    for (int i = 0; i < 3; i++) {
      sum[i] = out.by_gap[i] * direction[9] + out.by_stiffness[i] * direction[10];
      for (int j = 0; j < 3; j++)
        sum[i] += out.by_normal[i][j] * direction[j] + out.by_slip[i][j] * direction[3 + j] +
                  out.by_along[i][j] * direction[6 + j];
    }
    for (double h = 3e-3; h > 2e-6; h /= 3) {
      double error[3];

      difference(law, &in, 11, x, direction, h, slope);
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
        for (double grip = 0; grip <= 4; grip += 4) {
          check_law(dim, 1e3, open * 0.03, grip, bound, FRICTION_STICKS);
          check_law(dim, 0.01, open * 0.03, grip, bound, FRICTION_SLIPS);
        }
      }
    }
  }
}

/* A multiplier that is the traction takes the elastic slip away, where the node sticks and where it slips, and the
   traction stays. */
static void test_grip(void **state)
{
  (void)state;
  for (int trial = 0; trial < 20; trial++) {
    FrictionInput    in = node(3, trial % 2 ? 0.01 : 1e3, 0, 1);
    FrictionTraction before, after;

    FrictionEvaluate(&in, &before);
    FrictionComponents(in.normal, in.along, before.traction, in.grip);
    FrictionComponents(in.normal, in.along, in.slip, in.kept);
    for (int k = 0; k < 2; k++) in.kept[k] = -in.kept[k];
    FrictionEvaluate(&in, &after);
    for (int d = 0; d < 3; d++)
      assert_true(fabs(after.traction[d] - before.traction[d]) <= 1e-12 * norm(before.traction));
    assert_true(after.elastic <= 1e-12 * norm(in.slip));
    assert_true(fabs(after.slipped) <= 1e-12 * norm(in.slip));
  }
}

/* Near the touch the traction is that of the way on which the node came, whatever the penalty: along it within the cone
   of friction, at its bound beyond it. */
static void test_touch(void **state)
{
  (void)state;
  for (int trial = 0; trial < 20; trial++) {
    const double     slope = trial % 2 ? 0.1 : 3, pressure = 1e-6;
    FrictionInput    in = {.coefficient = 0.3, .normal = {0, 0, 1}, .along = {1, 0, 0}, .began = 0.2};
    FrictionTraction out;

    in.pressure  = pressure;
    in.stiffness = trial < 10 ? 30 : 3000;
    in.rate      = pow(10, trial % 5) * in.stiffness;
    in.slip[0]   = slope * in.began;
    FrictionEvaluate(&in, &out);
    assert_true(fabs(out.traction[0] / (pressure * fmin(slope, in.coefficient)) - 1) <= 1e-6);
    assert_int_equal(out.state, slope < in.coefficient ? FRICTION_STICKS : FRICTION_SLIPS);
  }
}

/* A node that a linear step pulls at while it slips has the traction of its signed pressure, and resists turns of its
   slip as under the pressure that is expected. */
static void test_pulled(void **state)
{
  (void)state;
  for (int trial = 0; trial < 20; trial++) {
    FrictionInput    in = node(3, 0.01, 0, 0);
    FrictionTraction pressed, pulled;

    in.state = FRICTION_SLIPS;
    FrictionEvaluate(&in, &pressed);
    in.expected = in.pressure;
    in.pressure = -2 * in.pressure;
    FrictionEvaluate(&in, &pulled);
    for (int i = 0; i < 3; i++) {
      assert_true(fabs(pulled.traction[i] + 2 * pressed.traction[i]) <= 1e-12 * norm(pressed.traction));
      for (int j = 0; j < 3; j++)
        assert_true(fabs(pulled.by_slip[i][j] - pressed.by_slip[i][j]) <= 1e-12 * in.stiffness);
    }
    in.expected = 0;
    FrictionEvaluate(&in, &pulled);
    for (int i = 0; i < 9; i++) assert_true(pulled.by_slip[i / 3][i % 3] == 0);
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
    FrictionInput    in = node(3, trial % 2 ? 0.01 : 1e3, 0, trial % 3), turned = in;
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
  FrictionInput    in = node(3, 1e3, 0, 0);
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

/* The forces of a slave point over its face, which holds it at xi, its normal and the nodes of a face of the master.
   Numbers x: normal, nodes of the slave's face, nodes of the master's. node: of the master's face, then of the slave's.
 */
typedef struct {
  int         dim, node;
  ElementType type;
  double      F[3], S[FACE_MAX_NODES], slope[FACE_MAX_NODES][2];
} Case;

enum { CASE_NUMBERS = 3 + 6 * FACE_MAX_NODES };

static const double *case_node(const Case *c, const double *x, int master, int k)
{
  return x + 3 + 3 * (master * ElementGet(c->type)->nodes + k);
}

static void case_point(const Case *c, const double *x, double point[3])
{
  for (int d = 0; d < 3; d++) {
    point[d] = 0;
    for (int k = 0; k < ElementGet(c->type)->nodes; k++) point[d] += c->S[k] * case_node(c, x, 0, k)[d];
  }
}

static int place(const Case *c, const double *x, FrictionFoot *foot, FrictionLever *lever)
{
  double relative[FACE_MAX_NODES * 3], point[3], tangent[2][3] = {{0}};

  case_point(c, x, point);
  for (int k = 0; k < ElementGet(c->type)->nodes; k++) {
    for (int d = 0; d < c->dim; d++) {
      relative[k * c->dim + d] = case_node(c, x, 1, k)[d] - point[d];
      for (int a = 0; a < c->dim - 1; a++) tangent[a][d] += c->slope[k][a] * case_node(c, x, 0, k)[d];
    }
  }
  return FrictionFootFind(c->dim, c->type, relative, x, foot) && FrictionLeverMake(c->dim, x, tangent, lever);
}

static void nodal(const double *x, void *context, double value[3])
{
  const Case   *c = context;
  const int     n = ElementGet(c->type)->nodes;
  FrictionFoot  foot;
  FrictionLever lever;
  double        force[3][3];

  assert_true(place(c, x, &foot, &lever));
  for (int d = 0; d < 3; d++) value[d] = c->node < n ? -foot.N[c->node] * c->F[d] : 0;
  if (c->node < n) return;
  FrictionLeverForces(&lever, &foot, c->slope[c->node - n], force);
  for (int d = 0; d < 3; d++) value[d] = force[d][0] * c->F[0] + force[d][1] * c->F[1] + force[d][2] * c->F[2];
}

/* Two faces, shaken and bent, one above the other. */
static void make_case(Case *c, double *x)
{
  const Element *e     = ElementGet(c->type);
  double         xi[2] = {0.1 * any(), 0.1 * any()}, dN[FACE_MAX_NODES * 2];

  if (e->corners == 3) xi[0] += 0.3;
  if (e->corners == 3) xi[1] += 0.3;
  ElementShape(c->type, xi, c->S, dN, NULL);
  fill(c->dim, 0.2, x);
  x[c->dim - 1] = 1 + 0.1 * any();
  for (int k = 0; k < e->nodes; k++)
    for (int a = 0; a < e->dim; a++) c->slope[k][a] = dN[k * e->dim + a];
  for (int k = 0; k < 2 * e->nodes; k++) {
    double *at = x + 3 + 3 * k;

    fill(c->dim, 0.05, at);
    for (int a = 0; a < e->dim; a++) at[a] += e->node[k % e->nodes][a];
    if (k < e->nodes) at[c->dim - 1] += 0.3;
  }
  fill(c->dim, 1, c->F);
}

/* The derivative along a direction from FrictionFootVary() and FrictionLeverVary(). */
static void vary(const Case *c, const double *x, const double *direction, double slope[3])
{
  const int             n = ElementGet(c->type)->nodes;
  FrictionFoot          foot;
  FrictionLever         lever;
  FrictionFootVariation by;
  double                w[3], tangent[2][3] = {{0}};

  assert_true(place(c, x, &foot, &lever));
  if (c->node < n)
    FrictionFootVary(&foot, c->F, c->node, &by);
  else
    FrictionLeverVary(&lever, &foot, c->F, c->slope[c->node - n], &by);
  case_point(c, direction, w);
  for (int d = 0; d < 3; d++) {
    for (int k = 0; k < n; k++) {
      w[d] -= foot.N[k] * case_node(c, direction, 1, k)[d];
      for (int a = 0; a < lever.tangents; a++) tangent[a][d] += c->slope[k][a] * case_node(c, direction, 0, k)[d];
    }
  }
  for (int i = 0; i < 3; i++) {
    slope[i] = 0;
    for (int j = 0; j < 3; j++)
      slope[i] += by.by_place[i][j] * w[j] + by.by_normal[i][j] * direction[j] +
                  by.by_tangent[0][i][j] * tangent[0][j] + by.by_tangent[1][i][j] * tangent[1][j];
  }
}

static void check_foot(int dim, ElementType type)
{
  for (int trial = 0; trial < 10; trial++) {
    Case      c = {.dim = dim, .type = type};
    double    x[CASE_NUMBERS], direction[CASE_NUMBERS], slope[3], expected[3];
    const int n = 3 + 6 * ElementGet(type)->nodes;

    make_case(&c, x);
    for (int i = 0; i < n; i += 3) fill(dim, 1, direction + i);
    for (c.node = 0; c.node < 2 * ElementGet(type)->nodes; c.node++) {
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

/* Adds a force at x to a sum of forces, and its moment to a sum of moments. */
static void add_force(const double x[3], const double force[3], double sum[3], double moment[3])
{
  for (int d = 0; d < 3; d++) {
    sum[d] += force[d];
    moment[d] += x[(d + 1) % 3] * force[(d + 2) % 3] - x[(d + 2) % 3] * force[(d + 1) % 3];
  }
}

/* The forces on slave point, master's face and lever have no sum and no moment. */
static void check_balance(int dim, ElementType type)
{
  for (int trial = 0; trial < 10; trial++) {
    Case          c = {.dim = dim, .type = type};
    FrictionFoot  foot;
    FrictionLever lever;
    double        x[CASE_NUMBERS], sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, point[3];

    make_case(&c, x);
    assert_true(place(&c, x, &foot, &lever));
    case_point(&c, x, point);
    add_force(point, c.F, sum, moment);
    for (c.node = 0; c.node < 2 * foot.nodes; c.node++) {
      double force[3];

      nodal(x, &c, force);
      add_force(case_node(&c, x, c.node < foot.nodes, c.node % foot.nodes), force, sum, moment);
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

/* Two faces of a flat master side by side, under a slave's face that is not parallel to them. Where the foot goes on
   from one face to the other, no force of the lever jumps. */
static void test_crossing(void **state)
{
  double before[2][3] = {{0}}, jump = 0, size = 0;
  Case   c = {.dim = 2, .type = ELEMENT_EDGE2, .F = {1, 0.1, 0}, .S = {0.5, 0.5}, .slope = {{-0.5}, {0.5}}};

  (void)state;
  for (int side = 0; side < 2; side++) { /* the master's faces are as long as 2 and 0.7 */
    const double  x[15] = {0.1, 1, 0, -1, 0.2, 0, 1, 0.4, 0, side ? -0.03 : -2.03, 0, 0, side ? 0.67 : -0.03, 0, 0};
    FrictionFoot  foot;
    FrictionLever lever;

    assert_true(place(&c, x, &foot, &lever));
    assert_true(fabs(foot.xi[0] - (side ? -1 : 1)) < 1e-12);
    for (c.node = 2; c.node < 4; c.node++) {
      double force[3];

      nodal(x, &c, force);
      for (int d = 0; d < 2; d++) {
        if (side) jump = fmax(jump, fabs(force[d] - before[c.node - 2][d]));
        before[c.node - 2][d] = force[d];
        size                  = fmax(size, fabs(force[d]));
      }
    }
  }
  assert_true(size > 0.05 && jump <= 1e-14);
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_law),      cmocka_unit_test(test_grip),
                                     cmocka_unit_test(test_rotation), cmocka_unit_test(test_kept),
                                     cmocka_unit_test(test_touch),    cmocka_unit_test(test_foot),
                                     cmocka_unit_test(test_balance),  cmocka_unit_test(test_crossing),
                                     cmocka_unit_test(test_frame),    cmocka_unit_test(test_pulled)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
