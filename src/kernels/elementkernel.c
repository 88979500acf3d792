/* Batched element kernels: full integration, and the choice of the kernel for every formulation. */
#include "elementbatch.h"
#include "planestress.h"
#include "volumehold.h"
#include <math.h>
#include <stddef.h>

/* Largest part kappa of the modulus of the volume over the shear modulus that mixed elements have without multipliers.
   A solve leaves a relative error of 1 / 1e4 in the volume strains where the multipliers are those of no load, and each
   change of the multipliers makes it 1e4 times smaller. The condition number of the tangent grows with kappa, and its
   round-off is small with 1e4 still. */
static const double largest_kappa = 1e4;
/* The same where energies are compared. A step that is right changes volumes by the square of its length, which full
   moduli make into more energy than the step gains. This is the modulus up to which solids need no mixed elements. */
static const double yielding_kappa = 20;
/* Part of the modulus of the volume that mixed elements with linear pressures evaluate at their points, over the shear
   modulus and over the modulus itself. Laws whose shape part does not depend on the volume resist changes of it inside
   an element that the projection does not see by their shear alone. One shear modulus more keeps Newton's method from
   long ways there: a bonded bush takes 27 iterations with it, 37 and a failed step without. It costs little accuracy,
   as a solid with this modulus has nu = 0.125 and does not lock; 20 shear moduli cost 2 to 7 times the error. A tenth
   keeps moderate moduli projected too. Plastic laws have no such part: their mean stress is far below the shear
   modulus, and where they flow, it would lock. */
static const double largest_local = 1, local_share = 0.1;

/* Numbers of the state of a point, of any law */
enum { MAX_STATE = UMAT_STATES + UMAT_MAX_STATES + UMAT_HOLD };
_Static_assert((int)MAX_STATE >= (int)PLASTIC_MAX_STATE, "room for the states of all laws");

const char *const Formulations[] = {"full", "enhanced", "fbar", "mixed", NULL};

/* Computes energy, force and tangent of the first LANES elements of the arrays. n, points, dim and hoop are constants
   of the instance. */
LANES_INLINE void Batch(const BatchCall *call, const int n, const int points, const int dim, const int hoop)
{
  const Element *e = call->e;
  double *const W = call->W, *const f = call->f, *const K = call->K;
  const Lanes zero = {0};
  ChunkPoints c;

  if (W) LANE(W, 0) = zero;
  for (int i = 0; i < n * dim && f; i++) LANE(f, i) = zero;
  StartLeastJ(call);
  for (int first = 0; first < points; first += CHUNK) {
    const int count = points - first < CHUNK ? points - first : CHUNK;

    for (int q = 0; q < count; q++) {
      Lanes H[9], P[9], energy, volume, dilatation;

      PointGradients(n, dim, hoop, e->N[first + q], e->dN[first + q], e->weight[first + q], q, call->X, &c, &volume);
      PointDisplacementGradient(n, dim, hoop, q, call->u, &c, H);
      if (call->thin) PointStretch(call, H);
      MaterialDilatation(H, &dilatation);
      KeepLeastJ(call, &dilatation);
      PointLaw(call, first + q, H, &dilatation, W ? &energy : NULL, P, K ? c.A[q] : NULL);
      if (call->thin && K) PlaneTangent(c.A[q]);
      if (K && call->u_0) {
        Lanes H_0[9];

        PointDisplacementGradient(n, dim, hoop, q, call->u_0, &c, H_0);
        PointExtrapolate(call, H, &dilatation, H_0, c.A[q]);
      }
      if (W) LANE(W, 0) += energy * volume;
      if (call->H) StorePoint(call, first + q, H);
      for (int r = 0; r < 9; r++) P[r] *= volume;
      if (f) AddForce(n, dim, hoop, q, &c, P, f);
      for (int k = 0; k < MATERIAL_TANGENT_SIZE && K; k++) c.A[q][k] *= volume;
    }
    if (K) AddTangent(n, dim, hoop, count, first == 0, first + count == points, &c, K);
  }
  if (call->skew) AddSkewTangent(call, hoop);
}

#define BATCH_INSTANCE(name, nodes, points, dim, hoop) \
  static void name(const BatchCall *call)              \
  {                                                    \
    Batch(call, nodes, points, dim, hoop);             \
  }

BATCH_INSTANCE(BatchTri3, 3, 1, 2, 0)
BATCH_INSTANCE(BatchTri6, 6, 3, 2, 0)
BATCH_INSTANCE(BatchQuad4, 4, 4, 2, 0)
BATCH_INSTANCE(BatchQuad9, 9, 9, 2, 0)
BATCH_INSTANCE(BatchTri3Axisymmetric, 3, 1, 2, 1)
BATCH_INSTANCE(BatchTri6Axisymmetric, 6, 3, 2, 1)
BATCH_INSTANCE(BatchQuad4Axisymmetric, 4, 4, 2, 1)
BATCH_INSTANCE(BatchQuad9Axisymmetric, 9, 9, 2, 1)
BATCH_INSTANCE(BatchTet4, 4, 1, 3, 0)
BATCH_INSTANCE(BatchTet10, 10, 4, 3, 0)
BATCH_INSTANCE(BatchHex8, 8, 8, 3, 0)
BATCH_INSTANCE(BatchHex27, 27, 27, 3, 0)

static BatchFn *const full_batches[ELEMENT_TYPES][2] = {
  [ELEMENT_TRI3]  = {BatchTri3, BatchTri3Axisymmetric},
  [ELEMENT_TRI6]  = {BatchTri6, BatchTri6Axisymmetric},
  [ELEMENT_QUAD4] = {BatchQuad4, BatchQuad4Axisymmetric},
  [ELEMENT_QUAD9] = {BatchQuad9, BatchQuad9Axisymmetric},
  [ELEMENT_TET4]  = {BatchTet4, NULL},
  [ELEMENT_TET10] = {BatchTet10, NULL},
  [ELEMENT_HEX8]  = {BatchHex8, NULL},
  [ELEMENT_HEX27] = {BatchHex27, NULL},
};

/* The kernels of mixed elements whose nodes have pressures, NULL where there are none. Elements of second order
   condense their pressures with plastic laws, and where the case says so. */
static BatchFn *const *NodalPressureBatches(const KernelCase *kernel)
{
  if (kernel->formulation != FORMULATION_MIXED) return NULL;
  if (nodal_pressure_batches[kernel->type][0]) return nodal_pressure_batches[kernel->type];
  if (kernel->condensed || MaterialGetLaw(kernel->law)->plastic || !taylor_hood_batches[kernel->type][0]) return NULL;
  return taylor_hood_batches[kernel->type];
}

static BatchFn *GetBatch(const KernelCase *kernel)
{
  const int         axisymmetric = kernel->geometry == GEOMETRY_AXISYMMETRIC;
  const ElasticLaw *law          = MaterialGetLaw(kernel->law);
  const int         splits = law->separable || (kernel->kinematics == KINEMATICS_SMALL && kernel->law != MATERIAL_UMAT);

  switch (kernel->formulation) { /* the modes of enhanced elements are found by an energy, which a routine has not */
  case FORMULATION_ENHANCED: return kernel->law == MATERIAL_UMAT ? NULL : enhanced_batches[kernel->type][axisymmetric];
  case FORMULATION_FBAR: return mean_dilatation_batches[kernel->type][axisymmetric];
  case FORMULATION_MIXED:
    if (!splits) return NULL;
    return (NodalPressureBatches(kernel) ? NodalPressureBatches(kernel) : mixed_batches[kernel->type])[axisymmetric];
  default: return full_batches[kernel->type][axisymmetric];
  }
}

/*@
  ElementKernelExists - says whether there is a kernel. Enhanced and fbar exist for quad4 and hex8 only.

  Not collective

  Note:
  Mixed exists for separable laws, see material.h. With small strains all laws are.
@*/
int ElementKernelExists(const KernelCase *kernel)
{
  return GetBatch(kernel) != NULL;
}

/* Are there numbers of volumehold.h? */
static int HoldsVolume(const KernelCase *kernel)
{
  return kernel->plastic && kernel->kinematics == KINEMATICS_FINITE &&
         (kernel->formulation == FORMULATION_FBAR || kernel->formulation == FORMULATION_MIXED);
}

/* Counts the numbers that a law has in the state of a point. */
static int LawStates(const PlasticBatch *plastic)
{
  return plastic->umat ? UmatStates(plastic->umat) : PlasticStates(plastic->hardening);
}

/*@
  ElementStates - counts the numbers of the state of a point.

  Not collective
@*/
int ElementStates(const KernelCase *kernel)
{
  const int hold = kernel->plastic->umat ? UMAT_HOLD : PLASTIC_HOLD;

  return LawStates(kernel->plastic) + (HoldsVolume(kernel) ? hold : 0);
}

/*@
  ElementStatePoints - counts the points of an element that have a plastic state.

  Not collective

  Note:
  Mixed triangles and tetrahedra integrate with more points than the element has in its table. The points of the table
  follow theirs in the state, and give the results.
@*/
int ElementStatePoints(const KernelCase *kernel)
{
  const Element *e      = ElementGet(kernel->type);
  const int      points = kernel->formulation == FORMULATION_MIXED ? MixedPoints(e) : e->points;

  return points > e->points ? points + e->points : e->points;
}

/*@
  ElementExtrapolates - says whether the tangent depends on a StressReference.

  Not collective

  Note:
  It does with laws that extrapolate their stress, and with separable laws, of which the pressure is extrapolated. With
  formulation fbar it does with the latter only.
@*/
int ElementExtrapolates(const KernelCase *kernel)
{
  const ElasticLaw *law = MaterialGetLaw(kernel->law);

  if (kernel->kinematics == KINEMATICS_SMALL || kernel->thin || NodalPressureBatches(kernel)) return 0;
  return law->separable || (law->extrapolate && kernel->formulation != FORMULATION_FBAR);
}

/* Sets what all parts of a batch have in common. */
static BatchCall StartCall(const KernelCase *kernel, const Lanes *constants)
{
  const ElasticLaw *law = MaterialGetLaw(kernel->law);

  return (BatchCall){.e           = ElementGet(kernel->type),
                     .law         = law,
                     .finite      = kernel->kinematics == KINEMATICS_FINITE,
                     .n_constants = kernel->n_constants ? kernel->n_constants : law->constants,
                     .plastic     = kernel->plastic,
                     .length      = kernel->length,
                     .component   = kernel->component,
                     .thin        = kernel->thin,
                     .states      = kernel->plastic ? ElementStates(kernel) : 0,
                     .hold        = HoldsVolume(kernel) ? LawStates(kernel->plastic) : 0,
                     .constants   = constants};
}

/* Splits the modulus of the volume. A modulus that is not positive is projected as a whole. */
static VolumeModuli SplitVolume(const KernelCase *kernel, double modulus, double mu)
{
  VolumeModuli split = {.mu = mu};

  if (ElementPressures(kernel) > 1 && !MaterialGetLaw(kernel->law)->plastic)
    split.local = fmax(0, fmin(largest_local * mu, local_share * modulus));
  split.projected = modulus - split.local;
  split.kappa     = fmin(split.projected, (kernel->yields ? yielding_kappa : largest_kappa) * mu);
  return split;
}

/*@
  ElementVolumeModuli - computes the parts of the modulus of the volume in mixed elements.

  Not collective

  Input Parameters:
+ kernel    - element type, law and number of constants
. constants - of the law [n][stride]; the first is the modulus, infinite in incompressible materials
- stride    - from one constant to the next

  Output Parameter:
. moduli - its parts
@*/
void ElementVolumeModuli(const KernelCase *kernel, const double *constants, int stride, VolumeModuli *moduli)
{
  const ElasticLaw *law = MaterialGetLaw(kernel->law);
  const int         n   = kernel->n_constants ? kernel->n_constants : law->constants;
  Lanes             lanes_constants[MATERIAL_MAX_CONSTANTS], shear;

  for (int k = 0; k < n; k++) lanes_constants[k] = (Lanes){0} + constants[k * stride];
  law->shear(n, lanes_constants, &shear);
  *moduli = SplitVolume(kernel, constants[0], shear[0]);
}

/* Sets the constants of LANES elements. Those of mixed elements have only the local part of the modulus of the volume.
 */
static void SetConstants(const KernelCase *kernel, const double *constants, int stride, BatchCall *call,
                         Lanes lanes_constants[MATERIAL_MAX_CONSTANTS])
{
  for (int k = 0; k < call->n_constants; k++) {
    for (int lane = 0; lane < LANES; lane++)
      lanes_constants[k][lane] = constants[k * stride + (stride == 1 ? 0 : lane)];
  }
  if (kernel->thin) {
    Lanes mu, first;

    call->law->shear(call->n_constants, lanes_constants, &mu);
    first        = lanes_constants[0] - (call->law->isochoric ? 2 * mu / 3 : (Lanes){0});
    call->across = first / (first + 2 * mu);
  }
  if (kernel->formulation != FORMULATION_MIXED) return;
  call->law->shear(call->n_constants, lanes_constants, &call->mu);
  for (int lane = 0; lane < LANES; lane++) {
    const VolumeModuli split = SplitVolume(kernel, lanes_constants[0][lane], call->mu[lane]);

    call->kappa[lane]        = split.kappa;
    call->modulus[lane]      = split.projected;
    call->rest[lane]         = 1 - split.kappa / split.projected;
    lanes_constants[0][lane] = split.local;
  }
}

/* Elements that have come across the axis of revolution are inverted, too: J is at most their hoop stretch where that
   is not positive. A ball that is turned inside out through its centre has a determinant above 0. */
static void AcrossAxis(const BatchCall *call)
{
  for (int p = 0; p < call->e->points; p++) {
    Lanes before = {0}, now = {0};

    for (int a = 0; a < call->e->nodes; a++) {
      before += call->e->N[p][a] * CONST_LANE(call->X, 2 * a);
      now += call->e->N[p][a] * CONST_LANE(call->u, 2 * a);
    }
    now += before;
    for (int lane = 0; lane < LANES; lane++)
      if (before[lane] > 0 && now[lane] <= 0) call->J[lane] = fmin(call->J[lane], now[lane] / before[lane]);
  }
}

/*@
  ElementKernel - computes energy, internal force and tangent of a batch of KERNEL_LANES elements, total Lagrangian.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics, law and formulation of the batch
. X         - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim][lanes]
. reference  - the state from which K extrapolates the pressure, u as above; NULL: K has the pressure of u
. constants  - of the law [n_constants][lanes]
- multiplier - of mixed elements (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Output Parameters:
+ W - strain energy [lanes], or NULL
. f - internal force [nodes][dim][lanes], or NULL
. K - tangent [nodes*dim][nodes*dim][lanes], or NULL
- J - smallest determinant of F over the quadrature points [lanes], or a hoop stretch that is not positive; 1 for small
      kinematics

  Note:
  Solids in the plane have unit thickness; where they are thin, their stress across the plane is 0. Axisymmetric
quantities are over 360 degrees. A state with J <= 0 or NaN is not admissible, but all arrays hold finite numbers if X
and u do. f and K are derivatives of the energy, but for elements whose nodes have pressures; there W is what is stored
where the pressure is in equilibrium. K is full. It is symmetric, unless a routine of the user's has an unsymmetric
tangent or nodes have pressures. With a reference K is no derivative, but it differs from it only by the square of the
way from there (rate 1) or by that way (rate 0). A reference is ignored unless ElementExtrapolates().

  Source:
  Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", sections 8.4 and 8.5
  (reference configuration)
@*/
void ElementKernel(const KernelCase *kernel, const double *X, const double *u, const StressReference *reference,
                   const double *constants, const double *multiplier, double *W, double *f, double *K, double *J)
{
  const int extrapolates = reference && ElementExtrapolates(kernel);
  const int unsymmetric  = K && kernel->plastic && kernel->plastic->umat && UmatIsUnsymmetric(kernel->plastic->umat);
  int       fault[LANES] = {0};
  BatchFn  *batch        = GetBatch(kernel);
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS], skew[ELEMENT_MAX_POINTS][UMAT_SKEW_SIZE];
  BatchCall call = StartCall(kernel, lanes_constants);

  call.skew = unsymmetric ? skew : NULL;
  call.rate = extrapolates ? reference->rate : 0;
  call.held = extrapolates && reference->held;
  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    SetConstants(kernel, constants + part, KERNEL_LANES, &call, lanes_constants);
    call.multiplier = multiplier ? multiplier + part : NULL;
    call.part       = part;
    call.X          = X + part;
    call.u          = u + part;
    call.u_0        = extrapolates ? reference->u + part : NULL;
    call.state      = kernel->plastic ? kernel->plastic->state + part : NULL;
    call.W          = W ? W + part : NULL;
    call.f          = f ? f + part : NULL;
    call.K          = K ? K + part : NULL;
    call.J          = J + part;
    call.fault      = fault;
    batch(&call);
    if (kernel->geometry == GEOMETRY_AXISYMMETRIC && call.finite) AcrossAxis(&call);
    for (int lane = 0; lane < LANES; lane++) { /* as an element that is inverted: the step is taken back */
      if (fault[lane]) J[part + lane] = NAN;
      if (kernel->plastic && kernel->plastic->fault) kernel->plastic->fault[part + lane] = fault[lane];
      fault[lane] = 0;
    }
  }
}

/* Takes the state of all points of a part of a batch on to the displacement gradients H. */
static void AcceptPoints(const BatchCall *call, int points, const double *H, double *state)
{
  const int   inner = call->hold ? MixedPoints(call->e) : 0;
  const Lanes hold  = HoldModulus(call, inner);

  for (int p = 0; p < points; p++) {
    Lanes lanes_H[9], lanes_state[PLASTIC_MAX_STATE], dilatation;

    for (int r = 0; r < 9; r++) lanes_H[r] = CONST_LANE(H, p * 9 + r);
    if (call->plastic->umat) {
      PointUmat(call, p, lanes_H, state, NULL, NULL, NULL);
      continue;
    }
    for (int k = 0; k < call->states; k++) lanes_state[k] = CONST_LANE(state, p * call->states + k);
    MaterialDilatation(lanes_H, &dilatation);
    VonMisesLaw(call->finite, lanes_H, &dilatation, &call->constants[0], &call->constants[1], call->plastic->hardening,
                call->plastic->dt, lanes_state, NULL, NULL, NULL, lanes_state);
    for (int k = 0; k < call->states; k++) LANE(state, p * call->states + k) = lanes_state[k];
  }
  if (call->hold) HoldAccept(call, inner, &hold, call->off, state);
}

/*@
  ElementAcceptState - takes the plastic state of a batch of KERNEL_LANES elements on to displacements that are
accepted.

  Not collective

  Input Parameters:
+ kernel    - with plastic, whose state is changed
. X         - reference coordinates (length) [nodes][dim][lanes]
. u         - displacements (length) [nodes][dim][lanes]
. constants - of the law [n_constants][lanes]
- multiplier - of mixed elements (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Note:
  At the same u, ElementKernel() gives the same values before and after, up to round-off, and without time passing.
@*/
void ElementAcceptState(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                        const double *multiplier)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS] = {{0}};
  BatchCall call = StartCall(kernel, lanes_constants);
  double    H[ELEMENT_MAX_POINTS * 9 * KERNEL_LANES], off[ELEMENT_MAX_POINTS * KERNEL_LANES], J[LANES];

  call.off = off;
  call.J   = J;
  call.H   = H;
  call.all = 1;
  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    SetConstants(kernel, constants + part, KERNEL_LANES, &call, lanes_constants);
    call.part       = part;
    call.X          = X + part;
    call.u          = u + part;
    call.multiplier = multiplier ? multiplier + part : NULL;
    call.state      = kernel->plastic->state + part;
    GetBatch(kernel)(&call);
    AcceptPoints(&call, ElementStatePoints(kernel), H, kernel->plastic->state + part);
  }
}

/*@
  ElementPressures - returns the number of pressures of an element: 0 but for mixed elements.

  Not collective

  Input Parameter:
. kernel - element type and formulation
@*/
int ElementPressures(const KernelCase *kernel)
{
  return kernel->formulation == FORMULATION_MIXED && !NodalPressureBatches(kernel) ? mixed_pressures[kernel->type] : 0;
}

/*@
  ElementNodes - returns the number of nodes that a kernel has: those of the element, and its corners once more where
  they have pressures.

  Not collective

  Input Parameter:
. kernel - element type and formulation

  Note:
  The nodes of the element come first. Those of the corners' pressures follow in the same order; nodalpressurekernel.c
  tells what their displacements are.
@*/
int ElementNodes(const KernelCase *kernel)
{
  const Element *e = ElementGet(kernel->type);

  return e->nodes + (NodalPressureBatches(kernel) ? e->corners : 0);
}

/*@
  ElementDilatation - computes the dilatations of a batch of mixed elements, from which the pressures follow.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics, law and formulation of the batch
. X          - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim][lanes]
. constants  - of the law [n_constants][lanes]
- multiplier - (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Output Parameter:
. theta - coefficients of the projection of ln j / j, which mixedkernel.c explains (root of volume) [pressures][lanes]

  Note:
  The pressure in the element is multiplier + kappa theta, see ElementVolumeModuli(). It is right where it is the
  modulus of the volume times theta.
@*/
void ElementDilatation(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                       const double *multiplier, double *theta)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS] = {{0}};
  BatchCall call = StartCall(kernel, lanes_constants);
  double    J[LANES];

  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    SetConstants(kernel, constants + part, KERNEL_LANES, &call, lanes_constants);
    call.X          = X + part;
    call.u          = u + part;
    call.J          = J;
    call.part       = part;
    call.state      = kernel->plastic ? kernel->plastic->state + part : NULL;
    call.multiplier = multiplier ? multiplier + part : NULL;
    call.theta      = theta + part;
    GetBatch(kernel)(&call);
  }
}

/* Extrapolates the pressures of a batch from an earlier state; multiplier as for ElementKernel(). */
static void Follow(const KernelCase *kernel, const double *X, const double *u, const StressReference *reference,
                   const double *constants, const double *multiplier, double *pressure)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS] = {{0}};
  BatchCall call = StartCall(kernel, lanes_constants);
  double    J[LANES];

  call.rate = reference->rate;
  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    SetConstants(kernel, constants + part, KERNEL_LANES, &call, lanes_constants);
    call.X          = X + part;
    call.u          = u + part;
    call.u_0        = reference->u + part;
    call.part       = part;
    call.state      = kernel->plastic ? kernel->plastic->state + part : NULL;
    call.J          = J;
    call.multiplier = multiplier ? multiplier + part : NULL;
    call.follow     = pressure + part;
    GetBatch(kernel)(&call);
  }
}

/*@
  ElementFollow - computes the multipliers with which a batch of mixed elements has the pressures that extrapolate from
  an earlier state.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics, law and formulation of the batch
. X          - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim][lanes]
. reference  - the earlier state, u as above
. constants  - of the law [n_constants][lanes]
- multiplier - present ones (stress times root of volume) [pressures][lanes]

  Output Parameter:
. next - multipliers [pressures][lanes]; 0 in elements that have the whole modulus of the volume

  Note:
  These pressures are those that the mixed method's own Newton iteration has as unknowns.
@*/
void ElementFollow(const KernelCase *kernel, const double *X, const double *u, const StressReference *reference,
                   const double *constants, const double *multiplier, double *next)
{
  Follow(kernel, X, u, reference, constants, multiplier, next);
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    VolumeModuli moduli;

    ElementVolumeModuli(kernel, constants + lane, KERNEL_LANES, &moduli);
    for (int k = lane; k < ElementPressures(kernel) * KERNEL_LANES; k += KERNEL_LANES)
      next[k] *= 1 - moduli.kappa / moduli.projected;
  }
}

/*@
  ElementYield - computes the multipliers with which elements of a soft volume have the pressures that extrapolate from
  an earlier state.

  Not collective

  Input Parameters:
+ kernel     - as for ElementFollow()
. X          - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim][lanes]
. reference  - the earlier state, u as above
. constants  - of the law [n_constants][lanes]
- multiplier - present ones (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Output Parameter:
. next - multipliers [pressures][lanes] for a KernelCase that yields

  Note:
  The energy of such elements with these multipliers has the same minimum in an equilibrium with these pressures.
@*/
void ElementYield(const KernelCase *kernel, const double *X, const double *u, const StressReference *reference,
                  const double *constants, const double *multiplier, double *next)
{
  KernelCase soft = *kernel;

  Follow(kernel, X, u, reference, constants, multiplier, next);
  soft.yields = 1;
  for (int lane = 0; lane < KERNEL_LANES; lane++) {
    VolumeModuli moduli;

    ElementVolumeModuli(&soft, constants + lane, KERNEL_LANES, &moduli);
    for (int k = lane; k < ElementPressures(kernel) * KERNEL_LANES; k += KERNEL_LANES)
      next[k] *= 1 - moduli.kappa / moduli.projected;
  }
}

/*@
  ElementPointState - computes the displacement gradient at which an element evaluates the law, and the pressure of a
  mixed element, at its quadrature points.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics, law and formulation
. X          - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim]
. constants  - of the law [n_constants]
- multiplier - of a mixed element (stress times root of volume) [pressures]; NULL: they are 0

  Output Parameters:
+ H        - F - 1 at 3 i + I (i: space, I: reference) [points][9]
- pressure - derivative of the energy of the volume by ln J (stress) [points]; 0 unless mixed

  Note:
  A mixed element evaluates the law without its modulus of the volume. tri6 and tet10 have other points inside.
@*/
void ElementPointState(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                       const double *multiplier, double *H, double *pressure)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS] = {{0}};
  BatchCall call = StartCall(kernel, lanes_constants);
  const int dofs = ElementNodes(kernel) * call.e->dim;
  double    lanes_X[ELEMENT_MAX_NODES * 3 * KERNEL_LANES], lanes_u[ELEMENT_MAX_NODES * 3 * KERNEL_LANES],
    lanes_H[ELEMENT_MAX_POINTS * 9 * KERNEL_LANES], lanes_state[ELEMENT_MAX_POINTS * MAX_STATE * KERNEL_LANES],
    lanes_pressure[ELEMENT_MAX_POINTS * KERNEL_LANES] = {0}, lanes_multiplier[MIXED_PRESSURES * KERNEL_LANES];
  double       J[LANES];
  PlasticBatch one;

  for (int lane = 0; lane < LANES; lane++) {
    for (int k = 0; k < dofs; k++) {
      lanes_X[k * KERNEL_LANES + lane] = X[k];
      lanes_u[k * KERNEL_LANES + lane] = u[k];
    }
    for (int k = 0; k < ElementPressures(kernel); k++)
      lanes_multiplier[k * KERNEL_LANES + lane] = multiplier ? multiplier[k] : 0;
  }
  SetConstants(kernel, constants, 1, &call, lanes_constants);
  call.X          = lanes_X;
  call.u          = lanes_u;
  call.J          = J;
  call.H          = lanes_H;
  call.multiplier = lanes_multiplier;
  call.pressure   = lanes_pressure;
  if (kernel->plastic) {
    for (int k = 0; k < ElementStatePoints(kernel) * call.states; k++)
      LANE(lanes_state, k) = (Lanes){0} + kernel->plastic->state[k * KERNEL_LANES + kernel->plastic->lane];
    call.state = lanes_state;
    one        = *kernel->plastic;
    for (int lane = 0; lane < LANES; lane++) {
      one.number[lane] = kernel->plastic->number[kernel->plastic->lane];
      one.length[lane] = kernel->plastic->length[kernel->plastic->lane];
    }
    call.plastic = &one;
  }
  GetBatch(kernel)(&call);
  for (int k = 0; k < call.e->points * 9; k++) H[k] = lanes_H[k * KERNEL_LANES];
  for (int q = 0; q < call.e->points; q++) pressure[q] = lanes_pressure[q * KERNEL_LANES];
}

/*@
  ElementBatchStates - computes for a batch of KERNEL_LANES elements what ElementPointState() does for one.

  Not collective

  Input Parameters:
+ kernel     - element type, geometry, kinematics, law and formulation of the batch
. X          - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u          - displacements (length) [nodes][dim][lanes]
. constants  - of the law [n_constants][lanes]
- multiplier - of mixed elements (stress times root of volume) [pressures][lanes]; NULL: they are 0

  Output Parameters:
+ H        - F - 1 at 3 i + I (i: space, I: reference) [points][9][lanes]
- pressure - derivative of the energy of the volume by ln J (stress) [points][lanes]; 0 unless mixed
@*/
void ElementBatchStates(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                        const double *multiplier, double *H, double *pressure)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS] = {{0}};
  BatchCall call = StartCall(kernel, lanes_constants);
  double    J[LANES];

  call.J = J;
  for (int k = 0; k < call.e->points * KERNEL_LANES; k++) pressure[k] = 0;
  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    SetConstants(kernel, constants + part, KERNEL_LANES, &call, lanes_constants);
    call.part       = part;
    call.X          = X + part;
    call.u          = u + part;
    call.multiplier = multiplier ? multiplier + part : NULL;
    call.state      = kernel->plastic ? kernel->plastic->state + part : NULL;
    call.H          = H + part;
    call.pressure   = pressure + part;
    GetBatch(kernel)(&call);
  }
}
