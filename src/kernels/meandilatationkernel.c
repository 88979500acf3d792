/* Mean dilatation, the formulation `fbar`. The law is evaluated at F' = (J'/J)^(1/3) F, where J' is the element's mean
   of J = det F. Nearly incompressible solids then do not lock.

   Energy, force and tangent are those of the energy W(F'). With a law that splits volume and shape this is the mean
   dilatation method (Nagtegaal, Parks and Rice 1974; Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element
   Analysis", section 8.6.5). In small strains it is the B-bar element (Hughes 1980). The F-bar element of de Souza Neto
   et al. (1996) uses the same F' without its variation and has no energy.

   Plastic elements have an energy of what J is at the points besides its mean, see volumehold.h.

   St. Venant-Kirchhoff's law is nearly incompressible in small strains only. It resists the trace of Green's strain
   instead of J, and locks a little at large strains. */
#include "elementbatch.h"
#include "volumehold.h"
#include <math.h>
#include <stddef.h>

enum { MAX_NODES = 8, MAX_POINTS = 8 };
_Static_assert((int)MAX_POINTS <= (int)CHUNK, "all points in one chunk");

typedef struct {
  ChunkPoints c;
  Lanes       volume[MAX_POINTS];
  Lanes       H[MAX_POINTS][9];
  Lanes       dilatation[MAX_POINTS]; /* J - 1; with small strains the trace */
  Lanes       mean;                   /* of the dilatation over the reference volume */
  Lanes       P[MAX_POINTS][9];       /* of the law, at F' */
  Lanes       total;                  /* reference volume */
} MeanDilatation;

LANES_INLINE void Prepare(const BatchCall *call, const int n, const int points, const int dim, const int hoop,
                          MeanDilatation *x)
{
  const Element *e = call->e;

  x->mean = x->total = (Lanes){0};
  for (int q = 0; q < points; q++) {
    PointGradients(n, dim, hoop, e->N[q], e->dN[q], e->weight[q], q, call->X, &x->c, &x->volume[q]);
    PointDisplacementGradient(n, dim, hoop, q, call->u, &x->c, x->H[q]);
    if (call->finite)
      MaterialDilatation(x->H[q], &x->dilatation[q]);
    else
      x->dilatation[q] = x->H[q][0] + x->H[q][4] + x->H[q][8];
    KeepLeastJ(call, &x->dilatation[q]);
    x->mean += x->dilatation[q] * x->volume[q];
    x->total += x->volume[q];
  }
  x->mean /= x->total;
}

/* Computes F' - 1 at a point and factor = (J'/J)^(1/3) - 1. With small strains both are linearised. */
LANES_INLINE void MeanGradient(const BatchCall *call, int q, const MeanDilatation *x, Lanes H[9], Lanes *factor)
{
  Lanes stretch;

  for (int lane = 0; lane < LANES; lane++)
    stretch[lane] =
      call->finite
        ? expm1((log1p(FlooredDilatation(x->mean[lane])) - log1p(FlooredDilatation(x->dilatation[q][lane]))) / 3)
        : (x->mean[lane] - x->dilatation[q][lane]) / 3;
  *factor = stretch * (double)call->finite;
  for (int r = 0; r < 9; r++) H[r] = x->H[q][r] + *factor * x->H[q][r];
  for (int i = 0; i < 3; i++) H[4 * i] += stretch;
}

/* Computes F, G = F^-T and J. With small strains they are those of the undeformed state. */
LANES_INLINE void PointMotion(const BatchCall *call, int q, const MeanDilatation *x, Lanes F[9], Lanes G[9], Lanes *J)
{
  Lanes H[9];

  for (int r = 0; r < 9; r++) H[r] = x->H[q][r] * (double)call->finite;
  for (int r = 0; r < 9; r++) F[r] = H[r] + (double)(r % 4 == 0);
  for (int lane = 0; lane < LANES; lane++)
    (*J)[lane] = 1 + (call->finite ? FlooredDilatation(x->dilatation[q][lane]) : 0);
  Cofactors(H, G);
  for (int r = 0; r < 9; r++) G[r] /= *J;
}

LANES_INLINE Lanes Contract(const Lanes A[9], const Lanes B[9])
{
  Lanes sum = A[0] * B[0];

  for (int r = 1; r < 9; r++) sum += A[r] * B[r];
  return sum;
}

/* Second variation of W(F') at a point. A holds the law's tangent on entry and the part quadratic in dF on return. Q is
   the part that couples dF to the variation of ln J'. square is the factor of the square of that variation. P is the
   law's stress and pressure that of the element's geometric part. The terms with `geometry` vanish in small strains. */
LANES_INLINE void PointTangent(const Lanes F[9], const Lanes G[9], const Lanes *J, const Lanes *factor,
                               const Lanes *pressure, double geometry, const Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE],
                               Lanes Q[9], Lanes *square)
{
  const Lanes s = 1 + *factor, t = geometry * s * Contract(P, F) / 3, p = geometry * *pressure * *J;
  Lanes       AF[9], Y[9], FAF, GG;

  for (int r = 0; r < 9; r++) {
    AF[r] = TANGENT(A, r, 0) * F[0];
    for (int k = 1; k < 9; k++) AF[r] += TANGENT(A, r, k) * F[k];
  }
  FAF = Contract(F, AF);
  for (int r = 0; r < 9; r++) Y[r] = (s * s * AF[r] + geometry * s * P[r]) / 3;
  *square = s * s * FAF / 9 + t / 3;
  GG      = *square + p;
  for (int r = 0; r < 9; r++) Q[r] = Y[r] - *square * G[r];
  for (int r = 0, k = 0; r < 9; r++) {
    for (int m = r; m < 9; m++, k++)
      A[k] = s * s * A[k] - Y[r] * G[m] - G[r] * Y[m] + GG * G[r] * G[m] +
             (t - p) * G[3 * (r / 3) + m % 3] * G[3 * (m / 3) + r % 3];
  }
}

/* Adds the part of the tangent at a point that holds J there with a modulus and a stress. */
LANES_INLINE void AddHold(const Lanes *hold, const Lanes *stress, const Lanes *J, const Lanes G[9],
                          Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes pull = *stress * *J, both = *hold * *J * *J + pull;

  for (int r = 0, k = 0; r < 9; r++)
    for (int m = r; m < 9; m++, k++)
      A[k] += both * G[r] * G[m] - pull * G[3 * (r / 3) + m % 3] * G[3 * (m / 3) + r % 3];
}

/* Makes the element's pressure that which its volume extrapolates to. `deformed` is its volume now. */
LANES_INLINE void ExtrapolatePressure(const BatchCall *call, const int n, const int points, const int dim,
                                      const int hoop, const MeanDilatation *x, const Lanes *deformed, Lanes *pressure)
{
  Lanes mean_0 = {0}, change = {0}, excess;

  for (int q = 0; q < points; q++) {
    Lanes H_0[9], dilatation_q, change_q;

    PointDisplacementGradient(n, dim, hoop, q, call->u_0, &x->c, H_0);
    ChangeOfVolume(x->H[q], H_0, &dilatation_q, &change_q);
    mean_0 += x->volume[q] * dilatation_q;
    change += x->volume[q] * change_q;
  }
  mean_0 /= x->total;
  change /= x->total;
  ExcessPressure(call, &x->mean, &mean_0, &change, &excess);
  *pressure += excess * x->total / *deformed;
}

/* Adds q m^T + m q^T + square m m^T to K. */
LANES_INLINE void AddMeanTangent(const int dofs, const double *q, const double *m, const Lanes *square, double *K)
{
  for (int r = 0; r < dofs; r++) {
    const Lanes mr = CONST_LANE(m, r), qr = CONST_LANE(q, r) + *square * mr;

    for (int s = r; s < dofs; s++) {
      const Lanes value = LANE(K, r * dofs + s) + qr * CONST_LANE(m, s) + mr * CONST_LANE(q, s);

      LANE(K, r * dofs + s) = value;
      LANE(K, s * dofs + r) = value;
    }
  }
}

/* Adds the skew part of the tangent. m: variation of ln J' */
LANES_INLINE void AddMeanSkew(const BatchCall *call, const int n, const int points, const int dim, const int hoop,
                              const MeanDilatation *x, const Lanes factor[], const double *m)
{
  for (int q = 0; q < points; q++) {
    Lanes V[MAX_NODES * 3][9], F[9], G[9], J;

    PointMotion(call, q, x, F, G, &J);
    PointGradientDerivatives(n, dim, hoop, q, &x->c, V);
    for (int s = 0; s < n * dim; s++) {
      const Lanes change = (CONST_LANE(m, s) - Contract(G, V[s])) / 3;

      for (int r = 0; r < 9; r++) V[s][r] = (1 + factor[q]) * (V[s][r] + change * F[r]);
    }
    AddSkewPoint(n * dim, V, call->skew[q], &x->volume[q], call->K);
  }
}

/* Computes energy, force and tangent. n, points, dim and hoop are constants of the instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int points, const int dim, const int hoop)
{
  double *const W = call->W, *const f = call->f, *const K = call->K;
  const double geometry = call->finite;
  const Lanes  zero     = {0};
  double       m[MAX_NODES * 3 * KERNEL_LANES],
    q_force[MAX_NODES * 3 * KERNEL_LANES]; /* m: variation of ln J'; q_force: what it is coupled to */
  const Lanes    hold     = HoldModulus(call, points);
  Lanes          pressure = {0}, deformed = {0}, square = {0}, factor[MAX_POINTS], off[MAX_POINTS], geometric;
  MeanDilatation x;

  if (W) LANE(W, 0) = zero;
  for (int i = 0; i < n * dim; i++) {
    if (f) LANE(f, i) = zero;
    LANE(m, i) = LANE(q_force, i) = zero;
  }
  StartLeastJ(call);
  Prepare(call, n, points, dim, hoop, &x);
  for (int q = 0; q < points; q++) {
    Lanes H[9], F[9], G[9], J, dilatation, energy;

    off[q] = x.dilatation[q] - x.mean;
    if (call->off) LANE(call->off, q) = off[q];
    MeanGradient(call, q, &x, H, &factor[q]);
    MaterialDilatation(H, &dilatation);
    PointLaw(call, q, H, &dilatation, W ? &energy : NULL, x.P[q], K ? x.c.A[q] : NULL);
    if (W) LANE(W, 0) += (energy + HoldEnergy(call, q, &hold, &off[q])) * x.volume[q];
    if (call->H) StorePoint(call, q, H);
    if (!f && !K) continue;
    PointMotion(call, q, &x, F, G, &J);
    pressure += x.volume[q] * (1 + factor[q]) * Contract(x.P[q], F) / 3;
    deformed += x.volume[q] * J;
  }
  if (!f && !K) return;
  pressure /= deformed;
  geometric = pressure;
  if (K && call->u_0) ExtrapolatePressure(call, n, points, dim, hoop, &x, &deformed, &geometric);
  for (int q = 0; q < points; q++) {
    const Lanes stress = HoldStress(call, q, &hold, &off[q]);
    Lanes       F[9], G[9], P[9], Q[9], J, square_q, pull;

    PointMotion(call, q, &x, F, G, &J);
    pull = (1 + factor[q]) * Contract(x.P[q], F) / 3 - (pressure + stress) * J;
    for (int r = 0; r < 9; r++) P[r] = x.volume[q] * ((1 + factor[q]) * x.P[q][r] - pull * G[r]);
    if (f) AddForce(n, dim, hoop, q, &x.c, P, f);
    if (!K) continue;
    PointTangent(F, G, &J, &factor[q], &geometric, geometry, x.P[q], x.c.A[q], Q, &square_q);
    if (call->hold) AddHold(&hold, &stress, &J, G, x.c.A[q]);
    for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) x.c.A[q][k] *= x.volume[q];
    for (int r = 0; r < 9; r++) {
      Q[r] *= x.volume[q];
      G[r] *= x.volume[q] * J / deformed;
    }
    square += x.volume[q] * (square_q - geometry * geometric * J);
    AddForce(n, dim, hoop, q, &x.c, Q, q_force);
    AddForce(n, dim, hoop, q, &x.c, G, m);
  }
  if (!K) return;
  AddTangent(n, dim, hoop, points, 1, 1, &x.c, K);
  square -= hold * deformed * deformed / x.total;
  AddMeanTangent(n * dim, q_force, m, &square, K);
  if (call->skew) AddMeanSkew(call, n, points, dim, hoop, &x, factor, m);
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

BatchFn *const mean_dilatation_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_HEX8]  = {BatchHex8, NULL},
};
