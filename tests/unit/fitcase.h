/* Neighbourhoods for the tests of the diffuse fit: bowls of jittered nodes, straight or turned in space. Straight()
   and AddBowl() make a case step by step, RandomCase() makes a complete one, and Evaluate() computes it. */
#pragma once
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "smooth/diffusefit.h"
#include "smooth/fitframe.h"

enum { MAX = FIT_MAX_POINTS, FEW = 120, WORK = 400000 };

/* One slave point with all its arrays. */
typedef struct {
  FitProblem in;
  FitResult  out;
  double     x[3 * MAX], v[MAX], t[MAX], shape[MAX], N[3 * (1 + MAX)], M[9 * (1 + FEW) * (1 + FEW)];
  int        points[MAX];
} Case;

static const int cases[6][2] = {{2, 1}, {2, 2}, {2, 4}, {3, 1}, {3, 2}, {3, 4}}; /* dim, degree */
static double    work[WORK];

static inline double Random(double low, double high)
{
  static uint64_t state = 88172645463325252u;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

/* Replaces assert_float_equal(), which compares as float. */
static inline void AssertNear(double a, double b, double tolerance)
{
  if (!(fabs(a - b) <= tolerance)) {
    print_error("%.17g and %.17g differ by more than %g\n", a, b, tolerance);
    fail();
  }
}

static inline double MaxAbs(long n, const double *a)
{
  double most = 0;

  for (long i = 0; i < n; i++) {
    if (!isfinite(a[i])) return INFINITY;
    most = fmax(most, fabs(a[i]));
  }
  return most;
}

/* Evaluates a case. The workspace has just the length that is asked for and need not be aligned. */
static inline int Evaluate(Case *c, FitWant want)
{
  const long size = FitWorkspace(c->in.dim, c->in.degree, c->in.n);
  int        whole;

  assert_true(1 + size < WORK);
  work[1 + size]   = 7;
  c->in.x          = c->x;
  c->in.multiplier = c->v;
  c->in.hoop       = c->t;
  c->out           = (FitResult){.points = c->points, .shape = c->shape, .N = c->N, .M = c->in.n <= FEW ? c->M : NULL};
  whole            = DiffuseFitEvaluate(&c->in, want, work + 1, &c->out);
  assert_true(work[1 + size] == 7);
  return whole;
}

/* The frame e_1, e_2, e_3 and a round support. */
static inline void Straight(Case *c, int dim, int degree, double support, double exponent)
{
  memset(c, 0, sizeof(*c));
  c->in.dim      = dim;
  c->in.degree   = degree;
  c->in.exponent = exponent;
  for (int k = 0; k < dim; k++) c->in.frame[k][k] = 1;
  for (int k = 0; k < dim - 1; k++) c->in.metric[k][k] = 1 / (support * support);
}

static inline void AddPoint(Case *c, double s, double t, double z, double v)
{
  double *x = c->x + c->in.n * c->in.dim;

  assert_true(c->in.n < MAX);
  x[0]             = s;
  x[1]             = t;
  x[c->in.dim - 1] = z;
  c->v[c->in.n++]  = v;
}

/* Adds jittered nodes one spacing apart as far as `reach`, on a bowl with bumps. No node is close to the end of a
   round support. */
static inline void AddBowl(Case *c, double reach, double support)
{
  const int    dim = c->in.dim, cells = (int)reach + 1;
  const double shift[2] = {Random(0, 1), Random(0, 1)};

  for (int i = -cells; i <= cells; i++) {
    for (int j = dim == 3 ? -cells : 0; j <= (dim == 3 ? cells : 0); j++) {
      const double s = i + shift[0] + Random(-0.25, 0.25), t = dim == 3 ? j + shift[1] + Random(-0.25, 0.25) : 0,
                   r = hypot(s, t);

      if (r < reach && fabs(r - support) > 0.02 * support)
        AddPoint(c, s, t, -(s * s + 0.5 * t * t) / 14 - 0.3 + Random(-0.05, 0.05), Random(0.5, 1.5));
    }
  }
}

/* A random rotation from the axis-angle form; in 2D about z. */
static inline void Rotation(int dim, double R[3][3])
{
  double       axis[3] = {Random(-1, 1), Random(-1, 1), Random(-1, 1)}, length;
  const double angle = Random(-3, 3), c = cos(angle), s = sin(angle);

  if (dim == 2) axis[0] = axis[1] = 0;
  length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (int i = 0; i < 3; i++) axis[i] /= length;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) R[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j];
    R[i][(i + 2) % 3] += s * axis[(i + 1) % 3];
    R[i][(i + 1) % 3] -= s * axis[(i + 2) % 3];
  }
}

/* out = R a for n vectors. */
static inline void Turn(int dim, int n, double R[3][3], const double *a, double *out)
{
  for (int i = 0; i < n; i++) {
    for (int c = 0; c < dim; c++) {
      out[i * dim + c] = 0;
      for (int d = 0; d < dim; d++) out[i * dim + c] += R[c][d] * a[i * dim + d];
    }
  }
}

/* A bowl turned in space, with an elliptic support. */
static inline void RandomCase(Case *c, int dim, int degree, double exponent)
{
  const double support = dim == 2 ? 6 : degree == 4 ? 4.2 : 3;
  double       R[3][3], x[3 * MAX];

  Straight(c, dim, degree, support, exponent);
  AddBowl(c, 1.3 * support, support);
  if (dim == 3) c->in.metric[0][1] = c->in.metric[1][0] = 0.005 / support;
  Rotation(dim, R);
  memcpy(x, c->x, sizeof(x));
  Turn(dim, c->in.n, R, x, c->x);
  for (int k = 0; k < dim; k++) {
    for (int j = 0; j < dim; j++) c->in.frame[k][j] = R[j][k];
  }
}
