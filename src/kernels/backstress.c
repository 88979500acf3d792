/* Kinematic hardening: backstresses of Armstrong and Frederick with the plastic part of the deformation split into a
   part that stores energy and a rest. Every backstress has its own split.

   The state of plastic deformation is G = Cp^-1, that of the rest of backstress k is G_k = Ci^-1. The distance of two
   such tensors A and B is the norm of the deviator of 1/2 ln(A^-1 B). It does not depend on the frame, so the law is
   objective. The incremental potential is a sum of squared distances:

       mu |G, C^-1|^2 + sum_k [w_k(p) C_k/3 (|G, G_k|^2 - |G_0, G_k|^2) + h_k(p)] + work of the yield stress,

   where p = sqrt(2/3) |G_0, G| is the increment of the equivalent plastic strain. This is multiplicative flow by the
   exponential map without plastic spin. w_k = (1 - exp(-gamma p)) / (gamma p) and h_k make the term the work of the
   backstress along a straight path, on which Armstrong's and Frederick's equation has a closed solution. At the end of
   a step the rest follows: the elastic strain a of the backstress becomes exp(-gamma p) a + (w - exp(-gamma p)) d,
   where a is its value without recovery and d the strain of the flow. In small strains the distances are |A - B| / 2,
   and the law is radial return with backstresses.

   On a path that is not straight, the stress at the end lies off the yield surface by the square of the step. The
   backstress takes this part in when the state is accepted, so that an accepted state is elastic.

   Newton's method finds G. Its unknown delta is a symmetric tensor in the frame B of the plastic configuration at hand,
   G = B exp(-2 delta) B^T with B B^T = G. First and second derivatives by delta are those of distances in the space of
   positive tensors; its squared distances are convex.

   Sources: Armstrong and Frederick, report RD/B/N731 of the Central Electricity Generating Board, 1966; Lion,
   "Constitutive modelling in finite thermoviscoplasticity", International Journal of Plasticity 16, 2000; Vladimirov,
   Pietryga and Reese, "On the modelling of non-linear kinematic hardening at finite strains", International Journal for
   Numerical Methods in Engineering 75, 2008; Mosler, "Variationally consistent modeling of finite strain plasticity
   theory with non-linear kinematic hardening", Computer Methods in Applied Mechanics and Engineering 199, 2010; for the
   distances Bhatia, "Positive Definite Matrices". */
#include "backstress.h"
#include "plasticpoint.h"
#include <float.h>
#include <string.h>

/* Newton's method takes 3 to 8 iterations. It has failed with this many. */
enum { MAX_ITERATIONS = 60 };
/* The equations are solved when their residual is below this part of the stresses in them, or when it falls no more and
   is below the second part. */
static const double solved = 1e-15, nearly_solved = 1e-10;
/* Relative round-off error of the potential. Two values this close count as equal. */
static const double potential_round_off = 1e-13;
/* gamma p below which series replace differences that lose digits */
static const double short_way = 1e-3;

/* Tensors in the frame have six components in an orthonormal basis: aa bb cc and sqrt(2) times ab bc ac. */
static const double root_2        = 1.41421356237309504880;
static const int    pair_of[3][2] = {{0, 1}, {1, 2}, {0, 2}};

/* The strain between two plastic states */
typedef struct {
  Lanes strain[6], square;
  Lanes value[3], axis[3][3]; /* of finite strains: principal values and axes */
} Distance;

/* A plastic state, and the derivatives of the potential there */
typedef struct {
  int              finite;
  double           dt;
  const Hardening *hardening;
  const Lanes     *state; /* accepted */
  const Lanes     *shear;
  Lanes            G[6], change[6]; /* G - 1, and G - G_0, whose digits a small flow needs; tensor components */
  Trial            x;
  Lanes            B[3][3], inverse[3][3]; /* frame, columns of B and rows of its inverse */
  Lanes            elastic[6];             /* deviator of the elastic strain in the frame */
  Distance         flow, term[HARDENING_MAX_TERMS];
  Lanes            before[HARDENING_MAX_TERMS]; /* squared distances at G_0 */
  Lanes            p, drag;                     /* drag: derivative of the potential by p alone */
  Lanes            potential, stored;           /* stored: work against the backstresses in this increment */
  Lanes            viscous;                     /* work against the overstress */
  Lanes            gradient[6], hessian[6][6], scale;
} Plastic;

/* w, h and their derivatives by p, see above */
typedef struct {
  double w, w1, w2, h, h1, h2;
} Recovery;

static Recovery SetRecovery(double C, double gamma, double p)
{
  const double y = gamma * p, left = exp(-y);
  double       u = (-expm1(-y) - y * left) / (y * y), u1 = (left - 2 * u) / y,
         h = (1 + expm1(-y) / y) / y + expm1(-y) / (2 * y);

  if (y < short_way) {
    u  = 1. / 2 - y / 3 + y * y / 8 - y * y * y / 30;
    u1 = -1. / 3 + y / 4 - y * y / 10 + y * y * y / 36;
    h  = y / 12 - y * y / 24 + y * y * y / 80;
  }
  return (Recovery){.w  = y > 0 ? -expm1(-y) / y : 1,
                    .w1 = -gamma * u,
                    .w2 = -gamma * gamma * u1,
                    .h  = C * p * p * h,
                    .h1 = C * gamma * p * p * u / 2,
                    .h2 = C * gamma * p * left / 2};
}

LANES_INLINE Lanes Dot(const Lanes a[6], const Lanes b[6])
{
  Lanes sum = a[0] * b[0];

  for (int k = 1; k < 6; k++) sum += a[k] * b[k];
  return sum;
}

/* Adds value times the dyad of axes a and b, symmetrised and of norm 1, to the components of a tensor. */
LANES_INLINE void AxisDyad(const Lanes a[3], const Lanes b[3], const Lanes *value, Lanes tensor[6])
{
  for (int k = 0; k < 3; k++) tensor[k] += *value * a[k] * b[k];
  for (int k = 0; k < 3; k++)
    tensor[3 + k] += *value * (a[pair_of[k][0]] * b[pair_of[k][1]] + a[pair_of[k][1]] * b[pair_of[k][0]]) / root_2;
}

/* Computes the strain between G and another state: `other` is that state minus G, in tensor components. */
static void SetDistance(const Plastic *s, const Lanes other[6], Distance *d)
{
  Lanes E[6], mean;

  memset(d, 0, sizeof *d);
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++) {
      Lanes sum = {0};

      for (int I = 0; I < 3; I++) {
        for (int J = 0; J < 3; J++) sum += s->inverse[a][I] * s->inverse[b][J] * other[component[I][J]];
      }
      E[component[a][b]] = sum;
    }
  }
  if (s->finite) {
    PrincipalAxes(E, d->value, d->axis);
    for (int a = 0; a < 3; a++) {
      for (int lane = 0; lane < LANES; lane++) d->value[a][lane] = log1p(fmax(d->value[a][lane], least_square - 1)) / 2;
    }
    mean = (d->value[0] + d->value[1] + d->value[2]) / 3;
    for (int a = 0; a < 3; a++) {
      d->value[a] -= mean;
      AxisDyad(d->axis[a], d->axis[a], &d->value[a], d->strain);
    }
  } else {
    mean = (E[0] + E[1] + E[2]) / 6;
    for (int k = 0; k < 3; k++) d->strain[k] = E[k] / 2 - mean;
    for (int k = 3; k < 6; k++) d->strain[k] = E[k] / root_2;
  }
  d->square = Dot(d->strain, d->strain);
}

/* Sets frame and elastic strain for the present G. */
static void SetFrame(const Lanes H[9], const Lanes *dilatation, Plastic *s)
{
  Lanes mean;

  if (s->finite) {
    TrialState(H, dilatation, s->G, &s->x);
    for (int a = 0; a < 3; a++) {
      Lanes stretch;

      for (int lane = 0; lane < LANES; lane++) stretch[lane] = sqrt(s->x.square[a][lane]);
      for (int I = 0; I < 3; I++) {
        s->B[I][a]       = s->x.pulled[a][I] * stretch;
        s->inverse[a][I] = s->x.axis[a][I];
        for (int i = 0; i < 3; i++) s->inverse[a][I] += s->x.axis[a][i] * H[3 * i + I];
        s->inverse[a][I] /= stretch;
      }
      s->elastic[a] = s->x.deviator[a];
    }
    return;
  }
  for (int a = 0; a < 3; a++) {
    for (int I = 0; I < 3; I++) {
      s->B[I][a] = s->inverse[a][I] = s->x.axis[a][I] = s->x.pulled[a][I] = (Lanes){0} + (double)(a == I);
      if (I < a) continue;
      s->elastic[component[a][I]] = (H[3 * a + I] + H[3 * I + a] + s->G[component[a][I]]) / (a == I ? 2 : root_2);
    }
  }
  mean = (s->elastic[0] + s->elastic[1] + s->elastic[2]) / 3;
  for (int a = 0; a < 3; a++) s->elastic[a] -= mean;
}

/* Adds factor times the second derivative of a squared distance in small strains. AddTurns() adds what finite strains
   have more. */
LANES_INLINE void AddDistance(const Lanes *factor, Lanes hessian[6][6])
{
  for (int k = 0; k < 6; k++) {
    hessian[k][k] += 2 * *factor;
    for (int l = 0; l < 3 && k < 3; l++) hessian[k][l] -= 2 * *factor / 3;
  }
}

/* x / tanh(x) - 1 */
LANES_INLINE Lanes TurnFactor(const Lanes *a, const Lanes *b)
{
  Lanes turn;

  for (int lane = 0; lane < LANES; lane++) {
    const double x = (*a)[lane] - (*b)[lane];

    turn[lane] = x == 0 ? 0 : x / tanh(x) - 1;
  }
  return turn;
}

static void AddTurns(const Lanes *factor, const Distance *d, Lanes hessian[6][6])
{
  for (int pair = 0; pair < 3; pair++) {
    const int   a = pair_of[pair][0], b = pair_of[pair][1];
    const Lanes turn = 2 * *factor * TurnFactor(&d->value[a], &d->value[b]), one = (Lanes){0} + root_2;
    Lanes       S[6] = {{0}};

    AxisDyad(d->axis[a], d->axis[b], &one, S);
    for (int k = 0; k < 6; k++) {
      for (int l = 0; l < 6; l++) hessian[k][l] += turn * S[k] * S[l];
    }
  }
}

/* Adds the elastic part. */
static void AddElastic(Plastic *s)
{
  s->potential = *s->shear * Dot(s->elastic, s->elastic);
  for (int k = 0; k < 6; k++) s->gradient[k] = -2 * *s->shear * s->elastic[k];
  AddDistance(s->shear, s->hessian);
  for (int pair = 0; pair < 3 && s->finite; pair++)
    s->hessian[3 + pair][3 + pair] +=
      2 * *s->shear * TurnFactor(&s->x.strain[pair_of[pair][0]], &s->x.strain[pair_of[pair][1]]);
  for (int k = 0; k < 3; k++) { /* the trace of delta is nothing, and has a stiffness to be so */
    for (int l = 0; l < 3; l++) s->hessian[k][l] += 2 * *s->shear / 3;
  }
}

/* Adds a backstress. curve is the second derivative of the potential by p alone. */
static void AddTerm(int k, Plastic *s, const Lanes N[6], Lanes *curve)
{
  const double    C = s->hardening->backstress[k][0];
  const Distance *d = &s->term[k];
  Lanes           factor, cross;

  for (int lane = 0; lane < LANES; lane++) {
    const Recovery r    = SetRecovery(C, s->hardening->backstress[k][1], s->p[lane]);
    const double   more = C / 3 * (d->square[lane] - s->before[k][lane]);

    factor[lane] = r.w * C / 3;
    cross[lane]  = r.w1 * 2 * C / 3;
    s->stored[lane] += r.w * more + r.h;
    s->drag[lane] += r.w1 * more + r.h1;
    (*curve)[lane] += r.w2 * more + r.h2;
  }
  AddDistance(&factor, s->hessian);
  if (s->finite) AddTurns(&factor, d, s->hessian);
  for (int i = 0; i < 6; i++) {
    s->gradient[i] += 2 * factor * d->strain[i];
    for (int j = 0; j < 6; j++) s->hessian[i][j] += cross * (d->strain[i] * N[j] + N[i] * d->strain[j]);
  }
}

/* Adds what depends on p alone: yield stress, overstress, and the curvature of p itself. N is the gradient of p. */
static void AddFlow(Plastic *s, const Lanes N[6], Lanes *curve)
{
  Lanes bend, size = {0};

  for (int lane = 0; lane < LANES; lane++) {
    const double before = s->state[PLASTIC_STRAIN][lane], p = s->p[lane];
    double       slope, work, work_0, more, viscous;

    HardeningStress(s->hardening, before, &slope, &work_0);
    s->drag[lane] += HardeningStress(s->hardening, before + p, &slope, &work);
    s->viscous[lane] = HardeningOverstress(s->hardening, p, s->dt, &more, &viscous);
    s->drag[lane] += s->viscous[lane];
    s->viscous[lane] *= p;
    s->potential[lane] += work - work_0 + viscous;
    bend[lane] = p > 0 ? s->drag[lane] / p : 0;
    (*curve)[lane] += slope + more - bend[lane];
  }
  s->potential += s->stored;
  for (int k = 0; k < 6; k++) size += s->gradient[k] * s->gradient[k];
  for (int lane = 0; lane < LANES; lane++) s->scale[lane] += sqrt(size[lane]) + s->drag[lane];
  for (int i = 0; i < 6; i++) {
    s->gradient[i] += s->drag * N[i];
    for (int j = 0; j < 6; j++) s->hessian[i][j] += *curve * N[i] * N[j];
  }
  bend /= 3;
  AddDistance(&bend, s->hessian);
  if (s->finite) AddTurns(&bend, &s->flow, s->hessian);
}

/* Evaluates the potential and its derivatives at the present G. */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, Plastic *s)
{
  Lanes N[6], other[6], curve = {0};

  for (int k = 0; k < 6; k++) {
    s->G[k]  = s->state[k] + s->change[k];
    other[k] = -s->change[k];
  }
  SetFrame(H, dilatation, s);
  SetDistance(s, other, &s->flow);
  for (int lane = 0; lane < LANES; lane++) s->p[lane] = sqrt(2 * s->flow.square[lane] / 3);
  for (int k = 0; k < 6; k++) {
    for (int lane = 0; lane < LANES; lane++)
      N[k][lane] = s->p[lane] > 0 ? 2 * s->flow.strain[k][lane] / (3 * s->p[lane]) : 0;
  }
  s->drag = s->stored = (Lanes){0};
  memset(s->hessian, 0, sizeof s->hessian);
  AddElastic(s);
  s->scale = 2 * *s->shear * (double)DBL_EPSILON; /* so that it is not 0 */
  for (int k = 0; k < s->hardening->terms; k++) {
    for (int i = 0; i < 6; i++) other[i] = s->state[PLASTIC_BACKSTRESS + 6 * k + i] - s->state[i] - s->change[i];
    SetDistance(s, other, &s->term[k]);
    AddTerm(k, s, N, &curve);
  }
  AddFlow(s, N, &curve);
}

/* Factors the Hessian as L D L^T; L stands below the diagonal and 1 / D on it. */
static void Factor(Lanes A[6][6])
{
  for (int k = 0; k < 6; k++) {
    A[k][k] = 1 / A[k][k];
    for (int i = k + 1; i < 6; i++) {
      const Lanes l = A[i][k] * A[k][k];

      for (int j = k + 1; j <= i; j++) A[i][j] -= l * A[j][k];
    }
    for (int i = k + 1; i < 6; i++) A[i][k] *= A[k][k];
  }
}

LANES_INLINE void SolveLower(const Lanes A[6][6], Lanes y[6])
{
  for (int k = 0; k < 6; k++) {
    for (int i = k + 1; i < 6; i++) y[i] -= A[i][k] * y[k];
  }
}

static void Solve(const Lanes A[6][6], Lanes y[6])
{
  SolveLower(A, y);
  for (int k = 5; k >= 0; k--) {
    y[k] *= A[k][k];
    for (int i = k + 1; i < 6; i++) y[k] -= A[i][k] * y[i];
  }
}

/* Computes B (exp(2 strain) - 1) B^T, in small strains 2 strain, in tensor components. */
static void Exponential(const Plastic *s, const Lanes B[3][3], const Lanes strain[6], Lanes change[6])
{
  Lanes T[6], value[3], axis[3][3];

  for (int k = 0; k < 6; k++) T[k] = strain[k] / (k < 3 ? 1 : root_2);
  if (!s->finite) {
    for (int k = 0; k < 6; k++) change[k] = 2 * T[k];
    return;
  }
  PrincipalAxes(T, value, axis);
  for (int k = 0; k < 6; k++) change[k] = (Lanes){0};
  for (int a = 0; a < 3; a++) {
    Lanes v[3];

    for (int lane = 0; lane < LANES; lane++) value[a][lane] = expm1(2 * value[a][lane]);
    for (int I = 0; I < 3; I++) v[I] = B[I][0] * axis[a][0] + B[I][1] * axis[a][1] + B[I][2] * axis[a][2];
    for (int I = 0; I < 3; I++) {
      for (int J = I; J < 3; J++) change[component[I][J]] += value[a] * v[I] * v[J];
    }
  }
}

/* State of Newton's method: the last point that was better than the one before, and the step from there */
typedef struct {
  Lanes potential, residual;
  Lanes change[6], B[3][3], step[6];
  int   active[LANES], left;
} Search;

/* Finds the lanes that flow, and their first step: along the trial stress. */
static void Begin(Plastic *s, Search *x)
{
  Lanes square = Dot(s->gradient, s->gradient);

  memset(x, 0, sizeof *x);
  memcpy(x->B, s->B, sizeof x->B);
  for (int lane = 0; lane < LANES; lane++) {
    const double before = s->state[PLASTIC_STRAIN][lane], trial = sqrt(1.5 * square[lane]);
    double       slope, work, way, stiffness = 3 * (*s->shear)[lane];
    const double yield = HardeningStress(s->hardening, before, &slope, &work);

    x->potential[lane] = x->residual[lane] = DBL_MAX;
    x->active[lane] = trial > yield + yield_round_off * s->scale[lane] && PlasticFlows(s->hardening, s->dt);
    x->left += x->active[lane];
    if (!x->active[lane]) continue;
    for (int k = 0; k < s->hardening->terms; k++) stiffness += s->hardening->backstress[k][0];
    way = 1.5 * HardeningReturn(s->hardening, before, s->dt, trial, stiffness) / trial;
    for (int k = 0; k < 6; k++) x->step[k][lane] = -way * s->gradient[k][lane];
  }
}

/* Judges the present point and sets the next step of a lane: Newton's, or half of the last one. */
static void Judge(const Plastic *s, const Lanes newton[6], const Lanes *residual, int lane, Search *x)
{
  const double limit = x->potential[lane] + potential_round_off * fabs(s->potential[lane]);
  const int    better =
    s->potential[lane] <= limit || (*residual)[lane] < x->residual[lane]; /* false where it is not a number */

  if (!better) {
    for (int k = 0; k < 6; k++) x->step[k][lane] /= 2;
    return;
  }
  if ((*residual)[lane] <= solved * s->scale[lane] ||
      ((*residual)[lane] <= nearly_solved * s->scale[lane] && (*residual)[lane] > x->residual[lane] / 2)) {
    x->active[lane] = 0;
    x->left--;
    return;
  }
  x->potential[lane] = s->potential[lane];
  x->residual[lane]  = (*residual)[lane];
  for (int k = 0; k < 6; k++) {
    x->change[k][lane] = s->change[k][lane];
    x->step[k][lane]   = -newton[k][lane];
  }
  for (int k = 0; k < 9; k++) x->B[k / 3][k % 3][lane] = s->B[k / 3][k % 3][lane];
}

/* Moves the active lanes by their steps. */
static void Move(Plastic *s, const Search *x)
{
  Lanes minus[6], change[6];

  for (int k = 0; k < 6; k++) minus[k] = -x->step[k];
  Exponential(s, x->B, minus, change);
  for (int k = 0; k < 6; k++) {
    for (int lane = 0; lane < LANES; lane++)
      if (x->active[lane]) s->change[k][lane] = x->change[k][lane] + change[k][lane];
  }
}

/* Finds the G of least potential. Lanes that do not flow keep theirs, so that no lane depends on the others. Lanes that
   are not solved get a potential that is not a number. */
static void Minimise(const Lanes H[9], const Lanes *dilatation, Plastic *s)
{
  Search x;

  memset(s->change, 0, sizeof s->change);
  Evaluate(H, dilatation, s);
  for (int k = 0; k < s->hardening->terms; k++) {
    s->before[k] = s->term[k].square;
    s->stored -= s->hardening->backstress[k][0] / 3 * s->before[k];
    s->potential -= s->hardening->backstress[k][0] / 3 * s->before[k];
  }
  Begin(s, &x);
  for (int i = 0; i < MAX_ITERATIONS && x.left; i++) {
    Lanes newton[6], residual;

    Move(s, &x);
    Evaluate(H, dilatation, s);
    residual = Dot(s->gradient, s->gradient);
    for (int lane = 0; lane < LANES; lane++) residual[lane] = sqrt(residual[lane]);
    memcpy(newton, s->gradient, sizeof newton);
    Factor(s->hessian);
    Solve(s->hessian, newton);
    for (int lane = 0; lane < LANES; lane++)
      if (x.active[lane]) Judge(s, newton, &residual, lane, &x);
  }
  for (int lane = 0; lane < LANES; lane++)
    if (x.active[lane]) s->potential[lane] = NAN;
}

/* Takes off the tangent what the change of G releases. */
static void AddRelease(const Plastic *s, Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes C[9][6], D[9][6];

  for (int r = 0; r < 9; r++) {
    Lanes T[3][3], mean;

    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) T[a][b] = s->x.axis[a][r / 3] * s->x.pulled[b][r % 3];
    mean = (T[0][0] + T[1][1] + T[2][2]) / 3;
    for (int a = 0; a < 3; a++) C[r][a] = -2 * *s->shear * (T[a][a] - mean);
    for (int pair = 0; pair < 3; pair++) {
      const int a = pair_of[pair][0], b = pair_of[pair][1];
      Lanes     turn;

      for (int lane = 0; lane < LANES; lane++) {
        const double x = s->finite ? s->x.strain[a][lane] - s->x.strain[b][lane] : 0;

        turn[lane] = x == 0 ? 1 : x / sinh(x);
      }
      C[r][3 + pair] = -2 * *s->shear * turn * (T[a][b] + T[b][a]) / root_2;
    }
    SolveLower(s->hessian, C[r]);
    for (int k = 0; k < 6; k++) D[r][k] = C[r][k] * s->hessian[k][k];
  }
  for (int r = 0, k = 0; r < 9; r++) {
    for (int t = r; t < 9; t++, k++) {
      const Lanes release = Dot(C[r], D[t]);

      for (int lane = 0; lane < LANES; lane++) A[k][lane] -= s->p[lane] > 0 ? release[lane] : 0;
    }
  }
}

/* Lets the backstresses recover, and puts the stress on the yield surface again. */
static void NextTerms(const Plastic *s, Lanes next[])
{
  Lanes strain[HARDENING_MAX_TERMS][6], beyond[6], size, share = {0}, excess = {0};

  for (int i = 0; i < 6; i++) beyond[i] = 2 * *s->shear * s->elastic[i];
  for (int k = 0; k < s->hardening->terms; k++) {
    const double C = s->hardening->backstress[k][0], gamma = s->hardening->backstress[k][1];
    Lanes        left, mean;

    for (int lane = 0; lane < LANES; lane++) {
      left[lane] = exp(-gamma * s->p[lane]);
      mean[lane] = SetRecovery(C, gamma, s->p[lane]).w;
    }
    for (int i = 0; i < 6; i++) {
      strain[k][i] = left * s->term[k].strain[i] + (mean - left) * s->flow.strain[i];
      beyond[i] -= 2 * C / 3 * strain[k][i];
    }
    share += C * gamma;
  }
  size = Dot(beyond, beyond);
  for (int lane = 0; lane < LANES; lane++) {
    double       slope, work;
    const double strength = HardeningStress(s->hardening, s->state[PLASTIC_STRAIN][lane] + s->p[lane], &slope, &work) +
                            HardeningOverstress(s->hardening, s->p[lane], s->dt, &slope, &work);

    if (s->p[lane] > 0 && share[lane] > 0) excess[lane] = 1 - strength / sqrt(1.5 * size[lane]);
  }
  for (int k = 0; k < s->hardening->terms; k++) {
    Lanes *const rest = &next[PLASTIC_BACKSTRESS + 6 * k], change[6];

    for (int i = 0; i < 6; i++)
      strain[k][i] += share[0] > 0 ? 1.5 * s->hardening->backstress[k][1] / share * excess * beyond[i] : (Lanes){0};
    Exponential(s, s->B, strain[k], change);
    for (int i = 0; i < 6; i++) {
      for (int lane = 0; lane < LANES; lane++)
        rest[i][lane] =
          s->p[lane] > 0 ? s->G[i][lane] + change[i][lane] : s->state[PLASTIC_BACKSTRESS + 6 * k + i][lane];
    }
  }
}

static void FiniteStress(const Lanes *bulk, const Lanes *shear, Trial *x, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Return held = {.theta = (Lanes){0} + 1};
  const Lanes  none = {0};

  for (int a = 0; a < 3; a++) x->stress[a] = *bulk * x->log_J + 2 * *shear * x->deviator[a];
  PrincipalStress(x, P);
  if (A) FiniteTangent(bulk, shear, &none, &held, x, A);
}

static void SmallStress(const Lanes *bulk, const Lanes *trace, const Plastic *s, Lanes P[9],
                        Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Return held    = {.theta = (Lanes){0} + 1};
  const Lanes  none[9] = {{0}};

  for (int k = 0; k < 9; k++)
    P[k] = 2 * *s->shear * s->elastic[component[k / 3][k % 3]] / (k % 4 ? root_2 : 1) +
           *bulk * *trace * (double)(k % 4 == 0);
  if (A) SmallTangent(bulk, s->shear, &none[0], &held, none, A);
}

/*@
  BackstressLaw - computes what VonMisesLaw() does, for laws with backstresses.

  Not collective

  Note:
  Arguments as there.
@*/
void BackstressLaw(int finite, const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                   const Hardening *hardening, double dt, const Lanes state[], Lanes *W, Lanes P[9],
                   Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[])
{
  const Lanes trace = H[0] + H[4] + H[8];
  Plastic     s     = {.finite = finite, .dt = dt, .hardening = hardening, .state = state, .shear = shear};

  Minimise(H, dilatation, &s);
  if (W) {
    const Lanes volume = finite ? s.x.log_J : trace;

    *W = s.potential + *bulk * volume * volume / 2 + state[PLASTIC_WORK];
    for (int lane = 0; lane < LANES; lane++) {
      double slope, work;

      HardeningStress(hardening, state[PLASTIC_STRAIN][lane], &slope, &work);
      (*W)[lane] += work;
    }
  }
  if (P && finite)
    FiniteStress(bulk, shear, &s.x, P, A);
  else if (P)
    SmallStress(bulk, &trace, &s, P, A);
  for (int r = 0; r < 9 && P; r++) P[r] += 0 * s.potential; /* not a number where the equations are not solved */
  if (P && A) AddRelease(&s, A);
  if (!next) return;
  NextTerms(&s, next);
  for (int k = 0; k < 6; k++) next[k] = s.G[k];
  next[PLASTIC_STRAIN] = state[PLASTIC_STRAIN] + s.p;
  next[PLASTIC_WORK]   = state[PLASTIC_WORK] + s.stored + s.viscous;
}
