/* First and second variation of the diffuse gap, in the orthonormal basis and the scaled coordinates of diffusefit.c.

   First variation. N_i = G^T J_i^T G_a and N_c = -sum N_i, with J_i = dalpha/dd_i.

   Second variation. G_aa = F^T S F with the rows F = [p; Dp] at the foot and a symmetric S of their number. With phi_i
   = w_i e_i (lambda.p_i), C_i = d2 phi_i/dd_i dalpha and H_i = d2 phi_i/dd_i dd_i,
       M_ij = K_i J_j + J_i^T K_j^T + delta_ij H_i,   K_i = C_i + 1/2 (F J_i)^T S F
   The rows of the slave point are those of one more point with J_c = -sum J_i, K_c = -sum K_i. */
#include "fitkernel.h"
#include "symmetricproduct.h"

/* The quantities of LANES points from which the variations are made. */
typedef struct {
  Lanes p[FIT_MAX_TERMS], dp[MAX_TANGENTS][FIT_MAX_TERMS]; /* monomials and their gradients */
  /* w1, w2: derivatives of the weight by rho^2, times 2 and 4. */
  Lanes eta[MAX_TANGENTS], w, w1, w2, e;
  /* q: gradient of the height; l = lambda.p and dl its gradient. */
  Lanes q[MAX_TANGENTS], l, dl[MAX_TANGENTS];
  Lanes c[MAX_TANGENTS], a[MAX_TANGENTS]; /* gradients of w e and w l */
  Lanes slope, turn;                      /* of the bend at the point, with its curvature */
} FitBundle;

/* Derivative of scaled coordinate k of the points by component c of their position. */
LANES_INLINE Lanes Turn(const int dim, const int degree, const FitState *s, const FitBundle *b, int k, int c)
{
  if (IsBent(degree) && k < dim - 1) return s->G[k][c] - s->across[k] * s->along[c] * b->slope;
  return Broadcast(s->G[k][c]);
}

/* Fills a bundle. With derivatives == FIT_DIFFUSE the weights count as constants. */
LANES_INLINE void Bundle(const int m, const int degree, const int terms, const FitProblem *in, const FitArrays *a,
                         const FitState *s, FitDerivativeKind derivatives, int g, FitBundle *b)
{
  const double exponent = in->exponent;

  for (int k = 0; k < m; k++) b->eta[k] = a->eta[k][g];
  if (IsRevolved(degree)) b->eta[1] = a->eta[1][g];
  Monomials(m, degree, b->eta, b->p);
  MonomialGradients(m, degree, b->p, b->dp);
  b->w  = a->weight[g];
  b->w1 = Broadcast(0);
  b->w2 = Broadcast(0);
  if (derivatives == FIT_FULL) {
    b->w1 = -2 * exponent * a->power[g] * a->inside[g];
    b->w2 = 4 * exponent * (exponent - 1) * a->power[g];
  }
  b->e = a->basis[terms * a->capacity + g];
  b->l = DotTerms(terms, s->lambda, b->p);
  for (int k = 0; k < m; k++) {
    b->q[k]  = DotTerms(terms, s->alpha, b->dp[k]);
    b->dl[k] = DotTerms(terms, s->lambda, b->dp[k]);
    b->c[k]  = b->w1 * b->eta[k] * b->e - b->w * b->q[k];
    b->a[k]  = b->w1 * b->eta[k] * b->l + b->w * b->dl[k];
  }
  for (int i = 0; i < LANES && IsBent(degree); i++) {
    double bend[3];

    BendAt(&in->bend, a->row[g][i], bend);
    b->slope[i] = bend[1];
    b->turn[i]  = bend[2];
  }
}

/* Writes the vectors of the first `count` of LANES points one after the other. */
LANES_INLINE void StoreVectors(const int dim, int count, const Lanes *v, double *out)
{
  for (int i = 0; i < count; i++) {
    for (int c = 0; c < dim; c++) out[i * dim + c] = v[c][i];
  }
}

/* N_i = G^T J_i^T G_a and N_c = -sum N_i. */
LANES_INLINE void FirstVariation(const int dim, const int degree, const int terms, const FitProblem *in,
                                 const FitArrays *a, const FitState *s, double *N)
{
  Lanes total[3] = {{0}};

  for (int g = 0; g < a->groups; g++) {
    const int count = a->n - g * LANES < LANES ? a->n - g * LANES : LANES;
    FitBundle b;
    Lanes     v[3];

    Bundle(dim - 1, degree, terms, in, a, s, FIT_FULL, g, &b);
    for (int c = 0; c < dim; c++) {
      v[c] = s->G[dim - 1][c] * b.w * b.l;
      for (int k = 0; k < dim - 1; k++)
        v[c] += Turn(dim, degree, s, &b, k, c) * (b.c[k] * b.l + b.w * b.e * b.dl[k]);
      total[c] += v[c];
    }
    StoreVectors(dim, count, v, N + dim * (1 + g * LANES));
  }
  for (int c = 0; c < dim; c++) N[c] = -LanesSum(total[c]);
}

/* H_i in the scaled frame, h[k][l]. */
LANES_INLINE void PointHessian(const int dim, const int degree, const FitState *s, const FitBundle *b, Lanes (*h)[3])
{
  const int m = dim - 1;
  Lanes     q[3], l[3];

  PolynomialHessian(m, degree, b->p, s->alpha, q);
  PolynomialHessian(m, degree, b->p, s->lambda, l);
  for (int k = 0; k < m; k++) {
    for (int j = 0; j <= k; j++) {
      const Lanes w2 = b->w2 * b->eta[k] * b->eta[j] + (j == k ? b->w1 : Broadcast(0));

      h[k][j] = h[j][k] = w2 * b->e * b->l + b->w1 * b->eta[k] * (b->e * b->dl[j] - b->q[j] * b->l) +
                          b->w1 * b->eta[j] * (b->e * b->dl[k] - b->q[k] * b->l) +
                          b->w * (b->e * l[k + j] - b->q[k] * b->dl[j] - b->q[j] * b->dl[k] - b->l * q[k + j]);
    }
    h[m][k] = h[k][m] = b->a[k];
  }
  h[m][m] = Broadcast(0);
}

/* The contributions of LANES points to K, J and H, in space. */
typedef struct {
  Lanes factor[3][FACTORS]; /* [component]: terms of K, terms of J, zeros */
  Lanes hessian[FIT_HESSIAN];
} FitBlock;

/* J^ = A p^ + B Dp^, and C likewise. The coefficients are in space already. */
LANES_INLINE void PointFactors(const int dim, const int degree, const int terms, const FitArrays *a, const FitState *s,
                               FitBundle *b, int g, FitBlock *out)
{
  const int   m  = dim - 1;
  const Lanes we = b->w * b->e, wl = b->w * b->l;
  Lanes       p[FIT_MAX_TERMS], fp[ROWS], fd[ROWS][MAX_TANGENTS], A[3], C[3], T[3][ROWS];

  for (int k = 0; k < terms; k++) p[k] = a->basis[k * a->capacity + g];
  for (int k = 0; k < m; k++) ToOrthonormal(terms, s, b->dp[k]);
  for (int r = 0; r < 1 + m; r++) {
    fp[r] = DotTerms(terms, s->foot[r], p);
    for (int k = 0; k < m; k++) fd[r][k] = DotTerms(terms, s->foot[r], b->dp[k]);
  }
  for (int c = 0; c < dim; c++) {
    Lanes U[ROWS];

    A[c] = s->G[m][c] * b->w;
    C[c] = Broadcast(0);
    for (int k = 0; k < m; k++) {
      A[c] += Turn(dim, degree, s, b, k, c) * b->c[k];
      C[c] -= Turn(dim, degree, s, b, k, c) * b->a[k];
    }
    for (int r = 0; r < 1 + m; r++) {
      U[r] = A[c] * fp[r];
      for (int k = 0; k < m; k++) U[r] += Turn(dim, degree, s, b, k, c) * we * fd[r][k];
    }
    for (int r = 0; r < 1 + m; r++) {
      T[c][r] = Broadcast(0);
      for (int t = 0; t < 1 + m; t++) T[c][r] += 0.5 * s->S[t][r] * U[t];
    }
  }
  for (int c = 0; c < dim; c++) {
    Lanes *const K = out->factor[c], *const J = K + terms;

    for (int k = 0; k < terms; k++) {
      J[k] = A[c] * p[k];
      K[k] = C[c] * p[k];
      for (int t = 0; t < m; t++) {
        J[k] += Turn(dim, degree, s, b, t, c) * we * b->dp[t][k];
        K[k] -= Turn(dim, degree, s, b, t, c) * wl * b->dp[t][k];
      }
      for (int r = 0; r < 1 + m; r++) K[k] += T[c][r] * s->foot[r][k];
    }
    for (int k = 2 * terms; k < FactorStride(terms); k++) out->factor[c][k] = Broadcast(0);
  }
}

/* H of LANES points in space. */
LANES_INLINE void TurnHessian(const int dim, const int degree, const FitState *s, const FitBundle *b, Lanes (*h)[3],
                              Lanes *out)
{
  Lanes bend = Broadcast(0);

  for (int k = 0; k < dim - 1 && IsBent(degree); k++)
    bend -= s->across[k] * b->turn * (b->c[k] * b->l + b->w * b->e * b->dl[k]);
  for (int c = 0, entry = 0; c < dim; c++) {
    for (int d = 0; d <= c; d++, entry++) {
      out[entry] = Broadcast(0);
      for (int k = 0; k < dim; k++) {
        for (int l = 0; l < dim; l++)
          out[entry] += Turn(dim, degree, s, b, k, c) * Turn(dim, degree, s, b, l, d) * h[k][l];
      }
      if (IsBent(degree)) out[entry] += bend * (s->along[c] * s->along[d]);
    }
  }
  for (int entry = dim * (dim + 1) / 2; entry < HessianStride(dim); entry++) out[entry] = Broadcast(0);
}

/* Computes the contributions of vector g of points to K, J and H. */
LANES_INLINE void Block(const int dim, const int degree, const int terms, const FitProblem *in, const FitArrays *a,
                        const FitState *s, int g, FitBlock *out)
{
  FitBundle b;
  Lanes     h[3][3];

  Bundle(dim - 1, degree, terms, in, a, s, in->derivatives, g, &b);
  PointHessian(dim, degree, s, &b, h);
  TurnHessian(dim, degree, s, &b, h, out->hessian);
  PointFactors(dim, degree, terms, a, s, &b, g, out);
}

/* Adds the points' own second variations H, in space, to the blocks of the point, of the slave point and of both
   couplings. */
LANES_INLINE void AddPointHessians(const int dim, const FitArrays *a, double *M)
{
  const int size = dim * (1 + a->n);

  for (int c = 0; c < dim; c++) {
    for (int d = 0; d < dim; d++) {
      const double *const h =
        (const double *)(a->H + (c > d ? c * (c + 1) / 2 + d : d * (d + 1) / 2 + c) * a->capacity);
      double total = 0;

      for (int i = 0; i < a->n; i++) {
        const long row = dim * (1 + i) + c, column = dim * (1 + i) + d;

        M[row * size + column] += h[i];
        M[row * size + d] -= h[i];
        M[(long)c * size + column] -= h[i];
        total += h[i];
      }
      M[c * size + d] += total;
    }
  }
}

/* Fills K, J and H of all points and of the slave point and multiplies them to M. */
LANES_INLINE void SecondVariation(const int dim, const int degree, const int terms, const FitProblem *in, FitArrays *a,
                                  const FitState *s, double *M)
{
  Lanes     total[3][2 * FIT_MAX_TERMS] = {{{0}}};
  const int used                        = dim * (1 + a->groups * LANES);

  for (int g = 0; g < a->groups; g++) {
    FitBlock block;

    Block(dim, degree, terms, in, a, s, g, &block);
    for (int entry = 0; entry < dim * (dim + 1) / 2; entry++) a->H[entry * a->capacity + g] = block.hessian[entry];
    for (int k = 0; k < 2 * terms; k++) {
      Lanes v[3];

      for (int c = 0; c < dim; c++) {
        v[c] = block.factor[c][k];
        total[c][k] += v[c];
      }
      StoreVectors(dim, LANES, v, (double *)(a->K + k * a->stride) + dim * (1 + g * LANES)); /* J follows K */
    }
  }
  for (int k = 0; k < 2 * terms; k++) {
    double *const row = (double *)(a->K + k * a->stride);

    for (int c = 0; c < dim; c++) row[c] = -LanesSum(total[c][k]);
    for (int i = used; i < a->stride * LANES; i++) row[i] = 0;
  }
  SymmetricProduct(dim * (1 + a->n), terms, a->stride * LANES, (double *)a->K, (double *)a->J, M);
  AddPointHessians(dim, a, M);
}

/* Writes `count` vectors of LANES points as one row for each point; the rows of two points are `distance` vectors
   apart. Adds the rows to `total`. */
LANES_INLINE void StoreRows(const int count, const int distance, const Lanes *v, Lanes *rows, Lanes *total)
{
  for (int k = 0; k < count; k += LANES) {
    Lanes square[LANES];

    for (int i = 0; i < LANES; i++) square[i] = v[k + i];
    Transpose(square);
    for (int i = 0; i < LANES; i++) {
      rows[i * distance + k / LANES] = square[i];
      total[k / LANES] += square[i];
    }
  }
}

/* Writes the rows of K, J and H of the slave point and of all points, without multiplying them. */
LANES_INLINE void Factors(const int dim, const int degree, const int terms, const FitProblem *in, const FitArrays *a,
                          const FitState *s, FitFactors *out)
{
  const int stride = FactorStride(terms) / LANES, hessianstride = HessianStride(dim) / LANES;
  Lanes     total[3][FACTORS / LANES] = {{{0}}}, hessian[FIT_HESSIAN] = {{0}};
  Lanes *rows = a->K, *const hessians = rows + (1 + a->groups * LANES) * dim * stride;

  for (int g = 0; g < a->groups; g++) {
    const int first = 1 + g * LANES;
    FitBlock  block;

    Block(dim, degree, terms, in, a, s, g, &block);
    for (int c = 0; c < dim; c++)
      StoreRows(stride * LANES, dim * stride, block.factor[c], rows + (first * dim + c) * stride, total[c]);
    StoreRows(hessianstride * LANES, hessianstride, block.hessian, hessians + first * hessianstride, hessian);
  }
  for (int c = 0; c < dim; c++) {
    for (int k = 0; k < stride; k++) rows[c * stride + k] = -total[c][k];
  }
  for (int k = 0; k < hessianstride; k++) hessians[k] = hessian[k];
  *out = (FitFactors){.dim           = dim,
                      .degree        = degree,
                      .n             = a->n,
                      .stride        = stride * LANES,
                      .hessianstride = hessianstride * LANES,
                      .rows          = (const double *)rows,
                      .hessians      = (const double *)hessians};
}

/*@
  FitVariationFirst - computes the first variation N, eqs 11 and 12 of Chamoret et al. (2004).

  Not collective

  Input Parameters:
+ in - the problem
. a  - arrays as the evaluation left them
- s  - state as the evaluation left it

  Output Parameter:
. N - N[(1 + points inside)*dim], the slave point first

  Note:
  Plain C.
@*/
void FitVariationFirst(const FitProblem *in, const FitArrays *a, const FitState *s, double *N)
{
#define FIRST(dim, degree, terms)                  \
  FirstVariation(dim, degree, terms, in, a, s, N); \
  return
  INSTANTIATE(in, FIRST)
#undef FIRST
}

/*@
  FitVariationSecond - computes the second variation M, eqs 13 and 14 of Chamoret et al. (2004).

  Not collective

  Input Parameters:
+ in - the problem
- s  - state as the evaluation left it

  Input/Output Parameter:
. a - arrays as the evaluation left them; K, J and H are overwritten

  Output Parameter:
. M - M[((1 + points inside)*dim)^2], symmetric

  Note:
  Plain C.
@*/
void FitVariationSecond(const FitProblem *in, FitArrays *a, const FitState *s, double *M)
{
#define SECOND(dim, degree, terms)                  \
  SecondVariation(dim, degree, terms, in, a, s, M); \
  return
  INSTANTIATE(in, SECOND)
#undef SECOND
}

/*@
  FitVariationFactors - computes the factors of M without M itself.

  Not collective

  Input Parameters:
+ in - the problem
. a  - arrays as the evaluation left them; the place of K and J in the workspace is overwritten
- s  - state as the evaluation left it

  Output Parameter:
. factors - see FitFactors

  Note:
  Plain C.
@*/
void FitVariationFactors(const FitProblem *in, const FitArrays *a, const FitState *s, FitFactors *factors)
{
#define FACTORISE(dim, degree, terms)             \
  Factors(dim, degree, terms, in, a, s, factors); \
  return
  INSTANTIATE(in, FACTORISE)
#undef FACTORISE
}
