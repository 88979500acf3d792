/* Measures the diffuse fit over nodes, as surface-to-surface contact needs it, in microseconds per slave quadrature
   point. The points of the fit are quadrature points of master faces, and the slave point is a quadrature point of a
   slave face. A line is row, column and value; a line with # begins a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bench.h"
#include "smooth/fitframe.h"
#include "smooth/fitderivatives.h"
#include "symmetricproduct.h"

/* Numbers of slave points and of repetitions, faces along a side of the patch, largest order of an element, largest
   numbers of nodes on a side and on a face, and largest number of points in a list. */
enum {
  SLAVES     = 48,
  REPEATS    = 60,
  SIDE       = 7,
  MAX_ORDER  = 2,
  MAX_LINE   = SIDE * MAX_ORDER + 1,
  MAX_FACE   = 9,
  MAX_POINTS = SIDE * SIDE * MAX_FACE
};
/* Largest number of nodes of a list and of the slave face, and largest size of N */
enum { MAX_NODES = MAX_LINE * MAX_LINE + MAX_FACE, MAX_SIZE = 3 * MAX_NODES };
/* Radius of the master's sphere, in face sizes */
static const double radius = 15;

typedef struct {
  int    dim, degree, order;
  double support, exponent;
} Kind;

/* The list of one slave point, and the nodes of every point in the list */
typedef struct {
  int    n, entries; /* number of points in the list; number of nodes of a face */
  int    node[MAX_POINTS * MAX_FACE];
  double x[3 * MAX_POINTS], multiplier[MAX_POINTS], S[MAX_POINTS * MAX_FACE];
} List;

/* The points inside the support, and the nodes on which they depend */
typedef struct {
  FitDerivatives map;
  int            ptr[MAX_POINTS + 2], run[MAX_POINTS + 1], node[(MAX_POINTS + 1) * MAX_FACE];
  double         S[(MAX_POINTS + 1) * MAX_FACE], sign[3 * (MAX_POINTS + 1) * MAX_FACE];
} Map;

/* Returns shape function a of a line element at s in [0, 1]. */
static double LineShape(int order, int a, double s)
{
  if (order == 1) return a == 0 ? 1 - s : s;
  return a == 0 ? (1 - s) * (1 - 2 * s) : a == 1 ? 4 * s * (1 - s) : s * (2 * s - 1);
}

/* Makes a patch of faces around the slave point. Its nodes are randomly shifted, and its faces have order + 1
   quadrature points in each direction. */
static void Fill(const Kind *kind, List *list)
{
  static const double gauss[2][3] = {{0.211324865405187, 0.788675134594813, 0},
                                     {0.112701665379258, 0.5, 0.887298334620742}};
  const int           order = kind->order, q = order + 1, line = SIDE * order + 1, rows = kind->dim == 3 ? SIDE : 1;
  const double        shift[2] = {Random(-0.5, 0.5), Random(-0.5, 0.5)};
  double              x[3 * MAX_LINE * MAX_LINE];

  for (int i = 0; i < line; i++) {
    for (int j = 0; j < (kind->dim == 3 ? line : 1); j++) {
      double      *at = x + 3 * (i * line + j);
      const double s  = (double)i / order - 0.5 * SIDE + shift[0] + Random(-0.15, 0.15) / order;
      const double t  = kind->dim == 3 ? (double)j / order - 0.5 * SIDE + shift[1] + Random(-0.15, 0.15) / order : 0;

      at[0]             = s;
      at[1]             = t;
      at[kind->dim - 1] = sqrt(radius * radius - s * s - t * t) - radius - 0.01;
    }
  }
  list->n       = 0;
  list->entries = kind->dim == 3 ? q * q : q;
  for (int face = 0; face < SIDE * rows; face++) {
    const int origin = kind->dim == 3 ? face / SIDE * order * line + face % SIDE * order : face * order * line;

    for (int p = 0; p < list->entries; p++, list->n++) {
      double *const at = list->x + list->n * kind->dim;

      for (int c = 0; c < kind->dim; c++) at[c] = 0;
      for (int a = 0; a < list->entries; a++) {
        const int    entry = list->n * list->entries + a, i = a % q, j = a / q;
        const double S = LineShape(order, i, gauss[order - 1][p % q]) *
                         (kind->dim == 3 ? LineShape(order, j, gauss[order - 1][p / q]) : 1);

        list->node[entry] = origin + i * line + j;
        list->S[entry]    = S;
        for (int c = 0; c < kind->dim; c++) at[c] += S * x[3 * list->node[entry] + c];
      }
      list->multiplier[list->n] = 1;
    }
  }
}

/* Numbers the nodes of the points inside the support, after the slave point's own nodes. */
static void MakeMap(const List *list, int n, const int *points, Map *map)
{
  int number[MAX_LINE * MAX_LINE], entries = list->entries;

  map->map = (FitDerivatives){list->entries, map->ptr, map->run, map->node, map->S, map->sign};
  for (int i = 0; i < MAX_LINE * MAX_LINE; i++) number[i] = -1;
  for (int i = 0; i < 3 * (1 + n) * list->entries; i++) map->sign[i] = 1;
  for (int k = 0; k < entries; k++) {
    map->node[k] = k;
    map->S[k]    = 1.0 / entries;
  }
  map->ptr[0] = map->run[0] = 0;
  map->ptr[1]               = entries;
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < list->entries; k++, entries++) {
      const int from = points[i] * list->entries + k, node = list->node[from];

      if (number[node] < 0) number[node] = map->map.n_nodes++;
      map->node[entries] = number[node];
      map->S[entries]    = list->S[from];
    }
    map->ptr[2 + i] = entries;
    map->run[1 + i] = 1 + i;
    if (i && list->node[points[i] * list->entries] == list->node[points[i - 1] * list->entries])
      map->run[1 + i] = map->run[i];
  }
}

/* The parts of the work that are measured: the gap, the gap and N, these and the factors K, J, H of M, N and M over the
   nodes, the product that M contains, and all together. */
typedef enum { GAP, GAP_N, FACTORS, NODAL_N, NODAL_M, PRODUCT, ALL, PARTS } Part;
static const char *const names[] = {"gap", "gap,N", "..,K,J,H", "N_nodes", "M_nodes", "(product)", "all"};

typedef struct {
  FitProblem problem;
  FitResult  result;
  FitFactors factors;
  List       list;
  Map        map;
  int        points[MAX_POINTS];
  double     N[3 * (1 + MAX_POINTS)], *workspace;
} Slave;

static double nodal[MAX_SIZE], own[MAX_POINTS][FIT_DERIVATIVES_OWN], M[(long)MAX_SIZE * MAX_SIZE], *scratch;

/* Does one part of the work for one slave point. */
static void Do(Part part, Slave *s)
{
  const int terms = FitTerms(s->problem.dim, s->problem.degree), size = s->map.map.n_nodes * s->problem.dim,
            stride = SymmetricProductStride(size);
  FitDerivativesSum sum;

  s->result.factors = part == FACTORS || part == ALL ? &s->factors : NULL;
  if (part <= FACTORS || part == ALL) {
    if (!DiffuseFitEvaluate(&s->problem,
                            part == GAP     ? FIT_GAP
                            : part == GAP_N ? FIT_FIRST_VARIATION
                                            : FIT_SECOND_VARIATION,
                            s->workspace, &s->result))
      exit(1);
  }
  if (part == NODAL_N || part == ALL) FitDerivativesFirst(s->problem.dim, s->result.n, s->N, &s->map.map, nodal);
  if (part == NODAL_M || part == ALL) {
    FitDerivativesBegin(&sum, s->problem.dim, s->problem.degree, s->map.map.n_nodes,
                        FitDerivativesDepth(s->problem.dim, s->problem.degree), scratch);
    FitDerivativesAdd(&sum, 1, &s->factors, &s->map.map);
    FitDerivativesEnd(&sum, M);
    memset(own, 0, s->result.n * sizeof(own[0]));
    for (int i = 0; i < s->result.n; i++) FitDerivativesOwn(1, &s->factors, i, own[i]);
    FitDerivativesAddOwn(s->problem.dim, 1, 1 + s->result.n, own, &s->map.map, M);
  }
  if (part == PRODUCT) SymmetricProductUpper(size, terms, stride, scratch, scratch + terms * stride, M);
}

static void Setup(const Kind *kind, Slave *s)
{
  double round[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, up[3] = {0};

  up[kind->dim - 1] = 1;
  Fill(kind, &s->list);
  s->problem = (FitProblem){.dim        = kind->dim,
                            .degree     = kind->degree,
                            .exponent   = kind->exponent,
                            .n          = s->list.n,
                            .x          = s->list.x,
                            .multiplier = s->list.multiplier};
  s->result  = (FitResult){.points = s->points, .N = s->N};
  FitFrameFromNormal(kind->dim, up, s->problem.frame);
  FitMetricFromCovariance(kind->dim, s->problem.frame, round, 1, kind->support, s->problem.metric);
  s->workspace = malloc(FitWorkspace(kind->dim, kind->degree, s->list.n) * sizeof(double));
  if (!s->workspace) exit(1);
  Do(FACTORS, s);
  MakeMap(&s->list, s->result.n, s->points, &s->map);
}

/* Prints the shortest time of some repetitions for every part, in microseconds per slave point. */
static void Bench(const char *row, const Kind *kind)
{
  static Slave slaves[SLAVES];
  double       points = 0, nodes = 0;

  for (int i = 0; i < SLAVES; i++) {
    Setup(kind, &slaves[i]);
    points += (double)slaves[i].result.n / SLAVES;
    nodes += (double)slaves[i].map.map.n_nodes / SLAVES;
  }
  printf("%s points %.0f\n%s nodes %.0f\n", row, points, row, nodes);
  for (Part part = GAP; part < PARTS; part++) {
    double best = INFINITY;

    for (int repeat = 0; repeat < REPEATS; repeat++) {
      const double begin = Seconds();

      for (int i = 0; i < SLAVES; i++) Do(part, &slaves[i]);
      best = fmin(best, 1e6 * (Seconds() - begin) / SLAVES);
    }
    printf("%s %s %.2f\n", row, names[part], best);
  }
  for (int i = 0; i < SLAVES; i++) free(slaves[i].workspace);
}

int main(void)
{
  static const struct {
    const char *row;
    Kind        kind;
  } cases[] = {{"hex8,4", {3, 4, 1, 3.0, 3}},
               {"hex8,2", {3, 2, 1, 2.5, 3}},
               {"hex27,4", {3, 4, 2, 2.25, 3}},
               {"quad4,4", {2, 4, 1, 3.0, 3}},
               {"quad9,4", {2, 4, 2, 2.25, 3}}};

  scratch = aligned_alloc(64, (FitDerivativesWorkspace(3, 4, MAX_NODES, FitDerivativesDepth(3, 4)) + 7) / 8 * 64);
  if (!scratch) return 1;
  puts("# diffuse fit over nodes, by element and degree: microseconds per slave quadrature point");
  for (int i = 0; i < (int)(sizeof(cases) / sizeof(cases[0])); i++) Bench(cases[i].row, &cases[i].kind);
  free(scratch);
  return 0;
}
