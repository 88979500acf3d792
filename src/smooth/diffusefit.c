/* The diffuse fit: surface, foot and gap. It is one always-inline function, instantiated with constant dimension and
   degree, so that its loops unroll. It handles LANES points at a time.

   QR decomposition. The scaled monomials are orthogonalised by modified Gram-Schmidt in the product sum_i w_i a_i b_i,
   which is the QR of sqrt(W) P. Row i of P becomes p^ = R^-T p, for which A = 1. The heights are the last column and
   end as e_i = z_i - p_i.alpha. Their projections are alpha^ = R alpha. All formulas below are written in this basis,
   where they need no solve: dalpha/dd_i = dr_i/dd_i and lambda = G_a.

   Foot. It satisfies y* + q grad q = 0. With the envelope theorem, G_a = dg/dalpha = -nu_3 p and J = I + grad q grad
   q^T + q Hess q,
       dy* = -J^-1 (grad q p^T + q Dp),   dgrad q = Dp + Hess q dy*,   dnu_3 = -nu_3^3 grad q^T dgrad q,
       G_aa = -(p dnu_3^T + nu_3 sum_k Dp_k dy*_k)
   all at the foot. dy* and dgrad q are rows over the terms: combinations of F = [p; Dp].

   Coordinates. d = (eta, z) = G (x_i - x_c) with G = [B, 0; 0, 1] E^T and B = Q^(1/2). Derivatives are taken with
   respect to d and returned to space by G^T. */
#include "fitkernel.h"
#include "symmetricproduct.h"
#include <math.h>
#include <stdint.h>

/* 1 - rho^2 of points in the inner half of the support. Points on its border, as regular meshes have them, still count,
   so that round-off decides nothing. */
#define FIT_INNER (0.75 - 1e-6)

/* The surface at tangent coordinates y. Without a second tangent its components are 0. */
typedef struct {
  Lanes  p[FIT_MAX_TERMS]; /* monomials of the scaled coordinates */
  double q, g[2], h[2][2];
  double scale[2][2]; /* derivatives of the scaled coordinates by y */
} FitLocal;

/* c := R^-1 c with the strictly upper part of R, column by column as in ToOrthonormal(). */
LANES_INLINE void ToMonomials(const int terms, const FitState *s, Lanes *c)
{
  for (int l = terms - 1; l > 0; l--)
    for (int k = 0; k < l; k++) c[k] -= s->R[k][l] * c[l];
}

/* base^exponent, by products where the exponent is whole or half. */
LANES_INLINE Lanes Power(Lanes base, double exponent)
{
  Lanes power = Broadcast(1);

  if (2 * exponent == floor(2 * exponent) && exponent < 32) {
    if (exponent != floor(exponent))
      for (int i = 0; i < LANES; i++) power[i] = sqrt(base[i]);
    for (int i = 0; i < (int)exponent; i++) power *= base;
  } else {
    for (int i = 0; i < LANES; i++) power[i] = pow(base[i], exponent);
  }
  return power;
}

/* The symmetric square root of the metric. Returns 0 if the metric is not positive definite. */
LANES_INLINE int ScaleFromMetric(const int m, const double Q[2][2], double B[2][2])
{
  const double determinant = m == 1 ? Q[0][0] * Q[0][0] : Q[0][0] * Q[1][1] - Q[0][1] * Q[0][1];
  const double root = sqrt(determinant), size = sqrt(Q[0][0] + (m == 1 ? Q[0][0] : Q[1][1]) + 2 * root);

  if (!(determinant > 0 && Q[0][0] > 0)) return 0;
  B[0][0] = (Q[0][0] + root) / size;
  B[0][1] = B[1][0] = m == 1 ? 0 : Q[0][1] / size;
  B[1][1]           = m == 1 ? 0 : (Q[1][1] + root) / size;
  return 1;
}

/* Places the arrays in the workspace. */
LANES_INLINE void Layout(const int terms, int n, double *workspace, FitArrays *a)
{
  Lanes *at = (Lanes *)(((uintptr_t)workspace + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);

  a->capacity   = LanesGroups(n);
  a->eta[0]     = at;
  a->eta[1]     = at + a->capacity;
  a->multiplier = at + 2 * a->capacity;
  a->inside     = at + 3 * a->capacity;
  a->power      = at + 4 * a->capacity;
  a->weight     = at + 5 * a->capacity;
  a->scratch    = at + 6 * a->capacity;
  a->row        = at + 7 * a->capacity;
  a->H          = at + 8 * a->capacity;
  a->basis      = at + ARRAYS * a->capacity;
  a->points     = (int *)(a->basis + (terms + 1) * a->capacity);
  a->K          = a->basis + (terms + 2) * a->capacity;
}

/* Writes the points inside the support into the arrays, and their heights into the last column of the basis. */
LANES_INLINE void Collect(const int dim, const int degree, const int terms, const FitProblem *in, const FitState *s,
                          double scale, FitArrays *a)
{
  const double(*const G)[3] = s->G;
  double *const z           = (double *)(a->basis + terms * a->capacity);
  int           n           = 0;

  for (int i = 0; i < in->n; i++) {
    const double *x = in->x + i * dim;
    const double  t = IsRevolved(degree) ? scale * in->hoop[i]
                      : IsBent(degree)   ? s->along[0] * x[0] + s->along[1] * x[1] + s->along[2] * x[2]
                                         : 0;
    double        d[3], bend[3], rho2 = IsRevolved(degree) ? t * t : 0;

    for (int k = 0; k < dim; k++) d[k] = G[k][0] * x[0] + G[k][1] * x[1] + (dim == 3 ? G[k][2] * x[2] : 0);
    if (IsBent(degree)) BendAt(&in->bend, t, bend);
    for (int k = 0; k < dim - 1 && IsBent(degree); k++) d[k] -= s->across[k] * bend[0];
    for (int k = 0; k < dim - 1; k++) rho2 += d[k] * d[k];
    if (!(rho2 < 1)) continue;
    for (int k = 0; k < dim - 1; k++) ((double *)a->eta[k])[n] = d[k];
    if (IsRevolved(degree)) ((double *)a->eta[1])[n] = t;
    if (IsBent(degree)) ((double *)a->row)[n] = t;
    ((double *)a->multiplier)[n] = in->multiplier[i];
    ((double *)a->inside)[n]     = 1 - rho2;
    z[n]                         = d[dim - 1];
    a->points[n]                 = i;
    n++;
  }
  a->n      = n;
  a->groups = LanesGroups(n);
  a->stride = SymmetricProductStride(dim * (1 + a->groups * LANES)) / LANES;
  a->J      = a->K + terms * a->stride;
  for (; n < a->groups * LANES; n++) {
    for (int k = 0; k < dim - 1; k++) ((double *)a->eta[k])[n] = 0;
    if (IsRevolved(degree)) ((double *)a->eta[1])[n] = 0;
    if (IsBent(degree)) ((double *)a->row)[n] = 0;
    ((double *)a->multiplier)[n] = ((double *)a->inside)[n] = z[n] = 0;
  }
}

/* Sums the lanes of each of 1 or BLOCK vectors. Pairs of vectors become one vector, then its halves are added. */
LANES_INLINE void SumEach(const int vectors, Lanes *a, double *sum)
{
  for (int stage = 0, count = vectors; stage < SWAP_STAGES; stage++, count = (count + 1) / 2) {
    for (int i = 0; 2 * i < count; i++) {
      const Lanes even = a[2 * i], odd = a[count > 1 ? 2 * i + 1 : 2 * i];

      a[i] = Shuffle(even, odd, swap_low[stage]) + Shuffle(even, odd, swap_high[stage]);
    }
  }
  memcpy(sum, a, vectors * sizeof(double));
}

/* Computes weights and monomials of the points inside. square[terms] holds the squared norms of the weighted
   columns. */
LANES_INLINE void Assemble(const int m, const int degree, const int terms, double exponent, FitArrays *a,
                           double *square)
{
  Lanes squares[FIT_MAX_TERMS + BLOCK] = {{0}};

  for (int g = 0; g < a->groups; g++) {
    const Lanes eta[MAX_TANGENTS] = {a->eta[0][g], a->eta[1][g]};
    Lanes       p[FIT_MAX_TERMS];

    a->power[g]  = a->multiplier[g] * Power(a->inside[g], exponent - 2);
    a->weight[g] = a->power[g] * a->inside[g] * a->inside[g];
    Monomials(m, degree, eta, p);
    for (int k = 0; k < terms; k++) {
      a->basis[k * a->capacity + g] = p[k];
      squares[k] += a->weight[g] * p[k] * p[k];
    }
  }
  for (int k = 0; k < terms; k += BLOCK) SumEach(BLOCK, squares + k, square + k);
}

/* Computes the shares of column k in `width` columns from j on and sums their products with it; the weighted values
   of column k are in scratch. If `take` is set, the shares of the column before, which are known, are subtracted
   first. */
LANES_INLINE void ProjectOnPlane(const int take, const int width, const FitArrays *a, int k, int j, double inverse,
                                 FitState *s)
{
  Lanes *const       column     = a->basis + j * a->capacity;
  const Lanes *const before     = column - (take ? j - k + 1 : 0) * a->capacity;
  const double      *share      = s->R[take ? k - 1 : k] + j;
  Lanes              sum[BLOCK] = {{0}};

  for (int g = 0; g < a->groups; g++) {
    const Lanes along = before[g], weighted = a->scratch[g];

    for (int b = 0; b < width; b++) {
      Lanes at = column[b * a->capacity + g];

      if (take) column[b * a->capacity + g] = at -= share[b] * along;
      sum[b] += weighted * at;
    }
  }
  for (int b = 0; b < width; b++) sum[b] *= inverse;
  SumEach(BLOCK, sum, s->R[k] + j);
}

/* Computes the shares of column k in all columns after it. */
LANES_INLINE void ProjectAll(const int take, const int terms, const FitArrays *a, int k, double inverse, FitState *s)
{
  int j = k + 1;

  for (; j + BLOCK <= terms + 1; j += BLOCK) ProjectOnPlane(take, BLOCK, a, k, j, inverse, s);
  switch (terms + 1 - j) {
  case 3: ProjectOnPlane(take, 3, a, k, j, inverse, s); break;
  case 2: ProjectOnPlane(take, 2, a, k, j, inverse, s); break;
  case 1: ProjectOnPlane(take, 1, a, k, j, inverse, s); break;
  }
}

/* Gram-Schmidt without roots. Returns the smallest |R_kk| of unit columns and stops where this falls below
   FIT_SINGULAR. length2[terms] are the squared norms of the columns. A column is subtracted from those behind it
   while these are multiplied with the next one, so that they are read once for both. */
LANES_INLINE double Orthogonalise(const int terms, const double *length2, FitArrays *a, FitState *s)
{
  double pivot2 = 1;

  for (int k = 0; k < terms; k++) {
    Lanes *const       column = a->basis + k * a->capacity;
    const Lanes *const before = column - (k ? a->capacity : 0);
    const double       share  = k ? s->R[k - 1][k] : 0;
    Lanes              sum    = Broadcast(0);
    double             square, ratio;

    for (int g = 0; g < a->groups; g++) {
      if (k) column[g] -= share * before[g];
      a->scratch[g] = a->weight[g] * column[g];
      sum += a->scratch[g] * column[g];
    }
    SumEach(1, &sum, &square);
    s->square[k] = square;
    ratio        = square > 0 ? square / length2[k] : 0;
    if (ratio < pivot2) pivot2 = ratio;
    if (!(pivot2 > FIT_SINGULAR * FIT_SINGULAR)) break;
    if (k)
      ProjectAll(1, terms, a, k, 1 / square, s);
    else
      ProjectAll(0, terms, a, k, 1 / square, s);
  }
  return sqrt(pivot2);
}

/* Subtracts the last column from the heights and scales the columns to unit length. */
LANES_INLINE void Normalise(const int terms, FitArrays *a, FitState *s)
{
  Lanes *const residual = a->basis + terms * a->capacity;

  for (int k = 0; k < terms; k++) s->inverse[k] = 1 / sqrt(s->square[k]);
  for (int g = 0; g < a->groups; g++) {
    residual[g] -= s->R[terms - 1][terms] * a->basis[(terms - 1) * a->capacity + g];
    for (int k = 0; k < terms; k++) a->basis[k * a->capacity + g] *= s->inverse[k];
  }
}

/* Largest distance to the surface of the points in the inner half of the support, from the residuals. */
LANES_INLINE double Missed(const int terms, const FitArrays *a)
{
  const Lanes *const residual = a->basis + terms * a->capacity;
  Lanes              most     = Broadcast(0);
  double             missed   = 0;

  for (int g = 0; g < a->groups; g++) {
    const Lanes at = (Lanes)((LaneMask)LanesAbsolute(residual[g]) & (a->inside[g] >= FIT_INNER));

    most = LanesLarger(most, at);
  }
  for (int i = 0; i < LANES; i++) missed = most[i] > missed ? most[i] : missed;
  return missed;
}

/* Makes the polynomial through the points inside. Returns 0 if there is none. */
LANES_INLINE int MakeSurface(const int dim, const int degree, const int terms, const FitProblem *in, FitArrays *a,
                             FitState *s, FitResult *out)
{
  FitSurface *const surface = &out->surface;
  double            length2[FIT_MAX_TERMS + BLOCK];

  surface->dim    = dim;
  surface->degree = degree;
  out->guards     = FIT_NO_SURFACE;
  out->n          = 0;
  out->pivot      = 0;
  if (!ScaleFromMetric(dim - 1, in->metric, surface->scale)) return 0;
  for (int k = 0; k < dim - 1; k++) {
    for (int c = 0; c < dim; c++) {
      s->G[k][c] = surface->scale[k][0] * in->frame[0][c] + (dim == 3 ? surface->scale[k][1] * in->frame[1][c] : 0);
    }
  }
  memcpy(s->G[dim - 1], in->frame[dim - 1], sizeof(s->G[0]));
  if (IsBent(degree)) {
    surface->bend = in->bend;
    BendAcross(&in->bend, (const double(*)[2])surface->scale, s->across);
    for (int c = 0; c < 3; c++) s->along[c] = in->bend.along[0] * in->frame[0][c] + in->bend.along[1] * in->frame[1][c];
  }
  Collect(dim, degree, terms, in, s, surface->scale[0][0], a);
  out->n = a->n;
  if (out->points) memcpy(out->points, a->points, a->n * sizeof(int));
  if (a->n < terms) return 0;
  Assemble(dim - 1, degree, terms, in->exponent, a, length2);
  out->pivot = Orthogonalise(terms, length2, a, s);
  if (!(out->pivot > FIT_SINGULAR)) return 0;
  for (int k = 0; k < terms; k++) s->alpha[k] = Broadcast(s->R[k][terms]);
  ToMonomials(terms, s, s->alpha);
  for (int k = 0; k < terms; k++) surface->coefficient[k] = s->alpha[k][0];
  out->guards =
    (a->n < FitPointsWanted(dim, degree) ? FIT_FEW_POINTS : 0) | (out->pivot < FIT_PIVOT ? FIT_LOW_PIVOT : 0);
  return 1;
}

/* Makes scaled coordinates from tangent coordinates y that bend. scale holds their derivatives by y. The second
   derivative of coordinate k is second[k] d d^T with d = `along`. */
LANES_INLINE void BendCoordinates(const FitSurface *surface, const double *y, double eta[2], double (*scale)[2],
                                  double second[2])
{
  const double *const along = surface->bend.along;
  double              bend[3], across[2];

  BendAt(&surface->bend, along[0] * y[0] + along[1] * y[1], bend);
  BendAcross(&surface->bend, surface->scale, across);
  for (int k = 0; k < 2; k++) {
    eta[k] -= across[k] * bend[0];
    second[k] = -across[k] * bend[2];
    for (int c = 0; c < 2; c++) scale[k][c] -= across[k] * bend[1] * along[c];
  }
}

/* Makes scaled coordinates from tangent coordinates y, with their derivatives. */
LANES_INLINE void ScaledCoordinates(const int m, const int degree, const FitSurface *surface, const double *y,
                                    double eta[2], double (*scale)[2], double second[2])
{
  const double(*const B)[2] = surface->scale;

  memcpy(scale, B, 4 * sizeof(double));
  for (int k = 0; k < m; k++) eta[k] = B[k][0] * y[0] + (m == 2 ? B[k][1] * y[1] : 0);
  if (IsRevolved(degree)) eta[1] = B[0][0] * y[1];
  if (IsBent(degree)) BendCoordinates(surface, y, eta, scale, second);
}

/* Computes monomials, height, gradient and Hessian of the surface at tangent coordinates y. */
LANES_INLINE void SurfaceAt(const int m, const int degree, const int terms, const FitSurface *surface,
                            const Lanes *alpha, const double *y, FitLocal *at)
{
  double(*const B)[2] = at->scale;
  Lanes  eta[MAX_TANGENTS], gradient[2], hessian[3];
  double h[2][2], scaled[2], second[2];

  ScaledCoordinates(m, degree, surface, y, scaled, at->scale, second);
  for (int k = 0; k < (IsRevolved(degree) ? 2 : m); k++) eta[k] = Broadcast(scaled[k]);
  Monomials(m, degree, eta, at->p);
  PolynomialGradient(m, degree, at->p, alpha, gradient);
  PolynomialHessian(m, degree, at->p, alpha, hessian);
  at->q   = DotTerms(terms, at->p, alpha)[0];
  h[0][0] = hessian[0][0];
  h[0][1] = h[1][0] = hessian[1][0];
  h[1][1]           = hessian[2][0];
  for (int c = 0; c < 2; c++) {
    at->g[c] = B[0][c] * gradient[0][0] + B[1][c] * gradient[1][0];
    for (int d = 0; d < 2; d++) {
      at->h[c][d] =
        B[0][c] * (h[0][0] * B[0][d] + h[0][1] * B[1][d]) + B[1][c] * (h[1][0] * B[0][d] + h[1][1] * B[1][d]);
      if (IsBent(degree))
        at->h[c][d] +=
          (second[0] * gradient[0][0] + second[1] * gradient[1][0]) * surface->bend.along[c] * surface->bend.along[d];
    }
  }
}

/* Length of a vector in supports, or of another vector whose size is far from the limits of the number range.
   hypot() guards against these limits, at many times the cost. */
LANES_INLINE double VectorLength(double a, double b)
{
  return sqrt(a * a + b * b);
}

static double SmallestEigenvalue(double (*a)[2])
{
  return 0.5 * (a[0][0] + a[1][1]) - VectorLength(0.5 * (a[0][0] - a[1][1]), a[0][1]);
}

static void InvertMetric(double (*a)[2], double (*inverse)[2])
{
  const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];

  inverse[0][0] = a[1][1] / determinant;
  inverse[1][1] = a[0][0] / determinant;
  inverse[0][1] = inverse[1][0] = -a[0][1] / determinant;
}

/* Newton's method from the slave point for y + q grad q = 0. Returns 0 if it does not converge, or converges where
   the distance has no minimum. */
LANES_INLINE int FindFoot(const int m, const int degree, const int terms, const FitState *s, FitLocal *at,
                          FitResult *out)
{
  const double(*const B)[2] = out->surface.scale;
  double *const y           = out->foot;
  double        inverse[2][2], step[2], size = INFINITY;

  y[0] = y[1] = 0;
  for (int iteration = 0;; iteration++) {
    SurfaceAt(m, degree, terms, &out->surface, s->alpha, y, at);
    for (int c = 0; c < 2; c++) {
      for (int d = 0; d < 2; d++) out->J[c][d] = (c == d) + at->g[c] * at->g[d] + at->q * at->h[c][d];
    }
    if (size <= FIT_FOOT) break;
    if (iteration == FIT_ITERATIONS) return 0;
    InvertMetric(out->J, inverse);
    for (int c = 0; c < 2; c++)
      step[c] = -inverse[c][0] * (y[0] + at->q * at->g[0]) - inverse[c][1] * (y[1] + at->q * at->g[1]);
    for (int c = 0; c < m; c++) y[c] += step[c];
    size = m == 1 ? fabs(B[0][0] * step[0])
                  : VectorLength(B[0][0] * step[0] + B[0][1] * step[1], B[1][0] * step[0] + B[1][1] * step[1]);
  }
  out->reach =
    m == 1 ? fabs(B[0][0] * y[0]) : VectorLength(B[0][0] * y[0] + B[0][1] * y[1], B[1][0] * y[0] + B[1][1] * y[1]);
  return SmallestEigenvalue(out->J) > FIT_FOCAL;
}

/* Computes gap, normal, tangents and curvature from the surface at the foot. */
static void Describe(int dim, const FitProblem *in, const FitLocal *at, FitResult *out)
{
  const double l           = sqrt(1 + at->g[0] * at->g[0] + at->g[1] * at->g[1]);
  const double determinant = (at->h[0][0] * at->h[1][1] - at->h[0][1] * at->h[0][1]) / (l * l * l * l);
  const double mean        = ((1 + at->g[1] * at->g[1]) * at->h[0][0] - 2 * at->g[0] * at->g[1] * at->h[0][1] +
                       (1 + at->g[0] * at->g[0]) * at->h[1][1]) /
                      (2 * l * l * l);

  memset(out->normal, 0, sizeof(out->normal));
  memset(out->tangent, 0, sizeof(out->tangent));
  for (int c = 0; c < dim; c++) {
    out->normal[c] = in->frame[dim - 1][c] / l;
    for (int k = 0; k < dim - 1; k++) {
      out->normal[c] -= at->g[k] * in->frame[k][c] / l;
      out->tangent[k][c] = in->frame[k][c] + at->g[k] * in->frame[dim - 1][c];
    }
  }
  out->gap       = -at->q * l;
  out->curvature = fabs(mean) + sqrt(fmax(mean * mean - determinant, 0));
}

/* Computes F and S of G_aa = F^T S F, and lambda, from the surface at the foot. dy[c][r] is the share of row r of F
   in dy*_c. */
LANES_INLINE void FootVariation(const int m, const int degree, const int terms, const FitLocal *at,
                                const FitResult *out, FitState *s)
{
  double dy[2][ROWS] = {{0}}, inverse[2][2], J[2][2];
  Lanes  dp[MAX_TANGENTS][FIT_MAX_TERMS];

  memcpy(J, out->J, sizeof(J));
  InvertMetric(J, inverse);
  s->nu3 = 1 / sqrt(1 + at->g[0] * at->g[0] + at->g[1] * at->g[1]);
  for (int c = 0; c < m; c++) {
    dy[c][0] = -inverse[c][0] * at->g[0] - inverse[c][1] * at->g[1];
    for (int d = 0; d < m; d++) dy[c][1 + d] = -at->q * inverse[c][d];
  }
  for (int r = 0; r < 1 + m; r++) {
    double slope = 0; /* grad q . dgrad q */

    for (int c = 0; c < m; c++) slope += at->g[c] * ((r == 1 + c) + at->h[c][0] * dy[0][r] + at->h[c][1] * dy[1][r]);
    s->S[0][r] = s->nu3 * s->nu3 * s->nu3 * slope;
    for (int c = 0; c < m; c++) s->S[1 + c][r] = -s->nu3 * dy[c][r];
  }
  MonomialGradients(m, degree, at->p, dp);
  for (int k = 0; k < terms; k++) {
    s->foot[0][k] = at->p[k];
    for (int c = 0; c < m; c++) {
      s->foot[1 + c][k] = at->scale[0][c] * dp[0][k];
      if (m == 2) s->foot[1 + c][k] += at->scale[1][c] * dp[1][k];
    }
  }
  for (int r = 0; r < 1 + m; r++) ToOrthonormal(terms, s, s->foot[r]);
  for (int k = 0; k < terms; k++) s->lambda[k] = -s->nu3 * s->inverse[k] * s->foot[0][k];
  ToMonomials(terms, s, s->lambda);
}

/* Writes the shape values dq(y*)/dz_i = w_i p^_i.p^(y*) into scratch. Returns the sum of their absolute values. */
LANES_INLINE double Shapes(const int terms, FitArrays *a, const Lanes *foot)
{
  Lanes sum = Broadcast(0);

  for (int g = 0; g < a->groups; g++) {
    Lanes shape = Broadcast(0);

    for (int k = 0; k < terms; k++) shape += foot[k] * a->basis[k * a->capacity + g];
    a->scratch[g] = a->weight[g] * shape;
    sum += LanesAbsolute(a->scratch[g]);
  }
  return LanesSum(sum);
}

/* Evaluates one problem as far as it is wanted: surface, foot and gap, shape values, variations. */
LANES_INLINE int Evaluate(const int dim, const int degree, const int terms, const FitProblem *in, FitWant want,
                          double *workspace, FitResult *out)
{
  FitArrays a;
  FitState  s;
  FitLocal  at;

  Layout(terms, in->n, workspace, &a);
  if (!MakeSurface(dim, degree, terms, in, &a, &s, out)) return 0;
  if (want < FIT_GAP_ONLY) return 1;
  if (!FindFoot(dim - 1, degree, terms, &s, &at, out)) {
    out->guards |= FIT_NO_FOOT;
    return 0;
  }
  Describe(dim, in, &at, out);
  out->guards |= out->reach < FIT_REACH ? 0 : FIT_FAR_FOOT;
  if (want < FIT_GAP) return 1;
  Normalise(terms, &a, &s);
  FootVariation(dim - 1, degree, terms, &at, out, &s);
  out->missed    = Missed(terms, &a);
  out->amplified = Shapes(terms, &a, s.foot[0]);
  if (out->shape) memcpy(out->shape, a.scratch, a.n * sizeof(double));
  out->guards |= out->amplified <= FIT_AMPLIFIED ? 0 : FIT_HIGH_SUM;
  if (want >= FIT_FIRST_VARIATION && out->N) FitVariationFirst(in, &a, &s, out->N);
  if (want >= FIT_SECOND_VARIATION && out->M)
    FitVariationSecond(in, &a, &s, out->M);
  else if (want >= FIT_SECOND_VARIATION && out->factors)
    FitVariationFactors(in, &a, &s, out->factors);
  return 1;
}

/*@
  FitTerms - gives the number of monomials of the fit's polynomial.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
- degree - of the polynomial over the dim - 1 tangents; FIT_REVOLVED added: of a fit of revolution; FIT_BENT added: of
           one in bent coordinates

  Note:
  Plain C.
@*/
int FitTerms(int dim, int degree)
{
  if (IsRevolved(degree)) return PlainDegree(degree) == 4 ? 9 : 2 * PlainDegree(degree);
  return dim == 2 ? degree + 1 : (PlainDegree(degree) + 1) * (PlainDegree(degree) + 2) / 2;
}

/*@
  FitPointsWanted - gives the least number of nodes inside the support, where nodes are the fit points.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
- degree - of the polynomial

  Note:
  The number is two per term in 3D, and one and a half per term in 2D. Plain C.
@*/
int FitPointsWanted(int dim, int degree)
{
  const int terms = FitTerms(dim, degree);

  return dim == 3 ? 2 * terms : (3 * terms) / 2;
}

/*@
  FitWorkspace - gives the length of the workspace for one evaluation, in doubles.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. degree - of the polynomial
- n      - number of points of the problem

  Note:
  Plain C.
@*/
long FitWorkspace(int dim, int degree, int n)
{
  const long terms = FitTerms(dim, degree), points = (long)LanesGroups(n) * LANES;
  const long product = 2 * terms * SymmetricProductStride(dim * (int)(LANES + points)),
             factors = (1 + points) * (dim * FactorStride((int)terms) + HessianStride(dim));

  return ALIGNMENT / (long)sizeof(double) + (ARRAYS + terms + 2) * points + (product > factors ? product : factors);
}

/*@
  DiffuseFitEvaluate - computes gap, first and second variation of one slave point against the diffuse surface through
  its fit points, eqs 1 to 14 of Chamoret et al. (2004).

  Not collective

  Input Parameters:
+ in        - the problem
. want      - how far the evaluation goes: the surface, the gap, Lambda with the shape values, N, or M; each includes
              those before it
- workspace - FitWorkspace() doubles of any contents

  Output Parameter:
. out - the result, with arrays as FitResult describes them

  Note:
  Returns 1 if everything wanted was computed; other guards may still be set. Returns 0 if there is no surface
  (FIT_NO_SURFACE) or no foot (FIT_NO_FOOT). The result is never NaN for finite input. The closed forms of N and M are
  derived by the envelope theorem from g(alpha(x)). Plain C.
@*/
int DiffuseFitEvaluate(const FitProblem *in, FitWant want, double *workspace, FitResult *out)
{
#define EVALUATE(dim, degree, terms) return Evaluate(dim, degree, terms, in, want, workspace, out)
  INSTANTIATE(in, EVALUATE)
#undef EVALUATE
  out->guards = FIT_NO_SURFACE;
  return 0;
}

/*@
  DiffuseFitEvaluateBatch - calls DiffuseFitEvaluate() for several slave points with one workspace.

  Not collective

  Input Parameters:
+ n         - number of slave points
. in        - the problems, in[n]
. want      - how far the evaluation goes
- workspace - FitWorkspace() doubles for the largest of the problems

  Output Parameter:
. out - the results, out[n]; their guards tell what is missing

  Note:
  Returns the number of slave points for which everything wanted was computed. Plain C.
@*/
int DiffuseFitEvaluateBatch(int n, const FitProblem *in, FitWant want, double *workspace, FitResult *out)
{
  int whole = 0;

  for (int i = 0; i < n; i++) whole += DiffuseFitEvaluate(&in[i], want, workspace, &out[i]);
  return whole;
}

/* Height of the surface at y without its derivatives. */
LANES_INLINE double HeightOnly(const int m, const int degree, const int terms, const FitSurface *surface,
                               const Lanes *alpha, const double *y)
{
  Lanes  eta[MAX_TANGENTS], p[FIT_MAX_TERMS];
  double scaled[2], scale[2][2], second[2];

  ScaledCoordinates(m, degree, surface, y, scaled, scale, second);
  for (int k = 0; k < (IsRevolved(degree) ? 2 : m); k++) eta[k] = Broadcast(scaled[k]);
  Monomials(m, degree, eta, p);
  return DotTerms(terms, p, alpha)[0];
}

LANES_INLINE double HeightAt(const int m, const int degree, const int terms, const FitSurface *surface, const double *y,
                             double *gradient)
{
  Lanes    alpha[FIT_MAX_TERMS];
  FitLocal at;

  for (int k = 0; k < terms; k++) alpha[k] = Broadcast(surface->coefficient[k]);
  if (!gradient) return HeightOnly(m, degree, terms, surface, alpha, y);
  SurfaceAt(m, degree, terms, surface, alpha, y, &at);
  memcpy(gradient, at.g, m * sizeof(double));
  return at.q;
}

/*@
  FitDistance2 - computes rho^2 of a point.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. degree - of the fit
. metric - as in FitProblem
. bend   - as in FitProblem; read by a fit in bent coordinates only
- y      - tangent coordinates relative to the slave point, y[2] (length); in 2D y[1] is the distance along the hoop

  Note:
  Plain C.
@*/
double FitDistance2(int dim, int degree, const double (*metric)[2], const FitBend *bend, const double *y)
{
  double at[3] = {0}, x[2] = {y[0], y[1]};

  if (dim == 2) return metric[0][0] * (y[0] * y[0] + y[1] * y[1]);
  if (IsBent(degree)) {
    BendAt(bend, bend->along[0] * y[0] + bend->along[1] * y[1], at);
    x[0] += bend->along[1] * at[0];
    x[1] -= bend->along[0] * at[0];
  }
  return metric[0][0] * x[0] * x[0] + (2 * metric[0][1] * x[0] + metric[1][1] * x[1]) * x[1];
}

/*@
  FitSurfaceHeight - computes the height of the fitted surface over the slave point's tangent plane (length).

  Not collective

  Input Parameters:
+ surface - of an evaluation
- y       - tangent coordinates relative to the slave point, y[dim - 1] (length); in a fit of revolution y[2] with the
            distance along the hoop

  Output Parameter:
. gradient - gradient[dim - 1] with respect to y; may be NULL

  Note:
  Plain C.
@*/
double FitSurfaceHeight(const FitSurface *surface, const double *y, double *gradient)
{
#define HEIGHT(dim, degree, terms) return HeightAt(dim - 1, degree, terms, surface, y, gradient)
  INSTANTIATE(surface, HEIGHT)
#undef HEIGHT
  return 0;
}

/* FitShape() for one dimension and degree. */
LANES_INLINE int FitShapeValues(const int dim, const int degree, const int terms, const FitProblem *in, int n,
                                const double *y, const double *factor, double *workspace, double *shape)
{
  FitArrays a;
  FitState  s;
  FitLocal  at;
  FitResult out                = {.points = NULL};
  Lanes     row[FIT_MAX_TERMS] = {{0}};

  Layout(terms, in->n, workspace, &a);
  memset(shape, 0, in->n * sizeof(double));
  if (!MakeSurface(dim, degree, terms, in, &a, &s, &out)) return 0;
  Normalise(terms, &a, &s);
  for (int i = 0; i < n; i++) {
    SurfaceAt(dim - 1, degree, terms, &out.surface, s.alpha, y + i * (dim - 1), &at);
    for (int k = 0; k < terms; k++) row[k] += factor[i] * at.p[k];
  }
  ToOrthonormal(terms, &s, row);
  Shapes(terms, &a, row);
  for (int i = 0; i < a.n; i++) shape[a.points[i]] = ((const double *)a.scratch)[i];
  return 1;
}

/*@
  FitShape - computes how a combination of heights, sum_a factor_a q(y_a), depends on the points' heights z_i.

  Not collective

  Input Parameters:
+ in        - the problem
. n         - number of heights in the combination
. y         - their tangent coordinates, y[n][dim - 1]
. factor    - their factors, factor[n]
- workspace - FitWorkspace() doubles

  Output Parameter:
. shape - sum_a factor_a dq(y_a)/dz_i with the weights held, for each point of the problem; 0 outside the support

  Note:
  These are the coefficients of an offset that follows the points. Returns 0, with all shape values 0, if there is no
  surface. Plain C.
@*/
int FitShape(const FitProblem *in, int n, const double *y, const double *factor, double *workspace, double *shape)
{
#define SHAPE(dim, degree, terms) return FitShapeValues(dim, degree, terms, in, n, y, factor, workspace, shape)
  INSTANTIATE(in, SHAPE)
#undef SHAPE
  return 0;
}
