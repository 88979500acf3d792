/* Variations over nodes are those over points, summed by the map, and they are the derivatives of the gap when the
   nodes move. */
#include "fitcase.h"
#include "smooth/fitderivatives.h"

enum { MAX_ENTRIES = 12, NODES = 1 + FEW, SIZE = 3 * NODES, MAP_WORK = 200000 };

/* A map with its arrays. */
typedef struct {
  FitDerivatives map;
  int            ptr[2 + FEW], run[1 + FEW], node[(1 + FEW) * MAX_ENTRIES];
  double         S[(1 + FEW) * MAX_ENTRIES], sign[3 * (1 + FEW) * MAX_ENTRIES];
} Map;

static int Whole(int low, int high)
{
  return low + (int)Random(0, high - low + 1 - 1e-9);
}

static void Empty(Map *m, int n_nodes)
{
  m->map    = (FitDerivatives){n_nodes, m->ptr, m->run, m->node, m->S, m->sign};
  m->ptr[0] = 0;
}

/* Makes runs of rows with the same 1 to 9 nodes and signs, like those of faces, and rows that differ only in their
   signs. The signs are those of the row or, as for offsets whose nodes lie on both sides of a mirror plane, those of
   each entry. Nodes are shared with other runs and with the slave point, occur twice in a row, or are left out. */
static void RandomMap(Map *m, int n, int n_nodes)
{
  int    entries = 0, node[9];
  double sign[27];

  Empty(m, n_nodes);
  for (int r = 0, left = 0; r <= n; r++, left--) {
    const int at = m->ptr[r], same = left > 0 && left % 3;

    if (left <= 0) {
      left    = Whole(1, 9);
      entries = Whole(1, 9);
      for (int k = 0; k < entries; k++) node[k] = Whole(-1, n_nodes - 1);
    }
    for (int k = 0, mixed = Whole(0, 1); k < 3 * entries && !same; k++)
      sign[k] = k >= 3 && !mixed ? sign[k - 3] : Whole(0, 1) ? -1 : 1;
    for (int k = 0; k < entries; k++) {
      m->node[at + k] = node[k];
      m->S[at + k]    = Random(-0.5, 1);
    }
    memcpy(m->sign + 3 * at, sign, 3 * entries * sizeof(double));
    m->run[r]     = same ? m->run[r - 1] : r;
    m->ptr[r + 1] = at + entries;
  }
}

/* S as a dense matrix, [size][points' components]. */
static void Dense(int dim, int n, const FitDerivatives *map, double *S)
{
  const int own = dim * (1 + n);

  memset(S, 0, (size_t)map->n_nodes * dim * own * sizeof(double));
  for (int r = 0; r <= n; r++) {
    for (int e = map->ptr[r]; e < map->ptr[r + 1]; e++) {
      for (int c = 0; c < dim && map->node[e] >= 0; c++)
        S[(map->node[e] * dim + c) * own + r * dim + c] += map->sign[3 * e + c] * map->S[e];
    }
  }
}

/* S^T N and S^T M S by dense products. */
static void Reference(const Case *c, const FitDerivatives *map, double *N, double *M)
{
  static double S[SIZE * SIZE], half[SIZE * SIZE];
  const int     own = c->in.dim * (1 + c->out.n), size = c->in.dim * map->n_nodes;

  Dense(c->in.dim, c->out.n, map, S);
  memset(half, 0, sizeof(half));
  memset(M, 0, (size_t)size * size * sizeof(double));
  for (int i = 0; i < size; i++) {
    N[i] = 0;
    for (int r = 0; r < own; r++) {
      const double s = S[i * own + r];

      N[i] += s * c->N[r];
      for (int k = 0; k < own && s != 0; k++) half[i * own + k] += s * c->M[r * own + k];
    }
  }
  for (int i = 0; i < size; i++) {
    for (int j = 0; j < size; j++) {
      for (int k = 0; k < own; k++) M[i * size + j] += half[i * own + k] * S[j * own + k];
    }
  }
}

/* N and M over nodes by the kernel. M is a sum of shares, one of them dense, and the outer product of a vector with
   itself is added and subtracted again. Nothing is written past the ends. */
static void Mapped(Case *c, const FitDerivatives *map, double *N, double *M)
{
  static double scratch[MAP_WORK], own[FEW][FIT_DERIVATIVES_OWN];
  const int     depth    = 2 * FitDerivativesDepth(c->in.dim, c->in.degree) + c->in.dim * (1 + c->out.n) + 2;
  const long    length   = FitWorkspace(c->in.dim, c->in.degree, c->in.n),
             need        = FitDerivativesWorkspace(c->in.dim, c->in.degree, map->n_nodes, depth);
  const int         size = c->in.dim * map->n_nodes;
  FitFactors        factors;
  FitDerivativesSum sum;
  FitResult         out = {.points = c->points, .N = c->N, .factors = &factors};

  assert_true(1 + need < MAP_WORK && 1 + length < WORK);
  for (int i = 0; i < MAP_WORK; i++) scratch[i] = NAN;
  for (int i = 0; i < WORK; i++) work[i] = NAN;
  work[1 + length] = scratch[1 + need] = N[size] = M[(long)size * size] = 7;
  assert_true(DiffuseFitEvaluate(&c->in, FIT_SECOND_VARIATION, work + 1, &out));
  assert_int_equal(factors.n, out.n);
  FitDerivativesFirst(c->in.dim, out.n, c->N, map, N);
  FitDerivativesBegin(&sum, c->in.dim, c->in.degree, map->n_nodes, depth, scratch + 1);
  FitDerivativesAdd(&sum, -2, &factors, map);
  FitDerivativesAdd(&sum, 2.5, &factors, map);
  FitDerivativesAddOuter(&sum, 2, N);
  FitDerivativesAddDense(&sum, 0.5, out.n, c->M, map);
  FitDerivativesAddOuter(&sum, -2, N);
  FitDerivativesEnd(&sum, M);
  memset(own, 0, sizeof(own));
  for (int i = 0; i < out.n; i++) {
    FitDerivativesOwn(-2, &factors, i, own[i]);
    FitDerivativesOwn(2.5, &factors, i, own[i]);
  }
  FitDerivativesAddOwn(c->in.dim, 1, 1 + out.n, own, map, M);
  assert_true(work[1 + length] == 7 && scratch[1 + need] == 7 && N[size] == 7 && M[(long)size * size] == 7);
  for (int i = 0; i < size; i++) {
    for (int j = 0; j < i; j++) M[i * size + j] = M[j * size + i];
  }
}

static void Compare(long n, const double *a, const double *b, double tolerance)
{
  const double scale = MaxAbs(n, b);

  for (long i = 0; i < n; i++) AssertNear(a[i], b[i], tolerance * scale);
}

static void TestSums(void **state)
{
  static Case   c;
  static Map    m;
  static double N[SIZE + 1], M[SIZE * SIZE + 1], reference_N[SIZE], reference_M[SIZE * SIZE];

  (void)state;
  for (int i = 0; i < 6; i++) {
    for (int repeat = 0; repeat < 6; repeat++) {
      int size;

      RandomCase(&c, cases[i][0], cases[i][1], 3);
      c.in.derivatives = repeat % 3 == 2 ? FIT_DIFFUSE : FIT_FULL;
      assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
      RandomMap(&m, c.out.n, Whole(1, repeat < 3 ? 9 : 60));
      size = c.in.dim * m.map.n_nodes;
      Reference(&c, &m.map, reference_N, reference_M);
      Mapped(&c, &m.map, N, M);
      Compare(size, N, reference_N, 1e-13);
      Compare((long)size * size, M, reference_M, 1e-13);
    }
  }
}

/* Each point has its own node, so that nothing is summed. */
static void TestOwnNodes(void **state)
{
  static Case   c;
  static Map    m;
  static double N[SIZE + 1], M[SIZE * SIZE + 1];

  (void)state;
  for (int i = 0; i < 6; i++) {
    int size;

    RandomCase(&c, cases[i][0], cases[i][1], 3);
    assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
    Empty(&m, 1 + c.out.n);
    for (int r = 0; r <= c.out.n; r++) {
      m.node[r]    = r;
      m.S[r]       = 1;
      m.run[r]     = r;
      m.ptr[r + 1] = r + 1;
      for (int k = 0; k < 3; k++) m.sign[3 * r + k] = 1;
    }
    size = c.in.dim * m.map.n_nodes;
    Mapped(&c, &m.map, N, M);
    assert_memory_equal(N, c.N, size * sizeof(double));
    Compare((long)size * size, M, c.M, 1e-14);
  }
}

/* Moves a component of a node. The points move by the map, relative to the slave point, which moves too. */
static void Move(Case *c, const FitDerivatives *map, int column, double step)
{
  const int dim = c->in.dim, k = column % dim;
  double    by[1 + FEW] = {0};

  for (int r = 0; r <= c->out.n; r++) {
    for (int e = map->ptr[r]; e < map->ptr[r + 1]; e++)
      by[r] += map->node[e] == column / dim ? step * map->sign[3 * e + k] * map->S[e] : 0;
  }
  for (int i = 0; i < c->in.n; i++) c->x[i * dim + k] -= by[0];
  for (int i = 0; i < c->out.n; i++) c->x[c->points[i] * dim + k] += by[1 + i];
}

/* Fourth-order central difference from the values at -2h, -h, h, 2h. */
static double Difference(const double value[4], double h)
{
  return (value[0] - 8 * value[1] + 8 * value[2] - value[3]) / (12 * h);
}

static void TestDerivatives(void **state)
{
  static Case   c, moved;
  static Map    m;
  static double N[SIZE + 1], M[SIZE * SIZE + 1], moved_N[4][SIZE + 1];
  const double  h = 1e-4;

  (void)state;
  for (int i = 0; i < 6; i++) {
    int    size;
    double most;

    RandomCase(&c, cases[i][0], cases[i][1], 3);
    assert_true(Evaluate(&c, FIT_SECOND_VARIATION));
    RandomMap(&m, c.out.n, 14);
    size = c.in.dim * m.map.n_nodes;
    Mapped(&c, &m.map, N, M);
    most = MaxAbs((long)size * size, M);
    for (int column = 0; column < size; column++) {
      double gap[4];

      for (int s = 0; s < 4; s++) {
        memcpy(&moved, &c, offsetof(Case, N));
        memcpy(moved.points, c.points, sizeof(c.points));
        Move(&moved, &m.map, column, (s < 2 ? s - 2 : s - 1) * h);
        assert_true(Evaluate(&moved, FIT_FIRST_VARIATION));
        assert_int_equal(moved.out.n, c.out.n);
        gap[s] = moved.out.gap;
        FitDerivativesFirst(c.in.dim, c.out.n, moved.N, &m.map, moved_N[s]);
      }
      AssertNear(N[column], Difference(gap, h), 1e-7 * MaxAbs(size, N));
      for (int row = 0; row < size; row++) {
        AssertNear(M[row * size + column],
                   Difference((double[4]){moved_N[0][row], moved_N[1][row], moved_N[2][row], moved_N[3][row]}, h),
                   1e-7 * most);
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestSums), cmocka_unit_test(TestOwnNodes),
                                     cmocka_unit_test(TestDerivatives)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
