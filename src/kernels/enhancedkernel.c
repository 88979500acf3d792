/* Enhanced assumed strains, the formulation `enhanced`: F = F(u) + F_0 sum_I w_I G_I (x) b_I with free vectors b_I in
   every element. G_I is the gradient of reference coordinate I at the element's centre. F_0 is F(u) at the centre. w_I
   is xi_I times the ratio of the volume elements at the centre and at the point. It is orthogonal to constants, so the
   patch test holds.

   These are Wilson's incompatible modes, transposed. In small strains the element is that of Taylor, Beresford and
   Wilson (QM6) and its brick. In large strains it lacks the hourglass modes that Wilson's modes have under compression.
   Sources: Glaser and Armero, "On the formulation of enhanced strain finite elements in finite deformations",
   Engineering Computations 14, 1997. For F_0 and the constant gradients: Pfefferkorn and Betsch, "On transformations
   and shape functions for enhanced assumed strain elements", International Journal for Numerical Methods in Engineering
   120, 2019. Axisymmetric elements have one more mode for the hoop strain, w = xi eta (Simo and Rifai 1990).

   Every call solves for the b_I by Newton's method in the element, from b = 0, and condenses them. Energy, force and
   tangent are thus functions of u alone. A state that is returned to after a cutback gives the same numbers. The b_I
   are at a minimum of the element's energy. A step of Newton's method lowers it even where the tangent of the modes is
   not positive definite, and is shortened where it goes beyond a minimum: plastic flow makes both happen. */
#include "elementbatch.h"
#include "planestress.h"
#include <math.h>
#include <stddef.h>

enum { MAX_NODES = 8, MAX_POINTS = 8, MAX_MODES = 9 };
_Static_assert((int)MAX_POINTS < (int)CHUNK, "the centre follows the points in a chunk");

/* Iterations of Newton's method in an element. Bending takes 3 to 6; an element that needs more than this has failed.
 */
enum { MAX_ITERATIONS = 40 };
/* The tangent of the modes is computed in the first RENEWED_FIRST iterations and again from iteration RENEWED_AGAIN on.
   In between the last one is used. The rule depends on the iteration alone, so that the result of an element does not
   depend on the other elements of its batch. */
enum { RENEWED_FIRST = 2, RENEWED_AGAIN = 5 };
/* Newton's method has converged when the energy of a correction is below this part of the element's energy. */
static const double converged_energy = 1e-16;
/* Round-off error of the strains where a body turns: they are differences of numbers about 1. Energies count as equal
   if their difference is below that of such strains, or below the relative round-off error of a sum over the points. */
static const double strain_round_off = 1e-14, energy_round_off = 1e-13;
/* Square of a strain that is negligible, for elements that have no energy. It is far above the round-off of
   displacements and far below any strain of interest. */
static const double converged_strain2 = 1e-20;

/* Least amount of a pivot, as a part of the entry on the diagonal that it came from. */
static const double least_pivot = 1e-6;

/* A step along which more than this part of the derivative of the energy is left is shortened. */
static const double slope_left = 0.5;
/* Least part of an interval that the next step keeps from both its ends. */
static const double least_part = 0.1;

/* Mode k is component J of vector I. The hoop mode is the only one in the third direction. A mode acts on the space
   components from FIRST to END. */
#define MODE_IS_HOOP(dim, k)   ((dim) == 2 && (k) == 4)
#define MODE_VECTOR(dim, k)    (MODE_IS_HOOP(dim, k) ? 2 : (k) / (dim))
#define MODE_COMPONENT(dim, k) (MODE_IS_HOOP(dim, k) ? 2 : (k) % (dim))
#define MODE_FIRST(dim, k)     (MODE_IS_HOOP(dim, k) ? 2 : 0)
#define MODE_END(dim, k)       (MODE_IS_HOOP(dim, k) ? 3 : (dim))
/* Row of the gradient operator that belongs to tensor component (i, J) */
#define OPERATOR_ROW(dim, i, J) ((dim) == 2 && (i) == 2 ? 4 : (dim) * (i) + (J))

typedef struct {
  ChunkPoints c; /* the centre follows the points */
  Lanes       volume[MAX_POINTS];
  Lanes       H[MAX_POINTS][9]; /* of the displacements alone */
  Lanes       w[MAX_POINTS][3];
  Lanes       L[3][3];         /* F_0 G_I; axisymmetric: [2][2] is the hoop stretch at the centre */
  Lanes       C[MAX_NODES][3]; /* gradient of node a at the centre times G_I; axisymmetric: [2] is N_a / R there */
  Lanes       b[MAX_MODES];
} Enhanced;

/* Computes gradients at the points and the centre, the modes, and displacement gradients without the modes. */
LANES_INLINE void Prepare(const BatchCall *call, const int n, const int points, const int dim, const int hoop,
                          Enhanced *x)
{
  const Element *e = call->e;
  double         N[MAX_NODES], dN[MAX_NODES][3];
  Lanes          centre, H[9];

  for (int a = 0; a < n; a++) {
    N[a] = 1. / n;
    for (int k = 0; k < dim; k++) dN[a][k] = e->node[a][k] / n;
  }
  PointGradients(n, dim, hoop, N, dN, 1, points, call->X, &x->c, &centre);
  PointDisplacementGradient(n, dim, hoop, points, call->u, &x->c, H);
  for (int q = 0; q < points; q++) {
    Lanes ratio;

    PointGradients(n, dim, hoop, e->N[q], e->dN[q], e->weight[q], q, call->X, &x->c, &x->volume[q]);
    PointDisplacementGradient(n, dim, hoop, q, call->u, &x->c, x->H[q]);
    ratio = e->weight[q] * centre / x->volume[q];
    for (int k = 0; k < dim; k++) x->w[q][k] = e->point[q][k] * ratio;
    if (hoop) x->w[q][2] = e->point[q][0] * e->point[q][1] * ratio;
  }
  for (int k = 0; k < dim; k++) {
    Lanes G[3] = {{0}};

    for (int a = 0; a < n; a++) {
      for (int m = 0; m < dim; m++) G[m] += e->node[a][k] * x->c.g[a][points][m];
    }
    for (int i = 0; i < dim; i++) {
      x->L[k][i] = G[i];
      for (int m = 0; m < dim && call->finite; m++) x->L[k][i] += H[3 * i + m] * G[m];
    }
    for (int a = 0; a < n; a++) {
      x->C[a][k] = x->c.g[a][points][0] * G[0];
      for (int m = 1; m < dim; m++) x->C[a][k] += x->c.g[a][points][m] * G[m];
    }
  }
  if (hoop) x->L[2][2] = 1 + H[TENSOR_HOOP] * (double)call->finite;
  for (int a = 0; a < n && hoop; a++) x->C[a][2] = x->c.g[a][points][2];
  for (int k = 0; k < MAX_MODES; k++) x->b[k] = (Lanes){0};
}

LANES_INLINE void PointGradient(const int dim, const int hoop, const Enhanced *x, int q, Lanes H[9])
{
  for (int r = 0; r < 9; r++) H[r] = x->H[q][r];
#pragma GCC unroll 9
  for (int k = 0; k < dim * dim + hoop; k++) {
    const int   vector = MODE_VECTOR(dim, k);
    const Lanes b      = x->w[q][vector] * x->b[k];

    for (int i = MODE_FIRST(dim, k); i < MODE_END(dim, k); i++)
      H[3 * i + MODE_COMPONENT(dim, k)] += x->L[vector][i] * b;
  }
}

/* T[row of the operator][mode] is the law's tangent times volume, applied to the modes without their factors w. Adds
   the tangent of the modes to the upper triangle of K. */
LANES_INLINE void AddModeTangent(const int dim, const int hoop, const Enhanced *x, int q, Lanes T[MAX_ROWS][MAX_MODES],
                                 Lanes K[MAX_MODES][MAX_MODES])
{
  const int modes = dim * dim + hoop;

#pragma GCC unroll 9
  for (int r = 0; r < modes; r++) {
#pragma GCC unroll 9
    for (int k = 0; k < modes; k++) {
      const int first = MODE_FIRST(dim, k), J = MODE_COMPONENT(dim, k), vector = MODE_VECTOR(dim, k);

      T[r][k] = TANGENT(x->c.A[q], TENSOR_ROW(dim, r), 3 * first + J) * x->L[vector][first];
      for (int i = first + 1; i < MODE_END(dim, k); i++)
        T[r][k] += TANGENT(x->c.A[q], TENSOR_ROW(dim, r), 3 * i + J) * x->L[vector][i];
    }
  }
#pragma GCC unroll 9
  for (int k = 0; k < modes; k++) {
    const int first = MODE_FIRST(dim, k), J = MODE_COMPONENT(dim, k), vector = MODE_VECTOR(dim, k);

#pragma GCC unroll 9
    for (int l = k; l < modes; l++) {
      Lanes sum = x->L[vector][first] * T[OPERATOR_ROW(dim, first, J)][l];

      for (int i = first + 1; i < MODE_END(dim, k); i++) sum += x->L[vector][i] * T[OPERATOR_ROW(dim, i, J)][l];
      K[k][l] += x->w[q][vector] * x->w[q][MODE_VECTOR(dim, l)] * sum;
    }
  }
}

LANES_INLINE void AddModeForce(const int dim, const int hoop, const Enhanced *x, int q, const Lanes P[9],
                               Lanes f[MAX_MODES])
{
#pragma GCC unroll 9
  for (int k = 0; k < dim * dim + hoop; k++) {
    const int vector = MODE_VECTOR(dim, k);
    Lanes     sum    = {0};

    for (int i = MODE_FIRST(dim, k); i < MODE_END(dim, k); i++)
      sum += x->L[vector][i] * P[3 * i + MODE_COMPONENT(dim, k)];
    f[k] += x->w[q][vector] * sum;
  }
}

/* Factors K = U^T D U from its upper triangle. U is stored above the diagonal and 1 / D on it. */
LANES_INLINE void Factor(const int modes, Lanes K[MAX_MODES][MAX_MODES])
{
#pragma GCC unroll 9
  for (int k = 0; k < modes; k++) {
    K[k][k] = 1 / K[k][k];
#pragma GCC unroll 9
    for (int i = k + 1; i < modes; i++) {
      const Lanes u = K[k][i] * K[k][k];

#pragma GCC unroll 9
      for (int j = i; j < modes; j++) K[i][j] -= u * K[k][j];
    }
    for (int i = k + 1; i < modes; i++) K[k][i] *= K[k][k];
  }
}

/* Factors as Factor() does, but takes the amounts of the pivots. A step along -K^-1 f then lowers the energy with the
   gradient f, even where K is not positive definite. */
LANES_INLINE void FactorPositive(const int modes, Lanes K[MAX_MODES][MAX_MODES])
{
  Lanes least[MAX_MODES];

  for (int k = 0; k < modes; k++) {
    for (int lane = 0; lane < LANES; lane++) least[k][lane] = least_pivot * fabs(K[k][k][lane]);
  }
#pragma GCC unroll 9
  for (int k = 0; k < modes; k++) {
    Lanes pivot;

    for (int lane = 0; lane < LANES; lane++) pivot[lane] = fmax(fabs(K[k][k][lane]), least[k][lane]);
    K[k][k] = 1 / pivot;
#pragma GCC unroll 9
    for (int i = k + 1; i < modes; i++) {
      const Lanes u = K[k][i] * K[k][k];

#pragma GCC unroll 9
      for (int j = i; j < modes; j++) K[i][j] -= u * K[k][j];
    }
    for (int i = k + 1; i < modes; i++) K[k][i] *= K[k][k];
  }
}

/* y = U^-T y */
LANES_INLINE void SolveLower(const int modes, Lanes K[MAX_MODES][MAX_MODES], Lanes y[MAX_MODES])
{
#pragma GCC unroll 9
  for (int k = 0; k < modes; k++) {
#pragma GCC unroll 9
    for (int i = k + 1; i < modes; i++) y[i] -= K[k][i] * y[k];
  }
}

/* y = K^-1 y */
LANES_INLINE void SolveModesSystem(const int modes, Lanes K[MAX_MODES][MAX_MODES], Lanes y[MAX_MODES])
{
  SolveLower(modes, K, y);
  for (int k = modes - 1; k >= 0; k--) {
    y[k] *= K[k][k];
    for (int i = k + 1; i < modes; i++) y[k] -= K[k][i] * y[i];
  }
}

/* Computes the element's energy W, the least dilatation of its points and the force f of the modes. If renew, also
   computes and factors their tangent K. */
LANES_INLINE void ModeSystem(const BatchCall *call, const int points, const int dim, const int hoop, const int renew,
                             Enhanced *x, Lanes *W, Lanes *least, Lanes f[MAX_MODES], Lanes K[MAX_MODES][MAX_MODES])
{
  const int modes = dim * dim + hoop;

  *W     = (Lanes){0};
  *least = (Lanes){0} + INFINITY;
  for (int k = 0; k < modes; k++) {
    f[k] = (Lanes){0};
    for (int l = k; l < modes && renew; l++) K[k][l] = (Lanes){0};
  }
  for (int q = 0; q < points; q++) {
    Lanes H[9], P[9], T[MAX_ROWS][MAX_MODES], dilatation, energy;

    PointGradient(dim, hoop, x, q, H);
    if (call->thin) PointStretch(call, H);
    MaterialDilatation(H, &dilatation);
    for (int lane = 0; lane < LANES; lane++)
      if (dilatation[lane] < (*least)[lane]) (*least)[lane] = dilatation[lane];
    PointLaw(call, q, H, &dilatation, &energy, P, renew ? x->c.A[q] : NULL);
    if (call->thin && renew) PlaneTangent(x->c.A[q]);
    *W += energy * x->volume[q];
    for (int r = 0; r < 9; r++) P[r] *= x->volume[q];
    AddModeForce(dim, hoop, x, q, P, f);
    if (!renew) continue;
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) x->c.A[q][k] *= x->volume[q];
    AddModeTangent(dim, hoop, x, q, T, K);
  }
  if (renew) FactorPositive(modes, K);
}

/* State of Newton's method for the modes of each lane. A step goes from the last accepted modes along STEP; b is at the
   part AT of it. */
typedef struct {
  Lanes W, slope; /* energy and its derivative along the step where the step starts */
  Lanes step[MAX_MODES];
  Lanes at;
  Lanes low, high; /* parts of the step with a minimum between them; high: 0 if none is known */
  Lanes low_slope, high_slope;
  Lanes active; /* 1 while the lane has not converged, else 0 */
  Lanes scale;  /* energy of a negligible strain */
} ModesState;

/* The next part of the step of a lane, by the derivatives at both ends of what it is known to lie in. */
static inline double NextPart(const ModesState *m, int lane)
{
  const double fall = m->low_slope[lane], rise = m->high_slope[lane];
  double       part = rise > 0 ? fall / (fall - rise) : 0.5;

  part = fmin(fmax(part, least_part), 1 - least_part);
  return m->low[lane] + part * (m->high[lane] - m->low[lane]);
}

/* Whether the modes of a lane are good enough to start the next step from them. Where energies are equal but for
   round-off they are. Else the energy must have fallen, and little of its derivative along the step may be left, unless
   the whole step was too short. Steps in which plastic flow sets in or ends go too far. W and slope are of
   the modes that are there. */
static inline int StepIsGood(const ModesState *m, int lane, double W, double slope, double round_off)
{
  if (fabs(W - m->W[lane]) <= round_off) return 1;
  if (!(W <= m->W[lane])) return 0;
  return slope <= -slope_left * m->slope[lane] && (m->high[lane] == 0 || slope >= slope_left * m->slope[lane]);
}

/* A lane whose step was good takes the correction d, which was computed from the force f, as its next step. Others go
   back on their last step. A lane that has converged does not change. Returns how many have not converged. */
LANES_INLINE int Advance(const int modes, const Lanes *W, const Lanes *f, const Lanes *d, ModesState *m, Enhanced *x)
{
  int left = 0;

  for (int lane = 0; lane < LANES; lane++) {
    const double before = m->W[lane], now = (*W)[lane], scale = m->scale[lane], at = m->at[lane];
    const double round_off =
      energy_round_off * fabs(before) + strain_round_off * sqrt(scale / converged_strain2 * fabs(before));
    double slope = 0, work = 0; /* work: twice the energy that the correction releases */

    if (m->active[lane] == 0) continue;
    for (int k = 0; k < modes; k++) slope += f[k][lane] * m->step[k][lane];
    if (at > 0 && !StepIsGood(m, lane, now, slope, round_off + scale)) {
      if (now <= before && slope < 0) {
        m->low[lane]       = at;
        m->low_slope[lane] = slope;
      } else {
        m->high[lane]       = at;
        m->high_slope[lane] = slope;
      }
      m->at[lane] = NextPart(m, lane);
      for (int k = 0; k < modes; k++) x->b[k][lane] += (m->at[lane] - at) * m->step[k][lane];
      left++;
      continue;
    }
    m->W[lane]   = now;
    m->at[lane]  = 1;
    m->low[lane] = m->high[lane] = 0;
    for (int k = 0; k < modes; k++) {
      m->step[k][lane] = -d[k][lane];
      x->b[k][lane] -= d[k][lane];
      work += f[k][lane] * d[k][lane];
    }
    m->slope[lane] = m->low_slope[lane] = -work;
    m->active[lane]                     = !(work <= converged_energy * fabs(now) + scale);
    left += m->active[lane] != 0;
  }
  return left;
}

/* Lanes that are inverted without modes get none. Their energy may have no minimum. least: dilatation without modes. */
static inline void LeaveInverted(const Lanes *least, ModesState *m)
{
  for (int lane = 0; lane < LANES; lane++)
    if ((*least)[lane] <= -1) m->active[lane] = 0;
}

/* Solves for the modes of each lane. A lane that does not converge gets J = NaN and no modes. With small strains and
   without plasticity one step is enough. */
LANES_INLINE void SolveModes(const BatchCall *call, const int points, const int dim, const int hoop, Enhanced *x)
{
  const int  modes       = dim * dim + hoop;
  const int  iterates    = call->finite || call->state;
  ModesState modes_state = {.active = (Lanes){0} + 1};
  int        left        = LANES;
  Lanes      K[MAX_MODES][MAX_MODES], mu;

  call->law->shear(call->n_constants, call->constants, &mu);
  for (int q = 0; q < points; q++) modes_state.scale += converged_strain2 * mu * x->volume[q];
  for (int iteration = 0; left && iteration < (iterates ? MAX_ITERATIONS : 1); iteration++) {
    Lanes W, least, f[MAX_MODES], d[MAX_MODES];

    ModeSystem(call, points, dim, hoop, iteration < RENEWED_FIRST || iteration >= RENEWED_AGAIN, x, &W, &least, f, K);
    if (iteration == 0 && call->finite) LeaveInverted(&least, &modes_state);
    for (int k = 0; k < modes; k++) d[k] = f[k];
    SolveModesSystem(modes, K, d);
    left = Advance(modes, &W, f, d, &modes_state, x);
  }
  for (int lane = 0; lane < LANES && iterates; lane++) {
    for (int k = 0; k < modes && modes_state.active[lane] != 0; k++) x->b[k][lane] = 0;
    if (modes_state.active[lane] != 0) call->J[lane] = NAN;
  }
}

/* Adds C w b to the gradients g: dF/du at a point is du (x) (g + C w b), because the modes move with F_0. */
LANES_INLINE void CarryModes(const int n, const int dim, const int hoop, int q, Enhanced *x)
{
  for (int k = 0; k < dim * dim + hoop; k++) {
    const int   vector = MODE_VECTOR(dim, k);
    const Lanes b      = x->w[q][vector] * x->b[k];

    for (int a = 0; a < n; a++) x->c.g[a][q][MODE_COMPONENT(dim, k)] += x->C[a][vector] * b;
  }
}

/* Adds a point to the tangent between displacements and modes, K[n*dim][modes]. P is multiplied by the volume. */
LANES_INLINE void AddModeCoupling(const int n, const int dim, const int hoop, int finite, int q, const Enhanced *x,
                                  const Lanes P[9], Lanes T[MAX_ROWS][MAX_MODES], Lanes K[MAX_NODES * 3][MAX_MODES])
{
  for (int a = 0; a < n; a++) {
#pragma GCC unroll 3
    for (int i = 0; i < dim; i++) {
#pragma GCC unroll 9
      for (int k = 0; k < dim * dim + hoop; k++) {
        const int vector = MODE_VECTOR(dim, k), J = MODE_COMPONENT(dim, k);
        Lanes     sum = x->c.g[a][q][0] * T[dim * i][k];

        for (int m = 1; m < dim; m++) sum += x->c.g[a][q][m] * T[dim * i + m][k];
        if (hoop && i == 0) sum += x->c.g[a][q][2] * T[4][k];
        if (finite && !MODE_IS_HOOP(dim, k)) sum += P[3 * i + J] * x->C[a][vector];
        if (finite && MODE_IS_HOOP(dim, k) && i == 0) sum += P[TENSOR_HOOP] * x->C[a][2];
        K[a * dim + i][k] += x->w[q][vector] * sum;
      }
    }
  }
}

/* K -= K_ub K_bb^-1 K_bu */
LANES_INLINE void Condense(const int dofs, const int modes, Lanes Kbb[MAX_MODES][MAX_MODES],
                           Lanes Kub[MAX_NODES * 3][MAX_MODES], double *K)
{
  Factor(modes, Kbb);
  for (int r = 0; r < dofs; r++) SolveLower(modes, Kbb, Kub[r]);
  for (int r = 0; r < dofs; r++) {
    Lanes row[MAX_MODES];

    for (int k = 0; k < modes; k++) row[k] = Kub[r][k] * Kbb[k][k];
    for (int s = r; s < dofs; s++) {
      Lanes sum = LANE(K, r * dofs + s);

#pragma GCC unroll 9
      for (int k = 0; k < modes; k++) sum -= row[k] * Kub[s][k];
      LANE(K, r * dofs + s) = sum;
      LANE(K, s * dofs + r) = sum;
    }
  }
}

/* Computes the displacement gradients at the points of the state from which stresses are extrapolated, with its modes.
 */
LANES_INLINE void EarlierGradients(const BatchCall *call, const int n, const int points, const int dim, const int hoop,
                                   Lanes H_0[MAX_POINTS][9])
{
  BatchCall earlier = *call;
  double    J[LANES];
  Enhanced  x;

  earlier.u = call->u_0;
  earlier.J = J;
  Prepare(&earlier, n, points, dim, hoop, &x);
  SolveModes(&earlier, points, dim, hoop, &x);
  for (int q = 0; q < points; q++) PointGradient(dim, hoop, &x, q, H_0[q]);
}

/* Computes energy, force and tangent, and condenses the modes. n, points, dim and hoop are constants of the instance.
 */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int points, const int dim, const int hoop)
{
  double *const W = call->W, *const f = call->f, *const K = call->K;
  const Lanes zero                      = {0};
  Lanes       Kbb[MAX_MODES][MAX_MODES] = {{{0}}}, Kub[MAX_NODES * 3][MAX_MODES] = {{{0}}};
  Lanes       H_0[MAX_POINTS][9];
  Enhanced    x;

  if (W) LANE(W, 0) = zero;
  for (int i = 0; i < n * dim && f; i++) LANE(f, i) = zero;
  StartLeastJ(call);
  Prepare(call, n, points, dim, hoop, &x);
  SolveModes(call, points, dim, hoop, &x);
  if (K && call->u_0) EarlierGradients(call, n, points, dim, hoop, H_0);
  for (int q = 0; q < points; q++) {
    Lanes H[9], P[9], T[MAX_ROWS][MAX_MODES], dilatation, energy;

    PointGradient(dim, hoop, &x, q, H);
    if (call->thin) PointStretch(call, H);
    MaterialDilatation(H, &dilatation);
    KeepLeastJ(call, &dilatation);
    PointLaw(call, q, H, &dilatation, W ? &energy : NULL, P, K ? x.c.A[q] : NULL);
    if (call->thin && K) PlaneTangent(x.c.A[q]);
    if (K && call->u_0) PointExtrapolate(call, H, &dilatation, H_0[q], x.c.A[q]);
    if (W) LANE(W, 0) += energy * x.volume[q];
    if (call->H) StorePoint(call, q, H);
    for (int r = 0; r < 9; r++) P[r] *= x.volume[q];
    if (call->finite) CarryModes(n, dim, hoop, q, &x);
    if (f) AddForce(n, dim, hoop, q, &x.c, P, f);
    if (!K) continue;
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) x.c.A[q][k] *= x.volume[q];
    AddModeTangent(dim, hoop, &x, q, T, Kbb);
    AddModeCoupling(n, dim, hoop, call->finite, q, &x, P, T, Kub);
  }
  if (!K) return;
  AddTangent(n, dim, hoop, points, 1, 1, &x.c, K);
  Condense(n * dim, dim * dim + hoop, Kbb, Kub, K);
}

static void BatchQuad4(const BatchCall *call)
{
  Batch(call, 4, 4, 2, 0);
}

static void BatchQuad4Axisymmetric(const BatchCall *call)
{
  Batch(call, 4, 4, 2, 1);
}

static void BatchHex8(const BatchCall *call)
{
  Batch(call, 8, 8, 3, 0);
}

BatchFn *const enhanced_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_HEX8]  = {BatchHex8, NULL},
};
