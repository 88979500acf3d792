/* First and second variation of the diffuse gap over nodes. With rows K_i, J_i, H_i of the points and x_i = S_i x,
       S^T M S = Kbar^T Jbar + Jbar^T Kbar + sum_i (S_i - S_c)^T H_i (S_i - S_c),   Kbar = sum_i K_i S_i,  Jbar
   likewise. In the last sum the points' own part goes to pairs of nodes of one row: it is summed by
   FitDerivativesAddOwn(), for a single slave point or, as slave points near each other see the same points, over many
   of them before it goes to the nodes. What couples them to the slave point is again such a product, sum_i -S_i^T H_i
   S_c - S_c^T H_i S_i + S_c^T H_c S_c = B^T S_c + S_c^T B,   B = 1/2 H_c S_c - sum_i H_i S_i,  H_c = sum H_i, so B and
   S_c are dim more rows of the factors. The rows of many slave points over the same nodes stand below each other: one
   product, which writes the large M once, serves them all. */
#include "smooth/fitderivatives.h"
#include "fitkernel.h"
#include "symmetricproduct.h"
#include <stdint.h>

/* What is summed in registers at a time: vectors of a row, for that many entries of a run */
enum { ROW_VECTORS = 4, ROW_ENTRIES = LANES == 8 ? 4 : 2 };

/* Rows first to end - 1 of the map, which have the same nodes and signs: entry k of row r is S[(r - first)*entries +
 * k], its signs are sign[3*k]. */
typedef struct {
  int           first, end, entries;
  const int    *node;
  const double *S, *sign;
} FitRun;

/* The factors of one slave point over nodes */
typedef struct {
  Lanes *rows; /* [stride + dim][vectors of a row of FitFactors]: by node and component; the last dim are those of left
                  out nodes */
  double *K, *J; /* [terms + dim][stride] */
  int     stride;
  double  factor; /* of this slave point in the sum; K carries it */
} FitNodal;

static int SameNodes(const FitDerivatives *map, int a, int b)
{
  const int *const ptr = map->ptr, entries = ptr[a + 1] - ptr[a];

  if (ptr[b + 1] - ptr[b] != entries) return 0;
  for (int k = 0; k < entries; k++)
    if (map->node[ptr[a] + k] != map->node[ptr[b] + k]) return 0;
  for (int k = 0; k < 3 * entries; k++)
    if (map->sign[3 * ptr[a] + k] != map->sign[3 * ptr[b] + k]) return 0;
  return 1;
}

/* The rows that belong together from `first` on. */
static FitRun NextRun(const FitDerivatives *map, int rows, int first)
{
  const int start = map->ptr[first];
  int       end   = first + 1;

  while (end < rows && SameNodes(map, first, end)) end++;
  return (FitRun){first, end, map->ptr[first + 1] - start, map->node + start, map->S + start, map->sign + 3 * start};
}

/* Adds some vectors of a run's rows of K and J, of component c, to those of some of its nodes. A node may be among them
 * twice. */
LANES_INLINE void AddTile(const int dim, const int vectors, const int entries, const int count,
                          const FitFactors *factors, const FitRun *run, int c, int k, int v, FitNodal *nodal)
{
  const double *S                             = run->S + k;
  const Lanes  *row                           = (const Lanes *)factors->rows + (run->first * dim + c) * vectors + v;
  Lanes         sum[ROW_ENTRIES][ROW_VECTORS] = {{{0}}};

  for (int r = run->first; r < run->end; r++, S += run->entries, row += dim * vectors) {
    for (int a = 0; a < entries; a++) {
      for (int b = 0; b < count; b++) sum[a][b] += S[a] * row[b];
    }
  }
  for (int a = 0; a < entries; a++) {
    const int    node = run->node[k + a];
    const double sign = run->sign[3 * (k + a) + c];
    Lanes *const at   = nodal->rows + ((node < 0 ? nodal->stride : node * dim) + c) * vectors + v;

    for (int b = 0; b < count; b++) at[b] += sign * sum[a][b];
  }
}

LANES_INLINE void AddTiles(const int dim, const int vectors, const int entries, const FitFactors *factors,
                           const FitRun *run, int k, FitNodal *nodal)
{
  for (int c = 0; c < dim; c++) {
    for (int v = 0; v + ROW_VECTORS <= vectors; v += ROW_VECTORS)
      AddTile(dim, vectors, entries, ROW_VECTORS, factors, run, c, k, v, nodal);
    if (vectors % ROW_VECTORS)
      AddTile(dim, vectors, entries, vectors % ROW_VECTORS, factors, run, c, k, vectors - vectors % ROW_VECTORS, nodal);
  }
}

/* Adds a run's rows of K and J to those of its nodes. */
LANES_INLINE void AddRows(const int dim, const int vectors, const FitFactors *factors, const FitRun *run,
                          FitNodal *nodal)
{
  int k = 0;

  for (; k + ROW_ENTRIES <= run->entries; k += ROW_ENTRIES) AddTiles(dim, vectors, ROW_ENTRIES, factors, run, k, nodal);
  for (; k < run->entries; k++) AddTiles(dim, vectors, 1, factors, run, k, nodal);
}

/* Turns the nodes' rows into columns of K and J. */
LANES_INLINE void TurnBack(const int terms, const int vectors, FitNodal *nodal)
{
  for (int i = 0; i < nodal->stride; i += LANES) {
    for (int v = 0; v < vectors; v++) {
      Lanes square[LANES];

      for (int k = 0; k < LANES; k++) square[k] = nodal->rows[(i + k) * vectors + v];
      Transpose(square);
      for (int k = 0; k < LANES; k++) {
        const int term = v * LANES + k;

        if (term < terms) *(Lanes *)(nodal->K + term * nodal->stride + i) = nodal->factor * square[k];
        if (term >= terms && term < 2 * terms) *(Lanes *)(nodal->J + (term - terms) * nodal->stride + i) = square[k];
      }
    }
  }
}

/* sum_r S_rk H_r over a run's rows */
LANES_INLINE void SumHessians(const int vectors, const FitFactors *factors, const FitRun *run, int k, Lanes *sum)
{
  const double *S = run->S;
  const Lanes  *h = (const Lanes *)factors->hessians + run->first * vectors;

  for (int v = 0; v < vectors; v++) sum[v] = Broadcast(0);
  for (int r = run->first; r < run->end; r++, S += run->entries, h += vectors) {
    for (int v = 0; v < vectors; v++) sum[v] += S[k] * h[v];
  }
}

/* Place of component (c, d) in an H */
LANES_INLINE int HessianEntry(const int c, const int d)
{
  return c > d ? c * (c + 1) / 2 + d : d * (d + 1) / 2 + c;
}

/* Adds `share` times the run's part of H_i S_i to B, the last dim rows of K. */
LANES_INLINE void AddSumCoupling(const int dim, const int terms, const FitFactors *factors, const FitRun *run,
                                 double share, FitNodal *nodal)
{
  const int vectors = HessianStride(dim) / LANES;

  for (int k = 0; k < run->entries; k++) {
    Lanes               sum[FIT_HESSIAN];
    const double *const h = (const double *)sum;
    double              sign[3];

    if (run->node[k] < 0) continue;
    for (int c = 0; c < dim; c++) sign[c] = nodal->factor * share * run->sign[3 * k + c];
    SumHessians(vectors, factors, run, k, sum);
    for (int d = 0; d < dim; d++) {
      double *const B = nodal->K + (terms + d) * nodal->stride + run->node[k] * dim;

      for (int c = 0; c < dim; c++) B[c] += sign[c] * h[HessianEntry(c, d)];
    }
  }
}

/* S_c, the last dim rows of J */
LANES_INLINE void AddSlave(const int dim, const int terms, const FitRun *slave, FitNodal *nodal)
{
  for (int k = 0; k < slave->entries; k++) {
    if (slave->node[k] < 0) continue;
    for (int c = 0; c < dim; c++)
      nodal->J[(terms + c) * nodal->stride + slave->node[k] * dim + c] += slave->sign[3 * k + c] * slave->S[k];
  }
}

/* Adds an H between entries of these signs to a block of M. */
LANES_INLINE void AddSumBlock(const int dim, const double *h, const double *row_sign, const double *column_sign,
                              long size, double *block)
{
  for (int c = 0; c < dim; c++) {
    for (int d = 0; d < dim; d++) block[c * size + d] += row_sign[c] * column_sign[d] * h[HessianEntry(c, d)];
  }
}

/* Adds sum_r S_r^T H_r S_r over a run's rows to each pair of its nodes, above the diagonal. own: of row `first`. */
LANES_INLINE void AddPairs(const int dim, int first, const double (*own)[FIT_DERIVATIVES_OWN], const FitRun *run,
                           long size, double *M)
{
  for (int k = 0; k < run->entries; k++) {
    const long          i        = (long)run->node[k] * dim;
    const double *const row_sign = run->sign + 3 * k;

    for (int l = 0; i >= 0 && l <= k; l++) {
      const long          j           = (long)run->node[l] * dim;
      const double *const column_sign = run->sign + 3 * l, *S = run->S;
      double              sum[FIT_DERIVATIVES_OWN] = {0};

      if (j < 0) continue;
      for (int r = run->first; r < run->end; r++, S += run->entries) {
        for (int e = 0; e < FIT_DERIVATIVES_OWN; e++) sum[e] += S[k] * S[l] * own[r - first][e];
      }
      if (i <= j) AddSumBlock(dim, sum, row_sign, column_sign, size, M + i * size + j);
      if (j < i || (j == i && l < k)) AddSumBlock(dim, sum, column_sign, row_sign, size, M + j * size + i);
    }
  }
}

LANES_INLINE void Own(const int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN],
                      const FitDerivatives *map, double *M)
{
  for (FitRun run = {.end = first}; run.end < end;) {
    run = NextRun(map, end, run.end);
    AddPairs(dim, first, own, &run, (long)map->n_nodes * dim, M);
  }
}

LANES_INLINE void Second(const int dim, const int terms, double factor, const FitFactors *factors,
                         const FitDerivatives *map, FitDerivativesSum *sum)
{
  const int    vectors = FactorStride(terms) / LANES, rows = 1 + factors->n;
  const FitRun slave = NextRun(map, 1, 0);
  const long   first = (long)sum->depth * sum->stride;
  FitNodal     nodal = {.rows   = (Lanes *)sum->rows,
                        .K      = sum->K + first,
                        .J      = sum->J + first,
                        .stride = sum->stride,
                        .factor = factor};

  memset(nodal.rows, 0, (size_t)(nodal.stride + dim) * vectors * sizeof(Lanes));
  memset(nodal.K + terms * nodal.stride, 0, (size_t)dim * nodal.stride * sizeof(double));
  memset(nodal.J + terms * nodal.stride, 0, (size_t)dim * nodal.stride * sizeof(double));
  AddRows(dim, vectors, factors, &slave, &nodal);
  AddSumCoupling(dim, terms, factors, &slave, 0.5, &nodal);
  AddSlave(dim, terms, &slave, &nodal);
  for (FitRun run = slave; run.end < rows;) {
    run = NextRun(map, rows, run.end);
    AddRows(dim, vectors, factors, &run, &nodal);
    AddSumCoupling(dim, terms, factors, &run, -1, &nodal);
  }
  TurnBack(terms, vectors, &nodal);
  sum->depth += terms + dim;
}

/* Row i of S: component c of point r */
LANES_INLINE void AddSelection(const int dim, const FitDerivatives *map, int r, int c, double scale, double *row)
{
  for (int e = map->ptr[r]; e < map->ptr[r + 1]; e++) {
    if (map->node[e] >= 0) row[map->node[e] * dim + c] += scale * map->S[e] * map->sign[3 * e + c];
  }
}

/* S^T M S = 1/2 (M S)^T S + S^T 1/2 (M S): a row of M S and of S for each component of each point */
LANES_INLINE void Dense(const int dim, int n, double factor, const double *M, const FitDerivatives *map,
                        FitDerivativesSum *sum)
{
  const int     m     = (1 + n) * dim;
  const long    first = (long)sum->depth * sum->stride;
  double *const K = sum->K + first, *const J = sum->J + first;

  memset(K, 0, (size_t)m * sum->stride * sizeof(double));
  memset(J, 0, (size_t)m * sum->stride * sizeof(double));
  for (int i = 0; i < m; i++) {
    AddSelection(dim, map, i / dim, i % dim, 1, J + (long)i * sum->stride);
    for (int j = 0; j < m; j++)
      AddSelection(dim, map, j / dim, j % dim, 0.5 * factor * M[i * m + j], K + (long)i * sum->stride);
  }
  sum->depth += m;
}

LANES_INLINE void First(const int dim, int n, const double *N, const FitDerivatives *map, double *nodal)
{
  for (int r = 0; r < 1 + n; r++) {
    for (int e = map->ptr[r]; e < map->ptr[r + 1]; e++) {
      if (map->node[e] < 0) continue;
      for (int c = 0; c < dim; c++) nodal[map->node[e] * dim + c] += map->S[e] * map->sign[3 * e + c] * N[r * dim + c];
    }
  }
}

/* FitDerivativesDepth - rows of K and J for one slave point by its factors. Not collective.

   Input: dim, degree - of the fit */
int FitDerivativesDepth(int dim, int degree)
{
  return FitTerms(dim, degree) + dim;
}

/* FitDerivativesWorkspace - doubles of workspace for a sum of second variations. Not collective.

   Input: dim, degree - the highest of the fits; n_nodes - of the maps; depth - most rows of K and J in all:
   FitDerivativesDepth() for each FitDerivativesAdd(), dim*(1 + n) for each FitDerivativesAddDense(), 1 for each
   FitDerivativesAddOuter() */
long FitDerivativesWorkspace(int dim, int degree, int n_nodes, int depth)
{
  const int stride = SymmetricProductStride(n_nodes * dim);

  return ALIGNMENT / (long)sizeof(double) + (long)(stride + dim) * FactorStride(FitTerms(dim, degree)) +
         2L * depth * stride;
}

/* FitDerivativesFirst - the first variation over nodes, S^T N. Not collective.

   Input: dim; n - points inside; N[(1 + n)*dim] - over slave point and points, as DiffuseFitEvaluate() makes it; map
   Output: nodal[n_nodes*dim] */
void FitDerivativesFirst(int dim, int n, const double *N, const FitDerivatives *map, double *nodal)
{
  memset(nodal, 0, (size_t)map->n_nodes * dim * sizeof(double));
  if (dim == 3)
    First(3, n, N, map, nodal);
  else
    First(2, n, N, map, nodal);
}

/* FitDerivativesBegin - begins a sum of second variations over the same nodes. Not collective.

   Input: dim, degree, n_nodes, depth - as of FitDerivativesWorkspace(); workspace - that many doubles of any contents,
   to be left alone until FitDerivativesEnd() */
void FitDerivativesBegin(FitDerivativesSum *sum, int dim, int degree, int n_nodes, int depth, double *workspace)
{
  const int stride = SymmetricProductStride(n_nodes * dim);

  *sum      = (FitDerivativesSum){.dim = dim, .n_nodes = n_nodes, .stride = stride};
  sum->rows = (double *)(((uintptr_t)workspace + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
  sum->K    = sum->rows + (stride + dim) * FactorStride(FitTerms(dim, degree));
  sum->J    = sum->K + (long)depth * stride;
}

/* FitDerivativesAdd - adds factor times the second variation over nodes, S^T M S, of one slave point, without M; the
   points' own H are left to FitDerivativesAddOwn(). Not collective.

   Input: factors - of M, as DiffuseFitEvaluate() leaves them in its workspace; map - nodes below the sum's n_nodes

   Source: Chamoret et al. 2004, eqs 13 and 14, for points that are combinations of nodes. */
void FitDerivativesAdd(FitDerivativesSum *sum, double factor, const FitFactors *factors, const FitDerivatives *map)
{
#define SECOND(dim, degree, terms)               \
  Second(dim, terms, factor, factors, map, sum); \
  return
  INSTANTIATE(factors, SECOND)
#undef SECOND
}

/* FitDerivativesAddDense - adds factor S^T M S. Not collective.

   Input: n - points that take part; M[((1 + n)*dim)^2] - symmetric; map - nodes below the sum's n_nodes */
void FitDerivativesAddDense(FitDerivativesSum *sum, double factor, int n, const double *M, const FitDerivatives *map)
{
  if (sum->dim == 3)
    Dense(3, n, factor, M, map, sum);
  else
    Dense(2, n, factor, M, map, sum);
}

/* FitDerivativesAddOuter - adds factor v v^T. Not collective.

   Input: v[n_nodes*dim] */
void FitDerivativesAddOuter(FitDerivativesSum *sum, double factor, const double *v)
{
  const int     n     = sum->n_nodes * sum->dim;
  const long    first = (long)sum->depth++ * sum->stride;
  double *const K = sum->K + first, *const J = sum->J + first;

  for (int i = 0; i < sum->stride; i++) {
    J[i] = i < n ? v[i] : 0;
    K[i] = 0.5 * factor * J[i];
  }
}

/* FitDerivativesOwn - own += factor H, for point i of those inside. Not collective. */
void FitDerivativesOwn(double factor, const FitFactors *factors, int i, double own[FIT_DERIVATIVES_OWN])
{
  const double *const h = factors->hessians + (1 + i) * factors->hessianstride;

  for (int e = 0; e < factors->dim * (factors->dim + 1) / 2; e++) own[e] += factor * h[e];
}

/* FitDerivativesAddOwn - M += sum_r S_r^T own_r S_r, the points' own part of second variations. Not collective.

   Input: dim; rows first to end - 1 of the map; own[end - first] - of these rows' points, from FitDerivativesOwn().
   M[n_nodes*dim][n_nodes*dim] - its upper triangle, in whole blocks on the diagonal */
void FitDerivativesAddOwn(int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN],
                          const FitDerivatives *map, double *M)
{
  if (dim == 3)
    Own(3, first, end, own, map, M);
  else
    Own(2, first, end, own, map, M);
}

/* FitDerivativesEnd - the sum into the upper triangle of M[n_nodes*dim][n_nodes*dim]; what is below is left alone. Not
 * collective. */
void FitDerivativesEnd(FitDerivativesSum *sum, double *M)
{
  SymmetricProductUpper(sum->n_nodes * sum->dim, sum->depth, sum->stride, sum->K, sum->J, M);
}
