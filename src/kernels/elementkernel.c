/* Batched element kernels: full integration, and the choice of the kernel for every formulation. */
#include "elementbatch.h"
#include <stddef.h>

const char *const Formulations[] = {"full", "enhanced", "fbar", NULL};

/* Puts the extrapolated pressure into the geometric part of the law's tangent A at point q, whose gradient is H. */
LANES_INLINE void ExtrapolatePressure(const BatchCall *call, const int n, const int dim, const int hoop, int q,
                                      const ChunkPoints *c, const Lanes H[9], const Lanes *dilatation,
                                      Lanes A[MATERIAL_TANGENT_SIZE])
{
  Lanes dilatation_0, change, excess, C[9];

  PointReference(call, n, dim, hoop, q, c, H, &dilatation_0, &change);
  ExcessPressure(call, dilatation, &dilatation_0, &change, &excess);
  Cofactors(H, C);
  for (int lane = 0; lane < LANES; lane++) {
    const double J = 1 + FlooredDilatation((*dilatation)[lane]);

    excess[lane] /= J * J; /* F^-T = C / J enters twice */
  }
  for (int r = 0, k = 0; r < 9; r++)
    for (int s = r; s < 9; s++, k++) A[k] -= excess * C[3 * (r / 3) + s % 3] * C[3 * (s / 3) + r % 3];
}

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
      MaterialDilatation(H, &dilatation);
      KeepLeastJ(call, &dilatation);
      PointLaw(call, H, &dilatation, W ? &energy : NULL, P, K ? c.A[q] : NULL);
      if (K && call->u_0) ExtrapolatePressure(call, n, dim, hoop, q, &c, H, &dilatation, c.A[q]);
      if (W) LANE(W, 0) += energy * volume;
      if (call->H) StorePoint(call, first + q, H);
      for (int r = 0; r < 9; r++) P[r] *= volume;
      if (f) AddForce(n, dim, hoop, q, &c, P, f);
      for (int k = 0; k < MATERIAL_TANGENT_SIZE && K; k++) c.A[q][k] *= volume;
    }
    if (K) AddTangent(n, dim, hoop, count, first == 0, first + count == points, &c, K);
  }
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

static BatchFn *GetBatch(const KernelCase *kernel)
{
  const int axisymmetric = kernel->geometry == GEOMETRY_AXISYMMETRIC;

  switch (kernel->formulation) {
  case FORMULATION_ENHANCED: return enhanced_batches[kernel->type][axisymmetric];
  case FORMULATION_FBAR: return mean_dilatation_batches[kernel->type][axisymmetric];
  default: return full_batches[kernel->type][axisymmetric];
  }
}

/*@
  ElementKernelExists - says whether there is a kernel. The formulations other than full exist for quad4 and hex8 only.

  Not collective
@*/
int ElementKernelExists(const KernelCase *kernel)
{
  return GetBatch(kernel) != NULL;
}

/*@
  ElementExtrapolates - says whether the tangent depends on a PressureReference.

  Not collective

  Note:
  It does with separable laws, see ElasticLaw. Enhanced elements take no reference.
@*/
int ElementExtrapolates(const KernelCase *kernel)
{
  return kernel->kinematics == KINEMATICS_FINITE && kernel->formulation != FORMULATION_ENHANCED &&
         MaterialGetLaw(kernel->law)->separable;
}

/* Sets what all parts of a batch have in common. */
static BatchCall StartCall(const KernelCase *kernel, const Lanes *constants)
{
  const ElasticLaw *law = MaterialGetLaw(kernel->law);

  return (BatchCall){.e           = ElementGet(kernel->type),
                     .law         = law,
                     .finite      = kernel->kinematics == KINEMATICS_FINITE,
                     .n_constants = kernel->n_constants ? kernel->n_constants : law->constants,
                     .constants   = constants};
}

/*@
  ElementKernel - computes energy, internal force and tangent of a batch of KERNEL_LANES elements, total Lagrangian.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics, law and formulation of the batch
. X         - reference coordinates (length) [nodes][dim][lanes]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim][lanes]
. reference - the state from which K extrapolates the pressure, u as above; NULL: K has the pressure of u
- constants - of the law [n_constants][lanes]

  Output Parameters:
+ W - strain energy [lanes], or NULL
. f - internal force [nodes][dim][lanes], or NULL
. K - tangent [nodes*dim][nodes*dim][lanes], or NULL
- J - smallest determinant of F over the quadrature points [lanes]; 1 for small kinematics

  Note:
  Solids in plane strain have unit thickness. Axisymmetric quantities are over 360 degrees. A state with J <= 0 or NaN
  is not admissible, but all arrays hold finite numbers if X and u do. Every formulation has an energy; f and K are its
  derivatives. K is full and symmetric. With a reference K is no derivative, but it differs from it only by the square
  of the way from there (rate 1) or by that way (rate 0). A reference is ignored unless ElementExtrapolates().

  Source:
  Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", sections 8.4 and 8.5
  (reference configuration)
@*/
void ElementKernel(const KernelCase *kernel, const double *X, const double *u, const PressureReference *reference,
                   const double *constants, double *W, double *f, double *K, double *J)
{
  const int extrapolates = reference && ElementExtrapolates(kernel);
  BatchFn  *batch        = GetBatch(kernel);
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS];
  BatchCall call = StartCall(kernel, lanes_constants);

  call.rate = extrapolates ? reference->rate : 0;
  for (int part = 0; part < KERNEL_LANES; part += LANES) {
    for (int k = 0; k < call.n_constants; k++) lanes_constants[k] = CONST_LANE(constants + part, k);
    call.X   = X + part;
    call.u   = u + part;
    call.u_0 = extrapolates ? reference->u + part : NULL;
    call.W   = W ? W + part : NULL;
    call.f   = f ? f + part : NULL;
    call.K   = K ? K + part : NULL;
    call.J   = J + part;
    batch(&call);
  }
}

/*@
  ElementPointGradient - computes the displacement gradient at which an element evaluates the law, at its quadrature
  points.

  Not collective

  Input Parameters:
+ kernel    - element type, geometry, kinematics, law and formulation
. X         - reference coordinates (length) [nodes][dim]; axisymmetric: X[.][0] is the radius
. u         - displacements (length) [nodes][dim]
- constants - of the law [n_constants]

  Output Parameter:
. H - F - 1 at 3 i + I (i: space, I: reference) [points][9]
@*/
void ElementPointGradient(const KernelCase *kernel, const double *X, const double *u, const double *constants,
                          double *H)
{
  Lanes     lanes_constants[MATERIAL_MAX_CONSTANTS];
  BatchCall call = StartCall(kernel, lanes_constants);
  const int dofs = call.e->nodes * call.e->dim;
  double    lanes_X[ELEMENT_MAX_NODES * 3 * KERNEL_LANES], lanes_u[ELEMENT_MAX_NODES * 3 * KERNEL_LANES],
    lanes_H[ELEMENT_MAX_POINTS * 9 * KERNEL_LANES];
  double J[LANES];

  for (int lane = 0; lane < LANES; lane++) {
    for (int k = 0; k < dofs; k++) {
      lanes_X[k * KERNEL_LANES + lane] = X[k];
      lanes_u[k * KERNEL_LANES + lane] = u[k];
    }
  }
  for (int k = 0; k < call.n_constants; k++) lanes_constants[k] = (Lanes){0} + constants[k];
  call.X = lanes_X;
  call.u = lanes_u;
  call.J = J;
  call.H = lanes_H;
  GetBatch(kernel)(&call);
  for (int k = 0; k < call.e->points * 9; k++) H[k] = lanes_H[k * KERNEL_LANES];
}
