/* Measures the diffuse fit in microseconds per slave point, by dimension, degree and number of points inside the
   support. It measures the gap alone, the gap with N, and the gap with N and M. The lists also have the points of the
   margin. A line of the output is "name value unit". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "bench.h"
#include "smooth/diffusefit.h"
#include "smooth/fitframe.h"
#include "symmetricproduct.h"

/* Numbers of slave points and of repetitions, largest number of points in a list, and largest size of N. */
enum { SLAVES = 64, REPEATS = 40, MAX_LIST = 400, MAX_SIZE = 3 * (1 + MAX_LIST) };
/* `margin` is the largest rho^2 of a point in a list, where rho = 1 is the boundary of the support. `radius` is that of
   the master's sphere, in spacings. */
static const double margin = 1.7, radius = 15;

/* Slave points with their lists of master points, relative to the slave point */
typedef struct {
  int    dim, degree, n[SLAVES];
  double support, exponent, x[SLAVES][3 * MAX_LIST], multiplier[MAX_LIST];
} Neighbourhoods;

/* Puts slave points over the nodes of a sphere or circle, which are one spacing apart and randomly shifted. */
static void Fill(Neighbourhoods *all)
{
  const int dim = all->dim, reach = (int)(1.5 * all->support) + 1;

  for (int i = 0; i < MAX_LIST; i++) all->multiplier[i] = 1;
  for (int s = 0; s < SLAVES; s++) {
    const double shift[2] = {Random(0, 1), Random(0, 1)};
    int          n        = 0;

    for (int i = -reach; i <= reach; i++) {
      for (int j = dim == 3 ? -reach : 0; j <= (dim == 3 ? reach : 0); j++) {
        const double y[2] = {i + shift[0] + Random(-0.2, 0.2), dim == 3 ? j + shift[1] + Random(-0.2, 0.2) : 0},
                     r2   = y[0] * y[0] + y[1] * y[1];

        if (r2 > margin * all->support * all->support || n == MAX_LIST) continue;
        for (int k = 0; k < dim - 1; k++) all->x[s][n * dim + k] = y[k];
        all->x[s][n * dim + dim - 1] = sqrt(radius * radius - r2) - radius - 0.01;
        n++;
      }
    }
    all->n[s] = n;
  }
}

/* Returns the shortest time of some repetitions, in microseconds per slave point. *points is the mean number of points
   inside the support. */
static double Time(const Neighbourhoods *all, FitWant want, double *points)
{
  static int    index[MAX_LIST];
  static double N[MAX_SIZE], M[(long)MAX_SIZE * MAX_SIZE];
  double        best = INFINITY, *workspace = malloc(FitWorkspace(all->dim, all->degree, MAX_LIST) * sizeof(double));
  double        round[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, up[3] = {0, 0, 1};
  FitProblem    in = {.dim = all->dim, .degree = all->degree, .exponent = all->exponent, .multiplier = all->multiplier};

  if (!workspace) exit(1);
  FitFrameFromNormal(in.dim, in.dim == 3 ? up : up + 1, in.frame);
  FitMetricFromCovariance(in.dim, in.frame, round, 1, all->support, in.metric);
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    const double begin = Seconds();
    int          sum   = 0;

    for (int s = 0; s < SLAVES; s++) {
      FitResult out = {.points = index, .N = N, .M = M};

      in.n = all->n[s];
      in.x = all->x[s];
      if (!DiffuseFitEvaluate(&in, want, workspace, &out)) exit(1);
      sum += out.n;
    }
    best    = fmin(best, 1e6 * (Seconds() - begin) / SLAVES);
    *points = (double)sum / SLAVES;
  }
  free(workspace);
  return best;
}

/* Measures only the product that M contains, as a bound of what the machine can reach. */
static void BenchProduct(int points)
{
  const int size = 3 * (1 + points), stride = SymmetricProductStride(size), terms = FitTerms(3, 4);
  double   *K = aligned_alloc(64, terms * stride * sizeof(double)), *M = malloc((long)size * size * sizeof(double)),
         best = INFINITY;

  if (!K || !M) exit(1);
  for (int i = 0; i < terms * stride; i++) K[i] = Random(-1, 1);
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    const double begin = Seconds();

    for (int s = 0; s < SLAVES; s++) SymmetricProduct(size, terms, stride, K, K, M);
    best = fmin(best, 1e6 * (Seconds() - begin) / SLAVES);
  }
  printf("product_of_M_points_%d %.2f us\n", points, best);
  free(K);
  free(M);
}

int main(void)
{
  static const struct {
    int    dim, degree;
    double support, exponent;
  } cases[]                        = {{3, 2, 2.52, 3}, {3, 2, 3.5, 6}, {3, 4, 3.5, 3}, {3, 4, 4.5, 3},
                                      {3, 4, 6.0, 3},  {2, 2, 3.5, 6}, {2, 4, 4.5, 6}};
  static const char *const names[] = {"gap", "gap_N", "gap_N_M"};
  static Neighbourhoods    all;

  for (int i = 0; i < (int)(sizeof(cases) / sizeof(cases[0])); i++) {
    all.dim      = cases[i].dim;
    all.degree   = cases[i].degree;
    all.support  = cases[i].support;
    all.exponent = cases[i].exponent;
    Fill(&all);
    for (int want = FIT_GAP; want <= FIT_SECOND_VARIATION; want++) {
      double       points;
      const double us = Time(&all, want, &points);

      printf("%s_%dD_degree_%d_points_%.0f %.2f us\n", names[want - FIT_GAP], all.dim, all.degree, points, us);
    }
  }
  BenchProduct(113);
  return 0;
}
