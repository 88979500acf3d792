/* Mixed elements, the formulation `mixed`. The pressure has its own shape functions in every element, so that solids
   that keep their volume nearly or exactly do not lock, and their pressures do not oscillate.

   The energy of an element is int W_s dV + lambda/2 int (ln j)^2 dV with j = 1 + Pi (J - 1). W_s is the energy of the
   law with a small part of the modulus of the volume, lambda is the rest of that modulus (VolumeModuli), and Pi the
   projection on the pressure's shape functions (least squares over the reference volume). The pressure is p =
   Pi (lambda ln j / j). This is the mixed method with displacements, pressures and volumes as unknowns; the last two
   are condensed in the element. In small strains the trace of the strain takes the place of J - 1, and j - 1 that of
   ln j.

   The projection is of J and not of ln J. J has no second variation that integrates to more than boundary terms, so
   that a pressure neither stiffens nor softens changes of the volume inside an element that the projection does not
   see. With ln J a mean tension above the shear modulus makes them unstable, although the solid is stable; bonded
   bushes stop there.

   Pressures are constant in quad4 and hex8. They are linear in quad9, hex27, tri6 and tet10, in reference coordinates,
   not in those of the parent element: on general quadrilaterals only the former converge at the full order (Arnold,
   Boffi and Falk, Mathematics of Computation 71, 2002). tri6 and tet10 have an inner node besides, whose shape function
   is a bubble that vanishes on all faces (Crouzeix and Raviart, RAIRO 7, 1973). Its displacement is solved for and
   condensed in the element, as enhancedkernel.c does with its modes. Every call starts from no bubble, so that energy,
   force and tangent are functions of u alone.

   Where lambda is large or infinite, a part Pi (kappa ln j / j) of the pressure and a multiplier make up the pressure.
   The caller changes the multiplier until the pressure is right (augmented Lagrangian).

   The geometric part of the tangent may have pressures that are extrapolated from an earlier state
   (stressreference.h): theta there and its linear change on the way, with the bubble's.

   Pressures and multipliers of an element are coefficients of shape functions that are orthonormal over the reference
   volume. Their unit is stress times the root of a volume. */
#include "elementbatch.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { MAX_BUBBLE = 3 /* displacements of the inner node */ };

/* Iterations of Newton's method for the inner node. It takes 2 to 5; an element that needs more than this has failed.
 */
enum { MAX_ITERATIONS = 40 };
/* Newton's method has converged when the energy of a correction is below this part of the element's energy. */
static const double converged_energy = 1e-16;
/* Relative round-off error of an energy that is a sum over the points. Two energies this close count as equal. */
static const double energy_round_off = 1e-13;
/* Square of a strain that is negligible, for elements that have no energy. It is far above the round-off of
   displacements and far below any strain of interest. */
static const double converged_strain2 = 1e-20;

/* Points of an integration rule, with the shape functions of the nodes and of the inner node, which is the last. */
typedef struct {
  int    points;
  double point[ELEMENT_MAX_POINTS][3], weight[ELEMENT_MAX_POINTS];
  double N[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES], dN[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES][3];
} Rule;

/* What a batch knows of its elements */
typedef struct {
  ChunkPoints c;
  double      X[ELEMENT_MAX_NODES * 3 * KERNEL_LANES]; /* with the inner node: X = 0, so that it does not count */
  double      u[ELEMENT_MAX_NODES * 3 * KERNEL_LANES];
  Lanes       volume[ELEMENT_MAX_POINTS];
  Lanes       H[ELEMENT_MAX_POINTS][9];                   /* while the bubble is solved for, without it */
  Lanes       bubble[ELEMENT_MAX_POINTS][3];              /* gradient of the bubble; axisymmetric: [2] is N / R */
  Lanes       shape[ELEMENT_MAX_POINTS][MIXED_PRESSURES]; /* orthonormal shape functions of the pressure */
  Lanes       centre[3];                                  /* about which they are linear */
  Lanes       L[MIXED_PRESSURES][MIXED_PRESSURES];        /* L L^T: matrix of their products before; 1/L_kk at k k */
  Lanes       theta[MIXED_PRESSURES], p[MIXED_PRESSURES]; /* of J - 1 and of the pressure */
  Lanes       C[MIXED_PRESSURES][MIXED_PRESSURES];        /* derivatives of p by theta */
  Lanes       geometric[MIXED_PRESSURES];                 /* of the pressure in the tangent's geometric part */
  Lanes       b[MAX_BUBBLE];
} Mixed;

/* Rules by element. The stress is output at the points of the element's own table. */
static Rule rules[ELEMENT_TYPES], output_rules[ELEMENT_TYPES];

/* Adds the points whose barycentric coordinates are the permutations of (a, ..., a, rest): those with rest at one place
   or, for a pair, with (1 - 2 a) / 2 at two of four places. */
static void AddPoints(Rule *rule, int dim, int pair, double a, double weight)
{
  const double rest = pair ? 0.5 - a : 1 - dim * a, volume = dim == 2 ? 1. / 2 : 1. / 6;

  for (int i = 0; i <= dim; i++) {
    for (int j = pair ? i + 1 : i; j <= (pair ? dim : i); j++) {
      for (int k = 0; k < dim; k++) rule->point[rule->points][k] = k + 1 == i || k + 1 == j ? rest : a;
      rule->weight[rule->points++] = volume * weight;
    }
  }
}

/* The bubble needs more points than a straight tri6 or tet10 without it: degree 4 with 6 points (Dunavant 1985), degree
   5 with 14 points (Walkington 2000). All weights are positive. */
static void SetPoints(Rule *rule, const Element *e, int output)
{
  rule->points = 0;
  if (e->type == ELEMENT_TRI6 && !output) {
    AddPoints(rule, 2, 0, 0.44594849091596488632, 0.22338158967801146570);
    AddPoints(rule, 2, 0, 0.09157621350977074346, 0.10995174365532186764);
  } else if (e->type == ELEMENT_TET10 && !output) {
    AddPoints(rule, 3, 0, 0.31088591926330060980, 0.11268792571801585080);
    AddPoints(rule, 3, 0, 0.09273525031089122640, 0.07349304311636194954);
    AddPoints(rule, 3, 1, 0.04550370412564964949, 0.04254602077708146644);
  } else {
    rule->points = e->points;
    memcpy(rule->point, e->point, sizeof(e->point));
    memcpy(rule->weight, e->weight, sizeof(e->weight));
  }
}

/* The product of the barycentric coordinates, 1 in the middle, with its derivatives */
static void BubbleShape(int dim, const double *xi, double *N, double dN[3])
{
  double L[4] = {1, 0, 0, 0};
  int    product;

  for (int k = 0; k < dim; k++) {
    L[0] -= xi[k];
    L[k + 1] = xi[k];
  }
  product = dim == 2 ? 27 : 256;
  *N      = product;
  for (int k = 0; k <= dim; k++) *N *= L[k];
  for (int k = 0; k < dim; k++) {
    double others = product;

    for (int l = 1; l <= dim; l++) others *= l == k + 1 ? 1 : L[l];
    dN[k] = others * (L[0] - L[k + 1]);
  }
}

static void CompleteRule(Rule *rule, const Element *e, int output)
{
  SetPoints(rule, e, output);
  for (int q = 0; q < rule->points; q++) {
    double dN[ELEMENT_MAX_NODES * 3];

    ElementShape(e->type, rule->point[q], rule->N[q], dN, NULL);
    for (int a = 0; a < e->nodes; a++) {
      for (int k = 0; k < e->dim; k++) rule->dN[q][a][k] = dN[a * e->dim + k];
    }
    if (e->nodes < ELEMENT_MAX_NODES) BubbleShape(e->dim, rule->point[q], &rule->N[q][e->nodes], rule->dN[q][e->nodes]);
  }
}

static const Rule *GetRule(const Element *e, int output)
{
  Rule *rule = output ? &output_rules[e->type] : &rules[e->type];

  if (!rule->points) CompleteRule(rule, e, output);
  return rule;
}

LANES_INLINE Lanes Root(Lanes a)
{
  for (int lane = 0; lane < LANES; lane++) a[lane] = sqrt(a[lane]);
  return a;
}

/* Computes 1 and the coordinates about the centre at a point. */
LANES_INLINE void Monomials(const int nodes, const int modes, const int dim, const double *N, const Mixed *x,
                            Lanes phi[MIXED_PRESSURES])
{
  phi[0] = (Lanes){0} + 1;
  for (int k = 1; k < modes; k++) {
    phi[k] = -x->centre[k - 1];
    for (int a = 0; a < nodes; a++) phi[k] += N[a] * CONST_LANE(x->X, a * dim + k - 1);
  }
}

/* Makes monomials at a point into orthonormal shape functions: phi = L^-1 phi */
LANES_INLINE void Orthonormal(const int modes, const Mixed *x, Lanes phi[MIXED_PRESSURES])
{
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l < k; l++) phi[k] -= x->L[k][l] * phi[l];
    phi[k] *= x->L[k][k];
  }
}

/* Factors the matrix of the products of the monomials, and makes them orthonormal at all points. */
LANES_INLINE void PressureShapes(const int points, const int modes, Mixed *x)
{
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l <= k; l++) {
      x->L[k][l] = (Lanes){0};
      for (int q = 0; q < points; q++) x->L[k][l] += x->volume[q] * x->shape[q][k] * x->shape[q][l];
      for (int m = 0; m < l; m++) x->L[k][l] -= x->L[k][m] * x->L[l][m];
      x->L[k][l] = k == l ? 1 / Root(x->L[k][k]) : x->L[k][l] * x->L[l][l];
    }
  }
  for (int q = 0; q < points; q++) Orthonormal(modes, x, x->shape[q]);
}

/* Copies X and u and gives the inner node neither a place nor a displacement. */
LANES_INLINE void CopyNodes(const BatchCall *call, const int n, const int bubble, const int dim, Mixed *x)
{
  for (int k = 0; k < dim; k++) x->centre[k] = (Lanes){0};
  for (int k = 0; k < n * dim; k++) {
    LANE(x->X, k) = CONST_LANE(call->X, k);
    LANE(x->u, k) = CONST_LANE(call->u, k);
    x->centre[k % dim] += CONST_LANE(call->X, k) / n;
  }
  for (int k = n * dim; k < (n + bubble) * dim; k++) LANE(x->X, k) = LANE(x->u, k) = (Lanes){0};
  for (int k = 0; k < MAX_BUBBLE; k++) x->b[k] = (Lanes){0};
}

/* Computes gradients at the points, displacement gradients without the bubble, and the pressure's shape functions. */
LANES_INLINE void Prepare(const BatchCall *call, const Rule *rule, const int n, const int bubble, const int points,
                          const int modes, const int dim, const int hoop, Mixed *x)
{
  const int nodes = n + bubble;

  CopyNodes(call, n, bubble, dim, x);
  for (int q = 0; q < points; q++) {
    const int at = points > CHUNK ? 0 : q;

    PointGradients(nodes, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], at, x->X, &x->c, &x->volume[q]);
    PointDisplacementGradient(n, dim, hoop, at, x->u, &x->c, x->H[q]);
    for (int k = 0; k < dim + hoop && bubble; k++) x->bubble[q][k] = x->c.g[n][at][k];
    Monomials(nodes, modes, dim, rule->N[q], x, x->shape[q]);
  }
  PressureShapes(points, modes, x);
}

/* Computes J - 1 at a point; with small strains it is the trace. */
LANES_INLINE void Dilatation(const BatchCall *call, const Lanes H[9], Lanes *dilatation)
{
  if (call->finite)
    MaterialDilatation(H, dilatation);
  else
    *dilatation = H[0] + H[4] + H[8];
}

LANES_INLINE Lanes LogVolume(Lanes dilatation)
{
  for (int lane = 0; lane < LANES; lane++) dilatation[lane] = log1p(FlooredDilatation(dilatation[lane]));
  return dilatation;
}

/* Computes the derivative G of J by F, the cofactors; with small strains it is the unit tensor. */
LANES_INLINE void DilatationGradient(const BatchCall *call, const Lanes H[9], Lanes G[9])
{
  if (call->finite) {
    Cofactors(H, G);
    return;
  }
  for (int r = 0; r < 9; r++) G[r] = (Lanes){0} + (double)(r % 4 == 0);
}

/* Adds the bubble to a displacement gradient. */
LANES_INLINE void AddBubble(const int dim, const int hoop, const Lanes b[MAX_BUBBLE], const Lanes g[3], Lanes H[9])
{
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) H[3 * i + m] += b[i] * g[m];
  }
  if (hoop) H[TENSOR_HOOP] += b[0] * g[2];
}

LANES_INLINE Lanes Multiplier(const BatchCall *call, int k)
{
  Lanes multiplier = {0};

  if (call->multiplier) multiplier = CONST_LANE(call->multiplier, k);
  return multiplier;
}

LANES_INLINE Lanes PressureAt(const int modes, const Lanes p[MIXED_PRESSURES], const Lanes shape[MIXED_PRESSURES])
{
  Lanes sum = p[0] * shape[0];

  for (int k = 1; k < modes; k++) sum += p[k] * shape[k];
  return sum;
}

/* Computes the pressures from theta, their derivatives by theta, and the energy of the volume. With small strains it is
   a square of theta. */
LANES_INLINE void Pressures(const BatchCall *call, const int points, const int modes, Mixed *x, Lanes *W)
{
  *W = (Lanes){0};
  for (int k = 0; k < modes; k++) {
    x->p[k] = Multiplier(call, k);
    *W += x->theta[k] * x->p[k];
    for (int l = 0; l < modes; l++) x->C[k][l] = (Lanes){0};
    if (call->finite) continue;
    x->p[k] += call->kappa * x->theta[k];
    x->C[k][k] = call->kappa;
    *W += 0.5 * call->kappa * x->theta[k] * x->theta[k];
  }
  for (int q = 0; q < points && call->finite; q++) {
    const Lanes dilatation = PressureAt(modes, x->theta, x->shape[q]), log_j = LogVolume(dilatation);
    const Lanes weight = call->kappa * x->volume[q];
    Lanes       inverse;

    for (int lane = 0; lane < LANES; lane++) inverse[lane] = 1 / (1 + FlooredDilatation(dilatation[lane]));
    *W += 0.5 * weight * log_j * log_j;
    for (int k = 0; k < modes; k++) {
      const Lanes part = weight * x->shape[q][k] * inverse;

      x->p[k] += part * log_j;
      for (int l = 0; l < modes; l++) x->C[k][l] += part * x->shape[q][l] * inverse * (1 - log_j);
    }
  }
}

/* The equations of the bubble: energy W of the element, force f and tangent K of the inner node. size is a sum of
   absolute values that W is a sum of, for its round-off. */
typedef struct {
  Lanes W, size, f[MAX_BUBBLE], K[MAX_BUBBLE][MAX_BUBBLE];
} BubbleSystem;

/* What J adds to them: first and second derivatives of theta by the bubble */
typedef struct {
  Lanes first[MIXED_PRESSURES][MAX_BUBBLE], second[MIXED_PRESSURES][MAX_BUBBLE][MAX_BUBBLE];
} BubbleDilatation;

/* Adds a point to f and K of the inner node: the law's stress P and tangent A. */
LANES_INLINE void AddBubbleShape(const int dim, const int hoop, const Lanes g[3], const Lanes *volume, const Lanes P[9],
                                 const Lanes A[MATERIAL_TANGENT_SIZE], BubbleSystem *s)
{
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) s->f[i] += *volume * P[3 * i + m] * g[m];
    if (hoop && i == 0) s->f[i] += *volume * P[TENSOR_HOOP] * g[2];
    for (int j = i; j < dim; j++) {
      Lanes sum = {0};

      for (int m = 0; m < dim; m++) {
        for (int l = 0; l < dim; l++) sum += g[m] * g[l] * TANGENT(A, 3 * i + m, 3 * j + l);
        if (hoop && j == 0) sum += g[m] * g[2] * TANGENT(A, 3 * i + m, TENSOR_HOOP);
        if (hoop && i == 0) sum += g[m] * g[2] * TANGENT(A, 3 * j + m, TENSOR_HOOP);
      }
      if (hoop && i == 0 && j == 0) sum += g[2] * g[2] * TANGENT(A, TENSOR_HOOP, TENSOR_HOOP);
      s->K[i][j] += *volume * sum;
    }
  }
}

/* Adds a point to the derivatives of theta. J is linear in the bubble but for the hoop stretch. */
LANES_INLINE void AddBubbleDilatation(const int modes, const int dim, const int hoop, int finite, const Lanes g[3],
                                      const Lanes *volume, const Lanes shape[MIXED_PRESSURES], const Lanes H[9],
                                      const Lanes G[9], BubbleDilatation *d)
{
  Lanes v[MAX_BUBBLE], ring = {0};

  for (int i = 0; i < dim; i++) {
    v[i] = G[3 * i] * g[0];
    for (int m = 1; m < dim; m++) v[i] += G[3 * i + m] * g[m];
  }
  if (hoop && finite) ring = g[2] / (1 + H[TENSOR_HOOP]);
  for (int k = 0; k < modes; k++) {
    const Lanes weight = *volume * shape[k];

    for (int i = 0; i < dim; i++) {
      d->first[k][i] += weight * (hoop && i == 0 ? v[0] + G[TENSOR_HOOP] * g[2] : v[i]);
      if (hoop) d->second[k][0][i] += weight * ring * (i == 0 ? 2 * v[0] : v[i]);
    }
  }
}

LANES_INLINE void SetBubbleSystem(const BatchCall *call, const int points, const int modes, const int dim,
                                  const int hoop, Mixed *x, BubbleSystem *s, BubbleDilatation *d)
{
  Lanes volume;

  memset(s, 0, sizeof(*s));
  memset(d, 0, sizeof(*d));
  for (int k = 0; k < modes; k++) x->theta[k] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    Lanes H[9], P[9], G[9], A[MATERIAL_TANGENT_SIZE], dilatation, energy;

    for (int r = 0; r < 9; r++) H[r] = x->H[q][r];
    AddBubble(dim, hoop, x->b, x->bubble[q], H);
    Dilatation(call, H, &dilatation);
    PointLaw(call, q, H, &dilatation, &energy, P, A);
    DilatationGradient(call, H, G);
    s->W += x->volume[q] * energy;
    for (int k = 0; k < modes; k++) x->theta[k] += x->volume[q] * x->shape[q][k] * dilatation;
    AddBubbleShape(dim, hoop, x->bubble[q], &x->volume[q], P, A, s);
    AddBubbleDilatation(modes, dim, hoop, call->finite, x->bubble[q], &x->volume[q], x->shape[q], H, G, d);
  }
  Pressures(call, points, modes, x, &volume);
  s->size = s->W + volume;
  s->W += volume;
  for (int k = 0; k < modes; k++) {
    const Lanes work = x->theta[k] * Multiplier(call, k);
    Lanes       change[MAX_BUBBLE]; /* of the pressure by the bubble */

    for (int lane = 0; lane < LANES; lane++) s->size[lane] += fabs(work[lane]) - work[lane];
    for (int i = 0; i < dim; i++) {
      change[i] = (Lanes){0};
      for (int l = 0; l < modes; l++) change[i] += x->C[k][l] * d->first[l][i];
    }
    for (int i = 0; i < dim; i++) {
      s->f[i] += x->p[k] * d->first[k][i];
      for (int j = i; j < dim; j++) s->K[i][j] += d->first[k][i] * change[j] + x->p[k] * d->second[k][i][j];
    }
  }
}

/* Factors K = U^T D U from its upper triangle and solves K d = f. U is stored above the diagonal and 1 / D on it. */
LANES_INLINE void SolveBubbleSystem(const int dim, BubbleSystem *s, Lanes d[MAX_BUBBLE])
{
  for (int k = 0; k < dim; k++) {
    s->K[k][k] = 1 / s->K[k][k];
    for (int i = k + 1; i < dim; i++) {
      const Lanes u = s->K[k][i] * s->K[k][k];

      for (int j = i; j < dim; j++) s->K[i][j] -= u * s->K[k][j];
    }
    for (int i = k + 1; i < dim; i++) s->K[k][i] *= s->K[k][k];
    d[k] = s->f[k];
  }
  for (int k = 0; k < dim; k++) {
    for (int i = k + 1; i < dim; i++) d[i] -= s->K[k][i] * d[k];
  }
  for (int k = dim - 1; k >= 0; k--) {
    d[k] *= s->K[k][k];
    for (int i = k + 1; i < dim; i++) d[k] -= s->K[k][i] * d[i];
  }
}

/* State of Newton's method for the bubble of each lane */
typedef struct {
  Lanes W;                /* energy at the last point that was better than the one before */
  Lanes gone[MAX_BUBBLE]; /* step from that point to b */
  Lanes active;           /* 1 while the lane has not converged, else 0 */
  Lanes scale;            /* energy of a negligible strain */
} BubbleState;

/* A lane whose energy fell takes the correction d. A lane whose energy rose goes back by half of its last step. A lane
   that has converged does not change. Returns how many have not converged. */
LANES_INLINE int Advance(const int dim, const BubbleSystem *s, const Lanes *d, BubbleState *state, Mixed *x)
{
  int left = 0;

  for (int lane = 0; lane < LANES; lane++) {
    const double round_off = energy_round_off * s->size[lane] + state->scale[lane];
    double       work      = 0; /* twice the energy that the correction releases */

    if (state->active[lane] == 0) continue;
    if (s->W[lane] > state->W[lane] + round_off) {
      for (int k = 0; k < dim; k++) {
        state->gone[k][lane] /= 2;
        x->b[k][lane] -= state->gone[k][lane];
      }
      left++;
      continue;
    }
    state->W[lane] = s->W[lane];
    for (int k = 0; k < dim; k++) {
      state->gone[k][lane] = -d[k][lane];
      x->b[k][lane] -= d[k][lane];
      work += fabs(s->f[k][lane] * d[k][lane]);
    }
    state->active[lane] = !(work <= converged_energy * s->size[lane] + state->scale[lane]);
    left += state->active[lane] != 0;
  }
  return left;
}

/* Solves for the bubble of each lane. A lane that does not converge gets J = NaN and no bubble. With small strains one
   step is enough. */
LANES_INLINE void SolveBubble(const BatchCall *call, const int points, const int modes, const int dim, const int hoop,
                              Mixed *x)
{
  BubbleState state = {.W = (Lanes){0} + __DBL_MAX__, .active = (Lanes){0} + 1};
  int         left  = LANES;

  for (int q = 0; q < points; q++) state.scale += converged_strain2 * call->mu * x->volume[q];
  for (int iteration = 0; left && iteration < (call->finite ? MAX_ITERATIONS : 1); iteration++) {
    BubbleSystem     s;
    BubbleDilatation dilatation;
    Lanes            d[MAX_BUBBLE];

    SetBubbleSystem(call, points, modes, dim, hoop, x, &s, &dilatation);
    SolveBubbleSystem(dim, &s, d);
    left = Advance(dim, &s, d, &state, x);
  }
  for (int lane = 0; lane < LANES && call->finite; lane++) {
    for (int k = 0; k < dim && state.active[lane] != 0; k++) x->b[k][lane] = 0;
    if (state.active[lane] != 0) call->J[lane] = NAN;
  }
}

/* Adds second derivatives of J times the pressure to a tangent of the law: those of J by F_iI and F_kK are components
   of F. */
LANES_INLINE void AddGeometry(const Lanes *pressure, const Lanes H[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  for (int r = 0; r < 9; r++) {
    for (int s = r + 1; s < 9; s++) {
      const int i = r / 3, k = s / 3, I = r % 3, K = s % 3, rest = 3 * (3 - i - k) + 3 - I - K;

      if (i == k || I == K) continue;
      if (((k - i) % 3 + 3) % 3 == ((K - I) % 3 + 3) % 3)
        A[MATERIAL_TANGENT_INDEX(r, s)] += *pressure * (H[rest] + (double)(rest % 4 == 0));
      else
        A[MATERIAL_TANGENT_INDEX(r, s)] -= *pressure * (H[rest] + (double)(rest % 4 == 0));
    }
  }
}

/* Adds a point to the force on the inner node that a change dH of the displacement gradient makes. */
LANES_INLINE void AddBubbleChange(const int dim, const int hoop, const Lanes g[3], const Lanes *volume,
                                  const Lanes A[MATERIAL_TANGENT_SIZE], const Lanes dH[9], Lanes f[MAX_BUBBLE])
{
  Lanes Q[9];

  for (int r = 0; r < 9; r++) {
    Q[r] = TANGENT(A, r, 0) * dH[0];
    for (int s = 1; s < 9; s++) Q[r] += TANGENT(A, r, s) * dH[s];
  }
  for (int i = 0; i < dim; i++) {
    for (int m = 0; m < dim; m++) f[i] += *volume * Q[3 * i + m] * g[m];
  }
  if (hoop) f[0] += *volume * Q[TENSOR_HOOP] * g[2];
}

/* Adds to the linear change of theta between the states y and x what the bubble of y does in it. */
LANES_INLINE void FollowBubble(const BatchCall *call, const int points, const int modes, const int dim, const int hoop,
                               const Mixed *x, Mixed *y, Lanes change[MIXED_PRESSURES])
{
  BubbleSystem     s;
  BubbleDilatation d;
  Lanes            follow[MAX_BUBBLE];

  SetBubbleSystem(call, points, modes, dim, hoop, y, &s, &d);
  for (int i = 0; i < dim; i++) s.f[i] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    const Lanes pressure = PressureAt(modes, y->p, y->shape[q]);
    Lanes       H[9], P[9], A[MATERIAL_TANGENT_SIZE], dH[9], dilatation;

    for (int r = 0; r < 9; r++) {
      H[r]  = y->H[q][r];
      dH[r] = x->H[q][r] - y->H[q][r];
    }
    AddBubble(dim, hoop, y->b, y->bubble[q], H);
    Dilatation(call, H, &dilatation);
    PointLaw(call, q, H, &dilatation, NULL, P, A);
    AddGeometry(&pressure, H, A);
    AddBubbleChange(dim, hoop, y->bubble[q], &y->volume[q], A, dH, s.f);
  }
  for (int k = 0; k < modes; k++) {
    Lanes pressure = y->C[k][0] * change[0];

    for (int l = 1; l < modes; l++) pressure += y->C[k][l] * change[l];
    for (int i = 0; i < dim; i++) s.f[i] += pressure * d.first[k][i];
  }
  SolveBubbleSystem(dim, &s, follow);
  for (int k = 0; k < modes; k++) {
    for (int i = 0; i < dim; i++) change[k] -= d.first[k][i] * follow[i];
  }
}

/* Extrapolates the pressures of the geometric part from the state u_0. x has displacement gradients without the
   bubble. */
LANES_INLINE void ReferencePressures(const BatchCall *call, const Rule *rule, const int n, const int bubble,
                                     const int points, const int modes, const int dim, const int hoop, Mixed *x)
{
  Mixed y;
  Lanes change[MIXED_PRESSURES], W;

  for (int i = 0; i < MAX_BUBBLE; i++) y.b[i] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    PointGradients(n + bubble, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], 0, x->X, &y.c, &y.volume[q]);
    PointDisplacementGradient(n, dim, hoop, 0, call->u_0, &y.c, y.H[q]);
    for (int k = 0; k < modes; k++) y.shape[q][k] = x->shape[q][k];
    for (int k = 0; k < dim + hoop && bubble; k++) y.bubble[q][k] = x->bubble[q][k];
  }
  if (bubble) SolveBubble(call, points, modes, dim, hoop, &y);
  for (int k = 0; k < modes; k++) y.theta[k] = change[k] = (Lanes){0};
  for (int q = 0; q < points; q++) {
    Lanes H[9], G[9], dilatation, slope = {0};

    for (int r = 0; r < 9; r++) H[r] = y.H[q][r];
    if (bubble) AddBubble(dim, hoop, y.b, y.bubble[q], H);
    Dilatation(call, H, &dilatation);
    DilatationGradient(call, H, G);
    for (int r = 0; r < 9; r++) slope += G[r] * (x->H[q][r] - y.H[q][r]);
    for (int k = 0; k < modes; k++) {
      y.theta[k] += y.volume[q] * y.shape[q][k] * dilatation;
      change[k] += y.volume[q] * y.shape[q][k] * slope;
    }
  }
  Pressures(call, points, modes, &y, &W);
  for (int k = 0; k < modes; k++) x->geometric[k] = y.p[k];
  if (bubble) FollowBubble(call, points, modes, dim, hoop, x, &y, change);
  for (int k = 0; k < modes; k++) {
    for (int l = 0; l < modes; l++) x->geometric[k] += call->rate * y.C[k][l] * change[l];
    for (int lane = 0; lane < LANES && call->held; lane++) {
      if (call->rest[lane] > 0) x->geometric[k][lane] = Multiplier(call, k)[lane] / call->rest[lane];
    }
  }
}

/* Computes displacement gradients with the bubble, theta, pressures, the energy of the volume and the smallest J. */
LANES_INLINE void SetPressures(const BatchCall *call, const int n, const int bubble, const int points, const int modes,
                               const int dim, const int hoop, Mixed *x, Lanes *W)
{
  for (int k = 0; k < modes; k++) x->theta[k] = (Lanes){0};
  for (int k = 0; k < dim && bubble; k++) LANE(x->u, n * dim + k) = x->b[k];
  for (int q = 0; q < points; q++) {
    Lanes dilatation;

    if (bubble) AddBubble(dim, hoop, x->b, x->bubble[q], x->H[q]);
    Dilatation(call, x->H[q], &dilatation);
    KeepLeastJ(call, &dilatation);
    for (int k = 0; k < modes; k++) x->theta[k] += x->volume[q] * x->shape[q][k] * dilatation;
  }
  Pressures(call, points, modes, x, W);
}

/* Adds t C t^T to the tangent, for the derivatives t of every theta by the displacements. */
LANES_INLINE void AddDilatationTangent(const int dofs, const int modes, const Mixed *x,
                                       double t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES], double *K)
{
  for (int r = 0; r < dofs; r++) {
    Lanes row[MIXED_PRESSURES];

    for (int k = 0; k < modes; k++) {
      row[k] = x->C[k][0] * CONST_LANE(t[0], r);
      for (int l = 1; l < modes; l++) row[k] += x->C[k][l] * CONST_LANE(t[l], r);
    }
    for (int s = r; s < dofs; s++) {
      Lanes value = LANE(K, r * dofs + s);

      for (int k = 0; k < modes; k++) value += row[k] * CONST_LANE(t[k], s);
      LANE(K, r * dofs + s) = value;
      LANE(K, s * dofs + r) = value;
    }
  }
}

/* Writes the tangent of the nodes without the inner node, whose rows are the last: K = Kuu - Kub Kbb^-1 Kbu. Kub is
   overwritten. */
LANES_INLINE void Condense(const int dofs, const int dim, double *full, double *K)
{
  const int all = dofs + dim;

  for (int k = all - 1; k >= dofs; k--) { /* from the last row on, so that the rest is a smaller full tangent */
    const Lanes inverse = 1 / LANE(full, k * all + k);

    for (int r = 0; r < k; r++) {
      const Lanes factor = LANE(full, r * all + k) * inverse;

      for (int s = r; s < k; s++) LANE(full, r * all + s) -= factor * LANE(full, s * all + k);
    }
  }
  for (int r = 0; r < dofs; r++) {
    for (int s = r; s < dofs; s++) {
      LANE(K, r * dofs + s) = LANE(full, r * all + s);
      LANE(K, s * dofs + r) = LANE(full, r * all + s);
    }
  }
}

/* Stores displacement gradient and pressure at the points of the element's table. */
LANES_INLINE void StoreOutput(const BatchCall *call, const int n, const int bubble, const int modes, const int dim,
                              const int hoop, Mixed *x)
{
  const Rule *rule = GetRule(call->e, 1);

  for (int q = 0; q < rule->points; q++) {
    Lanes H[9], phi[MIXED_PRESSURES], volume, dilatation;

    PointGradients(n + bubble, dim, hoop, rule->N[q], rule->dN[q], rule->weight[q], 0, x->X, &x->c, &volume);
    PointDisplacementGradient(n + bubble, dim, hoop, 0, x->u, &x->c, H);
    StorePoint(call, q, H);
    if (!call->pressure) continue;
    Monomials(n + bubble, modes, dim, rule->N[q], x, phi);
    Orthonormal(modes, x, phi);
    Dilatation(call, H, &dilatation);
    LANE(call->pressure, q) = PressureAt(modes, x->p, phi);
    if (call->finite)
      LANE(call->pressure, q) =
        (1 + dilatation) * CONST_LANE(call->pressure, q) + call->constants[0] * LogVolume(dilatation);
    else
      LANE(call->pressure, q) += call->constants[0] * dilatation;
  }
}

/* Evaluates the points of a chunk, which starts at point `first`: adds to energy and force, and makes the tangents in
   x->c.A. */
LANES_INLINE void EvaluateChunk(const BatchCall *call, const int modes, const int nodes, const int dim, const int hoop,
                                const int first, const int count, Mixed *x, Lanes *W, double *f, const int tangent,
                                double t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES])
{
  for (int at = 0; at < count; at++) {
    const int   q        = first + at;
    const Lanes pressure = PressureAt(modes, x->p, x->shape[q]);
    Lanes       P[9], G[9], D[9], dilatation, energy, geometric;

    Dilatation(call, x->H[q], &dilatation);
    PointLaw(call, q, x->H[q], &dilatation, call->W ? &energy : NULL, P, tangent ? x->c.A[at] : NULL);
    if (call->W) *W += x->volume[q] * energy;
    DilatationGradient(call, x->H[q], G);
    for (int r = 0; r < 9; r++) P[r] = x->volume[q] * (P[r] + pressure * G[r]);
    if (f) AddForce(nodes, dim, hoop, at, &x->c, P, f);
    if (!tangent) continue;
    geometric = PressureAt(modes, x->geometric, x->shape[q]);
    if (call->finite) AddGeometry(&geometric, x->H[q], x->c.A[at]);
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) x->c.A[at][k] *= x->volume[q];
    for (int k = 0; k < modes; k++) {
      for (int r = 0; r < 9; r++) D[r] = x->volume[q] * x->shape[q][k] * G[r];
      AddForce(nodes, dim, hoop, at, &x->c, D, t[k]);
    }
  }
}

/* Computes energy, force and tangent. n, bubble (1 with an inner node), points, modes, dim and hoop are constants of
   the instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int bubble, const int points, const int modes,
                        const int dim, const int hoop)
{
  const int   nodes = n + bubble, dofs = nodes * dim;
  const Rule *rule = GetRule(call->e, 0);
  double      f[ELEMENT_MAX_NODES * 3 * KERNEL_LANES], t[MIXED_PRESSURES][ELEMENT_MAX_NODES * 3 * KERNEL_LANES];
  double full[bubble ? dofs * dofs * KERNEL_LANES : 1], *const K = bubble && call->K ? full : call->K;
  Lanes W;
  Mixed x;

  for (int i = 0; i < dofs; i++) {
    LANE(f, i) = (Lanes){0};
    for (int k = 0; k < modes && K; k++) LANE(t[k], i) = (Lanes){0};
  }
  Prepare(call, rule, n, bubble, points, modes, dim, hoop, &x);
  if ((K || call->follow) && call->u_0) ReferencePressures(call, rule, n, bubble, points, modes, dim, hoop, &x);
  for (int k = 0; k < modes && call->follow; k++) LANE(call->follow, k) = x.geometric[k];
  if (call->follow) return;
  StartLeastJ(call);
  if (bubble) SolveBubble(call, points, modes, dim, hoop, &x);
  SetPressures(call, n, bubble, points, modes, dim, hoop, &x, &W);
  for (int k = 0; k < modes && !call->u_0; k++) x.geometric[k] = x.p[k];
  for (int first = 0; first < points; first += CHUNK) {
    const int count = points - first < CHUNK ? points - first : CHUNK;
    Lanes     volume;

    for (int at = 0; at < count && points > CHUNK; at++)
      PointGradients(nodes, dim, hoop, rule->N[first + at], rule->dN[first + at], rule->weight[first + at], at, x.X,
                     &x.c, &volume);
    EvaluateChunk(call, modes, nodes, dim, hoop, first, count, &x, &W, call->f ? f : NULL, K != NULL, t);
    if (K) AddTangent(nodes, dim, hoop, count, first == 0, first + count == points, &x.c, K);
  }
  if (call->W) LANE(call->W, 0) = W;
  for (int i = 0; i < n * dim && call->f; i++) LANE(call->f, i) = LANE(f, i);
  if (K) AddDilatationTangent(dofs, modes, &x, t, K);
  if (K && bubble) Condense(n * dim, dim, full, call->K);
  for (int k = 0; k < modes && call->theta; k++) LANE(call->theta, k) = (x.p[k] - Multiplier(call, k)) / call->kappa;
  if (call->H) StoreOutput(call, n, bubble, modes, dim, hoop, &x);
}

#define BATCH_INSTANCE(name, nodes, bubble, points, modes, dim, hoop) \
  static void name(const BatchCall *call)                             \
  {                                                                   \
    Batch(call, nodes, bubble, points, modes, dim, hoop);             \
  }

BATCH_INSTANCE(BatchTri6, 6, 1, 6, 3, 2, 0)
BATCH_INSTANCE(BatchQuad4, 4, 0, 4, 1, 2, 0)
BATCH_INSTANCE(BatchQuad9, 9, 0, 9, 3, 2, 0)
BATCH_INSTANCE(BatchTri6Axisymmetric, 6, 1, 6, 3, 2, 1)
BATCH_INSTANCE(BatchQuad4Axisymmetric, 4, 0, 4, 1, 2, 1)
BATCH_INSTANCE(BatchQuad9Axisymmetric, 9, 0, 9, 3, 2, 1)
BATCH_INSTANCE(BatchTet10, 10, 1, 14, 4, 3, 0)
BATCH_INSTANCE(BatchHex8, 8, 0, 8, 1, 3, 0)
BATCH_INSTANCE(BatchHex27, 27, 0, 27, 4, 3, 0)

BatchFn *const mixed_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI6]  = {BatchTri6, BatchTri6Axisymmetric},
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_QUAD9] = {BatchQuad9, BatchQuad9Axisymmetric},
  [ELEMENT_TET10] = {BatchTet10, NULL},
  [ELEMENT_HEX8]  = {BatchHex8, NULL},
  [ELEMENT_HEX27] = {BatchHex27, NULL},
};

/* Number of pressures of an element */
const int mixed_pressures[ELEMENT_TYPES] = {
  [ELEMENT_TRI6] = 3,  [ELEMENT_QUAD4] = 1, [ELEMENT_QUAD9] = 3,
  [ELEMENT_TET10] = 4, [ELEMENT_HEX8] = 1,  [ELEMENT_HEX27] = 4,
};
