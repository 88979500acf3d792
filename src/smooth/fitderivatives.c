/* First and second variation of the diffuse gap over nodes. With the rows K_i, J_i, H_i of the points and x_i = S_i x,
       S^T M S = Kbar^T Jbar + Jbar^T Kbar + sum_i (S_i - S_c)^T H_i (S_i - S_c)
   with Kbar = sum_i K_i S_i and Jbar likewise.

   In the last sum the points' own part S_i^T H_i S_i couples pairs of nodes of one row. FitDerivativesAddOwn() adds it,
   for a single slave point or for many. Slave points near each other see the same points, so that their H are summed
   before they go to the nodes.

   The part that couples the points to the slave point is again such a product:
       sum_i -S_i^T H_i S_c - S_c^T H_i S_i + S_c^T H_c S_c = B^T S_c + S_c^T B
   with B = 1/2 H_c S_c - sum_i H_i S_i and H_c = sum H_i. So B and S_c are dim more rows of the factors. They stand
   apart, because S_c has few entries: all slave points of a face have the same nodes. The rows of many slave points
   over the same nodes stand below each other. One product, which writes the large M once, serves all of them. */
#include "smooth/fitderivatives.h"
#include "fitkernel.h"
#include "symmetricproduct.h"
#include <stdint.h>

/* Size of the sums that are held in registers: so many vectors of a row for so many entries of a run. */
enum { ROW_VECTORS = 4, ROW_ENTRIES = LANES == 8 ? 4 : 2 };
/* Entries of a run whose sums of a first variation are held in registers */
enum { FIRST_ENTRIES = 4 };

/* A run: the rows first to end - 1 of the map, which have the same nodes and signs. Entry k of row r is S[(r -
   first)*entries + k], and its signs are sign[3*k]. */
typedef struct {
  int           first, end, entries;
  const int    *node;
  const double *S, *sign;
} FitRun;

/* The factors of one slave point over nodes. */
typedef struct {
  /* [stride + dim][vectors of a row of FitFactors], by node and component. The last dim rows are those of nodes that
     are left out. */
  Lanes  *rows;
  double *K, *J; /* [terms][stride] */
  double *B, *S; /* [dim][stride]: the coupling */
  int     stride;
  double  factor; /* of this slave point in the sum; it is applied to K */
} FitNodal;

/* The run of rows that starts at `first`. */
static FitRun NextRun(const FitDerivatives *map, int rows, int first)
{
  const int start = map->ptr[first];
  int       end   = first + 1;

  while (end < rows && map->run[end] == map->run[first]) end++;
  return (FitRun){first, end, map->ptr[first + 1] - start, map->node + start, map->S + start, map->sign + 3 * start};
}

/* Adds some vectors of a run's rows of K and J, in component c, to the rows of some of its nodes. A node may be
   among them twice. */
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

/* Adds all vectors of some entries of a run to the rows of their nodes, tile by tile. */
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

/* Adds a run's rows of K and J to the rows of its nodes. */
LANES_INLINE void AddRows(const int dim, const int vectors, const FitFactors *factors, const FitRun *run,
                          FitNodal *nodal)
{
  int k = 0;

  for (; k + ROW_ENTRIES <= run->entries; k += ROW_ENTRIES) AddTiles(dim, vectors, ROW_ENTRIES, factors, run, k, nodal);
  for (; k < run->entries; k++) AddTiles(dim, vectors, 1, factors, run, k, nodal);
}

/* Transposes the nodes' rows into columns of K and J. */
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

/* sum_r S_rk H_r over the rows of a run. */
LANES_INLINE void SumHessians(const int vectors, const FitFactors *factors, const FitRun *run, int k, Lanes *sum)
{
  const double *S = run->S;
  const Lanes  *h = (const Lanes *)factors->hessians + run->first * vectors;

  for (int v = 0; v < vectors; v++) sum[v] = Broadcast(0);
  for (int r = run->first; r < run->end; r++, S += run->entries, h += vectors) {
    for (int v = 0; v < vectors; v++) sum[v] += S[k] * h[v];
  }
}

/* Position of component (c, d) in an H. */
LANES_INLINE int HessianEntry(const int c, const int d)
{
  return c > d ? c * (c + 1) / 2 + d : d * (d + 1) / 2 + c;
}

/* Adds `share` times the run's part of H_i S_i to B. */
LANES_INLINE void AddSumCoupling(const int dim, const FitFactors *factors, const FitRun *run, double share,
                                 FitNodal *nodal)
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
      double *const B = nodal->B + d * nodal->stride + run->node[k] * dim;

      for (int c = 0; c < dim; c++) B[c] += sign[c] * h[HessianEntry(c, d)];
    }
  }
}

/* Adds S_c to S. */
LANES_INLINE void AddSlave(const int dim, const FitRun *slave, FitNodal *nodal)
{
  for (int k = 0; k < slave->entries; k++) {
    if (slave->node[k] < 0) continue;
    for (int c = 0; c < dim; c++)
      nodal->S[c * nodal->stride + slave->node[k] * dim + c] += slave->sign[3 * k + c] * slave->S[k];
  }
}

/* Adds an H between entries with these signs to a block of M. */
LANES_INLINE void AddSumBlock(const int dim, const double *h, const double *row_sign, const double *column_sign,
                              long size, double *block)
{
  for (int c = 0; c < dim; c++) {
    for (int d = 0; d < dim; d++) block[c * size + d] += row_sign[c] * column_sign[d] * h[HessianEntry(c, d)];
  }
}

/* Adds sum_r S_r^T H_r S_r over the rows of a run to each pair of its nodes, above the diagonal. own starts with row
   `first`. */
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

/* Adds the points' own H of the rows first to end - 1, run by run. */
LANES_INLINE void Own(const int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN],
                      const FitDerivatives *map, double *M)
{
  for (FitRun run = {.end = first}; run.end < end;) {
    run = NextRun(map, end, run.end);
    AddPairs(dim, first, own, &run, (long)map->n_nodes * dim, M);
  }
}

/* Appends the rows of K and J of one slave point over nodes, with those of its coupling, to the sum. */
LANES_INLINE void Second(const int dim, const int terms, double factor, const FitFactors *factors,
                         const FitDerivatives *map, FitDerivativesSum *sum)
{
  const int    vectors = FactorStride(terms) / LANES, rows = 1 + factors->n;
  const FitRun slave = NextRun(map, 1, 0);
  const long   first = (long)sum->depth * sum->stride, last = (long)(sum->room - sum->coupled - dim) * sum->stride;
  FitNodal     nodal = {.rows   = (Lanes *)sum->rows,
                        .K      = sum->K + first,
                        .J      = sum->J + first,
                        .B      = sum->K + last,
                        .S      = sum->J + last,
                        .stride = sum->stride,
                        .factor = factor};

  memset(nodal.rows, 0, (size_t)(nodal.stride + dim) * vectors * sizeof(Lanes));
  memset(nodal.B, 0, (size_t)dim * nodal.stride * sizeof(double));
  memset(nodal.S, 0, (size_t)dim * nodal.stride * sizeof(double));
  AddRows(dim, vectors, factors, &slave, &nodal);
  AddSumCoupling(dim, factors, &slave, 0.5, &nodal);
  AddSlave(dim, &slave, &nodal);
  for (FitRun run = slave; run.end < rows;) {
    run = NextRun(map, rows, run.end);
    AddRows(dim, vectors, factors, &run, &nodal);
    AddSumCoupling(dim, factors, &run, -1, &nodal);
  }
  TurnBack(terms, vectors, &nodal);
  sum->depth += terms;
  sum->coupled += dim;
}

/* Adds scale times row i of S, which belongs to component c of point r. */
LANES_INLINE void AddSelection(const int dim, const FitDerivatives *map, int r, int c, double scale, double *row)
{
  const int    *node = map->node + map->ptr[map->run[r]];
  const double *sign = map->sign + 3 * map->ptr[map->run[r]], *S = map->S + map->ptr[r];

  for (int k = 0; k < map->ptr[r + 1] - map->ptr[r]; k++) {
    if (node[k] >= 0) row[node[k] * dim + c] += scale * S[k] * sign[3 * k + c];
  }
}

/* S^T M S = 1/2 (M S)^T S + S^T 1/2 (M S). Each component of each point gives a row of M S and a row of S. */
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

/* Adds a run's part of S^T N to `count` of its nodes. */
LANES_INLINE void AddFirst(const int dim, const int count, const double *N, const FitRun *run, int k, double *nodal)
{
  const double *S = run->S + k, *from = N + run->first * dim;
  double        sum[3][FIRST_ENTRIES] = {{0}};

  for (int r = run->first; r < run->end; r++, S += run->entries, from += dim) {
    for (int c = 0; c < dim; c++) {
      for (int a = 0; a < count; a++) sum[c][a] += S[a] * from[c];
    }
  }
  for (int a = 0; a < count; a++) {
    if (run->node[k + a] < 0) continue;
    for (int c = 0; c < dim; c++) nodal[run->node[k + a] * dim + c] += run->sign[3 * (k + a) + c] * sum[c][a];
  }
}

/* Adds S^T N to nodal, run by run. */
LANES_INLINE void First(const int dim, int n, const double *N, const FitDerivatives *map, double *nodal)
{
  for (FitRun run = {.end = 0}; run.end < 1 + n;) {
    int k = 0;

    run = NextRun(map, 1 + n, run.end);
    for (; k + FIRST_ENTRIES <= run.entries; k += FIRST_ENTRIES) AddFirst(dim, FIRST_ENTRIES, N, &run, k, nodal);
    for (; k < run.entries; k++) AddFirst(dim, 1, N, &run, k, nodal);
  }
}

/*@
  FitDerivativesDepth - gives the number of rows of K and J for one slave point that is added by its factors.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
- degree - of the fit

  Note:
  Plain C.
@*/
int FitDerivativesDepth(int dim, int degree)
{
  return FitTerms(dim, degree) + dim;
}

/*@
  FitDerivativesWorkspace - gives the length of the workspace for a sum of second variations, in doubles.

  Not collective

  Input Parameters:
+ dim     - 2 or 3
. degree  - highest degree of the fits
. n_nodes - of the maps
- depth   - most rows of K and J in all: FitDerivativesDepth() for each FitDerivativesAdd(), dim*(1 + n) for each
            FitDerivativesAddDense(), 1 for each FitDerivativesAddOuter()

  Note:
  Plain C.
@*/
long FitDerivativesWorkspace(int dim, int degree, int n_nodes, int depth)
{
  const int stride = SymmetricProductStride(n_nodes * dim);

  return ALIGNMENT / (long)sizeof(double) + (long)(stride + dim) * FactorStride(FitTerms(dim, degree)) +
         2L * depth * stride;
}

/*@
  FitDerivativesFirst - computes the first variation over nodes, S^T N.

  Not collective

  Input Parameters:
+ dim - 2 or 3
. n   - number of points inside
. N   - N[(1 + n)*dim] over slave point and points, of DiffuseFitEvaluate()
- map - from these to nodes

  Output Parameter:
. nodal - S^T N, nodal[n_nodes*dim]

  Note:
  Plain C.
@*/
void FitDerivativesFirst(int dim, int n, const double *N, const FitDerivatives *map, double *nodal)
{
  memset(nodal, 0, (size_t)map->n_nodes * dim * sizeof(double));
  if (dim == 3)
    First(3, n, N, map, nodal);
  else
    First(2, n, N, map, nodal);
}

/*@
  FitDerivativesSlave - gives a row of M that belongs to the slave point: the derivative of one component of its own N.

  Not collective

  Input Parameters:
+ factors   - of M
- component - of the slave point

  Output Parameter:
. row - row[(1 + n)*dim], over slave point and points

  Note:
  Plain C.
@*/
void FitDerivativesSlave(const FitFactors *factors, int component, double *row)
{
  const int     dim = factors->dim, terms = FitTerms(dim, factors->degree), vectors = factors->stride / LANES;
  const double *K                       = &factors->rows[component * factors->stride];
  Lanes         turned[FACTORS / LANES] = {{0}}; /* J, then K */

  memcpy(turned, K + terms, terms * sizeof(double));
  memcpy((double *)turned + terms, K, terms * sizeof(double));
  for (int i = 0; i < (1 + factors->n) * dim; i++) {
    const int point = i / dim, high = component > i % dim ? component : i % dim,
              low        = component > i % dim ? i % dim : component;
    const Lanes *other   = (const Lanes *)factors->rows + (long)i * vectors;
    const double own     = factors->hessians[(long)point * factors->hessianstride + high * (high + 1) / 2 + low];
    Lanes        product = Broadcast(0);

    for (int v = 0; v < vectors; v++) product += turned[v] * other[v];
    row[i] = (point ? -own : own) + LanesSum(product);
  }
}

/*@
  FitDerivativesBegin - begins a sum of second variations over the same nodes.

  Not collective

  Input Parameters:
+ dim       - 2 or 3
. degree    - as in FitDerivativesWorkspace()
. n_nodes   - as in FitDerivativesWorkspace()
. depth     - as in FitDerivativesWorkspace()
- workspace - FitDerivativesWorkspace() doubles of any contents, which the sum uses until FitDerivativesEnd()

  Output Parameter:
. sum - the empty sum

  Note:
  Plain C.
@*/
void FitDerivativesBegin(FitDerivativesSum *sum, int dim, int degree, int n_nodes, int depth, double *workspace)
{
  const int stride = SymmetricProductStride(n_nodes * dim);

  *sum      = (FitDerivativesSum){.dim = dim, .n_nodes = n_nodes, .stride = stride, .room = depth};
  sum->rows = (double *)(((uintptr_t)workspace + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
  sum->K    = sum->rows + (stride + dim) * FactorStride(FitTerms(dim, degree));
  sum->J    = sum->K + (long)depth * stride;
}

/*@
  FitDerivativesAdd - adds factor times the second variation over nodes, S^T M S, of one slave point, without forming M.

  Not collective

  Input Parameters:
+ factor  - of this slave point
. factors - of M, as DiffuseFitEvaluate() leaves them in its workspace
- map     - its nodes are below the sum's n_nodes

  Input/Output Parameter:
. sum - the sum

  Note:
  The points' own H are left to FitDerivativesAddOwn(). Source: eqs 13 and 14 of Chamoret et al. (2004), for points that
  are combinations of nodes. Plain C.
@*/
void FitDerivativesAdd(FitDerivativesSum *sum, double factor, const FitFactors *factors, const FitDerivatives *map)
{
#define SECOND(dim, degree, terms)               \
  Second(dim, terms, factor, factors, map, sum); \
  return
  INSTANTIATE(factors, SECOND)
#undef SECOND
}

/*@
  FitDerivativesAddDense - adds factor S^T M S, where M itself is given.

  Not collective

  Input Parameters:
+ factor - of this slave point
. n      - number of points that take part
. M      - M[((1 + n)*dim)^2], symmetric
- map    - its nodes are below the sum's n_nodes

  Input/Output Parameter:
. sum - the sum

  Note:
  Plain C.
@*/
void FitDerivativesAddDense(FitDerivativesSum *sum, double factor, int n, const double *M, const FitDerivatives *map)
{
  if (sum->dim == 3)
    Dense(3, n, factor, M, map, sum);
  else
    Dense(2, n, factor, M, map, sum);
}

/*@
  FitDerivativesAddOuter - adds factor v v^T.

  Not collective

  Input Parameters:
+ factor - of the product
- v      - v[n_nodes*dim]

  Input/Output Parameter:
. sum - the sum

  Note:
  Plain C.
@*/
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

/*@
  FitDerivativesOwn - adds factor H of one point to the sum of that point's own H.

  Not collective

  Input Parameters:
+ factor  - of this slave point
. factors - of M
- i       - number of the point among those inside

  Input/Output Parameter:
. own - own += factor H_i

  Note:
  Plain C.
@*/
void FitDerivativesOwn(double factor, const FitFactors *factors, int i, double own[FIT_DERIVATIVES_OWN])
{
  const double *const h = factors->hessians + (1 + i) * factors->hessianstride;

  for (int e = 0; e < factors->dim * (factors->dim + 1) / 2; e++) own[e] += factor * h[e];
}

/*@
  FitDerivativesAddOwn - adds sum_r S_r^T own_r S_r, the points' own part of second variations, to M.

  Not collective

  Input Parameters:
+ dim   - 2 or 3
. first - first row of the map
. end   - last row of the map plus 1
. own   - own[end - first] of these rows' points, from FitDerivativesOwn()
- map   - its rows may belong to points of many slave points

  Input/Output Parameter:
. M - M[n_nodes*dim][n_nodes*dim]: its upper triangle, in whole blocks on the diagonal

  Note:
  Plain C.
@*/
void FitDerivativesAddOwn(int dim, int first, int end, const double (*own)[FIT_DERIVATIVES_OWN],
                          const FitDerivatives *map, double *M)
{
  if (dim == 3)
    Own(3, first, end, own, map, M);
  else
    Own(2, first, end, own, map, M);
}

/* T := row i of S^T B over the coupling rows. Returns 0 if it has no entries. */
static int CouplingRow(const FitDerivativesSum *sum, int i, double *T)
{
  int any = 0;

  for (int r = sum->room - sum->coupled; r < sum->room; r++) {
    const double        S = sum->J[(long)r * sum->stride + i];
    const double *const B = sum->K + (long)r * sum->stride;

    if (S == 0) continue;
    for (int j = 0; j < sum->stride; j++) T[j] = any ? T[j] + S * B[j] : S * B[j];
    any = 1;
  }
  return any;
}

/* Adds S^T B and its transpose to the upper triangle of M. Row i goes to row i and to column i. */
static void AddCoupling(const FitDerivativesSum *sum, double *M)
{
  const int     n = sum->n_nodes * sum->dim;
  double *const T = sum->rows;

  for (int i = 0; i < n; i++) {
    double *const row = M + (long)i * n;

    if (!CouplingRow(sum, i, T)) continue;
    for (int j = i; j < n; j++) row[j] += T[j];
    for (int j = 0; j <= i; j++) M[(long)j * n + i] += T[j];
  }
}

/*@
  FitDerivativesJoin - puts the coupling rows of a sum behind its other rows, so that K and J hold the sum.

  Not collective

  Input/Output Parameter:
. sum - the sum; nothing is added any more

  Note:
  Plain C.
@*/
void FitDerivativesJoin(FitDerivativesSum *sum)
{
  const long   from = (long)(sum->room - sum->coupled) * sum->stride, to = (long)sum->depth * sum->stride;
  const size_t size = (size_t)sum->coupled * sum->stride * sizeof(double);

  memmove(sum->K + to, sum->K + from, size);
  memmove(sum->J + to, sum->J + from, size);
  sum->depth += sum->coupled;
  sum->coupled = 0;
}

/*@
  FitDerivativesEnd - writes the sum into the upper triangle of M.

  Not collective

  Input Parameter:
. sum - the sum

  Output Parameter:
. M - M[n_nodes*dim][n_nodes*dim]; the entries below the diagonal are left as they are

  Note:
  Plain C.
@*/
void FitDerivativesEnd(FitDerivativesSum *sum, double *M)
{
  SymmetricProductUpper(sum->n_nodes * sum->dim, sum->depth, sum->stride, sum->K, sum->J, M);
  if (sum->coupled) AddCoupling(sum, M);
}
