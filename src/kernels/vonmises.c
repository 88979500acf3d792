/* Von Mises plasticity: trial state, return mapping in principal or Cartesian components, stress, tangent, new state.
 */
#include "kernels/vonmises.h"
#include "backstress.h"
#include "lameconstants.h"
#include "plasticpoint.h"
#include <float.h>
#include <math.h>
#include <stddef.h>

/* Returns from the deviatoric trial strain whose square is `square`. */
LANES_INLINE void ReturnMap(const Hardening *hardening, double dt, const Lanes *shear, const Lanes *square,
                            const Lanes state[], Return *r)
{
  const int history = PlasticStates(hardening) > PLASTIC_WORK;

  for (int lane = 0; lane < LANES; lane++) {
    const double mu = (*shear)[lane], old = state[PLASTIC_STRAIN][lane];
    const double trial = mu * sqrt(6 * (*square)[lane]); /* equivalent stress */
    double       slope, work, more = 0, viscous = 0, over = 0, x = 0;
    const double yield = HardeningStress(hardening, old, &slope, &work);

    r->theta[lane] = 1;
    r->fall[lane]  = 0;
    if (trial > yield * (1 + yield_round_off) && PlasticFlows(hardening, dt)) {
      x = HardeningReturn(hardening, old, dt, trial, 3 * mu);
      HardeningStress(hardening, old + x, &slope, &work);
      over = HardeningOverstress(hardening, x, dt, &more, &viscous);
      slope += more;
      r->theta[lane] = 1 - 3 * mu * x / trial;
      r->fall[lane]  = r->theta[lane] - slope / (3 * mu + slope);
    }
    r->increment[lane] = x;
    r->work[lane]      = history ? state[PLASTIC_WORK][lane] + over * x : 0;
    r->W[lane] = mu * r->theta[lane] * r->theta[lane] * (*square)[lane] + work + r->work[lane] + viscous - over * x;
  }
}

LANES_INLINE void NextStrain(const Lanes state[], const Return *r, int history, Lanes next[])
{
  next[PLASTIC_STRAIN] = state[PLASTIC_STRAIN] + r->increment;
  if (history) next[PLASTIC_WORK] = r->work;
}

/* New Cp^-1 = F^-1 b F^-T with the elastic b after the return. Its change is formed, which is zero where nothing flows.
 */
LANES_INLINE void FiniteState(const Lanes state[], const Return *r, const Trial *x, int history, Lanes next[])
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
  NextStrain(state, r, history, next);
}

static void FiniteLaw(const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                      const Hardening *hardening, double dt, const Lanes state[], Lanes *W, Lanes P[9],
                      Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[])
{
  Lanes  square;
  Return r;
  Trial  x;

  TrialState(H, dilatation, state, &x);
  square = x.deviator[0] * x.deviator[0] + x.deviator[1] * x.deviator[1] + x.deviator[2] * x.deviator[2];
  ReturnMap(hardening, dt, shear, &square, state, &r);
  if (W) *W = *bulk * x.log_J * x.log_J / 2 + r.W;
  if (next) FiniteState(state, &r, &x, PlasticStates(hardening) > PLASTIC_WORK, next);
  if (!P) return;
  for (int a = 0; a < 3; a++) x.stress[a] = *bulk * x.log_J + 2 * *shear * r.theta * x.deviator[a];
  PrincipalStress(&x, P);
  if (A) FiniteTangent(bulk, shear, &square, &r, &x, A);
}

static void SmallLaw(const Lanes H[9], const Lanes *bulk, const Lanes *shear, const Hardening *hardening, double dt,
                     const Lanes state[], Lanes *W, Lanes P[9], Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[])
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
  ReturnMap(hardening, dt, shear, &square, state, &r);
  if (W) *W = *bulk * trace * trace / 2 + r.W;
  for (int k = 0; k < 9 && P; k++) P[k] = 2 * *shear * r.theta * deviator[k] + *bulk * trace * (double)(k % 4 == 0);
  if (A) SmallTangent(bulk, shear, &square, &r, deviator, A);
  if (!next) return;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      next[component[i][j]] = state[component[i][j]] - 2 * (1 - r.theta) * deviator[3 * i + j];
  }
  NextStrain(state, &r, PlasticStates(hardening) > PLASTIC_WORK, next);
}

/*@
  PlasticStates - counts the numbers of the state of a point.

  Not collective
@*/
int PlasticStates(const Hardening *hardening)
{
  if (hardening->terms) return PLASTIC_BACKSTRESS + 6 * hardening->terms;
  return hardening->overstress > 0 ? PLASTIC_WORK + 1 : PLASTIC_STATE;
}

/*@
  PlasticStrainTensor - computes the plastic strain of a point.

  Not collective

  Input Parameters:
+ finite - 0 for small strains
- state  - the first six numbers of its state

  Output Parameter:
. strain - xx yy zz xy yz xz; in finite strains 1/2 ln Cp, which is along the axes of the reference configuration
@*/
void PlasticStrainTensor(int finite, const double state[6], double strain[6])
{
  Lanes tensor[6], value[3], axis[3][3];

  for (int k = 0; k < 6; k++) {
    tensor[k] = (Lanes){0} + state[k];
    strain[k] = finite ? 0 : -state[k] / 2;
  }
  if (!finite) return;
  PrincipalAxes(tensor, value, axis);
  for (int a = 0; a < 3; a++) {
    const double log = -log1p(fmax(value[a][0], least_square - 1)) / 2;

    for (int I = 0; I < 3; I++) {
      for (int J = I; J < 3; J++) strain[component[I][J]] += log * axis[a][I][0] * axis[a][J][0];
    }
  }
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
. hardening  - yield stress over equivalent plastic strain, backstresses, overstress
. dt         - time since the accepted state; it matters to an overstress alone, and nothing flows with 0 then
- state      - the accepted state [PlasticStates()]

  Output Parameters:
+ W    - elastic energy plus all plastic work from the virgin state on, per reference volume, or NULL
. P    - first Piola-Kirchhoff stress; with small strains the stress, or NULL
. A    - tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), r <= s, or NULL; it needs P
- next - the state at H, or NULL; it may be the same array as state

  Note:
  W is continuous where a state is accepted, but with an overstress: the potential of the overstress is its work from no
  rate to the present one, and the work that the state counts is that at the present rate. The output is finite for
every finite H, but it is NaN where the equations of a backstress are not solved.
@*/
void VonMisesLaw(int finite, const Lanes H[9], const Lanes *dilatation, const Lanes *bulk, const Lanes *shear,
                 const Hardening *hardening, double dt, const Lanes state[], Lanes *W, Lanes P[9],
                 Lanes A[MATERIAL_TANGENT_SIZE], Lanes next[])
{
  if (hardening->terms)
    BackstressLaw(finite, H, dilatation, bulk, shear, hardening, dt, state, W, P, A, next);
  else if (finite)
    FiniteLaw(H, dilatation, bulk, shear, hardening, dt, state, W, P, A, next);
  else
    SmallLaw(H, bulk, shear, hardening, dt, state, W, P, A, next);
}

/* The elastic part: Hencky's law */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  static const Hardening never                 = {.yield = DBL_MAX};
  const Lanes            virgin[PLASTIC_STATE] = {{0}};

  (void)n;
  FiniteLaw(H, dilatation, &constants[0], &constants[1], &never, 0, virgin, W, P, A, NULL);
}

const ElasticLaw MaterialLaw_VonMises = {.evaluate  = Evaluate,
                                         .shear     = MaterialLameShear,
                                         .constants = 2,
                                         .separable = 1,
                                         .isochoric = 1,
                                         .keys      = {"mu"},
                                         .required  = 1,
                                         .plastic   = 1};
