/* The internals that the files of the diffuse fit share, and nobody else. diffusefit.c makes surface and foot,
   fitvariation.c the variations N and M over points, and fitderivatives.c those over nodes. symmetricproduct.c
   transposes its squares with Transpose().

   FitVariationFirst(), FitVariationSecond() and FitVariationFactors() are called by the evaluation once FitArrays
   and FitState describe fit and foot. The inline functions handle LANES points at a time. INSTANTIATE() calls a
   function with constant dimension and degree. */
#pragma once
#include "smooth/diffusefit.h"
#include "base/lanes.h"
#include <string.h>

enum {
  MAX_TANGENTS = 2,
  ROWS         = 1 + MAX_TANGENTS, /* rows of F */
  /* Columns that are orthogonalised together, so that their sums do not wait for each other; at most 8. */
  BLOCK = 4,
  /* Alignment of the arrays in bytes: a cache line, and the widest vector. */
  ALIGNMENT = 64,
  /* Most entries of a row of factors. */
  FACTORS = LANES * ((2 * FIT_MAX_TERMS + LANES - 1) / LANES),
  /* Most entries of a point's H, filled up to whole vectors. */
  FIT_HESSIAN = 8,
  /* Vectors per LANES points besides the basis: eta (2), multiplier, inside, power, weight, scratch, row, H (6). */
  ARRAYS = 14
};

/* Arrays over the points inside the support, in vectors of LANES points. The last vector is filled up with points of
   weight 0. */
typedef struct {
  int n, groups; /* points inside, and vectors that hold them */
  int capacity;  /* length of an array: vectors that hold all points of the problem */
  int stride;    /* vectors per row of K and J */
  /* inside: 1 - rho^2; power: v inside^(exponent - 2). */
  Lanes *eta[MAX_TANGENTS], *multiplier, *inside, *power, *weight, *scratch;
  Lanes *row;   /* t, in bent coordinates */
  Lanes *H;     /* [6][capacity]: xx xy yy xz yz zz */
  Lanes *basis; /* [terms + 1][capacity]: orthonormal basis, then the residual e */
  Lanes *K, *J; /* [terms][stride]: entry (1 + i)*dim + c of a row */
  int   *points;
} FitArrays;

/* The fit and its foot. Quantities of type Lanes are the same in all lanes. */
typedef struct {
  /* Only the entries above the diagonal, with those of the heights at the end. */
  double R[FIT_MAX_TERMS][FIT_MAX_TERMS + 1 + BLOCK];
  double square[FIT_MAX_TERMS], inverse[FIT_MAX_TERMS]; /* of the diagonal */
  Lanes  alpha[FIT_MAX_TERMS], lambda[FIT_MAX_TERMS];   /* of the monomials */
  Lanes  foot[ROWS][FIT_MAX_TERMS];                     /* F = p^, Dp^ at the foot, D with respect to y */
  double S[ROWS][ROWS];
  double G[3][3], nu3; /* d = G x */
  /* In bent coordinates d = G x - across h(along.x), with `along` in space and across in scaled coordinates. */
  double along[3], across[MAX_TANGENTS];
} FitState;

#if defined(__AVX512F__)
  #define SWAP_STAGES 3
static const LaneMask swap_low[SWAP_STAGES]  = {{0, 8, 2, 10, 4, 12, 6, 14},
                                                {0, 1, 8, 9, 4, 5, 12, 13},
                                                {0, 1, 2, 3, 8, 9, 10, 11}};
static const LaneMask swap_high[SWAP_STAGES] = {{1, 9, 3, 11, 5, 13, 7, 15},
                                                {2, 3, 10, 11, 6, 7, 14, 15},
                                                {4, 5, 6, 7, 12, 13, 14, 15}};
#elif defined(__AVX__)
  #define SWAP_STAGES 2
static const LaneMask swap_low[SWAP_STAGES]  = {{0, 4, 2, 6}, {0, 1, 4, 5}};
static const LaneMask swap_high[SWAP_STAGES] = {{1, 5, 3, 7}, {2, 3, 6, 7}};
#else
  #define SWAP_STAGES 1
static const LaneMask swap_low[SWAP_STAGES]  = {{0, 2}};
static const LaneMask swap_high[SWAP_STAGES] = {{1, 3}};
#endif

#ifdef __clang__ /* clang has no __builtin_shuffle() */
LANES_INLINE Lanes Shuffle(Lanes a, Lanes b, LaneMask from)
{
  Lanes mixed = a;

  for (int i = 0; i < LANES; i++) mixed[i] = from[i] < LANES ? a[from[i]] : b[from[i] - LANES];
  return mixed;
}
#else
  #define Shuffle __builtin_shuffle
#endif

/* Transposes a square of LANES vectors by swapping ever larger off-diagonal blocks. */
LANES_INLINE void Transpose(Lanes a[LANES])
{
  for (int stage = 0; stage < SWAP_STAGES; stage++) {
    const int half = 1 << stage;

    for (int i = 0; i < LANES; i++) {
      const int j = i + half;

      if (!(i & half)) {
        const Lanes low = Shuffle(a[i], a[j], swap_low[stage]);

        a[j] = Shuffle(a[i], a[j], swap_high[stage]);
        a[i] = low;
      }
    }
  }
}

LANES_INLINE Lanes Broadcast(double a)
{
  return (Lanes){0} + a;
}

/* Is this the code of a fit of revolution? It has the monomials s^(k-b) t^b with even b, where t is the distance along
   the hoop. */
LANES_INLINE int IsRevolved(const int degree)
{
  return degree > FIT_REVOLVED && degree < FIT_BENT;
}

/* Is this the code of a fit in bent coordinates? */
LANES_INLINE int IsBent(const int degree)
{
  return degree > FIT_BENT;
}

/* How far a row bends aside at t, with its slope and curvature in bend[1] and bend[2]. */
LANES_INLINE void BendAt(const FitBend *in, double t, double bend[3])
{
  bend[0] = FitBendAside(in->h, t);
  bend[1] = t * (2 * in->h[0] + t * (t * 4 * in->h[1]));
  bend[2] = 2 * in->h[0] + t * (t * 12 * in->h[1]);
}

/* The bend's `across` in scaled coordinates. */
LANES_INLINE void BendAcross(const FitBend *in, const double (*scale)[2], double across[2])
{
  for (int k = 0; k < 2; k++) across[k] = -scale[k][0] * in->along[1] + scale[k][1] * in->along[0];
}

/* Degree of the polynomial itself. */
LANES_INLINE int PlainDegree(const int degree)
{
  return IsRevolved(degree) ? degree - FIT_REVOLVED : IsBent(degree) ? degree - FIT_BENT : degree;
}

/* Position of s^(k-b) t^b among the monomials. Those without t come first in a fit of revolution. */
LANES_INLINE int Term(const int tangents, const int degree, const int k, const int b)
{
  const int plain = PlainDegree(degree);

  if (tangents == 2) return k * (k + 1) / 2 + b;
  return b == 0 ? k : b == 2 ? plain + k - 1 : 2 * plain + k - 4;
}

/* Has the polynomial the monomial s^(k-b) t^b? */
LANES_INLINE int HasTerm(const int tangents, const int degree, const int k, const int b)
{
  return k <= PlainDegree(degree) && (tangents == 2 || b == 0 || (IsRevolved(degree) && b % 2 == 0));
}

/* Calls body(k, b) with constants for all monomials s^(k-b) t^b up to degree 4. In a loop the compiler would compute
   positions of terms again and again. */
#define FOR_MONOMIALS(body)                    \
  body(0, 0);                                  \
  body(1, 0) body(1, 1);                       \
  body(2, 0) body(2, 1) body(2, 2);            \
  body(3, 0) body(3, 1) body(3, 2) body(3, 3); \
  body(4, 0) body(4, 1) body(4, 2) body(4, 3) body(4, 4)

LANES_INLINE void Monomials(const int m, const int degree, const Lanes *eta, Lanes *p)
{
#define MONOMIAL(k, b)                                                              \
  if (k > 0 && HasTerm(m, degree, k, b))                                            \
    p[Term(m, degree, k, b)] = b < k    ? eta[0] * p[Term(m, degree, k - 1, b)]     \
                               : m == 2 ? eta[1] * p[Term(m, degree, k - 1, b - 1)] \
                                        : eta[1] * eta[1] * p[Term(m, degree, k - 2, b - 2)];
  p[0] = Broadcast(1);
  FOR_MONOMIALS(MONOMIAL)
#undef MONOMIAL
}

LANES_INLINE void MonomialGradients(const int m, const int degree, const Lanes *p, Lanes (*dp)[FIT_MAX_TERMS])
{
#define GRADIENT(k, b)                                                                                      \
  if (HasTerm(m, degree, k, b)) {                                                                           \
    dp[0][Term(m, degree, k, b)] = b < k ? (k - b) * p[Term(m, degree, k - 1, b)] : Broadcast(0);           \
    if (m == 2) dp[1][Term(m, degree, k, b)] = b > 0 ? b * p[Term(m, degree, k - 1, b - 1)] : Broadcast(0); \
  }
  FOR_MONOMIALS(GRADIENT)
#undef GRADIENT
}

/* Derivatives (s, t) of the polynomial with coefficients c, where the monomials have the values p. */
LANES_INLINE void PolynomialGradient(const int m, const int degree, const Lanes *p, const Lanes *c, Lanes gradient[2])
{
#define GRADIENT(k, b)                                                                                     \
  if (HasTerm(m, degree, k, b)) {                                                                          \
    if (k - b > 0) gradient[0] += (k - b) * (c[Term(m, degree, k, b)] * p[Term(m, degree, k - 1, b)]);     \
    if (m == 2 && b > 0) gradient[1] += b * (c[Term(m, degree, k, b)] * p[Term(m, degree, k - 1, b - 1)]); \
  }
  gradient[0] = gradient[1] = Broadcast(0);
  FOR_MONOMIALS(GRADIENT)
#undef GRADIENT
}

/* Second derivatives (ss, st, tt) of the polynomial with coefficients c, where the monomials have the values p. */
LANES_INLINE void PolynomialHessian(const int m, const int degree, const Lanes *p, const Lanes *c, Lanes hessian[3])
{
#define HESSIAN(k, b)                                                                                                 \
  if (HasTerm(m, degree, k, b)) {                                                                                     \
    if (k - b > 1) hessian[0] += ((k - b) * (k - b - 1)) * (c[Term(m, degree, k, b)] * p[Term(m, degree, k - 2, b)]); \
    if (m == 2 && k - b > 0 && b > 0)                                                                                 \
      hessian[1] += ((k - b) * b) * (c[Term(m, degree, k, b)] * p[Term(m, degree, k - 2, b - 1)]);                    \
    if (m == 2 && b > 1) hessian[2] += (b * (b - 1)) * (c[Term(m, degree, k, b)] * p[Term(m, degree, k - 2, b - 2)]); \
  }
  hessian[0] = hessian[1] = hessian[2] = Broadcast(0);
  FOR_MONOMIALS(HESSIAN)
#undef HESSIAN
}

LANES_INLINE Lanes DotTerms(const int terms, const Lanes *a, const Lanes *b)
{
  Lanes even = a[0] * b[0], odd = a[1] * b[1]; /* the two sums do not wait for each other */

  for (int k = 2; k < terms; k += 2) even += a[k] * b[k];
  for (int k = 3; k < terms; k += 2) odd += a[k] * b[k];
  return even + odd;
}

/* p := R^-T p, column by column. Row by row each operation would wait for the one before. */
LANES_INLINE void ToOrthonormal(const int terms, const FitState *s, Lanes *p)
{
  for (int l = 0; l < terms; l++)
    for (int k = l + 1; k < terms; k++) p[k] -= s->R[l][k] * p[l];
  for (int k = 0; k < terms; k++) p[k] *= s->inverse[k];
}

/* Calls body(dim, degree, terms) with constants for the problem's dimension and degree. */
#define INSTANTIATE(in, body)                               \
  switch (10 * (in)->dim + (in)->degree) {                  \
  case 21: body(2, 1, 2);                                   \
  case 22: body(2, 2, 3);                                   \
  case 24: body(2, 4, 5);                                   \
  case 20 + FIT_REVOLVED + 1: body(2, FIT_REVOLVED + 1, 2); \
  case 20 + FIT_REVOLVED + 2: body(2, FIT_REVOLVED + 2, 4); \
  case 20 + FIT_REVOLVED + 4: body(2, FIT_REVOLVED + 4, 9); \
  case 31: body(3, 1, 3);                                   \
  case 32: body(3, 2, 6);                                   \
  case 34: body(3, 4, 15);                                  \
  case 30 + FIT_BENT + 1: body(3, FIT_BENT + 1, 3);         \
  case 30 + FIT_BENT + 2: body(3, FIT_BENT + 2, 6);         \
  case 30 + FIT_BENT + 4: body(3, FIT_BENT + 4, 15);        \
  }

/* Length of a row of FitFactors: terms of K, terms of J, filled up with zeros. */
LANES_INLINE int FactorStride(const int terms)
{
  return LanesGroups(2 * terms) * LANES;
}

/* Length of a point's H in FitFactors: xx xy yy | xz yz zz, filled up with zeros. */
LANES_INLINE int HessianStride(const int dim)
{
  return LanesGroups(dim * (dim + 1) / 2) * LANES;
}

void FitVariationFirst(const FitProblem *, const FitArrays *, const FitState *, double *N);
void FitVariationSecond(const FitProblem *, FitArrays *, const FitState *, double *M);
void FitVariationFactors(const FitProblem *, const FitArrays *, const FitState *, FitFactors *);
