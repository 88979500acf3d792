/* Von Mises plasticity: trial state, return mapping in principal or Cartesian components, stress, tangent, new state.
 */
#include "kernels/vonmises.h"
#include "lameconstants.h"
#include "principal.h"
#include <float.h>
#include <math.h>
#include <stddef.h>

/* Smallest principal value of F Cp^-1 F^T whose logarithm is taken; smaller ones are replaced by it, as determinants
   below MATERIAL_LEAST_J are. */
static const double least_square = MATERIAL_LEAST_J * MATERIAL_LEAST_J;
/* A trial stress yields when it exceeds the yield stress by this part. An accepted state lies on the yield surface up
   to round-off and must be elastic when it is evaluated again. */
static const double yield_round_off = 1e-12;

/* What the return mapping of a trial state gives, the same in small and finite strains */
typedef struct {
  Lanes theta; /* deviatoric stress over that of the trial state */
  Lanes fall;  /* part by which the tangent along the trial stress is smaller: theta minus it is the tangent there */
  Lanes increment; /* of the equivalent plastic strain */
  Lanes W;         /* deviatoric part of the incremental potential */
} Return;

/* Returns from the deviatoric trial strain whose square is `square`. */
LANES_INLINE void ReturnMap(const Hardening *hardening, const Lanes *shear, const Lanes *square, const Lanes *before,
                            Return *r)
{
  for (int lane = 0; lane < LANES; lane++) {
    const double mu = (*shear)[lane], old = (*before)[lane];
    const double trial = mu * sqrt(6 * (*square)[lane]); /* equivalent stress */
    double       slope, work, x = 0;
    const double yield = HardeningStress(hardening, old, &slope, &work);

    r->theta[lane] = 1;
    r->fall[lane]  = 0;
    if (trial > yield * (1 + yield_round_off)) {
      x = HardeningReturn(hardening, old, trial, 3 * mu);
      HardeningStress(hardening, old + x, &slope, &work);
      r->theta[lane] = 1 - 3 * mu * x / trial;
      r->fall[lane]  = r->theta[lane] - slope / (3 * mu + slope);
    }
    r->increment[lane] = x;
    r->W[lane]         = mu * r->theta[lane] * r->theta[lane] * (*square)[lane] + work;
  }
}

/* Components of a symmetric tensor: xx yy zz xy yz xz */
static const int component[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/* The trial state in finite strains */
typedef struct {
  Lanes square[3];    /* principal values of b = F Cp^-1 F^T */
  Lanes strain[3];    /* half their logarithms */
  Lanes axis[3][3];   /* n: principal axes of b */
  Lanes pulled[3][3]; /* F^-1 n */
  Lanes deviator[3];  /* of the logarithmic strains */
  Lanes stress[3];    /* principal Kirchhoff stresses after the return */
  Lanes log_J;
} Trial;

/* Computes principal values and axes of F Cp^-1 F^T. Its difference to 1 is formed, so that small strains keep their
   digits. */
LANES_INLINE void TrialState(const Lanes H[9], const Lanes *dilatation, const Lanes state[PLASTIC_STATE], Trial *x)
{
  Lanes FC[9], b[6], mean;

  for (int i = 0; i < 3; i++) { /* F (Cp^-1 - 1) */
    for (int J = 0; J < 3; J++) {
      FC[3 * i + J] = state[component[i][J]];
      for (int K = 0; K < 3; K++) FC[3 * i + J] += H[3 * i + K] * state[component[K][J]];
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      Lanes sum = H[3 * i + j] + H[3 * j + i] + FC[3 * i + j];

      for (int K = 0; K < 3; K++) sum += (H[3 * i + K] + FC[3 * i + K]) * H[3 * j + K];
      b[component[i][j]] = sum;
    }
  }
  PrincipalAxes(b, x->square, x->axis);
  for (int lane = 0; lane < LANES; lane++) {
    x->log_J[lane] = log1p(fmax((*dilatation)[lane], MATERIAL_LEAST_J - 1));
    for (int a = 0; a < 3; a++) {
      const double excess = fmax(x->square[a][lane], least_square - 1);

      x->square[a][lane] = 1 + excess;
      x->strain[a][lane] = log1p(excess) / 2;
    }
  }
  mean = (x->strain[0] + x->strain[1] + x->strain[2]) / 3;
  for (int a = 0; a < 3; a++) x->deviator[a] = x->strain[a] - mean;
  for (int i = 0; i < 9; i++) FC[i] += H[i] + (double)(i % 4 == 0); /* F Cp^-1 */
  for (int a = 0; a < 3; a++) {                                     /* F^-1 n = Cp^-1 F^T n / b */
    for (int I = 0; I < 3; I++)
      x->pulled[a][I] = (FC[I] * x->axis[a][0] + FC[3 + I] * x->axis[a][1] + FC[6 + I] * x->axis[a][2]) / x->square[a];
  }
}

/* A += factor * v w^T + w v^T, or v v^T where v is w */
LANES_INLINE void AddDyad(const Lanes *factor, const Lanes v[9], const Lanes w[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  for (int r = 0, k = 0; r < 9; r++) {
    const Lanes vr = *factor * v[r], wr = *factor * w[r];

    for (int s = r; s < 9; s++, k++) A[k] += v == w ? vr * v[s] : vr * w[s] + wr * v[s];
  }
}

/* x / (exp(2 x) - 1), which is 1/2 at 0 */
static inline double ShearFactor(double x)
{
  return x == 0 ? 0.5 : x / expm1(2 * x);
}

/* Tangent in the frame of the principal axes: A = sum_abcd a_abcd (n_a x F^-1 n_b) (n_c x F^-1 n_d). The factors
   between two axes do not divide by the difference of their strains, because stress differences are strain differences
   times 2 shear theta. */
LANES_INLINE void FiniteTangent(const Lanes *bulk, const Lanes *shear, const Lanes *square, const Return *r,
                                const Trial *x, Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes zero = {0}, along = 2 * *shear * r->theta;
  Lanes       T[3][3][9], inverse;

  for (int k = 0; k < MATERIAL_TANGENT_SIZE; k++) A[k] = zero;
  for (int lane = 0; lane < LANES; lane++) inverse[lane] = (*square)[lane] > 0 ? 1 / (*square)[lane] : 0;
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) {
      for (int k = 0; k < 9; k++) T[a][b][k] = x->axis[a][k / 3] * x->pulled[b][k % 3];
    }
  }
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++) { /* change of stress a with strain b, then the shear of both axes */
      Lanes normal = *bulk - along / 3 - 2 * *shear * r->fall * inverse * x->deviator[a] * x->deviator[b];
      Lanes factor, other, shear_ab;

      if (a == b) {
        normal += along - x->stress[a];
        AddDyad(&normal, T[a][a], T[a][a], A);
        continue;
      }
      AddDyad(&normal, T[a][a], T[b][b], A);
      for (int lane = 0; lane < LANES; lane++)
        factor[lane] = along[lane] * ShearFactor(x->strain[a][lane] - x->strain[b][lane]);
      shear_ab = factor - x->stress[b];
      other    = shear_ab + x->stress[a];
      AddDyad(&factor, T[a][b], T[a][b], A);
      AddDyad(&other, T[b][a], T[b][a], A);
      AddDyad(&shear_ab, T[a][b], T[b][a], A);
    }
  }
}

/* New Cp^-1 = F^-1 b F^-T with the elastic b after the return. Its change is formed, which is zero where nothing flows.
 */
LANES_INLINE void FiniteState(const Lanes state[PLASTIC_STATE], const Return *r, const Trial *x,
                              Lanes next[PLASTIC_STATE])
{
  Lanes change[3];

  for (int a = 0; a < 3; a++) {
    for (int lane = 0; lane < LANES; lane++)
      change[a][lane] = x->square[a][lane] * expm1(2 * (r->theta[lane] - 1) * x->deviator[a][lane]);
  }
  for (int I = 0; I < 3; I++) {
    for (int J = I; J < 3; J++) {
      Lanes sum = state[component[I][J]];

      for (int a = 0; a < 3; a++) sum += change[a] * x->pulled[a][I] * x->pulled[a][J];
      next[component[I][J]] = sum;
    }
  }
  next[PLASTIC_STRAIN] = state[PLASTIC_STRAIN] + r->increment;
}

static void FiniteLaw(const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                      const Hardening *hardening, const Lanes state[PLASTIC_STATE], Lanes *W, Lanes P[9],
                      Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[PLASTIC_STATE])
{
  Lanes  square;
  Return r;
  Trial  x;

  TrialState(H, dilatation, state, &x);
  square = x.deviator[0] * x.deviator[0] + x.deviator[1] * x.deviator[1] + x.deviator[2] * x.deviator[2];
  ReturnMap(hardening, shear, &square, &state[PLASTIC_STRAIN], &r);
  if (W) *W = *bulk * x.log_J * x.log_J / 2 + r.W;
  if (next) FiniteState(state, &r, &x, next);
  if (!P) return;
  for (int a = 0; a < 3; a++) x.stress[a] = *bulk * x.log_J + 2 * *shear * r.theta * x.deviator[a];
  for (int k = 0; k < 9; k++) {
    P[k] = x.stress[0] * x.axis[0][k / 3] * x.pulled[0][k % 3];
    for (int a = 1; a < 3; a++) P[k] += x.stress[a] * x.axis[a][k / 3] * x.pulled[a][k % 3];
  }
  if (A) FiniteTangent(bulk, shear, &square, &r, &x, A);
}

static void SmallTangent(const Lanes *bulk, const Lanes *shear, const Lanes *square, const Return *r,
                         const Lanes deviator[9], Lanes A[MATERIAL_TANGENT_SIZE])
{
  const Lanes mu = *shear * r->theta, lambda = *bulk - 2 * mu / 3;
  Lanes       factor;

  for (int lane = 0; lane < LANES; lane++)
    factor[lane] = (*square)[lane] > 0 ? -2 * (*shear)[lane] * r->fall[lane] / (*square)[lane] : 0;
  for (int s = 0, k = 0; s < 9; s++) {
    for (int t = s; t < 9; t++, k++) {
      const int i = s / 3, I = s % 3, j = t / 3, J = t % 3;

      A[k] = lambda * (double)(i == I && j == J) + mu * (double)((i == j && I == J) + (i == J && j == I));
    }
  }
  AddDyad(&factor, deviator, deviator, A);
}

static void SmallLaw(const Lanes H[9], const Lanes *bulk, const Lanes *shear, const Hardening *hardening,
                     const Lanes state[PLASTIC_STATE], Lanes *W, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE],
                     Lanes next[PLASTIC_STATE])
{
  const Lanes trace = H[0] + H[4] + H[8];
  Lanes       deviator[9], mean, square = {0};
  Return      r;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) deviator[3 * i + j] = 0.5 * (H[3 * i + j] + H[3 * j + i] + state[component[i][j]]);
  }
  mean = (deviator[0] + deviator[4] + deviator[8]) / 3;
  for (int i = 0; i < 3; i++) deviator[4 * i] -= mean;
  for (int k = 0; k < 9; k++) square += deviator[k] * deviator[k];
  ReturnMap(hardening, shear, &square, &state[PLASTIC_STRAIN], &r);
  if (W) *W = *bulk * trace * trace / 2 + r.W;
  for (int k = 0; k < 9 && P; k++) P[k] = 2 * *shear * r.theta * deviator[k] + *bulk * trace * (double)(k % 4 == 0);
  if (A) SmallTangent(bulk, shear, &square, &r, deviator, A);
  if (!next) return;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      next[component[i][j]] = state[component[i][j]] - 2 * (1 - r.theta) * deviator[3 * i + j];
  }
  next[PLASTIC_STRAIN] = state[PLASTIC_STRAIN] + r.increment;
}

/*@
  VonMisesLaw - computes incremental potential, stress and tangent of LANES points, and the state after the increment.

  Not collective

  Input Parameters:
+ finite     - 0 for small strains
. H          - displacement gradient F - 1 at 3 i + I
. dilatation - det F - 1 from MaterialDilatation(); not used in small strains
. bulk       - bulk modulus (stress); 0 leaves out the volume part
. shear      - shear modulus (stress)
. hardening  - yield stress over equivalent plastic strain
- state      - the accepted state [PLASTIC_STATE]

  Output Parameters:
+ W    - elastic energy plus all plastic work from the virgin state on, per reference volume, or NULL
. P    - first Piola-Kirchhoff stress; with small strains the stress, or NULL
. A    - tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), r <= s, or NULL; it needs P
- next - the state at H, or NULL; it may be the same array as state

  Note:
  W is continuous where a state is accepted. The output is finite for every finite H.
@*/
void VonMisesLaw(int finite, const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                 const Hardening *hardening, const Lanes state[PLASTIC_STATE], Lanes *W, Lanes P[9],
                 Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[PLASTIC_STATE])
{
  if (finite)
    FiniteLaw(H, dilatation, bulk, shear, hardening, state, W, P, A, next);
  else
    SmallLaw(H, bulk, shear, hardening, state, W, P, A, next);
}

/* The elastic part: Hencky's law */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  static const Hardening never                 = {.yield = DBL_MAX};
  const Lanes            virgin[PLASTIC_STATE] = {{0}};

  (void)n;
  FiniteLaw(H, dilatation, &constants[0], &constants[1], &never, virgin, W, P, A, NULL);
}

const ElasticLaw MaterialLaw_VonMises = {.evaluate  = Evaluate,
                                         .shear     = MaterialLameShear,
                                         .constants = 2,
                                         .separable = 1,
                                         .isochoric = 1,
                                         .keys      = {"mu"},
                                         .required  = 1,
                                         .plastic   = 1};
