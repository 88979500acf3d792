/* N and M of the diffuse fit are the derivatives of its gap. They balance, turn with the points, and add up over
   mirror images. */
#include "fitcase.h"

/* Fourth-order central difference from the values at -2h, -h, h, 2h. */
static double Difference(const double value[4], double h)
{
  return (value[0] - 8 * value[1] + 8 * value[2] - value[3]) / (12 * h);
}

/* Moves the slave point (block 0) or a point inside in direction k. The slave point is the origin. */
static void Move(Case *c, const int *points, int block, int k, double step)
{
  const int dim = c->in.dim;

  if (block > 0)
    c->x[points[block - 1] * dim + k] += step;
  else
    for (int i = 0; i < c->in.n; i++) c->x[i * dim + k] -= step;
}

static void CheckVariations(Case *c)
{
  static Case  moved[4];
  const double h   = 2e-4;
  const int    dim = c->in.dim;
  int          size;
  double       most[2] = {0}, error[2] = {0};

  assert_true(Evaluate(c, FIT_SECOND_VARIATION));
  size = dim * (1 + c->out.n);
  for (int column = 0; column < size; column++) {
    double gap[4];

    for (int s = 0; s < 4; s++) {
      memcpy(&moved[s], c, offsetof(Case, N));
      Move(&moved[s], c->points, column / dim, column % dim, (s < 2 ? s - 2 : s - 1) * h);
      assert_true(Evaluate(&moved[s], FIT_FIRST_VARIATION));
      assert_int_equal(moved[s].out.n, c->out.n);
      gap[s] = moved[s].out.gap;
    }
    error[0] = fmax(error[0], fabs(c->N[column] - Difference(gap, h)));
    most[0]  = fmax(most[0], fabs(c->N[column]));
    for (int row = 0; row < size; row++) {
      const double N[4] = {moved[0].N[row], moved[1].N[row], moved[2].N[row], moved[3].N[row]};

      error[1] = fmax(error[1], fabs(c->M[row * size + column] - Difference(N, h)));
      most[1]  = fmax(most[1], fabs(c->M[row * size + column]));
    }
  }
  AssertNear(error[0] / most[0], 0, 1e-7);
  AssertNear(error[1] / most[1], 0, 1e-7);
}

static void TestVariations(void **state)
{
  static const double exponents[] = {3, 3.5, 6};
  static Case         c;

  (void)state;
  for (int i = 0; i < 6; i++) {
    for (int e = 0; e < 3; e++) {
      RandomCase(&c, cases[i][0], cases[i][1], exponents[e]);
      CheckVariations(&c);
    }
  }
}

/* The sum over all blocks of N and of every row of M is zero, and M is symmetric to the last bit. */
static void CheckBalance(const Case *c)
{
  const int    dim = c->in.dim, size = dim * (1 + c->out.n);
  const double scale[2] = {MaxAbs(size, c->N), MaxAbs((long)size * size, c->M)};

  for (int k = 0; k < dim; k++) {
    double sum = 0;

    for (int i = k; i < size; i += dim) sum += c->N[i];
    AssertNear(sum, 0, 1e-14 * scale[0] * size);
    for (int row = 0; row < size; row++) {
      sum = 0;
      for (int i = k; i < size; i += dim) sum += c->M[row * size + i];
      AssertNear(sum, 0, 1e-14 * scale[1] * size);
    }
  }
  for (int i = 0; i < size; i++) {
    for (int j = 0; j < i; j++) assert_true(c->M[i * size + j] == c->M[j * size + i]);
  }
}

static void TestBalance(void **state)
{
  static Case c;

  (void)state;
  for (int i = 0; i < 6; i++) {
    for (int derivatives = FIT_FULL; derivatives <= FIT_DIFFUSE; derivatives++) {
      RandomCase(&c, cases[i][0], cases[i][1], 3);
      c.in.derivatives = derivatives;
      assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
      CheckBalance(&c);
    }
  }
}

/* Diffuse derivatives do not change gap and N. They are the full derivatives where the weights are constant, which
   they are in a support that is far too large. */
static void TestDiffuseDerivatives(void **state)
{
  static Case full, diffuse;

  (void)state;
  for (int i = 0; i < 6; i++) {
    RandomCase(&full, cases[i][0], cases[i][1], 3);
    for (int large = 0; large < 2; large++) {
      long   size;
      double difference = 0, most;

      if (large)
        for (int k = 0; k < 4; k++) full.in.metric[k / 2][k % 2] *= 1e-10;
      diffuse                = full;
      diffuse.in.derivatives = FIT_DIFFUSE;
      assert_true(Evaluate(&full, FIT_SECOND_VARIATION) && Evaluate(&diffuse, FIT_SECOND_VARIATION));
      size = full.in.dim * (1 + full.out.n);
      assert_true(full.out.gap == diffuse.out.gap);
      assert_memory_equal(full.N, diffuse.N, size * sizeof(double));
      most = MaxAbs(size * size, full.M);
      for (long k = 0; k < size * size; k++) difference = fmax(difference, fabs(full.M[k] - diffuse.M[k]));
      if (large)
        assert_true(difference < 1e-6 * most);
      else
        assert_true(difference > 1e-3 * most);
    }
  }
}

/* Points that are turned and shifted, with a frame and metric made anew, have the same gap. N and M turn with them. */
static void TestInvariance(void **state)
{
  static Case c, turned;

  (void)state;
  for (int i = 0; i < 6; i++) {
    const int    dim = cases[i][0], degree = cases[i][1];
    const double support = dim == 2 ? 6 : 4.2, shift = 64, slave[3] = {0.5, 0.25, 0.125};
    double R[3][3], C[3][3] = {{1, 0.2, 0}, {0.2, 0.7, 0.1}, {0, 0.1, 0.3}}, RC[3][3] = {{0}}, up[3] = {0}, outward[3],
                    x[3 * MAX], N[3 * (1 + MAX)];
    int size;

    up[dim - 1] = 1;
    Straight(&c, dim, degree, support, 3);
    AddBowl(&c, 1.3 * support, support);
    turned = c;
    Rotation(dim, R);
    Turn(dim, 1, R, up, outward);
    Turn(dim, c.in.n, R, c.x, x);
    /* Nodes and slave point lie far from the origin and are rounded to the spacing of numbers there. */
    for (int k = 0; k < c.in.n * dim; k++) {
      const double far = shift + slave[k % dim] + x[k];

      turned.x[k] = far - (shift + slave[k % dim]);
    }
    for (int a = 0; a < 9; a++) {
      for (int b = 0; b < 9; b++) RC[a / 3][a % 3] += R[a / 3][b / 3] * C[b / 3][b % 3] * R[a % 3][b % 3];
    }
    assert_true(FitFrame(dim, c.in.n, c.x, c.v, up, c.in.frame) &&
                FitFrame(dim, c.in.n, turned.x, c.v, outward, turned.in.frame));
    FitMetricFromCovariance(dim, c.in.frame, C, 1, support, c.in.metric);
    FitMetricFromCovariance(dim, turned.in.frame, RC, 1, support, turned.in.metric);
    assert_true(Evaluate(&c, FIT_SECOND_VARIATION) && Evaluate(&turned, FIT_SECOND_VARIATION));
    size = dim * (1 + c.out.n);
    assert_int_equal(turned.out.n, c.out.n);
    AssertNear(turned.out.gap, c.out.gap, 1e-12);
    Turn(dim, 1 + c.out.n, R, c.N, N);
    for (int k = 0; k < size; k++) AssertNear(turned.N[k], N[k], 1e-12);
    for (int a = 0; a <= c.out.n; a++) {
      for (int b = 0; b <= c.out.n; b++) {
        for (int k = 0; k < dim * dim; k++) {
          double sum = 0;

          for (int l = 0; l < dim * dim; l++)
            sum += R[k / dim][l / dim] * c.M[(a * dim + l / dim) * size + b * dim + l % dim] * R[k % dim][l % dim];
          AssertNear(turned.M[(a * dim + k / dim) * size + b * dim + k % dim], sum, 1e-12);
        }
      }
    }
  }
}

/* Half a bowl, mirrored at x = 0. Its points carry reflection maps. Nodes on the plane occur once, with twice their
   half area. */
typedef struct {
  int    nodes, node[MAX], image[MAX]; /* of each point: its node, and whether the point is the image */
  double x[3 * MAX], v[MAX];           /* of the nodes */
} Half;

static void Mirror(const Half *half, const double slave[3], Case *c, Half *map)
{
  c->in.n = 0;
  for (int a = 0; a < half->nodes; a++) {
    const int on = half->x[3 * a] == 0;

    for (int image = 0; image < (on ? 1 : 2); image++) {
      map->node[c->in.n]  = a;
      map->image[c->in.n] = image;
      AddPoint(c, (image ? -1 : 1) * half->x[3 * a] - slave[0], half->x[3 * a + 1] - slave[1],
               half->x[3 * a + 2] - slave[2], (on ? 2 : 1) * half->v[a]);
    }
  }
}

/* R^T N and R^T M R, accumulated over the nodes of the half model; the slave point comes first. */
static void Accumulate(const Half *half, const Half *map, const Case *c, double *N, double *M)
{
  const int size = 3 * (1 + half->nodes), own = 3 * (1 + c->out.n);
  int       at[3 * (1 + FEW)];
  double    sign[3 * (1 + FEW)];

  memset(N, 0, size * sizeof(double));
  memset(M, 0, (long)size * size * sizeof(double));
  for (int i = 0; i < own; i++) {
    const int point = i < 3 ? -1 : c->points[i / 3 - 1];

    at[i]   = point < 0 ? i : 3 * (1 + map->node[point]) + i % 3;
    sign[i] = point >= 0 && map->image[point] && i % 3 == 0 ? -1 : 1;
    N[at[i]] += sign[i] * c->N[i];
  }
  for (int i = 0; i < own; i++) {
    for (int j = 0; j < own; j++) M[at[i] * size + at[j]] += sign[i] * sign[j] * c->M[i * own + j];
  }
}

static void TestMirror(void **state)
{
  static Case   c, full;
  static Half   half, map;
  static double N[3 * (1 + FEW)], M[9 * (1 + FEW) * (1 + FEW)], moved[4][3 * (1 + FEW)],
    scratch[9 * (1 + FEW) * (1 + FEW)];
  const double h = 2e-4, support = 4.2;

  (void)state;
  memset(&half, 0, sizeof(half));
  for (int i = 0; i <= 5; i++) {
    for (int j = -5; j <= 5; j++) {
      const double s = i == 0 ? 0 : i + Random(-0.2, 0.2), t = j + Random(-0.2, 0.2),
                   z = -(s * s + t * t) / 15 + Random(-0.03, 0.03);

      if (hypot(s, t) > 5.2) continue;
      memcpy(half.x + 3 * half.nodes, (double[3]){s, t, z}, 3 * sizeof(double));
      half.v[half.nodes++] = i == 0 ? 0.5 : 1;
    }
  }
  for (int on = 0; on < 2; on++) {
    double slave[3] = {on ? 0 : 0.4, 0.1, 0.2}, most = 0;
    int    size = 3 * (1 + half.nodes);

    Straight(&c, 3, 4, support, 4);
    Mirror(&half, slave, &c, &map);
    full = c; /* the full model in another order */
    for (int i = 0; i < c.in.n; i++) {
      const int j = (7 * i + 3) % c.in.n;

      memcpy(full.x + 3 * i, c.x + 3 * j, 3 * sizeof(double));
      full.v[i] = c.v[j];
    }
    assert_true(c.in.n % 7 != 0);
    assert_true(Evaluate(&full, FIT_GAP) && Evaluate(&c, FIT_SECOND_VARIATION));
    assert_int_equal(full.out.n, c.out.n);
    AssertNear(full.out.gap, c.out.gap, 1e-13);
    Accumulate(&half, &map, &c, N, M);
    if (on) AssertNear(c.out.normal[0], 0, 1e-14);
    if (on) AssertNear(N[0], 0, 1e-14);
    for (int i = 0; i < size * size; i++) most = fmax(most, fabs(M[i]));
    for (int column = 0; column < size; column++) {
      double *position = column < 3 ? slave + column : half.x + column - 3, value = *position, gap[4];

      if (column >= 3 && column % 3 == 0 && value == 0) continue; /* fixed, because a node stays on its plane */
      for (int s = 0; s < 4; s++) {
        *position = value + (s < 2 ? s - 2 : s - 1) * h;
        Mirror(&half, slave, &c, &map);
        assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
        gap[s] = c.out.gap;
        Accumulate(&half, &map, &c, moved[s], scratch);
      }
      *position = value;
      AssertNear(N[column], Difference(gap, h), 1e-7);
      for (int row = 0; row < size; row++) {
        AssertNear(M[row * size + column],
                   Difference((double[4]){moved[0][row], moved[1][row], moved[2][row], moved[3][row]}, h), 1e-7 * most);
      }
    }
  }
}

/* A bowl that is even in t, as points (x, y, t) and (x, y, -t) in space and as points of a fit of revolution. The frame
   is turned about t. */
static void RevolvedCase(Case *space, Case *revolved, int degree)
{
  const double support = degree == 4 ? 4.2 : 3, angle = Random(-1, 1), c = cos(angle), s = sin(angle);
  const double frame[3][3] = {{c, s, 0}, {0, 0, 1}, {-s, c, 0}};

  Straight(space, 3, degree, support, 3.5);
  Straight(revolved, 2, degree + FIT_REVOLVED, support, 3.5);
  memcpy(space->in.frame, frame, sizeof(frame));
  memcpy(revolved->in.frame[0], frame[0], sizeof(frame[0]));
  memcpy(revolved->in.frame[1], frame[2], sizeof(frame[2]));
  for (int i = -5; i <= 5; i++) {
    for (int j = 0; j <= 5; j++) {
      const double a = i + Random(-0.25, 0.25), t = j + 0.5 + Random(-0.25, 0.25), v = Random(0.5, 1.5);
      const double z = -(a * a + 0.5 * t * t) / 14 - 0.3 + Random(-0.05, 0.05), x[2] = {c * a - s * z, s * a + c * z};

      if (fabs(hypot(a, t) - support) < 0.02 * support) continue;
      for (int side = -1; side <= 1; side += 2) {
        memcpy(space->x + 3 * space->in.n, x, sizeof(x));
        space->x[3 * space->in.n + 2] = side * t;
        space->v[space->in.n++]       = v;
      }
      memcpy(revolved->x + 2 * revolved->in.n, x, sizeof(x));
      revolved->t[revolved->in.n]   = t;
      revolved->v[revolved->in.n++] = 2 * v;
    }
  }
}

/* A fit of revolution is the fit in space: the same gap, foot and normal, the same N, and an N and M that are
   derivatives of the gap. */
static void TestRevolution(void **state)
{
  static Case space, revolved;

  (void)state;
  for (int degree = 1; degree <= 4; degree += degree == 1 ? 1 : 2) {
    double most;

    RevolvedCase(&space, &revolved, degree);
    assert_true(Evaluate(&space, FIT_FIRST_VARIATION) && Evaluate(&revolved, FIT_FIRST_VARIATION));
    AssertNear(revolved.out.gap, space.out.gap, 1e-13);
    AssertNear(revolved.out.foot[0], space.out.foot[0], 1e-13);
    AssertNear(revolved.out.amplified, space.out.amplified, 1e-12);
    assert_int_equal(2 * revolved.out.n, space.out.n);
    most = MaxAbs(2 * (1 + revolved.out.n), revolved.N);
    for (int d = 0; d < 2; d++) {
      AssertNear(revolved.out.normal[d], space.out.normal[d], 1e-13);
      AssertNear(revolved.N[d], space.N[d], 1e-12 * most);
      for (int i = 0; i < revolved.out.n; i++)
        AssertNear(revolved.N[2 * (1 + i) + d], space.N[3 * (1 + 2 * i) + d] + space.N[3 * (2 + 2 * i) + d],
                   1e-12 * most);
    }
    CheckVariations(&revolved);
  }
}

/* In bent coordinates N and M are the derivatives of the gap, and they balance. Without a bend they are those of the
   straight fit. */
static void TestBent(void **state)
{
  static const double exponents[] = {3, 3.5, 6};
  static Case         bent, straight;

  (void)state;
  for (int i = 3; i < 6; i++) {
    for (int e = 0; e < 3; e++) {
      const double angle = Random(-3, 3), scale[2] = {0.05, 5e-4};

      RandomCase(&straight, 3, cases[i][1], exponents[e]);
      bent           = straight;
      bent.in.degree = FIT_BENT + straight.in.degree;
      bent.in.bend   = (FitBend){.along = {cos(angle), sin(angle)}};
      assert_true(Evaluate(&straight, FIT_SECOND_VARIATION) && Evaluate(&bent, FIT_SECOND_VARIATION));
      assert_int_equal(straight.out.n, bent.out.n);
      AssertNear(straight.out.gap, bent.out.gap, 1e-14);
      for (int k = 0; k < 3 * (1 + bent.out.n); k++) AssertNear(straight.N[k], bent.N[k], 1e-13);
      for (int k = 0; k < 2; k++) bent.in.bend.h[k] = Random(0.3, 1) * scale[k];
      CheckVariations(&bent);
      assert_true(Evaluate(&bent, FIT_SECOND_VARIATION));
      CheckBalance(&bent);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(TestBent),    cmocka_unit_test(TestVariations),         cmocka_unit_test(TestRevolution),
    cmocka_unit_test(TestBalance), cmocka_unit_test(TestDiffuseDerivatives), cmocka_unit_test(TestInvariance),
    cmocka_unit_test(TestMirror)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
